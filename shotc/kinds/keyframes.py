"""Keyframes: the camera poses that the user framed, in order."""

from typing import Literal

from pydantic import Field

from shotc.diag.model import Diagnostic
from shotc.ir.mission import Deferred
from shotc.kinds.base import Expansion, Kind, Part, Scene, Stand
from shotc.spec.shot import KeyframeSpec, ShotBase


class KeyframesShot(ShotBase):
    """The parameters of a shot through keyframes."""

    kind: Literal["keyframes"] = Field(description="what sort of shot it is")
    keyframes: tuple[KeyframeSpec, ...] = Field(
        min_length=2, description="camera poses in order, two or more"
    )


def expand(shot: KeyframesShot, scene: Scene) -> Expansion:
    """Return the keyframes as they are written."""
    return Expansion.of(_keyframe(shot, scene, i) for i in range(len(shot.keyframes)))


def _keyframe(shot: KeyframesShot, scene: Scene, index: int) -> Part:
    spec, path = shot.keyframes[index], ("keyframes", index)
    aim = scene.aim(shot, spec, *path, own=spec.target)
    if isinstance(aim, Diagnostic | Deferred):
        return aim
    stand = scene.stand(shot, spec.at, *path, "at")
    if not isinstance(stand, Stand):
        return stand
    return scene.keyframe(
        stand.at,
        aim[1],
        aim=aim[0],
        composition=spec.frame or scene.composition,
        hfov=spec.hfov or scene.drone.hfov,
        hold=spec.hold,
        time=spec.time,
        placed=True,
        path=(*scene.path, *path),
        heading=spec.heading,
        beside=stand.beside,
        box=spec.box,
    )


KIND = Kind("keyframes", "fly through camera poses of your own", KeyframesShot, expand)
