"""Lateral: beside a moving target. Checked, but not planned yet."""

from typing import Annotated, Literal

from pydantic import Field

from shotc.kinds.base import Kind, postponed
from shotc.spec.fields import Length, Name, PositiveLength
from shotc.spec.fieldtypes import NamedOr
from shotc.spec.shot import ShotBase

Side = Annotated[str, NamedOr("Side", {"left": "left", "right": "right"}, "side")]


class LateralShot(ShotBase):
    """The parameters of a lateral."""

    kind: Literal["lateral"] = Field(description="what sort of shot it is")
    target: Name = Field(description="name of the target that is accompanied")
    side: Side = Field(description="left or right of the target's motion")
    distance: PositiveLength = Field(description="horizontal distance beside the target")
    altitude: Length = Field(description="z of the camera")


KIND = Kind(
    "lateral", "accompany a moving target at its side", LateralShot, postponed("lateral"), planned=False
)
