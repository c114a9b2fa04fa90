"""A replan of a shot of one target by fatrop to its end, for comparison: exact Hessians, from the same plan.

The problem is that of ``shotc_casadi.replan.chase`` past one round zone, in its own symbols: the same cost,
the same margin, the worst of a stage priced alike. It has no stop at its end, which makes it easier.
"""

from __future__ import annotations

import time
from functools import cache
from typing import Any, NamedTuple

import casadi as ca
import numpy as np
from shotc_casadi.clock.angles import rates
from shotc_casadi.derivatives import differentiated, laid_out
from shotc_casadi.symbols import StageSymbols

from shotc.geom.bernstein import Array
from shotc.geom.solids import Cylinder
from shotc.plugin_api.replanner import ChaseProblem, ChaseSituation

DT = 0.1
STATES, WIDTH, SIZE = 6, 10, 23
SLACK = 1e-4  # metres a unit of slack: the solver begins with a price of 1
FIXED = 1e-9
OPTIONS = {"print_level": 0, "tol": 1e-4, "max_iter": 300, "max_soc": 0, "mu_init": 1e-2}


class Solved(NamedTuple):
    """What came of it: inputs (N, 3), whether it converged, iterations, CPU seconds."""

    inputs: Array
    converged: bool
    iterations: int
    seconds: float


def solve(problem: ChaseProblem, situation: ChaseSituation, inputs: Array) -> Solved:
    """Solve from the states that inputs (N, 3) lead to."""
    n = problem.horizon.stages
    made, p = _programme(n), _parameters(problem, situation)
    states = _rolled(situation, inputs)
    z = np.hstack([states[:-1], inputs, np.zeros((n, 1))])
    low = np.full((n + 1, WIDTH), -np.inf)
    limits = problem.keeping.limits
    low[:, 3:6] = [-limits.speed, -limits.speed, -limits.descent]
    low[:, 6:9], low[:, 9] = -limits.acceleration, 0.0
    high = -low
    high[:, 9] = np.inf
    low[0, :6], high[0, :6] = states[0] - FIXED, states[0] + FIXED
    rows = np.zeros(STATES)
    given = {
        "x0": np.append(z.ravel(), states[-1]),
        "p": p.ravel(),
        "lbx": np.append(low[:-1].ravel(), low[-1, :6]),
        "ubx": np.append(high[:-1].ravel(), high[-1, :6]),
        "lbg": np.tile([*rows, 0.0], n),
        "ubg": np.tile([*rows, np.inf], n),
    }
    began = time.process_time()
    out = made(**given)
    seconds = time.process_time() - began
    table = np.array(out["x"]).ravel()[: n * WIDTH].reshape(n, WIDTH)
    stats = made.stats()
    return Solved(table[:, 6:9], bool(stats["success"]), int(stats["iter_count"]), seconds)


@cache
def _programme(stages: int) -> Any:
    d = differentiated(_stage())
    x = ca.MX.sym("x", stages * WIDTH + STATES)
    p = ca.MX.sym("p", (stages + 1) * SIZE)
    z, given = ca.reshape(x[: stages * WIDTH], WIDTH, stages), ca.reshape(p, SIZE, stages + 1)
    end = x[stages * WIDTH :]
    cost, end_cost = d.cost.map(stages)(z, given[:, :stages]), d.last_cost(end, given[:, stages])
    gap, bound = d.rows.map(stages)(z, given[:, :stages])
    rows = ca.vec(ca.vertcat(ca.horzcat(z[:STATES, 1:], end) - gap, bound))
    nlp = {"x": x, "p": p, "f": ca.sum2(cost) + end_cost, "g": rows}
    options = {
        "print_time": False,
        "calc_lam_p": False,
        "cache": laid_out(d, "fatrop", stages, x, p),
        "structure_detection": "manual",
        "N": stages,
        "nx": [STATES] * (stages + 1),
        "nu": [4] * stages + [0],
        "ng": [1] * stages + [0],
        "equality": ([True] * STATES + [False]) * stages,
        "fatrop": OPTIONS,
    }
    return ca.nlpsol("warm", "fatrop", nlp, options)


def _stage() -> StageSymbols:
    z, p = ca.SX.sym("z", WIDTH), ca.SX.sym("p", SIZE)
    place, v, u, slack = z[:3], z[3:6], z[6:9], z[9]
    target, moves, wanted = p[:3], p[3:6], p[6:12]
    effort, pitch, yaw, end, tall, height = (p[k] for k in range(12, 18))
    centre, radius, price, margin = p[18:20], p[20], p[21], p[22]
    following = ca.vertcat(place + DT * (v + DT * u / 2), v + DT * u)
    yaw_rate, pitch_rate = rates(target - place, moves - v)
    passing = effort * ca.sumsqr(u) + pitch * pitch_rate**2 + yaw * yaw_rate**2 + price * slack
    node = tall * (place[2] - height) ** 2 + end * ca.sumsqr(z[:6] - wanted)
    cut = ca.sumsqr(following[3:6]) * DT**2 / (8 * (radius + margin))
    clear = ca.norm_2(following[:2] - centre) - radius - margin - cut + SLACK * slack
    return StageSymbols(z, p, following, node, passing, ca.SX(0, 1), clear)


def _parameters(problem: ChaseProblem, situation: ChaseSituation) -> Array:
    n, w, s = problem.horizon.stages, problem.weights, situation
    (zone,) = problem.keeping.zones
    assert isinstance(zone.solid, Cylinder)
    p = np.zeros((n + 1, SIZE))
    p[:, :3], p[:, 3:6] = s.target, s.target_velocity
    p[:, 6:12] = np.concatenate([s.wanted, s.wanted_velocity])
    p[:, 12:15] = w.effort, w.pitch, w.yaw
    p[-1, 15] = w.end
    p[:, 16], p[:, 17] = w.height, s.height or 0.0
    p[:, 18:21] = *zone.solid.centre, zone.solid.radius
    p[:, 21], p[:, 22] = 1e4 * SLACK, problem.keeping.margin + zone.metres
    return p


def _rolled(situation: ChaseSituation, inputs: Array) -> Array:
    v = situation.velocity + DT * np.vstack([np.zeros(3), np.cumsum(inputs, axis=0)])
    places = np.cumsum(DT * (v[:-1] + 0.5 * DT * inputs), axis=0)
    return np.hstack([situation.place + np.vstack([np.zeros(3), places]), v])


def paid(problem: ChaseProblem, situation: ChaseSituation, inputs: Array) -> float:
    """Return what a motion costs, with what it lacks priced, by the symbols of this module."""
    p, states = _parameters(problem, situation), _rolled(situation, inputs)
    (zone,) = problem.keeping.zones
    assert isinstance(zone.solid, Cylinder)
    room = zone.solid.radius + problem.keeping.margin + zone.metres
    cut = (states[1:, 3:] ** 2).sum(axis=1) * DT**2 / (8 * room)
    lack = room + cut - np.hypot(*(states[1:, :2] - zone.solid.centre).T)
    slack = np.maximum(lack, 0.0) / SLACK
    z = np.hstack([states[:-1], inputs, slack[:, None]])
    d = differentiated(_stage())
    cost = d.cost.map(len(inputs))(z.T, p[:-1].T)
    return float(np.array(cost).sum() + float(d.last_cost(states[-1], p[-1])))
