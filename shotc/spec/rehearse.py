"""Wind, and the requirements of a mission on its rehearsals (`shotc simulate`)."""

from typing import Annotated, ClassVar, Literal

from pydantic import Field

from shotc.spec import presets
from shotc.spec.fields import (
    Heading,
    NonNegativeLength,
    NonNegativeSpeed,
    PositiveLength,
    PositiveShare,
    ScreenDistance,
    Share,
)
from shotc.spec.fieldtypes import Integer
from shotc.spec.model import Model, section
from shotc.spec.quantities import Quantity
from shotc.spec.shorthand import QuantityModel

Runs = Annotated[int, Integer("Runs", 1, 100_000)]


class WindSpec(QuantityModel):
    """The speed of the wind, and where it comes from."""

    SHORT: ClassVar = ("speed", Quantity("NonNegativeSpeed", "speed", 0.0))

    speed: NonNegativeSpeed = Field(default=0.0, description="how fast it blows")
    from_: Heading | None = Field(
        default=None, alias="from", description="compass bearing it comes from; any by default"
    )


class RehearsalPromiseSpec(Model):
    """The requirements on the runs of a rehearsal."""

    in_frame: Share | None = Field(
        default=None, description="least share of the frames of each shot with the whole target in them"
    )
    in_sight: Share | None = Field(
        default=None,
        description="least share of the instants of each shot at which half of the target or more is free",
    )
    mean_error: ScreenDistance | None = Field(
        default=None, description="largest mean distance on screen between target and reference, over a shot"
    )
    clearance: NonNegativeLength | None = Field(
        default=None,
        description="least distance from a drone's body to all else; 0 by default: nothing is touched",
    )
    stray: PositiveLength | None = Field(
        default=None, description="largest distance of a drone from where the plan has it"
    )
    of: PositiveShare = Field(default=1.0, description="share of the runs in which all of it has to hold")


class RehearseSpec(Model):
    """The conditions and requirements of the runs of `shotc simulate`; nothing else reads them."""

    wind: WindSpec | None = Field(default=None, description="wind; that of the world by default")
    gusts: NonNegativeSpeed = Field(default=0.0, description="standard deviation of gusts, on each axis")
    gps: Literal["rtk", "plain"] = Field(
        default="rtk", description="satellite receivers of drones and targets: with corrections, or without"
    )
    wander: NonNegativeLength = Field(
        default=0.0, description="standard deviation of how far what moves is off its track"
    )
    loop: Literal["replay", "track", "replan"] = Field(
        default="replay",
        description="replay: drone and camera do what was planned; track: the camera follows what is seen; "
        "replan: the drone does, too",
    )
    runs: Runs = Field(default=presets.RUN_COUNT, description="number of runs")
    require: RehearsalPromiseSpec = section("what has to hold in the runs")
