"""Targets: what is filmed, standing or moving, as an upright cylinder about its centre."""

from typing import ClassVar

from pydantic import Field

from shotc.spec.fields import NonNegativeDuration, Position, PositiveLength, RelativePath, Speed, Velocity
from shotc.spec.model import Model, OneOf


class TrackSpec(Model):
    """How a target moves: rows of a file, a constant velocity, or points at one speed or at given times."""

    exclusive: ClassVar[tuple[OneOf, ...]] = (
        OneOf(
            (("file",), ("file", "begins"), ("start", "velocity"), ("points", "speed"), ("points", "times"))
        ),
    )

    file: RelativePath | None = Field(
        default=None,
        description="CSV file of t,x,y,z or t,lat,lon,height and maybe heading (rad) or heading_deg; or a "
        "GPX file with times, which count from its first point",
    )
    begins: NonNegativeDuration | None = Field(
        default=None,
        description="when the file's first row happens, from mission start; the others come as long after it "
        "as in the file",
    )
    start: Position | None = Field(default=None, description="where the target is at time 0")
    velocity: Velocity | None = Field(default=None, description="[east, north, up]")
    points: tuple[Position, ...] | None = Field(
        default=None, min_length=2, description="points passed in order"
    )
    speed: Speed | None = Field(default=None, description="speed along the points, from time 0")
    times: tuple[NonNegativeDuration, ...] | None = Field(
        default=None, min_length=2, description="when it is at each point, from mission start"
    )


class TargetSpec(Model):
    """Something to film."""

    exclusive: ClassVar[tuple[OneOf, ...]] = (OneOf((("at",), ("track",))),)

    at: Position | None = Field(default=None, description="centre of a target that stands")
    track: TrackSpec | None = Field(default=None, description="motion of the centre of a target that moves")
    radius: PositiveLength = Field(description="radius of its cylinder")
    height: PositiveLength = Field(description="height of its cylinder")
    top_speed: Speed | None = Field(
        default=None,
        description="speed that it never exceeds: a track that does is a fault; 70 m/s if silent",
    )
