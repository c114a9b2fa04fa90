"""Whether drones keep out of each other's pictures, as a mission writes it."""

from typing import Annotated, Literal

from pydantic import Field

from shotc.spec.model import Model
from shotc.spec.quantities import Quantity
from shotc.units import SMALLEST

_HALF_ANGLE = Quantity("HalfAngle", "angle", SMALLEST["angle"], 1.5707963267948966)


class MutualVisibilitySpec(Model):
    """Whether the drones keep out of each other's pictures."""

    half_angle: Annotated[float, _HALF_ANGLE] | None = Field(
        default=None, description="half the opening of the cone to keep free; the frame itself if silent"
    )
    strength: Literal["require", "prefer", "off"] = Field(default="require", description="how strictly")
