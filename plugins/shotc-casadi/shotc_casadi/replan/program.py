"""The quadratic programme of one step, stage by stage, solved by PIQP.

The unknowns of a stage are the change of its input, its slack, and the change of the state it leads to. The
measured state is no unknown, so nothing is fixed.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
import piqp
from numpy.typing import NDArray
from scipy.sparse import csc_matrix

from shotc.plugin_api.replanner import Array
from shotc_casadi.replan.rows import Rows

TOLERANCE = 1e-4
ITERATIONS = 50
"""Of PIQP: 10 to 14 are usual, and a programme without a solution takes all of them."""

FEW = 3
"""Rounds of scaling: in metres and seconds a programme is near to scale, and each takes time."""

Index = NDArray[np.int64]
Mask = NDArray[np.bool_]


class Pattern(NamedTuple):
    """Which entries of a stage can differ from zero, as bytes of masks.

    hessian : (U + X, U + X); onward : (X, X); driven : (X, U)
    """

    hessian: bytes
    onward: bytes
    driven: bytes


def pattern(hessian: Mask, onward: Mask, driven: Mask) -> Pattern:
    """Return masks as a pattern."""
    return Pattern(hessian.tobytes(), onward.tobytes(), driven.tobytes())


class Quadratic(NamedTuple):
    """A step's programme about an iterate of N stages with U inputs and X states.

    gradient : of the cost by input and next state, shape (N, U + X); hessian : (N, U + X, U + X)
    onward, driven : derivatives of the next state by the state, (N, X, X), and by the input, (N, X, U)
    rows : linearised; price : of what the worst row of a stage lacks
    low, high : bounds of the step, (N, U + X); pattern : of these matrices
    """

    gradient: Array
    hessian: Array
    onward: Array
    driven: Array
    rows: Rows
    price: float
    low: Array
    high: Array
    pattern: Pattern


@dataclass(frozen=True, slots=True, eq=False)
class _Matrix:
    """A sparse matrix of a fixed pattern, and in which order its entries are taken from a vector of them."""

    matrix: Any
    order: Index

    def filled(self, entries: Array) -> Any:
        self.matrix.data[:] = entries[self.order]
        return self.matrix


class Programs:
    """Solves programmes; it keeps their matrices, so only one thread may use it at a time."""

    def __init__(self) -> None:
        """Know no pattern yet."""
        self._layouts: dict[tuple[object, ...], _Layout] = {}

    def solve(self, task: Quadratic) -> Array | None:
        """Return the step, shape (N, U + X), or None where the solver found none.

        The solver is set up anew, so that its answer does not depend on what was solved before.
        """
        layout = self._layout(task)
        rows = task.rows
        driven, onward = task.driven[:, *layout.driven], task.onward[1:, *layout.onward]
        solver = _solver()
        solver.setup(
            layout.cost.filled(task.hessian[:, *layout.upper].ravel()),
            layout.spread(task.gradient, task.price),
            layout.motion.filled(np.concatenate([driven.ravel(), layout.minus_one, onward.ravel()])),
            layout.still,
            layout.bound.filled(np.concatenate([rows.slope[rows.uses], layout.ones])),
            -rows.value,
            None,
            layout.spread(task.low, 0.0),
            layout.spread(task.high, np.inf),
        )
        if solver.solve() != piqp.PIQP_SOLVED:
            return None
        step = np.asarray(solver.result.x).reshape(len(task.gradient), -1)
        return step[:, layout.place] if np.isfinite(step).all() else None

    def _layout(self, task: Quadratic) -> _Layout:
        shape = (len(task.gradient), task.driven.shape[2], task.onward.shape[2])
        stage, uses = task.rows.stage.tobytes(), task.rows.uses.tobytes()
        key = (shape, task.pattern, stage, uses)
        if key not in self._layouts:
            self._layouts[key] = _layout(shape, task.pattern, stage, uses)
        return self._layouts[key]


def _solver() -> Any:
    solver = piqp.SparseSolver()
    settings = solver.settings
    settings.eps_abs = settings.eps_rel = TOLERANCE
    settings.eps_duality_gap_abs = settings.eps_duality_gap_rel = TOLERANCE
    settings.max_iter, settings.preconditioner_iter = ITERATIONS, FEW
    return solver


@dataclass(frozen=True, slots=True, eq=False)
class _Layout:
    """Where the entries of a programme stand.

    place : of inputs and states among the unknowns of a stage; the slack stands between them
    upper, driven, onward : rows and columns of the entries of a stage's matrices
    """

    place: Index
    upper: tuple[Index, Index]
    driven: tuple[Index, Index]
    onward: tuple[Index, Index]
    cost: _Matrix
    motion: _Matrix
    bound: _Matrix
    still: Array
    minus_one: Array
    ones: Array

    def spread(self, values: Array, slack: float) -> Array:
        """Return values (N, U + X) with one for the slack of each stage between them, flat."""
        spread = np.full((len(values), len(self.place) + 1), slack)
        spread[:, self.place] = values
        return spread.ravel()


def _layout(shape: tuple[int, int, int], pattern: Pattern, stage: bytes, uses: bytes) -> _Layout:
    stages, inputs, states = shape
    width = inputs + states + 1
    first = width * np.arange(stages)[:, None]
    size = stages * width
    place = np.delete(np.arange(width), inputs)
    upper = _entries(np.triu(_mask(pattern.hessian, inputs + states)))
    driven, onward = _entries(_mask(pattern.driven, inputs)), _entries(_mask(pattern.onward, states))
    cost = _matrix((first + place[upper[0]]).ravel(), (first + place[upper[1]]).ravel(), (size, size))
    after = np.arange(states) + inputs + 1
    line = states * np.arange(stages)[:, None]
    count = stages * states
    motion = _matrix(
        np.concatenate([(line + driven[0]).ravel(), np.arange(count), (line[1:] + onward[0]).ravel()]),
        np.concatenate(
            [(first + driven[1]).ravel(), (first + after).ravel(), (first[:-1] + after[onward[1]]).ravel()]
        ),
        (count, size),
    )
    of = np.frombuffer(stage, dtype=np.int64)
    number = np.arange(len(of))
    row, state = np.nonzero(_mask(uses, len(uses) // max(1, len(of))))
    bound = _matrix(
        np.concatenate([row, number]),
        np.concatenate([width * of[row] + after[state], width * of + inputs]),
        (len(of), size),
    )
    still, minus_one = np.zeros(count), -np.ones(count)
    return _Layout(place, upper, driven, onward, cost, motion, bound, still, minus_one, np.ones(len(of)))


def _mask(entries: bytes, columns: int) -> Mask:
    return np.frombuffer(entries, dtype=np.bool_).reshape(-1, columns)


def _entries(mask: Mask) -> tuple[Index, Index]:
    rows, columns = np.nonzero(mask)
    return rows.astype(np.int64), columns.astype(np.int64)


def _matrix(rows: Index, columns: Index, shape: tuple[int, int]) -> _Matrix:
    order = np.lexsort((rows, columns))
    starts = np.searchsorted(columns[order], np.arange(shape[1] + 1))
    data = np.zeros(len(order))
    return _Matrix(csc_matrix((data, rows[order].astype(np.int32), starts.astype(np.int32)), shape), order)
