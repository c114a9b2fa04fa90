"""Waves: drones depart one after another, with a proof of their separation.

Two drones at shares s_i and s_j of their paths are nearer than if both were at s_i, by up to |s_j - s_i|
times the path of the second. So the proof for straight paths between matched formations does not hold, and no
sharp closed form exists. Every wave is therefore verified by ``geom.separation`` as flown, and a violation is
a fault. Drones are not pushed aside, because that would bend the wave.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from shotc.diag.model import Diagnostic
from shotc.geom.apart import keeps_separation, stretch
from shotc.geom.bernstein import Array
from shotc.geom.separation import Nearest, closest
from shotc.ir.effects import Way
from shotc.ir.light_layers import Axis, Order
from shotc.ir.light_paints import reached
from shotc.ir.limits import Vec3
from shotc.ir.mission import MissionIR
from shotc.ir.show import Display, Fleet, Picture, Wave
from shotc.planning.clearances import ROUNDING_M
from shotc.rounding import down, up
from shotc.show.assignment.faults import (
    TriedWave,
    too_fast,
    wave_in_the_way,
    wave_too_near,
    wave_without_extent,
)
from shotc.show.assignment.layers import LEAST_M, EffectContext, along_of
from shotc.show.assignment.over import MoveSurroundings
from shotc.show.assignment.score import FlightScore
from shotc.show.geom.push_apart import nearest_pair
from shotc.show.solvers.wave_move import WaveMove, fastest_wave

MOST_HALVINGS = 6
"""Bisection steps between an insufficient and a sufficient value."""
FACTORS = (1.25, 1.5, 2.0, 3.0, 4.0)
"""Factors on the spacing that are tried in turn; if none suffices, the diagnostic proposes none."""
TINY_S = 1e-6
"""Seconds, below which a missed time counts as met."""

Ends = tuple[Array, Array]
"""Positions of all drones before and after a move, shape (n, 3) each."""


def departures(wave: Wave, viewpoint: Vec3 | None, ends: Ends) -> Array | None:
    """Return the delay of each drone's departure, shape (n,), seconds; None if all places are equal.

    The last drone departs ``wave.time`` after the first; the others are in proportion to their coordinate.
    """
    places = ends[1] if wave.by == "goal" else ends[0]
    along = along_of(wave.along, wave.center, EffectContext(places, viewpoint, len(places), {}))
    if isinstance(along, Order):
        share = np.arange(len(places), dtype=np.float64)
    else:
        metres = along.high - along.low if isinstance(along, Axis) else along.reach
        share = metres * reached(along, places)
    low, high = float(share.min()), float(share.max())
    return None if high - low < LEAST_M else wave.time * (share - low) / (high - low)


class Waves:
    """Finds the waves of one fleet.

    faults : collects their diagnostics
    """

    def __init__(self, mission: MissionIR, fleet: Fleet, sky: MoveSurroundings) -> None:
        self.mission, self.fleet, self.sky = mission, fleet, sky
        self.faults: list[Diagnostic] = []

    def move(self, ends: Ends, display: Display, picture: Picture) -> WaveMove:
        """Return the move to a picture with a wave, in the requested time or the time that the
        pace allows.
        """
        wave = picture.wave
        assert wave is not None
        departs = departures(wave, display.viewpoint, ends)
        if departs is None:
            others: tuple[Way, ...] = ("right", "up", "away", "out", "index")
            able = [
                w for w in others if departures(wave._replace(along=w), display.viewpoint, ends) is not None
            ]
            self.faults.append(wave_without_extent(self.mission, picture, wave, able))
            return self._timed(ends, np.zeros(len(ends[0])), display, picture)
        move = self._timed(ends, departs, display, picture)
        if picture.transition is not None and move.duration > picture.transition + TINY_S:
            distance = float(np.linalg.norm((ends[1] - ends[0])[move.drone]))
            self.faults.append(too_fast(self.mission, self.fleet, picture, move, distance))
            return move
        nearest = self._nearest(ends, move)
        if not keeps_separation(nearest.proven, self.fleet.apart.across):
            self.faults.append(self._too_near(ends, display, picture, nearest))
            return move
        lack = self.sky.lack(ends, move)
        if lack.metres > ROUNDING_M:
            self.faults.append(wave_in_the_way(self.mission, self.fleet, picture, lack))
        return move

    def _timed(self, ends: Ends, departs: Array, display: Display, picture: Picture) -> WaveMove:
        """Return the flown move, which takes longer than requested if that is not feasible."""
        duration, limits = picture.transition, self.fleet.limits
        pace = display.pace if duration is None else 1.0
        move = fastest_wave(ends[1] - ends[0], departs, limits, pace, picture.easing)
        return move if duration is None or duration < move.duration else move.lasting(duration)

    def _nearest(self, ends: Ends, move: WaveMove) -> Nearest:
        """Return the nearest pair, proved on the flown control points."""
        score = FlightScore(ends[0])
        score.move(ends[1], move)
        return closest(*score.spline(), self.fleet.apart)

    def _too_near(self, ends: Ends, display: Display, picture: Picture, nearest: Nearest) -> Diagnostic:
        """Return D141 with a sufficient wave and a sufficient spacing."""
        wave, apart = picture.wave, self.fleet.apart
        assert wave is not None

        def enough(seconds: float, factor: float) -> bool:
            wider = _larger(ends[0], factor), _larger(ends[1], factor)
            departs = departures(wave._replace(time=seconds), display.viewpoint, wider)
            assert departs is not None
            move = self._timed(wider, departs, display, picture)
            return keeps_separation(self._nearest(wider, move).proven, apart.across)

        longest = 0.0
        if enough(0.0, 1.0):
            longest = _closed_in((0.0, wave.time), lambda time: enough(time, 1.0), down)
        factor = next((f for f in FACTORS if enough(wave.time, f)), None)
        if factor is not None:
            less = max((f for f in FACTORS if f < factor), default=1.0)
            factor = _closed_in((factor, less), lambda f: enough(wave.time, f), up)
        scale = np.array([1.0, 1.0, stretch(apart)])
        before, after = (nearest_pair(places * scale) for places in ends)
        tried = TriedWave(nearest, longest, (before, after), factor)
        return wave_too_near(self.mission, self.fleet, picture, tried)


def _larger(places: Array, factor: float) -> Array:
    """Return positions scaled about their middle, shape (n, 3)."""
    middle = 0.5 * (places.min(axis=0) + places.max(axis=0))
    return np.asarray(middle + factor * (places - middle))


def _closed_in(
    ends: tuple[float, float], enough: Callable[[float], bool], rounded: Callable[[float], float]
) -> float:
    """Return a sufficient value near the insufficient one, by bisection.

    ends : a sufficient and an insufficient value
    """
    good, bad = ends
    for _ in range(MOST_HALVINGS):
        middle = rounded(0.5 * (good + bad))
        if middle in (good, bad):
            break
        good, bad = (middle, bad) if enough(middle) else (good, middle)
    return good
