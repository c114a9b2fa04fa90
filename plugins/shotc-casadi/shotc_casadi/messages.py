"""Diagnostics and statistics about the solver of a shot; the same for all problems."""

from __future__ import annotations

from shotc.plugin_api import (
    Diagnostic,
    PathIR,
    SolverState,
    fallback,
    impossible,
    solver_nan,
    stopped_early,
)
from shotc_casadi.solving import Solution
from shotc_casadi.timeout import TIMEOUT_S

UNITS = {
    "speed": "m^2/s^2",
    "acceleration": "m^2/s^4",
    "jerk": "m^2/s^6",
    "climb and descent": "m/s",
    "clearance": "m",
}


def word(solution: Solution) -> str:
    """Return why a solver ended without a solution."""
    if solution.status == "nan":
        return "numbers that are none"
    return (
        f"{solution.iterations} iterations"
        if solution.iterations
        else f"{TIMEOUT_S:.0f} s of processor time without an end"
    )


def fallen_back(path: PathIR, shot: str, first: Solution | None, solution: Solution) -> Diagnostic | None:
    """Return the warning that another solver failed first, None if none did."""
    return None if first is None else fallback(path, shot, (first.solver, solution.solver), word(first))


def unsolved(path: PathIR, state: SolverState, solution: Solution) -> Diagnostic:
    """Return the error of a shot that is not refined; ``state`` names the constraint."""
    if solution.status == "nan":
        return solver_nan(path, state)
    if solution.status == "stopped":
        return stopped_early(path, state, word(solution))
    return impossible(path, state)


def stats(
    shot: str, rounds: int, solution: Solution, status: str | None = None
) -> tuple[tuple[str, float | str], ...]:
    """Return the statistics of a shot; status : of its refinement, if it differs from the solver's."""
    return (
        (f"{shot}.refine_stages", float(len(solution.inputs))),
        (f"{shot}.refine_rounds", float(rounds)),
        (f"{shot}.refine_iterations", float(solution.iterations)),
        (f"{shot}.refine_solver", solution.solver),
        (f"{shot}.refine_status", status or solution.status),
    )
