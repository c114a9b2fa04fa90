"""The legs of one drone on the mission's clock, shot by shot in the order of flight.

A shot of a moving target is planned for the time at which it starts. The legs before it are therefore timed
here, in the same way as in the time pass.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from math import inf
from typing import NamedTuple

import numpy as np

from shotc.ir.drone import Drone
from shotc.ir.keyframes import PlacedShot
from shotc.ir.mission import MissionIR
from shotc.ir.path import ClockDeviation, Leg, MovingLeg, Pose, TimedPath
from shotc.ir.trajectory import DroneTrajectory
from shotc.planning.clock.aims import CameraTask
from shotc.planning.clock.departure import NextLeg, Transfer, When, choose
from shotc.planning.clock.detours import Meanwhile, Transit, ways_home, ways_to
from shotc.planning.clock.ends import (
    ASIDES,
    END_REQUIREMENTS,
    FROM_AFAR,
    Departure,
    EndRequirement,
    leading_aside,
)
from shotc.planning.clock.flights import flight
from shotc.planning.clock.run_up import lead_in, way_time
from shotc.planning.clock.shot import NoMotion, OtherVehicles, timed_shot
from shotc.planning.clock.starts import (
    SLIGHT_M,
    ClockFailure,
    Lateness,
    Meets,
    OutsideTrack,
    Reached,
    TooLate,
    inside,
    later,
    outside,
    put_off,
    straight_lateness,
    too_late,
    tracks_begin,
    without_stop,
)
from shotc.planning.path.legs import (
    LegContext,
    end_of,
    nearest,
    take_off,
    turned,
    turned_leg,
    way_home,
    way_to,
)
from shotc.planning.path.shots import Failure, PlannedShot
from shotc.planning.timing.timed_leg import leg_time
from shotc.rounding import up

LATE_S = 1e-6  # seconds
AMPLE_RATIO = 1.5  # time that a transfer without a deadline may take, over its direct duration


class _Snapshot(NamedTuple):
    """A snapshot of an itinerary, with the same field names."""

    legs: tuple[Leg, ...]
    clock: float
    deviations: tuple[ClockDeviation, ...]
    stats: tuple[tuple[str, float | str], ...]
    ends: dict[str, float]
    last: _Last | None
    slack: float


class _Last(NamedTuple):
    """The last shot, if it is on its own clock, and the state before it."""

    reached: Reached
    before: _Snapshot


@dataclass(slots=True)
class Itinerary:
    """The legs of one drone planned so far, and the mission time at their end.

    ends : mission times at which shots of drones planned before end, by id; this drone's are added
    last : its last shot on its own clock
    slack : least slack over clearances on the last transfer, metres
    late : seconds by which the last transfer ends after the fixed start of its shot
    """

    mission: MissionIR
    flight: LegContext
    others: OtherVehicles
    ends: dict[str, float]
    legs: list[Leg] = field(default_factory=list)
    clock: float = 0.0
    deviations: list[ClockDeviation] = field(default_factory=list)
    stats: list[tuple[str, float | str]] = field(default_factory=list)
    last: _Last | None = None
    slack: float = inf
    late: float = 0.0

    @property
    def drone(self) -> Drone:
        """The drone that flies."""
        return self.flight.drone

    def copied(self, mission: MissionIR, flight: LegContext) -> Itinerary:
        """Return a copy for another mission with the same shots so far, to try changes."""
        lists = list(self.legs), self.clock, list(self.deviations), list(self.stats)
        return Itinerary(mission, flight, self.others, dict(self.ends), *lists, self.last, self.slack)

    def film(self, shot: PlannedShot | PlacedShot) -> ClockFailure | None:
        """Add a shot and the transfer to it."""
        add = partial(self._path, shot) if isinstance(shot, PlannedShot) else partial(self._timed, shot)
        return self._leaving(add)

    def home(self) -> ClockFailure | None:
        """Add the way home."""
        return self._leaving(self._home)

    def _leaving(self, add: Callable[[], ClockFailure | None]) -> ClockFailure | None:
        """Add what follows the last shot, and plan that shot again with another end if this helps.

        The end leads aside where the transfer meets something otherwise, and straight on where leading aside
        takes too long.
        """
        self.late = 0.0
        before = self._state()
        outcome = add()
        if isinstance(outcome, TooLate) or self.late > LATE_S:
            tries = (
                ((False, False), (True, False)) if before.last and before.last.reached.ends_aside[1] else ()
            )
        elif isinstance(outcome, Meets) or self.slack < 0.0:
            tries = (False, True), (True, True)
        else:
            return outcome
        planned = self._state()
        self._restore(before)
        if self._ended(tries):
            again = add()
            if again is None and self.slack >= 0.0 and self.late <= LATE_S:
                return None
            if isinstance(outcome, TooLate) and isinstance(again, TooLate) and again.late < outcome.late:
                outcome = again
        self._restore(planned)
        return outcome

    def _ended(self, ends: tuple[tuple[bool, bool], ...]) -> bool:
        """Plan the last shot again with the first feasible pair of ends; return whether there is one.

        ends : whether the shot begins away from moving obstacles, and whether it ends so
        """
        if self.last is None:
            return False
        old, before = self.last
        self._restore(before)
        for led in ends:
            new = self._reached_as(old.placed, old.shot.leg.start, leading_aside(*led))
            if isinstance(new, Reached) and new.transfer.met is None and new.late <= LATE_S:
                self._add(new)
                return True
        return False

    def _state(self) -> _Snapshot:
        lists = tuple(self.legs), self.clock, tuple(self.deviations), tuple(self.stats)
        return _Snapshot(*lists, dict(self.ends), self.last, self.slack)

    def _restore(self, state: _Snapshot) -> None:
        self.legs, self.clock = list(state.legs), state.clock
        self.deviations, self.stats = list(state.deviations), list(state.stats)
        self.last, self.slack = state.last, state.slack
        self.ends.clear()
        self.ends.update(state.ends)

    def _home(self) -> ClockFailure | None:
        pose = end_of(self.legs)
        back = way_home(self.flight, pose)
        if not isinstance(back, list):
            return back
        transits = ways_home(self.flight, pose, back, self._meanwhile(back, None))
        stays = max(self.ends.values(), default=0.0)
        transfer = choose(self.mission, self.drone, self.others, transits, When(self.clock, stays=stays))
        assert transfer is not None
        if transfer.met is not None:
            return Meets(transfer.met)
        self._take(transfer)
        return None

    def track(self) -> DroneTrajectory:
        """Return the drone's flight as far as it is planned, with the timing of the time pass."""
        return flight(self.mission, TimedPath(self.drone.name, tuple(self.legs)), dict(self.ends))

    def _meanwhile(self, direct: list[MovingLeg], deadline: float | None) -> Meanwhile:
        """Return the other vehicles during a transfer.

        direct : legs that take about as long
        deadline : of the arrival, if there is one
        """
        end = deadline
        if end is None:
            end = self.clock + AMPLE_RATIO * sum(leg_time(self.drone, leg) for leg in direct)
        return Meanwhile(self.others, (self.clock, max(self.clock, end)))

    def _path(self, shot: PlannedShot) -> ClockFailure | None:
        timing = shot.shot.shot.timing
        ready = max(timing.start or 0.0, self.ends.get(timing.after or "", 0.0))
        transfer = self._transfer(shot.leg.pose, shot, timing.start, ready)
        if not isinstance(transfer, Transfer):
            return transfer
        if transfer.met is not None:
            return Meets(transfer.met)
        self.late = 0.0 if timing.start is None else transfer.end - timing.start
        pose = end_of(transfer.legs) if transfer.legs else end_of(self.legs)
        placed = turned(self.drone, shot, pose)
        self._take(transfer)
        leg = placed.leg
        self.clock = max(self.clock, ready)
        self.legs.append(leg)
        self.clock += leg_time(self.drone, leg)
        self.ends[shot.shot.shot.id] = self.clock
        self.last = None
        return None

    def _transfer(
        self, goal: Pose, shot: PlannedShot | PlacedShot, deadline: float | None, ready: float = 0.0
    ) -> Transfer | Failure:
        """Return the unfilmed legs from the current pose, or from the pad, to a shot's first pose.

        deadline : of the arrival, if there is one
        ready : earliest start of a shot on a path
        """
        lift = [] if self.legs else [take_off(self.flight, goal)]
        pose = end_of(lift or self.legs)
        path = (shot.shot.shot if isinstance(shot, PlannedShot) else shot.shot).path
        near, then = nearest(goal, pose), None
        if isinstance(shot, PlannedShot):
            placed = turned(self.drone, shot, pose)
            near, then = placed.leg.pose, NextLeg(placed.leg, ready)
        direct = way_to(self.flight, pose, near, path)
        if not isinstance(direct, list):
            return direct

        transit = Transit(self.mission, self.flight, pose, near, path)
        transits = ways_to(transit, (lift, goal), direct, self._meanwhile([*lift, *direct], deadline))
        transfer = choose(self.mission, self.drone, self.others, transits, When(self.clock, deadline), then)
        assert transfer is not None
        return transfer

    def _timed(self, placed: PlacedShot) -> ClockFailure | None:
        shot = placed.shot
        fixed = shot.timing.start
        if fixed is None:
            ready = self.ends.get(shot.timing.after or "", 0.0)
            before = lead_in(self.mission, self.drone, shot, self.clock).seconds
            ready = max(ready, self.clock + before, tracks_begin(self.mission, placed))
            start = inside(self.mission, self.flight.space, placed, ready)
            reached = self._put_off(placed, start)
            if isinstance(reached, Reached):
                film_start = reached.shot.leg.start
                entry = inside(self.mission, self.flight.space, placed, film_start)
                reached = self._put_off(placed, entry) if entry > film_start else reached
            elif isinstance(reached, NoMotion):
                reached = later(self._reached, placed, start) or reached
        else:
            reached = self._reached(placed, fixed)
            if isinstance(reached, Reached) and reached.late > LATE_S:
                reached = self._without_stop(reached) or reached
        if not isinstance(reached, Reached):
            return reached
        trouble = self._late(placed, reached)
        if trouble is not None:
            return trouble
        if not reached.transfer.clear and (fixed is None or reached.transfer.met is not None):
            freer = later(self._reached, placed, reached.shot.leg.start)
            if fixed is None:
                reached = freer or reached
            if reached.transfer.met is not None:
                return Meets(reached.transfer.met, None if freer is None else freer.shot.leg.start)
        self._add(reached)
        return None

    def _add(self, reached: Reached) -> None:
        """Add a shot on its own clock and the transfer to it."""
        self.last = _Last(reached, self._state())
        self._take(reached.transfer)
        leg = turned_leg(reached.shot.leg, end_of(self.legs))
        self.legs.append(leg)
        self.clock = float(leg.curve.end)
        self.ends[reached.placed.shot.id] = leg.end
        self.deviations += reached.shot.deviations
        self.stats += reached.shot.stats

    def _late(self, placed: PlacedShot, reached: Reached) -> ClockFailure | None:
        """Return the failure if the drone is late for a shot, or if the track ends before the shot does."""
        start, fixed = reached.shot.leg.start, placed.shot.timing.start
        if reached.late <= LATE_S:
            return outside(self.mission, placed, start)
        if fixed is None:
            return self._too_late(reached, reached, None)
        first = self._put_off(placed, up(fixed))
        if isinstance(first, OutsideTrack):
            return self._too_late(reached, reached, first)
        if not isinstance(first, Reached):
            return first
        short = outside(self.mission, placed, first.shot.leg.start) if first.late <= LATE_S else None
        return self._too_late(reached, first, short)

    def _too_late(self, requested: Reached, first: Reached, short: OutsideTrack | None) -> TooLate:
        """Return the failure of a shot that the drone reaches too late; arguments as of ``too_late``."""
        path = TimedPath(self.drone.name, (*self.legs, *first.transfer.legs, first.shot.leg))
        return too_late(flight(self.mission, path, dict(self.ends)).phases, requested, first, short)

    def _reached(self, placed: PlacedShot, start: float) -> Reached | ClockFailure:
        """Plan a shot for a start, and the transfer to it, with the ends that suit it best."""
        reached = self._with_plain_ends(placed, start)
        return self._with_better_ends(reached) if isinstance(reached, Reached) else reached

    def _with_plain_ends(self, placed: PlacedShot, start: float) -> Reached | ClockFailure:
        """Plan a shot for a start, and the transfer to it, with straight ends if there is such a motion.

        A subject that follows the camera runs into a drone that stops ahead of it. Then the shot begins or
        ends aside.
        """
        short = outside(self.mission, placed, start)
        if short is not None:
            return short
        near = self._reached_as(placed, start, END_REQUIREMENTS)
        if isinstance(near, NoMotion) and near.missed is None:
            asides = (self._reached_as(placed, start, aside) for aside in ASIDES)
            return next((a for a in asides if isinstance(a, Reached) and a.transfer.met is None), near)
        return near

    def _with_better_ends(self, near: Reached) -> Reached:
        """Return a shot with other ends, if they are better.

        If every transfer to its first pose comes too near to a target, or its run-up or run-out lacks
        clearances of transfers, the shot begins or ends aside, or farther off.
        """
        into, out = (lack > SLIGHT_M for lack in near.shot.lacks)
        best = near
        for requirements in (leading_aside(into or near.transfer.met is not None, out), FROM_AFAR):
            if best.transfer.met is None and max(best.shot.lacks) <= SLIGHT_M:
                break
            far = self._reached_as(near.placed, near.shot.leg.start, requirements)
            if isinstance(far, Reached) and far.better(best):
                best = far
        return best

    def _reached_as(
        self, placed: PlacedShot, start: float, requirements: tuple[EndRequirement, ...]
    ) -> Reached | ClockFailure:
        """Plan a shot and the transfer to it, with given requirements on the shot's ends."""
        camera_task = CameraTask(self.mission, self.drone, placed.subjects)
        shot = timed_shot(camera_task, (self.flight.spaces, self.others), placed, start, requirements)
        if isinstance(shot, NoMotion):
            return shot
        curve_start = float(shot.leg.curve.start)
        transfer = self._transfer(shot.leg.pose, placed, curve_start)
        if not isinstance(transfer, Transfer):
            return transfer
        return Reached(placed, shot, transfer, transfer.end - curve_start, requirements[0].ends_aside)

    def _without_stop(self, late: Reached) -> Reached | None:
        """Return a shot that is late, with a run-up from the end of the last leg, if it is in time then."""
        lift = [] if self.legs else [take_off(self.flight, late.shot.leg.pose)]
        x, y, z = end_of(lift or self.legs)[:3]
        ready = self.clock + sum(leg_time(self.drone, leg) for leg in lift)
        reach = partial(self._reached_as, late.placed, late.shot.leg.start)
        return without_stop(self.mission, self.drone, late, reach, Departure((x, y, z), ready))

    def _put_off(self, placed: PlacedShot, start: float) -> Reached | ClockFailure:
        """Plan a shot for the first start, from a given one on, that the drone reaches in time."""
        reached = put_off(self.mission, self._with_plain_ends, placed, start, self._about(placed))
        return self._with_better_ends(reached) if isinstance(reached, Reached) else reached

    def _about(self, placed: PlacedShot) -> Lateness:
        """Return an estimate of the seconds by which a straight flight to a shot is late."""
        here, ready = np.array(end_of(self.legs)[:3] if self.legs else self.flight.top), self.clock
        if not self.legs:
            ready += way_time(self.drone.limits, here - np.array(self.drone.home))
        return straight_lateness(self.mission, self.drone, placed.shot, here, ready)

    def _take(self, transfer: Transfer) -> None:
        self.slack = transfer.slack
        self.legs += transfer.legs
        self.clock = transfer.end
