"""Constraints of a motion on the clock: rest at its ends, limits of the drone, keyframes at given places."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.bspline import SplineFunctionals, control_rows, hull_rows
from shotc.ir.keyed import arrivals, is_keyed, place_of
from shotc.ir.limits import Limits, Vec3
from shotc.ir.mission import MissionIR, Shot
from shotc.solvers.spline_problem import Cones

NEARLY_SHARE = 0.999  # share of each limit that is used, as a margin for rounding


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


def at_rest(breaks: Array) -> SplineFunctionals:
    """Return the rows for the first and second derivative of a spline at both ends.

    breaks : shape (P + 1,), mission times in seconds
    """
    parts = []
    for order in (1, 2):
        rows = control_rows(breaks, order)
        parts.append((rows.piece[[0, -1]], rows.weight[[0, -1]]))
    return SplineFunctionals(np.concatenate([p for p, _ in parts]), np.concatenate([w for _, w in parts]))


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
