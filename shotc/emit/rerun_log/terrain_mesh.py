"""Terrain in the recording, as one mesh with shared corners for smooth shading."""

from __future__ import annotations

from typing import Any

import rerun as rr

from shotc.emit.ground_mesh import mesh_of
from shotc.emit.palette import GROUND, rgba8, shade
from shotc.geom.surface.ground import Ground

TERRAIN = "world/terrain"
COLOR = rgba8(shade(GROUND, 0.62))


def log_terrain(stream: Any, ground: Ground) -> None:
    """Log the ground, without a time."""
    mesh = mesh_of(ground.surface.triangles)
    mesh3d = rr.Mesh3D(
        vertex_positions=mesh.corners,
        vertex_normals=mesh.normals,
        triangle_indices=mesh.faces,
        albedo_factor=COLOR,
    )
    stream.log(TERRAIN, mesh3d, static=True)
