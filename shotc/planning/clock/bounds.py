"""Constraints of a motion on the clock: its ends, limits of the drone, keyframes at given places."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.bspline import SplineFunctionals, control_rows, hull_rows
from shotc.ir.keyed import arrivals, is_keyed, place_of
from shotc.ir.limits import Limits, Vec3
from shotc.ir.mission import MissionIR, Shot
from shotc.solvers.spline_problem import Cones, Equalities

NEARLY_SHARE = 0.999  # share of each limit that is used, as a margin for rounding
STATE_ORDERS = 3  # of a state: value, rate, acceleration


@dataclass(frozen=True, slots=True, eq=False)
class Bound:
    """A place p_W in metres that the author gave, where the camera is from ``start`` to ``end``, seconds.

    index : number of its keyframe in the shot, -1 if it belongs to none
    """

    index: int
    place: Vec3
    start: float
    end: float

    @property
    def still(self) -> bool:
        """Whether the camera stands still there for a while."""
        return self.end > self.start


def bounds_of(mission: MissionIR, shot: Shot, start: float) -> tuple[Bound, ...]:
    """Return the places of keyframes that bind a shot whose first frame is at mission time ``start``."""
    if not is_keyed(shot):
        return ()
    bounds: list[Bound] = []
    for index, (keyframe, at) in enumerate(zip(shot.keyframes, arrivals(shot), strict=True)):
        if not keyframe.placed:
            continue
        reach, leave = start + at, start + at + keyframe.hold
        if keyframe.beside is None:
            bounds.append(Bound(index, keyframe.at, reach, leave))
            continue
        times = [reach] if keyframe.hold <= 0 else [reach, leave]
        bounds += [Bound(index, place_of(mission, keyframe, t), t, t) for t in times]
    return tuple(bounds)


def held_ends(breaks: Array, begin: Array | None = None, end: Array | None = None) -> Equalities:
    """Return the constraints of a spline in three dimensions at both ends: the given state, or else rest.

    breaks : shape (P + 1,), mission times in seconds
    begin, end : value, rate and acceleration there, shape (3, 3); None for rest at any value
    """
    piece, weight, value = [], [], []
    for order in range(STATE_ORDERS):
        rows = control_rows(breaks, order)
        for at, state in ((0, begin), (-1, end)):
            if state is None and order == 0:
                continue
            piece.append(rows.piece[at])
            weight.append(rows.weight[at])
            value.append(np.zeros(3) if state is None else state[order])
    return Equalities(SplineFunctionals(np.array(piece), np.array(weight)), np.array(value))


def with_ends(breaks: Array, coef: Array, begin: Array | None, end: Array | None) -> Array:
    """Return a spline's coefficients with exactly the states of ``held_ends``, without a solver's tolerance.

    Only then do two motions of which one goes over into the other have no jumps.

    coef : shape (P + 5, 3)
    """
    exact = coef.copy()
    for at, own, state in ((0, slice(None, STATE_ORDERS), begin), (-1, slice(-STATE_ORDERS, None), end)):
        if state is not None:
            rows = [control_rows(breaks, order).weight[at, own] for order in range(STATE_ORDERS)]
            exact[own] = np.linalg.solve(np.array(rows), state)
    return exact


def limits_of(limits: Limits, breaks: Array) -> tuple[Cones, ...]:
    """Return the limits of a drone's motion as cones over the control points of its derivatives.

    breaks : shape (P + 1,), mission times in seconds
    """
    cones = []
    for order, axes, middle, bound in (
        (1, (0, 1), limits.wind, limits.speed),
        (2, (0, 1, 2), (0.0, 0.0, 0.0), limits.usable_acceleration),
        (3, (0, 1, 2), (0.0, 0.0, 0.0), limits.jerk),
    ):
        rows = hull_rows(breaks, order)
        number = len(rows.piece)
        owner = np.zeros(number, dtype=np.intp)
        centre = np.tile(NEARLY_SHARE * np.array(middle), (number, 1))
        cones.append(Cones(rows, axes, centre, np.full(number, NEARLY_SHARE * bound), None, owner))
    up = hull_rows(breaks, 1)
    rise = 0.5 * NEARLY_SHARE * (limits.climb - limits.descent)
    half = 0.5 * NEARLY_SHARE * (limits.climb + limits.descent)
    number = len(up.piece)
    owner = np.zeros(number, dtype=np.intp)
    cones.append(Cones(up, (2,), np.full((number, 1), rise), np.full(number, half), None, owner))
    return tuple(cones)
