"""The moves of a fleet with one scalar clock s(t), from 0 to 1: its shape, and its shortest duration.

Every drone flies straight from x_i to g_i as x_i + s(t) (g_i - x_i), so a bound on s', s'' and s''' bounds
every drone. s is the cubic B-spline of ``geom.fleet_spline`` over uniform pieces; its differences bound its
derivatives at all times. Its control points are samples of a profile with piecewise constant third derivative
(seven stretches). From a family of these, with several numbers of pieces, the fastest is taken: for a given
shape the least duration of a piece has a closed form. The mission's easing selects the family: at which
shares of its time a move has sped up, and starts to slow down.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from itertools import product
from math import inf
from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array
from shotc.ir.limits import Limits
from shotc.ir.show import Easing

PIECES = (8, 12, 16, 20, 32)
"""Possible numbers of pieces of a move."""

WORTH_RATIO = 1.02
"""A move of more pieces must be faster by this factor."""

LEAST_PIECE_S = 0.1
"""Shortest piece: below it, the rounding of control points to a micrometre would show in the jerk."""

LIMIT_SHARE = 0.999
"""Used share of the limits, so that rounding exceeds none."""

TICK_S = 1e-6
"""Unit of the durations of pieces, unless a duration is written."""

EVEN_SHARE = 0.85
"""Least mean speed of a linear move, as a share of its greatest."""
LONG_SHARES = (0.6, 0.65, 0.7, 0.75, 0.8)
"""Shares of its time in which a move slowly speeds up (ease-in) or slows down (ease-out)."""
SHORT_SHARES = (0.1, 0.15, 0.2)
"""Shares of its time for the other, fast ramp."""
JERK_SHARES = (0.25, 0.5, 0.75, 1.0)
"""Shares of a ramp in which the acceleration rises and falls."""


@dataclass(frozen=True, slots=True, eq=False)
class CommonMove:
    """A common move.

    s : control points, shape (P + 3,), the first three 0 and the last three 1
    piece : duration of each of the P pieces, s
    limit : name in ``ir.limits.Limits`` of the active limit
    drone : row of the drone for which it is active
    """

    s: Array
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
        return len(self.s) - 3

    def between(self, starts: Array, goals: Array) -> list[Array]:
        """Return the control points between the two formations, shape (n, 3) each."""
        displacements = goals - starts
        return [starts + share * displacements for share in self.s[3:-3]]


@dataclass(frozen=True, slots=True, eq=False)
class Ceilings:
    """The bounds that each drone's limits put on s', s'' and s''', shape (n,), and the limit of s'."""

    first: Array
    second: Array
    third: Array
    names: list[str]

    @staticmethod
    def of(displacements: Array, limits: Limits, pace: float) -> Ceilings:
        """Return the bounds of every limit times ``pace`` for moves g - x, shape (n, 3), m."""
        across = np.hypot(displacements[:, 0], displacements[:, 1])
        far = np.linalg.norm(displacements, axis=1)
        with np.errstate(divide="ignore"):
            rates = np.stack(
                [
                    limits.speed / across,
                    limits.climb / np.maximum(displacements[:, 2], 0.0),
                    limits.descent / np.maximum(-displacements[:, 2], 0.0),
                ]
            )
            scale = LIMIT_SHARE * pace
            named = ("speed", "climb", "descent")
            return Ceilings(
                scale * rates.min(axis=0),
                scale * limits.usable_acceleration / far,
                scale * limits.jerk / far,
                [named[k] for k in rates.argmin(axis=0)],
            )

    def least(self, steps: Array) -> Array:
        """Return the least unit of time of each shape for all drones together, s, shape (M,).

        steps : (M, 3), its largest derivatives of order 1 to 3 in that unit, or differences that bound them
        """
        first, second, third = (float(c.min()) for c in (self.first, self.second, self.third))
        with np.errstate(divide="ignore"):
            times = [steps[:, 0] / first, np.sqrt(steps[:, 1] / second), np.cbrt(steps[:, 2] / third)]
        return np.asarray(np.max(times, axis=0))

    def binding(self, steps: Array, unit: float) -> tuple[str, int]:
        """Return the active limit of a shape, and the drone for which it is active.

        steps : largest derivatives of the shape, shape (3,)
        unit : its unit of time, s
        """
        limits = (self.first, self.second, self.third)
        tight = [steps[k] / unit ** (k + 1) / float(limits[k].min()) for k in range(3)]
        k = int(np.argmax(tight))
        drone = int(limits[k].argmin())
        return (self.names[drone], "acceleration", "jerk")[k], drone


def fastest(displacements: Array, limits: Limits, pace: float, easing: Easing = "ease-in-out") -> CommonMove:
    """Return the shortest move of an easing that is found, within every limit times ``pace`` for all drones.

    displacements : g - x, shape (n, 3), m
    """
    ceilings = Ceilings.of(displacements, limits, pace)
    best: tuple[float, Array] | None = None
    for pieces in PIECES:
        shapes, steps = family(pieces, easing)
        if not len(shapes):
            continue
        least = np.maximum(ceilings.least(steps), LEAST_PIECE_S)
        # Of equally fast shapes, take the smoothest.
        k = int(np.where(least <= 1.001 * least.min(), steps[:, 2], inf).argmin())
        if best is None or pieces * least[k] * WORTH_RATIO < best[0] * (len(best[1]) - 3):
            best = float(np.ceil(least[k] / TICK_S) * TICK_S), shapes[k]
    assert best is not None
    return CommonMove(best[1], best[0], *ceilings.binding(_steps(best[1][None])[0], best[0]))


def least_piece(pieces: int, displacements: Array, limits: Limits) -> float:
    """Return the least duration of one of ``pieces`` pieces for ``displacements`` (n, 3), seconds."""
    if pieces < 4:
        return inf if np.abs(displacements).max(initial=0.0) > 0.0 else 0.0
    ceilings = Ceilings.of(displacements, limits, 1.0)
    return float(ceilings.least(family(pieces)[1]).min())


def least_pieces(pieces: int, displacements: Array, limits: Limits) -> Array:
    """Return the value of ``least_piece`` for every drone alone, s, shape (n,)."""
    if pieces < 4:
        return np.where(np.abs(displacements).max(axis=1) > 0.0, inf, 0.0)
    ceilings, steps = Ceilings.of(displacements, limits, 1.0), family(pieces)[1]
    with np.errstate(divide="ignore"):
        first = steps[:, :1] / ceilings.first
        second = np.sqrt(steps[:, 1:2] / ceilings.second)
        third = np.cbrt(steps[:, 2:] / ceilings.third)
    return np.asarray(np.maximum(first, np.maximum(second, third)).min(axis=0))


def _steps(shapes: Array) -> Array:
    return np.stack([np.abs(np.diff(shapes, n, axis=1)).max(axis=1) for n in (1, 2, 3)], axis=1)


class Ramps(NamedTuple):
    """The shares of a profile's time in which it speeds up and slows down.

    up_jerk, down_jerk : shares of each ramp in which the acceleration rises and falls
    """

    up: float
    down: float
    up_jerk: float
    down_jerk: float

    @property
    def back(self) -> Ramps:
        """Return those of the reversed profile."""
        return Ramps(self.down, self.up, self.down_jerk, self.up_jerk)

    @property
    def peaks(self) -> tuple[float, float, float]:
        """Return the largest absolute value of each derivative of the profile, of order 1 to 3, over its
        time.
        """
        sets_in, out = 0.5 * self.up * self.up_jerk, 0.5 * self.down * self.down_jerk
        speed = 1.0 / (1.0 - 0.5 * (self.up + self.down))
        up, down = speed / (self.up - sets_in), speed / (self.down - out)
        return speed, max(up, down), max(up / sets_in, down / out)


@cache
def ramps_of(easing: Easing) -> tuple[Ramps, ...]:
    """Return the profiles of an easing; for the linear one, those with sufficiently constant speed."""
    if easing in ("ease-in", "ease-out"):
        slow = tuple(Ramps(*r) for r in product(LONG_SHARES, SHORT_SHARES, JERK_SHARES, JERK_SHARES))
        return slow if easing == "ease-in" else tuple(ramps.back for ramps in slow)
    shares = np.linspace(0.0, 1.0, 15)[1:].tolist()
    every = tuple(Ramps(0.5 * ramp, 0.5 * ramp, jerk, jerk) for ramp, jerk in product(shares, shares))
    if easing == "linear":
        return tuple(ramps for ramps in every if ramps.peaks[0] * EVEN_SHARE <= 1.0)
    return every


@cache
def family(pieces: int, easing: Easing = "ease-in-out") -> tuple[Array, Array]:
    """Return shapes of control points, shape (M, pieces + 3), and their largest differences, (M, 3).

    The result is empty if the easing needs more pieces.
    """
    # The profile starts one piece late, ends one early and rests outside: three equal points at each end.
    at = np.clip((np.arange(pieces + 3) - 2.0) / (pieces - 2.0), 0.0, 1.0)
    shapes = np.array([profile(at, ramps) for ramps in ramps_of(easing)])
    steps = _steps(shapes)
    if easing == "linear":
        even = pieces * steps[:, 0] * EVEN_SHARE <= 1.0
        shapes, steps = shapes[even], steps[even]
    return shapes, steps


def profile(at: Array, ramps: Ramps) -> Array:
    """Return s of seven stretches of constant third derivative at shares of its time, 0 to 1, any shape."""
    up, down = ramps.up, ramps.down
    in_, out = 0.5 * up * ramps.up_jerk, 0.5 * down * ramps.down_jerk
    ends = np.array([in_, up - in_, up, 1.0 - down, 1.0 - down + out, 1.0 - out])
    # Both ramps reach one speed: the third derivative of the first is normalised to 1.
    back = (up - in_) * in_ / ((down - out) * out)
    signs = np.array([1.0, 0.0, -1.0, 0.0, -back, 0.0, back])
    jumps = np.diff(signs)
    late = np.maximum(at[..., None] - ends, 0.0)
    s = (signs[0] * at**3 + (late**3 * jumps).sum(axis=-1)) / 6.0
    whole = (signs[0] + ((1.0 - ends) ** 3 * jumps).sum()) / 6.0
    return np.asarray(np.where(at >= 1.0, 1.0, s / whole))
