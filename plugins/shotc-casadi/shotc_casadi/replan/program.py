"""The quadratic programme of one step, stage by stage, solved by PIQP.

The unknowns of a stage are the change of its input, its slack, and the change of the state it leads to. The
measured state is no unknown, so nothing is fixed.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import piqp
from scipy.sparse import csc_matrix

from shotc.plugin_api.replanner import Array
from shotc_casadi.replan.evaluation import Horizon, Index, Slopes

TOLERANCE = 1e-4
ITERATIONS = 50
"""Of PIQP: 10 to 14 are usual, and a programme without a solution takes all of them."""


class Program:
    """Steps about motions over one horizon. It keeps its matrices: one thread may use it at a time."""

    def __init__(self, of: Horizon, price: float) -> None:
        """Lay out its matrices; price : of what the worst row of a stage lacks."""
        n, p = of.stages, of.pattern
        width = of.inputs + of.states + 1
        self._place = np.delete(np.arange(width), of.inputs)
        first = width * np.arange(n)[:, None]
        after, line = np.arange(of.states) + of.inputs + 1, of.states * np.arange(n)[:, None]
        place, size, count = self._place, n * width, n * of.states
        self._cost = _matrix(
            (first + place[p.hessian[0]]).ravel(), (first + place[p.hessian[1]]).ravel(), (size, size)
        )
        self._motion = _matrix(
            np.concatenate(
                [(line + p.driven[0]).ravel(), np.arange(count), (line[1:] + p.onward[0]).ravel()]
            ),
            np.concatenate(
                [
                    (first + p.driven[1]).ravel(),
                    (first + after).ravel(),
                    (first[:-1] + after[p.onward[1]]).ravel(),
                ]
            ),
            (count, size),
        )
        rows = p.rows * np.arange(n)[:, None]
        ends = n * p.rows + np.arange(p.last)
        number = np.arange(n * p.rows + p.last)
        slack = np.append(np.repeat(first, p.rows), np.full(p.last, first[-1])) + of.inputs
        self._bound = _matrix(
            np.concatenate([(rows + p.kept[0]).ravel(), ends[p.ends[0]], number]),
            np.concatenate([(first + place[p.kept[1]]).ravel(), first[-1] + after[p.ends[1]], slack]),
            (len(number), size),
        )
        self._still, self._minus, self._ones = np.zeros(count), -np.ones(count), np.ones(len(number))
        self._linear = np.full((n, width), price)
        self._low, self._high = np.zeros((n, width)), np.full((n, width), np.inf)
        self._solver: Any = None

    def solve(self, slopes: Slopes, low: Array, high: Array) -> Array | None:
        """Return the step (N, U + X) within bounds (N, U + X), or None where the solver found none."""
        place, s = self._place, slopes
        self._linear[:, place], self._low[:, place], self._high[:, place] = s.gradient, low, high
        cost = self._cost.filled(s.hessian.ravel())
        motion = self._motion.filled(np.concatenate([s.driven.ravel(), self._minus, s.onward[1:].ravel()]))
        bound = self._bound.filled(np.concatenate([s.kept.ravel(), s.kept_ends, self._ones]))
        rows, linear = -np.concatenate([s.rows.ravel(), s.ends]), self._linear.ravel()
        box = self._low.ravel(), self._high.ravel()
        if self._solver is None:
            self._solver = _solver()
            self._solver.setup(cost, linear, motion, self._still, bound, rows, None, *box)
        else:
            self._solver.update(cost, linear, motion, self._still, bound, rows, None, *box)
        if self._solver.solve() != piqp.PIQP_SOLVED:
            return None
        step = np.asarray(self._solver.result.x).reshape(self._low.shape)
        return step[:, place] if np.isfinite(step).all() else None


def _solver() -> Any:
    """Return a solver whose answers do not depend on what it solved before.

    Scaling would be taken over from one programme to the next, to their last digits; in metres and seconds a
    programme is near to scale.
    """
    solver = piqp.SparseSolver()
    settings = solver.settings
    settings.eps_abs = settings.eps_rel = TOLERANCE
    settings.eps_duality_gap_abs = settings.eps_duality_gap_rel = TOLERANCE
    settings.max_iter, settings.preconditioner_iter = ITERATIONS, 0
    return solver


@dataclass(frozen=True, slots=True, eq=False)
class _Matrix:
    """A sparse matrix of a fixed pattern, and in which order its entries are taken from a vector of them."""

    matrix: Any
    order: Index

    def filled(self, entries: Array) -> Any:
        np.take(entries, self.order, out=self.matrix.data)
        return self.matrix


def _matrix(rows: Index, columns: Index, shape: tuple[int, int]) -> _Matrix:
    order = np.lexsort((rows, columns))
    starts = np.searchsorted(columns[order], np.arange(shape[1] + 1))
    data = np.zeros(len(order))
    return _Matrix(csc_matrix((data, rows[order].astype(np.int32), starts.astype(np.int32)), shape), order)
