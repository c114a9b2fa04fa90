"""The seat of replanners: what plans the next seconds of a flight anew while it is flown.

A package registers one in the entry-point group ``shotc.replanners``. It gets what holds for a whole shot
and returns a planner, whose ``replan`` gets what is known at one moment and the plan that the drone flies. It
is a pure function of the two: nothing else is kept between calls. One planner serves one thread at a time.

Lengths are metres, times seconds, angles radians. Vectors are in W: East, North, Up. N is the number of
stages of the horizon: stage k lies k steps after the moment of the replan, and stage 0 is that moment.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Literal, NamedTuple, Protocol

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.solids import Cylinder, Prism, Solid, convex_parts, edges, hull_and_pockets
from shotc.geom.viewpoint import NEAR_WEIGHT
from shotc.ir.limits import Limits, Vec2, Vec3
from shotc.planning.clearances import Clearance

__all__ = [
    "NEAR_WEIGHT",
    "NO_TRAFFIC",
    "USUAL",
    "USUAL_FRAMING",
    "Appearance",
    "Array",
    "ChasePlanner",
    "ChaseProblem",
    "ChaseSituation",
    "ChaseWeights",
    "Clearance",
    "Cone",
    "Cylinder",
    "DrawnPose",
    "FilmedSubject",
    "FramingPlanner",
    "FramingProblem",
    "FramingSituation",
    "FramingWeights",
    "Horizon",
    "Keeping",
    "Limits",
    "Plan",
    "Prism",
    "Replan",
    "Replanner",
    "Solid",
    "Status",
    "Traffic",
    "convex_parts",
    "edges",
    "hull_and_pockets",
]

Status = Literal["planned", "stalled", "opened", "failed"]
"""What a replan did.

