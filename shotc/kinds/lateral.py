"""Lateral: beside a moving target."""

from typing import Annotated, Literal

from pydantic import Field

from shotc.kinds.base import Expansion, Kind, Scene
from shotc.kinds.moving import along
from shotc.spec.fields import CameraAltitude, Name, PositiveLength
from shotc.spec.fieldtypes import NamedOr
from shotc.spec.shot import ShotBase

Side = Annotated[str, NamedOr("Side", {"left": "left", "right": "right"}, "side")]


class LateralShot(ShotBase):
    """The parameters of a lateral."""

    kind: Literal["lateral"] = Field(description="what sort of shot it is")
    target: Name = Field(description="name of the target that is accompanied")
    side: Side = Field(description="left or right of the target's motion")
    distance: PositiveLength = Field(description="horizontal distance beside the target")
    altitude: CameraAltitude = Field(description="height of the camera over the target's foot")


def expand(shot: LateralShot, scene: Scene) -> Expansion:
    """Return the place beside the target, which moves with it."""
    left = shot.distance if shot.side == "left" else -shot.distance
    return along(shot, scene, [(0.0, left, shot.altitude.first)], shot.altitude.above)


KIND = Kind("lateral", "accompany a moving target at its side", LateralShot, expand)
