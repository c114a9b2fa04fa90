"""One vehicle: the last of each message that it sent, and when."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from shotc.geom.vec import Vec3
from shotc.stream.autopilots import Autopilot
from shotc.stream.messages import (
    CommandResult,
    GimbalManager,
    GlobeFix,
    Heartbeat,
    Home,
    LocalPosition,
    Message,
    Origin,
    Parameter,
    StatusText,
)

if TYPE_CHECKING:  # MAVLink is an extra, and the checks work without it
    from shotc.stream.link import VehicleLink

AUTOPILOT_COMPONENT = 1
CAMERA_MAV_TYPE = 30
"""MAV_TYPE of a camera that sends heartbeats of its own."""
WARNING_SEVERITY = 4
"""The mildest MAV_SEVERITY whose texts are kept; higher numbers do not matter before a flight."""
MOST_KEPT_TEXTS = 4


@dataclass(slots=True)
class VehicleStatus:
    """What is known of one drone's vehicle.

    drone : its name in the plan
    autopilot : the autopilot that the plan is made for
    seen : when its last heartbeat arrived, s
    camera : the component that records
    answers : the last result of each command
    """

    drone: str
    autopilot: Autopilot
    link: VehicleLink
    heartbeat: Heartbeat | None = None
    seen: float = 0.0
    camera: int = AUTOPILOT_COMPONENT
    origin: GlobeFix | None = None
    home: GlobeFix | None = None
    position: Vec3 | None = None
    gimbal: GimbalManager | None = None
    parameters: dict[str, float] = field(default_factory=dict)
    answers: dict[int, int] = field(default_factory=dict)
    texts: deque[str] = field(default_factory=lambda: deque(maxlen=MOST_KEPT_TEXTS))

    @property
    def mode(self) -> int | None:
        """The flight mode of the last heartbeat."""
        return None if self.heartbeat is None else self.heartbeat.mode

    @property
    def armed(self) -> bool:
        """Whether its motors run."""
        return self.heartbeat is not None and self.heartbeat.armed

    def listen(self, now: float) -> None:
        """Read all messages that have arrived."""
        for message in self.link.receive():
            self.hear(message, now)

    def hear(self, message: Message, now: float) -> None:
        """Store one message."""
        match message:
            case Heartbeat():
                self._met(message, now)
            case Parameter(name, value):
                self.parameters[name] = value
            case CommandResult(command, result):
                self.answers[command] = result
            case Origin(place):
                self.origin = place
            case Home(place):
                self.home = place
            case LocalPosition(position):
                self.position = position
            case GimbalManager():
                self.gimbal = message
            case StatusText(severity, text) if severity <= WARNING_SEVERITY:
                self.texts.append(text)

    def _met(self, heartbeat: Heartbeat, now: float) -> None:
        if heartbeat.component == AUTOPILOT_COMPONENT:
            self.heartbeat, self.seen = heartbeat, now
        elif heartbeat.kind == CAMERA_MAV_TYPE:
            self.camera = heartbeat.component
