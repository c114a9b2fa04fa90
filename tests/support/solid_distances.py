"""Distances to solids, computed anew for the tests: nothing here is shared with what is tested."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.solids import Cylinder, Solid
from tests.support.csv_tables import Table


def signed_distance(solid: Solid, points: Array) -> Array:
    """Return how far points (M, 3) lie outside a solid, negative inside, metres."""
    across = _to_disc(solid, points) if isinstance(solid, Cylinder) else _to_polygon(solid.points, points)
    upright = np.maximum(solid.bottom - points[:, 2], points[:, 2] - solid.top)
    outside = np.hypot(np.maximum(across, 0), np.maximum(upright, 0))
    return np.where((across > 0) | (upright > 0), outside, np.maximum(across, upright))


def _to_disc(solid: Cylinder, points: Array) -> Array:
    return np.hypot(points[:, 0] - solid.centre[0], points[:, 1] - solid.centre[1]) - solid.radius


def _to_polygon(corners: tuple[tuple[float, float], ...], points: Array) -> Array:
    """Distance to the outline, with the sign by the winding number of the corners round the point."""
    a = np.array(corners)
    b = np.roll(a, -1, axis=0)
    p = points[:, None, :2]
    along = np.clip(((p - a) * (b - a)).sum(-1) / ((b - a) ** 2).sum(-1), 0, 1)
    distance = np.linalg.norm(p - a - along[..., None] * (b - a), axis=-1).min(axis=1)
    to_a, to_b = a - p, b - p
    cross = to_a[..., 0] * to_b[..., 1] - to_a[..., 1] * to_b[..., 0]
    turns = np.arctan2(cross, (to_a * to_b).sum(-1)).sum(axis=1) / (2 * np.pi)
    return np.where(np.abs(turns) > 0.5, -distance, distance)


def least_on_the_way(solid: Solid, eyes: Array, points: Array, steps: int = 300) -> Array:
    """Return the least signed distance on the straight lines from eyes (M, 3) to points (M, 3), metres."""
    at = np.linspace(0, 1, steps)[:, None, None]
    line = eyes + at * (points - eyes)
    return signed_distance(solid, line.reshape(-1, 3)).reshape(steps, -1).min(axis=0)


def body(flight: Table, t: Array) -> Array:
    """Return a drone's places at times (M,), shape (M, 3): on its pad after its last row."""
    return np.stack([np.interp(t, flight["t_s"], flight[name]) for name in ("x_m", "y_m", "z_m")], axis=1)


def apart(flights: Mapping[str, Table], one: str, other: str) -> Array:
    """Return how far two drones are from each other at all samples, centre to centre, metres."""
    t = max((flights[one]["t_s"], flights[other]["t_s"]), key=len)
    return np.asarray(np.linalg.norm(body(flights[one], t) - body(flights[other], t), axis=1))
