"""Run-ups to a shot on its own clock from where the drone is, so that it does not stop on the way.

Such a run-up begins at rest where the last leg ended, or else in the run-out of the film before it.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from shotc.geom.bernstein import Piecewise, state_at
from shotc.ir.drone import Drone
from shotc.ir.mission import MissionIR
from shotc.ir.path import HFOV, ClockLeg, Leg
from shotc.planning.clock.aims import CameraTask
from shotc.planning.clock.ends import EndRequirement
from shotc.planning.clock.preferred import cost
from shotc.planning.clock.run_up import Departure
from shotc.planning.clock.starts import ROUNDING_S, SLIGHT_M, Reached, ReachFrom

TURN_TRIES = 3  # departures that are tried until the turn before them is known
SPARE_SHARE = 0.05  # of a turn's time, by which the next departure is later: another one has another turn
SHORTEST_S = 1.0  # least seconds of a way to a film
SAME_RAD = 1e-9  # rad


def without_stop(
    mission: MissionIR, drone: Drone, late: Reached, reach: ReachFrom, departures: Iterator[Departure]
) -> Reached | None:
    """Return a shot that is late with the first of some departures that brings the drone there in time.

    A departure is refused if the run-up lacks clearances of transfers, or if the film differs by more than a
    preference may cost. Where the author gave the place, the film may not differ.

    reach : plans the shot and the transfer to it, which then only turns the drone
    """
    camera_task, leg = CameraTask(mission, drone, late.placed.subjects), late.shot.leg
    ideal = late.placed.shot.ideal

    def good(reached: Reached) -> bool:
        if ideal is not None and ideal.placed:
            return reached.shot.off - late.shot.off <= SLIGHT_M
        return cost(camera_task, (leg.start, leg.end), leg.curve, reached.shot.leg.curve).little

    found = (_in_time(late, reach, departure) for departure in departures)
    return next((reached for reached in found if reached is not None and good(reached)), None)


def _in_time(late: Reached, reach: ReachFrom, departure: Departure) -> Reached | None:
    """Return the shot with a run-up that begins at a departure, or later if the drone has to turn first."""
    for _ in range(TURN_TRIES):
        if late.shot.leg.start - departure.time < SHORTEST_S:
            return None
        reached = reach((EndRequirement(0.0, 1.0, begins=departure),))
        if not isinstance(reached, Reached) or reached.transfer.met is not None:
            return None
        if max(reached.shot.lacks) > max(SLIGHT_M, *late.shot.lacks):
            return None
        if reached.late <= ROUNDING_S:
            return replace(reached, cut=departure.cut)
        # The turn towards the first pose takes that long.
        later_by = (1.0 + SPARE_SHARE) * reached.late + ROUNDING_S
        departure = replace(departure, time=departure.time + later_by)
    return None


def departures(here: Departure, legs: Sequence[Leg], then: ClockLeg) -> Iterator[Departure]:
    """Yield where a run-up may begin: where the drone is at rest, then in the run-out of the last film.

    Of that run-out one piece is left. Nothing is yielded for it if the lens changes between the two films.

    legs : flown so far; then : the next film
    """
    yield here
    last = legs[-1] if legs else None
    if not isinstance(last, ClockLeg):
        return
    pieces = int(np.searchsorted(last.curve.breaks, last.end + ROUNDING_S))
    cut = replace(last, curve=Piecewise(last.curve.breaks[: pieces + 1], last.curve.ctrl[:pieces]))
    zooms = abs(cut.end_pose[HFOV] - then.pose[HFOV]) > SAME_RAD
    if not zooms:
        end = float(cut.curve.end)
        state = state_at(cut.curve, end)
        yield Departure(end, state[:, :3], state[:, 3:HFOV], cut)
