"""What a drone is asked to do at each step: what was planned, or what is planned anew while it flies."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from shotc import plugins
from shotc.geom.bernstein import Array
from shotc.geom.vec import wrapped
from shotc.ir.mission import MissionIR, Shot
from shotc.ir.phases import Phase
from shotc.planning.clearances import clearances_of, from_parked
from shotc.plugin_api.replanner import (
    ChasePlanner,
    ChaseProblem,
    ChaseSituation,
    ChaseWeights,
    Horizon,
    Keeping,
    Plan,
    Traffic,
)
from shotc.simulation.film import Film
from shotc.simulation.seen import Watched
from shotc.simulation.sent import Fading, Held, Sent
from shotc.simulation.tracker import Estimate
from shotc.simulation.vehicle import STEP_S, Setpoint
from shotc.simulation.world import World

HORIZON_S = 3.0
STAGE_S = 0.1
PERIOD_S = 0.5
"""Seconds that are planned, those of a stage of the plan, and those between two plans."""

STAGES = round(HORIZON_S / STAGE_S)

WEIGHTS = ChaseWeights(end=20.0)
"""With the paper's 1 a drone stays a metre and more behind a target that leaves its track; with 20 half,
and its acceleration grows by a twentieth (measured: a chase and a lateral at 1.2 m/s, horizon 4 s)."""

STILL_M_S = 0.3
"""Speed below which the course of a target is not known."""

LEVEL_M = 0.1
"""Metres by which the height of a shot may change over a horizon and count as one height."""

BACK_S = 4.0
"""Least time in which a drone comes back to its plan after a shot, seconds."""


@dataclass(slots=True)
class Replans:
    """How often a drone's plan was made anew in a run, and what came of it (``plugin_api.replanner``)."""

    planned: int = 0
    stalled: int = 0
    opened: int = 0
    failed: int = 0
    lack: float = 0.0
    reason: str = ""


@dataclass(frozen=True, slots=True)
class Anew:
    """A shot that is planned anew: its phase, its target, and whether its place turns with the target."""

    phase: Phase
    target: str
    turns: bool


def replanned(mission: MissionIR, film: Film) -> tuple[Anew, ...]:
    """Return the shots that are planned anew: of one target that moves, from a place beside it."""
    return tuple(_anew(mission, film))


def _anew(mission: MissionIR, film: Film) -> Iterator[Anew]:
    framed = {each.target for each in film.framed}
    for phase in film.track.phases:
        shot = None if phase.shot is None else mission.shot(phase.shot)
        target = None if shot is None else _beside(shot)
        if (
            shot is not None
            and target is not None
            and target in framed
            and mission.target(target).track is not None
        ):
            assert shot.ideal is not None
            yield Anew(phase, target, shot.ideal.frame == "heading")


def _beside(shot: Shot) -> str | None:
    """Return the target beside which a shot's camera flies, if that is the one that it films."""
    if shot.ideal is None or shot.ideal.target is None or len(shot.subjects) > 1:
        return None
    films = shot.subjects[0].target if shot.subjects else shot.subject
    return shot.ideal.target if films == shot.ideal.target else None


