"""Sparse rows of a cone programme, collected in bulk and passed to Clarabel without a modelling layer.

The same structures of problems repeat for every move of every drone. cvxpy would compile each grid size
again, which takes longer than the solution.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import clarabel
import numpy as np
from numpy.typing import NDArray

from shotc.solvers.conic import Status

Array = NDArray[np.float64]
BoolArray = NDArray[np.bool_]
# Columns and their values, one entry for each row.
Term = tuple[NDArray[Any], Array]

USABLE = frozenset({Status.SOLVED, Status.INACCURATE})
BESIDE_CONES = (
    4  # neighbours on each side of a violated cone that are added with it (rows are in the curve's order)
)
REFINED_SHARE = 1e-3  # share of the tolerance to which the linear systems of a step are solved
ROUNDING_SHARE = 1e-13  # absolute value of it, if that does not suffice


class WarmStart(NamedTuple):
    """A guess of the unknowns, and the share of its bound at which a cone is active at first."""

    x: Array
    share: float


class _Block(NamedTuple):
    """Cones of one kind and dimension; rows : of all of them."""

    kind: str
    dim: int
    cones: int
    rows: slice


class ConeRows:
    """Expressions constant + sum of terms over ``unknowns`` columns, each in a cone."""

    def __init__(self, unknowns: int) -> None:
        self.unknowns = unknowns
        self._rows: list[NDArray[Any]] = []
        self._cols: list[NDArray[Any]] = []
        self._values: list[Array] = []
        self._constants: list[Array] = []
        self._blocks: list[_Block] = []
        self._count = 0

    def zero(self, terms: list[Term], constant: Array | None = None) -> None:
        """Require constant + terms = 0; constant : shape (R,)."""
        self._add("zero", [np.zeros(len(terms[0][0])) if constant is None else constant], [terms])

    def positive(self, constant: Array, terms: list[Term]) -> None:
        """Require constant + terms >= 0; constant : shape (R,)."""
        self._add("positive", [constant], [terms])

    def second_order(
        self, constant: Array, entries: list[list[Term]], rest: list[Array] | None = None
    ) -> None:
        """Require that the first entry bounds the norm of the others.

        constant : of the first entry, shape (R,); rest : constants of the others, zero by default
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
        self._blocks.append(_Block(kind, dim, cones, slice(self._count, self._count + dim * cones)))
        self._count += dim * cones

    def solve(
        self,
        cost: Array,
        tolerance: float,
        hessian: Any = None,
        *,
        scaled: bool = False,
        near: WarmStart | None = None,
    ) -> tuple[Status, Array]:
        """Minimise cost.x + x.hessian.x / 2; return the status and x (meaningless unless SOLVED or
        INACCURATE).

        cost : shape (unknowns,)
        hessian : a sparse matrix, or its diagonal as an array; None for a linear cost
        scaled : whether unknowns and rows are scaled already; then Clarabel's equilibration is switched off,
            because it would only be slower
        near : switches on constraint generation, because few of a curve's bounds are active. The first
            programme has the cones that the guess reaches. The cones that its solution violates are then
            added. A solution that violates no other cone solves the whole programme.
        """
        from scipy.sparse import csr_matrix

        places = (np.concatenate(self._rows), np.concatenate(self._cols))
        terms = csr_matrix((np.concatenate(self._values), places), shape=(self._count, self.unknowns))
        constants, square = np.concatenate(self._constants), self._square(hessian)
        settings = _settings(tolerance, scaled=scaled)
        active = [np.ones(block.cones, dtype=np.bool_) for block in self._blocks]
        if near is not None:
            active = self._reached(near.share, constants + terms @ near.x, constants)
        while True:
            parts = list(zip(self._blocks, active, strict=True))
            rows = np.concatenate([_rows(*part) for part in parts])
            cones = [cone for part in parts for cone in _cones(*part)]
            # Clarabel's form is A x + s = rhs with s in the cone; s is our expression, so A = -terms.
            status, x = _solved((square, cost, -terms[rows].tocsc(), constants[rows], cones), settings)
            if all(part.all() for part in active):
                return status, x
            if status in USABLE:
                reached = self._reached(1.0 + tolerance, constants + terms @ x, constants)
                broken = [new & ~old for new, old in zip(reached, active, strict=True)]
                if not any(part.any() for part in broken):
                    return status, x
                active = [old | _widened(new) for new, old in zip(broken, active, strict=True)]
            else:
                active = [np.ones_like(part) for part in active]

    def _reached(self, share: float, values: Array, constants: Array) -> list[BoolArray]:
        """Return for each block the mask of cones whose values reach a share of their bound; equalities
        always.

        values, constants : of all rows; the bound of a half-space is its constant
        """
        reached = []
        for block in self._blocks:
            value = values[block.rows].reshape(block.cones, block.dim)
            if block.kind == "cone":
                reached.append(np.linalg.norm(value[:, 1:], axis=1) >= share * value[:, 0])
            elif block.kind == "positive":
                reached.append(value[:, 0] <= (1.0 - share) * np.abs(constants[block.rows]))
            else:
                reached.append(np.ones(block.cones, dtype=np.bool_))
        return reached

    def _square(self, hessian: Any) -> Any:
        """Return the upper triangle of a Hessian, given as in ``solve``, in sparse columns."""
        from scipy.sparse import csc_matrix, triu

        if hessian is None:
            return csc_matrix((self.unknowns, self.unknowns))
        if isinstance(hessian, np.ndarray):
            each = np.arange(self.unknowns)
            return csc_matrix((hessian, (each, each)))
        return triu(hessian, format="csc")


