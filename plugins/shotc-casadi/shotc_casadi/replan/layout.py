"""Where the entries of a step's quadratic programme are.

The unknowns of a stage are the change of its input, its slacks, and the change of the next state. The
measured state is not an unknown, so no unknown is fixed.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_matrix

Index = NDArray[np.int64]
Places = tuple[Index, Index]


class Pattern(NamedTuple):
    """Rows and columns of the nonzeros of a stage's matrices, in the order of their values.

    hessian : of the upper triangle, by input and next state
    onward, driven : of the next state, by the state and by the input
    kept : of the rows, by input and next state
    ends : of the rows at the end, by the state
    rows : number of rows of each stage with each slack
    firm : number of rows of each stage without a slack, after those
    last : number of rows at the end, with the first slack
    """

    hessian: Places
    onward: Places
    driven: Places
    kept: Places
    ends: Places
    rows: tuple[int, ...]
    firm: int
    last: int


@dataclass(frozen=True, slots=True, eq=False)
class Sparse:
    """A sparse matrix with a fixed pattern; ``order`` gives the place of each value in a list."""

    order: Index
    indices: NDArray[np.int32]
    starts: NDArray[np.int32]
    shape: tuple[int, int]

    def over(self, values: Any) -> Any:
        """Return a matrix on top of an array of values, which may change."""
        return csc_matrix((values, self.indices, self.starts), self.shape, copy=False)


class ProgramMatrices(NamedTuple):
    """The matrices of a programme over a horizon.

    cost : of the stages' Hessians
    motion : of their ``driven``, then -1 for every state, then ``onward`` of all stages except the first
    bound : of ``kept``, then ``ends``, then for every row with a slack its unit
    """

    cost: Sparse
    motion: Sparse
    bound: Sparse


def layout(pattern: Pattern, stages: int, inputs: int, states: int) -> ProgramMatrices:
    """Return the matrices of that many stages."""
    p, n, slacks = pattern, stages, len(pattern.rows)
    width = inputs + slacks + states
    after, first = np.arange(states) + inputs + slacks, width * np.arange(n)[:, None]
    place = np.append(np.arange(inputs), after)
    line, size, count = states * np.arange(n)[:, None], n * width, n * states
    cost = _sparse([first + place[p.hessian[0]]], [first + place[p.hessian[1]]], (size, size))
    motion = _sparse(
        [line + p.driven[0], np.arange(count), line[1:] + p.onward[0]],
        [first + p.driven[1], first + after, first[:-1] + after[p.onward[1]]],
        (count, size),
    )
    soft, many = sum(p.rows), sum(p.rows) + p.firm
    rows, ends = many * np.arange(n)[:, None], n * many + np.arange(p.last)
    yielding = np.append((rows + np.arange(soft)).ravel(), ends)
    own = first + inputs + np.repeat(np.arange(slacks), p.rows)
    slack = np.append(own.ravel(), np.full(p.last, first[-1] + inputs))
    bound = _sparse(
        [rows + p.kept[0], ends[p.ends[0]], yielding],
        [first + place[p.kept[1]], first[-1] + after[p.ends[1]], slack],
        (n * many + p.last, size),
    )
    return ProgramMatrices(cost, motion, bound)


def _sparse(rows: list[Index], columns: list[Index], shape: tuple[int, int]) -> Sparse:
    row, column = (np.concatenate([part.ravel() for part in parts]) for parts in (rows, columns))
    order = np.lexsort((row, column))
    starts = np.searchsorted(column[order], np.arange(shape[1] + 1))
    return Sparse(order, row[order].astype(np.int32), starts.astype(np.int32), shape)
