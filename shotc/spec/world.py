"""The world of a mission and its targets: its origin, standing and moving bodies, and zones."""

from typing import Annotated, Any, ClassVar, Literal

from pydantic import Field

from shotc.spec.fields import (
    Angle,
    BodySize,
    BuildingName,
    Duration,
    Heading,
    Heights,
    Name,
    NonNegativeDuration,
    Plan,
    PositiveLength,
    RelativePath,
    Size3,
    Speed,
    Stand,
    Velocity,
)
from shotc.spec.fieldtypes import Integer
from shotc.spec.heights import Lift
from shotc.spec.model import Model, OneOf, section
from shotc.spec.places import Altitude, Latitude, Longitude
from shotc.spec.pydantic_faults import fault
from shotc.spec.rehearse import WindSpec
from shotc.units import clip


class OriginSpec(Model):
    """The geographic position of the world's origin (WGS84)."""

    lat: Latitude = Field(description="latitude, degrees north")
    lon: Longitude = Field(description="longitude, degrees east")
    alt: Altitude = Field(default=0.0, description="height of the ground above mean sea level")


class CylinderSpec(Model):
    """An upright cylinder."""

    center: Plan = Field(description="axis, [x, y] or {lat, lon}")
    radius: PositiveLength = Field(description="radius")
    height: Heights = Field(description="[bottom, top], z in the world, or above ground")


class PolygonSpec(Model):
    """An upright prism over a simple polygon."""

    points: tuple[Plan, ...] = Field(
        min_length=3, max_length=200, description="corners in order, [[x, y], ...]"
    )
    height: Heights = Field(description="[bottom, top], z in the world, or above ground")


class BoxSpec(Model):
    """An upright box."""

    center: Stand = Field(description="middle of the box; it stands on the ground where no height is written")
    size: Size3 = Field(description="[width, depth, height]; width lies east at heading 0")
    heading: Angle = Field(default=0.0, description="compass bearing of the depth")


class ZoneSpec(Model):
    """A volume that drones stay outside or inside of."""

    exclusive: ClassVar[tuple[OneOf, ...]] = (OneOf((("cylinder",), ("polygon",), ("box",))),)

    keep: Literal["in", "out"] = Field(default="out", description="whether drones stay out of it or inside")
    cylinder: CylinderSpec | None = Field(default=None, description="the zone as a cylinder")
    polygon: PolygonSpec | None = Field(default=None, description="the zone as a prism")
    box: BoxSpec | None = Field(default=None, description="the zone as a box")


class TrackSpec(Model):
    """The motion of a target: rows of a file, a constant velocity, or points at constant speed or given
    times.
    """

    exclusive: ClassVar[tuple[OneOf, ...]] = (
        OneOf(
            (
                ("file",),
                ("file", "begins"),
                ("file", "smooth"),
                ("file", "begins", "smooth"),
                ("start", "velocity"),
                ("points", "speed"),
                ("points", "times"),
            )
        ),
    )

    file: RelativePath | None = Field(
        default=None,
        description="CSV file of t,x,y,z or t,lat,lon,height and maybe heading (rad) or heading_deg; or a "
        "GPX file with times, which count from its first point. Without heights it stands on the ground",
    )
    smooth: Duration | None = Field(
        default=None,
        description="standard deviation, over time, of the weights by which the file's rows are smoothed",
    )
    lift: Lift | None = Field(
        default=None,
        description="height of the target's centre over the places of the track, or over the ground where "
        "they have no height: half its own there by default, else 0; {above: ground, height} "
        "leaves their heights out",
    )
    begins: NonNegativeDuration | None = Field(
        default=None,
        description="when the file's first row happens, from mission start; the others come as long after it "
        "as in the file",
    )
    start: Stand | None = Field(
        default=None, description="where the target is at time 0; it stands where no height is written"
    )
    velocity: Velocity | None = Field(default=None, description="[east, north, up]")
    points: tuple[Stand, ...] | None = Field(
        default=None,
        min_length=2,
        description="points passed in order; it stands at those where no height is written",
    )
    speed: Speed | None = Field(default=None, description="speed along the points, from time 0")
    times: tuple[NonNegativeDuration, ...] | None = Field(
        default=None, min_length=2, description="when it is at each point, from mission start"
    )


