"""What a drone is asked to do at each step: what was planned, or what is planned anew while it flies."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import exp
from typing import Any

import numpy as np

from shotc import plugins
from shotc.geom.bernstein import Array
from shotc.geom.vec import wrapped
from shotc.ir.drone import Drone
from shotc.ir.mission import MissionIR
from shotc.planning.clearances import clearances_of, from_parked
from shotc.plugin_api.replanner import Cone, Keeping, Plan, Traffic
from shotc.simulation.film import PlanSamples
from shotc.simulation.seen import TrackedTarget
from shotc.simulation.sent import Fading, Sent, SentPlans
from shotc.simulation.situations import STAGE_S, Anew, Chased, Known, ReplanInstant
from shotc.simulation.time_limit import CallTimeout, time_limit
from shotc.simulation.vehicle import STEP_S, VehicleSetpoint
from shotc.simulation.world import World

PERIOD_S = 0.5
"""Seconds between two plans."""

LIMIT_S = 10.0
"""Seconds after which a planner is given up: it hangs, for nobody could fly with it."""

LOST_M = 4.0
"""Standard deviation of a target's place beyond which nobody flies beside it, metres."""

STILL_M_S = 0.3
"""Speed below which the course of a target is not known."""

COURSE_S = 3.0
"""Time over which the course of a target is taken, seconds: one that weaves does not turn.

The place of a shot turns with it, so that a step aside would send a camera 15 m away on a way of metres.
"""

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


