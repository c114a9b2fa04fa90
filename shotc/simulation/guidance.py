"""The setpoint of a drone at each step: from its plan, or from a replan."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import exp, inf
from typing import Any

import numpy as np

from shotc.diag.plugin_faults import one_line
from shotc.geom.bernstein import Array
from shotc.geom.pieces import Mask
from shotc.geom.vec import wrapped
from shotc.ir.drone import Drone
from shotc.ir.mission import MissionIR
from shotc.ir.phases import UPRIGHT, Phase
from shotc.planning.clearances import clearances_of, from_parked
from shotc.plugin_api.replanner import Cone, Keeping, Plan, Replanner, Traffic
from shotc.simulation.film import PlanSamples
from shotc.simulation.replanner_answers import fault_of
from shotc.simulation.replanner_process import ReplannerFailed, ReplannerHangs
from shotc.simulation.seen import TrackedTarget
from shotc.simulation.sent import Fading, Sent, SentPlans, seconds_back
from shotc.simulation.situations import STAGE_S, Anew, Chased, ComposedShot, Known, Rejoined, ReplanInstant
from shotc.simulation.target_reach import TargetReach, reaches, with_targets
from shotc.simulation.vehicle import STEP_S, VehicleSetpoint
from shotc.simulation.walls import Standing, followed
from shotc.simulation.world import World

PERIOD_S = 0.5
"""Seconds between two replans."""

LOST_M = 4.0
"""Standard deviation of a target's position, above which a drone does not fly beside it, metres."""

STILL_M_S = 0.3
"""Speed, below which the course of a target is unknown."""

COURSE_S = 3.0
"""Time constant of a target's course and height, seconds, so that a target that weaves does not turn. The
position of a shot turns with the course, so without smoothing a sidestep would move a camera by 15 m. A
height known to 2 cm would let the camera climb and sink twice a second with 0.2 m/s^2.
"""

_SHARE = 1.0 - exp(-PERIOD_S / COURSE_S)

MOST_BACK_S = 20.0
"""Seconds after a shot for which a drone replans around an obstacle on the direct path to its plan."""

NEARER_M = 0.01
"""Metres by which the return may lack more clearance than necessary, or than the plan does."""


@dataclass(slots=True)
class Replans:
    """The number of replans of a drone in a run by result (``plugin_api.replanner``).

    failed : the replanner gave no plan that can be flown, or it hangs and is not asked again in this shot
    lost : the replanner was not asked, because the position of a target is unknown
    reason : of the last failure
    blind : the reason why the last target was lost
    """

    planned: int = 0
    stalled: int = 0
    opened: int = 0
    failed: int = 0
    lost: int = 0
    lack: float = 0.0
    reason: str = ""
    blind: str = ""

    @property
    def requested(self) -> int:
        """The number of replans that the replanner was asked for, or would have been."""
        return self.planned + self.stalled + self.opened + self.failed


