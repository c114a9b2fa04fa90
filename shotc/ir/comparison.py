"""A mission under several refiners: what each of them shows, in numbers and as motion."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

from shotc.diag.model import Diagnostic
from shotc.geom.bernstein import Array
from shotc.ir.mission import MissionIR
from shotc.ir.smoothing import written
from shotc.ir.trajectory import VerifiedIR


class Score(NamedTuple):
    """What one shot, or all, of one refiner are worth.

    frames : how many samples of a target the shares are of
    error_... : to the wanted place on screen, half frames: the mean, what 95 % of the frames do not exceed,
        and the largest; infinite where it counts frames with the target behind the camera; None where
        nothing is wanted
    in_frame, in_frame_four_points : share of frames with the whole target in the frame, by its exact
        silhouette and by the four points of Gebhardt and Hilliges; None without frames
    visible : least share of a target's outline that nothing covers, in any frame; None without frames
    jerk_rms : over the time filmed, m/s^3; turn_jerk_rms : of the camera's yaw and pitch together, rad/s^3
    off_place : mean distance from where the shot would have the camera, metres; None where nothing says
    duration : time filmed, seconds
    """

    frames: int
    error_mean: float | None
    error_p95: float | None
    error_worst: float | None
    in_frame: float | None
    in_frame_four_points: float | None
    visible: float | None
    jerk_rms: float
    turn_jerk_rms: float
    off_place: float | None
    duration: float


@dataclass(frozen=True, slots=True, eq=False)
class Trace:
    """One target over one shot, every array of shape (M,).

    times : seconds of mission time; share : how much of the shot's time is over, 0 to 1
    error : half frames, infinite behind the camera, NaN where no place is wanted
    margin : how far inside the frame's nearest edge the whole target lies, metres
    points : whether its four points are in the frame; covered : share of its outline that something covers
    """

    target: str
    times: Array
    share: Array
    error: Array
    margin: Array
    points: Array
    covered: Array


class MotionMeasures(NamedTuple):
    """How a camera moves over the time filmed, as integrals over it.

    jerk : of its square, m^2/s^5; turn_jerk : of that of its yaw and pitch, rad^2/s^5
    off_place : of the distance from where the shot would have the camera, m s, over ``placed`` seconds
    """

    jerk: float
    turn_jerk: float
    off_place: float
    placed: float
    duration: float


@dataclass(frozen=True, slots=True, eq=False)
class FlownShot:
    """One shot as one refiner has it flown.

    start, end : seconds of mission time
    rounds : how often the refiner solved it, None where it does not say
    """

    id: str
    drone: str
    start: float
    end: float
    traces: tuple[Trace, ...]
    motion: MotionMeasures
    score: Score
    rounds: int | None = None


@dataclass(frozen=True, slots=True, eq=False)
class Condition:
    """A mission under one refiner, with one smoothing.

    smoothing : seconds, of all its shots, where it is not the mission's
    plan : None where the refiner gives none that may be flown, and then ``faults`` say why; it is held to
        every limit, but not to what shots promise
    broken : promises that it breaks; convex : warnings of shots that fly the convex path instead
    seconds : that the refiner took, by the clock
    """

    refiner: str
    package: str
    plan: VerifiedIR | None
    faults: tuple[Diagnostic, ...] = ()
    broken: tuple[Diagnostic, ...] = ()
    convex: tuple[Diagnostic, ...] = ()
    shots: tuple[FlownShot, ...] = ()
    score: Score | None = None
    seconds: float | None = None
    smoothing: float | None = None

    @property
    def name(self) -> str:
        """What it is called: its refiner, and the smoothing that it is tried with."""
        return (
            self.refiner if self.smoothing is None else f"{self.refiner}, smoothing {written(self.smoothing)}"
        )


class Difference(NamedTuple):
    """How a shot under one condition differs from the same one under another.

    mean : over the shot, of the metres between the cameras plus the degrees between where they look
    time, other_time : of the frames at which that sum is largest, seconds of mission time
    metres, degrees : there
    """

    shot: str
    condition: str
    other: str
    mean: float
    time: float
    other_time: float
    metres: float
    degrees: float


@dataclass(frozen=True, slots=True, eq=False)
class Comparison:
    """One mission under several refiners, in the order they were asked for.

    differences : of each condition from the last one with a plan, its shots with the greatest first
    """

    mission: MissionIR
    conditions: tuple[Condition, ...]
    differences: tuple[Difference, ...] = ()
