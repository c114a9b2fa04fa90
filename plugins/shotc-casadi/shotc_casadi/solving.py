"""Calls the solver of a programme with a time limit, and checks what the solver reports."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from shotc_casadi.derivatives import Derived
from shotc_casadi.horizon import Solver, built
from shotc_casadi.timeout import TIMEOUT_S, TimedOut, within

Array = NDArray[np.float64]
Status = Literal["solved", "stopped", "infeasible", "nan"]
SOLVERS: tuple[Solver, ...] = ("fatrop", "ipopt")  # IPOPT is the fallback; a diagnostic reports its use
MOTION = "the motion from stage to stage"


@dataclass(frozen=True, slots=True, eq=False)
class Instance:
    """One instance of a programme: N stages, N + 1 nodes.

    kind : of its stages
    parameters : shape (N + 1, kind.size)
    states, inputs : initial guess, shapes (N + 1, kind.states) and (N, kind.inputs)
    state_bounds, input_bounds : (lower, upper), shapes as states and inputs
    held, driven : (lower, upper) of a stage's constraints
    named : the readable name of a row of held and driven, by its index
    tolerance : of the solver
    feasible : largest residual of a constraint, each in its own unit
    """

    kind: Derived
    parameters: Array
    states: Array
    inputs: Array
    state_bounds: tuple[Array, Array]
    input_bounds: tuple[Array, Array]
    held: tuple[Array, Array]
    driven: tuple[Array, Array]
    named: Callable[[int], str]
    tolerance: float
    feasible: float

    @property
    def stages(self) -> int:
        """N."""
        return len(self.inputs)

    @property
    def high(self) -> int:
        """Number of constraint rows of a stage: dynamics, held and driven."""
        return self.kind.states + self.kind.bound


@dataclass(frozen=True, slots=True, eq=False)
class Solution:
    """The result of a solver.

    status : "solved", "stopped" (at a limit of the solver), "infeasible" or "nan"
    seconds : of the solver alone
    residual : the worst violation of a constraint, in its own unit
    stage, constraint : where, and which one; "" if all hold or there are no numbers
    multipliers : multipliers of the constraints held and driven, absolute values, shape (N, kind.bound)
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
    multipliers: Array


class Attempt(NamedTuple):
    """The result of a problem; failed : the result of the solver that failed before, if one did."""

    solution: Solution
    failed: Solution | None = None

    @property
    def seconds(self) -> float:
        """Time of all solvers, seconds."""
        return self.solution.seconds + (self.failed.seconds if self.failed else 0.0)


def by_one_of(solvers: tuple[Solver, ...], solve: Callable[[Solver], Solution]) -> Attempt:
    """Solve with the first solver, and if that fails with the second one."""
    solution = solve(solvers[0])
    if solution.status == "solved" or len(solvers) == 1:
        return Attempt(solution)
    return Attempt(solve(solvers[1]), solution)


def solved(task: Instance, solver: Solver) -> Solution:
    """Solve a programme from its initial guess; returns the guess if the solver leaves no iterate."""
    start = _flat(task.states, task.inputs)
    if not (np.isfinite(start).all() and np.isfinite(task.parameters).all()):
        # fatrop does not end on NaN.
        return _nothing("nan", task, solver, 0.0)
    lower, upper = _rows(task, 0), _rows(task, 1)
    low, high = (_flat(task.state_bounds[side], task.input_bounds[side]) for side in (0, 1))
    pattern = b"" if solver == "ipopt" else _pattern((low, high), (lower, upper))
    programme = built(task.kind, task.stages, solver, task.tolerance, pattern)
    given = {
        "x0": start,
        "p": task.parameters.ravel(),
        "lbx": low,
        "ubx": high,
        "lbg": lower,
        "ubg": upper,
    }
    began = time.perf_counter()
    try:
        out = within(TIMEOUT_S, lambda: programme(**given))
    except RuntimeError:
        # CasADi raises if a solver gives up inside; then there is no iterate.
        return _nothing("nan", task, solver, time.perf_counter() - began)
    except TimedOut:
        built.cache_clear()  # the abandoned solver still uses its memory
        return _nothing("stopped", task, solver, time.perf_counter() - began)
    return _judged(task, solver, out, programme.stats(), time.perf_counter() - began)


def _pattern(*bounds: tuple[Array, Array]) -> bytes:
    """Return which bounds are finite and which ones fix a variable, as bytes."""
    finite = [np.isfinite(side) for pair in bounds for side in pair]
    return np.packbits(np.concatenate([*finite, *(low == high for low, high in bounds)])).tobytes()


def _nothing(status: Status, task: Instance, solver: Solver, seconds: float) -> Solution:
    """Return the initial guess as the solution, for a solver without an iterate."""
    free = np.zeros((task.stages, task.kind.bound))
    return Solution(status, solver, task.states, task.inputs, np.nan, 0, seconds, np.nan, 0, "", free)


def _judged(
    task: Instance, solver: Solver, out: Mapping[str, Any], stats: Mapping[str, Any], seconds: float
) -> Solution:
    """Return the solver's last iterate, judged by its residuals."""
    x, g = np.array(out["x"]).ravel(), np.array(out["g"]).ravel()
    states, inputs = _nodes(x, task)
    iterations, multipliers = int(stats["iter_count"]), _multipliers(out, task)
    if not (np.isfinite(x).all() and np.isfinite(g).all()):
        return Solution(
            "nan", solver, states, inputs, np.nan, iterations, seconds, np.nan, 0, "", multipliers
        )
    violation = np.maximum(np.maximum(_rows(task, 0) - g, g - _rows(task, 1)), 0.0)
    worst = int(violation.argmax())
    residual = float(violation[worst])
    return Solution(
        status=_status(stats, residual < task.feasible),
        solver=solver,
        states=states,
        inputs=inputs,
        objective=float(out["f"]),
        iterations=iterations,
        seconds=seconds,
        residual=residual,
        stage=min(worst // task.high, task.stages),
        constraint=_name(worst, task) if residual >= task.feasible else "",
        multipliers=multipliers,
    )


def _multipliers(out: Mapping[str, Any], task: Instance) -> Array:
    stages = np.array(out["lam_g"]).ravel()[: task.stages * task.high].reshape(task.stages, task.high)
    return np.asarray(np.abs(stages[:, task.kind.states :]))


def _status(stats: Mapping[str, Any], feasible: bool) -> Status:
    # A success flag alone proves nothing.
    if stats["success"] and feasible:
        return "solved"
    status = str(stats.get("return_status", ""))
    return "nan" if "Invalid_Number" in status else "infeasible" if "nfeasible" in status else "stopped"


def _name(row: int, task: Instance) -> str:
    """Return the readable name of a constraint row; the last node has only held rows."""
    closed = task.kind.states
    inner = row % task.high if row < task.stages * task.high else closed + row - task.stages * task.high
    return MOTION if inner < closed else task.named(inner - closed)


def _rows(task: Instance, side: int) -> Array:
    """Return the lower or upper bounds of all constraints."""
    stage = np.concatenate([np.zeros(task.kind.states), task.held[side], task.driven[side]])
    return np.concatenate([np.tile(stage, task.stages), task.held[side]])


def _flat(states: Array, inputs: Array) -> Array:
    return np.concatenate([np.hstack([states[:-1], inputs]).ravel(), states[-1]])


def _nodes(x: Array, task: Instance) -> tuple[Array, Array]:
    wide = task.kind.states
    inner = x[:-wide].reshape(task.stages, -1)
    return np.vstack([inner[:, :wide], x[-wide:]]), inner[:, wide:]
