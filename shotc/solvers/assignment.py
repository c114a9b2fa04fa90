"""Assignment problems: mixed-integer linear programmes with binary choices, solved by HiGHS (scipy)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from shotc.geom.bernstein import Array


@dataclass(frozen=True, slots=True, eq=False)
class AssignmentProgramme:
    """Minimise cost . x with 0 <= x <= highest, once x = 1 and rows x <= most; all shapes by N unknowns.

    cost, highest : (N,); once : (T, N); rows : (R, N); most : (R,)
    whole : number of leading unknowns that are integers
    """

    cost: Array
    highest: Array
    once: Array
    rows: Array
    most: Array
    whole: int


def least_cost(programme: AssignmentProgramme) -> Array | None:
    """Return the optimal x, shape (N,), or None if the programme is infeasible."""
    from scipy.optimize import Bounds, LinearConstraint, milp

    number = len(programme.cost)
    solution = milp(
        programme.cost,
        integrality=(np.arange(number) < programme.whole).astype(float),
        bounds=Bounds(np.zeros(number), programme.highest),
        constraints=[
            LinearConstraint(programme.once, 1.0, 1.0),
            LinearConstraint(programme.rows, -np.inf, programme.most),
        ],
        options={"mip_rel_gap": 0.0},
    )
    return None if solution.x is None else np.asarray(solution.x)
