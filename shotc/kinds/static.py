"""Static: the camera stands still and films."""

from math import hypot, pi
from typing import ClassVar, Literal

from pydantic import Field

from shotc.diag.model import Diagnostic
from shotc.geom.camera import aim_at, yaw_of
from shotc.ir.limits import Vec2
from shotc.ir.mission import Composition, Deferred, Ideal
from shotc.kinds.base import STILL_S, Expansion, Kind, Scene
from shotc.kinds.moving import evenly, timed
from shotc.spec.fields import Angle, LookAt, Pitch, Position
from shotc.spec.model import OneOf
from shotc.spec.shot import AIM, ShotBase

SAME_PLACE_M = 1e-3  # metres, distance below which a camera looks at its own position
WATCH = Composition("fixed")  # the camera does not turn to its target


class StaticShot(ShotBase):
    """The parameters of a still camera; it films for ``timing.duration``, by default 5 s."""

    exclusive: ClassVar[tuple[OneOf, ...]] = (AIM,)

    kind: Literal["static"] = Field(description="what sort of shot it is")
    at: Position = Field(description="position of the camera")
    heading: Angle | None = Field(default=None, description="compass heading of the camera")
    pitch: Pitch | None = Field(default=None, description="elevation of the camera, positive up")
    look_at: LookAt | None = Field(default=None, description="target or position to look at")


def expand(shot: StaticShot, scene: Scene) -> Expansion:
    """Return one keyframe, held for the shot's duration; for a moving target, an ideal at one place."""
    followed = shot.look_at if isinstance(shot.look_at, str) else shot.target
    target = None if followed is None else scene.targets.get(followed)
    if followed is not None and target is not None and target.track is not None:
        aim = _constant_aim(shot, scene)
        if isinstance(aim, Diagnostic):
            return Expansion.of([aim])
        subject = scene.framed(shot, followed)
        if aim is not None:
            subject = subject._replace(composition=WATCH)
        ideal = Ideal("world", None, evenly([scene.place(shot.at)]), placed=True, aim=aim)
        return timed(shot, scene, ideal, (subject,), duration=STILL_S)
    aimed = scene.aim(shot, shot)
    if isinstance(aimed, Diagnostic | Deferred):
        return Expansion.of([aimed])
    keyframe = scene.keyframe(
        scene.place(shot.at),
        aimed[1],
        aim=aimed[0],
        hold=shot.timing.duration or STILL_S,
        placed=True,
        path=scene.path,
    )
    return Expansion.of([keyframe])


def _constant_aim(shot: StaticShot, scene: Scene) -> Vec2 | Diagnostic | None:
    """Return the constant (yaw, pitch) of a camera whose target moves through the picture, or None."""
    if shot.heading is not None and shot.pitch is not None:
        return (yaw_of(shot.heading), shot.pitch)
    if shot.look_at is None or isinstance(shot.look_at, str):
        return None
    point, eye = scene.place(shot.look_at), scene.place(shot.at)
    offset = (point[0] - eye[0], point[1] - eye[1], point[2] - eye[2])
    if hypot(*offset) < SAME_PLACE_M:
        return scene.fault("G014", "the camera looks at its own place", "look at another point", "look_at")
    # The middle of the screen can be turned to any other point.
    return aim_at(offset, (0.0, 0.0), 1.0, 1.0, pi / 2)


KIND = Kind("static", "stand still and film", StaticShot, expand)
