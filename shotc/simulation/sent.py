"""Short-term plans: how drones fly them, and what other drones know of them."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.framing import optical_axes
from shotc.ir.limits import Limits
from shotc.ir.path import CAM_PITCH, CAM_YAW
from shotc.plugin_api.replanner import Plan
from shotc.simulation.film import PlanSamples
from shotc.simulation.vehicle import VehicleSetpoint, braked

PLACE = np.polynomial.Polynomial([1.0, 0.0, 0.0, -10.0, 15.0, -6.0])
RATE = np.polynomial.Polynomial([0.0, 1.0, 0.0, -6.0, 8.0, -3.0])
"""Polynomials over a unit time from 1, or from a slope of 1, to rest at 0; no acceleration at both ends."""
SLOWS_S = 4.0
"""Least time in which a velocity beside the plan fades, seconds."""
BACK_S = 4.0
"""Least time in which a drone returns to its plan, seconds."""
BRAKES_M_S2 = 0.6
"""Mean deceleration of faster ones, m/s^2; a quintic brakes at up to four times its mean."""


@dataclass(frozen=True, slots=True, eq=False)
class Fading:
    """The return of drones in R runs to their plan: an offset that is quintic in time and ends at rest.

    start, durations : (R,), seconds
    off, rate : offset at the start, (R, 3), metres, m/s
    """

    film: PlanSamples
    start: Array
    durations: Array
    off: Array
    rate: Array

    @staticmethod
    def none(film: PlanSamples, runs: int) -> Fading:
        """Return the state without any offset."""
        return Fading(film, np.zeros(runs), np.ones(runs), np.zeros((runs, 3)), np.zeros((runs, 3)))

    def begun(self, run: int, time: float, duration: float, off: tuple[Array, Array]) -> Fading:
        """Return the same with one run that begins its return now.

        off : position and velocity, (3,) each
        """
        start, seconds, place, rate = (
            part.copy() for part in (self.start, self.durations, self.off, self.rate)
        )
        start[run], seconds[run], place[run], rate[run] = time, duration, *off
        return Fading(self.film, start, seconds, place, rate)

    def setpoint(self, time: float) -> VehicleSetpoint:
        """Return the plan's setpoint plus the remaining offset."""
        planned = self.film.setpoint(self.film.step(time))
        if (time >= self.start + self.durations).all():
            return planned
        parts = (planned.position, planned.velocity, planned.acceleration)
        return VehicleSetpoint(*(part + self._beside(time, order) for order, part in enumerate(parts)))

    def places(self, run: int, times: Array) -> Array:
        """Return the positions of a run at times (M,), shape (M, 3), metres."""
        elapsed, slows = times - self.start[run], self._slows[run]
        x, y = (np.clip(elapsed / seconds, 0.0, 1.0)[:, None] for seconds in (self.durations[run], slows))
        beside = PLACE(x) * self.off[run] + RATE(y) * slows * self.rate[run]
        return np.asarray(self.film.places(times) + beside)

    @property
    def _slows(self) -> Array:
        """Return the times in which the rates fade, (R,), s: who is far off does not fly on for long."""
        speed = np.linalg.norm(self.rate, axis=1)
        return np.asarray(np.minimum(self.durations, np.maximum(SLOWS_S, speed / BRAKES_M_S2)))

    def _beside(self, time: float, order: int) -> Array:
        """Return the offset or its derivative, (R, 3)."""
        slows = self._slows
        x, y = (
            np.clip((time - self.start) / seconds, 0.0, 1.0)[:, None] for seconds in (self.durations, slows)
        )
        place = PLACE.deriv(order)(x) * self.off / self.durations[:, None] ** order
        rate = RATE.deriv(order)(y) * self.rate * slows[:, None] ** (1 - order)
        return np.asarray(place + rate)


def seconds_back(off: Array, limits: Limits) -> Array:
    """Return the durations of returns from offsets (..., 3), metres; shape (...), seconds."""
    return np.asarray(np.maximum(BACK_S, 4.0 * np.abs(off).max(axis=-1) / limits.slowest))


