"""Shots with replanning, and the input of a replanner."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from math import cos, pi, sin
from typing import ClassVar, NamedTuple

import numpy as np

from shotc.geom import viewpoint
from shotc.geom.bernstein import Array
from shotc.ir.bodies import centres
from shotc.ir.drone import Drone
from shotc.ir.keyed import near_at
from shotc.ir.mission import MissionIR, Near, Subject
from shotc.ir.path import CAM_PITCH, CAM_YAW
from shotc.ir.phases import Phase
from shotc.ir.setpoints import Asked
from shotc.ir.target import Target
from shotc.ir.trajectory import DroneTrajectory
from shotc.plugin_api.replanner import (
    NO_WALLS,
    USUAL_FRAMING,
    Appearance,
    ChasePlanner,
    ChaseProblem,
    ChaseSituation,
    ChaseWeights,
    DrawnPose,
    FilmedSubject,
    FramingPlanner,
    FramingProblem,
    FramingSituation,
    Horizon,
    Keeping,
    Plan,
    Replanner,
    Traffic,
    Walls,
)
from shotc.simulation.film import PlanSamples
from shotc.simulation.seen import Foreseen

STAGE_S = 0.1
CHASE_STAGES, FRAMING_STAGES = 30, 25
"""Planning horizon in stages of STAGE_S seconds."""

WEIGHTS = ChaseWeights(end=20.0)
"""With the paper's weight 1, a drone lags by a metre and more behind a target that leaves its track. With 20
the lag is half of that, and the acceleration grows by a twentieth (measured: a chase and a lateral at 1.2
m/s, horizon 4 s).
"""

NOWHERE_M = 1e4
"""Distance of the point below a drone that its camera looks at during a return, metres."""

LEVEL_M = 0.1
"""Change of a shot's height over a horizon, metres, below which the height is constant."""

Known = Mapping[str, Foreseen]
"""Estimates and predictions of the moving targets at the stages of a replan, by name, in R runs."""


@dataclass(frozen=True, slots=True)
class Chased:
    """A shot beside one target.

    turns : whether its position turns with the target's course
    smoother : smoothing time of the shot over the normal one; its square is the weight of rates
    """

    stages: ClassVar = CHASE_STAGES
    phase: Phase
    target: str
    turns: bool
    smoother: float = 1.0

    def planner(self, by: Replanner, _film: PlanSamples, keeping: Keeping) -> ChasePlanner:
        """Return its planner."""
        calm = self.smoother**2
        weights = WEIGHTS._replace(pitch=calm * WEIGHTS.pitch, yaw=calm * WEIGHTS.yaw)
        return by.chase(ChaseProblem(Horizon(CHASE_STAGES, STAGE_S), keeping, weights))

    def situation(
        self,
        mission: MissionIR,
        film: PlanSamples,
        stages: Array,
        drone: tuple[Array, Array],
        of: ReplanInstant,
    ) -> ChaseSituation:
        """Return the input of a replan in one run at the first of the stages, mission times (N + 1,).

        drone : its estimated position and velocity, (3,) each
        """
        target, moves = predicted(mission.target(self.target), stages, of)
        goal = min(float(stages[-1]), self.phase.end)
        there = np.asarray(film.track.curve(goal))[:3]
        beside = there - np.array(mission.target(self.target).at(goal))
        level = film.track.curve(stages[stages <= goal])[:, 2]
        c, s = cos(of.turn), sin(of.turn)
        goal_place = target[-1] + np.array(
            [c * beside[0] - s * beside[1], s * beside[0] + c * beside[1], beside[2]]
        )
        # The floor is only a penalty in the replan, so a target estimated to be in the ground must not lead
        # the drone there.
        goal_place[2] = max(
            there[2] + of.rise, mission.lowest((goal_place[0], goal_place[1], 0.0), film.drone.radius)
        )
        return ChaseSituation(
            time=float(stages[0]),
            place=drone[0],
            velocity=drone[1],
            target=target,
            target_velocity=moves,
            wanted=goal_place,
            wanted_velocity=moves[-1],
            height=float(goal_place[2]) if np.ptp(level) <= LEVEL_M else None,
            traffic=of.traffic,
            walls=of.walls,
        )


