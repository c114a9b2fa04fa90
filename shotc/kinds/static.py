"""Static: the camera stands still and films."""

from typing import ClassVar, Literal

from pydantic import Field

from shotc.diag.model import Diagnostic
from shotc.ir.mission import Deferred, Ideal
from shotc.kinds.base import STILL, Expansion, Kind, Scene
from shotc.kinds.moving import evenly, timed
from shotc.spec.fields import Angle, LookAt, Pitch, Position
from shotc.spec.model import OneOf
from shotc.spec.shot import AIM, ShotBase


class StaticShot(ShotBase):
    """The parameters of a still camera; it films for ``timing.duration``, 5 s where none is given."""

    exclusive: ClassVar[tuple[OneOf, ...]] = (AIM,)

    kind: Literal["static"] = Field(description="what sort of shot it is")
    at: Position = Field(description="position of the camera")
    heading: Angle | None = Field(default=None, description="compass heading of the camera")
    pitch: Pitch | None = Field(default=None, description="elevation of the camera, positive up")
    look_at: LookAt | None = Field(default=None, description="target or position to look at")


def expand(shot: StaticShot, scene: Scene) -> Expansion:
    """Return one keyframe, held for the shot's duration; of a target that moves, the place to watch from."""
    followed = shot.target if shot.look_at is None else shot.look_at
    if isinstance(followed, str) and shot.heading is None:
        target = scene.targets.get(followed)
        if target is not None and target.track is not None:
            ideal = Ideal("world", None, evenly([scene.place(shot.at)]), placed=True)
            return timed(shot, scene, ideal, (scene.framed(shot, followed),), lasts=STILL)
    aim = scene.aim(shot, shot)
    if isinstance(aim, Diagnostic | Deferred):
        return Expansion.of([aim])
    keyframe = scene.keyframe(
        scene.place(shot.at),
        aim[1],
        aim=aim[0],
        hold=shot.timing.duration or STILL,
        placed=True,
        path=scene.path,
    )
    return Expansion.of([keyframe])


KIND = Kind("static", "stand still and film", StaticShot, expand)
