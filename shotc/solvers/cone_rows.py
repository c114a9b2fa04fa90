"""Sparse rows of a cone program, collected in bulk, and the way to Clarabel without a modelling layer.

The same shapes of problem come again for every move of every drone; cvxpy would compile each grid
size anew, which takes longer than solving it.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from shotc.solvers.conic import Status

Array = NDArray[np.float64]
# Columns and their values, one entry a row.
Term = tuple[NDArray[Any], Array]

REFINED = 1e-3  # of a tolerance: to which the linear systems of a step are solved
ROUNDING = 1e-13  # the same where that is not enough


class ConeRows:
    """Expressions constant + sum of terms over ``unknowns`` columns, each in a cone."""

    def __init__(self, unknowns: int) -> None:
        self.unknowns = unknowns
        self._rows: list[NDArray[Any]] = []
        self._cols: list[NDArray[Any]] = []
        self._values: list[Array] = []
        self._constants: list[Array] = []
        self._cones: list[tuple[str, int, int]] = []
        self._count = 0

    def zero(self, terms: list[Term], constant: Array | None = None) -> None:
        """Demand constant + terms = 0."""
        self._add("zero", [np.zeros(len(terms[0][0])) if constant is None else constant], [terms])

    def positive(self, constant: Array, terms: list[Term]) -> None:
        """Demand constant + terms >= 0."""
        self._add("positive", [constant], [terms])

    def second_order(
        self, constant: Array, entries: list[list[Term]], rest: list[Array] | None = None
    ) -> None:
        """Demand that the first entry bounds the norm of the others.

        constant : added to the first entry; rest : constants of the others, zero unless given
        """
        others = rest if rest is not None else [np.zeros_like(constant)] * (len(entries) - 1)
        self._add("cone", [constant, *others], entries)

    def _add(self, kind: str, constants: list[Array], entries: list[list[Term]]) -> None:
        dim, cones = len(entries), len(constants[0])
        base = self._count + dim * np.arange(cones)
        for entry, terms in enumerate(entries):
            row = base + entry
            for cols, values in terms:
                self._rows.append(row)
                self._cols.append(cols)
                self._values.append(values)
        self._constants.append(np.stack(constants, axis=1).ravel())
        self._cones.append((kind, dim, cones))
        self._count += dim * cones

    def solve(
        self, cost: Array, tolerance: float, hessian: Any = None, *, scaled: bool = False
    ) -> tuple[Status, Array]:
        """Minimise cost.x + x.hessian.x / 2; returns the status and x (meaningless unless SOLVED).

        hessian : a sparse matrix, or an array that is the diagonal of one; None for a linear cost
        scaled : whether every unknown and every row is in a unit of its own already, so that Clarabel is not
            to look for others, which only make it slower then
        """
        import clarabel
        from scipy.sparse import csc_matrix

        shape = (self._count, self.unknowns)
        places = (np.concatenate(self._rows), np.concatenate(self._cols))
        # Clarabel's form is A x + s = rhs with s in the cone: s is our expression, so A = -terms.
        lhs = csc_matrix((-np.concatenate(self._values), places), shape=shape)
        cones: list[Any] = []
        for kind, dim, count in self._cones:
            if kind == "cone":
                cones.extend([clarabel.SecondOrderConeT(dim)] * count)
            else:
                cones.append((clarabel.ZeroConeT if kind == "zero" else clarabel.NonnegativeConeT)(count))
        settings = clarabel.DefaultSettings()
        settings.verbose = False
        settings.max_threads = 1
        settings.presolve_enable = False
        settings.equilibrate_enable = not scaled
        settings.tol_feas = settings.tol_gap_abs = settings.tol_gap_rel = tolerance
        programme = (self._square(hessian), cost, lhs, np.concatenate(self._constants), cones)
        # What is solved no finer than that is solved sooner, but a few programmes make no progress so.
        for refined in (REFINED * tolerance, ROUNDING):
            settings.iterative_refinement_reltol = settings.iterative_refinement_abstol = refined
            solution = clarabel.DefaultSolver(*programme, settings).solve()
            status = _STATUS.get(str(solution.status), Status.FAILED)
            if status is not Status.FAILED:
                break
        return status, np.asarray(solution.x)

    def _square(self, hessian: Any) -> Any:
        """Return the upper triangle of a hessian as ``solve`` takes one, in columns."""
        from scipy.sparse import csc_matrix, triu

        if hessian is None:
            return csc_matrix((self.unknowns, self.unknowns))
        if isinstance(hessian, np.ndarray):
            each = np.arange(self.unknowns)
            return csc_matrix((hessian, (each, each)))
        return triu(hessian, format="csc")


_STATUS = {
    "Solved": Status.SOLVED,
    "AlmostSolved": Status.INACCURATE,
    "PrimalInfeasible": Status.INFEASIBLE,
    "AlmostPrimalInfeasible": Status.INFEASIBLE,
    "DualInfeasible": Status.UNBOUNDED,
    "AlmostDualInfeasible": Status.UNBOUNDED,
}
