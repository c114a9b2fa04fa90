"""References for every node: the target and its place on screen, or camera angles.

Between two keyframes that frame a target, all references move from the first to the second with the C2 step
of the convex path: the place on screen and, if the target changes, the target's cylinder (f_t and v_d of
Gebhardt and Hilliges, Sec. 4.1-4.2). Elsewhere the reference is the camera angles of the convex path.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from shotc.plugin_api import MissionIR, MovingLeg, PathIR
from shotc.plugin_api.refiner import (
    CAM_PITCH,
    CAM_YAW,
    HFOV,
    Array,
    DrawnPath,
    Drone,
    FreeSpace,
    PlacedKeyframe,
    PlacedShot,
    aim_at,
    flight_space,
    minimum_jerk,
    steady,
)
from shotc_casadi.conditions import AimCondition
from shotc_casadi.drawn import drawn_by
from shotc_casadi.extents import EXTENT_PARAMETERS, between, count_of, extents_of
from shotc_casadi.sight import sight_point
from shotc_casadi.walls import NodePlanes

LENS_COLUMN = 5  # column of the field of view in a camera of x, y, z, yaw, pitch, field of view
AHEAD_M = 1.0  # metres ahead of the camera: the target if no target is asked for


@dataclass(frozen=True, slots=True, eq=False)
class References:
    """References, one row a node.

    centre (N + 1, 3), radius, height, place (N + 1, 2), aim (N + 1, 2) : as in symbols.FIELDS
    framed : 1 where the target has a place on screen, shape (N + 1,)
    whole : 1 where the whole target has to be in the frame, shape (N + 1,)
    inside : margin of the target to the left, right, bottom and top edge there, half frames, (N + 1, 4)
    extents : of the target's bodies, (N + 1, K, EXTENT_PARAMETERS); K is 0 if it is one cylinder
    """

    centre: Array
    radius: Array
    height: Array
    place: Array
    aim: Array
    framed: Array
    whole: Array
    inside: Array
    extents: Array


Beside = Callable[[Array], NodePlanes]
"""Half-spaces for nodes at path parameters s, shape (N + 1,)."""


class ShotContext(NamedTuple):
    """A shot to refine: the mission, its drone, the free space, its keyframes and its leg.

    beside : half-spaces that keep it clear of moving obstacles, None if there are none
    drawn : the path that its author draws, None if there is none
    """

    mission: MissionIR
    drone: Drone
    space: FreeSpace
    placed: PlacedShot
    leg: MovingLeg
    beside: Beside | None = None
    drawn: DrawnPath | None = None


def subject_of(path: PathIR, drone: str, leg: MovingLeg) -> ShotContext:
    """Return the subject of a leg; drone : the name of its drone."""
    mission = path.keyframes.mission
    flown_by = mission.drone(drone)
    (placed,) = (p for p in path.keyframes.shots if p.shot.id == leg.shot)
    space, drawn = flight_space(mission, flown_by), drawn_by(placed, leg)
    return ShotContext(mission, flown_by, space, placed, leg, drawn=drawn)


def references_at(subject: ShotContext, condition: AimCondition, s: Array) -> References:
    """Return the references of a condition at path parameters s, shape (N + 1,)."""
    if condition.aims == "framing":
        return _framed(subject, s)
    keys = keys_of(subject)
    at = np.array([key_s for key_s, _ in keys])
    angles = _unwrapped([own_angles(subject, k) for _, k in keys], subject.leg.curve(at)[:, CAM_YAW])
    turn = np.column_stack([steady(at, angles[:, i])(s)[:, 0] for i in (0, 1)])
    own = _unframed(subject, s)
    if condition.aims == "angles":
        return replace(own, aim=turn)
    points = np.array(
        [
            sight_point(subject.mission, subject.space, k, tuple(a))
            for (_, k), a in zip(keys, angles, strict=True)
        ]
    )
    x, i = progress_at(at, s)
    looked_at = (1 - x) * points[i] + x * points[i + 1]
    aim = _towards(looked_at - np.asarray(subject.leg.curve(s)[:, :3]), turn)
    return replace(own, centre=looked_at, aim=aim, framed=np.ones(len(s)))


def own_angles(subject: ShotContext, keyframe: PlacedKeyframe) -> tuple[float, float]:
    """Return camera yaw and pitch of the author's keyframe, before the composition."""
    if keyframe.target is None or keyframe.asked is None:
        return keyframe.yaw, keyframe.pitch
    centre = subject.mission.target(keyframe.target).centre
    d = tuple(c - p for c, p in zip(centre, keyframe.at, strict=True))
    own = aim_at((d[0], d[1], d[2]), keyframe.asked, keyframe.hfov, subject.drone.aspect, keyframe.yaw)
    return own or (keyframe.yaw, keyframe.pitch)


