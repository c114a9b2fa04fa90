"""Spiral: a turn about the target whose distance and altitude change on the way."""

from math import pi
from typing import Literal

from pydantic import Field

from shotc.ir.target import Target
from shotc.kinds.base import Expansion, Kind, Scene
from shotc.kinds.orbit import Sweep
from shotc.kinds.rounds import axis_of, filmed, ring
from shotc.spec.fields import Angle, CameraAltitudeSpan, Name, PositiveLengthSpan
from shotc.spec.shot import ShotBase


class SpiralShot(ShotBase):
    """The parameters of a spiral."""

    kind: Literal["spiral"] = Field(description="what sort of shot it is")
    target: Name = Field(description="name of the target that is circled")
    radius: PositiveLengthSpan = Field(description="horizontal distance from the target's axis, [from, to]")
    altitude: CameraAltitudeSpan = Field(
        description="height of the camera over the target's foot, [from, to]"
    )
    sweep: Sweep = Field(default=2 * pi, description="how far to turn; negative is clockwise seen from above")
    start_azimuth: Angle = Field(
        default=0.0, description="compass bearing from the target to the first point"
    )


def expand(shot: SpiralShot, scene: Scene) -> Expansion:
    """Return keyframes around the target, at most 15 deg apart."""
    target = scene.subject(shot.target, "target")
    if not isinstance(target, Target):
        return Expansion.of([target])
    points = ring(axis_of(target), shot.start_azimuth, shot.sweep, shot.radius, shot.altitude.span)
    return filmed(shot, scene, target, points, turn="sweep", above=shot.altitude.above)


KIND = Kind("spiral", "turn about the target while distance and altitude change", SpiralShot, expand)
