"""The field types of the language, as annotations for models; values that were read are in SI and radians."""

from __future__ import annotations

from math import pi, radians
from typing import Annotated

from pydantic import StrictBool

from shotc.ir.allow import BLURRED, FAST_PAN, HIDDEN, SOFT
from shotc.ir.limits import Vec2, Vec3
from shotc.ir.smoothing import LONGEST_S, SHORTEST_S, SMOOTHINGS
from shotc.spec.fieldtypes import Integer, NamedOr, Text, TextOrNumber
from shotc.spec.heights import CameraAltitude, CameraAltitudeSpan, Heights
from shotc.spec.places import NAME, TITLE, Geodetic, LookAt, OnMap, Plan, Position, Relative, Stand, Station
from shotc.spec.quantities import Percentage, Quantity, QuantitySpan, Range, Tuple
from shotc.spec.screen import Aspect, BoxOnScreen, CompositionSet, Frame, ScreenPoint
from shotc.units import SMALLEST

__all__ = [
    "PACES",
    "Acceleration",
    "Angle",
    "AngleRange",
    "AngularAcceleration",
    "AngularRate",
    "Aspect",
    "BodySize",
    "BoxOnScreen",
    "BuildingName",
    "CameraAltitude",
    "CameraAltitudeSpan",
    "CompositionSet",
    "Count",
    "Duration",
    "FieldOfView",
    "Frame",
    "Frequency",
    "Geodetic",
    "Heading",
    "Heights",
    "Jerk",
    "Length",
    "LengthRange",
    "LengthSpan",
    "LookAt",
    "Name",
    "NonNegativeDuration",
    "NonNegativeLength",
    "NonNegativeSpeed",
    "OnMap",
    "Pace",
    "Pitch",
    "PitchRange",
    "Plan",
    "Point2",
    "Position",
    "PositiveLength",
    "PositiveLengthSpan",
    "PositiveShare",
    "Priority",
    "Relative",
    "RelativePath",
    "ScreenDistance",
    "ScreenPoint",
    "Share",
    "ShareRange",
    "ShotSize",
    "Size3",
    "Smoothing",
    "Speed",
    "Stand",
    "Station",
    "Switch",
    "Velocity",
]

SIZES: dict[str, float] = {
    "establishing": 0.1,  # the location, with the target as a part of it
    "long": 0.4,  # the target in its surroundings
    "full": 0.9,  # the whole target, with a little room
    "medium-full": 1.4,  # c = 0.34
    "medium": 2.2,  # c = 0.58
    "close-up": 5.0,  # c = 0.82
    "extreme-close-up": 10.0,  # a tenth of the target: of a person, forehead to chin
}
"""The film terms for the size of a target in the picture: its projected height over the frame's height.

The ladder of names is the one of film handbooks (Bowen and Thompson, Grammar of the Shot; Katz, Film
Directing Shot by Shot), which define sizes by where the frame cuts a standing person: below the feet (full),
above the knees (medium-full), at the waist (medium), at the shoulders (close-up), inside the face (extreme
close-up). Drillis and Contini's table (Winter, Biomechanics and Motor Control of Human Movement, fig. 4.1)
gives these heights as shares of the body's height: knee 0.285, hip 0.530, shoulder 0.818, chin 0.870,
eye 0.936. With 8 % of the frame above the head, a cut at c gives 0.92 / (1 - c), rounded here. The wide sizes
and the extreme one are our choice. Above 1 the target is cropped on purpose; a mission writes this only by
name.
"""

_LENGTH = Quantity("Length", "length")
_POSITIVE_LENGTH = Quantity("PositiveLength", "length", SMALLEST["length"])
_ANGLE = Quantity("Angle", "angle")
_PITCH = Quantity("Pitch", "angle", -pi / 2, pi / 2, noun="pitch")
_VELOCITY = Quantity("SignedSpeed", "speed")
_SHARE = Percentage("Share", "ratio", 0.0, 1.0, noun="share")
_POSITIVE_SHARE = Percentage("PositiveShare", "ratio", SMALLEST["ratio"], 1.0, noun="share")

