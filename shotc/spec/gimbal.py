"""A drone's gimbal as a mission writes it."""

from pydantic import Field

from shotc.spec.fields import AngleRange, AngularAcceleration, AngularRate, PitchRange
from shotc.spec.model import Model


class GimbalSpec(Model):
    """What a gimbal reaches; what is not given is the preset's."""

    pitch: PitchRange | None = Field(default=None, description="[lowest, highest] against the horizon")
    yaw: AngleRange | None = Field(default=None, description="[lowest, highest] against the body")
    rate: AngularRate | None = Field(default=None, description="turning rate of each axis")
    acceleration: AngularAcceleration | None = Field(default=None, description="its rate of change")
