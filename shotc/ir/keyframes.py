"""KeyframeIR: keyframes whose camera angles place their target on the composition. Plain Python."""

from typing import NamedTuple

from shotc.diag.model import Diagnostic
from shotc.ir.limits import Vec2, Vec3
from shotc.ir.mission import MissionIR, Shot
from shotc.ir.origin import KeyPath
from shotc.ir.setpoints import Asked, Setpoint, ViewAngles, required_at
from shotc.source.file import SourceFile


class PlacedKeyframe(NamedTuple):
    """A camera pose with the reference of its target on screen.

    at : p_WC; yaw : camera yaw in (-pi, pi], rad; pitch : rad, up positive; hfov : rad
    target : the subject, or None for a keyframe that frames nothing
    reference : (u, v) of the target's centre, or None
    asked : (u, v) by the user's own framing, or None
    hold, time, placed : as in Keyframe
    turn : change of camera yaw from the keyframe before, rad, if the author states the number of turns; None
        if it is free
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
        """Return whether the field of view is required: by the author, or as it differs from ``own``, rad."""
        return self.placed or self.hfov != own


class PlacedSubject(NamedTuple):
    """A subject of a shot on its own clock, with its reference on screen.

    target : its name; reference : (u, v) of its centre at the first frame, or None without a composition
    size, view, setpoints : as in Subject
    """

    target: str
    reference: Vec2 | None
    size: float | None
    view: ViewAngles | None
    path: KeyPath
    setpoints: tuple[Setpoint, ...] = ()

    def asked(self, time: float) -> Asked:
        """Return its required appearance at a time of its shot, seconds from the first frame."""
        return required_at(Asked(self.reference, self.size, self.view), self.setpoints, time)


class PlacedShot(NamedTuple):
    """A shot and its placed keyframes; a single keyframe is a still camera.

    subjects : of a shot on its own clock, which has no placed keyframes
    """

    shot: Shot
    keyframes: tuple[PlacedKeyframe, ...]
    subjects: tuple[PlacedSubject, ...] = ()


class KeyframeIR(NamedTuple):
    """The mission with every shot's keyframes placed, in the order the shots are flown."""

    mission: MissionIR
    shots: tuple[PlacedShot, ...]


class Lowered(NamedTuple):
    """The lowered mission, or the diagnostics that stopped its lowering.

    file : its text, which the diagnostics refer to
    """

    keyframes: KeyframeIR | None
    diagnostics: tuple[Diagnostic, ...]
    file: SourceFile
