"""A drone without positions of its own: it brakes and holds, and returns to its plan when they are back."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array
from shotc.simulation.film import PlanSamples
from shotc.simulation.sensors import Interval, within
from shotc.simulation.sent import BACK_S, Fading, seconds_back
from shotc.simulation.vehicle import VehicleSetpoint

BLIND_S = 2.0
"""Seconds without positions after which a drone brakes: its inertial sensors are off by 0.2 m by then."""


class _Braking(NamedTuple):
    """Position and velocity from which drones brake, (R, 3) each, at a mission time in seconds."""

    since: float
    place: Array
    velocity: Array


@dataclass(slots=True)
class BlindHold:
    """Replaces the setpoints of a drone in R runs while it is blind, and until it is back on its plan.

    held : intervals in which it brakes and holds, seconds
    lands : time at which it has to be on its plan again, seconds
    """

    film: PlanSamples
    held: tuple[Interval, ...]
    lands: float
    _braking: _Braking | None = None
    _back: Fading | None = None

    @staticmethod
    def of(film: PlanSamples, lost: tuple[Interval, ...]) -> BlindHold:
        """Return the hold of a drone whose positions are lost in some intervals.

        A drone that lands over its pad goes on landing.
        """
        lands = [phase.start for phase in film.track.phases if phase.name == "land"]
        until = min(lands, default=float(film.times[-1]))
        held = tuple((start + BLIND_S, end) for start, end in lost if start + BLIND_S < min(end, until))
        return BlindHold(film, held, until)

    def setpoint(self, time: float, planned: VehicleSetpoint, runs: int) -> VehicleSetpoint:
        """Return the setpoint at a time instead of the one that is asked; called at every step in order."""
        if within(time, self.held):
            if self._braking is None:
                place, velocity = (
                    np.broadcast_to(part, (runs, 3)) for part in (planned.position, planned.velocity)
                )
                self._braking, self._back = _Braking(time, place, velocity), None
            return self._stopping(self._braking, time)
        if self._braking is not None:
            self._back = self._returning(self._stopping(self._braking, time), time, planned)
            self._braking = None
        return planned if self._back is None else self._back.onto(time, planned)

    def _stopping(self, of: _Braking, time: float) -> VehicleSetpoint:
        most = self.film.drone.limits.usable_acceleration
        speed = np.linalg.norm(of.velocity, axis=1, keepdims=True)
        along = of.velocity / np.maximum(speed, 1e-12)
        t = np.minimum(time - of.since, speed / most)
        moves = time - of.since < speed / most
        return VehicleSetpoint(
            of.place + t * of.velocity - 0.5 * most * t * t * along,
            of.velocity - most * t * along,
            np.where(moves, -most * along, 0.0),
        )

    def _returning(self, now: VehicleSetpoint, time: float, planned: VehicleSetpoint) -> Fading:
        off, rate = now.position - planned.position, now.velocity - planned.velocity
        durations = np.minimum(seconds_back(off, self.film.drone.limits), self.lands - time)
        return Fading(self.film, np.full(len(off), time), np.maximum(BACK_S, durations), off, rate)
