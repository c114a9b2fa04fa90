"""The ends of a shot on its own clock: what is required of its run-up and run-out, and the two themselves."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from shotc.geom.vec import Vec3
from shotc.ir.drone import Drone
from shotc.ir.mission import Shot
from shotc.planning.clock.aims import CameraTask
from shotc.planning.clock.moving import Moving
from shotc.planning.clock.resting import LONG_S, shift_beside_traffic
from shotc.planning.clock.run_up import RunUp, run_ups
from shotc.planning.free_space import FreeSpace

MOST_ASIDES = 2  # searches for a place of rest aside


class Departure(NamedTuple):
    """Where and when a run-up begins: a place in W, metres, and a mission time, seconds."""

    place: Vec3
    time: float


class EndRequirement(NamedTuple):
    """Requirements on the ends of a motion.

    stand : seconds that the drone may stand there with all clearances
    longer : durations of run-up and run-out over the least ones
    ends_aside : whether the run-up and the run-out lead to where nothing passes
    begins : the beginning of the run-up; None if it is free
    """

    stand: float
    longer: float
    ends_aside: tuple[bool, bool] = (False, False)
    begins: Departure | None = None


END_REQUIREMENTS = (
    EndRequirement(3.0, 1.0),
    EndRequirement(1.0, 1.0),
    EndRequirement(0.0, 1.0),
    EndRequirement(0.0, 2.0),
)
"""Requirements from strict to weak; the first feasible ones are used."""
FROM_AFAR = (EndRequirement(3.0, 2.0), EndRequirement(0.0, 2.0), EndRequirement(0.0, 3.0))
"""The same where no transfer leads to the start of such a motion: it begins farther off."""


def leading_aside(before: bool, after: bool) -> tuple[EndRequirement, ...]:
    """Return requirements with rest away from moving obstacles: before the film, after it, or both."""
    if not (before or after):
        return END_REQUIREMENTS
    return tuple(
        EndRequirement(stand, longer, (before, after))
        for stand, longer in ((3.0, 1.0), (0.0, 1.0), (0.0, 2.0))
    )


ASIDES = tuple(leading_aside(*ends) for ends in ((False, True), (True, False), (True, True)))
"""Requirements that are tried where there is no motion with straight ends."""


def run_up_and_out(
    camera_task: CameraTask,
    shot: Shot,
    start: float,
    required: EndRequirement,
    around: tuple[tuple[Moving, ...], FreeSpace],
) -> tuple[RunUp, RunUp]:
    """Return the run-up and the run-out that meet a requirement; around : obstacles and the free space."""
    end = start + (shot.timing.duration or 0.0)
    before, after = (
        run_up.lasting(required.longer)
        for run_up in run_ups(camera_task.mission, camera_task.drone, shot, start)
    )
    if required.begins is not None:
        before = before.begun(np.array(required.begins.place), start - required.begins.time)
    if required.ends_aside[0]:
        before = _led(before, -1.0, start, around, camera_task.drone)
    if required.ends_aside[1]:
        after = _led(after, 1.0, end, around, camera_task.drone)
    return before, after


def _led(
    run_up: RunUp, sign: float, film: float, around: tuple[tuple[Moving, ...], FreeSpace], drone: Drone
) -> RunUp:
    """Return a run-up (sign -1) or a run-out (sign 1) shifted to where nothing passes its place of rest."""
    led = run_up
    for _ in range(MOST_ASIDES):  # a longer shift takes longer, which moves the straight end
        rest = film + sign * led.seconds
        straight = led.at(np.array([sign * led.seconds]))[0] - led.shift
        # The span includes the run-up, because an obstacle that passes then would meet the drone.
        span = (rest - LONG_S, film) if sign < 0.0 else (film, rest + LONG_S)
        led = run_up.led(shift_beside_traffic(*around, straight, span), drone.limits)
    return led
