"""Adds the hidden side of a target: the corners of bodies whose visible side is in the boxes."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.bspline import IntArray
from shotc.geom.camera import ScreenBox
from shotc.identify.views import CameraPose
from shotc.ir.mission import MissionIR

MARGIN_HALF_SIDES = 1.5
"""Size of a box, in its half sides, inside which a body lies if the box is drawn around it."""
LEAST_SHARE = 0.02
"""Least share of a target's points on a body that belongs to it."""


def hidden_corners(
    mission: MissionIR, hit: tuple[IntArray, IntArray], views: Sequence[tuple[CameraPose, ScreenBox]]
) -> Array:
    """Return the corners of the bodies of a target, shape (K, 3), W, metres.

    Only bodies count whose outline is inside, or just outside, every box. A body that reaches farther adds
    nothing, for example a church of which the tower is meant.

    hit : mesh and triangle of each of its points
    views : cameras, and the boxes that mean it
    """
    mesh, triangle = hit
    body = np.zeros(len(mesh), dtype=np.intp)
    for number in np.unique(mesh):
        mine = mesh == number
        body[mine] = mission.meshes[number].body[triangle[mine]]
    pairs, counts = np.unique(np.column_stack([mesh, body]), axis=0, return_counts=True)
    parts = [np.zeros((0, 3))]
    for (number, which), count in zip(pairs.tolist(), counts.tolist(), strict=True):
        each = mission.meshes[number]
        corners = each.surface.triangles[each.body[each.surface.source] == which].reshape(-1, 3)
        if count >= LEAST_SHARE * len(mesh) and all(_within(corners, *view) for view in views):
            parts.append(corners)
    return np.concatenate(parts)


def _within(corners: Array, camera: CameraPose, box: ScreenBox) -> bool:
    """Return whether all corners (K, 3) appear inside a box or just outside it."""
    u, v, depth = camera.view.project(tuple((corners - np.array(camera.eye)).T))
    if (depth <= 0.0).any():
        return False
    across, up = 0.5 * (box.u_max - box.u_min), 0.5 * (box.v_max - box.v_min)
    off = np.maximum(
        np.abs(u - 0.5 * (box.u_min + box.u_max)) / across, np.abs(v - 0.5 * (box.v_min + box.v_max)) / up
    )
    return bool((off <= MARGIN_HALF_SIDES).all())
