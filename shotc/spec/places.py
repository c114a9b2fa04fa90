"""Field types for places in the world: positions, and the point that a camera looks at."""

from typing import Annotated, Any, Literal

from pydantic import Field
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import PydanticCustomError

from shotc.ir.limits import Vec2, Vec3
from shotc.spec.degrees import instead_of
from shotc.spec.fieldtypes import FieldType, Text
from shotc.spec.heights import HEIGHT, STANDING, AboveGround
from shotc.spec.model import Model
from shotc.spec.pydantic_faults import fault
from shotc.spec.quantities import Quantity, Tuple
from shotc.units import describe

_LENGTH = Quantity("Length", "length")
_HINT = "write [x, y, z] in metres, or {lat: ..., lon: ..., height: ...}"
_POINT3 = Tuple("Point3", (_LENGTH,) * 3, "[x, y, z]", _HINT)
_SPOT = Tuple("Spot", (_LENGTH, _LENGTH, HEIGHT), "[x, y, z]", _HINT)
_PLAN = Tuple("Point2", (_LENGTH, _LENGTH), "[x, y]")

Spot = tuple[float, float, float | AboveGround]
"""x, y and z in metres, or x, y and a height above the ground there."""

# Names become file names and table cells, so they have no characters that are special in a shell, a file
# system or a spreadsheet.
NAME = Text(
    "Name",
    r"^[A-Za-z0-9]([A-Za-z0-9._-]{0,62}[A-Za-z0-9_-])?$",
    "unsafe-name",
    "use letters, digits, `-`, `_` and `.`, at most 64, starting with a letter or digit",
)

# A title is for people; ``filenames`` makes file names from it. It has no control characters, no marks that
# reverse or hide text, and does not look like a path.
_UNSEEN = r"\x00-\x1f\x7f-\xa0\u200b-\u200f\u2028-\u202f\u2060-\u206f\ufeff"
_OF_PATHS = r"/\\<>:|?*" + '"'
TITLE = Text(
    "MissionName",
    rf"^[^ .\-{_UNSEEN}{_OF_PATHS}]([^{_UNSEEN}{_OF_PATHS}]{{0,98}}[^ {_UNSEEN}{_OF_PATHS}])?$",
    "unsafe-name",
    'use letters of any script, digits, spaces and plain punctuation (no / \\ < > : " | ? *), at most 100',
)


class DegreesType(FieldType):
    """Latitude or longitude: a number of degrees, as on maps; stored in degrees."""

    def __init__(self, label: str, limit: float) -> None:
        self.label = label
        self.limit = limit

    def read(self, value: Any) -> float:
        """Return the number. Raise a fault unless it is within plus or minus ``limit``."""
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise fault(
                "wrong-type",
                f"expected a {self.label.lower()} in degrees, got {describe(value)}",
                "write decimal degrees without a unit, such as 47.3769",
            )
        if not -self.limit <= value <= self.limit:
            raise fault(
                "out-of-range",
                f"no place on earth has this {self.label.lower()}",
                f"give degrees from {-self.limit:g} to {self.limit:g}",
            )
        return float(value)

    def schema(self) -> JsonSchemaValue:
        """Return a bounded number."""
        return {"type": "number", "minimum": -self.limit, "maximum": self.limit}


Latitude = Annotated[float, DegreesType("Latitude", 90.0)]
Longitude = Annotated[float, DegreesType("Longitude", 180.0)]

Altitude = Annotated[float, Quantity("Altitude", "length", -500.0, 9000.0)]


class OnMap(Model):
    """A geographic place without height (WGS84)."""

    lat: Latitude = Field(description="latitude, degrees north")
    lon: Longitude = Field(description="longitude, degrees east")


class Geodetic(OnMap):
    """A geographic place (WGS84); with ``world.origin`` it is a point of the world frame."""

    height: Annotated[float | AboveGround, HEIGHT] = Field(
        default=STANDING,
        description="height over the plane through the origin, or {above: ground, height: ...}; on the "
        "ground by default",
    )


class PlaceType(FieldType):
    """A place: metres in the world, or latitude and longitude."""


