"""Keeps the drones of one fleet apart: finds violations of its separation and repairs them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from shotc.diag.model import Diagnostic
from shotc.geom.apart import keeps_separation
from shotc.geom.bernstein import Array
from shotc.geom.fleet_spline import DEGREE
from shotc.geom.on_pads import Mask
from shotc.geom.separation import Nearest, closest
from shotc.ir.fleet import FleetTrajectory
from shotc.ir.mission import MissionIR
from shotc.ir.passes import PassContext
from shotc.ir.show import Fleet
from shotc.planning.on_pads import standing
from shotc.show.geom.windows import Window, windows
from shotc.show.separation.common import common
from shotc.show.separation.faults import (
    RepairAttempts,
    recorded_in,
    recorded_too_near,
    standing_too_near,
    too_near,
)
from shotc.show.separation.longer import MoveBetweenStops, longer
from shotc.show.separation.pushed import Pushed, pushed

MANY_DRONES = 1000
"""Above this number of drones, common moves are proved in closed form; verification searches all pairs."""

NEAR_S = 1e-6
"""Times that differ by less are equal."""


class Keeper:
    """Repairs the flight of one fleet; wanted : control points that its goals ask for, as in ``ShowIR``."""

    def __init__(
        self, mission: MissionIR, fleet: Fleet, flight: FleetTrajectory, reference: Array, ctx: PassContext
    ) -> None:
        self.mission, self.fleet, self.flight, self.ctx = mission, fleet, flight, ctx
        self.wanted = reference
        self.across = fleet.apart.across
        self.coef = flight.coef.copy()
        self.faults: list[Diagnostic] = []
        self.rounds = 0
        self.proven = np.inf

    def keep(self) -> FleetTrajectory:
        """Return the flight with its drones kept apart, or as far as it was repaired if there are faults."""
        self.proven = self._alike()
        if not keeps_separation(self.proven, self.across):
            self.proven = self._closest().proven
        if keeps_separation(self.proven, self.across):
            return self.flight
        for window in windows(self.coef):
            self._mend(window)
        if not self.faults:
            # Each window was proved separately; the reported value is that of the whole flight.
            self.proven = self._closest().proven
        return replace(self.flight, coef=self.coef)

    def _alike(self) -> float:
        """Return the proved separation of a large fleet with only common moves; 0 if none is proved."""
        if len(self.coef) <= MANY_DRONES:
            return 0.0
        return min(map(self._apart_in, windows(self.coef)), default=0.0)

    def _apart_in(self, window: Window) -> float:
        """Return the proved separation in a stretch; 0 if that needs a search over all pairs."""
        counted = self._aloft()
        if counted is not None and not counted[:, window.pieces].all():
            return self._closest(window).proven
        return common(self.coef[:, window.points], self.fleet.apart)

    def _aloft(self) -> Mask | None:
        """Return which drones are in the air on each piece, (n, P), if they take off in layers; else None."""
        on_pads = standing(self.fleet, self.coef)
        return None if on_pads is None else ~on_pads

    def _closest(self, window: Window | None = None) -> Nearest:
        """Return the nearest pair of drones that must keep the separation, in a stretch or in the whole
        flight.
        """
        counted, apart = self._aloft(), self.fleet.apart
        if window is None:
            return closest(self.flight.breaks, self.coef, apart, counted)
        counted = None if counted is None else counted[:, window.pieces]
        return closest(window.breaks(self.flight.breaks), self.coef[:, window.points], apart, counted)

    def stats(self) -> list[tuple[str, float | str]]:
        """Return the statistics of the repair."""
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
        nearest = self._closest(window)
        if keeps_separation(nearest.proven, self.across):
            return
        self.ctx.progress(f"repairing fleet {self.fleet.name} from {breaks[0]:.0f} to {breaks[-1]:.0f} s")
        standing = self._standing(window)
        recorded = recorded_in(self.mission, self.flight, (float(breaks[0]), float(breaks[-1])))
        if standing is not None and recorded is not None:
            tried = RepairAttempts(standing, 0.0, None)
            self.faults.append(recorded_too_near(self.mission, self.fleet, recorded, tried))
            return
        if standing is not None:
            self.faults.append(standing_too_near(self.mission, self.fleet, self.flight, standing))
            return
        free, push = self._free(breaks), Pushed(None, 0, 0.0)
        if free.start < free.stop:
            push = pushed(breaks, coef, self.fleet, self.ctx.seed, free=free)
        self.rounds += push.rounds
        if push.coef is None and recorded is not None:
            tried = RepairAttempts(nearest, max(nearest.proven, push.reached), None)
            self.faults.append(recorded_too_near(self.mission, self.fleet, recorded, tried))
            return
        if push.coef is None:
            self.faults.append(self._too_near(window, nearest, push))
            return
        self.coef[:, window.points] = push.coef

    def _free(self, breaks: Array) -> slice:
        """Return the control points of a stretch that may change.

        A recorded flight may take off and land in the same stretch: there the drones stay over their pads.
        """
        ends = {p.name: p.end if p.name == "takeoff" else p.start for p in self.flight.phases}
        up, down = ends.get("takeoff", -np.inf), ends.get("land", np.inf)
        first = int(np.searchsorted(breaks, up - NEAR_S)) if up < breaks[-1] - NEAR_S else 0
        last = int(np.searchsorted(breaks, down - NEAR_S)) if down > breaks[0] + NEAR_S else len(breaks) - 1
        return slice(DEGREE + first, min(last, len(breaks) - 1))

    def _too_near(self, window: Window, nearest: Nearest, push: Pushed) -> Diagnostic:
        stretch = MoveBetweenStops.of(
            self.flight, window.breaks(self.flight.breaks), self.wanted[:, window.points]
        )
        seconds = longer(stretch, self.fleet, self.ctx)
        best = max(nearest.proven, push.reached)
        return too_near(self.mission, self.fleet, stretch, RepairAttempts(nearest, best, seconds))

    def _standing(self, window: Window) -> Nearest | None:
        """Return the pair that is too near at one of its stops, where nothing can be repaired, or None."""
        for stop in (window.first, window.last):
            at = np.repeat(self.coef[:, stop : stop + 1], 4, axis=1)
            time = float(self.flight.breaks[stop])
            nearest = closest(np.array([time, time + 1.0]), at, self.fleet.apart)
            if not keeps_separation(nearest.proven, self.across):
                return replace(nearest, time=time)
        return None