@dataclass(slots=True)
class Guide:
    """One drone of R runs.

    shots : those that are planned anew; () flies the plan; targets : what is known of those that move
    sent : what the drones of higher priority have sent; own : what this one sends
    away : how far the setpoints are from the plan after a shot, and how that fades
    """

    world: World
    film: Film
    shots: tuple[Anew, ...]
    targets: tuple[Watched, ...]
    sent: tuple[Sent, ...] = ()
    own: Sent | None = None
    counts: list[Replans] = field(default_factory=list)
    _planner: ChasePlanner | None = None
    _held: Held | None = None
    _back: Fading | None = None
    _active: Anew | None = None
    _course: Array | None = None

    def setpoint(self, k: int, drone: tuple[Array, Array]) -> Setpoint:
        """Return what the drone is asked for at a step.

        drone : where it takes itself to be, and how it moves, (R, 3) each
        """
        time = float(self.film.times[k])
        shot = next((s for s in self.shots if s.phase.start <= time < s.phase.end), None)
        if shot is not None:
            if shot is not self._active:
                self._begin(shot)
            if round((time - self.film.times[self._first(shot)]) / STEP_S) % round(PERIOD_S / STEP_S) == 0:
                known = next(t for t in self.targets if t.name == shot.target)
                self._replan(shot, time, drone, known.tracker.now(time))
        elif self._active is not None:
            self._leave(time)
        if self._active is not None and self._held is not None:
            return self._held.setpoint(time)
        return self.film.setpoint(k) if self._back is None else self._back.setpoint(time)

    def _first(self, shot: Anew) -> int:
        return int(np.searchsorted(self.film.times, shot.phase.start))

    def _begin(self, shot: Anew) -> None:
        mission, drone = self.world.mission, self.film.drone
        keeping = Keeping(
            limits=drone.limits,
            pitch=drone.gimbal.pitch,
            zones=(*clearances_of(mission, drone), *from_parked(mission, drone)),
            floor=mission.rules.over_ground(drone.radius),
            separation=mission.rules.separation,
        )
        problem = ChaseProblem(Horizon(STAGES, STAGE_S), keeping, WEIGHTS)
        self._planner = plugins.one("replanners", self.world.conditions.replanner).plugin.chase(problem)
        n = len(self.world.runs)
        self._active, self._held = shot, Held((self._planned(shot),) * n, drone.limits.acceleration)
        self.counts = self.counts or [Replans() for _ in self.world.runs]

    def _leave(self, time: float) -> None:
        """Let the drone come back to its plan."""
        assert self._held is not None
        self._active = None
        film, speed = self.film, self.film.drone.limits.speed
        now = self._held.setpoint(time)
        k = round(time / STEP_S)
        off = now.position - film.position[k], now.velocity - film.velocity[k]
        lasts = max(BACK_S, 4.0 * float(np.abs(off[0]).max()) / speed)
        self._back = Fading(film, time, lasts, *off)

    def _planned(self, shot: Anew) -> Plan:
        """Return the next seconds of the plan, from which the first replan goes on."""
        stages = self.film.times[self._first(shot)] + STAGE_S * np.arange(STAGES + 1, dtype=np.float64)
        curve = self.film.track.curve
        velocities = curve.derivative()(stages)[:, :3]
        return Plan(stages, curve(stages)[:, :3], velocities, np.diff(velocities, axis=0) / STAGE_S)

    def _replan(self, shot: Anew, time: float, drone: tuple[Array, Array], known: Estimate) -> None:
        assert self._planner is not None
        assert self._held is not None
        stages = time + STAGE_S * np.arange(STAGES + 1, dtype=np.float64)
        goal = min(float(stages[-1]), shot.phase.end)
        turn = self._turn(shot, time, known)
        plans: list[Plan | None] = []
        for r, count in enumerate(self.counts):
            situation = self._situation(shot, stages, goal, (drone[0][r], drone[1][r]), (known, r, turn[r]))
            plans.append(self._asked(situation, self._held.plans[r], count))
        self._held = self._held.replaced(plans)
        if self.own is not None:
            self.own.add(time, self._held.plans)

    def _asked(self, situation: ChaseSituation, last: Plan, count: Replans) -> Plan | None:
        """Return a new plan, or None where there is none: then the last one is flown to its end."""
        assert self._planner is not None
        try:
            done = self._planner.replan(situation, last)
        except Exception as error:  # noqa: BLE001  whatever it is, the drone is in the air
            count.failed += 1
            count.reason = f"{type(error).__name__}: {error}"
            return None
        count.lack = max(count.lack, done.lack)
        if done.plan is None or not _finite(done.plan):
            count.failed += 1
            count.reason = done.reason or "its plan holds numbers that are not finite"
            return None
        setattr(count, done.status, getattr(count, done.status) + 1)
        return done.plan

    def _turn(self, shot: Anew, time: float, known: Estimate) -> Array:
        """Return by how much the target's course is off the plan's, (R,), rad; kept while it stands."""
        if self._course is None:
            self._course = np.zeros(len(self.world.runs))
        if shot.turns:
            track = self.world.mission.target(shot.target).track
            assert track is not None
            moves = np.hypot(known.velocity[:, 0], known.velocity[:, 1]) > STILL_M_S
            course = np.arctan2(known.velocity[:, 1], known.velocity[:, 0])
            self._course = np.where(moves, wrapped(course - track.heading(time)), self._course)
        return self._course

    def _situation(
        self,
        shot: Anew,
        stages: Array,
        goal: float,
        drone: tuple[Array, Array],
        of: tuple[Estimate, int, float],
    ) -> ChaseSituation:
        """Return what is known of one run; goal : the time whose place beside the target is wanted."""
        known, r, turn = of
        track = self.world.mission.target(shot.target).track
        assert track is not None
        ahead = (stages - stages[0])[:, None]
        # A velocity that is known to 0.3 m/s is no climb: up and down the target goes as planned.
        moves = known.velocity[r] * np.array([1.0, 1.0, 0.0])
        climbs = np.array([track.at(t)[2] - track.at(float(stages[0]))[2] for t in stages.tolist()])
        target = known.position[r] + ahead * moves + climbs[:, None] * np.array([0.0, 0.0, 1.0])
        planned = track.at(goal)
        beside = np.asarray(self.film.track.curve(goal))[:3] - np.array(planned)
        level = self.film.track.curve(stages[stages <= goal])[:, 2]
        cos, sin = np.cos(turn), np.sin(turn)
        spun = np.array([cos * beside[0] - sin * beside[1], sin * beside[0] + cos * beside[1], beside[2]])
        wanted = target[-1] + spun
        return ChaseSituation(
            time=float(stages[0]),
            place=drone[0],
            velocity=drone[1],
            target=target,
            target_velocity=np.tile(moves, (len(stages), 1)),
            wanted=wanted,
            wanted_velocity=moves,
            height=float(wanted[2]) if np.ptp(level) <= LEVEL_M else None,
            traffic=Traffic(np.array([s.places(r, stages) for s in self.sent]).reshape(-1, len(stages), 3)),
        )


def _finite(plan: Plan) -> bool:
    parts = (plan.times, plan.places, plan.velocities, plan.accelerations)
    return all(bool(np.isfinite(part).all()) for part in parts)
