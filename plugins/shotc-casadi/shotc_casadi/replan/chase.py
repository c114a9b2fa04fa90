"""Shots of one target: Alcantara et al., Eq. 12, planned anew from every measured state.

State: place and velocity; input: acceleration, held over a step. A stage costs its acceleration, its height
off that of the shot and the rates of the camera that looks at the target; the last one the distance from the
wanted state instead of the rates. What the measured stage costs cannot be changed and is left out.
"""

from __future__ import annotations

from functools import lru_cache
from math import isfinite

import casadi as ca
import numpy as np

from shotc.plugin_api.replanner import (
    NO_TRAFFIC,
    Array,
    ChaseProblem,
    ChaseSituation,
    Plan,
    Replan,
    Status,
)
from shotc_casadi.clock.angles import rates
from shotc_casadi.replan.evaluation import Horizon, Prices, Stage, horizon
from shotc_casadi.replan.keeping import Kept, Standing, common, each, ends, kept, rows
from shotc_casadi.replan.steps import Solver, Until

PRICES = Prices(lacking=1e4, outside=30.0, damping=1e-3)  # a metre, a m/s, and of steps
FIRST, WARM = Until(30, 1e-3), Until(1, 0.0)
BEYOND = "the motion from here is beyond all numbers"
STATES, INPUTS = 6, 3
OWN = 14  # parameters of a stage: the target, whether it is not the last, whether it is, bounds of velocity
SHARED = 12  # parameters of all: weights, the wanted state, the height


class Chase:
    """Plans a shot of one target (``ChasePlanner``)."""

    def __init__(self, problem: ChaseProblem, until: Until = WARM) -> None:
        """Take memory; until : where a replan stops that continues a plan, for those who want a finer one."""
        n, limits = problem.horizon.stages, problem.keeping.limits
        self._problem, self._until = problem, until
        self._standing = Standing(problem.keeping)
        self._solvers: dict[Kept, Solver] = {}
        self._times = problem.horizon.step * np.arange(n + 1)
        self._way = float(self._times[-1])  # at a metre a second
        self._back = limits.acceleration / np.sqrt(3.0) * self._times[1:, None] * np.ones(3)
        self._lowest = np.array([-limits.speed, -limits.speed, -limits.descent])
        self._highest = np.array([limits.speed, limits.speed, limits.climb])
        self._solver_of(kept(problem.keeping, self._standing.near(np.zeros(3), 0.0), NO_TRAFFIC))

    def replan(self, situation: ChaseSituation, last: Plan | None) -> Replan:
        """Plan from the measured state on: one step from the last plan, up to 30 where there is none."""
        with np.errstate(all="ignore"):
            solver = self._prepared(situation)
            widened = self._bound(solver, situation.velocity)
            start = self._guess(situation) if last is None else self._shifted(situation, last)
            since = situation.time - (0.0 if last is None else last.times[0])
            if not (solver.evaluation.is_finite and isfinite(since) and isfinite(start.sum())):
                return Replan(None, "failed", _fault(situation, last))
            done = solver.walk(start, FIRST if last is None else self._until)
        motion = done.motion
        if not (isfinite(motion.worst) and isfinite(motion.states.sum())):
            return Replan(None, "failed", BEYOND)
        states = np.concatenate([solver.evaluation.start[None], motion.states])
        times = np.asarray(self._times + situation.time)
        plan = Plan(times, states[:, :3], states[:, 3:], motion.inputs)
        opened = done.opened or widened
        status: Status = "stalled" if done.stalled else "opened" if opened else "planned"
        return Replan(plan, status, "", motion.worst, done.steps)

    def _prepared(self, s: ChaseSituation) -> Solver:
        """Return the solver of a situation with its parameters filled in, bounds excepted."""
        keeping, w = self._problem.keeping, self._problem.weights
        fastest = max(keeping.limits.speed, float(np.linalg.norm(s.velocity)))
        near = self._standing.near(s.place, fastest * self._way)
        solver = self._solver_of(kept(keeping, near, s.traffic))
        into = solver.evaluation
        into.common[SHARED : len(into.common) - len(s.traffic.cones)] = common(
            keeping, near, self._problem.horizon.step
        )
        into.start[:3], into.start[3:] = s.place, s.velocity
        into.given[:, :3], into.given[:, 3:6] = s.target[1:], s.target_velocity[1:]
        if len(s.traffic.others) or s.traffic.cones:
            into.given[:, OWN:] = each(s.traffic)
            into.common[len(into.common) - len(s.traffic.cones) :] = [c.half_angle for c in s.traffic.cones]
        into.common[5:8], into.common[8:11] = s.wanted, s.wanted_velocity
        into.common[3] = 0.0 if s.height is None else w.height
        into.common[11] = 0.0 if s.height is None else s.height
        return solver

    def _solver_of(self, of: Kept) -> Solver:
        if of not in self._solvers:
            w = self._problem.weights
            solver = Solver(_horizon(of, self._problem.horizon.stages))
            into = solver.evaluation
            into.given[:, 6], into.given[-1, 6:8] = 1.0, (0.0, 1.0)
            into.common[:5] = w.effort, w.pitch, w.yaw, w.height, w.end
            self._solvers[of] = solver
        return self._solvers[of]

    def _bound(self, solver: Solver, v: Array) -> bool:
        """Bound the velocities, and tell whether the measured one opens these bounds.

        Who is too fast gets back within them by the acceleration that can be had along every axis at once.
        """
        given, back = solver.evaluation.given, self._back[0]
        given[:, 8:11], given[:, 11:OWN] = self._lowest, self._highest
        if (v >= self._lowest - back).all() and (v <= self._highest + back).all():
            return False
        given[:, 8:11] = np.minimum(self._lowest, v + self._back)
        given[:, 11:OWN] = np.maximum(self._highest, v - self._back)
        return True

    def _shifted(self, situation: ChaseSituation, last: Plan) -> Array:
        """Return the accelerations of the last plan from now on, and none after its end."""
        now = (situation.time + self._times[:-1] - last.times[0]) / self._problem.horizon.step
        index = np.fmin(np.fmax(now + 1e-6, 0.0), len(last.accelerations)).astype(np.int64)
        return np.asarray(np.concatenate([last.accelerations, np.zeros((1, 3))])[index])

    def _guess(self, situation: ChaseSituation) -> Array:
        """Return the accelerations of the cubic in time to the wanted state."""
        whole = self._way
        share = ((self._times[1:] + self._times[:-1]) / (2.0 * whole))[:, None]
        way, v0, v1 = situation.wanted - situation.place, situation.velocity, situation.wanted_velocity
        bend = 6.0 * way - whole * (4.0 * v0 + 2.0 * v1)
        return np.asarray((bend - share * (12.0 * way - 6.0 * whole * (v0 + v1))) / whole**2)


