"""Moves of a fleet on elliptic arcs (``geom.arcs``) with one common clock, as fast as the limits allow.

Every drone is at c + a(t) (x_i - c) + b(t) (g_i - c). (a, b) is a cubic B-spline of uniform pieces, whose
control points are on a free path (``geom.arcs``, ``geom.least_size``), moved outwards. The position along the
path is a profile of ``solvers.move`` over a time variable of its own. That variable advances by the need of
the busiest drone at each point: the root of the sum of squares of its speed's share and of the time that its
acceleration takes. Velocity, acceleration and jerk of every drone are linear in (a, b), so differences of
control points bound them at every time, as for straight moves.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import inf
from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array
from shotc.ir.limits import Limits
from shotc.ir.show import Easing
from shotc.show.geom.arcs import FreeRegion, angles
from shotc.show.solvers.move import LEAST_PIECE_S, LIMIT_SHARE, TICK_S, WORTH_RATIO, family

PIECES = (12, 16, 20, 24, 32, 40)
"""Possible numbers of pieces of a move."""
PROFILE_STRIDE = 3
"""Stride of the tried profiles in the family."""
ASKED_SHARE = 1.5
"""Acceleration allowed to a point of the path, in shares of the limit; the profile takes the rest."""
SMOOTHED_SHARE = 0.04
"""Share of the path over which the need is smoothed, so that corners of the path do not cause jerk."""
DIRECTION_COUNT = 16
"""Directions of (a, b) in which the busiest drones are searched for."""
LACK_SHARE = 1e-4
"""Share of the distance that a spline may lack: a fifth of the margin with which moves are requested."""

BINDS = ("speed", "climb", "descent", "acceleration", "jerk")


class BindingLimit(NamedTuple):
    """What limits a move: the least duration of a piece, seconds, the row of the drone, and the limit."""

    piece: float
    drone: int
    limit: str

    @property
    def ticks(self) -> float:
        """Return the duration of a piece, rounded up to what plans are written in, s."""
        return float(np.ceil(self.piece / TICK_S) * TICK_S)


@dataclass(frozen=True, slots=True, eq=False)
class ArcMove:
    """A common move on arcs.

    ctrl : control points of (a, b), shape (P + 3, 2), the first three (1, 0) and the last three (0, 1)
    heights : those of the scalars of the heights, shape (P + 3, 2); the same unless ``solvers.own_heights``
        found better ones
    pivot : the point c, shape (3,), m
    piece : duration of each of the P pieces, s
    limit : name in ``ir.limits.Limits`` of the active limit
    drone : row of the drone for which it is active
    """

    ctrl: Array
    heights: Array
    pivot: Array
    piece: float
    limit: str
    drone: int

    @property
    def duration(self) -> float:
        """Return the time from rest to rest, s."""
        return self.piece * self.pieces

    @property
    def pieces(self) -> int:
        """Return the number of pieces."""
        return len(self.ctrl) - 3

    @property
    def scalars(self) -> Array:
        """Return the control points of (a, b) for each axis, shape (P + 3, 2, 3)."""
        return np.stack([self.ctrl, self.ctrl, self.heights], axis=-1)

    def between(self, starts: Array, goals: Array) -> list[Array]:
        """Return the control points between the two formations, shape (n, 3) each."""
        away, there = starts - self.pivot, goals - self.pivot
        return [self.pivot + a * away + b * there for a, b in self.scalars[3:-3]]


def fastest_arc(
    ends: tuple[Array, Array],
    pivot: Array,
    free: FreeRegion,
    limits: Limits,
    pace: float,
    easing: Easing = "ease-in-out",
) -> ArcMove:
    """Return the shortest move of an easing that is found, within every limit times ``pace`` for all drones.

    ends : positions before and after, shape (n, 3) each
    pivot : the point c, shape (3,)
    free : the allowed region of (a, b)
    """
    drones = Drones.of(ends, pivot, limits, pace)
    busy = drones.busiest()
    ctrl = _shortest(busy, free, easing)
    least = float(free.least_share(ctrl))
    if least < 1.0:
        ctrl = np.concatenate([ctrl[:3], ctrl[3:-3] / least, ctrl[-3:]])
    binding = drones.binding(ctrl)
    return ArcMove(ctrl, ctrl, pivot, binding.ticks, binding.limit, binding.drone)


def _shortest(busy: Drones, free: FreeRegion, easing: Easing) -> Array:
    """Return the control points of (a, b), shape (K, 2), of the fastest move."""
    best, shortest = (1.0, inf), np.zeros((0, 2))
    for line in free.ways():
        at = times_of(busy, line)
        share = np.linspace(0.0, 1.0, len(line))
        for pieces in PIECES:
            shapes = family(pieces, easing)[0][::PROFILE_STRIDE]
            if not len(shapes):
                continue
            along = np.interp(shapes, at, share)
            ctrl = np.stack([np.interp(along, share, line[:, k]) for k in range(2)], axis=-1)
            ctrl = free.pushed_out(ctrl)
            seconds = pieces * busy.least_pieces(ctrl)
            # A move that is not free is used only if none is free: the one that lacks least.
            lacks = np.maximum(1.0 - LACK_SHARE - free.least_share(ctrl), 0.0)
            k = int(np.lexsort((seconds, lacks))[0])
            if (lacks[k], float(seconds[k]) * WORTH_RATIO) < best:
                best, shortest = (float(lacks[k]), float(seconds[k])), ctrl[k]
    return shortest


def times_of(busy: Drones, line: Array, height: Array | None = None) -> Array:
    """Return the share of the busiest drone's time up to each point of a path (N, 2), shape (N,).

    height : additional height of all drones, shape (N,), m
    """
    step = 1.0 / (len(line) - 1)
    whole = np.column_stack([line, np.zeros(len(line)) if height is None else height])
    rate = np.gradient(whole, step, axis=0)
    bend = np.gradient(rate, step, axis=0)
    speeds = busy.shares(rate[:, :2], 1, rate[:, 2])
    needs = np.hypot(speeds, np.sqrt(busy.shares(bend[:, :2], 2, bend[:, 2]) / ASKED_SHARE))
    wide = max(1, round(SMOOTHED_SHARE * len(line)))
    padded = np.pad(needs, wide, mode="edge")
    smooth = np.convolve(padded, np.ones(2 * wide + 1), mode="valid")  # only ratios matter
    smooth = np.maximum(smooth, 1e-9 + 1e-6 * float(smooth.max()))
    passed = np.concatenate([[0.0], np.cumsum(0.5 * (smooth[1:] + smooth[:-1]))])
    return np.asarray(passed / passed[-1])


class MotionLimits(NamedTuple):
    """Limits of a drone, SI."""

    speed: float
    climb: float
    descent: float
    acceleration: float
    jerk: float


@dataclass(frozen=True, slots=True, eq=False)
class Drones:
    """Drones, each at the sum of its parts times scalars that all have in common, and their limits.

    parts : shape (n, 3) each, m; of a move with two scalars, start and end relative to the pivot
    """

    parts: tuple[Array, ...]
    ceilings: MotionLimits

    @staticmethod
    def of(ends: tuple[Array, Array], pivot: Array, limits: Limits, pace: float) -> Drones:
        """Return the drones of two formations, shape (n, 3) each, with a share of every limit."""
        scale = LIMIT_SHARE * pace
        most = (limits.speed, limits.climb, limits.descent, limits.usable_acceleration, limits.jerk)
        return Drones((ends[0] - pivot, ends[1] - pivot), MotionLimits(*(scale * m for m in most)))

    def busiest(self) -> Drones:
        """Return the drones of which one is always the busiest, whatever the path; the others are never
        limiting.
        """
        busy: set[int] = set()
        for a, b in angles(DIRECTION_COUNT):
            rates = a * self.parts[0] + b * self.parts[1]
            level = np.einsum("nd,nd->n", rates[:, :2], rates[:, :2])
            whole = level + rates[:, 2] ** 2
            busy |= {int(level.argmax()), int(whole.argmax())}
            busy |= {int(rates[:, 2].argmax()), int(rates[:, 2].argmin())}
        return self.of_rows(sorted(busy))

    def of_rows(self, rows: list[int]) -> Drones:
        """Return the drones of some rows."""
        return Drones(tuple(part[rows] for part in self.parts), self.ceilings)

    def with_own_heights(self) -> Drones:
        """Return the drones of a move with two scalars by four: of (a, b), and of the heights' own (a, b)."""
        level, upright = np.array([1.0, 1.0, 0.0]), np.array([0.0, 0.0, 1.0])
        return Drones(tuple(part * axes for axes in (level, upright) for part in self.parts), self.ceilings)

    def busiest_on(self, rates: Array, order: int) -> set[int]:
        """Return the rows of the drones that need the largest share of a limit for one of some derivatives,
        (N, S).
        """
        return set(self._shares(rates, order).argmax(axis=1).ravel().tolist())

    def shares(self, rates: Array, order: int, rising: Array | None = None) -> Array:
        """Return the largest share of a limit that a derivative of the scalars, shape (..., S), needs for
        any drone.

        rising : the same derivative of an additional height, shape (...)
        """
        return np.asarray(self._shares(rates, order, rising).max(axis=(-2, -1)))

    def least_pieces(self, ctrl: Array, lift: Array | None = None) -> Array:
        """Return the least duration of a piece for control points (..., K, S), s.

        lift : control points (..., K) of an additional height of all drones, m
        """
        least = np.full(ctrl.shape[:-2], LEAST_PIECE_S)
        for order in (1, 2, 3):
            rates = np.diff(ctrl, order, axis=-2)
            rising = None if lift is None else np.diff(lift, order, axis=-1)
            most = self.shares(rates, order, rising).max(axis=-1)
            least = np.maximum(least, most ** (1.0 / order))
        return np.asarray(least)

    def binding(self, ctrl: Array, lift: Array | None = None) -> BindingLimit:
        """Return what limits a move with control points (K, 2).

        lift : as in ``least_pieces``, shape (K,)
        """
        best = BindingLimit(LEAST_PIECE_S, 0, BINDS[0])
        height = np.zeros(len(ctrl)) if lift is None else lift
        for order in (1, 2, 3):
            rising = np.diff(height, order)
            for rate, climb in zip(np.diff(ctrl, order, axis=0), rising, strict=True):
                shares = self._shares(rate, order, climb)
                drone, which = (int(k) for k in np.unravel_index(int(shares.argmax()), shares.shape))
                seconds = float(shares[drone, which]) ** (1.0 / order)
                if seconds > best.piece:
                    limit = BINDS[which] if order == 1 else BINDS[order + 1]
                    best = BindingLimit(seconds, drone, limit)
        return best

    def _shares(self, rates: Array, order: int, rising: Array | None = None) -> Array:
        """Return shares of limits, shape (..., n, 3) for speeds and (..., n, 1) for higher derivatives.

        rising : the same derivative of an additional height of all drones, shape (...), m
        """
        moved = rates[..., None, :1] * self.parts[0]
        for k, part in enumerate(self.parts[1:], 1):
            moved += rates[..., None, k : k + 1] * part
        if rising is not None:
            moved[..., 2] += np.asarray(rising)[..., None]
        if order == 1:
            across = np.sqrt(moved[..., 0] ** 2 + moved[..., 1] ** 2)
            up = moved[..., 2]
            most = self.ceilings
            return np.stack([across / most.speed, up / most.climb, -up / most.descent], axis=-1)
        bound = self.ceilings.acceleration if order == 2 else self.ceilings.jerk
        return np.asarray(np.sqrt(np.einsum("...d,...d->...", moved, moved))[..., None] / bound)
