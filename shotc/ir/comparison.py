"""Records of one mission under several refiners: the motion of each, and its measures."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

from shotc.diag.model import Diagnostic
from shotc.geom.bernstein import Array
from shotc.ir.mission import MissionIR
from shotc.ir.smoothing import written
from shotc.ir.trajectory import VerifiedIR


class Score(NamedTuple):
    """The measures of one shot, or of all shots, under one refiner.

    frames : number of samples of a target; the shares refer to it
    error_... : distance on screen from the reference, half frames: mean, 95th percentile and maximum;
        infinite if it includes frames with the target behind the camera; None without a reference
    in_frame, in_frame_four_points : share of frames with the whole target in the frame, by its exact
        silhouette and by the four points of Gebhardt and Hilliges; None without frames
    visible : least free share of a target's outline in any frame; None without frames
    jerk_rms : over the filmed time, m/s^3; turn_jerk_rms : of the camera's yaw and pitch together, rad/s^3
    off_place : mean distance of the camera from its ideal, metres; None without an ideal
    duration : filmed time, seconds
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

    times : mission time, seconds; share : elapsed share of the shot's time, 0 to 1
    error : distance on screen from the reference, half frames; infinite behind the camera, NaN without one
    margin : distance of the whole target from the frame's nearest edge, metres, positive inside
    points : whether its four points are in the frame; covered : covered share of its outline
    """

    target: str
    times: Array
    share: Array
    error: Array
    margin: Array
    points: Array
    covered: Array


class MotionMeasures(NamedTuple):
    """Measures of a camera's motion as integrals over the filmed time.

    jerk : of the squared jerk, m^2/s^5; turn_jerk : of that of its yaw and pitch, rad^2/s^5
    off_place : of the distance from the ideal, m s, over ``placed`` seconds
    duration : filmed time, seconds
    """

    jerk: float
    turn_jerk: float
    off_place: float
    placed: float
    duration: float


@dataclass(frozen=True, slots=True, eq=False)
class ComparedShot:
    """One shot as planned by one refiner.

    start, end : seconds of mission time
    rounds : number of solves by the refiner, None if it does not report it
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

    smoothing : seconds, for all shots, if it replaces the mission's
    plan : None if the refiner gives no plan that may be flown; then ``faults`` say why. The plan keeps every
        limit, but need not keep the promises of shots
    broken : the promises that it breaks; convex : warnings about shots that fly the convex path instead
    seconds : wall time of the refiner
    """

    refiner: str
    package: str
    plan: VerifiedIR | None
    faults: tuple[Diagnostic, ...] = ()
    broken: tuple[Diagnostic, ...] = ()
    convex: tuple[Diagnostic, ...] = ()
    shots: tuple[ComparedShot, ...] = ()
    score: Score | None = None
    seconds: float | None = None
    smoothing: float | None = None

    @property
    def name(self) -> str:
        """The name of the refiner, with the smoothing if there is one."""
        return (
            self.refiner if self.smoothing is None else f"{self.refiner}, smoothing {written(self.smoothing)}"
        )


class ShotDifference(NamedTuple):
    """The difference of a shot between two conditions.

    mean : mean over the shot of the distance between the cameras in metres plus the angle between their axes
        in degrees
    time, other_time : mission times of the frames at which that sum is largest, seconds
    metres, degrees : the two terms there
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
    """One mission under several refiners, in the order of the request.

    differences : of each condition from the last condition with a plan, the greatest first
    """

    mission: MissionIR
    conditions: tuple[Condition, ...]
    differences: tuple[ShotDifference, ...] = ()
