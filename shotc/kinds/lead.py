"""Lead: ahead of a moving target, looking back. Checked, but not planned yet."""

from typing import Literal

from pydantic import Field

from shotc.kinds.base import Kind, postponed
from shotc.spec.fields import Length, Name, PositiveLength
from shotc.spec.shot import ShotBase


class LeadShot(ShotBase):
    """The parameters of a lead."""

    kind: Literal["lead"] = Field(description="what sort of shot it is")
    target: Name = Field(description="name of the target that is led")
    distance: PositiveLength = Field(description="horizontal distance ahead of the target")
    altitude: Length = Field(description="z of the camera")


KIND = Kind("lead", "fly ahead of a moving target, looking back", LeadShot, postponed("lead"), planned=False)
