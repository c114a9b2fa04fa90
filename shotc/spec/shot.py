"""What every shot may say, whatever its kind, and the keyframes that a user writes down.

A kind subclasses ``ShotBase`` with its own parameters and ``kind: Literal["its-name"]``.
"""

from typing import ClassVar

from pydantic import Field

from shotc.spec.allow import Allowed
from shotc.spec.fields import (
    CompositionSet,
    FieldOfView,
    Frame,
    Heading,
    LookAt,
    Name,
    NonNegativeDuration,
    Pace,
    Pitch,
    ShotSize,
    Station,
)
from shotc.spec.model import Model, OneOf, section
from shotc.spec.shot_terms import RefineSpec, RequireSpec, TimingSpec

# The two ways to aim a camera: at something, or by compass heading and pitch.
AIM = OneOf((("look_at",), ("heading", "pitch")))
NO_DRONE = ""  # what stands for the drone of a shot that a fleet flies


class ShotBase(Model):
    """The fields every shot has."""

    id: Name = Field(description="name of the shot, unique in the mission")
    kind: str = Field(description="what sort of shot it is")
    drone: Name = Field(description="name of the drone that films it, or auto")
    target: Name | None = Field(default=None, description="name of the target in the picture")
    timing: TimingSpec = section("auto, or any of start, after, duration")
    composition: CompositionSet | None = Field(
        default=None,
        description="where on screen the target may be: a set, a named point or [[u, v], ...]; the rules' "
        "if silent; thirds includes the centre: to force a side, name a point such as left-third",
    )
    pace: Pace | None = Field(default=None, description="share of the limits used where timing is auto")
    size: ShotSize | None = Field(
        default=None,
        description="projected height over frame height to aim for: a share, or a name from establishing to "
        "extreme-close-up; from medium-full on the target is cropped",
    )
    require: RequireSpec | None = Field(default=None, description="what the shot promises")
    refine: RefineSpec | None = Field(default=None, description="how refinement is used")
    allow: Allowed = Field(
        default=(),
        description="warnings of film grammar that are not told of this shot, by name, or hidden-subject",
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
    frame: Frame | None = Field(
        default=None, description="where on screen the target goes; overrides composition"
    )
    hfov: FieldOfView | None = Field(
        default=None, description="horizontal field of view; the drone's if silent"
    )
    hold: NonNegativeDuration = Field(default=0.0, description="how long the camera rests here")
    time: NonNegativeDuration | None = Field(
        default=None, description="when it is here, from the shot's start"
    )
