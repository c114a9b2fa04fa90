"""Moves of a fleet on which all rise alike over what lies between two formations.

Everybody is at c + a(t) (x_i - c) + b(t) (g_i - c) + h(t) up: on straight ways (a + b = 1) or on arcs
(``geom.arcs``), and h(t) higher. All rise by the same, so nobody comes nearer to anybody than without it. h
is a cubic B-spline of even pieces that is, at every place on the way, as high as something asks for there.

The height goes with the way: it follows the concave hull of what is needed there, and the way is passed in
the time that the busiest drone needs, as on arcs. Of some that are smoothed more or less, and of some
profiles of speed, the one is taken with which all are there first.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cache
from math import inf
from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.pieces import Mask
from shotc.ir.limits import Limits
from shotc.ir.show import Easing
from shotc.show.geom.arcs import Free
from shotc.show.solvers.arc_move import LACK_SHARE, Drones, times_of
from shotc.show.solvers.move import LEAST_PIECE_S, TICK_S, family

PIECES = (16, 24, 32, 40)
"""Pieces that a move may have that is lifted."""
EVERY = 12
"""Profiles of the family that are tried, one in so many."""
STEP_M = 1.0
"""Metres from place to place of the longest way at which it is asked how high the fleet has to be."""
FEWEST, MOST = 33, 257
"""Places of a way at which that is asked, at least and at most."""
STEPS = 600
"""Places of a way that its height goes with."""
WIDTHS = (0.0, 0.02, 0.05, 0.1)
"""Shares of the way on either side over which its height is smoothed."""
SAMPLES = 4
"""Places a piece at which the height is held to what is asked for there."""
LEAST_M = 1e-3
"""Metres below which nobody has to rise: what is placed as low as it may be is there within a rounding."""
BEYOND_M = 0.02
"""By how much more than is asked for the fleet rises, metres."""


@dataclass(frozen=True, slots=True, eq=False)
class LiftedMove:
    """A common move on which all rise alike.

    ctrl : control points of (a, b), shape (P + 3, 2), the first three (1, 0) and the last three (0, 1)
    pivot : the point c, shape (3,), metres, of no account on straight ways
    lift : control points of the height, shape (P + 3,), the first three and the last three 0, metres
    piece : seconds that each of the P pieces takes
    limit : name in ``ir.limits.Limits`` of what binds; drone : whom it binds, a row
    """

    ctrl: Array
    pivot: Array
    lift: Array
    piece: float
    limit: str
    drone: int

    @property
    def duration(self) -> float:
        """Return seconds from rest to rest."""
        return self.piece * self.pieces

    @property
    def pieces(self) -> int:
        """Return the number of pieces."""
        return len(self.ctrl) - 3

    @property
    def height(self) -> float:
        """Return by how much the fleet rises at most, metres."""
        return float(self.lift.max())

    def between(self, starts: Array, goals: Array) -> list[Array]:
        """Return the control points between the two formations, shape (n, 3) each."""
        away, there, up = starts - self.pivot, goals - self.pivot, np.array([0.0, 0.0, 1.0])
        rows = zip(self.ctrl[3:-3], self.lift[3:-3], strict=True)
        return [self.pivot + a * away + b * there + h * up for (a, b), h in rows]


class Rise(NamedTuple):
    """How much higher a fleet has to be along its way: need (T,), metres, at shares of it, (T,), rising."""

    share: Array
    need: Array

    def at(self, share: Array) -> Array:
        """Return what is needed at other shares, of any shape."""
        return np.interp(share, self.share, self.need)


class Course(NamedTuple):
    """Where (a, b) of a move may go: about which point, and on which arcs, None for straight ways."""

    pivot: Array
    arcs: Free | None = None

    def ways(self) -> Iterator[Array]:
        """Yield (a, b) along ways from (1, 0) to (0, 1), evenly spaced, (N, 2)."""
        if self.arcs is None:
            yield np.array([[1.0, 0.0], [0.0, 1.0]])
        else:
            yield from self.arcs.ways()

    def pushed_out(self, ctrl: Array) -> Array:
        """Return control points (..., K, 2) of which splines are free, or nearly."""
        return ctrl if self.arcs is None else self.arcs.pushed_out(ctrl)

    def free(self, ctrl: Array) -> Mask:
        """Tell of which control points (M, K, 2) the splines are free, or nearly, (M,)."""
        if self.arcs is None:
            return np.ones(len(ctrl), dtype=bool)
        return np.asarray(self.arcs.least_share(ctrl) >= 1.0 - LACK_SHARE)

    def kept(self, ctrl: Array) -> Array:
        """Return control points (K, 2) of which the spline is free."""
        least = 1.0 if self.arcs is None else float(self.arcs.least_share(ctrl))
        return ctrl if least >= 1.0 else np.concatenate([ctrl[:3], ctrl[3:-3] / least, ctrl[-3:]])


def sampled(ctrl: Array) -> Array:
    """Return a spline at even places of every piece, shape (P * SAMPLES,); ctrl : shape (P + 3,)."""
    windows = np.lib.stride_tricks.sliding_window_view(ctrl, 4)
    return np.asarray((windows @ _basis().T).ravel())


def lifted(
    ends: tuple[Array, Array],
    course: Course,
    need: Callable[[Array], Array],
    drive: tuple[Limits, float, Easing],
) -> LiftedMove | None:
    """Return the shortest move found that rises as is needed; None where no height is enough.

    ends : places before and after, shape (n, 3) each; course : where (a, b) may go
    need : from places (a, b), shape (T, 2), to how much higher the fleet has to be there, metres, shape (T,)
    drive : the limits, the share of them that is used, and how the speed runs
    """
    limits, pace, easing = drive
    drones = Drones.of(ends, course.pivot, limits, pace)
    busy = drones.busiest()
    far = float(np.linalg.norm(ends[1] - ends[0], axis=1).max())
    best = LiftedShape(np.zeros((0, 2)), np.zeros(0), inf)
    for way in course.ways():
        share = np.linspace(0.0, 1.0, int(np.clip(far / STEP_M, FEWEST, MOST)))
        at = np.column_stack([np.interp(share, np.linspace(0.0, 1.0, len(way)), way[:, k]) for k in range(2)])
        rise = Rise(share, need(at))
        if not np.isfinite(rise.need).all():
            continue
        for line in _lines(far, rise):
            best = min(best, _fastest(busy, course, (at, line, rise), easing), key=lambda one: one.seconds)
    if not np.isfinite(best.seconds):
        return None
    ctrl = course.kept(best.ctrl)
    piece, drone, limit = drones.binding(ctrl, best.lift)
    piece = max(piece, LEAST_PIECE_S)
    return LiftedMove(ctrl, course.pivot, best.lift, float(np.ceil(piece / TICK_S) * TICK_S), limit, drone)


class LiftedShape(NamedTuple):
    """Control points of (a, b), shape (K, 2), and of the height, (K,), and how many seconds they take."""

    ctrl: Array
    lift: Array
    seconds: float


def _fastest(busy: Drones, course: Course, of: tuple[Array, Array, Rise], easing: Easing) -> LiftedShape:
    """Return the fastest move along a way; of : (a, b) at its shares, its line, and what is needed on it."""
    at, line, rise = of
    along_way = np.column_stack([np.interp(line[:, 0], rise.share, at[:, k]) for k in range(2)])
    times = times_of(busy, along_way, line[:, 1])
    passed = np.linspace(0.0, 1.0, len(line))
    best = LiftedShape(np.zeros((0, 2)), np.zeros(0), inf)
    for pieces in PIECES:
        shapes = family(pieces, easing)[0][::EVERY]
        if not len(shapes):
            continue
        along = np.interp(shapes, times, passed)
        share, height = (np.interp(along, passed, line[:, k]) for k in range(2))
        ctrl = np.stack([np.interp(along, passed, along_way[:, k]) for k in range(2)], axis=-1)
        ctrl = course.pushed_out(ctrl)
        times_higher = np.array([_enough(h, rise.at(sampled(s))) for s, h in zip(share, height, strict=True)])
        able = np.isfinite(times_higher) & course.free(ctrl)
        if not able.any():
            continue
        lift = height[able] * times_higher[able, None]
        least = busy.least_pieces(ctrl[able], lift)
        k = int(least.argmin())
        found = LiftedShape(ctrl[able][k], lift[k], float(least[k]) * pieces)
        best = min(best, found, key=lambda one: one.seconds)
    return best


def _lines(far: float, rise: Rise) -> Iterator[Array]:
    """Yield shares of the way and heights, evenly along what is flown, shape (STEPS + 1, 2).

    far : metres that whoever goes farthest has to go
    What goes down only to come up again takes longer than what stays up: the heights are concave.
    """
    hull = _concave(rise.share, rise.need)
    passed = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(rise.share) * far, np.diff(hull)))])
    even = np.linspace(0.0, passed[-1], STEPS + 1)
    share, height = np.interp(even, passed, rise.share), np.interp(even, passed, hull)
    for width in WIDTHS:
        half = round(width * STEPS)
        kernel = np.ones(2 * half + 1) / (2 * half + 1)
        smooth = np.column_stack(
            [np.convolve(np.pad(c, half, mode="edge"), kernel, mode="valid") for c in (share, height)]
        )
        # Smoothed, it still begins and ends where it did.
        smooth[0], smooth[-1] = (0.0, 0.0), (1.0, 0.0)
        yield smooth


def _enough(height: Array, need: Array) -> float:
    """Return how many times as high control points (K,) have to be, infinite where that does not help.

    need : at the places of ``sampled``, shape (T,), metres
    """
    asked = need > LEAST_M
    if not asked.any():
        return 1.0
    with np.errstate(divide="ignore", invalid="ignore"):
        return float(((need[asked] + BEYOND_M) / sampled(height)[asked]).max())


def _concave(at: Array, values: Array) -> Array:
    """Return the least concave row, from 0 to 0, that is nowhere below values (Andrew 1979); all (T,)."""
    row = values.copy()
    row[0] = row[-1] = 0.0
    corners: list[int] = []
    for k in range(len(row)):
        while len(corners) > 1:
            a, b = corners[-2:]
            if (row[b] - row[a]) * (at[k] - at[a]) > (row[k] - row[a]) * (at[b] - at[a]):
                break
            corners.pop()
        corners.append(k)
    return np.asarray(np.interp(at, at[corners], row[corners]))


@cache
def _basis() -> Array:
    u = (np.arange(SAMPLES) / SAMPLES)[:, None]
    return np.hstack([(1 - u) ** 3, 3 * u**3 - 6 * u**2 + 4, 3 * (u + u**2 - u**3) + 1, u**3]) / 6.0