@dataclass(slots=True)
class Guidance:
    """Guides one drone in R runs.

    shots : shots with replanning; () flies the plan
    by : the replanner; None without replanning
    targets : the trackers of moving targets
    sent : plans of drones of higher priority
    own : takes the plans that this drone sends
    """

    world: World
    film: PlanSamples
    shots: tuple[Anew, ...]
    by: Replanner | None
    targets: tuple[TrackedTarget, ...]
    sent: tuple[Sent, ...] = ()
    own: Sent | None = None
    counts: list[Replans] = field(default_factory=list)
    _planner: Any = None
    _held: SentPlans | None = None
    _back: Fading | None = None
    _active: Anew | Rejoined | None = None
    _standing: Standing | None = None
    _away: Mask = field(default_factory=lambda: np.zeros(0, dtype=bool))
    _hangs: dict[int, str] = field(default_factory=dict)
    _course: Array | None = None
    _rise: Array | None = None

    def setpoint(self, k: int, drone: tuple[Array, Array]) -> VehicleSetpoint:
        """Return the setpoint of the drone at a step.

        drone : its estimated position and velocity, (R, 3) each
        """
        time = float(self.film.times[k])
        shot = next((s for s in self.shots if s.phase.start <= time < s.phase.end), None)
        if shot is not None and shot is not self._active:
            self._begin(shot, time)
        elif shot is None and self._active is not None and not isinstance(self._active, Rejoined):
            self._leave(time)
        if self._active is None or self._held is None:
            return self.film.setpoint(k) if self._back is None else self._back.setpoint(time)
        if self._replan_due(time):
            self._replan(self._active, time, drone)
        return self._mixed(time)

    def _mixed(self, time: float) -> VehicleSetpoint:
        """Return the setpoints of all runs: those that have rejoined their plan follow it, the others their
        replans.
        """
        assert self._held is not None
        held = self._held.setpoint(time)
        if self._away.all() or self._back is None:
            return held
        back, away = self._back.setpoint(time), self._away[:, None]
        return VehicleSetpoint(
            np.where(away, held.position, back.position),
            np.where(away, held.velocity, back.velocity),
            np.where(away, held.acceleration, back.acceleration),
        )

    def _replan_due(self, time: float) -> bool:
        """Return whether a replan is due at a step."""
        assert self._active is not None
        steps = self.film.step(time) - self.film.step(self._active.phase.start)
        return steps % round(PERIOD_S / STEP_S) == 0

    def _begin(self, shot: Anew, time: float) -> None:
        self._take(shot)
        first = self._planned(time, shot.stages)
        n = len(self.world.runs)
        self._held = SentPlans((first,) * n, self.film.drone.limits.usable_acceleration)
        self.counts = self.counts or [Replans() for _ in range(n)]
        self._course, self._rise = np.zeros(n), np.zeros(n)
        self._away = np.ones(n, dtype=bool)
        self._hangs.clear()

    def _take(self, shot: Anew | Rejoined) -> None:
        """Start replanning of a shot or of a return."""
        mission, drone = self.world.mission, self.film.drone
        rules, terrain = mission.rules, mission.terrain
        keeping = Keeping(
            limits=drone.limits,
            pitch=drone.gimbal.pitch,
            zones=(*clearances_of(mission, drone), *from_parked(mission, drone)),
            floor=rules.over_ground(drone.radius) if terrain is None else -inf,
            ceiling=rules.max_height or inf if terrain is None else inf,
            separation=rules.separation,
            half_angle=_cone_of(mission, drone) if self.sent else None,
        )
        assert self.by is not None
        self._planner = shot.planner(self.by, self.film, keeping)
        self._standing = Standing.of(mission, drone, keeping)
        self._active = shot

    def _planned(self, time: float, count: int) -> Plan:
        """Return the next seconds of the plan, from which the first replan continues."""
        stages = time + STAGE_S * np.arange(count + 1, dtype=np.float64)
        curve = self.film.track.curve
        velocities = curve.derivative()(stages)[:, :3]
        return Plan(stages, curve(stages)[:, :3], velocities, np.diff(velocities, axis=0) / STAGE_S)

    def _leave(self, time: float) -> None:
        """Start the drones' return to their plan after a shot."""
        following = [p.start for p in self.film.track.phases if p.start >= time and _exact(p)]
        end = min(time + MOST_BACK_S, *following, float(self.film.times[-1]))
        self._take(Rejoined(Phase("transit", None, time, end)))
        self._back = Fading.none(self.film, len(self.world.runs))

    def _come_back(self, shot: Rejoined, time: float) -> None:
        """Let runs return directly to their plan if the path is clear or their time is over.

        Over its pad a drone may be near obstacles.
        """
        assert self._held is not None
        assert self._back is not None
        now, plan = self._held.setpoint(time), self.film.setpoint(self.film.step(time))
        off, rate = now.position - plan.position, now.velocity - plan.velocity
        away = np.flatnonzero(self._away).tolist()
        durations = seconds_back(off, self.film.drone.limits)
        times = np.arange(time, shot.phase.end, STAGE_S)
        times = times[times < time + durations[away].max()]
        reached = reaches(self.world, self.film.drone, self.targets, times) if len(times) else ()
        for r in away:
            back = self._back.begun(r, time, float(durations[r]), (off[r], rate[r]))
            on_way = times[times < time + durations[r]]
            if self._is_clear(back.places(r, on_way), self.film.places(on_way), r, reached):
                self._back, self._away[r] = back, False
        if not self._away.any():
            self._active = None

    def _is_clear(self, path: Array, plan: Array, run: int, reached: tuple[TargetReach, ...]) -> bool:
        """Return whether a way (M, 3) to the plan keeps clear of where targets may be, and lacks no more
        clearance from what stands than the plan does, (M, 3), metres.

        reached : where targets may be, at the times of the way and later
        """
        assert self._standing is not None
        most = np.maximum(self._standing.lack(plan), 0.0) + NEARER_M
        clear = (each.until(len(path)).lack(run, path) <= NEARER_M for each in reached)
        return bool((self._standing.lack(path) <= most).all()) and all(each.all() for each in clear)

    def _around(self, shot: Anew | Rejoined, stages: Array) -> tuple[TargetReach, ...]:
        """Return where those moving targets may be at the stages 1 to N, and once more at N, that a shot does
        not keep clear of by itself.
        """
        times = np.append(stages[1:], stages[-1])
        if not isinstance(shot, ComposedShot):
            near = shot.target if isinstance(shot, Chased) else None
            return reaches(self.world, self.film.drone, self.targets, times, near)
        bodies = {each.target for each in shot.subjects} | {each.name for each in self.targets}
        reached = reaches(self.world, self.film.drone, (), times)
        return tuple(each for each in reached if each.target not in bodies)

    def _replan(self, shot: Anew | Rejoined, time: float, drone: tuple[Array, Array]) -> None:
        assert self._held is not None
        if isinstance(shot, Rejoined):
            self._come_back(shot, time)
            if self._active is None:
                return
        stages = time + STAGE_S * np.arange(shot.stages + 1, dtype=np.float64)
        known = (
            {} if isinstance(shot, Rejoined) else {each.name: each.foreseen(stages) for each in self.targets}
        )
        turn, rise = self._turn(shot, time, known), self._risen(shot, time, known)
        reached = self._around(shot, stages)
        plans: list[Plan | None] = []
        for r, count in enumerate(self.counts):
            last = self._held.plans[r]
            if not self._away[r]:
                plans.append(None)
                continue
            lost = _lost(known, r)
            if lost:
                count.lost += 1
                count.blind = lost
                plans.append(None)
                continue
            assert self._standing is not None
            walls = self._standing.beside(last, stages)
            walls = with_targets(walls, reached, r, followed(last, stages, self._standing.keeping)[1:])
            of = ReplanInstant(
                known, last, r, float(turn[r]), float(rise[r]), self._traffic(r, stages), walls
            )
            mine = (drone[0][r], drone[1][r])
            situation = shot.situation(self.world.mission, self.film, stages, mine, of)
            plans.append(self._replanned(r, situation, stages))
        self._held = self._held.replaced(plans)
        if self.own is not None:
            self.own.add(time, self._held.plans)

    def _traffic(self, run: int, stages: Array) -> Traffic:
        """Return the sent positions of other drones at the stages, and the cones of their cameras."""
        mission = self.world.mission
        places = [each.places(run, stages) for each in self.sent]
        cones = [
            Cone(place, each.axes(run, stages), angle)
            for each, place in zip(self.sent, places, strict=True)
            if each.films(stages) and (angle := _cone_of(mission, each.film.drone)) is not None
        ]
        return Traffic(np.array(places).reshape(-1, len(stages), 3), tuple(cones))

    def _replanned(self, run: int, situation: Any, stages: Array) -> Plan | None:
        """Return a new plan of a run; None if there is none, so that the last one is flown to its end.

        A replanner that hangs is not asked again in the shot: it would take its time limit twice a second.
        """
        assert self._held is not None
        count = self.counts[run]
        fault, done = self._hangs.get(run, ""), None
        if not fault:
            try:
                done = self._planner.replan(situation, self._held.plans[run])
                fault = fault_of(done, stages)
            except ReplannerHangs as error:
                fault = self._hangs[run] = str(error)
            except ReplannerFailed as error:
                fault = str(error)
            except Exception as error:  # noqa: BLE001  whatever it is, the drone is in the air
                fault = one_line(error)
        if done is not None and not fault:
            setattr(count, done.status, getattr(count, done.status) + 1)
            count.lack = max(count.lack, done.lack)
            plan: Plan = done.plan
            return plan
        count.failed += 1
        count.reason = fault
        return None

    def _turn(self, shot: Anew | Rejoined, time: float, known: Known) -> Array:
        """Return the difference of the target's course from the planned one, (R,), rad.

        It approaches the estimate with the time constant COURSE_S. It stays constant while the target stands.
        """
        assert self._course is not None
        if isinstance(shot, Chased) and shot.turns:
            track, velocity = (
                self.world.mission.target(shot.target).track,
                known[shot.target].now.course_velocity,
            )
            assert track is not None
            moves = np.hypot(velocity[:, 0], velocity[:, 1]) > STILL_M_S
            course = np.arctan2(velocity[:, 1], velocity[:, 0])
            turned = wrapped(course - track.heading(time) - self._course)
            self._course = np.where(moves, self._course + _SHARE * turned, self._course)
        return self._course

    def _risen(self, shot: Anew | Rejoined, time: float, known: Known) -> Array:
        """Return the difference of the target's height from the planned one, (R,), metres, smoothed as the
        course.
        """
        assert self._rise is not None
        if isinstance(shot, Chased):
            planned = self.world.mission.target(shot.target).at(time)[2]
            rise = known[shot.target].now.position[:, 2] - planned
            self._rise = self._rise + _SHARE * (rise - self._rise)
        return self._rise


def _exact(phase: Phase) -> bool:
    """Return whether a phase must follow the plan from its start: shots, and vertical phases over the pad."""
    return phase.shot is not None or phase.name in UPRIGHT


def _cone_of(mission: MissionIR, drone: Drone) -> float | None:
    """Return half the opening angle of the cone of a drone's camera that others must avoid, rad.

    It is that of the rules, else half the horizontal field of view. It is None if the mission does not
    require it.
    """
    rules = mission.rules
    if rules.visibility != "require":
        return None
    return drone.hfov / 2 if rules.half_angle is None else rules.half_angle


def _lost(known: Known, run: int) -> str:
    """Return why a target's estimate is too uncertain to fly beside it; "" if none is."""
    for name, each in known.items():
        deviation = float(np.sqrt(np.trace(each.now.covariance[run, :3, :3]) / 3.0))
        if deviation > LOST_M:
            return f"`{name}` is known to {LOST_M:g} m at best: the drone brakes and holds"
    return ""