class PlanType(PlaceType):
    """A place in the plan: ``[x, y]`` or ``{lat, lon}``."""

    label = "Plan"

    def read(self, value: Any) -> Vec2 | OnMap:
        """Return x and y of W in metres, or a geographic place. Raise a fault for anything else."""
        if isinstance(value, dict | OnMap):
            return OnMap.model_validate(value)
        if not isinstance(value, list | tuple):
            help_ = instead_of(value, heights=False) or "write [x, y] in metres, or {lat: ..., lon: ...}"
            raise fault("wrong-type", f"expected a place on the map, got {describe(value)}", help_)
        x, y = _PLAN.read(value)
        return (x, y)

    def schema(self) -> JsonSchemaValue:
        """Return the schema of both notations."""
        return {"anyOf": [_PLAN.reference(), {"$model": OnMap}]}


Plan = Annotated[Vec2 | OnMap, PlanType()]


class PositionType(PlaceType):
    """A point of the world: ``[x, y, z]`` or ``{lat, lon, height}``; heights may be above the ground."""

    label = "Position"

    def read(self, value: Any) -> Spot | Geodetic:
        """Return a point of W in metres, or a geodetic place. Raise a fault for anything else."""
        if isinstance(value, dict | Geodetic):
            return Geodetic.model_validate(value)
        if not isinstance(value, list | tuple):
            help_ = instead_of(value) or _HINT
            raise fault("wrong-type", f"expected a position, got {describe(value)}", help_)
        x, y, z = _SPOT.read(value)
        return (x, y, z)

    def schema(self) -> JsonSchemaValue:
        """Return the schema of both notations."""
        return {"anyOf": [_SPOT.reference(), {"$model": Geodetic}]}


class StandType(PositionType):
    """A point of the world for a body that may stand on the ground: its height is optional, as in ``[x,
    y]``.
    """

    label = "Stand"

    def read(self, value: Any) -> Spot | Geodetic:
        """Return a position; one with two numbers is on the ground."""
        if isinstance(value, list | tuple) and len(value) == 2:
            x, y = _PLAN.read(value)
            return (x, y, STANDING)
        return super().read(value)

    def schema(self) -> JsonSchemaValue:
        """Return the schema of all notations."""
        return {"anyOf": [_PLAN.reference(), _SPOT.reference(), {"$model": Geodetic}]}


STAND = StandType()
Stand = Annotated[Spot | Geodetic, STAND]
POSITION = PositionType()
Position = Annotated[Spot | Geodetic, POSITION]


class Relative(Model):
    """A place relative to a target, which moves with it."""

    from_: Annotated[str, NAME] = Field(
        alias="from", description="name of the target it counts from, or target for the shot's own"
    )
    offset: Annotated[Vec3, _POINT3] = Field(
        description="[east, north, up] from the target's foot, or [ahead, left, up] where it turns"
    )
    turn: Literal["course"] | None = Field(
        default=None, description="course: the offset turns with the way that the target goes"
    )


class StationType(PlaceType):
    """The place of a keyframe's camera: a position, or a place relative to a target."""

    label = "Station"

    def read(self, value: Any) -> Spot | Geodetic | Relative:
        """Return a point of W in metres, a geodetic place, or one relative to a target.

        Raise a fault for anything else.
        """
        if isinstance(value, Relative) or (isinstance(value, dict) and value.keys() & Relative.keys().keys()):
            return Relative.model_validate(value)
        if isinstance(value, list | tuple | dict | Geodetic):
            return POSITION.read(value)
        help_ = instead_of(value) or _STATION_HINT
        raise fault("wrong-type", f"expected a position, got {describe(value)}", help_)

    def schema(self) -> JsonSchemaValue:
        """Return the schema of all notations."""
        return {"anyOf": [POSITION.reference(), {"$model": Relative}]}


_STATION_HINT = f"{_HINT}, or {{from: a target, offset: [east, north, up]}}"
STATION = StationType()
Station = Annotated[Spot | Geodetic | Relative, STATION]


class LookAtType(PlaceType):
    """The point to look at: the name of a target, or a position, which without a height is on the ground."""

    label = "LookAt"

    def read(self, value: Any) -> str | Spot | Geodetic:
        """Return a target's name or a position. Raise a fault for anything else."""
        if not isinstance(value, str):
            return STAND.read(value)
        try:
            return NAME.read(value)
        except PydanticCustomError:
            help_ = instead_of(value)
            if not help_:
                raise
        raise fault("wrong-type", f"expected a target or a position, got {describe(value)}", help_)

    def schema(self) -> JsonSchemaValue:
        """Return the schema of both notations."""
        return {"anyOf": [NAME.reference(), STAND.reference()]}


LookAt = Annotated[str | Spot | Geodetic, LookAtType()]
