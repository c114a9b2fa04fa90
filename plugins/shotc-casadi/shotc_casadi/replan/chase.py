"""Shots of one target: Alcantara et al., Eq. 12, planned anew from every measured state.

State: place and velocity; input: acceleration, held over a step. A stage costs its acceleration, its height
off that of the shot and the rates of the camera that looks at the target; the last one the distance from the
wanted state instead of the rates. What the measured stage costs cannot be changed and is left out.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from math import isfinite
from typing import Any

import casadi as ca
import numpy as np

from shotc.plugin_api.replanner import (
    Array,
    ChaseProblem,
    ChaseSituation,
    Plan,
    Replan,
    Status,
)
from shotc_casadi.clock.angles import rates
from shotc_casadi.replan.evaluation import Mapped, dense
from shotc_casadi.replan.program import Pattern, Programs, Quadratic, pattern
from shotc_casadi.replan.rows import Kept, Rows, rows, standing, within_reach
from shotc_casadi.replan.steps import walk

LACKING = 1e4  # a metre that the worst row of a stage lacks
OUTSIDE = 30.0  # a m/s beyond a bound of the velocity
DAMPING = 1e-3  # of the Hessian; never on the slack, or the programme buys itself through a zone
FIRST_STEPS, FIRST_GAIN = 30, 1e-3
STATES, INPUTS = 6, 3


class Chase:
    """Plans a shot of one target (``ChasePlanner``)."""

    def __init__(self, problem: ChaseProblem, most: int | None = None, gain: float = 0.0) -> None:
        """Take memory; most, gain : steps of a replan and where they end, for those who want a finer one."""
        self._problem = problem
        self._standing = standing(problem.keeping)
        self._rates = Mapped(_turning(), problem.horizon.stages)
        self._slopes = Mapped(_turning_with_slopes(), problem.horizon.stages)
        self._most, self._gain = most, gain
        self._programs = Programs()

    def replan(self, situation: ChaseSituation, last: Plan | None) -> Replan:
        """Plan from the measured state on: one step from the last plan, up to 30 where there is none."""
        fault = _fault(situation, last)
        if fault:
            return Replan(None, "failed", fault)
        first = (FIRST_STEPS, FIRST_GAIN)
        most, gain = (self._most, self._gain) if self._most else first if last is None else (1, 0.0)
        with np.errstate(all="ignore"):
            model = self._model(situation)
            start = self._guess(situation) if last is None else self._shifted(situation, last)
            done = walk(model, self._programs, start, (most, gain))
        if not (np.isfinite(done.states).all() and np.isfinite(done.lack)):
            return Replan(None, "failed", "the motion from here is beyond all numbers")
        n, step = self._problem.horizon
        plan = Plan(
            np.asarray(situation.time + step * np.arange(n + 1)),
            np.vstack([situation.place, done.states[:, :3]]),
            np.vstack([situation.velocity, done.states[:, 3:]]),
            done.inputs,
        )
        opened = done.opened or model.widened
        status: Status = "stalled" if done.stalled else "opened" if opened else "planned"
        return Replan(plan, status, "", done.lack, done.steps)

    def _model(self, situation: ChaseSituation) -> _Model:
        problem = self._problem
        limits, way = problem.keeping.limits, problem.horizon.stages * problem.horizon.step
        way *= max(limits.speed, float(np.linalg.norm(situation.velocity)))
        near = within_reach(self._standing, situation.place, way)
        kept = Kept(problem.keeping, problem.horizon.step, near, situation.target[1:], situation.traffic)
        target = np.hstack([situation.target[1:], situation.target_velocity[1:]])
        slowest, fastest, widened = _bounds(problem, situation)
        return _Model(problem, situation, target, kept, self._rates, self._slopes, slowest, fastest, widened)

    def _shifted(self, situation: ChaseSituation, last: Plan) -> Array:
        """Return the accelerations of the last plan from now on, and none after its end."""
        n, step = self._problem.horizon
        now = (situation.time - last.times[0]) / step + np.arange(n)
        index = np.clip(np.floor(now + 1e-6), 0, len(last.accelerations)).astype(np.int64)
        return np.asarray(np.vstack([last.accelerations, np.zeros(3)])[index])

    def _guess(self, situation: ChaseSituation) -> Array:
        """Return the accelerations of the cubic in time to the wanted state."""
        n, step = self._problem.horizon
        whole = n * step
        share = ((np.arange(n) + 0.5) / n)[:, None]
        way, v0, v1 = situation.wanted - situation.place, situation.velocity, situation.wanted_velocity
        bend = 6.0 * way - whole * (4.0 * v0 + 2.0 * v1)
        return np.asarray((bend - share * (12.0 * way - 6.0 * whole * (v0 + v1))) / whole**2)


def _fault(s: ChaseSituation, last: Plan | None) -> str:
    given = {
        "the drone's measured state": [s.place, s.velocity],
        "the target's predicted motion": [s.target, s.target_velocity],
        "the wanted state": [s.wanted, s.wanted_velocity],
        "a plan that was sent": [s.traffic.others, *(a for c in s.traffic.cones for a in (c.apex, c.axis))],
        "the last plan": [] if last is None else [last.times, last.accelerations],
    }
    total = s.time + (s.height or 0.0) + sum(float(a.sum()) for arrays in given.values() for a in arrays)
    if isfinite(total):
        return ""
    broken = (name for name, arrays in given.items() if not all(np.isfinite(a).all() for a in arrays))
    return f"{next(broken, 'a time or a height')} is not finite"


def _bounds(problem: ChaseProblem, situation: ChaseSituation) -> tuple[Array, Array, bool]:
    """Return the bounds of velocities, (N, 3) each, and whether the measured one opens them.

    Who is too fast gets back within them by the acceleration that can be had along every axis at once.
    """
    n, step = problem.horizon
    limits, v = problem.keeping.limits, situation.velocity
    lowest = np.array([-limits.speed, -limits.speed, -limits.descent])
    highest = np.array([limits.speed, limits.speed, limits.climb])
    each = limits.acceleration / np.sqrt(3.0) * step
    if (v >= lowest - each).all() and (v <= highest + each).all():
        return np.tile(lowest, (n, 1)), np.tile(highest, (n, 1)), False
    back = each * np.arange(1, n + 1)[:, None]
    return np.minimum(lowest, v + back), np.maximum(highest, v - back), True


@dataclass(frozen=True, slots=True, eq=False)
class _Model:
    """One replan; target : its states, (N, 6); slowest, fastest : bounds of the velocities, (N, 3).

    widened : whether these bounds are not the limits, which are out of reach
    """

    problem: ChaseProblem
    situation: ChaseSituation
    target: Array
    kept: Kept
    turning: Mapped
    slopes: Mapped
    slowest: Array
    fastest: Array
    widened: bool

    @property
    def prices(self) -> tuple[float, float]:
        return LACKING, OUTSIDE

    def allowed(self, inputs: Array) -> Array:
        most = self.problem.keeping.limits.acceleration
        size = np.sqrt(np.einsum("nd,nd->n", inputs, inputs))
        return np.asarray(inputs * (most / np.maximum(size, most))[:, None])

    def rolled(self, inputs: Array) -> Array:
        step, states = self.problem.horizon.step, np.empty((len(inputs), STATES))
        velocities = states[:, 3:]
        velocities[:] = self.situation.velocity + step * inputs.cumsum(axis=0)
        ways = step * (velocities - 0.5 * step * inputs)
        states[:, :3] = self.situation.place + ways.cumsum(axis=0)
        return states

    def cost(self, inputs: Array, states: Array) -> float:
        w = self.problem.weights
        turns = self.turning(states, self.target)[0][:-1]
        cost = w.effort * (inputs**2).sum() + w.end * (self._missed(states) ** 2).sum()
        cost += w.yaw * (turns[:, 0] ** 2).sum() + w.pitch * (turns[:, 1] ** 2).sum()
        if self.situation.height is not None:
            cost += w.height * ((states[:, 2] - self.situation.height) ** 2).sum()
        return float(cost)

    def rows(self, inputs: Array, states: Array) -> Rows:
        return rows(self.kept, states)

    def excess(self, states: Array) -> float:
        v = states[:, 3:]
        return float((np.maximum(v - self.fastest, 0.0) + np.maximum(self.slowest - v, 0.0)).sum())

    def quadratic(self, inputs: Array, states: Array, rows: Rows, opened: bool) -> Quadratic:
        n, w = len(inputs), self.problem.weights
        gradient, hessian = np.zeros((n, 9)), np.zeros((n, 9, 9))
        gradient[:, :3] = 2.0 * w.effort * inputs
        diagonal = np.zeros((n, 9))
        diagonal[:, :3] = 2.0 * w.effort
        turns, slope = self.slopes(states, self.target)
        each = np.array([w.yaw, w.pitch])
        slopes = slope.reshape(n, STATES, 2)[:-1]
        weighted = slopes * (2.0 * each)
        gradient[:-1, 3:] = np.einsum("nxr,nr->nx", weighted, turns[:-1])
        hessian[:-1, 3:, 3:] = weighted @ slopes.transpose(0, 2, 1)
        if self.situation.height is not None:
            gradient[:, 5] += 2.0 * w.height * (states[:, 2] - self.situation.height)
            diagonal[:, 5] += 2.0 * w.height
        gradient[-1, 3:] += 2.0 * w.end * self._missed(states)
        diagonal[-1, 3:] += 2.0 * w.end
        hessian[:, np.arange(9), np.arange(9)] += diagonal + DAMPING
        onward, driven = _motion(n, self.problem.horizon.step)
        low, high = self._step_bounds(inputs, states, opened)
        return Quadratic(gradient, hessian, onward, driven, rows, LACKING, low, high, _PATTERN)

    def _step_bounds(self, inputs: Array, states: Array, opened: bool) -> tuple[Array, Array]:
        most = self.problem.keeping.limits.acceleration
        v, low = states[:, 3:], np.full((len(states), 9), -np.inf)
        high = -low
        low[:, :3], high[:, :3] = -most - inputs, most - inputs
        low[:, 6:] = (np.minimum(self.slowest, v) if opened else self.slowest) - v
        high[:, 6:] = (np.maximum(self.fastest, v) if opened else self.fastest) - v
        return low, high

    def _missed(self, states: Array) -> Array:
        s = self.situation
        return np.asarray(states[-1] - np.concatenate([s.wanted, s.wanted_velocity]))


def _pattern() -> Pattern:
    hessian = np.eye(INPUTS + STATES, dtype=np.bool_)
    hessian[INPUTS:, INPUTS:] = True
    onward, driven = _motion(1, 1.0)
    return pattern(hessian, onward[0] != 0, driven[0] != 0)


@lru_cache(maxsize=8)
def _motion(stages: int, step: float) -> tuple[Array, Array]:
    """Return the derivatives of the next state by the state, (N, 6, 6), and by the input, (N, 6, 3)."""
    one = np.eye(3)
    onward = np.block([[one, step * one], [np.zeros((3, 3)), one]])
    driven = np.vstack([0.5 * step**2 * one, step * one])
    return np.tile(onward, (stages, 1, 1)), np.tile(driven, (stages, 1, 1))


def _symbols() -> tuple[list[Any], Any]:
    x, target = ca.SX.sym("x", STATES), ca.SX.sym("target", STATES)
    ray = target - x
    return [x, target], ca.vertcat(*rates(ray[:3], ray[3:]))


@lru_cache(maxsize=1)
def _turning() -> Any:
    """Return the yaw and pitch rate of the camera (Eq. 11, differentiated) by states of drone and target."""
    given, turns = _symbols()
    return dense("turning", given, [turns])


@lru_cache(maxsize=1)
def _turning_with_slopes() -> Any:
    given, turns = _symbols()
    return dense("turning_with_slopes", given, [turns, ca.jacobian(turns, given[0])])


_PATTERN = _pattern()
