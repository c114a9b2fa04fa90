"""Camera angles that put each target on the nearest place of its composition set (framing Eq. 1 and 2)."""

from collections.abc import Sequence
from itertools import pairwise
from math import atan2, hypot, pi
from typing import NamedTuple

from shotc.geom.camera import aim_at, heading_of
from shotc.geom.shapes import POINT
from shotc.geom.vec import TURN_RAD, Vec2, Vec3, direction, minus, wrapped
from shotc.ir.drone import Drone
from shotc.ir.keyframes import PlacedKeyframe
from shotc.ir.limits import reaches
from shotc.ir.mission import Keyframe, MissionIR, Shot
from shotc.planning.framing.candidates import TOUCH_M, FixedCamera, nearest_candidate, nearest_on_verticals

NORTH_RAD = pi / 2
ROUNDING_RAD = 1e-9


class Unmet(NamedTuple):
    """A keyframe whose composition is infeasible.

    aim : (yaw, pitch) as the author framed it, rad
    requested : place on screen of that framing; None where the keyframe keeps its author's framing
    place : where the target stands instead; None where no place shows it whole
    """

    keyframe: Keyframe
    setting: FixedCamera
    aim: Vec2
    requested: Vec2 | None
    place: Vec2 | None


def place_shot(
    mission: MissionIR, shot: Shot, moments: Sequence[MissionIR] = ()
) -> tuple[tuple[PlacedKeyframe, ...], tuple[Unmet, ...]]:
    """Return one shot's placed keyframes, and those whose composition is infeasible.

    moments : for every keyframe the mission at the time when the camera is there, if something moves
    """
    placed: list[PlacedKeyframe] = []
    misses: list[Unmet] = []
    for index, keyframe in enumerate(shot.keyframes):
        course = _course(shot.keyframes, index, placed[-1].yaw if placed else NORTH_RAD)
        placement, miss = _place(moments[index] if moments else mission, shot, keyframe, course)
        placed.append(placement)
        if miss is not None:
            misses.append(miss)
    return with_turns(shot.keyframes, tuple(placed)), tuple(misses)


def _place(
    mission: MissionIR, shot: Shot, keyframe: Keyframe, course: float
) -> tuple[PlacedKeyframe, Unmet | None]:
    drone = mission.drone(shot.drone)
    if keyframe.target is None:
        return _placed(keyframe, _own_aim(keyframe, drone, course), None, None), None
    setting = setting_of(mission, drone, keyframe, course)
    if shot.size is not None and shot.size > 1.0:
        # A shot of this size crops the target on purpose, so only its centre is placed.
        setting = setting._replace(shape=POINT)
    aim = own_framing(setting, keyframe, course)
    # A camera that looks at its target has it exactly in the middle.
    requested = (0.0, 0.0) if keyframe.aim is None else setting.screen(aim)
    composition = keyframe.composition
    if requested is None or composition.keep or composition.watches:
        crops = not reaches(setting.pitch, aim[1]) or -setting.margin(aim) > TOUCH_M
        unmet = Unmet(keyframe, setting, aim, None, None) if crops else None
        return _placed(keyframe, aim, requested, None if composition.watches else requested), unmet
    place, missed = nearest_candidate(setting, composition, requested), None
    if place is None:
        place = nearest_on_verticals(setting, composition, requested)
        missed = Unmet(keyframe, setting, aim, requested, place)
    turned = setting.aim(place) if place is not None else None
    return _placed(keyframe, turned or aim, requested, place), missed


def setting_of(mission: MissionIR, drone: Drone, keyframe: Keyframe, course: float) -> FixedCamera:
    """Return the placement problem of a keyframe that names a target."""
    assert keyframe.target is not None
    target = mission.target(keyframe.target)
    if isinstance(keyframe.aim, tuple) and len(keyframe.aim) == 2:
        course = keyframe.aim[0]
    return FixedCamera(
        offset=minus(target.centre, keyframe.at),
        shape=target.shape,
        hfov=keyframe.hfov,
        aspect=drone.aspect,
        pitch=drone.gimbal.pitch,
        yaw_if_vertical=course,
    )


def own_framing(setting: FixedCamera, keyframe: Keyframe, course: float) -> Vec2:
    """Return (yaw, pitch) of the camera as the author framed it, before composition."""
    if keyframe.aim is None:
        return setting.aim((0.0, 0.0)) or (course, 0.0)
    return explicit_aim(keyframe.at, keyframe.aim, course)


def explicit_aim(at: Vec3, aim: Vec2 | Vec3, course: float) -> Vec2:
    """Return (yaw, pitch) of given angles, or of a camera at ``at`` that looks at a point, rad."""
    if len(aim) == 2:
        return aim
    # The middle of the screen can be turned to any point, with any field of view.
    return aim_at(minus(aim, at), (0.0, 0.0), 1.0, 1.0, course) or (course, 0.0)


def _own_aim(keyframe: Keyframe, drone: Drone, course: float) -> Vec2:
    return (course, 0.0) if keyframe.aim is None else explicit_aim(keyframe.at, keyframe.aim, course)


def _placed(keyframe: Keyframe, aim: Vec2, requested: Vec2 | None, reference: Vec2 | None) -> PlacedKeyframe:
    return PlacedKeyframe(
        at=keyframe.at,
        yaw=_direction(aim[0]),
        pitch=aim[1],
        hfov=keyframe.hfov,
        target=keyframe.target,
        reference=reference,
        asked=requested,
        hold=keyframe.hold,
        time=keyframe.time,
        placed=keyframe.placed,
        path=keyframe.path,
    )


def _course(keyframes: tuple[Keyframe, ...], index: int, otherwise: float) -> float:
    """Return the yaw of the motion at a keyframe; without horizontal motion, ``otherwise``."""
    around = keyframes[max(0, index - 1) : index + 2]
    for a, b in reversed(list(pairwise(around))):
        dx, dy = b.at[0] - a.at[0], b.at[1] - a.at[1]
        if hypot(dx, dy) > 1e-6:
            return atan2(dy, dx)
    return otherwise


def _direction(angle: float) -> float:
    # The remainder is avoided where possible, because it would change the last bits.
    return angle if -pi < angle <= pi else direction(angle)


def with_turns(
    keyframes: tuple[Keyframe, ...], placed: tuple[PlacedKeyframe, ...]
) -> tuple[PlacedKeyframe, ...]:
    """Return the placed keyframes with the turns that their headings state.

    A heading within one whole turn, either way, is a direction, and the turn to it is free. A heading of
    360 deg or more states turns: the camera turns by exactly the difference from the number written before.
    Where no heading is written before, that of the keyframe before counts, from 0 to 360 deg. The change of
    angle due to composition is added.
    """
    turned = placed[:1]
    for i in range(1, len(placed)):
        heading = keyframes[i].heading
        if heading is None or abs(heading) < TURN_RAD - ROUNDING_RAD:
            turned += (placed[i],)
            continue
        before = keyframes[i - 1].heading
        written = (heading_of(placed[i - 1].yaw) if before is None else before) - heading
        step = placed[i].yaw - placed[i - 1].yaw
        turned += (placed[i]._replace(turn=written + wrapped(step - written)),)
    return turned
