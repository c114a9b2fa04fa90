"""The interface for replanners, which plan the next seconds of a flight during the flight.

A package registers a replanner in the entry-point group ``shotc.replanners``. It gets the constant part of a
shot and returns a planner. The planner's ``replan`` gets the situation at one time and the current plan. It
is a pure function of the two: no other state is kept between calls. One planner serves one thread at a time.

Lengths are in metres, times in seconds, angles in radians. Vectors are in W: East, North, Up. N is the number
of stages of the horizon: stage k is k steps after the time of the replan, and stage 0 is that time.
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
    "NO_WALLS",
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
    "Walls",
    "convex_parts",
    "edges",
    "hull_and_pockets",
]

Status = Literal["planned", "stalled", "opened", "failed"]
"""The result of a replan.

planned : a better plan than the one before, continued from the measured state
stalled : no better plan was found; the plan is the one before, continued from the measured state
opened : as planned, but limits of the state cannot be kept from here; the plan approaches them
failed : there is no plan; the reason says why
"""


class Horizon(NamedTuple):
    """The horizon of a plan: number of stages, and duration of a step in seconds."""

    stages: int
    step: float


@dataclass(frozen=True, slots=True, eq=False)
class Keeping:
    """The limits and clearances of a drone in a whole shot.

    limits : of the drone; the vehicle's controller is responsible for jerk and yaw
    pitch : (lowest, highest) angle of the line of sight to the target from the horizon, rad
    zones : standing solids that the drone stays outside or inside of, with distances from its centre
    floor, ceiling : least and greatest z of the drone's centre
    separation : least distance between the centres of two drones
    half_angle : half-angle of the cone about the camera's axis without other drones, rad; None for no cone
    margin : added to all these distances for the vehicle's tracking error, metres
    reaction : time before the vehicle brakes, seconds. From the end of every plan it can stop in front of
        every zone, after that time at the limit of acceleration.
    """

    limits: Limits
    pitch: Vec2 = (-np.pi / 2, np.pi / 2)
    zones: tuple[Clearance, ...] = ()
    floor: float = -np.inf
    ceiling: float = np.inf
    separation: float = 0.0
    half_angle: float | None = None
    margin: float = 0.15
    reaction: float = 0.3


class ChaseWeights(NamedTuple):
    """The weights w1 to w4 of Alcantara et al., Eq. 12, and one for the height.

    effort : per (m/s^2)^2 of acceleration; pitch, yaw : per (rad/s)^2 of the camera's rates, all at each
        stage
    height : per m^2 of deviation from the shot's height at each stage; a higher weight amplifies noise
    end : per m^2 and (m/s)^2 of deviation from the reference at the end
    """

    effort: float = 1.0
    pitch: float = 100.0
    yaw: float = 0.0
    height: float = 100.0
    end: float = 1.0


USUAL = ChaseWeights()


@dataclass(frozen=True, slots=True, eq=False)
class ChaseProblem:
    """The constant part of a shot of one target."""

    horizon: Horizon
    keeping: Keeping
    weights: ChaseWeights = USUAL


@dataclass(frozen=True, slots=True, eq=False)
class Cone:
    """The cone that another camera sees, at each stage.

    apex : positions of the camera, shape (N + 1, 3); axis : unit vectors of its view, (N + 1, 3)
    half_angle : of the cone, rad
    """

    apex: Array
    axis: Array
    half_angle: float


@dataclass(frozen=True, slots=True, eq=False)
class Traffic:
    """The plans of other drones, at the stages of this replan.

    others : their positions, shape (D, N + 1, 3); cones : of their cameras, to be avoided
    """

    others: Array
    cones: tuple[Cone, ...] = ()


NO_TRAFFIC = Traffic(np.zeros((0, 1, 3)))


@dataclass(frozen=True, slots=True, eq=False)
class Walls:
    """Half-spaces n . p >= d that keep the drone's centre clear of terrain, scenes and buildings.

    They are put between these and the plan that is flown, so they hold for one replan. Every stage has as
    many; those that nothing is behind hold everywhere. Row k is of stage k + 1, the last one of where
    the drone stands after it has braked from the end of the horizon.
    normals : units, shape (N + 1, M, 3); offsets : d, clearances included, (N + 1, M), metres
    """

    normals: Array
    offsets: Array

    @property
    def count(self) -> int:
        """Return M."""
        return int(self.offsets.shape[1])


NO_WALLS = Walls(np.zeros((1, 0, 3)), np.zeros((1, 0)))


@dataclass(frozen=True, slots=True, eq=False)
class ChaseSituation:
    """The situation at the time of a replan of a shot of one target.

    time : mission time of the replan; place, velocity : of the drone, measured, shape (3,)
    target, target_velocity : of the target, predicted, shape (N + 1, 3)
    wanted, wanted_velocity : references of the drone at the end of the horizon, shape (3,)
    height : reference z of the shot; None if it is free
    walls : half-spaces that hold besides the zones of the problem
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
    walls: Walls = NO_WALLS


