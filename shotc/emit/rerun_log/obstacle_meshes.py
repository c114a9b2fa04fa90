"""Scenes and buildings in the recording: shaded triangles, and points of clouds."""

from __future__ import annotations

from typing import Any

import numpy as np
import rerun as rr

from shotc.emit.mesh_shades import faces_of
from shotc.emit.palette import STONE, rgba8
from shotc.ir.mission import MissionIR

STANDING = "world/standing"
"""Parent entity of the meshes, which have the names of the mission."""
SKY_M = 1e4
"""Height of the eye from which faces are lit, metres."""


def log_meshes(stream: Any, mission: MissionIR) -> None:
    """Log the meshes that the mission reads from files, without a time."""
    for mesh in mission.meshes:
        triangles = mesh.surface.triangles
        points = (triangles == triangles[:, :1]).all(axis=(1, 2))
        solid = faces_of([mesh], np.array([-SKY_M, SKY_M, SKY_M]))
        colors = np.round(255.0 * solid.colors).astype(np.uint8)
        if not points.all():
            flat = solid.triangles[: len(triangles) - int(points.sum())].reshape(-1, 3)
            mesh3d = rr.Mesh3D(
                vertex_positions=flat.astype(np.float32),
                triangle_indices=np.arange(len(flat), dtype=np.uint32).reshape(-1, 3),
                vertex_colors=np.repeat(colors[: len(flat) // 3], 3, axis=0),
            )
            stream.log(f"{STANDING}/{mesh.kind}", mesh3d, static=True)
        if points.any():
            cloud = rr.Points3D(triangles[points, 0], radii=mesh.spacing, colors=[rgba8(STONE)])
            stream.log(f"{STANDING}/{mesh.kind}/points", cloud, static=True)
