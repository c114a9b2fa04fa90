"""What a plan is to keep at every stage, as rows that are not negative where it is kept, metres or m/s.

A row is linearised in the state of its stage: x, y, z and their rates. What two rows of one stage lack is
priced by the worse of them.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import lru_cache, partial
from math import sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from shotc.plugin_api.replanner import Array, Cone, Keeping, Traffic
from shotc_casadi.replan.solids import NO_LENGTH_M, SHARP_M, Room, above, rooms

STATES = 6
STANDING_MS = 1e-3
"""A speed below it has no direction, m/s."""
REACH_M = 1.0
"""What stands farther off than this and the way of a horizon is left out, metres."""


class Rows(NamedTuple):
    """Rows of stages 1 to N.

    stage : of each, counted from 0, shape (R,); value : (R,); slope : by the state of that stage, (R, 6)
    uses : which entries of the slope can differ from zero, (R, 6)
    """

    stage: NDArray[np.int64]
    value: Array
    slope: Array
    uses: NDArray[np.bool_]

    def lack(self, stages: int) -> Array:
        """Return what is lacking at each stage, shape (N,)."""
        worst = np.zeros(stages)
        np.maximum.at(worst, self.stage, -self.value)
        return worst


class Kept(NamedTuple):
    """What is kept in one replan.

    near : room of what stands, with the radius of the curve round it
    target : shape (N, 3), stages 1 to N; traffic : as sent
    """

    keeping: Keeping
    step: float
    near: tuple[tuple[Room, float], ...]
    target: Array
    traffic: Traffic


def standing(keeping: Keeping) -> tuple[tuple[Room, float], ...]:
    """Return the rooms of all that stands."""
    found = [room for zone in keeping.zones for room in rooms(zone, keeping.margin)]
    if np.isfinite(keeping.floor):
        up = np.array([0.0, 0.0, 1.0])
        found.append((partial(above, up, keeping.floor), np.inf))
    return tuple(found)


def within_reach(
    found: tuple[tuple[Room, float], ...], place: Array, way: float
) -> tuple[tuple[Room, float], ...]:
    """Return the rooms of what may be met on a way of so many metres."""
    return tuple(each for each in found if each[0](place[None])[0][0] < way + REACH_M)


def rows(kept: Kept, states: Array) -> Rows:
    """Return all rows of states, shape (N, 6)."""
    n = len(states)
    p, v, keeping = states[:, :3], states[:, 3:], kept.keeping
    stands = [room(p) for room, _ in kept.near]
    by_place = list(_between(kept, stands, v))
    by_place += _beside_traffic(kept, p, v)
    by_place += _pitched(p, kept.target, keeping.pitch)
    fast, by_velocity = _too_fast(v, keeping.limits.speed)
    many = n * len(by_place)
    value = np.concatenate([*(each for each, _ in by_place), fast, np.zeros(len(stands))])
    slope = np.zeros((len(value), STATES))
    for i, (_, each) in enumerate(by_place):
        slope[i * n : i * n + n, :3] = each
    slope[many : many + n, 3:] = by_velocity
    for i, (room, normal) in enumerate(stands, start=many + n):
        slope[i, :3] = normal[-1]
        value[i], slope[i, 3:] = _stopping(room[-1], normal[-1], v[-1], keeping)
    stage, uses = _layout(n, len(by_place), len(stands))
    return Rows(stage, value, slope, uses)


@lru_cache(maxsize=64)
def _layout(stages: int, by_place: int, last: int) -> tuple[NDArray[np.int64], NDArray[np.bool_]]:
    """Return stage and uses of the rows: so many of places, one of speed, and so many of both at the end."""
    many = stages * by_place
    uses = np.ones((many + stages + last, STATES), dtype=np.bool_)
    uses[:many, 3:] = False
    uses[many : many + stages, [0, 1, 2, 5]] = False
    stage = np.append(np.tile(np.arange(stages), by_place + 1), np.full(last, stages - 1))
    return stage, uses


def _between(kept: Kept, stands: list[tuple[Array, Array]], v: Array) -> Iterator[tuple[Array, Array]]:
    """Yield the room at the stages, less what a straight step between two of them cuts off."""
    square = np.einsum("nd,nd->n", v, v) * (0.125 * kept.step**2)
    for (room, normal), (_, radius) in zip(stands, kept.near, strict=True):
        yield (room if radius == np.inf else room - square / radius), normal


def _beside_traffic(kept: Kept, p: Array, v: Array) -> Iterator[tuple[Array, Array]]:
    keeping = kept.keeping
    for other in kept.traffic.others:
        yield _apart(kept, p, v, other)
        if keeping.half_angle is not None:
            yield out_of_frame(p, kept.target, other[1:], keeping.half_angle)
    for cone in kept.traffic.cones:
        yield _out_of_cone(p, cone)


def out_of_frame(p: Array, target: Array, other: Array, half_angle: float) -> tuple[Array, Array]:
    """Return how far others (N, 3) are out of the cone about the lines of sight from p to target.

    Alcantara et al., Eq. 12.i and 13, in metres: the distance of the other drone from the cone's side.
    """
    q, d = p - target, p - other
    far, off = _length(q), _length(d)
    sight, away = q / far, d / off
    cosine = np.clip(np.einsum("nd,nd->n", sight, away), -1.0, 1.0)[:, None]
    sine = np.maximum(np.sqrt(1.0 - cosine**2), 1e-6)
    turned = (away - cosine * sight) / far + (sight - cosine * away) / off
    return _beside_cone(off, away, np.arccos(cosine) - half_angle, -turned / sine)


def _out_of_cone(p: Array, cone: Cone) -> tuple[Array, Array]:
    d = p - cone.apex[1:]
    off = _length(d)
    away, axis = d / off, cone.axis[1:]
    cosine = np.clip(np.einsum("nd,nd->n", axis, away), -1.0, 1.0)[:, None]
    sine = np.maximum(np.sqrt(1.0 - cosine**2), 1e-6)
    return _beside_cone(off, away, np.arccos(cosine) - cone.half_angle, -(axis - cosine * away) / off / sine)


def _beside_cone(off: Array, away: Array, beside: Array, turned: Array) -> tuple[Array, Array]:
    # off : distance from the apex; beside : angle beyond the cone, rad; turned : its gradient
    behind = beside > 0.5 * np.pi
    sine = np.where(behind, 1.0, np.sin(beside))
    slope = away * sine + np.where(behind, 0.0, off * np.cos(beside)) * turned
    return (off * sine)[:, 0], slope


def _apart(kept: Kept, p: Array, v: Array, other: Array) -> tuple[Array, Array]:
    # The way of one as seen from the other is straight, too, between two stages.
    d = p - other[1:]
    off, metres = _length(d), kept.keeping.separation + kept.keeping.margin
    steps = kept.step * v - np.diff(other, axis=0)
    cut = np.einsum("nd,nd->n", steps, steps) / (8.0 * max(metres, SHARP_M))
    return off[:, 0] - metres - cut, d / off


def _pitched(p: Array, target: Array, pitch: tuple[float, float]) -> Iterator[tuple[Array, Array]]:
    # Distances from the cones of the lowest and the highest line of sight; Eq. 12.g of Alcantara et al.
    low, high = pitch
    sides = []
    if low > -0.5 * np.pi:
        sides.append((-np.sin(low), -np.cos(low)))
    if high < 0.5 * np.pi:
        sides.append((np.sin(high), np.cos(high)))
    if not sides:
        return
    q = p - target
    flat = np.maximum(np.hypot(q[:, 0], q[:, 1]), NO_LENGTH_M)
    level = q[:, :2] / flat[:, None]
    for out, up in sides:
        yield out * flat + up * q[:, 2], np.column_stack([out * level, np.full(len(q), up)])


def _too_fast(v: Array, speed: float) -> tuple[Array, Array]:
    flat = np.hypot(v[:, 0], v[:, 1])
    slope = np.zeros_like(v)
    slope[:, :2] = -v[:, :2] / np.maximum(flat, STANDING_MS)[:, None]
    return speed - flat, slope


def _stopping(room: float, normal: Array, v: Array, keeping: Keeping) -> tuple[float, Array]:
    """Return the room where the drone stands after it has braked at the end, and its slope by the velocity.

    The way is straight, and the linearised room of a convex solid is no larger than the room there.
    """
    speed, most = sqrt(float(v @ v)), keeping.limits.acceleration
    seconds = keeping.reaction + 0.5 * speed / most
    closing = float(normal @ v)
    slope = seconds * normal
    if speed > STANDING_MS:
        slope = slope + 0.5 * closing / most / speed * v
    return room + seconds * closing, slope


def _length(d: Array) -> Array:
    return np.asarray(np.maximum(np.sqrt(np.einsum("nd,nd->n", d, d)), NO_LENGTH_M)[:, None])