Length = Annotated[float, _LENGTH]
PositiveLength = Annotated[float, _POSITIVE_LENGTH]
NonNegativeLength = Annotated[float, Quantity("NonNegativeLength", "length", 0.0)]
Speed = Annotated[float, Quantity("Speed", "speed", SMALLEST["speed"])]
NonNegativeSpeed = Annotated[float, Quantity("NonNegativeSpeed", "speed", 0.0)]
Acceleration = Annotated[float, Quantity("Acceleration", "acceleration", SMALLEST["acceleration"])]
Jerk = Annotated[float, Quantity("Jerk", "jerk", SMALLEST["jerk"])]
Angle = Annotated[float, _ANGLE]
# Ten turns; more is a mistake.
Heading = Annotated[float, Quantity("Heading", "angle", -20 * pi, 20 * pi, noun="heading")]
Pitch = Annotated[float, _PITCH]
FieldOfView = Annotated[
    float,
    Quantity(
        "FieldOfView", "angle", radians(1), radians(170), fault="impossible-camera", noun="field of view"
    ),
]
AngularRate = Annotated[float, Quantity("AngularRate", "angular rate", SMALLEST["angular rate"])]
AngularAcceleration = Annotated[
    float, Quantity("AngularAcceleration", "angular acceleration", SMALLEST["angular acceleration"])
]
Duration = Annotated[float, Quantity("Duration", "duration", SMALLEST["duration"])]
NonNegativeDuration = Annotated[float, Quantity("NonNegativeDuration", "duration", 0.0)]
Share = Annotated[float, _SHARE]
PositiveShare = Annotated[float, _POSITIVE_SHARE]
ShotSize = Annotated[float, NamedOr("ShotSize", SIZES, "shot size", _POSITIVE_SHARE)]
ScreenDistance = Annotated[float, Quantity("ScreenDistance", "ratio", 0.0, 3.0, noun="distance on screen")]
Frequency = Annotated[float, Quantity("Frequency", "frequency", 1.0, 1000.0)]

LengthRange = Annotated[tuple[float, float], Range("LengthRange", _LENGTH, thick=True)]
AngleRange = Annotated[tuple[float, float], Range("AngleRange", _ANGLE)]
PitchRange = Annotated[tuple[float, float], Range("PitchRange", _PITCH)]
ShareRange = Annotated[tuple[float, float], Range("ShareRange", _SHARE)]
LengthSpan = Annotated[tuple[float, float], QuantitySpan("LengthSpan", _LENGTH)]
PositiveLengthSpan = Annotated[tuple[float, float], QuantitySpan("PositiveLengthSpan", _POSITIVE_LENGTH)]

Point2 = Annotated[Vec2, Tuple("Point2", (_LENGTH, _LENGTH), "[x, y]")]
Size3 = Annotated[Vec3, Tuple("Size3", (_POSITIVE_LENGTH,) * 3, "[width, depth, height]")]
BodySize = Annotated[Vec3, Tuple("BodySize", (_POSITIVE_LENGTH,) * 3, "[length, width, height]")]
Velocity = Annotated[Vec3, Tuple("Velocity", (_VELOCITY,) * 3, "[east, north, up]")]

Switch = StrictBool
Count = Annotated[int, Integer("Count", 1, 20_000)]
Priority = Annotated[int, Integer("Priority", 1, 1_000)]

Name = Annotated[str, NAME]
Title = Annotated[str, TITLE]
# Relative, without a drive, a backslash, a control character or a part that is `..`.
RelativePath = Annotated[
    str,
    Text(
        "RelativePath",
        r"^(?!/)(?!(.*/)?[.][.](/|$))[^\\:\x00-\x1f]{1,255}$",
        "unsafe-path",
        "give a path inside the mission's folder, with `/` between folders and without `..`",
    ),
]

BuildingName = Annotated[
    str,
    TextOrNumber(
        "BuildingName",
        r"^(?! *$)[^\x00-\x1f]{1,80}$",
        "wrong-type",
        "give the `name` or the id of a building, as its file has it, such as way/310002",
    ),
]

PACES = {"calm": 0.5, "normal": 0.75, "brisk": 1.0}
# Below a twentieth of its limits a drone hardly moves, and a plan takes hours.
_SMOOTHING = Quantity("SmoothingTime", "duration", SHORTEST_S, LONGEST_S, noun="smoothing time")
Smoothing = Annotated[float, NamedOr("Smoothing", SMOOTHINGS, "smoothing", _SMOOTHING)]
Pace = Annotated[float, NamedOr("Pace", PACES, "pace", Quantity("PaceShare", "ratio", 0.05, 1.0))]


GRAMMAR = ("crossing-the-line", "jump-cut", "short-shot", "walks-out-of-frame", FAST_PAN)

_SLUG = NamedOr("AllowedWarning", {slug: slug for slug in (*GRAMMAR, HIDDEN, SOFT, BLURRED)}, "warning")

Allowed = tuple[Annotated[str, _SLUG], ...]
