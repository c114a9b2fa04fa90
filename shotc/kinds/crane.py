"""Crane: the camera rises or sinks while it moves towards the target or away from it."""

from typing import Literal

from pydantic import Field

from shotc.ir.target import Target
from shotc.kinds.base import Expansion, Kind, Scene
from shotc.kinds.rounds import axis_of, filmed, line
from shotc.spec.fields import Angle, CameraAltitudeSpan, Name, PositiveLengthSpan
from shotc.spec.shot import ShotBase


class CraneShot(ShotBase):
    """The parameters of a crane."""

    kind: Literal["crane"] = Field(description="what sort of shot it is")
    target: Name = Field(description="name of the target that is framed")
    azimuth: Angle = Field(description="compass bearing from the target to the camera")
    distance: PositiveLengthSpan = Field(description="horizontal distance from the target's axis, [from, to]")
    altitude: CameraAltitudeSpan = Field(
        description="height of the camera over the target's foot, [from, to]"
    )


def expand(shot: CraneShot, scene: Scene) -> Expansion:
    """Return keyframes along the line, dense enough that the framing holds between them."""
    target = scene.subject(shot.target, "target")
    if not isinstance(target, Target):
        return Expansion.of([target])
    above, span = shot.altitude.above, shot.altitude.span
    looked_at = scene.height_of(target, above)
    points = line(axis_of(target), shot.azimuth, shot.distance, span, looked_at)
    return filmed(shot, scene, target, points, above=above)


KIND = Kind("crane", "rise or sink while moving towards the target or away", CraneShot, expand)
