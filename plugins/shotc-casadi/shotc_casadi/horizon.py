"""Repeats one stage over the horizon: a nonlinear programme for fatrop or IPOPT.

A process builds a programme once for each kind of stage, number of stages and pattern of bounds. The mission
enters only by the parameters.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Any, Literal

import casadi as ca

from shotc_casadi.derivatives import Derived, laid_out

Solver = Literal["fatrop", "ipopt"]
MOST_ITERATIONS = 300


@lru_cache(maxsize=32)
def built(d: Derived, stages: int, solver: Solver, tolerance: float, pattern: bytes) -> Any:
    """Return the solver for all problems of one kind of stage; unknowns x stage by stage, parameters p.

    pattern : of the bounds, as ``solving`` makes it for fatrop. If it changes, CasADi 3.8.2 makes a new
        solver without its options (such as the tolerance): a problem of 8 iterations then took 17.
    """
    states, wide = d.states, d.width
    x = ca.MX.sym("x", stages * wide + states)
    p = ca.MX.sym("p", (stages + 1) * d.size)
    z, end = ca.reshape(x[: stages * wide], wide, stages), x[stages * wide :]
    given = ca.reshape(p, d.size, stages + 1)
    following = ca.horzcat(z[:states, 1:], end)
    gap, bound = d.rows.map(stages)(z, given[:, :stages])
    rows = ca.vertcat(ca.vec(ca.vertcat(following - gap, bound)), d.last_rows(end, given[:, stages]))
    cost = ca.sum2(d.cost.map(stages)(z, given[:, :stages])) + d.last_cost(end, given[:, stages])
    nlp = {"x": x, "p": p, "f": cost, "g": rows}
    layout: dict[str, Any] = {
        "structure_detection": "manual",
        "N": stages,
        "nx": [states] * (stages + 1),
        "nu": [d.inputs] * stages + [0],
        "ng": [d.bound] * stages + [d.last_bound],
        "equality": ([True] * states + [False] * d.bound) * stages + [False] * d.last_bound,
        "fatrop": {"print_level": 0, "tol": tolerance, "max_iter": MOST_ITERATIONS, "max_soc": 0},
    }
    quiet: dict[str, Any] = {
        "ipopt": {"print_level": 0, "sb": "yes", "tol": tolerance, "max_iter": MOST_ITERATIONS}
    }
    # The status reports NaN; multipliers of the parameters are not needed.
    silent = {"print_time": False, "show_eval_warnings": False, "calc_lam_p": False}
    options: dict[str, Any] = {**silent, "cache": laid_out(d, solver, stages, x, p)}
    return ca.nlpsol("framing", solver, nlp, options | (layout if solver == "fatrop" else quiet))
