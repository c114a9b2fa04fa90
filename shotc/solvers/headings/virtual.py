"""``virtual``: the paper's virtual variables (Wu et al., Eq. 10 and 11), made robust near the origin.

The heading is the direction of a point s(t) in the plane, whose C1 cubic pieces need no winding. The
programme of the paper lets s pass near the origin on wide turns, where the heading turns very fast. So here
the radius at inner keyframes is free, and each interval has a free knot in its middle. At samples s stays
beyond a line perpendicular to n, the heading that turns the shorter way: n.s >= r_min. This also determines
the winding. Eq. 11e bounds s' and s'', which does not bound the heading, so its limits are wide here. The
rate has the bound |t.s'| <= rate n.s with t perpendicular to n, which is exact where s is along n. Finally
the real heading, atan2 of s as quintic pieces, is checked.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array, Piecewise, quintic_hermite
from shotc.geom.bspline import IntArray, subdivide
from shotc.geom.pieces import Pieces
from shotc.geom.proof import sup_norm
from shotc.geom.vec import wrapped
from shotc.solvers.cone_rows import ConeRows, Term
from shotc.solvers.conic import Status
from shotc.solvers.headings.energy import cubic, energy
from shotc.solvers.headings.task import Headings, HeadingTask, nearest_turns, turned

NEAREST_RADIUS, FARTHEST_RADIUS = 0.5, 4.0  # radii of inner keyframes
CLEAR_RADII = 0.3  # r_min of the half-planes
WIDE_LIMIT_RATIO = 8.0  # factor on the limits, for s' and s''
SAMPLES_PER_PIECE = 4  # samples of a piece
FINER_PIECES = 4  # quintic pieces for each cubic piece
SOLVER_TOLERANCE = 1e-8


@dataclass(frozen=True, slots=True, eq=False)
class _KnotGrid:
    """Knots, with one in the middle of each interval, and the nominal headings at the samples.

    knots : shape (J,); at, piece, x : shape (M,), parameter of each sample, its piece, and the share within
        it
    along, across : shape (M, 2), unit vectors of the nominal heading, and a quarter turn to the left
    """

    knots: Array
    at: Array
    piece: IntArray
    x: Array
    along: Array
    across: Array


def by_virtual(task: HeadingTask) -> Headings:
    """Return the heading of the best virtual curve; INFEASIBLE if the real heading violates a limit."""
    angles = turned(task, nearest_turns(task.yaw))
    near = cubic(task.at, angles, energy(task.at, 0.0, task.rates).slopes(angles))
    grid = _grid(task, near)
    status, value, slope = _programme(task, angles, grid)
    if status not in {Status.SOLVED, Status.INACCURATE}:
        return Headings(Status.INFEASIBLE if status is Status.INFEASIBLE else Status.FAILED, angles, None)
    curve = _real(task, angles, near, _point(grid.knots, value, slope))
    if curve is None or not _keeps(task, curve):
        return Headings(Status.INFEASIBLE, angles, None)
    return Headings(Status.SOLVED, angles, curve)


def _grid(task: HeadingTask, near: Piecewise) -> _KnotGrid:
    knots = subdivide(task.at, 2)
    at = subdivide(knots, SAMPLES_PER_PIECE)
    piece = np.clip(np.searchsorted(knots, at, side="right") - 1, 0, len(knots) - 2)
    x = (at - knots[piece]) / np.diff(knots)[piece]
    psi = near(at)[:, 0]
    along = np.column_stack([np.cos(psi), np.sin(psi)])
    return _KnotGrid(knots, at, piece, x, along, np.column_stack([-along[:, 1], along[:, 0]]))


class _Solved(NamedTuple):
    """The status of the programme; values and slopes of s at the knots, each (J, 2)."""

    status: Status
    value: Array
    slope: Array


def _programme(task: HeadingTask, angles: Array, grid: _KnotGrid) -> _Solved:
    """Solve Eq. 11; return the values and slopes of s at the knots, each of shape (J, 2)."""
    knots, count = len(grid.knots), len(angles)
    pieces = knots - 1
    radii = 4 * knots
    bends = radii + count
    problem = ConeRows(bends + 4 * pieces)
    _keyframes(problem, task, angles, (knots, radii))
    _bends(problem, grid, bends)
    value, rate, acceleration = (_samples(grid, order) for order in range(3))
    every = np.full(len(grid.at), CLEAR_RADII)
    problem.positive(-every, _dot(value, grid.along, knots))
    if np.isfinite(task.rate):
        limit = _dot(value, task.rate * grid.along, knots)
        for sign in (1.0, -1.0):
            problem.positive(0 * every, limit + _dot(rate, sign * grid.across, knots))
    for rows, bound in ((rate, task.rate), (acceleration, task.acceleration)):
        if np.isfinite(bound):
            axes = [_dot(rows, np.tile(axis, (len(grid.at), 1)), knots) for axis in np.eye(2)]
            problem.second_order(np.full(len(grid.at), WIDE_LIMIT_RATIO * bound), [[], *axes])
    squares = np.zeros(problem.unknowns)
    squares[bends:] = 1.0
    status, z = problem.solve(np.zeros(problem.unknowns), SOLVER_TOLERANCE, squares)
    return _Solved(status, z[: 2 * knots].reshape(2, knots).T, z[2 * knots : 4 * knots].reshape(2, knots).T)


def _keyframes(problem: ConeRows, task: HeadingTask, angles: Array, where: tuple[int, int]) -> None:
    """Require s = r psi at keyframes (11c), and r = 1 and the given rates at both ends (11b)."""
    knots, radii = where
    count = len(angles)
    direction = np.column_stack([np.cos(angles), np.sin(angles)])
    at, r = 2 * np.arange(count), radii + np.arange(count)
    for axis in range(2):
        problem.zero([(axis * knots + at, np.ones(count)), (r, -direction[:, axis])])
    ends = np.array([0, count - 1])
    problem.zero([(radii + ends, np.ones(2))], -np.ones(2))
    rates = np.array(task.rates)
    turn = np.column_stack([-direction[ends, 1], direction[ends, 0]]) * rates[:, None]
    for axis in range(2):
        problem.zero([((2 + axis) * knots + 2 * ends, np.ones(2))], -turn[:, axis])
    problem.positive(np.full(count, -NEAREST_RADIUS), [(r, np.ones(count))])
    problem.positive(np.full(count, FARTHEST_RADIUS), [(r, -np.ones(count))])


def _bends(problem: ConeRows, grid: _KnotGrid, bends: int) -> None:
    """Equate 4 unknowns a piece with s'', so that the sum of their squares is twice the integral in (11a)."""
    h = np.diff(grid.knots)
    pieces = len(h)
    knots = pieces + 1
    piece = np.arange(pieces)
    ends = [_weights(h, np.full(pieces, x), 2) for x in (0.0, 1.0)]
    # With s'' linear from a to b, its squared integral is h (a + b)^2 / 4 + h (b - a)^2 / 12.
    parts = ((ends[0] + ends[1]) * np.sqrt(h / 2)[:, None], (ends[1] - ends[0]) * np.sqrt(h / 6)[:, None])
    for axis in range(2):
        for k, weight in enumerate(parts):
            column = bends + (2 * axis + k) * pieces + piece
            problem.zero([*_terms(piece, weight, axis, knots), (column, -np.ones(pieces))])


def _samples(grid: _KnotGrid, order: int) -> tuple[IntArray, Array]:
    return grid.piece, _weights(np.diff(grid.knots)[grid.piece], grid.x, order)


def _weights(h: Array, x: Array, order: int) -> Array:
    """Return the weights of (p0, v0, p1, v1) in the derivative of that order at x of a piece, (M, 4)."""
    one, zero = np.ones_like(x), np.zeros_like(x)
    powers = [
        [one, x, x * x, x**3],
        [zero, one, 2 * x, 3 * x * x],
        [zero, zero, 2 * one, 6 * x],
    ][order]
    hermite = np.array([[1, 0, -3, 2], [0, 1, -2, 1], [0, 0, 3, -2], [0, 0, -1, 1]], dtype=np.float64)
    weight = np.stack(powers, axis=1) @ hermite.T / (h**order)[:, None]
    weight[:, [1, 3]] *= h[:, None]
    return np.asarray(weight)


def _terms(piece: IntArray, weight: Array, axis: int, knots: int) -> list[Term]:
    p, v = axis * knots + piece, (2 + axis) * knots + piece
    columns = (p, v, p + 1, v + 1)
    return [(column, weight[:, k]) for k, column in enumerate(columns)]


def _dot(rows: tuple[IntArray, Array], direction: Array, knots: int) -> list[Term]:
    """Return terms of a derivative's component along directions of shape (M, 2)."""
    piece, weight = rows
    return [
        term
        for axis in range(2)
        for term in _terms(piece, weight * direction[:, axis : axis + 1], axis, knots)
    ]


