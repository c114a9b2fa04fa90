"""The common fields of all shots, and keyframes as a user writes them.

A kind subclasses ``ShotBase`` with its own parameters and ``kind: Literal["its-name"]``. The mappings that
every shot may have are built on import: else pydantic would build them again for each kind that a mission
uses.
"""

from math import inf
from typing import Annotated, Any, ClassVar, Self

from pydantic import Field, GetJsonSchemaHandler, model_validator
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import CoreSchema

from shotc.ir.photos import Photos
from shotc.spec.exposure import FocusType, IntervalType
from shotc.spec.fields import (
    Allowed,
    BoxOnScreen,
    CompositionSet,
    FieldOfView,
    Frame,
    Heading,
    LookAt,
    Name,
    NonNegativeDuration,
    Pace,
    Pitch,
    ScreenDistance,
    Share,
    ShareRange,
    ShotSize,
    Smoothing,
    Station,
    Switch,
)
from shotc.spec.fieldtypes import Hinted
from shotc.spec.model import Model, OneOf, section
from shotc.spec.pydantic_faults import fault, fault_at
from shotc.spec.quantities import Quantity
from shotc.units import SMALLEST, clip, describe

# The two ways to aim a camera: at something, or by compass heading and pitch.
AIM = OneOf((("look_at",), ("heading", "pitch")))
NO_DRONE = ""  # drone of a shot that a fleet flies


_DURATION = Hinted(
    Quantity("Duration", "duration", SMALLEST["duration"]),
    "auto",
    "leave `duration` out, or write `timing: auto` where nothing else is given",
)


