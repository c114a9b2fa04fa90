"""The approach of a drone to its next shot: the transfers from where it is, and the shot at its end."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import numpy as np

from shotc.ir.drone import Drone
from shotc.ir.keyframes import PlacedShot
from shotc.ir.mission import MissionIR
from shotc.ir.path import Leg, MovingLeg, Pose
from shotc.planning.clock.aims import CameraTask
from shotc.planning.clock.departure import NextLeg, Transfer, When, choose
from shotc.planning.clock.detours import Meanwhile, Transit, ways_to
from shotc.planning.clock.ends import ASIDES, END_REQUIREMENTS, FROM_AFAR, EndRequirement, leading_aside
from shotc.planning.clock.flights import LATE_S
from shotc.planning.clock.run_up import Departure, way_time
from shotc.planning.clock.shot import NoMotion, OtherVehicles, timed_shot
from shotc.planning.clock.starts import (
    CLOSE_S,
    SLIGHT_M,
    ClockFailure,
    Lateness,
    Reached,
    outside,
    put_off,
    straight_lateness,
)
from shotc.planning.clock.without_stop import departures, without_stop
from shotc.planning.path.legs import LegContext, end_of, nearest, take_off, turned, way_to
from shotc.planning.path.shots import Failure, PlannedShot
from shotc.planning.timing.timed_leg import leg_time
from shotc.rounding import up

AMPLE_RATIO = 1.5  # time that a transfer without a deadline may take, over its direct duration
START_BISECTIONS = 5  # tries of an earlier start without a stop


@dataclass(frozen=True, slots=True, eq=False)
class Approach:
    """A drone where it is, from where it goes to its next shot.

    legs : flown so far; it is at the end of the last one, or on its pad
    clock : mission time there, seconds
    """

    mission: MissionIR
    flight: LegContext
    others: OtherVehicles
    legs: tuple[Leg, ...]
    clock: float

    @property
    def drone(self) -> Drone:
        """The drone that flies."""
        return self.flight.drone

    def meanwhile(self, direct: list[MovingLeg], deadline: float | None) -> Meanwhile:
        """Return the other vehicles during a transfer.

        direct : legs that take about as long
        deadline : of the arrival, if there is one
        """
        end = deadline
        if end is None:
            end = self.clock + AMPLE_RATIO * sum(leg_time(self.drone, leg) for leg in direct)
        return Meanwhile(self.others, (self.clock, max(self.clock, end)))

    def transfer(
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
        transits = ways_to(transit, (lift, goal), direct, self.meanwhile([*lift, *direct], deadline))
        transfer = choose(self.mission, self.drone, self.others, transits, When(self.clock, deadline), then)
        assert transfer is not None
        return transfer

    def reached(self, placed: PlacedShot, start: float) -> Reached | ClockFailure:
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
        near = self.reached_as(placed, start, END_REQUIREMENTS)
        if isinstance(near, NoMotion) and near.missed is None:
            asides = (self.reached_as(placed, start, aside) for aside in ASIDES)
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
            far = self.reached_as(near.placed, near.shot.leg.start, requirements)
            if isinstance(far, Reached) and far.better(best):
                best = far
        return best

    def reached_as(
        self, placed: PlacedShot, start: float, requirements: tuple[EndRequirement, ...]
    ) -> Reached | ClockFailure:
        """Plan a shot and the transfer to it, with given requirements on the shot's ends."""
        camera_task = CameraTask(self.mission, self.drone, placed.subjects)
        shot = timed_shot(camera_task, (self.flight.spaces, self.others), placed, start, requirements)
        if isinstance(shot, NoMotion):
            return shot
        curve_start, begins = float(shot.leg.curve.start), requirements[0].begins
        if begins is not None and begins.cut is not None:  # it goes on from the film before
            return Reached(placed, shot, Transfer((), curve_start), 0.0, (False, False))
        transfer = self.transfer(shot.leg.pose, placed, curve_start)
        if not isinstance(transfer, Transfer):
            return transfer
        return Reached(placed, shot, transfer, transfer.end - curve_start, requirements[0].ends_aside)

    def reached_at(self, placed: PlacedShot, start: float) -> Reached | ClockFailure:
        """Plan a shot for a fixed start: as ``reached``, but without a stop where it would be late."""
        found = self.reached(placed, start)
        if isinstance(found, Reached) and found.late > LATE_S:
            return self._without_stop(found) or found
        return found

    def _without_stop(self, late: Reached) -> Reached | None:
        """Return a shot that is late, with a run-up from where the drone is, if it is in time then."""
        lift = [] if self.legs else [take_off(self.flight, late.shot.leg.pose)]
        ready = self.clock + sum(leg_time(self.drone, leg) for leg in lift)
        here = Departure.at_rest(np.array(end_of(lift or self.legs)[:3]), ready)
        reach = partial(self.reached_as, late.placed, late.shot.leg.start)
        return without_stop(self.mission, self.drone, late, reach, departures(here, self.legs, late.shot.leg))

    def sooner(self, placed: PlacedShot, late: float, there: Reached) -> Reached:
        """Return a shot at an earlier start than that of ``there``, if the drone reaches one without a stop.

        late : a start at which it is late
        """
        for _ in range(START_BISECTIONS):
            start = up(0.5 * (late + there.shot.leg.start))
            if start > there.shot.leg.start - CLOSE_S:
                break
            found = self.reached_at(placed, start)
            if isinstance(found, Reached) and found.late <= LATE_S and found.transfer.met is None:
                there = found
            else:
                late = start
        return there

    def put_off(self, placed: PlacedShot, start: float) -> Reached | ClockFailure:
        """Plan a shot for the first start, from a given one on, that the drone reaches in time."""
        reached = put_off(self.mission, self._with_plain_ends, placed, start, self._about(placed))
        return self._with_better_ends(reached) if isinstance(reached, Reached) else reached

    def _about(self, placed: PlacedShot) -> Lateness:
        """Return an estimate of the seconds by which a straight flight to a shot is late."""
        here, ready = np.array(end_of(self.legs)[:3] if self.legs else self.flight.top), self.clock
        if not self.legs:
            ready += way_time(self.drone.limits, here - np.array(self.drone.home))
        return straight_lateness(self.mission, self.drone, placed.shot, here, ready)