@dataclass(frozen=True, slots=True, eq=False)
class SentPlans:
    """The plans that drones of R runs fly; at their end the drones brake and hold.

    plans : of every run
    acceleration : braking acceleration, m/s^2
    """

    plans: tuple[Plan, ...]
    acceleration: float

    def replaced(self, new: Sequence[Plan | None]) -> SentPlans:
        """Return the same with new plans; where there is none, the last one continues."""
        return SentPlans(tuple(n or last for n, last in zip(new, self.plans, strict=True)), self.acceleration)

    def setpoint(self, time: float) -> VehicleSetpoint:
        """Return the setpoints, (R, 3) each."""
        rows = [self._row(plan, time) for plan in self.plans]
        return VehicleSetpoint(
            np.array([row.position for row in rows]),
            np.array([row.velocity for row in rows]),
            np.array([row.acceleration for row in rows]),
        )

    def places(self, run: int, times: Array) -> Array:
        """Return the positions of a run at times (M,), shape (M, 3), metres."""
        return np.array([self._row(self.plans[run], time).position for time in times.tolist()])

    def _row(self, plan: Plan, time: float) -> VehicleSetpoint:
        k = int(np.searchsorted(plan.times, time, side="right")) - 1
        p, v = plan.places[k], plan.velocities[k]
        left = time - float(plan.times[k])
        if k == len(plan.accelerations):
            return braked(p, v, self.acceleration, left)
        a = plan.accelerations[k]
        return VehicleSetpoint(p + left * v + 0.5 * left * left * a, v + left * a, a)


@dataclass(slots=True)
class Sent:
    """The plans that a drone has sent to the others.

    age : seconds until a sent plan is known
    plans : of all runs at each time, None for a drone that flies as planned
    """

    film: PlanSamples
    age: float
    times: list[float] = field(default_factory=list)
    plans: list[tuple[Plan | None, ...]] = field(default_factory=list)

    def add(self, time: float, plans: tuple[Plan | None, ...]) -> None:
        """Send the plans of all runs at a time."""
        self.times.append(time)
        self.plans.append(plans)

    def places(self, run: int, stages: Array) -> Array:
        """Return the drone's expected positions at times (M,), as known at the first, (M, 3), metres.

        Without a sent plan they are those of its trajectory. Who has sent no plan after the end of the last
        one brakes and holds.
        """
        planned = np.asarray(self.film.track.curve(stages)[:, :3])
        plan = self._known(run, stages)
        if plan is None:
            return planned
        if plan.times[-1] <= stages[0]:
            return SentPlans((plan,), self.film.drone.limits.usable_acceleration).places(0, stages)
        return _instead(planned, stages, plan, plan.places)

    def axes(self, run: int, stages: Array) -> Array:
        """Return unit vectors of its camera's directions at the times, (M, 3), W; without a sent aim as
        planned.
        """
        planned = np.asarray(self.film.track.curve(stages)[:, [CAM_YAW, CAM_PITCH]])
        plan = self._known(run, stages)
        if plan is not None and plan.aim is not None and plan.times[-1] > stages[0]:
            planned = _instead(planned, stages, plan, plan.aim)
        return optical_axes(*planned.T)

    def films(self, stages: Array) -> bool:
        """Return whether it films at any of these times, shape (M,)."""
        return any(
            phase.shot is not None and phase.start <= stages[-1] and stages[0] <= phase.end
            for phase in self.film.track.phases
        )

    def _known(self, run: int, stages: Array) -> Plan | None:
        k = bisect_right(self.times, float(stages[0]) - self.age) - 1
        return None if k < 0 else self.plans[k][run]


def _instead(planned: Array, stages: Array, plan: Plan, rows: Array) -> Array:
    """Return rows of a plan at times (M,); after the plan's end the rows ``planned``, (M, D)."""
    inside = stages <= plan.times[-1]
    known = np.column_stack([np.interp(stages, plan.times, column) for column in rows.T])
    return np.where(inside[:, None], known, planned)
