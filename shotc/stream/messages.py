"""The MAVLink messages that are received from an autopilot, gimbal or target, as plain values in SI units."""

from __future__ import annotations

from typing import NamedTuple

from shotc.geom.vec import Vec2, Vec3

ACCEPTED, REJECTED_FOR_NOW, IN_PROGRESS = 0, 1, 5
"""MAV_RESULT: accepted, may be requested again, and in progress; any other value is a refusal."""


class Heartbeat(NamedTuple):
    """A heartbeat. ``mode`` is custom_mode; kind, autopilot and status are MAVLink's numbers."""

    system: int
    component: int
    kind: int
    autopilot: int
    armed: bool
    mode: int
    status: int


class GlobeFix(NamedTuple):
    """A position on the globe: latitude and longitude in degrees, metres above mean sea level."""

    lat: float
    lon: float
    alt: float


class Parameter(NamedTuple):
    """A parameter, with its numerical value."""

    name: str
    value: float


class CommandResult(NamedTuple):
    """The result of a command, as MAV_RESULT."""

    command: int
    result: int


class Origin(NamedTuple):
    """The origin of the autopilot's local frame."""

    place: GlobeFix


class Home(NamedTuple):
    """The place to which the autopilot returns."""

    place: GlobeFix


class LocalPosition(NamedTuple):
    """The vehicle's position in its local frame: North, East, Down, m."""

    position: Vec3


class GlobalPosition(NamedTuple):
    """A vehicle's position on the globe."""

    system: int
    place: GlobeFix


class GimbalManager(NamedTuple):
    """A gimbal manager: its component, its device, and the gimbal's range of pitch and yaw, rad."""

    component: int
    device: int
    pitch: Vec2
    yaw: Vec2


class StatusText(NamedTuple):
    """A text of the autopilot for its pilot; severity 0 is an emergency, 7 is for developers."""

    severity: int
    text: str


Message = (
    Heartbeat
    | Parameter
    | CommandResult
    | Origin
    | Home
    | LocalPosition
    | GlobalPosition
    | GimbalManager
    | StatusText
)
