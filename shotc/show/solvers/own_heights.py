"""Moves of cylinders on which heights have scalars of their own, as fast as the limits allow.

Every drone is at c + a (x - c) + b (g - c) horizontally, and its height follows the same formula with scalars
a', b' of its own. With common scalars two drones side by side before and one above the other after need a = 1
until b = 1, and drones one above the other before and side by side after need the same (``geom.least_size``).
So the path passes (1, 1). With own scalars the first pair needs a = 1 until b' = 1, and the second a' = 1
until b = 1. If the heights of the goal are reached early, and those of the start are left late, the
horizontal motion need not wait.

The second kind of pair gives a bound. If such a pair stands at exactly the separation, b rises from 0 to 1
while a' >= 1, and then a' falls to 0. Let W and w be the widths of the goal and the start, h the height of
the start, and let the heights of the goal be reached when b is 1. Two drones at the ends of a width part with
at most twice the speed v, two at the ends of a height approach with at most v_up + v_down, and both begin or
end at rest, so no such move takes less than

 (W - w) / 2 v + v / 2 acc + h / (v_up + v_down) + (v_up + v_down) / 4 acc.

The same holds backwards. For the moves of ``tests.experiments.dense`` it is 1.07 to 1.14 times the duration
of straight paths.

The method is sequential convex programming. The four scalars are cubic B-splines of uniform pieces. About a
motion, each pair at each time is kept apart in the direction in which it is apart now
(``geom.cylinder_planes``): a half-plane, inside the region where the pair is apart. The limits are cones in
the control points and the duration h of a piece; h^2 and h^3 are replaced by their tangents, which are below
them. So every solution keeps all limits, and all pairs apart at these times. The next programme starts from
it and is at least as good. The first motion only chooses the directions and need not be free.

Nothing here is a proof: the caller proves the result by ``geom.separation``, which knows no scalars.
"""

from __future__ import annotations

from math import hypot, inf, sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from shotc.geom.bernstein import Array
from shotc.ir.limits import Limits
from shotc.show.geom.arcs import basis_at_starts, sampled
from shotc.show.geom.cylinder_planes import CylinderPlanes, cylinder_planes, least_before_and_after
from shotc.show.solvers.arc_move import ArcMove, Drones
from shotc.show.solvers.move import LEAST_PIECE_S, Ramps, profile
from shotc.solvers.cone_rows import USABLE, ConeRows, Term, WarmStart

MOVE_PIECES = 36
POINTS = MOVE_PIECES + 3
PIECE_PARTS = 4
"""Parts of a piece, at whose ends pairs are kept apart."""
MOVE_SCALARS = 4
FIXED_POINTS = 3
MOST_SCALAR = 1.1
"""Largest control point of a scalar. Above 1 a scalar passes 1 before it slows down. Without a bound, one
that has time to spare would grow further.
"""
RAMPS = Ramps(0.3, 0.3, 0.6, 0.6)
"""The profile of each scalar on the first motion."""
MOST_ROUNDS = 7
WORTH_SHARE = 0.005
"""Least gain of a round, as a share of the duration; after a smaller one the search ends."""
NEAR_SHARE = 0.8
"""Share of its bound at which a limit is part of the first programme."""
LACK_SHARE = 2.5e-4
"""Share of the separation that drones may lack in the middle between two times: half of the margin with which
moves are requested.
"""
SOLVER_TOLERANCE = 1e-7

BEYOND_COST = 1.0
"""Seconds of a piece that a metre beyond the heights costs. The first directions may need more height than
later ones.
"""
BEYOND_M = 5e-7
"""Rounding error of a height, m."""
TOP = MOVE_SCALARS * POINTS
"""Column of the duration of a piece; the next one is of the height beyond the bounds, m."""

Column = NDArray[np.intp]


class OwnHeightsTask(NamedTuple):
    """What a move has to keep.

    ends : positions before and after, shape (n, 3) each, m
    scale : factors to units of the separation, shape (3,)
    limits, pace : the limits, and the used share of them
    heights : lowest and highest z of a drone, m; infinite if there is no bound
    """

    ends: tuple[Array, Array]
    scale: Array
    limits: Limits
    pace: float
    heights: tuple[float, float]


