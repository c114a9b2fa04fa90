"""Keeping the drones of one fleet apart: what breaks its separation, and how it is mended."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from shotc.diag.model import Diagnostic
from shotc.geom.bernstein import Array
from shotc.geom.fleet_windows import Window, windows
from shotc.geom.separation import Nearest, closest
from shotc.ir.fleet import FleetTrajectory
from shotc.ir.mission import MissionIR
from shotc.ir.show import Fleet
from shotc.passes.base import PassContext
from shotc.passes.keep_apart.faults import standing_too_near, too_near
from shotc.solvers.fleet_qcqp import Bounds, bounded
from shotc.solvers.fleet_repair import Index, Push, Pusher

ROUNDS = 25
GROWTH = 1.8
"""By which the weight of being apart grows from round to round."""

WEIGHT = 10.0
MARGIN = (0.02, 0.004)
"""Share of the distance that is asked for beyond it: in the first round, and more in each that follows."""

NOISE = 0.01
"""Shift by which two that fly at each other head-on are given a side, metres."""

DIGITS = 6
"""Decimals of a metre that control points keep, as in ``assign-goals``."""

SLACK = 1e-6
"""What the proof may fall short of, metres, as in verification."""


class Keeper:
    """Mends the flight of one fleet."""

    def __init__(self, mission: MissionIR, fleet: Fleet, flight: FleetTrajectory, ctx: PassContext) -> None:
        self.mission, self.fleet, self.flight, self.ctx = mission, fleet, flight, ctx
        self.across = fleet.apart.across
        self.bounds = Bounds(fleet.limits)
        self.coef = flight.coef.copy()
        self.faults: list[Diagnostic] = []
        self.rounds = 0
        self.proven = np.inf

    def keep(self) -> FleetTrajectory:
        """Return the flight with its drones kept apart, or as it is where there are faults."""
        found = closest(self.flight.breaks, self.coef, self.fleet.apart)
        self.proven = found.proven
        if found.proven >= self.across - SLACK:
            return self.flight
        for window in windows(self.coef):
            self._mend(window)
        if not self.faults:
            # The windows were proved one by one; what is told is of the whole.
            self.proven = closest(self.flight.breaks, self.coef, self.fleet.apart).proven
        return replace(self.flight, coef=self.coef)

    def stats(self) -> list[tuple[str, float | str]]:
        """Return what was done."""
        shift = np.linalg.norm(self.coef - self.flight.coef, axis=2)
        name = f"fleet {self.fleet.name} apart"
        return [
            (f"{name} proven", float(self.proven)),
            (f"{name} rounds", float(self.rounds)),
            (f"{name} moved", float((shift > 0.0).any(axis=1).sum())),
            (f"{name} shift", float(shift.max())),
        ]

    def _mend(self, window: Window) -> None:
        breaks, coef = window.breaks(self.flight.breaks), self.coef[:, window.points]
        found = closest(breaks, coef, self.fleet.apart)
        if found.proven >= self.across - SLACK:
            return
        self.ctx.progress(f"mending fleet {self.fleet.name} from {breaks[0]:.0f} to {breaks[-1]:.0f} s")
        standing = self._standing(window)
        if standing is not None:
            self.faults.append(standing_too_near(self.mission, self.fleet, self.flight, standing))
            return
        mended = self._pushed(breaks, coef)
        if mended is None:
            wanted = self.flight.coef[:, window.points]
            self.faults.append(too_near(self.mission, self.fleet, self.flight, (breaks, wanted, found)))
            return
        self.coef[:, window.points] = mended

    def _standing(self, window: Window) -> Nearest | None:
        """Return who is too near at one of its stops, where nothing can be mended."""
        for stop in (window.first, window.last):
            at = np.repeat(self.coef[:, stop : stop + 1], 4, axis=1)
            time = float(self.flight.breaks[stop])
            found = closest(np.array([time, time + 1.0]), at, self.fleet.apart)
            if found.proven < self.across - SLACK:
                return replace(found, time=time)
        return None

    def _pushed(self, breaks: Array, wanted: Array) -> Array | None:
        """Return control points that keep the separation and the limits, or None after all rounds."""
        pusher = Pusher(breaks, self.bounds.scaled(0.999), self.fleet.apart)
        rng = np.random.default_rng(self.ctx.seed)
        coef, movable = wanted, np.zeros(0, dtype=np.intp)
        for k in range(ROUNDS):
            self.rounds += 1
            distance = self.across * (1.0 + MARGIN[0] + k * MARGIN[1])
            crowded = np.setdiff1d(pusher.crowded(coef, distance), movable)
            coef, movable = _shaken(coef, crowded, rng), np.union1d(movable, crowded)
            coef = pusher.push(coef, wanted, movable, Push(distance, WEIGHT * GROWTH**k))
            within = self._within(breaks, coef)
            if within is None:
                continue
            if closest(breaks, within, self.fleet.apart).proven >= self.across - SLACK:
                return within
        return None

    def _within(self, breaks: Array, coef: Array) -> Array | None:
        """Return the nearest splines within the limits, with few digits, or None where there are none."""
        done = bounded(breaks, np.round(coef, DIGITS), self.bounds)
        return None if len(done.failed) else done.coef


def _shaken(coef: Array, rows: Index, rng: np.random.Generator) -> Array:
    """Shift the inner control points of some drones a little, so that those head-on have a side to pass."""
    coef = coef.copy()
    coef[rows, 3:-3] += rng.normal(scale=NOISE, size=(len(rows), coef.shape[1] - 6, 3))
    return coef
