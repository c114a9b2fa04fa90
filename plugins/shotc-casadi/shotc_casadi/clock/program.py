"""Solving the programme of one shot on its own clock, by fatrop or IPOPT; what they say is checked."""

from __future__ import annotations

import time
from functools import lru_cache
from typing import Any

import numpy as np

from shotc.refiner_api import Array
from shotc_casadi.clock.problem import ClockProblem
from shotc_casadi.clock.symbols import POINTS, Sizes, derived
from shotc_casadi.patience import PATIENCE, Endless, within
from shotc_casadi.program import Solution, Solver, Status, built

TOLERANCE = 1e-5
FEASIBLE = 1e-4  # of a constraint's residual, each in its own unit
ROWS = ("speed", "acceleration", "jerk", "speed", "climb and descent")
UNITS = {
    "speed": "m^2/s^2",
    "acceleration": "m^2/s^4",
    "jerk": "m^2/s^6",
    "climb and descent": "m/s",
    "clearance": "m",
}


def solve(task: ClockProblem, solver: Solver) -> Solution:
    """Solve a problem from its first guess."""
    n = task.stages
    start = _flat(task.states, task.inputs)
    began = time.perf_counter()

    def nothing(status: Status) -> Solution:
        took = time.perf_counter() - began
        return Solution(status, solver, task.states, task.inputs, np.nan, 0, took, np.nan, 0, ROWS[0])

    if not (np.isfinite(start).all() and np.isfinite(task.parameters).all()):
        return nothing("nan")
    programme = programme_of(n, task.sizes, solver)
    lower, upper = _constraint_bounds(task)
    given = {
        "x0": start,
        "p": task.parameters.ravel(),
        "lbx": _flat(task.state_bounds[0], np.tile(task.least, (n, 1))),
        "ubx": _flat(task.state_bounds[1], np.full_like(task.inputs, np.inf)),
        "lbg": lower,
        "ubg": upper,
    }
    began = time.perf_counter()
    try:
        out = within(PATIENCE, lambda: programme(**given))
    except RuntimeError:
        return nothing("nan")
    except Endless:
        programme_of.cache_clear()  # the one left behind is still at work on its memory
        return nothing("stopped")
    seconds = time.perf_counter() - began
    stats = programme.stats()
    x, g = np.array(out["x"]).ravel(), np.array(out["g"]).ravel()
    wide = task.sizes.states
    inner = x[:-wide].reshape(n, -1)
    states, inputs = np.vstack([inner[:, :wide], x[-wide:]]), inner[:, wide:]
    if not (np.isfinite(x).all() and np.isfinite(g).all()):
        return nothing("nan")
    violation = np.maximum(np.maximum(lower - g, g - upper), 0.0)
    worst = int(violation.argmax())
    return Solution(
        _status(stats, float(violation[worst])),
        solver,
        states,
        inputs,
        float(out["f"]),
        int(stats["iter_count"]),
        seconds,
        float(violation[worst]),
        min(worst // _high(task), n),
        _name(worst, task),
    )


@lru_cache(maxsize=16)
def programme_of(stages: int, sizes: Sizes, solver: Solver) -> Any:
    """Return the solver of all problems of one shape."""
    return built(derived(*sizes), stages, solver, TOLERANCE)


def cost(task: ClockProblem, states: Array, inputs: Array) -> float:
    """Return what a motion costs by a programme; what ellipsoids ask slacks for is paid.

    inputs : shape (N, sizes.moves), without those slacks
    """
    sizes, made = task.sizes, derived(*task.sizes)
    u = np.zeros((len(inputs), sizes.inputs))
    u[:, : sizes.moves] = inputs[:, : sizes.moves]
    rows = np.array(made.cost.map(len(u))(np.hstack([states[:-1], u]).T, task.parameters[:-1].T)[2])
    lack = np.maximum(-rows[2 + sizes.limits + POINTS * sizes.planes :].T, 0.0)
    if sizes.screens:
        u[:, sizes.moves] = lack[:, : sizes.screens].max(axis=1)
    if sizes.bodies:
        u[:, -1] = lack[:, sizes.screens :].max(axis=1)
    value = made.cost.map(len(u))(np.hstack([states[:-1], u]).T, task.parameters[:-1].T)[0]
    return float(np.array(value).sum()) + float(made.last_cost(states[-1], task.parameters[-1])[0])


def _status(stats: dict[str, Any], residual: float) -> Status:
    # A success flag alone is no evidence.
    if stats["success"] and residual < FEASIBLE:
        return "solved"
    return "infeasible" if "nfeasible" in str(stats.get("return_status", "")) else "stopped"


def _high(task: ClockProblem) -> int:
    """Return how many rows a stage has: the motion, held and driven constraints."""
    sizes = task.sizes
    return sizes.states + 2 + len(task.driven[0])


def _name(row: int, task: ClockProblem) -> str:
    high, stages, sizes = _high(task), task.stages, task.sizes
    inner = row % high if row < stages * high else sizes.states + row - stages * high
    if inner < sizes.states:
        return "the motion from stage to stage"
    inner -= sizes.states
    if inner < len(ROWS):
        return ROWS[inner]
    inner -= 2
    if inner < sizes.limits:
        return "the gimbal's pitch"
    inner -= sizes.limits + POINTS * sizes.planes
    if inner < 0:
        return "clearance"
    return "the line of sight" if inner < sizes.screens else "distance"


def _constraint_bounds(task: ClockProblem) -> tuple[Array, Array]:
    ends = []
    for side in (0, 1):
        rows = np.concatenate([np.zeros(task.sizes.states), task.held[side], task.driven[side]])
        ends.append(np.concatenate([np.tile(rows, task.stages), task.held[side]]))
    return ends[0], ends[1]


def _flat(states: Array, inputs: Array) -> Array:
    return np.concatenate([np.hstack([states[:-1], inputs]).ravel(), states[-1]])