class FramingWeights(NamedTuple):
    """The weights of Naegeli et al., Eq. 14, at each stage; of squares if not stated otherwise.

    place : per half frame of a subject's distance from its reference (Eq. 7)
    size : of the logarithm of its size over the reference (Eq. 8)
    view : of the distance between unit vectors from the subject to the camera (Eq. 9)
    cover : of the occlusion of a subject's point by another body, 1 for its middle; not squared (Eq. 11)
    field : per metre in the field around a body (Eq. 12)
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
    """The constant part of a framing shot.

    half : tan of half the horizontal and half the vertical field of view
    rates : largest yaw and pitch rate of the camera, rad/s
    """

    horizon: Horizon
    keeping: Keeping
    half: Vec2
    rates: Vec2
    weights: FramingWeights = USUAL_FRAMING


@dataclass(frozen=True, slots=True, eq=False)
class Appearance:
    """The required appearance of a subject; None is free.

    uv : place of its point on screen, half frames; size : of its diameter, over the frame's height
    view : unit vectors from the subject to the camera, at the stages, shape (N + 1, 3)
    """

    uv: Vec2 | None = None
    size: float | None = None
    view: Array | None = None


@dataclass(frozen=True, slots=True, eq=False)
class FilmedSubject:
    """A subject, or another body that is an obstacle and a possible occluder.

    point : its framed point, predicted at the stages, shape (N + 1, 3); diameter : for its size on screen
    centre : of its ellipsoid, (N + 1, 3); semi_axes : of the ellipsoid along x, y and z, with the drone's
        radius
    wanted : None for a body that is not filmed
    """

    point: Array
    centre: Array
    semi_axes: Vec3
    diameter: float
    wanted: Appearance | None = None


@dataclass(frozen=True, slots=True, eq=False)
class DrawnPose:
    """The preferred pose of the camera, kept as far as the picture allows (Naegeli et al., Eq. 10).

    places : at the stages, (N + 1, 3); yaw, pitch : of the camera, rad, each None if it is free
    """

    places: Array
    yaw: float | None = None
    pitch: float | None = None


@dataclass(frozen=True, slots=True, eq=False)
class FramingSituation:
    """The situation at the time of a replan of a framing shot.

    time : mission time of the replan; place, velocity : of the drone, measured, shape (3,)
    aim : yaw and pitch of the camera, W, rad; subjects : the same ones in the same order at every replan
    near : the preferred pose, or None; walls : as in ``ChaseSituation``
    """

    time: float
    place: Array
    velocity: Array
    aim: Vec2
    subjects: tuple[FilmedSubject, ...]
    traffic: Traffic = NO_TRAFFIC
    near: DrawnPose | None = None
    walls: Walls = NO_WALLS


@dataclass(frozen=True, slots=True, eq=False)
class Plan:
    """The planned motion.

    times : mission times of the stages, shape (N + 1,); places, velocities : there, shape (N + 1, 3)
    accelerations : of the steps between them, constant in each step, shape (N, 3)
    aim : yaw and pitch of the camera at the stages, W, rad, shape (N + 1, 2), with unwrapped yaw; None if the
        camera looks at the target
    """

    times: Array
    places: Array
    velocities: Array
    accelerations: Array
    aim: Array | None = None


@dataclass(frozen=True, slots=True, eq=False)
class Replan:
    """The result of a replan.

    plan : None if it failed; reason : of the failure, else empty
    lack : largest violation of limits and clearances by the plan, metres or m/s; 0 if it keeps all
    steps : number of solver steps, each with one programme
    """

    plan: Plan | None
    status: Status
    reason: str = ""
    lack: float = 0.0
    steps: int = 0


class ChasePlanner(Protocol):
    """A planner for a shot of one target."""

    def replan(self, situation: ChaseSituation, last: Plan | None) -> Replan:
        """Plan from the measured state.

        last : the current plan of the drone; None at the first replan
        Numbers that are not finite, in the input or in the computation, give the status "failed", never an
        exception.
        """
        ...


class FramingPlanner(Protocol):
    """A planner for a framing shot."""

    def replan(self, situation: FramingSituation, last: Plan | None) -> Replan:
        """Plan from the measured state, as ``ChasePlanner``; the plan has an aim."""
        ...


class Replanner(Protocol):
    """The interface of replanners (entry-point group ``shotc.replanners``)."""

    name: ClassVar[str]
    summary: ClassVar[str]
    api: ClassVar[int]

    def chase(self, problem: ChaseProblem) -> ChasePlanner:
        """Return the planner for a shot of one target."""
        ...

    def framing(self, problem: FramingProblem) -> FramingPlanner:
        """Return the planner for a framing shot."""
        ...