@lru_cache(maxsize=32)
def _horizon(of: Kept, stages: int) -> Horizon:
    x, u, y = ca.SX.sym("x", STATES), ca.SX.sym("u", INPUTS), ca.SX.sym("y", STATES)
    p, g = ca.SX.sym("p", OWN + of.each), ca.SX.sym("g", SHARED + of.common)
    effort, pitch, yaw, height, end = ca.vertsplit(g[:5])
    shared = g[SHARED:]
    step, most = shared[0], shared[2]
    place, v = y[:3], y[3:]
    ray = p[:6] - y
    yaw_rate, pitch_rate = rates(ray[:3], ray[3:])
    residuals = ca.vertcat(
        ca.sqrt(effort) * u,
        p[6] * ca.sqrt(yaw) * yaw_rate,
        p[6] * ca.sqrt(pitch) * pitch_rate,
        ca.sqrt(height) * (y[2] - g[11]),
        p[7] * ca.sqrt(end) * (y - g[5:11]),
    )
    free = ca.SX.inf(3)
    stage = Stage(
        x,
        u,
        y,
        p,
        g,
        allowed=u * most / ca.fmax(ca.norm_2(u), most),
        following=ca.vertcat(x[:3] + step * (x[3:] + 0.5 * step * u), x[3:] + step * u),
        residuals=residuals,
        rows=rows(of, (place, v, p[:3]), p[OWN:], shared),
        ends=ends(of, place, v, shared),
        inputs=(-most * ca.SX.ones(INPUTS), most * ca.SX.ones(INPUTS)),
        states=(ca.vertcat(-free, p[8:11]), ca.vertcat(free, p[11:OWN])),
    )
    return horizon(stage, stages, PRICES)


def _fault(s: ChaseSituation, last: Plan | None) -> str:
    given = {
        "the drone's measured state": [s.place, s.velocity],
        "the target's predicted motion": [s.target, s.target_velocity],
        "the wanted state": [s.wanted, s.wanted_velocity],
        "a plan that was sent": [s.traffic.others, *(a for c in s.traffic.cones for a in (c.apex, c.axis))],
        "the last plan": [] if last is None else [last.times, last.accelerations],
        "the time or the height": [np.array([s.time, s.height or 0.0])],
    }
    broken = (name for name, arrays in given.items() if not all(np.isfinite(a).all() for a in arrays))
    return next((f"{name} is not finite" for name in broken), BEYOND)
