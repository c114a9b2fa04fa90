"""Fleets in the language: number of drones, layout on the ground, separation."""

import re
from typing import Annotated, Any, ClassVar, Literal

from pydantic import Field
from pydantic.json_schema import JsonSchemaValue

from shotc.spec import presets
from shotc.spec.drones import LimitsSpec, ModelName
from shotc.spec.fields import (
    Count,
    Duration,
    Name,
    NonNegativeLength,
    PositiveLength,
    RelativePath,
    Stand,
)
from shotc.spec.fieldtypes import FieldType
from shotc.spec.heights import STANDING
from shotc.spec.model import Model, OneOf, section
from shotc.spec.pydantic_faults import fault
from shotc.spec.quantities import Quantity
from shotc.spec.shorthand import QuantityModel
from shotc.units import SMALLEST, describe

MOST_DRONES = 20_000
_RANGE = re.compile(r"([0-9]{1,5}) ?- ?([0-9]{1,5})")
_RULE = "give numbers of drones, from 1: a range such as 1-20, or a list such as [21-60, 75]"


class NumbersType(FieldType):
    """Numbers of drones, stored as rising integers."""

    label = "DroneNumbers"

    def read(self, value: Any) -> tuple[int, ...]:
        """Return all numbers, each once. Raise a fault for none, or for a number that is given twice."""
        named: set[int] = set()
        for item in value if isinstance(value, list) else [value]:
            numbers = _span(item)
            again = named.intersection(numbers)
            if again:
                help_ = "name every drone of the group once"
                raise fault("out-of-range", f"drone {min(again)} is named twice", help_)
            named.update(numbers)
        if not named:
            raise fault("wrong-length", "a group needs a drone", _RULE)
        return tuple(sorted(named))

    def schema(self) -> JsonSchemaValue:
        """Return a number, a range, or a list of both."""
        one = [
            {"type": "integer", "minimum": 1, "maximum": MOST_DRONES},
            {"type": "string", "pattern": f"^{_RANGE.pattern}$"},
        ]
        return {"anyOf": [*one, {"type": "array", "items": {"anyOf": one}, "minItems": 1}]}


def _span(item: Any) -> range:
    match = _RANGE.fullmatch(item) if isinstance(item, str) else None
    if match is None and type(item) is not int:
        raise fault("wrong-type", f"expected numbers of drones, got {describe(item)}", _RULE)
    first, last = (int(match[1]), int(match[2])) if match is not None else (item, item)
    if not 1 <= first <= last <= MOST_DRONES:
        quoted = f"`{item}`" if match is not None or abs(first) <= MOST_DRONES else "a number so large"
        raise fault("out-of-range", f"{quoted} is no range of drones", _RULE)
    return range(first, last + 1)


DroneNumbers = Annotated[tuple[int, ...], NumbersType()]


class GridSpec(Model):
    """Drones in a square grid, row by row."""

    spacing: PositiveLength = Field(description="distance between neighbours")
    origin: Stand = Field(
        default=(0.0, 0.0, STANDING),
        description="south-west corner of the grid; every pad is on the ground, or as high, as it is",
    )


class CircleSpec(Model):
    """Drones evenly spaced on a circle."""

    radius: PositiveLength = Field(description="radius")
    center: Stand = Field(
        default=(0.0, 0.0, STANDING),
        description="middle of the circle; every pad is on the ground, or as high, as it is",
    )


class LayoutSpec(Model):
    """The layout of a fleet on the ground."""

    exclusive: ClassVar[tuple[OneOf, ...]] = (OneOf((("grid",), ("circle",), ("file",))),)

    grid: GridSpec | None = Field(default=None, description="a square grid")
    circle: CircleSpec | None = Field(default=None, description="a circle")
    file: RelativePath | None = Field(
        default=None,
        description="a CSV file with x,y,z or lat,lon,height, one row a drone; on the ground without heights",
    )


class SeparationSpec(QuantityModel):
    """The separation of two drones of a fleet, centre to centre."""

    SHORT: ClassVar = ("horizontal", Quantity("PositiveLength", "length", SMALLEST["length"]))

    horizontal: PositiveLength = Field(description="least distance side by side")
    vertical: PositiveLength | None = Field(
        default=None, description="least distance one above the other; the horizontal one by default"
    )
    shape: Literal["ellipsoid", "cylinder"] = Field(
        default="ellipsoid", description="the volume that they keep free: round, or as strict at its rim"
    )
    margin: NonNegativeLength = Field(
        default=0.0, description="more on either distance, for how far a drone strays from its plan"
    )


class FleetSpec(Model):
    """Many drones of one model."""

    count: Count = Field(description="number of drones")
    layout: LayoutSpec = Field(description="where they stand before and after")
    model: ModelName = Field(default="show-drone", description="preset of every drone")
    limits: LimitsSpec = section("what each may do")
    radius: PositiveLength | None = Field(default=None, description="radius of the sphere round each body")
    endurance: Duration | None = Field(default=None, description="longest time in the air")
    separation: SeparationSpec | None = Field(
        default=None, description="how far apart they stay, one distance or several; the rules' by default"
    )
    return_: Literal["any", "own"] = Field(
        default="any", alias="return", description="to which pad each comes home: any, or its own"
    )
    groups: dict[Name, DroneNumbers] = Field(
        default={}, description="numbers of drones that draw apart from the rest of the fleet, by group"
    )
    rise: PositiveLength = Field(
        default=presets.RISE_M, description="how far each rises, straight up, before it goes anywhere"
    )


def in_no_group(fleet: FleetSpec) -> tuple[int, ...]:
    """Return the numbers of a fleet's drones that are in no group, rising."""
    taken = {number for numbers in fleet.groups.values() for number in numbers}
    return tuple(number for number in range(1, fleet.count + 1) if number not in taken)