@dataclass(frozen=True, slots=True)
class ComposedShot:
    """A shot that follows from the appearance of its subjects.

    smoother : as in ``Chased``
    near : pose that its camera stays near
    """

    stages: ClassVar = FRAMING_STAGES
    phase: Phase
    subjects: tuple[Subject, ...]
    smoother: float = 1.0
    near: Near | None = None

    def planner(self, by: Replanner, film: PlanSamples, keeping: Keeping) -> FramingPlanner:
        """Return its planner."""
        k = int(np.searchsorted(film.times, self.phase.start))
        half = (float(film.half[k, 0]), float(film.half[k, 1]))
        rates = (film.drone.gimbal.rate, film.drone.gimbal.rate)
        weights = USUAL_FRAMING._replace(turning=self.smoother**2 * USUAL_FRAMING.turning)
        return by.framing(FramingProblem(Horizon(FRAMING_STAGES, STAGE_S), keeping, half, rates, weights))

    def situation(
        self,
        mission: MissionIR,
        film: PlanSamples,
        stages: Array,
        drone: tuple[Array, Array],
        of: ReplanInstant,
    ) -> FramingSituation:
        """Return the input of a replan in one run; arguments as in ``Chased``."""
        filmed = {each.target: self._appearances(each, stages) for each in self.subjects}
        references = {each.target: each.reference[film.step(float(stages[0]))] for each in film.framed}
        bodies = [t for t in mission.targets if t.name in filmed or t.name in of.known]
        now = _FramedInstant(stages, of, references)
        return FramingSituation(
            time=float(stages[0]),
            place=drone[0],
            velocity=drone[1],
            aim=_aim(film, float(stages[0]), of.last),
            subjects=tuple(
                _filmed(mission, film.drone, target, filmed.get(target.name), now) for target in bodies
            ),
            traffic=of.traffic,
            walls=of.walls,
            near=None if self.near is None else _drawn(mission, self.near, stages, of),
        )

    def _appearances(self, subject: Subject, stages: Array) -> tuple[Asked, ...]:
        """Return the references of a subject's appearance at the stages."""
        return tuple(subject.asked(t - self.phase.start) for t in stages.tolist())


Anew = Chased | ComposedShot


@dataclass(frozen=True, slots=True)
class Rejoined:
    """The return to the plan where an obstacle is on the direct path.

    phase : from the end of a shot to the latest time at which the plan must be flown again
    """

    stages: ClassVar = CHASE_STAGES
    phase: Phase

    def planner(self, by: Replanner, _film: PlanSamples, keeping: Keeping) -> ChasePlanner:
        """Return its planner: that of a chase without camera costs."""
        free = replace(keeping, pitch=(-pi / 2, pi / 2), half_angle=None)
        weights = WEIGHTS._replace(pitch=0.0, yaw=0.0, height=0.0)
        return by.chase(ChaseProblem(Horizon(CHASE_STAGES, STAGE_S), free, weights))

    def situation(
        self,
        _mission: MissionIR,
        film: PlanSamples,
        stages: Array,
        drone: tuple[Array, Array],
        of: ReplanInstant,
    ) -> ChaseSituation:
        """Return the input of a replan in one run; arguments as in ``Chased``."""
        k = film.step(min(float(stages[-1]), self.phase.end))
        below = np.tile(drone[0] - [0.0, 0.0, NOWHERE_M], (len(stages), 1))
        return ChaseSituation(
            time=float(stages[0]),
            place=drone[0],
            velocity=drone[1],
            target=below,
            target_velocity=np.zeros_like(below),
            wanted=film.position[k],
            wanted_velocity=film.velocity[k],
            height=None,
            traffic=of.traffic,
            walls=of.walls,
        )


@dataclass(frozen=True, slots=True, eq=False)
class ReplanInstant:
    """The knowledge in one run at the time of a replan.

    known : estimates of the targets, in R runs
    last : the plan that the drone flies
    run : index of the run
    turn : difference of the course of a ``Chased`` target from the planned one, rad
    rise : difference of its height from the planned one, metres
    traffic : sent plans of other drones
    walls : half-spaces that keep it clear of terrain and meshes
    """

    known: Known
    last: Plan
    run: int
    turn: float
    rise: float
    traffic: Traffic
    walls: Walls = NO_WALLS


