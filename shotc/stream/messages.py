"""What is heard of an autopilot, a gimbal or a target: MAVLink messages as plain values in SI units."""

from __future__ import annotations

from typing import NamedTuple

from shotc.geom.vec import Vec2, Vec3

ACCEPTED, REJECTED_FOR_NOW, IN_PROGRESS = 0, 1, 5
"""MAV_RESULT: what is accepted, what may be asked again, and what takes its time; any other is a refusal."""


class Heartbeat(NamedTuple):
    """Who is there. ``mode`` is custom_mode; kind, autopilot and status are MAVLink's numbers."""

    system: int
    component: int
    kind: int
    autopilot: int
    armed: bool
    mode: int
    status: int


class GlobeFix(NamedTuple):
    """A place on the globe: degrees, degrees, metres above mean sea level."""

    lat: float
    lon: float
    alt: float


class Parameter(NamedTuple):
    """A parameter, as the number that it means."""

    name: str
    value: float


class CommandResult(NamedTuple):
    """What came of a command; result as MAV_RESULT."""

    command: int
    result: int


class Origin(NamedTuple):
    """Where the autopilot's local frame has its origin."""

    place: GlobeFix


class Home(NamedTuple):
    """Where the autopilot returns to."""

    place: GlobeFix


class LocalPosition(NamedTuple):
    """Where the vehicle is in its local frame: North, East, Down, metres."""

    position: Vec3


class GlobalPosition(NamedTuple):
    """Where a vehicle is on the globe."""

    system: int
    place: GlobeFix


class GimbalManager(NamedTuple):
    """A gimbal manager: its component, its device, and what the gimbal reaches, rad."""

    component: int
    device: int
    pitch: Vec2
    yaw: Vec2


class StatusText(NamedTuple):
    """What the autopilot says to its pilot; severity 0 is an emergency, 7 is for developers."""

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
