"""The field types of the language, as annotations for models; values that were read are in SI and radians."""

from __future__ import annotations

from math import pi, radians
from typing import Annotated

from pydantic import StrictBool

from shotc.ir.limits import Vec2, Vec3
from shotc.ir.smoothing import LONGEST_S, SHORTEST_S, SMOOTHINGS
from shotc.spec.fieldtypes import Integer, NamedOr, Text, TextOrNumber
from shotc.spec.heights import CameraAltitude, CameraAltitudeSpan, Heights
from shotc.spec.places import NAME, TITLE, Geodetic, LookAt, OnMap, Plan, Position, Relative, Stand, Station
from shotc.spec.quantities import Percentage, Quantity, QuantitySpan, Range, Tuple
from shotc.spec.screen import Aspect, BoxOnScreen, CompositionSet, Frame, ScreenPoint
from shotc.spec.sizes import SIZES
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
