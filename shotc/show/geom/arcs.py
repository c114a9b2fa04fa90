"""Moves of a whole fleet between two formations on elliptic arcs that keep the separation.

Every drone moves as p_i = c + a (x_i - c) + b (g_i - c), with scalars a, b >= 0 that are common to all, from
(1, 0) to (0, 1), about any common point c. If the matching gives (x_i - x_j).(g_i - g_j) >= 0
(``solvers.match``), two drones at r0 from each other before and r1 after keep

 |p_i - p_j|^2 = a^2 |r0|^2 + b^2 |r1|^2 + 2 a b r0.r1 >= a^2 d0^2 + b^2 d1^2

with d0, d1 the least distances before and after. So no two are nearer than d while (a, b) is outside the
ellipse (a d0 / d)^2 + (b d1 / d)^2 = 1. In the coordinates (a d0 / d, b d1 / d) it is the unit circle.

The shortest path is a tangent to the circle, an arc along it, and a tangent from it. It touches the circle at
acos(d / d0) and acos(d / d1) from the axes. If these angles meet, the straight path a + b = 1 is free: 1 /
d0^2 + 1 / d1^2 <= 1 / d^2.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from math import acos, cos, pi, sin
from typing import NamedTuple, Protocol

import numpy as np

from shotc.geom.bernstein import Array

WAY_POINTS = 1500
"""Points of a path. The error of an arc is a ten-millionth of its radius, which ``pushed_out``
compensates.
"""
WIDEST_RAD = pi / 4
"""Angle, above which control points are not pushed out further; no flown path has such steps."""
ROUNDING_TOLERANCE = 1e-9
PIECE_SAMPLES = 24
"""Parts of a spline's piece, at whose ends it is sampled."""


class FreeRegion(Protocol):
    """The region of (a, b) in which no two drones come too near."""

    def ways(self) -> Iterator[Array]:
        """Yield (a, b) along paths from (1, 0) to (0, 1), uniformly spaced, (N, 2), the shortest
        path first.
        """
        ...

    def pushed_out(self, ctrl: Array) -> Array:
        """Return control points (..., K, 2) of (a, b) moved outwards, so that their splines are free, or
        nearly so.
        """
        ...

    def least_share(self, ctrl: Array) -> Array:
        """Return the least radius of splines with control points (..., K, 2), over that at which they are
        free.
        """
        ...


class Gaps(NamedTuple):
    """Least distances of two drones before and after a move, over the separation; both are at least 1.

    (a, b) is free outside the ellipse.
    """

    before: float
    after: float

    @property
    def straight(self) -> bool:
        """Return whether the straight path a + b = 1 keeps the separation."""
        return 1.0 / self.before**2 + 1.0 / self.after**2 <= 1.0 + ROUNDING_TOLERANCE

    def ways(self) -> Iterator[Array]:
        """Yield (a, b) along the shortest path alone, which has no corners, shape (STEPS + 1, 2)."""
        corners = np.array([[self.before, 0.0], [0.0, self.after]])
        if not self.straight:
            angles = np.linspace(acos(1.0 / self.before), pi / 2.0 - acos(1.0 / self.after), WAY_POINTS)
            corners = np.insert(corners, 1, np.column_stack([np.cos(angles), np.sin(angles)]), axis=0)
        yield np.asarray(evenly(corners) / np.array(self))

    def pushed_out(self, ctrl: Array) -> Array:
        """Return control points (..., K, 2) of (a, b) moved outwards, so that their splines stay outside as
        well.

        Each goes to 1 / cos of the larger angle to a neighbour. Then the lines between neighbours do not
        enter the circle. Points on the axes do not move.
        """
        shares = ctrl * np.array(self)
        angle = np.arctan2(shares[..., 1], shares[..., 0])
        step = np.diff(angle, axis=-1)
        wide = np.minimum(np.maximum(step[..., 1:], step[..., :-1]), WIDEST_RAD)
        far = np.hypot(shares[..., 1:-1, 0], shares[..., 1:-1, 1])
        turned = (shares[..., 1:-1, :] > 0.0).all(axis=-1)
        factor = np.where(turned, np.maximum(1.0, 1.0 / (np.cos(wide) * far)), 1.0)
        pushed = ctrl.copy()
        pushed[..., 1:-1, :] *= factor[..., None]
        return pushed

    def least_share(self, ctrl: Array) -> Array:
        """Return the least size of (a d0, b d1) on splines with control points (..., K, 2), over the
        separation.
        """
        a, b = sampled(ctrl * np.array(self), PIECE_SAMPLES)
        return np.asarray(np.hypot(a, b).min(axis=(-2, -1)))


def evenly(line: Array) -> Array:
    """Return uniformly spaced points along a polygonal line (M, 2), shape (STEPS + 1, 2)."""
    length = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))])
    at = np.linspace(0.0, length[-1], WAY_POINTS + 1)
    return np.column_stack([np.interp(at, length, line[:, k]) for k in range(2)])


def sampled(ctrl: Array, parts: int) -> tuple[Array, Array]:
    """Return a and b of uniform cubic B-splines at the ends of parts of each piece, shape (..., K - 3, parts
    + 1) each.

    ctrl : control points, shape (..., K, 2)
    """
    weights = basis(parts)
    windows = np.lib.stride_tricks.sliding_window_view(ctrl, 4, axis=-2)
    return windows[..., 0, :] @ weights, windows[..., 1, :] @ weights


def basis(parts: int) -> Array:
    """Return the weights of the four control points of a piece of a uniform cubic B-spline, at the ends of
    its parts, shape (4, parts + 1).
    """
    u = np.linspace(0.0, 1.0, parts + 1)
    return np.stack([(1 - u) ** 3, 3 * u**3 - 6 * u**2 + 4, 3 * (u + u**2) - 3 * u**3 + 1, u**3]) / 6.0


@cache
def basis_at_starts(parts: int) -> Array:
    """Return ``basis`` at the start of each part of a piece, shape (parts, 4)."""
    return np.ascontiguousarray(basis(parts)[:, :-1].T)


def angles(count: int) -> Array:
    """Return directions (count, 2) of the derivatives of (a, b); opposite directions are equivalent."""
    return np.array([[cos(pi * k / count), sin(pi * k / count)] for k in range(count)])
