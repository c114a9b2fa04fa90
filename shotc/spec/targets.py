"""Targets: what is filmed, standing or moving, as an upright cylinder about its centre."""

from typing import ClassVar

from pydantic import Field

from shotc.spec.fields import Position, PositiveLength, Speed
from shotc.spec.model import Model, OneOf
from shotc.spec.tracks import TrackSpec


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
