"""The setpoint of a drone at each step: from its plan, or from a replan."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import exp
from typing import Any

import numpy as np

from shotc.diag.plugin_faults import one_line
from shotc.geom.bernstein import Array
from shotc.geom.pieces import Mask
from shotc.geom.vec import wrapped
from shotc.ir.drone import Drone
from shotc.ir.mission import MissionIR
from shotc.ir.phases import UPRIGHT, Phase
from shotc.plugin_api.replanner import Cone, Plan, Replanner, Traffic
from shotc.simulation.film import PlanSamples
from shotc.simulation.replanner_answers import fault_of
from shotc.simulation.replanner_process import ReplannerFailed, ReplannerHangs
from shotc.simulation.replans import Replans
from shotc.simulation.seen import TrackedTarget
from shotc.simulation.sensors import Interval, within
from shotc.simulation.sent import Fading, Sent, SentPlans
from shotc.simulation.situations import STAGE_S, Anew, Chased, ComposedShot, Known, Rejoined, ReplanInstant
from shotc.simulation.target_reach import TargetReach, reaches, with_targets
from shotc.simulation.vehicle import STEP_S, VehicleSetpoint
from shotc.simulation.walls import Standing, followed, keeping_of
from shotc.simulation.way_back import WayBack, durations_back, return_lack
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

_COURSE_SHARE = 1.0 - exp(-PERIOD_S / COURSE_S)

MOST_UNSURE_S = 20.0
"""Seconds on the way back to the plan, after which a target counts where it is expected, and no longer where
it may be: the reach of a lost target grows over every way back.
"""


@dataclass(slots=True)
class Guidance:
    """Guides one drone in R runs, in which it plans shots and its way back from them anew.

    shots : shots with replanning
    by : the replanner
    blind : the intervals in which it brakes and holds for lack of positions of its own, seconds
    targets : the trackers of moving targets
    sent : plans of drones of higher priority
    own : takes the plans that this drone sends
    """

    world: World
    film: PlanSamples
    shots: tuple[Anew, ...]
    by: Replanner
    blind: tuple[Interval, ...]
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
    _course: Array = field(default_factory=lambda: np.zeros(0))
    _rise: Array = field(default_factory=lambda: np.zeros(0))
    _holds: bool = False

    def setpoint(self, k: int, drone: tuple[Array, Array]) -> VehicleSetpoint:
        """Return the setpoint of the drone at a step.

        drone : its estimated position and velocity, (R, 3) each
        """
        time = float(self.film.times[k])
        if within(time, self.blind):
            return self._stopped(time)
        returns, self._holds = self._holds, False
        shot = next((s for s in self.shots if s.phase.start <= time < s.phase.end), None)
        if shot is not None and shot is not self._active:
            self._begin(shot, time)
        elif shot is None and (returns or isinstance(self._active, Chased | ComposedShot)):
            self._leave(time)
        if self._active is not None and self._replan_due(time):
            self._replan(self._active, time, drone)
        return self._now(time)

    def _now(self, time: float) -> VehicleSetpoint:
        """Return the setpoints of all runs at a time, without planning anew."""
        if self._active is None or self._held is None:
            return self._planned(time)
        return self._mixed(time)

    def _planned(self, time: float) -> VehicleSetpoint:
        """Return the setpoints of the plan, with what is left of the ways back to it."""
        return self.film.setpoint(self.film.step(time)) if self._back is None else self._back.setpoint(time)

    def _stopped(self, time: float) -> VehicleSetpoint:
        """Return the setpoints of drones that brake and hold."""
        if not self._holds:
            now, h = self._now(time), STAGE_S
            parts = (np.broadcast_to(part, (self._runs, 3)) for part in (now.position, now.velocity))
            # A plan of one stage: past its end drones brake and hold.
            stops = tuple(
                Plan(np.array([time, time + h]), np.array([p, p + h * v]), np.array([v, v]), np.zeros((1, 3)))
                for p, v in zip(*parts, strict=True)
            )
            self._prepare()
            self._held = SentPlans(stops, self.film.drone.limits.usable_acceleration)
            self._away, self._holds = np.ones(self._runs, dtype=bool), True
            self._send(time)
        assert self._held is not None
        return self._held.setpoint(time)

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

    @property
    def _runs(self) -> int:
        """Return the number of runs."""
        return len(self.world.runs)

    def _prepare(self) -> None:
        """Prepare the counts and the smoothed states of all runs, once."""
        if not self.counts:
            self.counts = [Replans() for _ in range(self._runs)]
            self._course, self._rise = np.zeros(self._runs), np.zeros(self._runs)
            self._away = np.zeros(self._runs, dtype=bool)

    def _begin(self, shot: Anew, time: float) -> None:
        """Start replanning of a shot: drones that are not back on their plan go on from where they are."""
        self._prepare()
        first = list(self._ahead(time, shot.stages))
        for r in np.flatnonzero(self._away).tolist():
            assert self._held is not None
            first[r] = self._held.plans[r]
        self._take(shot)
        self._held = SentPlans(tuple(first), self.film.drone.limits.usable_acceleration)
        self._course, self._rise = np.zeros(self._runs), np.zeros(self._runs)
        self._away = np.ones(self._runs, dtype=bool)
        self._hangs.clear()

    def _take(self, shot: Anew | Rejoined) -> None:
        """Start replanning of a shot or of a return."""
        mission, drone = self.world.mission, self.film.drone
        keeping = keeping_of(mission, drone, _cone_of(mission, drone) if self.sent else None)
        self._planner = shot.planner(self.by, self.film, keeping)
        self._standing = Standing.of(mission, drone, keeping)
        self._active = shot

    def _ahead(self, time: float, count: int) -> tuple[Plan, ...]:
        """Return the next seconds of the plan in all runs, from which the first replans continue."""
        stages = time + STAGE_S * np.arange(count + 1, dtype=np.float64)
        rows = [self._planned(t) for t in stages.tolist()]
        shape = (self._runs, 3)
        places, velocities = (
            np.stack([np.broadcast_to(row, shape) for row in part], axis=1)
            for part in ([row.position for row in rows], [row.velocity for row in rows])
        )
        rates = np.diff(velocities, axis=1) / STAGE_S
        return tuple(Plan(stages, *each) for each in zip(places, velocities, rates, strict=True))

    def _leave(self, time: float) -> None:
        """Start the drones' return to their plan."""
        self._prepare()
        self._take(Rejoined(Phase("transit", None, time, float(self.film.times[-1]))))
        self._back = Fading.none(self.film, self._runs)

    def _come_back(self, shot: Rejoined, time: float) -> None:
        """Let runs return directly to their plan if the path is clear.

        Over its pad a drone may be near obstacles.
        """
        assert self._held is not None
        assert self._back is not None
        assert self._standing is not None
        now, plan = self._held.setpoint(time), self.film.setpoint(self.film.step(time))
        off, rate = now.position - plan.position, now.velocity - plan.velocity
        away = np.flatnonzero(self._away).tolist()
        durations = durations_back(self.film, off, time)
        times = np.arange(time, time + float(durations[away].max()), STAGE_S)
        names = [each.name for each in self.targets] if time > shot.phase.start + MOST_UNSURE_S else ()
        reached = reaches(self.world, self.film.drone, self.targets, times, names)
        for r in away:
            back = self._back.begun(r, time, float(durations[r]), (off[r], rate[r]))
            on_way = times[times < time + durations[r]]
            way = WayBack(on_way, back.places(r, on_way), self.film.places(on_way))
            lack = return_lack(self._standing, way, r, reached, self._standing.keeping.margin)
            if lack.clear and way.flyable(self.film):
                self._back, self._away[r] = back, False
        if not self._away.any():
            self._active = None

    def _note_late(self, shot: Rejoined, time: float) -> None:
        """Note the runs that are not back on their plan in a phase that has to follow it."""
        phase = next((p for p in self.film.track.phases if p.start <= time < p.end and _exact(p)), None)
        if phase is None or phase.start < shot.phase.start:
            return
        what = f"shot `{phase.shot}`" if phase.shot is not None else "its landing"
        for r in np.flatnonzero(self._away).tolist():
            self.counts[r].late = self.counts[r].late or f"{what} at {phase.start:.1f} s"

    def _send(self, time: float) -> None:
        """Send the plans to the other drones."""
        if self.own is not None:
            assert self._held is not None
            off = self._away & (self._active is not None or self._holds)
            plans = zip(self._held.plans, off.tolist(), strict=True)
            self.own.add(time, tuple(plan if away else None for plan, away in plans))

    def _around(self, shot: Anew | Rejoined, stages: Array) -> tuple[TargetReach, ...]:
        """Return where those moving targets may be at the stages 1 to N, and once more at N, that a shot does
        not keep clear of by itself.
        """
        times = np.append(stages[1:], stages[-1])
        if not isinstance(shot, ComposedShot):
            near = (shot.target,) if isinstance(shot, Chased) else ()
            return reaches(self.world, self.film.drone, self.targets, times, near)
        bodies = {each.target for each in shot.subjects} | {each.name for each in self.targets}
        reached = reaches(self.world, self.film.drone, (), times)
        return tuple(each for each in reached if each.target not in bodies)

    def _replan(self, shot: Anew | Rejoined, time: float, drone: tuple[Array, Array]) -> None:
        assert self._held is not None
        if isinstance(shot, Rejoined):
            self._come_back(shot, time)
            if self._active is None:
                self._send(time)
                return
            self._note_late(shot, time)
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
        self._send(time)

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
        fault, replan = self._hangs.get(run, ""), None
        if not fault:
            try:
                replan = self._planner.replan(situation, self._held.plans[run])
                fault = fault_of(replan, stages)
            except ReplannerHangs as error:
                fault = self._hangs[run] = str(error)
            except ReplannerFailed as error:
                fault = str(error)
            except Exception as error:  # noqa: BLE001  whatever it is, the drone is in the air
                fault = one_line(error)
        if replan is not None and not fault:
            setattr(count, replan.status, getattr(count, replan.status) + 1)
            count.lack = max(count.lack, replan.lack)
            plan: Plan = replan.plan
            return plan
        count.failed += 1
        count.reason = fault
        return None

    def _turn(self, shot: Anew | Rejoined, time: float, known: Known) -> Array:
        """Return the difference of the target's course from the planned one, (R,), rad.

        It approaches the estimate with the time constant COURSE_S. It stays constant while the target stands.
        """
        if isinstance(shot, Chased) and shot.turns:
            track, velocity = (
                self.world.mission.target(shot.target).track,
                known[shot.target].now.course_velocity,
            )
            assert track is not None
            moves = np.hypot(velocity[:, 0], velocity[:, 1]) > STILL_M_S
            course = np.arctan2(velocity[:, 1], velocity[:, 0])
            turned = wrapped(course - track.heading(time) - self._course)
            self._course = np.where(moves, self._course + _COURSE_SHARE * turned, self._course)
        return self._course

    def _risen(self, shot: Anew | Rejoined, time: float, known: Known) -> Array:
        """Return the difference of the target's height from the planned one, (R,), metres, smoothed as the
        course.
        """
        if isinstance(shot, Chased):
            planned = self.world.mission.target(shot.target).at(time)[2]
            rise = known[shot.target].now.position[:, 2] - planned
            self._rise = self._rise + _COURSE_SHARE * (rise - self._rise)
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
