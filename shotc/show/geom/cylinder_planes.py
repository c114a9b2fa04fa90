"""Half-planes of a move's scalars in which drones keep vertical cylinders free, one for each pair and time.

Two drones at r0 from each other before a move and at r1 after it are at a r0 + b r1 across and at a' r0 + b'
r1 upright during it, with scalars a, b that are common to all drones, and a', b' of the heights
(``solvers.own_heights``). They keep a cylinder of radius and half height 1 free if they are at least 1 apart
across or at least 1 apart upright. With the horizontal unit vector n, or with the sign s,

 a n.r0 + b n.r1 >= 1    or    a' s z0 + b' s z1 >= 1

are sufficient. Both are half-planes of two scalars. Where a motion is known, n and s are the directions in
which the two are apart on it, and the larger distance chooses between the two.

Of the half-planes of all pairs at one time few are needed. As scalars are never negative, these are the lower
left corners of the convex hull of all normals.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from shotc.geom.bernstein import Array
from shotc.geom.pieces import Mask

Index = NDArray[np.intp]

ROUNDING_TOLERANCE = 1e-12
"""Distance below which a direction is arbitrary."""
REACH_RATIO = 1.5
"""Distance, in units of the separation, from which on a pair asks for nothing. A motion that is found without
such a pair is judged by it in the next round.
"""


NEARLY_APART_SHARE = 0.99
"""Distance, in units of the separation, above which a motion is nearly free. Two drones that lack a share of
the separation in the middle between two times are kept apart by that share more at both times.
"""


class CylinderPlanes(NamedTuple):
    """Half-planes normal . (a, b) >= 1 at times of a motion.

    at : number of the time of each, shape (R,)
    normals : shape (R, 2)
    upright : whether a and b are the scalars of the heights, shape (R,)
    least : the least distance of two drones at these times, at most ``REACH_RATIO``
    """

    at: Index
    normals: Array
    upright: Mask
    least: float


def cylinder_planes(before: Array, after: Array, scalars: Array) -> CylinderPlanes:
    """Return the half-planes that keep all pairs apart about a motion.

    before, after : positions, shape (n, 3), heights scaled, in units of the separation
    scalars : a, b and those of the heights at rising times, shape (2 T + 1, 4). The even rows are the times
        of the half-planes. Between two of them a pair is apart either across or upright, at both: a pair that
        changed in between would be apart in neither. It is the one of which the smaller distance at the two
        times is larger: a motion that keeps the half-planes of another keeps those of its own, too. Where the
        pair is a little too near in the odd row, both half-planes are moved outwards by what it lacks.
    """
    motion = _FleetMotion(before, after, scalars)
    normals_of: list[list[list[Array]]] = [[[], []] for _ in scalars[::2]]
    least = REACH_RATIO
    for middle in range(1, len(scalars), 2):
        gaps = motion.gaps(middle)
        across, along = np.stack(
            [gaps.distances(scalars[k]) for k in (middle - 1, middle, middle + 1)], axis=1
        )
        least = min(least, float(np.maximum(across, along).min(initial=REACH_RATIO)))
        flat = across[::2].min(axis=0) >= along[::2].min(axis=0)
        apart = np.where(flat, across[1], along[1])
        share = np.where(apart > NEARLY_APART_SHARE, np.minimum(apart, 1.0), 1.0)[:, None]
        for time in (middle - 1, middle + 1):
            normals = normals_of[time // 2]
            normals[0].append(share[flat] * gaps.of(flat).normals(scalars[time], slice(0, 2)))
            normals[1].append(share[~flat] * gaps.of(~flat).normals(scalars[time], slice(2, 3)))
    rows = [
        (time, upright, _needed(np.concatenate(both[upright])))
        for time, both in enumerate(normals_of)
        for upright in (0, 1)
    ]
    count = [len(normals) for _, _, normals in rows]
    return CylinderPlanes(
        np.repeat(np.array([time for time, _, _ in rows], dtype=np.intp), count),
        np.concatenate([normals for _, _, normals in rows]),
        np.repeat(np.array([bool(upright) for _, upright, _ in rows]), count),
        least,
    )


def least_before_and_after(before: Array, after: Array) -> float:
    """Return the least distance of two drones in two formations (n, 3), at most 1."""
    motion = _FleetMotion(before, after, np.array([[1.0, 0.0, 1.0, 0.0], [0.0, 1.0, 0.0, 1.0]]))
    return min(
        float(np.maximum(*motion.gaps(k).distances(motion.scalars[k])).min(initial=1.0)) for k in (0, 1)
    )


@dataclass(frozen=True, slots=True, eq=False)
class _FleetMotion:
    """Positions of all drones by their scalars; the arguments of ``cylinder_planes``."""

    before: Array
    after: Array
    scalars: Array

    def gaps(self, time: int) -> _Gaps:
        """Return the pairs that are within reach of each other at a time."""
        places = _at(self.scalars[time], self.before, self.after)
        pairs = cKDTree(places).query_pairs(REACH_RATIO, p=np.inf, output_type="ndarray")
        return _Gaps(*(p[pairs[:, 0]] - p[pairs[:, 1]] for p in (self.before, self.after)))


class _Gaps(NamedTuple):
    """One drone of each pair from the other: r0 before the move and r1 after it, shape (P, 3) each."""

    before: Array
    after: Array

    def of(self, some: Mask) -> _Gaps:
        """Return some of the pairs."""
        return _Gaps(self.before[some], self.after[some])

    def distances(self, row: Array) -> tuple[Array, Array]:
        """Return the horizontal and the vertical distance, shape (P,) each, for scalars (4,)."""
        gap = _at(row, *self)
        return np.hypot(gap[:, 0], gap[:, 1]), np.abs(gap[:, 2])

    def normals(self, row: Array, axes: slice) -> Array:
        """Return (n.r0, n.r1) for the direction n of each pair in some axes, shape (P, 2)."""
        n = _at(row, *self)[:, axes]
        n = n / np.maximum(np.linalg.norm(n, axis=1), ROUNDING_TOLERANCE)[:, None]
        return np.stack([np.einsum("pd,pd->p", n, r[:, axes]) for r in self], axis=1)


def _at(row: Array, before: Array, after: Array) -> Array:
    """Return positions or gaps, shape (P, 3), for scalars (4,)."""
    return np.asarray(before * row[[0, 0, 2]] + after * row[[1, 1, 3]])


def _needed(normals: Array) -> Array:
    """Return the normals (K, 2) that imply all others for scalars that are not negative."""
    normals = normals[np.lexsort((normals[:, 1], normals[:, 0]))]
    lower = normals[:, 1] < np.minimum.accumulate(np.append(np.inf, normals[:, 1]))[:-1]
    hull: list[Array] = []
    for point in normals[lower]:
        while len(hull) > 1 and _above(hull[-2], hull[-1], point):
            hull.pop()
        hull.append(point)
    return np.array(hull).reshape(-1, 2)


def _above(a: Array, b: Array, c: Array) -> bool:
    """Return whether b is on or above the line from a to c."""
    return bool((b[0] - a[0]) * (c[1] - a[1]) <= (b[1] - a[1]) * (c[0] - a[0]))
