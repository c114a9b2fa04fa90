"""The constraints of every plan as symbolic rows, >= 0 where they hold, in metres or m/s.

They depend on the position and velocity of the drone at a stage, and are the same for all shots.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

import casadi as ca
import numpy as np

from shotc.plugin_api.replanner import Array, Keeping, Traffic, Walls
from shotc_casadi.replan.solids import SHARP_M, TINY_M, SolidConstraint, count, free_at, half_space, rooms

STANDING_MS = 1e-3
"""Added to speeds and accelerations, which have no direction at 0, m/s and m/s^2."""
REACH_M = 1.0
"""Obstacles farther than this beyond the reach of a horizon are left out, metres."""
LEAST_CONSTRAINTS = 3
"""Up to this number of solids, none is left out, so that no new programme is built in flight."""
LIMIT_ROWS = 10
WALL_PARAMETERS = 4
"""Parameters of a half-space: its normal, and its offset with the margin."""


class RowCounts(NamedTuple):
    """Which rows there are.

    shapes : of the obstacles
    others, cones : their numbers
    low, high : whether the pitch has this bound
    framed : whether no other drone may be in a cone about the camera's axis
    walls : the number of half-spaces of a stage
    """

    shapes: tuple[int, ...]
    others: int
    cones: int
    low: bool
    high: bool
    framed: bool
    walls: int = 0

    @property
    def common(self) -> int:
        """Number of parameters that all stages share."""
        return LIMIT_ROWS + sum(map(count, self.shapes)) + WALL_PARAMETERS * self.walls + self.cones

    @property
    def each(self) -> int:
        """Number of parameters of one stage."""
        return 6 * (self.others + self.cones) + WALL_PARAMETERS * self.walls


class StaticObstacles:
    """All solids that the drone keeps clear of, or stays inside of."""

    def __init__(self, keeping: Keeping) -> None:
        """Split the zones into convex parts."""
        solids = [solid for zone in keeping.zones for solid in rooms(zone, keeping.margin)]
        if np.isfinite(keeping.floor):
            solids.append(half_space((0.0, 0.0, 1.0), keeping.floor))
        if np.isfinite(keeping.ceiling):
            solids.append(half_space((0.0, 0.0, -1.0), -keeping.ceiling))
        self._rooms = solids
        self._discs = np.array([solid.disc for solid in solids]).reshape(-1, 3)

    def near(self, place: Array, distance: float) -> tuple[SolidConstraint, ...]:
        """Return the solids within a way of ``distance`` metres from a place (3,); all if there are few."""
        if len(self._rooms) <= LEAST_CONSTRAINTS:
            return tuple(self._rooms)
        x, y, radius = self._discs.T
        distances = np.hypot(x - place[0], y - place[1]) - radius
        return tuple(self._rooms[i] for i in np.flatnonzero(distances < distance + REACH_M))


def row_counts(
    keeping: Keeping, near: tuple[SolidConstraint, ...], traffic: Traffic, walls: Walls
) -> RowCounts:
    """Return which rows there are in one replan."""
    low, high = keeping.pitch
    return RowCounts(
        tuple(solid.shape for solid in near),
        len(traffic.others),
        len(traffic.cones),
        low > -0.5 * np.pi,
        high < 0.5 * np.pi,
        keeping.half_angle is not None and len(traffic.others) > 0,
        walls.count,
    )


def common(
    keeping: Keeping, near: tuple[SolidConstraint, ...], step: float, traffic: Traffic, walls: Walls
) -> list[float]:
    """Return the parameters that all stages share."""
    limits, given = keeping.limits, keeping
    numbers = [
        step,
        limits.speed,
        limits.usable_acceleration,
        given.reaction,
        given.separation + given.margin,
    ]
    numbers += [given.half_angle or 0.0, *given.pitch, *limits.wind]
    numbers += [number for solid in near for number in solid.parameters]
    if walls.count:
        numbers += _numbers(walls, given.margin)[-1].tolist()
    return [*numbers, *(cone.half_angle for cone in traffic.cones)]


def each(traffic: Traffic, walls: Walls, margin: float) -> Array:
    """Return the parameters of each stage, shape (N, 6 (D + C) + 4 M)."""
    sent = [np.hstack([other[1:], np.diff(other, axis=0)]) for other in traffic.others]
    sent += [np.hstack([cone.apex[1:], cone.axis[1:]]) for cone in traffic.cones]
    if walls.count:
        sent.append(_numbers(walls, margin)[:-1])
    return np.hstack(sent)


def _numbers(walls: Walls, margin: float) -> Array:
    """Return the parameters of half-spaces, shape (N + 1, 4 M)."""
    rows = np.concatenate([walls.normals, (walls.offsets + margin)[..., None]], axis=2)
    return rows.reshape(len(rows), -1)


def rows(of: RowCounts, state: tuple[Any, Any, Any], p: Any, g: Any) -> Any:
    """Return the rows of a stage as a column.

    state : position and velocity of the drone, and the unit vector opposite to its camera's axis
    p, g : parameters of ``each`` and ``common``
    """
    place, v, back = state
    step, speed, _, _, apart, half_angle, *_ = ca.vertsplit(g[:LIMIT_ROWS])
    cut = ca.sumsqr(v) * step**2 / 8
    constraints = [free_at(shape, place, sizes) - cut * sizes[1] for shape, sizes in _rooms(of, g)]
    for i in range(of.others):
        other, step_of_other = p[6 * i : 6 * i + 3], p[6 * i + 3 : 6 * i + 6]
        d = place - other
        # The relative motion of the two between two stages is straight, too.
        cut = ca.sumsqr(step * v - step_of_other) / (8 * ca.fmax(apart, SHARP_M))
        constraints.append(length(d) - apart - cut)
        if of.framed:
            constraints.append(beside_cone(d, back, half_angle))
    for i in range(of.cones):
        at = 6 * (of.others + i)
        angle = g[of.common - of.cones + i]
        constraints.append(beside_cone(place - p[at : at + 3], p[at + 3 : at + 6], angle))
    constraints += [ca.dot(wall[:3], place) - wall[3] for wall in _walls(of, p, of.each)]
    constraints.append(speed - ca.sqrt(ca.sumsqr(v[:2] - g[LIMIT_ROWS - 2 : LIMIT_ROWS]) + STANDING_MS**2))
    return ca.vertcat(*constraints)


def within(a: Any, most: Any) -> tuple[Any, Any]:
    """Return the nearest acceleration within the limit ``most``, and the slack of ``a`` to that limit.

    Without this row, a step would be clipped by the limit, and its direction would not improve the merit.
    """
    return a * most / ca.fmax(ca.norm_2(a), most), most - ca.sqrt(ca.sumsqr(a) + STANDING_MS**2)


def ends(of: RowCounts, place: Any, v: Any, g: Any) -> Any:
    """Return the slacks at the place where the drone stops if it brakes from the last stage, as a column.

    The braking path is straight, and the linearised slack of a convex solid is never larger than the slack.
    """
    acceleration, reaction = g[2], g[3]
    seconds = reaction + ca.sqrt(ca.sumsqr(v) + STANDING_MS**2) / (2 * acceleration)
    constraints = []
    for shape, sizes in _rooms(of, g):
        slack = free_at(shape, place, sizes)
        constraints.append(slack + seconds * ca.jtimes(slack, place, v))
    stands = place + seconds * v
    constraints += [ca.dot(wall[:3], stands) - wall[3] for wall in _walls(of, g, of.common - of.cones)]
    return ca.vertcat(*constraints) if constraints else ca.SX(0, 1)


def beside_cone(d: Any, axis: Any, half_angle: Any) -> Any:
    """Return how far a point at d from the apex is outside a cone, metres; behind it, the distance.

    If the axis is the line of sight, it is Alcantara et al., Eq. 12.i and 13, in metres.
    """
    along = ca.dot(axis, d)
    across = ca.sqrt(ca.fmax(ca.sumsqr(d) - along**2, 0) + TINY_M**2)
    sine, cosine = ca.sin(half_angle), ca.cos(half_angle)
    behind = cosine * along + sine * across < 0
    return ca.if_else(behind, length(d), cosine * across - sine * along)


def _rooms(of: RowCounts, g: Any) -> Iterator[tuple[int, Any]]:
    at = LIMIT_ROWS
    for shape in of.shapes:
        yield shape, g[at : at + count(shape)]
        at += count(shape)


def _walls(of: RowCounts, numbers: Any, end: int) -> Iterator[Any]:
    """Yield the parameters of half-spaces, the last of which ends at an index."""
    for i in range(of.walls):
        at = end - WALL_PARAMETERS * (of.walls - i)
        yield numbers[at : at + WALL_PARAMETERS]


def pitched(of: RowCounts, q: Any, g: Any) -> Any:
    """Return the distances from the cones of the lowest and the highest line of sight, as a column.

    Alcantara et al., Eq. 12.g.

    q : from the target to the camera, W, metres
    """
    low, high = g[6], g[7]
    flat = ca.sqrt(ca.sumsqr(q[:2]) + TINY_M**2)
    constraints = []
    if of.low:
        constraints.append(-ca.sin(low) * flat - ca.cos(low) * q[2])
    if of.high:
        constraints.append(ca.sin(high) * flat + ca.cos(high) * q[2])
    return ca.vertcat(*constraints)


def length(d: Any) -> Any:
    """Return the length of a vector; it is differentiable at 0, too."""
    return ca.sqrt(ca.sumsqr(d) + TINY_M**2)