def _rows(block: _Block, active: BoolArray) -> NDArray[np.int_]:
    """Return the rows of a block's active cones."""
    each = np.arange(block.rows.start, block.rows.stop).reshape(block.cones, block.dim)
    return each[active].ravel()


def _cones(block: _Block, active: BoolArray) -> Sequence[Any]:
    """Return a block's active cones as Clarabel's types."""
    count = int(active.sum())
    if block.kind == "cone":
        return [clarabel.SecondOrderConeT(block.dim)] * count
    kind = clarabel.ZeroConeT if block.kind == "zero" else clarabel.NonnegativeConeT
    return [kind(count)] if count else []


def _widened(chosen: BoolArray) -> BoolArray:
    """Return the mask with BESIDE_CONES neighbours on each side added."""
    out = chosen.copy()
    for step in range(1, BESIDE_CONES + 1):
        out[step:] |= chosen[:-step]
        out[:-step] |= chosen[step:]
    return out


def _settings(tolerance: float, *, scaled: bool) -> Any:
    settings = clarabel.DefaultSettings()
    settings.verbose = False
    settings.max_threads = 1
    settings.presolve_enable = False
    settings.equilibrate_enable = not scaled
    settings.tol_feas = settings.tol_gap_abs = settings.tol_gap_rel = tolerance
    return settings


def _solved(programme: tuple[Any, ...], settings: Any) -> tuple[Status, Array]:
    """Return Clarabel's status and solution of a programme."""
    # The coarser refinement is faster, but a few programmes make no progress with it.
    for refined in (REFINED_SHARE * settings.tol_feas, ROUNDING_SHARE):
        settings.iterative_refinement_reltol = settings.iterative_refinement_abstol = refined
        solution = clarabel.DefaultSolver(*programme, settings).solve()
        status = _STATUS.get(str(solution.status), Status.FAILED)
        if status is not Status.FAILED:
            break
    return status, np.asarray(solution.x)


_STATUS = {
    "Solved": Status.SOLVED,
    "AlmostSolved": Status.INACCURATE,
    "PrimalInfeasible": Status.INFEASIBLE,
    "AlmostPrimalInfeasible": Status.INFEASIBLE,
    "DualInfeasible": Status.UNBOUNDED,
    "AlmostDualInfeasible": Status.UNBOUNDED,
}
