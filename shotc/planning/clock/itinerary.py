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

from shotc.ir.drone import Drone
from shotc.ir.keyframes import PlacedShot
from shotc.ir.mission import MissionIR
from shotc.ir.path import ClockDeviation, Leg, TimedPath
from shotc.ir.trajectory import DroneTrajectory
from shotc.planning.clock.approach import Approach
from shotc.planning.clock.departure import Transfer, When, choose
from shotc.planning.clock.detours import ways_home
from shotc.planning.clock.ends import leading_aside
from shotc.planning.clock.flights import LATE_S, flight
from shotc.planning.clock.run_up import lead_in
from shotc.planning.clock.shot import NoMotion, OtherVehicles
from shotc.planning.clock.starts import (
    ClockFailure,
    Meets,
    OutsideTrack,
    Reached,
    TooLate,
    inside,
    later,
    outside,
    too_late,
    tracks_begin,
)
from shotc.planning.path.legs import LegContext, end_of, turned, turned_leg, way_home
from shotc.planning.path.shots import PlannedShot
from shotc.planning.timing.timed_leg import leg_time
from shotc.rounding import up


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

    @property
    def _here(self) -> Approach:
        return Approach(self.mission, self.flight, self.others, tuple(self.legs), self.clock)

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
            new = self._here.reached_as(old.placed, old.shot.leg.start, leading_aside(*led))
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
        transits = ways_home(self.flight, pose, back, self._here.meanwhile(back, None))
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

    def _path(self, shot: PlannedShot) -> ClockFailure | None:
        timing = shot.shot.shot.timing
        ready = max(timing.start or 0.0, self.ends.get(timing.after or "", 0.0))
        transfer = self._here.transfer(shot.leg.pose, shot, timing.start, ready)
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

    def _timed(self, placed: PlacedShot) -> ClockFailure | None:
        shot = placed.shot
        fixed = shot.timing.start
        if fixed is None:
            ready = self.ends.get(shot.timing.after or "", 0.0)
            before = lead_in(self.mission, self.drone, shot, self.clock).seconds
            ready = max(ready, self.clock + before, tracks_begin(self.mission, placed))
            start = inside(self.mission, self.flight.space, placed, ready)
            reached = self._here.put_off(placed, start)
            if isinstance(reached, Reached):
                film_start = reached.shot.leg.start
                entry = inside(self.mission, self.flight.space, placed, film_start)
                reached = self._here.put_off(placed, entry) if entry > film_start else reached
            elif isinstance(reached, NoMotion):
                reached = later(self._here.reached, placed, start) or reached
        else:
            reached = self._here.reached_at(placed, fixed)
        if not isinstance(reached, Reached):
            return reached
        trouble = self._late(placed, reached)
        if trouble is not None:
            return trouble
        if not reached.transfer.clear and (fixed is None or reached.transfer.met is not None):
            freer = later(self._here.reached, placed, reached.shot.leg.start)
            if fixed is None:
                reached = freer or reached
            if reached.transfer.met is not None:
                return Meets(reached.transfer.met, None if freer is None else freer.shot.leg.start)
        self._add(reached)
        return None

    def _add(self, reached: Reached) -> None:
        """Add a shot on its own clock and the transfer to it."""
        self.last = _Last(reached, self._state())
        if reached.cut is not None:
            self.legs[-1], self.last = reached.cut, None
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
        first = self._here.put_off(placed, up(fixed))
        if isinstance(first, OutsideTrack):
            return self._too_late(reached, reached, first)
        if not isinstance(first, Reached):
            return first
        if first.late <= LATE_S:
            first = self._here.sooner(placed, fixed, first)
        short = outside(self.mission, placed, first.shot.leg.start) if first.late <= LATE_S else None
        return self._too_late(reached, first, short)

    def _too_late(self, requested: Reached, first: Reached, short: OutsideTrack | None) -> TooLate:
        """Return the failure of a shot that the drone reaches too late; arguments as of ``too_late``."""
        flown = self.legs if first.cut is None else [*self.legs[:-1], first.cut]
        path = TimedPath(self.drone.name, (*flown, *first.transfer.legs, first.shot.leg))
        return too_late(flight(self.mission, path, dict(self.ends)).phases, requested, first, short)

    def _take(self, transfer: Transfer) -> None:
        self.slack = transfer.slack
        self.legs += transfer.legs
        self.clock = transfer.end
