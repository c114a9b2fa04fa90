"""Lead: ahead of a moving target, looking back."""

from typing import Literal

from pydantic import Field

from shotc.kinds.base import Expansion, Kind, Scene
from shotc.kinds.moving import along
from shotc.spec.fields import CameraAltitude, Name, PositiveLength
from shotc.spec.shot import ShotBase


class LeadShot(ShotBase):
    """The parameters of a lead."""

    kind: Literal["lead"] = Field(description="what sort of shot it is")
    target: Name = Field(description="name of the target that is led")
    distance: PositiveLength = Field(description="horizontal distance ahead of the target")
    altitude: CameraAltitude = Field(description="height of the camera over the target's foot")


def expand(shot: LeadShot, scene: Scene) -> Expansion:
    """Return the place ahead of the target, which moves with it."""
    return along(shot, scene, [(shot.distance, 0.0, shot.altitude.first)], shot.altitude.above)


KIND = Kind("lead", "fly ahead of a moving target, looking back", LeadShot, expand)
