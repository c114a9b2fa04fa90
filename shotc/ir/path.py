"""PathIR: the geometry of every leg as a curve q(s), before it gets its time.

s is path length in metres, and never a time; turns on the spot count as length too. A shot on its own clock
is a ``ClockLeg``, the only leg that is already a curve over mission time. A shot of a camera that stands
still is a ``HoldLeg``, without a curve.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import ClassVar, TypeVar

import numpy as np

from shotc.geom.bernstein import Array, Piecewise
from shotc.ir.keyed import is_keyed
from shotc.ir.keyframes import KeyframeIR
from shotc.ir.mission import MissionIR
from shotc.ir.origin import KeyPath
from shotc.ir.pace import most_share
from shotc.ir.phases import KeyframeTime, PhaseName, Reference

Pose = tuple[float, ...]
"""The values of CHANNELS at one time."""

CHANNELS = ("x", "y", "z", "cam_yaw", "cam_pitch", "body_yaw", "hfov")
X, Y, Z, CAM_YAW, CAM_PITCH, BODY_YAW, HFOV = range(7)
LIMITS, CALM = "the drone's limits", "a calmer camera, and the drone's limits"
SIGHT = "what would hide the subject"
CORNERS, SHARP = "the turns at its points", "turns too sharp for its legs"
"""Causes that are neither an obstacle nor another drone's picture."""
NEEDS = ".needs"  # suffix of the statistic's name, after the shot's id
MORE_RATIO = 1.02  # factor on the needed duration, because the new path differs again


@dataclass(frozen=True, slots=True)
class Stop:
    """A rest of the drone at path parameter s, metres, for ``hold`` seconds."""

    s: float
    hold: float


@dataclass(frozen=True, slots=True)
class Mark:
    """A keyframe on the path.

    s : its path parameter, metres
    time : seconds from the shot's start, if the mission fixes it
    index : its index among the shot's keyframes
    """

    s: float
    time: float | None
    index: int
    path: KeyPath


@dataclass(frozen=True, slots=True, eq=False)
class FramingSpan:
    """A part of the path on which one target is framed.

    target : its name
    start, end : path parameters, metres
    reference : reference (u, v) of its centre, a curve over s from ``start`` to ``end``; None without a
        composition
    """

    target: str
    start: float
    end: float
    reference: Piecewise | None


class _OnCurve:
    """A leg that starts and ends at the ends of its curve."""

    __slots__ = ()
    curve: Piecewise

    @property
    def pose(self) -> Pose:
        """Channels at the start of the leg."""
        return tuple(map(float, self.curve.ctrl[0, 0]))

    @property
    def end_pose(self) -> Pose:
        """Channels at the end of the leg."""
        return tuple(map(float, self.curve.ctrl[-1, -1]))


@dataclass(frozen=True, slots=True, eq=False)
class MovingLeg(_OnCurve):
    """A part of the flight from rest to rest along a path.

    curve : q(s), channels CHANNELS, piecewise quintic, at least C2
    stops : rests in order of s; the first is at curve.start, the last at curve.end
    marks : keyframes (shots only)
    pace  : share of the limits if the duration is free; smoother : smoothing over the normal one
    duration : required duration of the whole leg with its holds, seconds, or None
    start : earliest mission time of its first frame, or None
    most : share of the limits at most in a duration that planning gives to a leg whose time is free
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
    most: float = 1.0

    def given(self, seconds: float) -> MovingLeg:
        """Return a leg whose time is free with a duration, seconds; it may use ``most_share`` there."""
        return replace(self, duration=seconds, most=most_share(self.pace))

    @property
    def keyframes_at(self) -> Array:
        """The path parameters of its keyframes, shape (K,), metres."""
        return np.array([mark.s for mark in self.marks])


@dataclass(frozen=True, slots=True, eq=False)
class HoldLeg:
    """A shot of a camera that stands still.

    pose : channels CHANNELS, constant
    hold : sum of the holds of its keyframes, seconds, if ``duration`` is None
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
        """Channels at the end of the leg."""
        return self.pose


