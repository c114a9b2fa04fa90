"""KeyframeIR: keyframes whose camera angles place their target on the composition. Plain Python."""

from typing import NamedTuple

from shotc.ir.limits import Vec2, Vec3
from shotc.ir.mission import MissionIR, Shot
from shotc.ir.origin import KeyPath
from shotc.ir.setpoints import Asked, Setpoint, ViewAngles, asked_at


class PlacedKeyframe(NamedTuple):
    """A camera pose with the screen position its target is to have there.

    at : p_WC; yaw : camera yaw in (-pi, pi], rad; pitch : rad, up positive; hfov : rad
    target : the subject, or None for a keyframe that frames nothing
    reference : (u, v) of the target's centre, or None
    asked : (u, v) that the user's own framing gave, or None
    hold, time, placed : as in Keyframe
    turn : rad by which the camera's yaw turns from the keyframe before to this one, where the author
        says how often it goes round; None where that is free
    """

    at: Vec3
    yaw: float
    pitch: float
    hfov: float
    target: str | None
    reference: Vec2 | None
    asked: Vec2 | None
    hold: float
    time: float | None
    placed: bool
    path: KeyPath
    turn: float | None = None

    def asks_for_lens(self, own: float) -> bool:
        """Tell whether its field of view is a wish: the author's, or other than the camera's own, rad."""
        return self.placed or self.hfov != own


class PlacedSubject(NamedTuple):
    """A subject of a shot on its own clock, with the screen position it is to have.

    target : its name; reference : (u, v) of its centre at the first frame, or None where it is only watched
    size, view, setpoints : as in Subject
    """

    target: str
    reference: Vec2 | None
    size: float | None
    view: ViewAngles | None
    path: KeyPath
    setpoints: tuple[Setpoint, ...] = ()

    def asked(self, time: float) -> Asked:
        """Return how it is to appear at a time of its shot, seconds from the first frame."""
        return asked_at(Asked(self.reference, self.size, self.view), self.setpoints, time)


class PlacedShot(NamedTuple):
    """A shot and its placed keyframes: at least one, and one alone is a still camera.

    subjects : of a shot on its own clock, which has no keyframes
    """

    shot: Shot
    keyframes: tuple[PlacedKeyframe, ...]
    subjects: tuple[PlacedSubject, ...] = ()


class KeyframeIR(NamedTuple):
    """The mission with every shot's keyframes placed, in the order the shots are flown."""

    mission: MissionIR
    shots: tuple[PlacedShot, ...]
