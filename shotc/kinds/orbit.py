"""Orbit: a turn about the target at one distance and altitude."""

from math import pi
from typing import Annotated, Any, Literal

from pydantic import Field, field_validator

from shotc.ir.target import Target
from shotc.kinds.base import Expansion, Kind, Scene
from shotc.kinds.rounds import axis_of, filmed, ring
from shotc.spec.fields import Angle, CameraAltitude, Name, PositiveLength
from shotc.spec.pydantic_faults import fault
from shotc.spec.quantities import Quantity
from shotc.spec.shot import ShotBase

# Ten turns; more is a mistake, and a plan would take hours.
Sweep = Annotated[float, Quantity("Sweep", "angle", -20 * pi, 20 * pi)]


class OrbitShot(ShotBase):
    """The parameters of an orbit."""

    kind: Literal["orbit"] = Field(description="what sort of shot it is")
    target: Name = Field(description="name of the target that is circled")
    radius: PositiveLength = Field(description="horizontal distance from the target's axis")
    altitude: CameraAltitude = Field(description="height of the camera over the target's foot")
    sweep: Sweep = Field(default=2 * pi, description="how far to turn; negative is clockwise seen from above")
    start_azimuth: Angle = Field(
        default=0.0, description="compass bearing from the target to the first point"
    )

    @field_validator("radius", "altitude", mode="before")
    @classmethod
    def _keeps(cls, value: Any) -> Any:
        if isinstance(value, list):
            message = "an orbit keeps its radius and its altitude"
            raise fault("wrong-type", message, "write one length, or `kind: spiral` to go [from, to]")
        return value


def expand(shot: OrbitShot, scene: Scene) -> Expansion:
    """Return keyframes around the target, at most 15 deg apart."""
    target = scene.subject(shot.target, "target")
    if not isinstance(target, Target):
        return Expansion.of([target])
    radius, altitude = (shot.radius, shot.radius), shot.altitude
    points = ring(axis_of(target), shot.start_azimuth, shot.sweep, radius, altitude.span)
    return filmed(shot, scene, target, points, turn="sweep", above=altitude.above)


KIND = Kind("orbit", "turn about the target at one distance and altitude", OrbitShot, expand)