planned : a better plan than the one before, continued from the measured state
stalled : nothing better was found; the plan is the one before, continued from the measured state
opened : as planned, but limits of the state are out of reach from here; they are approached
failed : there is no plan; the reason says why
"""


class Horizon(NamedTuple):
    """How far ahead is planned: stages, and the seconds of each."""

    stages: int
    step: float


@dataclass(frozen=True, slots=True, eq=False)
class Keeping:
    """What a drone keeps for a whole shot.

    limits : of the drone; jerk and yaw are left to whoever flies the plan
    pitch : (lowest, highest) angle of the line of sight to the target against the horizon, rad
    zones : what stands and is kept clear of, or stayed inside of, with distances from the drone's centre
    floor : least z of the drone's centre
    separation : least distance between the centres of two drones
    half_angle : half the opening of the cone about the camera's axis that holds no other drone, rad; None for
        no such cone
    margin : metres that are added to all these distances for what the vehicle strays from its plan
    reaction : seconds that the vehicle flies on before it brakes; from the end of every plan it can stop in
        front of every zone, after that time at the limit of acceleration
    """

    limits: Limits
    pitch: Vec2 = (-np.pi / 2, np.pi / 2)
    zones: tuple[Clearance, ...] = ()
    floor: float = -np.inf
    separation: float = 0.0
    half_angle: float | None = None
    margin: float = 0.15
    reaction: float = 0.3


class ChaseWeights(NamedTuple):
    """w1 to w4 of Alcantara et al., Eq. 12, and that of the height, which is theirs by the shot.

    effort : per (m/s^2)^2 of acceleration; pitch, yaw : per (rad/s)^2 of the camera's rates, all a stage
    height : per m^2 off the shot's height, a stage: stiffer ones answer to every centimetre of noise
    end : per m^2 and (m/s)^2 off what is wanted at the end
    """

    effort: float = 1.0
    pitch: float = 100.0
    yaw: float = 0.0
    height: float = 100.0
    end: float = 1.0


USUAL = ChaseWeights()


@dataclass(frozen=True, slots=True, eq=False)
class ChaseProblem:
    """A shot of one target: what holds for all its replans."""

    horizon: Horizon
    keeping: Keeping
    weights: ChaseWeights = USUAL


@dataclass(frozen=True, slots=True, eq=False)
class Cone:
    """What another camera sees, at each stage.

    apex : place of the camera, shape (N + 1, 3); axis : unit vectors along which it looks, (N + 1, 3)
    half_angle : half its opening, rad
    """

    apex: Array
    axis: Array
    half_angle: float


@dataclass(frozen=True, slots=True, eq=False)
class Traffic:
    """The plans that other drones have sent, at the stages of this replan.

    others : their places, shape (D, N + 1, 3); cones : what their cameras see and is kept out of
    """

    others: Array
    cones: tuple[Cone, ...] = ()


NO_TRAFFIC = Traffic(np.zeros((0, 1, 3)))


@dataclass(frozen=True, slots=True, eq=False)
class ChaseSituation:
    """What is known at the moment of a replan of a shot of one target.

    time : of this moment, mission time; place, velocity : of the drone, measured, shape (3,)
    target, target_velocity : of the target, predicted, shape (N + 1, 3)
    wanted, wanted_velocity : of the drone at the end of the horizon, shape (3,)
    height : z that the shot is to keep; None where it is free
    """

    time: float
    place: Array
    velocity: Array
    target: Array
    target_velocity: Array
    wanted: Array
    wanted_velocity: Array
    height: float | None
    traffic: Traffic = NO_TRAFFIC


class FramingWeights(NamedTuple):
    """The weights of Naegeli et al., Eq. 14, each a stage; of squares where nothing else is said.

    place : per half frame of a subject off its place (Eq. 7); size : of the logarithm of its size over that
    wanted (Eq. 8); view : of the distance between unit vectors, from the subject to the camera (Eq. 9)
    cover : by how much another body covers a subject's point, 1 where it does with its middle; not squared
        (Eq. 11)
    field : per metre in the field about a body (Eq. 12)
    effort : per m/s^2 of acceleration; turning : per rad/s of the camera
    """

    place: float = 10.0
    size: float = 2.0
    view: float = 4.0
    cover: float = 10.0
    field: float = 2.0
    effort: float = 0.02
    turning: float = 0.05


USUAL_FRAMING = FramingWeights()


@dataclass(frozen=True, slots=True, eq=False)
class FramingProblem:
    """A shot that composes subjects: what holds for all its replans.

    half : tan of half the horizontal and half the vertical field of view
    rates : greatest yaw and pitch rate of the camera, rad/s
    """

    horizon: Horizon
    keeping: Keeping
    half: Vec2
    rates: Vec2
    weights: FramingWeights = USUAL_FRAMING


@dataclass(frozen=True, slots=True, eq=False)
class Appearance:
    """How a subject is to appear; None is free.

    uv : place on screen of its point, half frames; size : of its diameter, over the frame's height
    view : unit vectors from the subject to the camera, at the stages, shape (N + 1, 3)
    """

    uv: Vec2 | None = None
    size: float | None = None
    view: Array | None = None


@dataclass(frozen=True, slots=True, eq=False)
class FilmedSubject:
    """A subject, or another body that is kept clear of and may cover one.

    point : what of it is framed, at the stages, predicted, shape (N + 1, 3); diameter : of what is sized
    centre : of its ellipsoid, (N + 1, 3); semi_axes : of that along x, y and z, the drone's radius included
    wanted : None for a body that is not filmed
    """

    point: Array
    centre: Array
    semi_axes: Vec3
    diameter: float
    wanted: Appearance | None = None


@dataclass(frozen=True, slots=True, eq=False)
class DrawnPose:
    """A pose that the camera stays near as far as the picture lets it (Naegeli et al., Eq. 10).

    places : at the stages, (N + 1, 3); yaw, pitch : of the camera, rad, each None where it is free
    """

    places: Array
    yaw: float | None = None
    pitch: float | None = None


@dataclass(frozen=True, slots=True, eq=False)
class FramingSituation:
    """What is known at the moment of a replan of a shot that composes subjects.

    time : of this moment, mission time; place, velocity : of the drone, measured, shape (3,)
    aim : yaw and pitch of the camera, W, rad; subjects : the same ones in the same order at every replan
    near : what the camera stays near besides
    """

    time: float
    place: Array
    velocity: Array
    aim: Vec2
    subjects: tuple[FilmedSubject, ...]
    traffic: Traffic = NO_TRAFFIC
    near: DrawnPose | None = None


@dataclass(frozen=True, slots=True, eq=False)
class Plan:
    """The motion that is planned.

    times : of the stages, mission time, shape (N + 1,); places, velocities : there, shape (N + 1, 3)
    accelerations : of the steps between them, each held over its step, shape (N, 3)
    aim : yaw and pitch of the camera at the stages, W, rad, shape (N + 1, 2); yaw is continuous. None where
        the camera is to look at the target.
    """

    times: Array
    places: Array
    velocities: Array
    accelerations: Array
    aim: Array | None = None


@dataclass(frozen=True, slots=True, eq=False)
class Replan:
    """What a replan returns.

    plan : None where it failed; reason : why it failed, empty otherwise
    lack : metres or m/s by which the plan breaks what it is to keep, at worst; 0 where it keeps all
    steps : of the solver, each with one programme solved
    """

    plan: Plan | None
    status: Status
    reason: str = ""
    lack: float = 0.0
    steps: int = 0


class ChasePlanner(Protocol):
    """Plans a shot of one target."""

    def replan(self, situation: ChaseSituation, last: Plan | None) -> Replan:
        """Plan from the measured state on.

        last : the plan that the drone flies; None where there is none yet
        Numbers that are not finite, or lead to such, are a failure that is told at once, never an exception.
        """
        ...


class FramingPlanner(Protocol):
    """Plans a shot that composes subjects."""

    def replan(self, situation: FramingSituation, last: Plan | None) -> Replan:
        """Plan from the measured state on; all as for ``ChasePlanner``, and the plan has an aim."""
        ...


class Replanner(Protocol):
    """What sits in the replanner seat (entry-point group ``shotc.replanners``)."""

    name: ClassVar[str]
    summary: ClassVar[str]
    api: ClassVar[int]

    def chase(self, problem: ChaseProblem) -> ChasePlanner:
        """Return the planner of a shot of one target."""
        ...

    def framing(self, problem: FramingProblem) -> FramingPlanner:
        """Return the planner of a shot that composes subjects."""
        ...
