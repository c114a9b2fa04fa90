"""The ends of a shot on its own clock: what is required of its run-up and run-out, and the two themselves."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.sampling import directions
from shotc.geom.solid_arrays.points import distances
from shotc.ir.drone import Drone
from shotc.ir.mission import Shot
from shotc.planning.clock.aims import CameraTask
from shotc.planning.clock.moving import COMFORT_M, Moving
from shotc.planning.clock.run_up import Departure, Link, RunUp, run_ups
from shotc.planning.free_space import MARGIN_M, FreeSpace, bounds_slack

MOST_ASIDES = 2  # searches for a place of rest aside
LONG_S = 20.0  # seconds before or after a film in which nothing comes near
STEP_S = 0.1  # seconds between samples of a rest
FARTHEST_M, RING_M = 15.0, 1.0  # metres, largest shift and distance of rings
PLACES_ON_RING = 16  # places on a ring
RISES_RAD = (0.0, 0.5, 1.0)  # rad, elevations of the rings, besides straight up


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
) -> tuple[RunUp | Link, RunUp]:
    """Return the run-up and the run-out that meet a requirement; around : obstacles and the free space."""
    end = start + (shot.timing.duration or 0.0)
    before, after = (
        run_up.lasting(required.longer)
        for run_up in run_ups(camera_task.mission, camera_task.drone, shot, start)
    )
    if required.ends_aside[0]:
        before = _led(before, -1.0, start, around, camera_task.drone)
    if required.ends_aside[1]:
        after = _led(after, 1.0, end, around, camera_task.drone)
    return before if required.begins is None else before.begun(required.begins, start), after


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


def shift_beside_traffic(
    near: Sequence[Moving], space: FreeSpace, rest: Array, span: tuple[float, float]
) -> Array:
    """Return the shortest shift of a place of rest to where nothing passes, (3,); zero if none is found.

    By default the drone rests where its run-up or run-out goes straight on. Beside a subject that follows the
    camera the subject is there some seconds earlier or later, so the drone rests aside of it.

    near : obstacles, standing and moving
    space : free space of the drone
    rest : place in W, shape (3,), metres
    span : start and end of the rest, mission times, seconds
    """
    times = np.arange(span[0], span[1] + STEP_S, STEP_S)
    tracks = [(what, what.at(times)) for what in near]
    for ring in np.arange(0.0, FARTHEST_M + RING_M, RING_M):
        shifts = ring * directions(PLACES_ON_RING, RISES_RAD) if ring else np.zeros((1, 3))
        places = rest + shifts
        fine = bounds_slack(space, places) >= MARGIN_M
        for what, at in tracks:
            needs = max(what.apart, what.clearance) + COMFORT_M
            clear = distances(what.part, (places[:, None] - at[None]).reshape(-1, 3))
            fine &= clear.reshape(len(places), -1).min(axis=1) >= needs
        if fine.any():
            return np.asarray(shifts[int(fine.argmax())])
    return np.zeros(3)