@dataclass(slots=True)
class Guidance:
    """One drone of R runs.

    shots : those that are planned anew; () flies the plan; targets : what is known of those that move
    sent : what the drones of higher priority have sent; own : takes what this one sends
    """

    world: World
    film: PlanSamples
    shots: tuple[Anew, ...]
    targets: tuple[TrackedTarget, ...]
    sent: tuple[Sent, ...] = ()
    own: Sent | None = None
    counts: list[Replans] = field(default_factory=list)
    _planner: Any = None
    _held: SentPlans | None = None
    _back: Fading | None = None
    _active: Anew | None = None
    _course: Array | None = None

    def setpoint(self, k: int, drone: tuple[Array, Array]) -> VehicleSetpoint:
        """Return what the drone is asked for at a step.

        drone : where it takes itself to be, and how it moves, (R, 3) each
        """
        time = float(self.film.times[k])
        shot = next((s for s in self.shots if s.phase.start <= time < s.phase.end), None)
        if shot is not None:
            if shot is not self._active:
                self._begin(shot, time)
            if (k - self.film.step(shot.phase.start)) % round(PERIOD_S / STEP_S) == 0:
                self._replan(shot, time, drone)
        elif self._active is not None:
            self._leave(time)
        if self._active is not None and self._held is not None:
            return self._held.setpoint(time)
        return self.film.setpoint(k) if self._back is None else self._back.setpoint(time)

    def _begin(self, shot: Anew, time: float) -> None:
        mission, drone = self.world.mission, self.film.drone
        keeping = Keeping(
            limits=drone.limits,
            pitch=drone.gimbal.pitch,
            zones=(*clearances_of(mission, drone), *from_parked(mission, drone)),
            floor=mission.rules.over_ground(drone.radius),
            separation=mission.rules.separation,
            half_angle=_cone_of(mission, drone) if self.sent else None,
        )
        by = plugins.one("replanners", self.world.conditions.replanner).plugin
        self._planner = shot.planner(by, self.film, keeping)
        first = self._planned(time, shot.stages)
        n = len(self.world.runs)
        self._active, self._held = shot, SentPlans((first,) * n, drone.limits.usable_acceleration)
        self.counts = self.counts or [Replans() for _ in range(n)]
        self._course = np.zeros(n)

    def _planned(self, time: float, count: int) -> Plan:
        """Return the next seconds of the plan, from which the first replan goes on."""
        stages = time + STAGE_S * np.arange(count + 1, dtype=np.float64)
        curve = self.film.track.curve
        velocities = curve.derivative()(stages)[:, :3]
        return Plan(stages, curve(stages)[:, :3], velocities, np.diff(velocities, axis=0) / STAGE_S)

    def _leave(self, time: float) -> None:
        """Let the drone come back to its plan."""
        assert self._held is not None
        self._active = None
        film, speed = self.film, self.film.drone.limits.slowest
        now, k = self._held.setpoint(time), film.step(time)
        off = now.position - film.position[k], now.velocity - film.velocity[k]
        lasts = max(BACK_S, 4.0 * float(np.abs(off[0]).max()) / speed)
        self._back = Fading.of(film, time, lasts, *off)

    def _replan(self, shot: Anew, time: float, drone: tuple[Array, Array]) -> None:
        assert self._held is not None
        stages = time + STAGE_S * np.arange(shot.stages + 1, dtype=np.float64)
        known = {each.name: each.tracker.now(time) for each in self.targets}
        turn = self._turn(shot, time, known)
        plans: list[Plan | None] = []
        for r, count in enumerate(self.counts):
            of = ReplanInstant(known, self._held.plans[r], r, float(turn[r]), self._traffic(r, stages))
            mine = (drone[0][r], drone[1][r])
            lost = _lost(known, r)
            if lost:
                count.failed += 1
                count.reason = lost
                plans.append(None)
                continue
            situation = shot.situation(self.world.mission, self.film, stages, mine, of)
            plans.append(self._asked(situation, self._held.plans[r], count))
        self._held = self._held.replaced(plans)
        if self.own is not None:
            self.own.add(time, self._held.plans)

    def _traffic(self, run: int, stages: Array) -> Traffic:
        """Return what the others have told of these instants, and what their cameras see then."""
        mission = self.world.mission
        places = [each.places(run, stages) for each in self.sent]
        cones = [
            Cone(place, each.axes(run, stages), angle)
            for each, place in zip(self.sent, places, strict=True)
            if each.films(stages) and (angle := _cone_of(mission, each.film.drone)) is not None
        ]
        return Traffic(np.array(places).reshape(-1, len(stages), 3), tuple(cones))

    def _asked(self, situation: Any, last: Plan, count: Replans) -> Plan | None:
        """Return a new plan, or None where there is none: then the last one is flown to its end."""
        try:
            with time_limit(LIMIT_S):
                done = self._planner.replan(situation, last)
        except CallTimeout:
            count.failed += 1
            count.reason = f"it took more than {LIMIT_S:g} s"
            return None
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
        plan: Plan = done.plan
        return plan

    def _turn(self, shot: Anew, time: float, known: Known) -> Array:
        """Return by how much the target's course is off the plan's, (R,), rad.

        It comes nearer to what is estimated by what COURSE_S makes of a period; it is kept while the target
        stands.
        """
        assert self._course is not None
        if isinstance(shot, Chased) and shot.turns:
            track, now = self.world.mission.target(shot.target).track, known[shot.target]
            assert track is not None
            moves = np.hypot(now.velocity[:, 0], now.velocity[:, 1]) > STILL_M_S
            course = np.arctan2(now.velocity[:, 1], now.velocity[:, 0])
            turned = wrapped(course - track.heading(time) - self._course)
            share = 1.0 - exp(-PERIOD_S / COURSE_S)
            self._course = np.where(moves, self._course + share * turned, self._course)
        return self._course


def _cone_of(mission: MissionIR, drone: Drone) -> float | None:
    """Return half the opening of the cone of a drone's camera that others keep their centres out of, rad.

    It is that of the rules, or goes to the sides of the frame. None where the mission does not require it.
    """
    rules = mission.rules
    if rules.visibility != "require":
        return None
    return drone.hfov / 2 if rules.half_angle is None else rules.half_angle


def _lost(known: Known, run: int) -> str:
    """Say which target is not known well enough to be flown beside; empty where all are."""
    for name, now in known.items():
        deviation = float(np.sqrt(np.trace(now.covariance[run, :3, :3]) / 3.0))
        if deviation > LOST_M:
            return f"`{name}` is known to {LOST_M:g} m at best: the drone brakes and holds"
    return ""


def _finite(plan: Plan) -> bool:
    parts = (plan.times, plan.places, plan.velocities, plan.accelerations)
    return all(bool(np.isfinite(part).all()) for part in parts)
