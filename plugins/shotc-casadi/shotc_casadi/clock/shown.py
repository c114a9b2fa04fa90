"""What a motion shows of its subject, frame by frame; the measure for shots that look past occluders."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from math import inf
from typing import NamedTuple

import numpy as np

from shotc.plugin_api.refiner import (
    Array,
    ClockLeg,
    DroneTrajectory,
    PlacedSubject,
    coverage,
    flights,
    keeps_a_place,
    others_of,
    projected,
    wanted_places,
)
from shotc_casadi.clock.occluders import farthest_past, occluders_of
from shotc_casadi.clock.references import ClockSubject, filmed_at, references_at
from shotc_casadi.clock.rounds import ClockRefined, refine_clock
from shotc_casadi.covered import GAIN_SHARE, UncoveredShare, broken, free_of, lost

RATE_HZ = 25.0  # frames a second that are evaluated
SLACK_SHARE = 1e-4  # tolerance, of a size, of half a frame, of the number of frames


class SubjectVisibility(NamedTuple):
    """What a leg shows of a subject.

    free : free share of its outline
    cropped : share of the frames in which it is not whole
    smallest, largest : its sizes
    off : its largest distance from its place on screen, half frames
    """

    free: UncoveredShare
    cropped: float
    smallest: float
    largest: float
    off: float


FLAWLESS = SubjectVisibility(UncoveredShare(), 0.0, inf, 0.0, 0.0)
"""With what is shown so no promise is broken."""


def past_occluders(subject: ClockSubject, plain: ClockRefined, *, unseen: bool = True) -> ClockRefined | None:
    """Return a shot refined so that its subjects are less hidden than in a plain refinement, or None.

    If the author gave the places, or keyframes hold the camera in one, the result is None. A promise of the
    shot is kept, or at least broken no further.

    unseen : as in ``refine_clock``
    """
    shot, ideal = subject.placed.shot, subject.placed.shot.ideal
    failed = plain.solution.status != "solved" or plain.gap is not None
    if failed or subject.watched is None or ideal is None or ideal.placed or keeps_a_place(shot):
        return None
    before = plain.leg or subject.leg
    if _covered(subject, before) <= GAIN_SHARE:
        return None
    occluders = occluders_of(subject, plain.breaks)
    freed = refine_clock(subject, occluders, unseen=unseen)
    if freed.leg is not None and _too_far(subject, freed.leg, freed.breaks):
        # Only now, since the bound makes some motions end on the side where the subject is hidden.
        freed = refine_clock(subject, occluders, unseen=unseen, bounded=True)
    if freed.leg is None:
        return None
    better = _covered(subject, freed.leg) < _covered(subject, before) - GAIN_SHARE
    return freed if better and as_whole(subject, before, freed.leg) else None


def _too_far(subject: ClockSubject, leg: ClockLeg, breaks: Array) -> bool:
    """Return whether a camera goes farther from its ideal place than verification accepts."""
    references, filmed = references_at(subject, breaks), filmed_at(leg, breaks)
    off = np.linalg.norm(leg.curve(breaks)[:, :3] - references.ideal, axis=1)
    return bool(off[filmed].max() > farthest_past(references, filmed))


def held_whole(subject: ClockSubject, plain: ClockRefined, *, unseen: bool = True) -> ClockRefined | None:
    """Return a shot refined so that its subject is whole in more frames than in a plain one, or None.

    The camera with its gimbal is then part of the problem. So the position changes where the camera cannot
    follow or the subject does not fit.

    unseen : as in ``refine_clock``
    """
    ideal, failed = subject.placed.shot.ideal, plain.solution.status != "solved" or plain.gap is not None
    follows = subject.watched is not None and subject.camera_task.keyed is None and not subject.together
    if failed or not follows or ideal is None or ideal.placed or cropped_on_purpose(subject.framed[0]):
        return None
    before = plain.leg or subject.leg
    if visibility_of(subject, before).cropped <= SLACK_SHARE:
        return None
    refined = refine_clock(replace(subject, held_whole=True), unseen=unseen)
    if refined.leg is None:
        return None
    fewer = visibility_of(subject, refined.leg).cropped < visibility_of(subject, before).cropped - SLACK_SHARE
    return refined if fewer and as_whole(subject, before, refined.leg) else None


def cropped_on_purpose(one: PlacedSubject) -> bool:
    """Return whether the size asked for a subject is too large for the whole of it."""
    sizes = (one.size, *(setpoint.size for setpoint in one.setpoints))
    return any(size is not None and size > 1.0 for size in sizes)


def no_less(subject: ClockSubject, before: ClockLeg, after: ClockLeg) -> bool:
    """Return whether a leg shows as much of all subjects as another one, and keeps as many promises."""
    gained = _covered(subject, after) <= _covered(subject, before) + GAIN_SHARE
    return gained and as_whole(subject, before, after)


def as_whole(subject: ClockSubject, before: ClockLeg, after: ClockLeg) -> bool:
    """Return whether no subject is cropped in more frames than before, and promises are as well kept.

    A single subject must also not be hidden more than before, in what is reported of it, unless the shot
    keeps a promise only then. Of several subjects, one may be hidden for another.
    """
    corrects = keeps_promises(subject, after) and not keeps_promises(subject, before)
    against = lost if len(subject.framed) == 1 and not corrects else broken
    for which in range(len(subject.framed)):
        old, new = visibility_of(subject, before, which), visibility_of(subject, after, which)
        if new.cropped > old.cropped + SLACK_SHARE or not _promised(subject, old, new):
            return False
        if against(subject.placed, old.free, new.free) > 0.0:
            return False
    return True


def keeps_promises(subject: ClockSubject, leg: ClockLeg) -> bool:
    """Return whether a leg keeps the promises of its shot for all subjects."""
    every = (visibility_of(subject, leg, which) for which in range(len(subject.framed)))
    return all(_promised(subject, FLAWLESS, one) for one in every)


def _covered(subject: ClockSubject, leg: ClockLeg) -> float:
    """Return the mean covered share of the outline over the frames, summed over all subjects."""
    return sum(1.0 - visibility_of(subject, leg, which).free.mean for which in range(len(subject.framed)))


@lru_cache(maxsize=8)  # several rules compare a guide with its refinement
def visibility_of(subject: ClockSubject, leg: ClockLeg, which: int = 0) -> SubjectVisibility:
    """Return what a leg shows of one of the subjects of its shot in the film."""
    one = subject.framed[which]
    t = np.linspace(leg.start, leg.end, max(2, int(RATE_HZ * (leg.end - leg.start))))
    flight = DroneTrajectory(subject.drone.name, leg.curve, (), (), ())
    others = others_of(tuple(flights(subject.path).values()), subject.drone.name)
    frames = projected(subject.mission, flight, one.target, t)
    covered = coverage(subject.mission, others, one.target, leg.curve(t)[:, :3], t).share
    u, v = wanted_places(one, leg.start, t).T
    off = np.nan_to_num(np.hypot(frames.u - u, frames.v - v), nan=np.inf)
    return SubjectVisibility(
        free_of(covered),
        float(1.0 - frames.in_frame.mean()),
        float(np.nan_to_num(frames.size, nan=np.inf).min()),
        float(np.nan_to_num(frames.size, nan=np.inf).max()),
        float(off.max()),
    )


def _promised(subject: ClockSubject, before: SubjectVisibility, after: SubjectVisibility) -> bool:
    """Return whether each promise of a shot is kept, or broken no further than before."""
    promise = subject.placed.shot.promise
    held = [True]
    if promise.size is not None:
        low, high = promise.size
        held.append(after.smallest >= min(low + SLACK_SHARE, before.smallest))
        held.append(after.largest <= max(high - SLACK_SHARE, before.largest))
    if promise.screen_error is not None:
        held.append(after.off <= max(promise.screen_error - SLACK_SHARE, before.off))
    if promise.in_frame is not None:
        held.append(after.cropped <= max(1.0 - promise.in_frame - SLACK_SHARE, before.cropped))
    return all(held)
