"""What a motion shows of its subject, frame by frame: what a shot that looks past something is taken by."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from shotc.refiner_api import DroneTrajectory, TimedLeg, flights, others_of, seen
from shotc_casadi.clock.rounds import ClockRefined, refine_clock
from shotc_casadi.clock.screens import screens_of
from shotc_casadi.clock.wishes import ClockSubject

RATE = 25.0  # frames a second that are looked at
GAIN = 0.005  # of the frames: showing less more than that is not worth going aside for
SLACK = 1e-4  # of a size, of half a frame, of the frames: as good


class Shown(NamedTuple):
    """Shares of the frames in which the subject is hidden, and is not whole; its least and largest size.

    off : its largest distance from its place on screen, half frames
    """

    hidden: float
    cropped: float
    smallest: float
    largest: float
    off: float


def past_what_hides(subject: ClockSubject, plain: ClockRefined) -> ClockRefined | None:
    """Return a shot refined so that more of its subject is seen than it is in a plain refinement, or None.

    Where the author gave the places they stay; what the shot promises is kept, or is broken no further.
    """
    ideal = subject.placed.shot.ideal
    failed = plain.solution.status != "solved" or plain.gap is not None
    if failed or subject.watched is None or ideal is None or ideal.placed:
        return None
    before = shown(subject, plain.leg or subject.leg)
    if before.hidden <= GAIN:
        return None
    found = refine_clock(subject, screens_of(subject, plain.breaks))
    if found.leg is None:
        return None
    after = shown(subject, found.leg)
    better = after.hidden < before.hidden - GAIN and after.cropped <= before.cropped + SLACK
    return found if better and _promised(subject, before, after) else None


def shown(subject: ClockSubject, leg: TimedLeg) -> Shown:
    """Return what a leg shows of the subject of its shot in the film."""
    assert subject.watched is not None
    t = np.linspace(leg.start, leg.end, max(2, int(RATE * (leg.end - leg.start))))
    flight = DroneTrajectory(subject.drone.name, leg.curve, (), (), ())
    others = others_of(tuple(flights(subject.path).values()), subject.drone.name)
    frames = seen(subject.mission, flight, subject.watched.target, t, others)
    u, v = subject.watched.reference or (0.0, 0.0)
    off = np.nan_to_num(np.hypot(frames.u - u, frames.v - v), nan=np.inf)
    return Shown(
        float(frames.hidden.mean()),
        float(1.0 - frames.in_frame.mean()),
        float(np.nan_to_num(frames.size, nan=np.inf).min()),
        float(np.nan_to_num(frames.size, nan=np.inf).max()),
        float(off.max()),
    )


def _promised(subject: ClockSubject, before: Shown, after: Shown) -> bool:
    """Tell whether all that a shot promises is kept, or is as it was."""
    promise = subject.placed.shot.promise
    held = [True]
    if promise.size is not None:
        low, high = promise.size
        held.append(after.smallest >= min(low + SLACK, before.smallest))
        held.append(after.largest <= max(high - SLACK, before.largest))
    if promise.screen_error is not None:
        held.append(after.off <= max(promise.screen_error - SLACK, before.off))
    if promise.in_frame is not None:
        held.append(after.cropped <= max(1.0 - promise.in_frame - SLACK, before.cropped))
    return all(held)
