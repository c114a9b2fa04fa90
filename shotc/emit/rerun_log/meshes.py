"""Terrain, scenes and buildings in the recording."""

from __future__ import annotations

from typing import Any

import numpy as np
import rerun as rr

from shotc.emit.mesh_shades import faces_of
from shotc.emit.palette import GROUND, STONE, rgba8, shade
from shotc.emit.triangles import mesh_of
from shotc.geom.surface.ground import Ground
from shotc.ir.mission import MissionIR

STANDING = "world/standing"
"""Parent entity of the meshes, which have the names of the mission."""
SKY_M = 1e4
"""Height of the eye from which faces are lit, metres."""
TERRAIN = "world/terrain"
GROUND_COLOR = rgba8(shade(GROUND, 0.62))


def log_meshes(stream: Any, mission: MissionIR) -> None:
    """Log scenes and buildings, without a time: shaded triangles, and points of clouds."""
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


def log_terrain(stream: Any, ground: Ground) -> None:
    """Log the ground as one mesh with shared corners, for smooth shading, without a time."""
    mesh = mesh_of(ground.surface.triangles)
    mesh3d = rr.Mesh3D(
        vertex_positions=mesh.corners,
        vertex_normals=mesh.normals,
        triangle_indices=mesh.faces,
        albedo_factor=GROUND_COLOR,
    )
    stream.log(TERRAIN, mesh3d, static=True)