class TargetSpec(Model):
    """Something to film."""

    exclusive: ClassVar[tuple[OneOf, ...]] = (
        OneOf((("at",), ("track",), ("parts",), ("building",))),
        OneOf((("radius", "height"), ("size",), ("size", "heading"), ("parts",), ("building",))),
        OneOf(
            (("heading",), ("track",)),
            required=False,
            help="leave `heading` out: what has a track faces the way it goes, or as the column `heading` of "
            "its file says",
        ),
    )

    at: Stand | None = Field(
        default=None, description="centre of a target that stands; on the ground where no height is written"
    )
    track: TrackSpec | None = Field(default=None, description="motion of the centre of a target that moves")
    radius: PositiveLength | None = Field(default=None, description="radius of its cylinder")
    height: PositiveLength | None = Field(default=None, description="height of its cylinder")
    size: BodySize | None = Field(
        default=None,
        description="[length, width, height] of its box: along the way that it faces, across it, up",
    )
    heading: Angle | None = Field(
        default=None, description="compass bearing of the length of a box that stands; 0 by default"
    )
    parts: tuple[Name, ...] | None = Field(
        default=None,
        min_length=2,
        max_length=8,
        description="names of targets that stand and make one picture, framed as one",
    )
    building: BuildingName | None = Field(
        default=None,
        description="name or id of a building of `world.buildings`, or name of a part of `world.scene`; the "
        "target is the boxes or cylinders about it",
    )
    top_speed: Speed | None = Field(
        default=None,
        description="speed that it never exceeds: a track that does is a fault; 70 m/s by default",
    )

    @property
    def tall(self) -> float:
        """The height of its body, metres; 0 for a group and for a building."""
        return self.size[2] if self.size is not None else self.height or 0.0


class TerrainSpec(Model):
    """Terrain from an elevation model."""

    file: RelativePath = Field(description="GeoTIFF, ASCII grid (.asc), SRTM (.hgt) or CSV of x,y,z")
    epsg: Annotated[int, Integer("Epsg", 1024, 32767)] | None = Field(
        default=None, description="code of its system of coordinates, where the file does not say it"
    )
    datum: Literal["sea", "origin", "home"] = Field(
        default="sea",
        description="what its heights count from: sea level, as the origin's alt; the plane z = 0; or home, "
        "which puts the ground at the first drone's home. Files in metres of the world count from z = 0",
    )


class SceneSpec(Model):
    """A mesh or a point cloud of the scene."""

    file: RelativePath = Field(
        description="mesh (.glb, .ply, .obj, .stl) or point cloud (.ply, .xyz, .las, .laz)"
    )
    at: Stand = Field(
        default=(0.0, 0.0, 0.0), description="where the file's origin is; on the ground without a height"
    )
    heading: Heading = Field(
        default=0.0,
        description="compass bearing of the file's north: of its y axis, or where y is up, of minus z",
    )
    up: Literal["y", "z"] | None = Field(
        default=None, description="the file's axis that points up; y in .glb and .obj, z in others by default"
    )
    units: Literal["m", "cm", "mm", "km", "ft", "in"] | None = Field(
        default=None, description="unit of the file's coordinates; .glb is in metres, others do not say it"
    )

    @classmethod
    def shorthand(cls, data: Any) -> Any:
        """Return the value. Raise a fault for a bare path, because it has no units."""
        units = "" if str(data).lower().endswith(".glb") else ", units: m"
        return _no_path(data, "scene", units)


class BuildingsSpec(Model):
    """Footprints of buildings, with their heights."""

    file: RelativePath = Field(description="GeoJSON of footprints, as OpenStreetMap exports them")
    height: PositiveLength | None = Field(
        default=None, description="height of buildings for which the file gives neither height nor levels"
    )

    @classmethod
    def shorthand(cls, data: Any) -> Any:
        """Return the value. Raise a fault for a bare path."""
        return _no_path(data, "buildings", "")


def _no_path(data: Any, key: str, more: str) -> Any:
    """Return data that is no bare path; else raise a fault that shows the mapping with its keys."""
    if not isinstance(data, str):
        return data
    help_ = f"write `{key}: {{file: {clip(data)}{more}}}`"
    raise fault("wrong-type", f"`{key}` is a mapping, not a path", help_)


class WorldSpec(Model):
    """The world of a mission."""

    origin: OriginSpec | None = Field(default=None, description="place on earth of the point [0, 0, 0]")
    scene: SceneSpec | None = Field(
        default=None, description="mesh or point cloud of what stands there; drones keep clear of it"
    )
    buildings: BuildingsSpec | None = Field(
        default=None, description="footprints of buildings; drones keep clear of them"
    )
    terrain: TerrainSpec | None = Field(
        default=None, description="ground that rises; the plane z = 0 by default"
    )
    wind: WindSpec = section("wind; drones' speed counts through the air")
    zones: dict[Name, ZoneSpec] = Field(default={}, description="named volumes to keep in or out of")