def replanned(mission: MissionIR, track: DroneTrajectory) -> tuple[Anew, ...]:
    """Return the shots with replanning: those of moving targets."""
    return tuple(_anew(mission, track))


def _anew(mission: MissionIR, track: DroneTrajectory) -> Iterator[Anew]:
    framed = {span.target for span in track.framing if span.reference is not None}
    for phase in track.phases:
        shot = None if phase.shot is None else mission.shot(phase.shot)
        if shot is None or shot.ideal is None:
            continue
        own = set() if shot.subject is None else {shot.subject}
        films = {each.target for each in shot.subjects} or own
        if not films <= framed or any(mission.target(name).parts for name in films):
            continue
        if shot.ideal.framed:
            if any(mission.target(name).track is not None for name in films):
                yield ComposedShot(phase, shot.subjects, shot.smoother, shot.ideal.near)
            continue
        target = shot.ideal.target
        if target is not None and films == {target} and mission.target(target).track is not None:
            yield Chased(phase, target, shot.ideal.frame == "heading", shot.smoother)


def predicted(target: Target, stages: Array, of: ReplanInstant) -> tuple[Array, Array]:
    """Return a target's predicted positions at the stages and its velocity over ground, (N + 1, 3) each.

    Its height follows the plan, because a vertical velocity with an error of 0.3 m/s is not usable.
    """
    course = centres(target, stages)
    if target.name not in of.known:
        return course, np.zeros_like(course)
    known = of.known[target.name]
    out, moves = known.places[:, of.run].copy(), known.velocities[:, of.run] * [1.0, 1.0, 0.0]
    out[:, 2] = known.now.position[of.run, 2] + course[:, 2] - course[0, 2]
    return out, moves


def _drawn(mission: MissionIR, near: Near, stages: Array, of: ReplanInstant) -> DrawnPose:
    """Return the pose that a camera stays near, relative to the target's estimate if it is beside
    a target.
    """
    places = np.array([near_at(mission, near, t) for t in stages.tolist()])
    if near.beside is not None:
        target = mission.target(near.beside.target)
        places += predicted(target, stages, of)[0] - centres(target, stages)
    return DrawnPose(places, near.yaw, near.pitch)


def _aim(film: PlanSamples, time: float, last: Plan) -> tuple[float, float]:
    """Return yaw and pitch of the camera in the last plan, rad."""
    if last.aim is None:
        pose = np.asarray(film.track.curve(time))
        return float(pose[CAM_YAW]), float(pose[CAM_PITCH])
    yaw, pitch = (float(np.interp(time, last.times, last.aim[:, i])) for i in range(2))
    return yaw, pitch


class _FramedInstant(NamedTuple):
    """The times of the stages (N + 1,), what is known now, and the wanted place on screen of each target."""

    stages: Array
    of: ReplanInstant
    references: Mapping[str, Array]


def _filmed(
    mission: MissionIR,
    drone: Drone,
    target: Target,
    appearances: tuple[Asked, ...] | None,
    now: _FramedInstant,
) -> FilmedSubject:
    points, _ = predicted(target, now.stages, now.of)
    beside = mission.rules.beside_target(drone.radius)
    return FilmedSubject(
        point=points,
        centre=points,
        semi_axes=(target.radius + beside, target.radius + beside, target.height / 2 + beside),
        diameter=target.height,
        wanted=None if appearances is None else _appearance(appearances, now.references.get(target.name)),
    )


def _appearance(appearances: tuple[Asked, ...], uv: Array | None) -> Appearance:
    """Return the reference of a subject's appearance: place and size now, the view at every stage.

    A view with a free angle is not constrained.
    """
    place = None if uv is None or np.isnan(uv).any() else (float(uv[0]), float(uv[1]))
    directions = [viewpoint.direction(*view) for view in map(_both, appearances) if view is not None]
    return Appearance(place, appearances[0].size, np.array(directions) if directions else None)


def _both(appearance: Asked) -> tuple[float, float] | None:
    azimuth, elevation = appearance.view or (None, None)
    return None if azimuth is None or elevation is None else (azimuth, elevation)
