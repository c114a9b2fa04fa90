"""Flyby: past a moving target from behind to ahead."""

from typing import Literal

from pydantic import Field

from shotc.kinds.base import Expansion, Kind, Scene
from shotc.kinds.moving import along
from shotc.spec.fields import CameraAltitude, Length, Name
from shotc.spec.shot import ShotBase


class FlybyShot(ShotBase):
    """The parameters of a flyby."""

    kind: Literal["flyby"] = Field(description="what sort of shot it is")
    target: Name = Field(description="name of the target that is passed")
    behind: Length = Field(description="distance behind the target at the start; negative is ahead of it")
    ahead: Length = Field(description="distance ahead of the target at the end; negative is behind it")
    altitude: CameraAltitude = Field(description="height of the camera over the target's foot")
    offset: Length = Field(
        default=0.0, description="distance of the pass to the left of the target's motion; negative is right"
    )


def expand(shot: FlybyShot, scene: Scene) -> Expansion:
    """Return the way past the target, relative to its motion."""
    up = shot.altitude.first
    ends = [(-shot.behind, shot.offset, up), (shot.ahead, shot.offset, up)]
    return along(shot, scene, ends, shot.altitude.above)


KIND = Kind("flyby", "pass a moving target from behind to ahead", FlybyShot, expand)
