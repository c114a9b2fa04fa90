"""A drone without positions of its own: it brakes and holds, and returns to its plan when they are back."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array
from shotc.simulation.film import PlanSamples
from shotc.simulation.sensors import Interval, within
from shotc.simulation.sent import Fading
from shotc.simulation.situations import STAGE_S
from shotc.simulation.target_reach import reaches
from shotc.simulation.vehicle import VehicleSetpoint, braked
from shotc.simulation.walls import Standing, keeping_of
from shotc.simulation.way_back import CLEAR, ReturnLack, WayBack, durations_back, return_lack
from shotc.simulation.world import World

BLIND_S = 2.0
"""Seconds without positions after which a drone brakes: its inertial sensors are off by 0.2 m by then."""


def held_intervals(film: PlanSamples, lost: tuple[Interval, ...]) -> tuple[Interval, ...]:
    """Return the intervals in which a drone brakes and holds, seconds.

    A drone that takes off or lands over its pad goes on.

    lost : the intervals in which it has no positions
    """
    begins = ((max(start + BLIND_S, film.above_pad), end) for start, end in lost)
    return tuple((start, end) for start, end in begins if start < min(end, film.lands))


class _Braking(NamedTuple):
    """Position and velocity from which drones brake, (R, 3) each, at a mission time in seconds."""

    since: float
    place: Array
    velocity: Array


@dataclass(slots=True)
class BlindHold:
    """Holds a drone that flies its plan in R runs while it is blind, and leads it straight back.

    held : intervals in which it brakes and holds, seconds
    lacks : what the ways back lack, the worst way of each run
    """

    world: World
    film: PlanSamples
    held: tuple[Interval, ...]
    lacks: list[ReturnLack] = field(default_factory=list)
    _braking: _Braking | None = None
    _back: Fading | None = None

    def setpoint(self, k: int, _drone: tuple[Array, Array]) -> VehicleSetpoint:
        """Return the setpoint at a step, for R runs, shapes (R, 3); called at every step in order."""
        time, planned = float(self.film.times[k]), self.film.setpoint(k)
        runs = len(self.world.runs)
        if within(time, self.held):
            if self._braking is None:
                now = planned if self._back is None else self._back.setpoint(time)
                place, velocity = (np.broadcast_to(part, (runs, 3)) for part in (now.position, now.velocity))
                self._braking, self._back = _Braking(time, place, velocity), None
            return self._stopping(self._braking, time)
        if self._braking is not None:
            self._back = self._returning(self._stopping(self._braking, time), time, planned)
            self._braking = None
        return planned if self._back is None else self._back.setpoint(time)

    def _stopping(self, of: _Braking, time: float) -> VehicleSetpoint:
        return braked(of.place, of.velocity, self.film.drone.limits.usable_acceleration, time - of.since)

    def _returning(self, now: VehicleSetpoint, time: float, planned: VehicleSetpoint) -> Fading:
        off, rate = now.position - planned.position, now.velocity - planned.velocity
        back = Fading(self.film, np.full(len(off), time), durations_back(self.film, off, time), off, rate)
        self._note(back, time)
        return back

    def _note(self, back: Fading, time: float) -> None:
        """Note what the ways back lack."""
        mission, drone = self.world.mission, self.film.drone
        standing = Standing.of(mission, drone, keeping_of(mission, drone))
        times = np.arange(time, time + float(back.durations.max()), STAGE_S)
        reached, plan = reaches(self.world, drone, (), times), self.film.places(times)
        lacks = [
            return_lack(standing, WayBack(times, back.places(r, times), plan), r, reached)
            for r in range(len(self.world.runs))
        ]
        before = self.lacks or [CLEAR] * len(lacks)
        self.lacks = [max(pair) for pair in zip(before, lacks, strict=True)]