def _point(knots: Array, value: Array, slope: Array) -> Piecewise:
    axes = [cubic(knots, value[:, axis], slope[:, axis]).ctrl for axis in range(2)]
    return Piecewise(knots, np.concatenate(axes, axis=2))


def _real(task: HeadingTask, angles: Array, near: Piecewise, point: Piecewise) -> Piecewise | None:
    """Return atan2 of the virtual curve as quintic pieces, or None if it passes through the origin.

    It is C2 except at knots where a limit causes a jump of s''.
    """
    breaks = subdivide(point.breaks, FINER_PIECES)
    ctrl = []
    for low, high, piece in zip(
        breaks[:-1], breaks[1:], np.repeat(point.ctrl, FINER_PIECES, axis=0), strict=True
    ):
        knot = np.searchsorted(point.breaks, 0.5 * (low + high)) - 1
        own = Piecewise(point.breaks[knot : knot + 2], piece[None])
        ends = np.array([low, high])
        s, ds, dds = (c(ends) for c in (own, own.derivative(), own.derivative(2)))
        square = (s * s).sum(axis=1)
        if square.min() < 1e-6:
            return None
        psi = near(ends)[:, 0]
        psi = psi + wrapped(np.arctan2(s[:, 1], s[:, 0]) - psi)
        rate = _cross(s, ds) / square
        acceleration = _cross(s, dds) / square - 2 * rate * (s * ds).sum(axis=1) / square
        ctrl.append(quintic_hermite(ends, psi[:, None], rate[:, None], acceleration[:, None]).ctrl[0])
    whole = np.array(ctrl)
    step = 2 * FINER_PIECES
    # Keyframes are met to the last bit; both sides of each break already agree but for rounding.
    whole[0, 0], whole[step - 1 :: step, -1, 0] = angles[0], angles[1:]
    whole[1:, 0] = whole[:-1, -1]
    return Piecewise(breaks, whole)


def _keeps(task: HeadingTask, curve: Piecewise) -> bool:
    """Return whether the real rate and acceleration keep their limits, proved by Bernstein hulls."""
    pieces = Pieces(curve.breaks[:-1], curve.breaks[1:], curve.ctrl)
    for limit in (task.rate, task.acceleration):
        pieces = pieces.derivative()
        allowed = limit * (1 + 1e-9)
        if np.isfinite(limit) and sup_norm(pieces, lambda _, a=allowed: 1e-3 * a).proven > allowed:  # type: ignore[misc]
            return False
    return True


def _cross(a: Array, b: Array) -> Array:
    return np.asarray(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])