def own_heights(task: OwnHeightsTask, pivot: Array) -> ArcMove | None:
    """Return the shortest move found about a pivot c, shape (3,); None if none is found to be free."""
    drones = Drones.of(task.ends, pivot, task.limits, task.pace).with_own_heights()
    before, after = (end * task.scale for end in task.ends)
    # Formations at exactly the separation have no share to spare.
    unit = least_before_and_after(before, after)
    before, after = before / unit, after / unit
    ctrl, busy = _first(drones), set[int]()
    best, best_ctrl = inf, None
    for number in range(MOST_ROUNDS):
        planes = cylinder_planes(before, after, _at(ctrl))
        piece = float(drones.least_pieces(ctrl))
        # The first motions may leave the heights.
        free = planes.least >= 1.0 - LACK_SHARE and _beyond(task, pivot, ctrl) <= BEYOND_M
        gain = 1.0 - piece / best
        if number and free and gain > 0.0:
            best, best_ctrl = piece, ctrl
        if gain < WORTH_SHARE:
            break
        busy |= _busiest(drones, ctrl)
        programme = _Programme(drones.of_rows(sorted(busy)), piece)
        programme.keep_apart(planes)
        programme.keep_heights(task, pivot)
        solved = programme.solved(ctrl)
        if solved is None:
            break
        ctrl = solved
    if best_ctrl is None:
        return None
    binding = drones.binding(best_ctrl)
    return ArcMove(best_ctrl[:, :2], best_ctrl[:, 2:], pivot, binding.ticks, binding.limit, binding.drone)


def _first(drones: Drones) -> Array:
    """Return control points (K, 4) of a motion that widens first and narrows last.

    At one turn b' has risen and a begins to fall, at the other b has risen and a' begins to fall. So at every
    time a and b', and a' and b, are such that one of both is 1. Rises and falls share the duration by the
    times that they would take with a moving start or end.
    """
    fall, rise, fall_up, rise_up = (_time_alone(drones, k) for k in range(MOVE_SCALARS))
    whole = max(rise_up + fall, rise + fall_up)
    turns = [0.5 * (1.0 + (up - down) / whole) for up, down in ((rise_up, fall), (rise, fall_up))]
    at = np.clip((np.arange(POINTS) - 2.0) / (MOVE_PIECES - 2.0), 0.0, 1.0)
    falls = [1.0 - profile(np.clip((at - turn) / (1.0 - turn), 0.0, 1.0), RAMPS) for turn in turns]
    rises = [profile(np.clip(at / turn, 0.0, 1.0), RAMPS) for turn in turns]
    return np.stack([falls[0], rises[1], falls[1], rises[0]], axis=1)


def _time_alone(drones: Drones, scalar: int) -> float:
    """Return about the time, s, in which one scalar may change by 1."""
    change = np.zeros(MOVE_SCALARS)
    change[scalar] = 2.0 * (scalar % 2) - 1.0
    speed, push = (float(drones.shares(change, order)) for order in (1, 2))
    return max(hypot(speed, sqrt(2.0 * push)), LEAST_PIECE_S)


def _at(ctrl: Array) -> Array:
    """Return the scalars at the ends and in the middle of all parts of pieces, shape (2 T + 1, 4)."""
    pairs = [sampled(ctrl[:, k : k + 2], 2 * PIECE_PARTS) for k in (0, 2)]
    return np.stack([np.append(s[:, :-1], s[-1, -1]) for pair in pairs for s in pair], axis=1)


def _busiest(drones: Drones, ctrl: Array) -> set[int]:
    """Return the rows of the drones that are the busiest of all at some control point."""
    rows: set[int] = set()
    for order in (1, 2, 3):
        rows |= drones.busiest_on(np.diff(ctrl, order, axis=0), order)
    return rows