@dataclass(frozen=True, slots=True, eq=False)
class ClockLeg(_OnCurve):
    """A shot on its own clock with its run-up and run-out.

    It begins and ends at rest, unless the drone flies on from one film to the next: then the first leg ends,
    and the second one begins, in the same motion.

    curve : channels CHANNELS over mission time, piecewise quintic, at least C2
    start, end : mission time of the first and the last filmed frame, seconds
    framing, keyframes : references of the framed targets, and times of keyframes
    """

    shot: str
    curve: Piecewise
    start: float
    end: float
    framing: tuple[Reference, ...]
    path: KeyPath
    keyframes: tuple[KeyframeTime, ...] = ()


PathLeg = MovingLeg | HoldLeg
"""A leg that is not on the clock."""
Leg = PathLeg | ClockLeg


@dataclass(frozen=True, slots=True, eq=False)
class DronePath:
    """All legs of one drone in the order of flight; each starts where the one before ended."""

    drone: str
    legs: tuple[PathLeg, ...]


@dataclass(frozen=True, slots=True, eq=False)
class TimedPath:
    """All legs of one drone whose legs are laid on the clock, joined as in DronePath."""

    drone: str
    legs: tuple[Leg, ...]


@dataclass(frozen=True, slots=True)
class PathDeviation:
    """The largest deviation of a shot on a path: ``distance`` metres at path parameter s, and its cause."""

    shot: str
    distance: float
    s: float
    cause: str


@dataclass(frozen=True, slots=True)
class ClockDeviation:
    """The largest deviation of a shot on its own clock: ``distance`` m at mission time t, and its cause."""

    shot: str
    distance: float
    t: float
    cause: str


Deviation = PathDeviation | ClockDeviation
_Deviation = TypeVar("_Deviation", PathDeviation, ClockDeviation, Deviation)


def from_required_positions(mission: MissionIR, deviations: Iterable[_Deviation]) -> tuple[_Deviation, ...]:
    """Return the deviations from positions that the mission requires.

    Between the keyframes of a shot on its own clock it requires none, so only obstacles count there.
    """
    return tuple(d for d in deviations if not (is_keyed(mission.shot(d.shot)) and d.cause in (LIMITS, CALM)))


@dataclass(frozen=True, slots=True, eq=False)
class PathIR:
    """The mission's geometry.

    drones : of a mission that is not planned on the clock; timed : of one that is
    stats : (name, value) pairs from the solvers, in a fixed order
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
    """Return the leg of a shot that moves along a path; raise KeyError if there is none."""
    leg = filmed(path, shot)
    if not isinstance(leg, MovingLeg):
        raise KeyError(shot)
    return leg


def filmed(path: PathIR, shot: str) -> Leg:
    """Return the leg of a shot, of any type; raise KeyError if there is none."""
    every: tuple[DronePath | TimedPath, ...] = (*path.drones, *path.timed)
    for drone in every:
        for leg in drone.legs:
            if leg.shot == shot:
                return leg
    raise KeyError(shot)


def with_need(path: PathIR, shot: str, seconds: float) -> PathIR:
    """Return the path with a note of the duration, seconds, that the refinement of a shot needs.

    A refined shot keeps the duration of its convex path if other shots are planned beside it. If it cannot,
    and the mission leaves its duration free, all paths are planned again with this one.
    """
    return replace(path, stats=(*path.stats, (f"{shot}{NEEDS}", seconds)))


def needed(path: PathIR) -> dict[str, float]:
    """Return by id the durations, seconds, with which the unrefined shots of a path could be refined."""
    mission, needs = path.keyframes.mission, {}
    for name, value in path.stats:
        shot = name.removesuffix(NEEDS)
        if name != shot and isinstance(value, float) and mission.shot(shot).timing.duration is None:
            needs[shot] = MORE_RATIO * value
    return needs
