"""Mission-wide rules and outputs; the defaults are in ``presets``."""

from math import inf
from typing import Annotated, Literal

from pydantic import Field

from shotc.spec import presets
from shotc.spec.compositions import COMPOSITIONS
from shotc.spec.fields import Allowed, CompositionSet, Frequency, Name, NonNegativeLength, Pace, Smoothing
from shotc.spec.fieldtypes import NamedOr
from shotc.spec.model import Model
from shotc.spec.quantities import Quantity
from shotc.units import SMALLEST

_MAX_HEIGHT = NamedOr(
    "MaxHeight", {"off": inf}, "height", Quantity("PositiveLength", "length", SMALLEST["length"])
)
_HALF_ANGLE = Quantity("HalfAngle", "angle", SMALLEST["angle"], 1.5707963267948966)
_LOOK_AHEAD = Quantity("LookAhead", "angle", 0.08726646259971647, 1.5707963267948966, noun="look-ahead")


class MutualVisibilitySpec(Model):
    """Whether the drones keep out of each other's pictures."""

    half_angle: Annotated[float, _HALF_ANGLE] | None = Field(
        default=None, description="half the opening of the cone to keep free; the frame itself by default"
    )
    strength: Literal["require", "prefer", "off"] = Field(default="require", description="how strictly")


class TransitClearanceSpec(Model):
    """Clearances of drones on transits, returns and waits."""

    filmed: NonNegativeLength | None = Field(
        default=None,
        description="least distance from a drone's body to a target that the mission films; "
        f"{presets.TRANSIT_FILMED_M:g} m where there is room by default",
    )
    other: NonNegativeLength | None = Field(
        default=None,
        description="least distance from a drone's body to any other target and to keep-out zones; "
        f"{presets.TRANSIT_OTHER_M:g} m where there is room by default",
    )


class RulesSpec(Model):
    """Rules for the whole mission."""

    composition: CompositionSet = Field(
        default=COMPOSITIONS[presets.COMPOSITION],
        description="where on screen targets may be: a set, a named point or [[u, v], ...]; thirds includes "
        "the centre",
    )
    separation: NonNegativeLength = Field(
        default=presets.SEPARATION_M, description="least distance between drones, centre to centre"
    )
    ground_clearance: NonNegativeLength = Field(
        default=presets.GROUND_CLEARANCE_M, description="least distance from a drone's body to the ground"
    )
    max_height: Annotated[float, _MAX_HEIGHT] | None = Field(
        default=None,
        description="greatest height of a drone above the ground, or off; a warning above 120 m by default",
    )
    target_clearance: NonNegativeLength = Field(
        default=presets.TARGET_CLEARANCE_M, description="least distance from a drone's body to a target"
    )
    obstacle_clearance: NonNegativeLength = Field(
        default=presets.OBSTACLE_CLEARANCE_M,
        description="least distance from a drone's body to the scene and to buildings",
    )
    look_ahead: Annotated[float, _LOOK_AHEAD] | None = Field(
        default=None,
        description="largest angle between a drone's nose and the way it flies, between shots and in shots "
        "that leave the heading free; not judged by default",
    )
    transit_clearance: TransitClearanceSpec | None = Field(
        default=None,
        description="distances from a drone's body to targets and keep-out zones between shots: required "
        "where written, kept where there is room by default",
    )
    mutual_visibility: MutualVisibilitySpec | None = Field(
        default=None,
        description="whether drones keep out of each other's pictures; prefer, by the frame, is the default",
    )
    pace: Pace = Field(
        default=presets.PACE_SHARE, description="share of the limits used where timing is auto"
    )
    smoothing: Smoothing = Field(
        default=presets.SMOOTHING,
        description="calm cameras against closeness to the ideal: shorter movements are smoothed away",
    )
    allow: Allowed = Field(
        default=(),
        description="warnings of film grammar to accept, by name, or hidden-subject, "
        "soft-subject, motion-blur",
    )


class OutputSpec(Model):
    """The outputs."""

    rate: Frequency | None = Field(default=None, description="samples a second; 50, for shows 5 by default")
    emit: tuple[Name, ...] | None = Field(
        default=None,
        description=f"emitters to run; {', '.join(presets.EMIT)}, for shows {', '.join(presets.SHOW_EMIT)},"
        " by default; for machines of DJI `dji` or `litchi` instead of `mavlink`; none of these three without"
        " `world.origin`",
    )