class _Programme:
    """The cone programme of a round; unknowns : control points, one scalar after another, and two more."""

    def __init__(self, drones: Drones, piece: float) -> None:
        self._rows = ConeRows(TOP + 2)
        self._piece = piece
        self._bound_scalars()
        self._keep_limits(drones)

    def _bound_scalars(self) -> None:
        fixed = np.arange(FIXED_POINTS)
        for scalar in range(MOVE_SCALARS):
            start = 1.0 - scalar % 2
            for points, value in ((fixed, start), (POINTS - 1 - fixed, 1.0 - start)):
                cols = _columns(scalar, points)
                self._rows.zero([(cols, np.ones(len(cols)))], np.full(len(cols), -value))
        every, ones = np.arange(TOP), np.ones(TOP)
        self._rows.positive(0.0 * ones, [(every, ones)])
        self._rows.positive(MOST_SCALAR * ones, [(every, -ones)])

    def _keep_limits(self, drones: Drones) -> None:
        speed, climb, descent, acceleration, jerk = drones.ceilings
        x, y, z = (_derivative(drones, 1, axis) for axis in range(3))
        none = np.zeros(len(x[0][0]))
        self._rows.second_order(none, [self._power(speed, 1, len(none))[1], x, y])
        self._rows.positive(none, [*self._power(climb, 1, len(none))[1], *_negative(z)])
        self._rows.positive(none, [*self._power(descent, 1, len(none))[1], *z])
        for order, most in ((2, acceleration), (3, jerk)):
            axes = [_derivative(drones, order, axis) for axis in range(3)]
            constant, terms = self._power(most, order, len(axes[0][0][0]))
            self._rows.second_order(constant, [terms, *axes])

    def _power(self, most: float, order: int, count: int) -> tuple[Array, list[Term]]:
        """Return most * h^order by its tangent at the present piece, for ``count`` rows."""
        h = self._piece
        cols = np.full(count, TOP)
        slope = np.full(count, most * order * h ** (order - 1))
        return np.full(count, most * (1 - order) * h**order), [(cols, slope)]

    def keep_apart(self, planes: CylinderPlanes) -> None:
        """Require all pairs to be apart in their directions."""
        # At both ends of a move the formations themselves are apart.
        inner = (planes.at > 0) & (planes.at < MOVE_PIECES * PIECE_PARTS)
        time, upright, normals = planes.at[inner], planes.upright[inner], planes.normals[inner]
        weights = basis_at_starts(PIECE_PARTS)[time % PIECE_PARTS]
        terms = []
        for scalar in range(2):
            for point in range(4):
                cols = _columns(2 * upright + scalar, time // PIECE_PARTS + point)
                terms.append((cols, normals[:, scalar] * weights[:, point]))
        if len(time):
            self._rows.positive(np.full(len(time), -1.0), terms)

    def keep_heights(self, task: OwnHeightsTask, pivot: Array) -> None:
        """Require all drones to stay between the heights, or little beyond."""
        points, beyond = np.arange(POINTS), (np.full(POINTS, TOP + 1), np.ones(POINTS))
        self._rows.positive(np.zeros(1), [(beyond[0][:1], beyond[1][:1])])
        for constant, ends in _height_bounds(task, pivot):
            terms = [(_columns(2 + k, points), np.full(POINTS, ends[k])) for k in range(2)]
            self._rows.positive(np.full(POINTS, constant), [*terms, beyond])

    def solved(self, ctrl: Array) -> Array | None:
        """Return the control points (K, 4) of the shortest move, or None; ctrl : a motion near it."""
        cost = np.zeros(TOP + 2)
        cost[TOP:] = 1.0, BEYOND_COST
        near = WarmStart(np.concatenate([ctrl.T.ravel(), [self._piece, 0.0]]), NEAR_SHARE)
        status, x = self._rows.solve(cost, SOLVER_TOLERANCE, near=near)
        if status not in USABLE:
            return None
        moved = x[:TOP].reshape(MOVE_SCALARS, POINTS).T.copy()
        moved[:FIXED_POINTS], moved[-FIXED_POINTS:] = ctrl[0], ctrl[-1]
        return moved


def _height_bounds(task: OwnHeightsTask, pivot: Array) -> list[tuple[float, Array]]:
    """Return a constant c and factors f of the heights' a and b, shape (2,): c + f.(a, b) >= 0."""
    z = [end[:, 2] - pivot[2] for end in task.ends]
    low, high = (height - pivot[2] for height in task.heights)
    bounds = [
        (-low, np.array([float(one.min()) for one in z])),
        (high, -np.array([float(one.max()) for one in z])),
    ]
    return [bound for bound in bounds if np.isfinite(bound[0])]


def _beyond(task: OwnHeightsTask, pivot: Array, ctrl: Array) -> float:
    """Return how far drones may be beyond the heights, by control points (K, 4), m; at most 0 if not."""
    lacks = [-float((constant + ctrl[:, 2:] @ ends).min()) for constant, ends in _height_bounds(task, pivot)]
    return max(lacks, default=0.0)


def _columns(scalar: int | Column, points: Column) -> Column:
    return np.asarray(scalar * POINTS + points)


def _derivative(drones: Drones, order: int, axis: int) -> list[Term]:
    """Return the differences of a coordinate of all drones as terms, one row for each drone and point."""
    weights = np.diff(np.eye(order + 1), order, axis=0)[0]
    count = POINTS - order
    first = np.tile(np.arange(count), len(drones.parts[0]))
    scalars = (2, 3) if axis == 2 else (0, 1)
    return [
        (_columns(scalar, first + k), np.repeat(weight * drones.parts[scalar][:, axis], count))
        for scalar in scalars
        for k, weight in enumerate(weights.tolist())
    ]


def _negative(terms: list[Term]) -> list[Term]:
    return [(cols, -values) for cols, values in terms]
