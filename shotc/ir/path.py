"""PathIR: the geometry of every leg as q(s), before time.

s is path length in metres (turns on the spot count as length too); it is never a time. A shot on its
own clock is a ``ClockLeg``, the one kind of leg that is a curve over mission time already. A camera that
stands still has a ``HoldLeg`` and no curve.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import ClassVar, TypeVar

from shotc.geom.bernstein import Piecewise
from shotc.ir.keyed import is_keyed
from shotc.ir.keyframes import KeyframeIR
from shotc.ir.mission import MissionIR
from shotc.ir.origin import KeyPath
from shotc.ir.phases import KeyframeTime, PhaseName, Reference

Pose = tuple[float, ...]
"""The channels of a camera at one moment, as CHANNELS."""

CHANNELS = ("x", "y", "z", "cam_yaw", "cam_pitch", "body_yaw", "hfov")
X, Y, Z, CAM_YAW, CAM_PITCH, BODY_YAW, HFOV = range(7)


@dataclass(frozen=True, slots=True)
class Stop:
    """A place where the drone comes to rest: at path parameter s, for ``hold`` seconds."""

    s: float
    hold: float


@dataclass(frozen=True, slots=True)
class Mark:
    """A keyframe on the path.

    s : its path parameter
    time : seconds from the shot's start, if the mission fixes it
    index : among the shot's keyframes
    """

    s: float
    time: float | None
    index: int
    path: KeyPath


@dataclass(frozen=True, slots=True, eq=False)
class FramingSpan:
    """A stretch of the path on which one target is framed.

    target : its name
    reference : (u, v) wanted of its centre, curve over s; breaks[0] and breaks[-1] are the stretch;
        or None where the target is only watched (no composition asked)
    """

    target: str
    start: float
    end: float
    reference: Piecewise | None


class _OnCurve:
    """A leg that begins and ends at rest where its curve does."""

    __slots__ = ()
    curve: Piecewise

    @property
    def pose(self) -> Pose:
        """Channels at the start of the leg, at rest."""
        return tuple(map(float, self.curve.ctrl[0, 0]))

    @property
    def end_pose(self) -> Pose:
        """Channels at its end, at rest."""
        return tuple(map(float, self.curve.ctrl[-1, -1]))


@dataclass(frozen=True, slots=True, eq=False)
class MovingLeg(_OnCurve):
    """One stretch of flight from rest to rest along a path.

    curve : q(s), channels CHANNELS, piecewise quintic, at least C2
    stops : where it rests, in order of s; the first is at curve.start, the last at curve.end
    marks : keyframes (shots only)
    pace  : share of the limits, where the duration is free; smoother : smoothing over the normal one
    duration : seconds asked for the whole leg including holds, or None
    start : earliest mission time of its first frame, or None
    """

    phase: PhaseName
    shot: str | None
    curve: Piecewise
    stops: tuple[Stop, ...]
    marks: tuple[Mark, ...]
    framing: tuple[FramingSpan, ...]
    pace: float
    duration: float | None
    start: float | None
    path: KeyPath
    smoother: float = 1.0


@dataclass(frozen=True, slots=True, eq=False)
class HoldLeg:
    """A shot of a camera that stands still.

    pose : channels CHANNELS, all through the leg
    hold : seconds that its keyframes are held, where ``duration`` is None
    marks, framing : as in MovingLeg, at s = 0; duration, start : as there
    """

    phase: ClassVar[PhaseName] = "shot"

    shot: str
    pose: Pose
    hold: float
    marks: tuple[Mark, ...]
    framing: tuple[FramingSpan, ...]
    duration: float | None
    start: float | None
    path: KeyPath

    @property
    def end_pose(self) -> Pose:
        """Channels at its end."""
        return self.pose


@dataclass(frozen=True, slots=True, eq=False)
class ClockLeg(_OnCurve):
    """A shot on its own clock, with the way into its motion and out of it, from rest to rest.

    curve : channels CHANNELS over mission time, piecewise quintic, at least C2
    start, end : mission time of the first and the last filmed frame, seconds
    framing, keyframes : what is framed, and when keyframes are reached
    """

    shot: str
    curve: Piecewise
    start: float
    end: float
    framing: tuple[Reference, ...]
    path: KeyPath
    keyframes: tuple[KeyframeTime, ...] = ()


PathLeg = MovingLeg | HoldLeg
"""A leg that no clock binds."""
Leg = PathLeg | ClockLeg


@dataclass(frozen=True, slots=True, eq=False)
class DronePath:
    """All legs of one drone, in the order they are flown; each starts where the last one ended."""

    drone: str
    legs: tuple[PathLeg, ...]


@dataclass(frozen=True, slots=True, eq=False)
class TimedPath:
    """All legs of one drone that films something on its own clock, joined as in DronePath."""

    drone: str
    legs: tuple[Leg, ...]


@dataclass(frozen=True, slots=True)
class PathDeviation:
    """How far a shot on a path left its ideal: ``distance`` metres, at path parameter s, and why."""

    shot: str
    distance: float
    s: float
    cause: str


@dataclass(frozen=True, slots=True)
class ClockDeviation:
    """How far a shot on its own clock left its ideal: ``distance`` metres, at mission time t, and why."""

    shot: str
    distance: float
    t: float
    cause: str


Deviation = PathDeviation | ClockDeviation
_Deviation = TypeVar("_Deviation", PathDeviation, ClockDeviation, Deviation)


LIMITS, CALM = "the drone's limits", "a calmer camera, and the drone's limits"
SIGHT = "what would hide the subject"
"""Causes that are neither a thing in the way nor a picture."""


def from_what_was_asked(mission: MissionIR, deviations: Iterable[_Deviation]) -> tuple[_Deviation, ...]:
    """Return the deviations from places that somebody asked for.

    Nobody did between the keyframes of a shot on its own clock: only what stands in the way counts there.
    """
    return tuple(d for d in deviations if not (is_keyed(mission.shot(d.shot)) and d.cause in (LIMITS, CALM)))


@dataclass(frozen=True, slots=True, eq=False)
class PathIR:
    """The mission's geometry.

    drones : those that film what stands, and nothing else; timed : the others
    stats : (name, value) pairs of what the solvers reported, in a fixed order
    """

    keyframes: KeyframeIR
    drones: tuple[DronePath, ...]
    deviations: tuple[Deviation, ...]
    stats: tuple[tuple[str, float | str], ...]
    timed: tuple[TimedPath, ...] = ()

    def check(self) -> None:
        """Raise ValueError unless legs join and stops lie on their curves."""
        every: tuple[DronePath | TimedPath, ...] = (*self.drones, *self.timed)
        for drone in every:
            end: Pose | None = None
            for leg in drone.legs:
                name = leg.phase if isinstance(leg, MovingLeg) else f"shot {leg.shot}"
                if end is not None and max(abs(a - b) for a, b in zip(end, leg.pose, strict=True)) > 1e-6:
                    raise ValueError(f"{drone.drone}: {name} does not start where the last leg ended")
                end = leg.end_pose
                if isinstance(leg, MovingLeg) and (
                    abs(leg.stops[0].s - leg.curve.start) > 1e-9
                    or abs(leg.stops[-1].s - leg.curve.end) > 1e-9
                ):
                    raise ValueError(f"{drone.drone}: {name} does not begin and end at rest")


def leg_of(path: PathIR, shot: str) -> MovingLeg:
    """Return the leg on which a camera that moves along a path films a shot; KeyError if there is none."""
    leg = filmed(path, shot)
    if not isinstance(leg, MovingLeg):
        raise KeyError(shot)
    return leg


def filmed(path: PathIR, shot: str) -> Leg:
    """Return the leg that films a shot, whatever it is a curve over; KeyError if there is none."""
    every: tuple[DronePath | TimedPath, ...] = (*path.drones, *path.timed)
    for drone in every:
        for leg in drone.legs:
            if leg.shot == shot:
                return leg
    raise KeyError(shot)
