"""A convex problem for a spline in three dimensions: goals, equalities, half-spaces and norm bounds.

The unknown is a curve on one set of knots. All requirements are ``SplineFunctionals`` of its coefficients.
``spline_qp`` finds the best curve, ``spline_relax`` the conflicting requirements.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.bspline import DEGREE, IntArray, SplineFunctionals
from shotc.solvers.cone_rows import ConeRows, Term

EVERY = (0, 1, 2)


@dataclass(frozen=True, slots=True, eq=False)
class Goal:
    """A term of the objective: sum over rows of |rows - value|^2 over ``axes``; value of shape (R, 3)."""

    rows: SplineFunctionals
    value: Array
    axes: tuple[int, ...] = EVERY


@dataclass(frozen=True, slots=True, eq=False)
class Equalities:
    """Rows with the exact values ``value``, shape (K, 3)."""

    rows: SplineFunctionals
    value: Array


@dataclass(frozen=True, slots=True, eq=False)
class HalfSpaceRows:
    """Rows whose component along ``normal``, shape (R, 3), is at least ``offset``, shape (R,).

    owner : shape (R,), index of the owner of each row; only ``relax`` uses it
    """

    rows: SplineFunctionals
    normal: Array
    offset: Array
    owner: IntArray


@dataclass(frozen=True, slots=True, eq=False)
class Cones:
    """Norm bounds |rows[axes] - centre| <= bound, each as a second-order cone.

    axes   : the components in the norm
    centre : shape (R, len(axes)); bound : shape (R,)
    price  : shape (R,), cost of each unit above the bound; None for a hard bound
    owner  : shape (R,), as in HalfSpaceRows
    """

    rows: SplineFunctionals
    axes: tuple[int, ...]
    centre: Array
    bound: Array
    price: Array | None
    owner: IntArray


@dataclass(frozen=True, slots=True, eq=False)
class SplineProblem:
    """The whole problem; ``size`` is the number of coefficients of a component."""

    size: int
    goals: tuple[Goal, ...]
    equalities: Equalities
    half_spaces: tuple[HalfSpaceRows, ...] = ()
    cones: tuple[Cones, ...] = ()


def centred(problem: SplineProblem, about: Array) -> SplineProblem:
    """Return the problem with a point ``about``, shape (3,), as its origin, which keeps numbers small.

    Coefficients shift with the curve. The weights of a row of values add up to 1, those of a derivative to 0.
    """

    def shift(rows: SplineFunctionals) -> Array:
        return np.asarray(rows.weight.sum(axis=1)[:, None] * -about)

    return SplineProblem(
        problem.size,
        tuple(replace(g, value=g.value + shift(g.rows)) for g in problem.goals),
        Equalities(problem.equalities.rows, problem.equalities.value + shift(problem.equalities.rows)),
        tuple(
            replace(f, offset=f.offset + (shift(f.rows) * f.normal).sum(axis=1)) for f in problem.half_spaces
        ),
        tuple(replace(c, centre=c.centre + shift(c.rows)[:, list(c.axes)]) for c in problem.cones),
    )


def scalar_map(rows: SplineFunctionals, size: int) -> Any:
    """Return the rows as a sparse matrix over one component's coefficients, shape (R, size)."""
    from scipy.sparse import csr_matrix

    count = len(rows.piece)
    columns = rows.piece[:, None] + np.arange(DEGREE + 1)
    pointer = np.arange(0, (DEGREE + 1) * count + 1, DEGREE + 1)
    return csr_matrix((rows.weight.ravel(), columns.ravel(), pointer), shape=(count, size))


def terms(rows: SplineFunctionals, factor: Array | float = 1.0, first: int = 0) -> list[Term]:
    """Return rows of one component, times a factor, as terms of ``ConeRows``.

    factor : a number, or shape (R,); first : first column of the component
    """
    columns = rows.piece + first
    return [(columns + k, rows.weight[:, k] * factor) for k in range(DEGREE + 1)]


def bounded(rows: ConeRows, size: int, cone: Cones, more: list[Term]) -> None:
    """Require norms of at most their bounds plus the terms ``more``; for one component its absolute value."""
    parts = [terms(cone.rows, first=axis * size) for axis in cone.axes]
    if len(parts) > 1:
        rows.second_order(cone.bound, [more, *parts], rest=list(-cone.centre.T))
        return
    for sign in (1.0, -1.0):
        part = [(columns, -sign * values) for columns, values in parts[0]]
        rows.positive(cone.bound + sign * cone.centre[:, 0], more + part)
