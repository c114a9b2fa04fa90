"""Chase: behind a moving target, relative to its heading."""

from typing import Literal

from pydantic import Field

from shotc.kinds.base import Expansion, Kind, Scene
from shotc.kinds.moving import along
from shotc.spec.fields import CameraAltitude, Name, PositiveLength
from shotc.spec.shot import ShotBase


class ChaseShot(ShotBase):
    """The parameters of a chase."""

    kind: Literal["chase"] = Field(description="what sort of shot it is")
    target: Name = Field(description="name of the target that is followed")
    distance: PositiveLength = Field(description="horizontal distance behind the target")
    altitude: CameraAltitude = Field(description="height of the camera over the target's foot")


def expand(shot: ChaseShot, scene: Scene) -> Expansion:
    """Return the place behind the target, which moves with it."""
    return along(shot, scene, [(-shot.distance, 0.0, shot.altitude.first)], shot.altitude.above)


KIND = Kind("chase", "follow a moving target from behind", ChaseShot, expand)