class TimingSpec(Model, defer_build=False):
    """The time of a shot; without any key it is ``auto``."""

    start: NonNegativeDuration | None = Field(
        default=None, description="first filmed frame, from mission start"
    )
    after: Name | None = Field(default=None, description="id of the shot that has to end first")
    duration: Annotated[float, _DURATION] | None = Field(
        default=None, description="length of the shot, holds included"
    )

    @classmethod
    def shorthand(cls, data: Any) -> Any:
        """Return an empty mapping for ``auto``; raise a fault for a value that is no timing."""
        if data == "auto":
            return {}
        if isinstance(data, str | int | float) and not isinstance(data, bool):
            seconds = data[:1].isdigit() if isinstance(data, str) else 0 < data < inf
            raise fault(
                "wrong-type",
                f"expected a timing, got {describe(data)}",
                f"write `auto`, or `{{duration: {clip(str(data))}}}`"
                if seconds
                else "write `auto`, or a mapping with start, after, duration",
            )
        return data

    @classmethod
    def __get_pydantic_json_schema__(
        cls, core_schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> JsonSchemaValue:
        """Return the schema of the mapping or ``auto``."""
        schema = handler.resolve_ref_schema(handler(core_schema))
        return {"anyOf": [{"const": "auto"}, schema]}


class RevealSpec(Model, defer_build=False):
    """The visible share of a target at the start and at the end of a shot."""

    from_: Share = Field(alias="from", description="share of its outline that is free in the first frame")
    to: Share = Field(description="share of its outline that is free in the last frame")

    @model_validator(mode="after")
    def _changes(self) -> Self:
        if self.from_ == self.to:
            help_ = "write `visible` for what is free in every frame"
            raise fault_at(("to",), "inverted-range", "nothing is revealed between equal shares", help_)
        return self


class RequireSpec(Model, defer_build=False):
    """The promises of a shot; verification checks them."""

    exclusive: ClassVar[tuple[OneOf, ...]] = (OneOf((("visible",), ("reveal",)), required=False),)

    in_frame: Share | None = Field(
        default=None, description="least share of the shot with the whole target in frame"
    )
    screen_error: ScreenDistance | None = Field(
        default=None, description="largest distance on screen between target and reference"
    )
    size: ShareRange | None = Field(
        default=None, description="lowest and highest projected height over frame height"
    )
    visible: Share | None = Field(
        default=None, description="least share of the target's outline that nothing covers, in any frame"
    )
    reveal: RevealSpec | None = Field(
        default=None,
        description="share of its outline that is free in the first frame and in the last: at most the "
        "smaller of the two, and at least the larger",
    )


class RefineSpec(Model, defer_build=False):
    """How refinement is used on a shot."""

    optional: Switch = Field(
        default=False, description="whether the unrefined path is flown if refinement fails"
    )


class PhotosSpec(Model, defer_build=False):
    """Photos that a shot takes instead of a film."""

    every: Annotated[Photos, IntervalType()] = Field(
        description="how far they are apart, in time or on the way, such as 2 s or 5 m"
    )


class ShotBase(Model):
    """The fields every shot has."""

    id: Name = Field(description="name of the shot, unique in the mission")
    kind: str = Field(description="what sort of shot it is")
    drone: Name = Field(description="name of the drone that films it, or auto")
    target: Name | None = Field(default=None, description="name of the target in the picture")
    timing: TimingSpec = section("auto, or any of start, after, duration")
    focus: Annotated[str | float, FocusType()] | None = Field(
        default=None,
        description="name of the target that the lens is focused on, or a distance, for cameras with an "
        "aperture; the target that is framed by default",
    )
    composition: CompositionSet | None = Field(
        default=None,
        description="where on screen the target may be: a set, a named point or [[u, v], ...]; the rules' "
        "by default; thirds includes the centre: to force a side, name a point such as "
        "left-third",
    )
    pace: Pace | None = Field(default=None, description="share of the limits used where timing is auto")
    smoothing: Smoothing | None = Field(
        default=None,
        description="calm camera against closeness to the ideal: shorter movements are smoothed away",
    )
    size: ShotSize | None = Field(
        default=None,
        description="projected height over frame height to aim for: a share, or a name from establishing to "
        "extreme-close-up; from medium-full on the target is cropped",
    )
    require: RequireSpec | None = Field(default=None, description="what the shot promises")
    refine: RefineSpec | None = Field(default=None, description="how refinement is used")
    photos: PhotosSpec | None = Field(
        default=None, description="photos in place of a film, by the files of machines that take them"
    )
    allow: Allowed = Field(
        default=(),
        description="warnings of film grammar to accept in this shot, by name, or hidden-subject, "
        "soft-subject, motion-blur",
    )


class KeyframeSpec(Model):
    """One picture of a shot: where the camera is, what it looks at, where the target goes."""

    exclusive: ClassVar[tuple[OneOf, ...]] = (AIM,)

    at: Station = Field(description="position of the camera")
    heading: Heading | None = Field(
        default=None,
        description="compass heading of the camera; 360 deg and more, either way, says how far to turn there",
    )
    pitch: Pitch | None = Field(default=None, description="elevation of the camera, positive up")
    look_at: LookAt | None = Field(default=None, description="target or position to look at")
    target: Name | None = Field(
        default=None, description="name of the target in this picture; the shot's by default"
    )
    box: BoxOnScreen | None = Field(
        default=None,
        description="[u0, v0, u1, v1], lower left and upper right, round what is meant, in which `shotc "
        "identify` finds the target",
    )
    frame: Frame | None = Field(
        default=None, description="where on screen the target goes; overrides composition"
    )
    hfov: FieldOfView | None = Field(
        default=None, description="horizontal field of view; the drone's by default"
    )
    hold: NonNegativeDuration = Field(default=0.0, description="how long the camera rests here")
    time: NonNegativeDuration | None = Field(
        default=None, description="when it is here, from the shot's start"
    )

    @model_validator(mode="after")
    def _one_subject(self) -> Self:
        if self.target is not None and isinstance(self.look_at, str):
            raise fault_at(
                ("target",),
                "conflicting-fields",
                "`target` cannot stand beside the name of a target to look at",
                "leave `target` out",
            )
        return self
