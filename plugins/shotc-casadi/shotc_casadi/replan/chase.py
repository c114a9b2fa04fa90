"""Shots of one target: Alcantara et al., Eq. 12, replanned from every measured state.

The state is position and velocity. The input is the acceleration, constant over a step. The cost of a stage
contains its acceleration, the difference of its height from that of the shot, and the rates of the camera
that looks at the target. The last stage has the distance from the reference state instead of the rates. The
cost of the measured stage is constant and is left out.
"""

from __future__ import annotations

from functools import lru_cache, partial
from math import isfinite

import casadi as ca
import numpy as np

from shotc.plugin_api.replanner import Array, ChaseProblem, ChaseSituation, Plan, Replan
from shotc_casadi.clock.angles import rates
from shotc_casadi.replan.evaluation import HorizonFunctions, Prices, StageExpressions, horizon
from shotc_casadi.replan.flight import BOUND_PARAMETERS, ShotSolvers, beside, fault, sent
from shotc_casadi.replan.keeping import RowCounts, ends, length, pitched, rows, within
from shotc_casadi.replan.steps import Solver, StopRule

PRICES = Prices(lacking=(1e4,), outside=30.0, damping=1e-3)  # of a metre, of a m/s, of the squared step
FIRST, WARM = StopRule(30, 1e-3), StopRule(1, 0.0)
STATES, INPUTS = 6, 3
STAGE_PARAMETERS = (
    BOUND_PARAMETERS + 8
)  # parameters of a stage: also the target, 1 if not the last stage, 1 if the last stage
SHARED_PARAMETERS = 12  # parameters of all stages: weights, reference state, height


class ShotChase:
    """Plans a shot of one target (``ChasePlanner``)."""

    def __init__(self, problem: ChaseProblem, stop_rule: StopRule = WARM) -> None:
        """Allocate memory; until : when a warm-started replan stops, for a finer plan than the default."""
        self._weights, self._until = problem.weights, stop_rule
        horizon_of = partial(_horizon, stages=problem.horizon.stages)
        self._flight = ShotSolvers(problem.keeping, problem.horizon, horizon_of, self._begin)

    def replan(self, situation: ChaseSituation, last: Plan | None) -> Replan:
        """Plan from the measured state: one step from the last plan, or up to 30 without one."""
        s, flight = situation, self._flight
        with np.errstate(all="ignore"):
            solver, widened = flight.solver(s.place, s.velocity, s.traffic, s.walls)
            into = solver.evaluation
            into.given[:, 6:9], into.given[:, 9:12] = s.target[1:], s.target_velocity[1:]
            into.common[5:8], into.common[8:11] = s.wanted, s.wanted_velocity
            into.common[3] = 0.0 if s.height is None else self._weights.height
            into.common[11] = 0.0 if s.height is None else s.height
            start = self._guess(s) if last is None else self._shifted(s, last)
            elapsed = s.time - (0.0 if last is None else last.times[0])
            if not (into.is_finite and isfinite(elapsed) and isfinite(start.sum())):
                return fault(_given(s, last))
            walk = solver.walk(start, FIRST if last is None else self._until)
            return flight.replan_of(solver, walk, s.time, widened)

    def _begin(self, solver: Solver) -> None:
        w, into = self._weights, solver.evaluation
        into.given[:, 12], into.given[-1, 12:14] = 1.0, (0.0, 1.0)
        into.common[:5] = w.effort, w.pitch, w.yaw, w.height, w.end

    def _shifted(self, s: ChaseSituation, last: Plan) -> Array:
        """Return the accelerations of the last plan from now on, (N, 3); zero after its end."""
        flown = np.concatenate([last.accelerations, np.zeros((1, 3))])
        return np.asarray(flown[self._flight.index(s.time, last)])

    def _guess(self, s: ChaseSituation) -> Array:
        """Return the accelerations of the cubic in time to the reference state, (N, 3)."""
        times = self._flight.times
        whole = float(times[-1])
        share = ((times[1:] + times[:-1]) / (2.0 * whole))[:, None]
        displacement, v0, v1 = s.wanted - s.place, s.velocity, s.wanted_velocity
        bend = 6.0 * displacement - whole * (4.0 * v0 + 2.0 * v1)
        return np.asarray((bend - share * (12.0 * displacement - 6.0 * whole * (v0 + v1))) / whole**2)


@lru_cache(maxsize=32)
def _horizon(of: RowCounts, stages: int) -> HorizonFunctions:
    x, u, y = ca.SX.sym("x", STATES), ca.SX.sym("u", INPUTS), ca.SX.sym("y", STATES)
    p, g = ca.SX.sym("p", STAGE_PARAMETERS + of.each), ca.SX.sym("g", SHARED_PARAMETERS + of.common)
    effort, pitch, yaw, height, end = ca.vertsplit(g[:5])
    shared, target = g[SHARED_PARAMETERS:], p[6:12]
    step, most = shared[0], shared[2]
    place, v, q = y[:3], y[3:], y[:3] - target[:3]
    yaw_rate, pitch_rate = rates(target[:3] - place, target[3:] - v)
    residuals = ca.vertcat(
        ca.sqrt(effort) * u,
        p[12] * ca.sqrt(yaw) * yaw_rate,
        p[12] * ca.sqrt(pitch) * pitch_rate,
        ca.sqrt(height) * (y[2] - g[11]),
        p[13] * ca.sqrt(end) * (y - g[5:11]),
    )
    free, (allowed, firm) = ca.SX.inf(3), within(u, most)
    stage = StageExpressions(
        x,
        u,
        y,
        p,
        g,
        allowed=allowed,
        following=ca.vertcat(x[:3] + step * (x[3:] + 0.5 * step * u), x[3:] + step * u),
        residuals=residuals,
        rows=(
            ca.vertcat(
                rows(of, (place, v, q / length(q)), p[STAGE_PARAMETERS:], shared), pitched(of, q, shared)
            ),
        ),
        firm=firm,
        ends=ends(of, place, v, shared),
        inputs=(-most * ca.SX.ones(INPUTS), most * ca.SX.ones(INPUTS)),
        states=(ca.vertcat(-free, p[:3]), ca.vertcat(free, p[3:BOUND_PARAMETERS])),
    )
    return horizon(stage, stages, PRICES)


def _given(s: ChaseSituation, last: Plan | None) -> dict[str, list[Array]]:
    return {
        "the drone's measured state": [s.place, s.velocity],
        "the target's predicted motion": [s.target, s.target_velocity],
        "the wanted state": [s.wanted, s.wanted_velocity],
        "a plan that was sent": sent(s.traffic),
        "a wall": beside(s.walls),
        "the last plan": [] if last is None else [last.times, last.accelerations],
        "the time or the height": [np.array([s.time, s.height or 0.0])],
    }
