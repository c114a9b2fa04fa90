"""Plans of the next seconds: how drones fly them, and what the others know of them."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from shotc.geom.bernstein import Array
from shotc.plugin_api.replanner import Plan
from shotc.simulation.film import Film
from shotc.simulation.vehicle import STEP_S, Setpoint


@dataclass(frozen=True, slots=True, eq=False)
class Fading:
    """How drones of R runs come back to their plan.

    start, lasts : seconds; off, rate : where they are beside it then, and how that changes, (R, 3) each
    """

    film: Film
    start: float
    lasts: float
    off: Array
    rate: Array

    def setpoint(self, time: float) -> Setpoint:
        """Return the plan's setpoint with what is left of the way back: a quintic that ends at rest."""
        plan = self.film.setpoint(min(round(time / STEP_S), len(self.film.times) - 1))
        x, d = min(1.0, (time - self.start) / self.lasts), self.lasts
        place, slope, bend = _fade(x)
        along, along_slope, along_bend = _fade_rate(x)
        return Setpoint(
            plan.position + place * self.off + d * along * self.rate,
            plan.velocity + slope / d * self.off + along_slope * self.rate,
            plan.acceleration + bend / d**2 * self.off + along_bend / d * self.rate,
        )


def _fade(x: float) -> tuple[float, float, float]:
    """Return the quintic from 1 to 0 with no slope and no bend at its ends, and its derivatives."""
    return (
        1 - x**3 * (10 - 15 * x + 6 * x * x),
        -30 * x * x * (1 - x) ** 2,
        -60 * x * (1 - x) * (1 - 2 * x),
    )


def _fade_rate(x: float) -> tuple[float, float, float]:
    """Return the quintic from 0 to 0 with slope 1 at its start and no other slope or bend at its ends."""
    return (
        x - 6 * x**3 + 8 * x**4 - 3 * x**5,
        1 - 18 * x * x + 32 * x**3 - 15 * x**4,
        -36 * x + 96 * x * x - 60 * x**3,
    )


@dataclass(frozen=True, slots=True, eq=False)
class Held:
    """The plans that drones of R runs fly, each to its end; then they brake and hold.

    plans : of every run; acceleration : limit at which they brake, m/s^2
    """

    plans: tuple[Plan, ...]
    acceleration: float

    def replaced(self, new: Sequence[Plan | None]) -> Held:
        """Return the same with new plans; where there is none the last one is flown on."""
        return Held(tuple(n or last for n, last in zip(new, self.plans, strict=True)), self.acceleration)

    def setpoint(self, time: float) -> Setpoint:
        """Return what drones are asked for, (R, 3) each."""
        rows = [self._row(plan, time) for plan in self.plans]
        position, velocity, acceleration = (np.array(part) for part in zip(*rows, strict=True))
        return Setpoint(position, velocity, acceleration)

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

    film: Film
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
        k = bisect_right(self.times, float(stages[0]) - self.age) - 1
        plan = None if k < 0 else self.plans[k][run]
        if plan is None or plan.times[-1] <= stages[0]:
            return planned
        inside = stages <= plan.times[-1]
        known = np.column_stack([np.interp(stages, plan.times, plan.places[:, i]) for i in range(3)])
        return np.where(inside[:, None], known, planned)
