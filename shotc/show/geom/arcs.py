"""The way of a whole fleet between two formations: elliptic arcs on which no two come too near.

Everybody moves as p_i = c + a (x_i - c) + b (g_i - c), with scalars a, b >= 0 that are the same for all, from
(1, 0) to (0, 1), about any common point c. Matched so that (x_i - x_j).(g_i - g_j) >= 0 (``solvers.match``),
two drones at r0 from each other before and r1 after keep

    |p_i - p_j|^2 = a^2 |r0|^2 + b^2 |r1|^2 + 2 a b r0.r1 >= a^2 d0^2 + b^2 d1^2

with d0, d1 the least distances before and after. So no two are nearer than d as long as (a, b) stays outside
the ellipse (a d0 / d)^2 + (b d1 / d)^2 = 1: in the coordinates (a d0 / d, b d1 / d), outside the unit circle.
The shortest way there is straight to the circle, along it, and straight off it; it touches at acos(d / d0)
and acos(d / d1) from the axes. Where these meet the way a + b = 1 is free: 1 / d0^2 + 1 / d1^2 <= 1 / d^2.

A formation may be tighter than d where what drones keep free is no ball but lies in one, as a cylinder does.
Its outside is star-shaped, so formations grow and shrink along the axes, where b = 0 or a = 0, and turn
from them only outside the circle.
"""

from __future__ import annotations

from math import acos, cos, pi, sin
from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array

STEPS = 1500
"""Points of a way; an arc is off them by a ten-millionth of its radius, which ``pushed_out`` makes good."""
WIDEST_RAD = pi / 4
"""Angle beyond which control points are not pushed out further: no way that is flown has such steps."""
ROUNDING = 1e-9


class Gaps(NamedTuple):
    """Least distances of two drones before and after a move, in shares of the distance to be kept."""

    before: float
    after: float


def straight_enough(gaps: Gaps) -> bool:
    """Tell whether straight ways, on which a + b = 1, keep the distance."""
    return 1.0 / gaps.before**2 + 1.0 / gaps.after**2 <= 1.0 + ROUNDING


def way(gaps: Gaps, corner: float) -> Array:
    """Return (a, b) along the shortest way, evenly in (a d0, b d1), shape (STEPS + 1, 2).

    corner : share by which formations tighter than the distance grow beyond it, to turn outside the circle
    """
    if straight_enough(gaps):
        ends = np.array([[gaps.before, 0.0], [0.0, gaps.after]])
        return _even(ends, gaps)
    first, last = (gap if gap >= 1.0 else 1.0 + corner for gap in gaps)
    touching, leaving = acos(1.0 / first), pi / 2.0 - acos(1.0 / last)
    if touching < leaving:
        angles = np.linspace(touching, leaving, STEPS)
        arc = np.column_stack([np.cos(angles), np.sin(angles)])
    else:
        arc = np.zeros((0, 2))  # the tangents of two grown formations meet before the circle
    corners = [np.array([p]) for p in ([gaps.before, 0.0], [first, 0.0], [0.0, last], [0.0, gaps.after])]
    return _even(np.concatenate([*corners[:2], arc, *corners[2:]]), gaps)


def _even(line: Array, gaps: Gaps) -> Array:
    length = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))])
    at = np.linspace(0.0, length[-1], STEPS + 1)
    return np.column_stack([np.interp(at, length, line[:, k]) / gaps[k] for k in range(2)])


def pushed_out(ctrl: Array, gaps: Gaps) -> Array:
    """Return control points (..., K, 2) of (a, b) moved out, so that their splines stay outside, too.

    Each goes to 1 / cos of the larger angle to a neighbour: then the lines between neighbours do not enter
    the circle. Those on the axes stay.
    """
    shares = ctrl * np.array(gaps)
    angle = np.arctan2(shares[..., 1], shares[..., 0])
    step = np.diff(angle, axis=-1)
    wide = np.minimum(np.maximum(step[..., 1:], step[..., :-1]), WIDEST_RAD)
    far = np.hypot(shares[..., 1:-1, 0], shares[..., 1:-1, 1])
    turned = (shares[..., 1:-1, :] > 0.0).all(axis=-1)
    factor = np.where(turned, np.maximum(1.0, 1.0 / (np.cos(wide) * far)), 1.0)
    pushed = ctrl.copy()
    pushed[..., 1:-1, :] *= factor[..., None]
    return pushed


def least_share(ctrl: Array, gaps: Gaps, samples: int = 24) -> float:
    """Return how near (a d0, b d1) comes to 0 on a spline of control points (K, 2), in shares of the
    distance.

    On the axes a formation only grows or shrinks, which counts where it is tighter at its end than there.
    """
    u = np.linspace(0.0, 1.0, samples + 1)[:, None]
    basis = np.hstack([(1 - u) ** 3, 3 * u**3 - 6 * u**2 + 4, 3 * (u + 3 * u**2) - 3 * u**3 + 1, u**3]) / 6.0
    windows = np.lib.stride_tricks.sliding_window_view(ctrl * np.array(gaps), 4, axis=0)
    at = np.einsum("uk,pdk->pud", basis, windows)
    size = np.sqrt(np.einsum("pud,pud->pu", at, at))
    for axis in range(2):
        still = (windows[:, 1 - axis] == 0.0).all(axis=1)
        size[still] = np.where(at[still, :, axis] >= min(1.0, gaps[axis]) - ROUNDING, 1.0, size[still])
    return float(size.min())


def angles(count: int) -> Array:
    """Return directions (count, 2) of the derivatives of (a, b), of which the opposite count as the same."""
    return np.array([[cos(pi * k / count), sin(pi * k / count)] for k in range(count)])
