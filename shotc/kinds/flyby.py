"""Flyby: past a moving target from behind to ahead. Checked, but not planned yet."""

from typing import Literal

from pydantic import Field

from shotc.kinds.base import Kind, postponed
from shotc.spec.fields import Length, Name, PositiveLength
from shotc.spec.shot import ShotBase


class FlybyShot(ShotBase):
    """The parameters of a flyby."""

    kind: Literal["flyby"] = Field(description="what sort of shot it is")
    target: Name = Field(description="name of the target that is passed")
    behind: PositiveLength = Field(description="distance behind the target at the start")
    ahead: PositiveLength = Field(description="distance ahead of the target at the end")
    altitude: Length = Field(description="z of the camera")
    offset: Length = Field(
        default=0.0, description="distance of the pass to the left of the target's motion; negative is right"
    )


KIND = Kind(
    "flyby", "pass a moving target from behind to ahead", FlybyShot, postponed("flyby"), planned=False
)
