"""The whole optimal-control problem as a nonlinear programme, for fatrop or IPOPT.

Programmes are built once a process for each number of stages and half-spaces; missions are parameters.
"""

from __future__ import annotations

import time
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, Literal

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from shotc_casadi.conditions import Visibility
from shotc_casadi.derivatives import Derived, derived, laid_out
from shotc_casadi.patience import PATIENCE, Endless, within
from shotc_casadi.symbols import STATES, WIDTH

Array = NDArray[np.float64]
Solver = Literal["fatrop", "ipopt"]
Status = Literal["solved", "stopped", "infeasible", "nan"]
TOLERANCE = 1e-4
FEASIBLE = 1e-3  # of a constraint's residual, each in its own unit
ITERATIONS = 300
NARROW = 1e-3  # least width of a state's bounds: without an interior fatrop does not end


@dataclass(frozen=True, slots=True, eq=False)
class Problem:
    """One instance of the programme: N stages, N + 1 nodes.

    parameters : shape (N + 1, symbols.size(planes))
    states, inputs : first guess, shapes (N + 1, STATES) and (N, INPUTS)
    state_bounds, input_bounds : (lower, upper), shapes as states and inputs
    held, driven : upper bounds (or lower, for half-spaces) of the stage's constraints:
        (lower, upper), each of shape (2 + planes,) and (1,)
    """

    visibility: Visibility
    parameters: Array
    states: Array
    inputs: Array
    state_bounds: tuple[Array, Array]
    input_bounds: tuple[Array, Array]
    held: tuple[Array, Array]
    driven: tuple[Array, Array]

    @property
    def stages(self) -> int:
        """N."""
        return len(self.inputs)

    @property
    def planes(self) -> int:
        """How many half-spaces each node is kept in."""
        return len(self.held[0]) - 2


@dataclass(frozen=True, slots=True, eq=False)
class Solution:
    """What a solver made of a problem.

    status : "solved", "stopped" (at a limit of its own), "infeasible" or "nan"
    residual : the worst violation of a constraint, in its own unit; stage, constraint : where, which
    seconds : of the solver alone
    """

    status: Status
    solver: Solver
    states: Array
    inputs: Array
    objective: float
    iterations: int
    seconds: float
    residual: float
    stage: int
    constraint: str


