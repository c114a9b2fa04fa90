"""Fleets in the language: number of drones, layout on the ground, separation."""

from typing import ClassVar, Literal

from pydantic import Field

from shotc.spec import presets
from shotc.spec.drone_numbers import DroneNumbers
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
from shotc.spec.heights import STANDING
from shotc.spec.model import Model, OneOf, section
from shotc.spec.quantities import Quantity
from shotc.spec.shorthand import QuantityModel
from shotc.units import SMALLEST


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