def _framed(subject: ShotContext, s: Array) -> References:
    unframed = _unframed(subject, s)
    keys = keys_of(subject)
    x, i = progress_at(np.array([at for at, _ in keys]), s)
    for k, ((_, a), (_, b)) in enumerate(pairwise(keys)):
        here = i == k
        if a.target is None or b.target is None or a.reference is None or b.reference is None:
            continue
        share = x[here]
        first, second = subject.mission.target(a.target), subject.mission.target(b.target)
        unframed.centre[here] = (1 - share) * np.array(first.centre) + share * np.array(second.centre)
        unframed.radius[here] = ((1 - share) * first.radius + share * second.radius)[:, 0]
        unframed.height[here] = ((1 - share) * first.height + share * second.height)[:, 0]
        bodies = [extents_of(target.shape, unframed.extents.shape[1], 1) for target in (first, second)]
        unframed.extents[here] = between(bodies[0], bodies[1], share)
        unframed.place[here] = (1 - share) * np.array(a.reference) + share * np.array(b.reference)
        unframed.framed[here] = 1.0
        unframed.whole[here] = 1.0
    return unframed


def _unframed(subject: ShotContext, s: Array) -> References:
    """Return references with the convex path's angles and no framed target."""
    curve = subject.leg.curve
    assert curve is not None
    q = curve(s)
    aim = q[:, [CAM_YAW, CAM_PITCH]]
    ahead = np.column_stack(
        [np.cos(aim[:, 0]) * np.cos(aim[:, 1]), np.sin(aim[:, 0]) * np.cos(aim[:, 1]), np.sin(aim[:, 1])]
    )
    n = len(s)
    return References(
        centre=q[:, :3] + AHEAD_M * ahead,
        radius=np.zeros(n),
        height=np.zeros(n),
        place=np.zeros((n, 2)),
        aim=aim,
        framed=np.zeros(n),
        whole=np.zeros(n),
        inside=np.zeros((n, 4)),
        extents=np.zeros((n, _bodies(subject), EXTENT_PARAMETERS)),
    )


def _bodies(subject: ShotContext) -> int:
    """Return the number of extents of the targets of a shot."""
    names = {k.target for k in subject.placed.keyframes if k.target is not None}
    return count_of([subject.mission.target(name).shape for name in names])


def keys_of(subject: ShotContext) -> list[tuple[float, PlacedKeyframe]]:
    """Return the keyframes with their path parameters; each place occurs once."""
    keys: list[tuple[float, PlacedKeyframe]] = []
    for mark in subject.leg.marks:
        if not keys or mark.s > keys[-1][0]:
            keys.append((mark.s, subject.placed.keyframes[mark.index]))
    return keys


def progress_at(at: Array, s: Array) -> tuple[Array, np.ndarray]:
    """Return the smooth progress within a keyframe interval, (N + 1, 1), and the interval's index, (N
    + 1,).
    """
    i = np.clip(np.searchsorted(at, s, side="right") - 1, 0, len(at) - 2)
    x = np.clip((s - at[i]) / (at[i + 1] - at[i]), 0.0, 1.0)
    return minimum_jerk(x)[:, None], i


def _unwrapped(angles: list[tuple[float, float]], convex: Array) -> Array:
    """Return angles as an array; each yaw gets the convex path's winding, so that the author's turns stay."""
    rows = np.array(angles, dtype=np.float64)
    rows[:, 0] += 2 * np.pi * np.round((convex - rows[:, 0]) / (2 * np.pi))
    return rows


def _towards(d: Array, near: Array) -> Array:
    """Return yaw and pitch of directions; yaw has the winding of ``near``."""
    yaw = np.unwrap(np.arctan2(d[:, 1], d[:, 0]))
    yaw += 2 * np.pi * np.round((near[0, 0] - yaw[0]) / (2 * np.pi))
    return np.column_stack([yaw, np.arctan2(d[:, 2], np.hypot(d[:, 0], d[:, 1]))])


def fields_of_view(subject: ShotContext, s: Array, q: Array | None = None) -> tuple[Array, Array]:
    """Return tan of half the horizontal and vertical fields of view at s, shape (M,) each.

    q : x, y, z, yaw, pitch of a camera there, and its field of view if it is not the convex path's
    """
    wide = subject.leg.curve(s)[:, HFOV] if q is None or q.shape[1] <= LENS_COLUMN else q[:, LENS_COLUMN]
    half = np.tan(wide / 2)
    return half, half / subject.drone.aspect