def solve(problem: Problem, solver: Solver) -> Solution:
    """Solve a problem; what the solver says of itself is checked against the residuals.

    State bounds narrower than NARROW are opened to that about their middle.
    """
    n, planes = problem.stages, problem.planes
    start = _flat(problem.states, problem.inputs)
    if not (np.isfinite(start).all() and np.isfinite(problem.parameters).all()):
        # fatrop does not end on numbers that are none.
        return _nothing("nan", problem, solver, 0.0)
    programme = _programme(n, planes, problem.visibility, solver)
    lower, upper = _constraint_bounds(problem)
    low, high = _opened(*problem.state_bounds)
    began = time.perf_counter()
    given = {
        "x0": start,
        "p": problem.parameters.ravel(),
        "lbx": _flat(low, problem.input_bounds[0]),
        "ubx": _flat(high, problem.input_bounds[1]),
        "lbg": lower,
        "ubg": upper,
    }
    try:
        out = within(PATIENCE, lambda: programme(**given))
    except RuntimeError:
        # CasADi raises where a solver gives up inside; there is no iterate to look at then.
        return _nothing("nan", problem, solver, time.perf_counter() - began)
    except Endless:
        _programme.cache_clear()  # the one left behind is still at work on its memory
        return _nothing("stopped", problem, solver, time.perf_counter() - began)
    seconds = time.perf_counter() - began
    stats = programme.stats()
    x, g = np.array(out["x"]).ravel(), np.array(out["g"]).ravel()
    states, inputs = _nodes(x, n)
    if not (np.isfinite(x).all() and np.isfinite(g).all()):
        return Solution(
            "nan", solver, states, inputs, np.nan, int(stats["iter_count"]), seconds, np.nan, 0, ""
        )
    violation = np.maximum(np.maximum(lower - g, g - upper), 0.0)
    worst = int(violation.argmax())
    return Solution(
        status=_status(stats, float(violation[worst])),
        solver=solver,
        states=states,
        inputs=inputs,
        objective=float(out["f"]),
        iterations=int(stats["iter_count"]),
        seconds=seconds,
        residual=float(violation[worst]),
        stage=min(worst // (STATES + planes + 3), n),
        constraint=_constraint_name(worst, n, planes),
    )


def _nothing(status: Status, problem: Problem, solver: Solver, seconds: float) -> Solution:
    """Return the first guess, where there is no iterate of the solver's own."""
    return Solution(status, solver, problem.states, problem.inputs, np.nan, 0, seconds, np.nan, 0, "")


def _status(stats: dict[str, Any], residual: float) -> Status:
    # A success flag alone is no evidence.
    if stats["success"] and residual < FEASIBLE:
        return "solved"
    return "infeasible" if "nfeasible" in str(stats.get("return_status", "")) else "stopped"


@lru_cache(maxsize=16)
def _programme(stages: int, planes: int, visibility: Visibility, solver: Solver) -> Any:
    """Return the solver of all problems of one shape."""
    return built(derived(visibility, planes), stages, solver)


def built(d: Derived, stages: int, solver: Solver, tolerance: float = TOLERANCE) -> Any:
    """Return the solver of all problems of one kind of stage: unknowns x stage by stage, parameters p."""
    states, wide = d.states, d.width
    x = ca.MX.sym("x", stages * wide + states)
    p = ca.MX.sym("p", (stages + 1) * d.size)
    z, end = ca.reshape(x[: stages * wide], wide, stages), x[stages * wide :]
    given = ca.reshape(p, d.size, stages + 1)
    following = ca.horzcat(z[:states, 1:], end)
    cost, gap, bound = d.cost.map(stages)(z, given[:, :stages])
    end_cost, end_bound = d.last_cost(end, given[:, stages])
    rows = ca.vertcat(ca.vec(ca.vertcat(following - gap, bound)), end_bound)
    nlp = {"x": x, "p": p, "f": ca.sum2(cost) + end_cost, "g": rows}
    layout: dict[str, Any] = {
        "structure_detection": "manual",
        "N": stages,
        "nx": [states] * (stages + 1),
        "nu": [d.inputs] * stages + [0],
        "ng": [d.bound] * stages + [d.last_bound],
        "equality": ([True] * states + [False] * d.bound) * stages + [False] * d.last_bound,
        "fatrop": {"print_level": 0, "tol": tolerance, "max_iter": ITERATIONS, "max_soc": 0},
    }
    quiet: dict[str, Any] = {
        "ipopt": {"print_level": 0, "sb": "yes", "tol": tolerance, "max_iter": ITERATIONS}
    }
    options: dict[str, Any] = {"print_time": False, "cache": laid_out(d, solver, stages, x, p)}
    return ca.nlpsol("framing", solver, nlp, options | (layout if solver == "fatrop" else quiet))


def _opened(low: Array, high: Array) -> tuple[Array, Array]:
    short = np.where(low <= high, np.maximum(0.0, 0.5 * (NARROW - (high - low))), 0.0)
    return low - short, high + short


def _constraint_bounds(problem: Problem) -> tuple[Array, Array]:
    closed = np.zeros(STATES)
    ends = []
    for side in (0, 1):
        stage_rows = np.concatenate([closed, problem.held[side], problem.driven[side]])
        ends.append(np.concatenate([np.tile(stage_rows, problem.stages), problem.held[side]]))
    return ends[0], ends[1]


def _constraint_name(row: int, stages: int, planes: int) -> str:
    inner = row % (STATES + planes + 3) if row < stages * (STATES + planes + 3) else None
    if inner is None:
        inner = STATES + row - stages * (STATES + planes + 3)
    if inner < STATES:
        return "the motion from stage to stage"
    return (
        ("speed", "acceleration")[inner - STATES]
        if inner < STATES + 2
        else ("jerk" if inner == STATES + 2 + planes else "clearance")
    )


def _flat(states: Array, inputs: Array) -> Array:
    return np.concatenate([np.hstack([states[:-1], inputs]).ravel(), states[-1]])


def _nodes(x: Array, stages: int) -> tuple[Array, Array]:
    inner = x[: stages * WIDTH].reshape(stages, WIDTH)
    return np.vstack([inner[:, :STATES], x[stages * WIDTH :]]), inner[:, STATES:]
