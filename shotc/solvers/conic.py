"""The door to cvxpy: solve a problem, map every outcome onto our own statuses.

``cone_rows`` is the other one, straight to Clarabel.
"""

from __future__ import annotations

import warnings
from enum import StrEnum
from typing import Any


class Status(StrEnum):
    """What became of a convex problem."""

    SOLVED = "solved"
    INFEASIBLE = "infeasible"
    UNBOUNDED = "unbounded"
    INACCURATE = "inaccurate"
    FAILED = "failed"


STATUSES = {
    "optimal": Status.SOLVED,
    "optimal_inaccurate": Status.INACCURATE,
    "infeasible": Status.INFEASIBLE,
    "infeasible_inaccurate": Status.INFEASIBLE,
    "unbounded": Status.UNBOUNDED,
    "unbounded_inaccurate": Status.UNBOUNDED,
    "infeasible_or_unbounded": Status.INFEASIBLE,
    "user_limit": Status.FAILED,
    "solver_error": Status.FAILED,
}


def solve(problem: Any, tolerance: float = 1e-8) -> Status:
    """Solve a cvxpy problem in place with Clarabel.

    tolerance : feasibility and relative gap
    A solver that raises is reported as FAILED, never passed on.
    """
    import cvxpy as cp

    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # what cvxpy warns of is in the status, and is judged there
            problem.solve(
                solver=cp.CLARABEL,
                tol_feas=tolerance,
                tol_gap_rel=tolerance,
                tol_gap_abs=tolerance,
                max_threads=1,
            )
    except cp.error.SolverError:
        return Status.FAILED
    return STATUSES.get(problem.status, Status.FAILED)
