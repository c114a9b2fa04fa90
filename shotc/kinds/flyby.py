"""Flyby: past a moving target from behind to ahead."""

from typing import Literal

from pydantic import Field

from shotc.kinds.base import Expansion, Kind, Scene
from shotc.kinds.moving import along
from shotc.spec.fields import Length, Name
from shotc.spec.shot import ShotBase


class FlybyShot(ShotBase):
    """The parameters of a flyby."""

    kind: Literal["flyby"] = Field(description="what sort of shot it is")
    target: Name = Field(description="name of the target that is passed")
    behind: Length = Field(description="distance behind the target at the start; negative is ahead of it")
    ahead: Length = Field(description="distance ahead of the target at the end; negative is behind it")
    altitude: Length = Field(description="z of the camera")
    offset: Length = Field(
        default=0.0, description="distance of the pass to the left of the target's motion; negative is right"
    )


def expand(shot: FlybyShot, scene: Scene) -> Expansion:
    """Return the way past the target, carried along by its motion."""
    start, end = (-shot.behind, shot.offset, shot.altitude), (shot.ahead, shot.offset, shot.altitude)
    return along(shot, scene, [start, end])


KIND = Kind("flyby", "pass a moving target from behind to ahead", FlybyShot, expand)
