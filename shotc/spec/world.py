"""The world of a mission: where it is, what stands in it, where drones may fly."""

from typing import ClassVar, Literal

from pydantic import Field

from shotc.spec.fields import (
    Angle,
    LengthRange,
    Name,
    NonNegativeSpeed,
    Point2,
    Position,
    PositiveLength,
    RelativePath,
    Size3,
)
from shotc.spec.model import Model, OneOf
from shotc.spec.places import Altitude, Latitude, Longitude


class OriginSpec(Model):
    """The place on earth of the world's origin (WGS84)."""

    lat: Latitude = Field(description="latitude, degrees north")
    lon: Longitude = Field(description="longitude, degrees east")
    alt: Altitude = Field(default=0.0, description="height of the ground above mean sea level")


class CylinderSpec(Model):
    """An upright cylinder."""

    center: Point2 = Field(description="axis, [x, y]")
    radius: PositiveLength = Field(description="radius")
    height: LengthRange = Field(description="[bottom, top], z in the world")


class PolygonSpec(Model):
    """An upright prism over a simple polygon."""

    points: tuple[Point2, ...] = Field(
        min_length=3, max_length=200, description="corners in order, [[x, y], ...]"
    )
    height: LengthRange = Field(description="[bottom, top], z in the world")


class BoxSpec(Model):
    """An upright box."""

    center: Position = Field(description="middle of the box")
    size: Size3 = Field(description="[width, depth, height]; width lies east at heading 0")
    heading: Angle = Field(default=0.0, description="compass bearing of the depth")


class ZoneSpec(Model):
    """A volume drones stay out of, or inside."""

    exclusive: ClassVar[tuple[OneOf, ...]] = (OneOf((("cylinder",), ("polygon",), ("box",))),)

    keep: Literal["in", "out"] = Field(default="out", description="whether drones stay out of it or inside")
    cylinder: CylinderSpec | None = Field(default=None, description="the zone as a cylinder")
    polygon: PolygonSpec | None = Field(default=None, description="the zone as a prism")
    box: BoxSpec | None = Field(default=None, description="the zone as a box")


class WorldSpec(Model):
    """The world of a mission."""

    origin: OriginSpec | None = Field(default=None, description="place on earth of the point [0, 0, 0]")
    scene: RelativePath | None = Field(default=None, description="point cloud or mesh of the scene")
    wind: NonNegativeSpeed = Field(
        default=0.0, description="wind to reckon with; taken off the drones' speed"
    )
    zones: dict[Name, ZoneSpec] = Field(default={}, description="named volumes to keep in or out of")
