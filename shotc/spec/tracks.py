"""Tracks: how targets move."""

from typing import ClassVar

from pydantic import Field

from shotc.spec.fields import NonNegativeDuration, Position, RelativePath, Speed, Velocity
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
