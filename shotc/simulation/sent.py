"""Plans of the next seconds: how drones fly them, and what the others know of them."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from shotc.geom.bernstein import Array
from shotc.ir.path import CAM_PITCH, CAM_YAW
from shotc.plugin_api.replanner import Plan
from shotc.simulation.film import PlanSamples
from shotc.simulation.vehicle import VehicleSetpoint

PLACE = np.polynomial.Polynomial([1.0, 0.0, 0.0, -10.0, 15.0, -6.0])
RATE = np.polynomial.Polynomial([0.0, 1.0, 0.0, -6.0, 8.0, -3.0])
"""From 1, or a slope of 1, to rest at 0 over a time of 1, without acceleration at both ends."""


@dataclass(frozen=True, slots=True, eq=False)
class Fading:
    """How drones of R runs come back to their plan: a quintic in time that ends at rest beside it.

    start, lasts : (R,), s; off, rate : beside the plan at the start, (R, 3), metres, m/s
    """

    film: PlanSamples
    start: Array
    lasts: Array
    off: Array
    rate: Array

    @staticmethod
    def none(film: PlanSamples, runs: int) -> Fading:
        """Return drones that are where they are to be."""
        return Fading(film, np.zeros(runs), np.ones(runs), np.zeros((runs, 3)), np.zeros((runs, 3)))

    def begun(self, run: int, time: float, lasts: float, off: tuple[Array, Array]) -> Fading:
        """Return the same with a run that begins to come back now; off : place and velocity, (3,) each."""
        start, seconds, place, rate = (part.copy() for part in (self.start, self.lasts, self.off, self.rate))
        start[run], seconds[run], place[run], rate[run] = time, lasts, *off
        return Fading(self.film, start, seconds, place, rate)

    def setpoint(self, time: float) -> VehicleSetpoint:
        """Return the plan's setpoint with what is left of the way back."""
        plan = self.film.setpoint(self.film.step(time))
        x = np.clip((time - self.start) / self.lasts, 0.0, 1.0)
        if (x == 1.0).all():
            return plan
        moved = [self._beside(x, n) for n in range(3)]
        return VehicleSetpoint(
            plan.position + moved[0], plan.velocity + moved[1], plan.acceleration + moved[2]
        )

    def places(self, run: int, times: Array) -> Array:
        """Return where a run is to be at times (M,), (M, 3), metres."""
        x = np.clip((times - self.start[run]) / self.lasts[run], 0.0, 1.0)[:, None]
        beside = PLACE(x) * self.off[run] + RATE(x) * self.lasts[run] * self.rate[run]
        return np.asarray(self.film.places(times) + beside)

    def _beside(self, x: Array, order: int) -> Array:
        """Return the way beside the plan or its derivative, (R, 3); x : share of the time, (R,)."""
        along, seconds = x[:, None], self.lasts[:, None]
        place, rate = PLACE.deriv(order)(along), RATE.deriv(order)(along)
        return np.asarray((place * self.off + rate * seconds * self.rate) / seconds**order)


@dataclass(frozen=True, slots=True, eq=False)
class SentPlans:
    """The plans that drones of R runs fly, each to its end; then they brake and hold.

    plans : of every run; acceleration : limit at which they brake, m/s^2
    """

    plans: tuple[Plan, ...]
    acceleration: float

    def replaced(self, new: Sequence[Plan | None]) -> SentPlans:
        """Return the same with new plans; where there is none the last one is flown on."""
        return SentPlans(tuple(n or last for n, last in zip(new, self.plans, strict=True)), self.acceleration)

    def setpoint(self, time: float) -> VehicleSetpoint:
        """Return what drones are asked for, (R, 3) each."""
        rows = [self._row(plan, time) for plan in self.plans]
        position, velocity, acceleration = (np.array(part) for part in zip(*rows, strict=True))
        return VehicleSetpoint(position, velocity, acceleration)

    def _row(self, plan: Plan, time: float) -> tuple[Array, Array, Array]:
        k = int(np.searchsorted(plan.times, time, side="right")) - 1
        p, v = plan.places[k], plan.velocities[k]
        left = time - float(plan.times[k])
        if k < len(plan.accelerations):
            a = plan.accelerations[k]
        else:
            speed = float(np.linalg.norm(v))
            stops = speed / self.acceleration
            a = np.zeros(3) if left >= stops else -self.acceleration * v / speed
            if left >= stops:
                return p + 0.5 * stops * v, np.zeros(3), a
        return p + left * v + 0.5 * left * left * a, v + left * a, a


@dataclass(slots=True)
class Sent:
    """What a drone has told the others of its next seconds.

    age : seconds until what is sent is known
    """

    film: PlanSamples
    age: float
    times: list[float] = field(default_factory=list)
    plans: list[tuple[Plan, ...]] = field(default_factory=list)

    def add(self, time: float, plans: tuple[Plan, ...]) -> None:
        """Send the plans of all runs at a time."""
        self.times.append(time)
        self.plans.append(plans)

    def places(self, run: int, stages: Array) -> Array:
        """Return where the drone is to be at times (M,), by what is known at the first, (M, 3), metres.

        Where it has sent nothing of these seconds, that is its plan.
        """
        planned = np.asarray(self.film.track.curve(stages)[:, :3])
        plan = self._known(run, stages)
        return planned if plan is None else _instead(planned, stages, plan, plan.places)

    def axes(self, run: int, stages: Array) -> Array:
        """Return unit vectors along which its camera looks then, (M, 3), W; as planned if it did not say."""
        planned = np.asarray(self.film.track.curve(stages)[:, [CAM_YAW, CAM_PITCH]])
        plan = self._known(run, stages)
        if plan is not None and plan.aim is not None:
            planned = _instead(planned, stages, plan, plan.aim)
        yaw, pitch = planned.T
        return np.column_stack([np.cos(pitch) * np.cos(yaw), np.cos(pitch) * np.sin(yaw), np.sin(pitch)])

    def films(self, stages: Array) -> bool:
        """Tell whether it films at any of these times."""
        return any(
            phase.shot is not None and phase.start <= stages[-1] and stages[0] <= phase.end
            for phase in self.film.track.phases
        )

    def _known(self, run: int, stages: Array) -> Plan | None:
        k = bisect_right(self.times, float(stages[0]) - self.age) - 1
        plan = None if k < 0 else self.plans[k][run]
        return None if plan is None or plan.times[-1] <= stages[0] else plan


def _instead(planned: Array, stages: Array, plan: Plan, rows: Array) -> Array:
    """Return rows of a plan at times (M,), and up to its end only: what was planned, (M, D), stands then."""
    inside = stages <= plan.times[-1]
    known = np.column_stack([np.interp(stages, plan.times, column) for column in rows.T])
    return np.where(inside[:, None], known, planned)
