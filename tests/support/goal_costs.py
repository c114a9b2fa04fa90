"""How well goals stand for points, to judge what places them."""

from __future__ import annotations

from scipy.spatial import cKDTree

from shotc.geom.bernstein import Array


def coverage(points: Array, goals: Array) -> float:
    """Return the sum of the squared distances of points (M, D) from their nearest goals (n, D).

    Source: *display* Eq. 16. For the projected cost give both ``(x - centre) @ view_plane(...)[0].T``.
    """
    near = cKDTree(goals).query(points)[0]
    return float(near @ near)
