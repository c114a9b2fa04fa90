"""What drones keep away from on their ways between shots, as a mission writes it."""

from pydantic import Field

from shotc.spec.fields import NonNegativeLength
from shotc.spec.model import Model
from shotc.spec.presets import TRANSIT_FILMED, TRANSIT_OTHER


class TransitClearanceSpec(Model):
    """How far drones stay away from things on transits, returns and waits."""

    filmed: NonNegativeLength | None = Field(
        default=None,
        description="least distance from a drone's body to a target that the mission films; "
        f"{TRANSIT_FILMED:g} m where there is room, if silent",
    )
    other: NonNegativeLength | None = Field(
        default=None,
        description="least distance from a drone's body to any other target and to keep-out zones; "
        f"{TRANSIT_OTHER:g} m where there is room, if silent",
    )
