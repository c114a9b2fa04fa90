"""Refines every shot of a path that is on its own clock, and reports on it."""

from __future__ import annotations

from dataclasses import replace
from math import isfinite
from typing import NamedTuple

import numpy as np

from shotc.plugin_api import (
    Diagnostic,
    PathIR,
    SolverState,
    unrefined,
)
from shotc.plugin_api.refiner import (
    CALM,
    SIGHT,
    ClockDeviation,
    ClockLeg,
    TimedPath,
    given_up,
    ideal_places,
    least_out,
    placed_at,
    prefers_free_pictures,
    worst_of_runs,
)
from shotc_casadi.clock.lens import zoomed
from shotc_casadi.clock.proof import UnprovedMoment
from shotc_casadi.clock.references import ClockSubject
from shotc_casadi.clock.rounds import ClockRefined, refine_clock
from shotc_casadi.clock.shown import as_whole, held_whole, keeps_promises, no_less, past_occluders
from shotc_casadi.messages import UNITS, fallen_back, stats, unsolved
from shotc_casadi.solving import MOTION

NOTICE_M, LEFT_M = 0.5, 0.1  # metres off the ideal: peaks that are reported, and the places around them
STEP_S = 0.1  # seconds between the places that are compared with the ideal
KEPT = "kept: the guide shows more"
GUIDE_BETTER = "its guide films the subject as well or better by what the refiner measures"
SHOWS_LESS = "its guide shows more of its subjects"
IN_PICTURE = "on the refined path a drone would come into another's picture"
OUT_M = 0.05  # metres or rad: a smaller distance from a picture may be an error of its samples
WHOLE = "the whole subject in the frame, and the drone's limits"
SAME_S = 2.0  # seconds: a deviation this close to one of the guide has the same cause


def refine_one(
    path: PathIR, shot: str, name: str, *, keeps_whole: bool = True
) -> tuple[PathIR, list[Diagnostic]]:
    """Return the path with one shot on its own clock refined, and its diagnostics.

    keeps_whole : whether the position changes if its single subject is not whole in the frame
    """
    subject = subject_of(path, shot)
    unseen = given_up(path.stats, shot) is None
    tried = _tried(path, subject, name, unseen=unseen, keeps_whole=keeps_whole)
    if tried.given_up and prefers_free_pictures(subject.mission):
        # A preference is no reason to leave a shot as it is, nor to break what it promises.
        leg = tried.refined.leg
        if leg is None or not keeps_promises(subject, leg):
            tried = _tried(path, subject, name, unseen=False, keeps_whole=keeps_whole)
    message = tried.said
    if message is None and tried.refined.leg is None:
        message = unrefined(path, shot, tried.why)
    stats = (*tried.path.stats, *_stats(tried.refined))
    return replace(tried.path, stats=stats), [] if message is None else [message]


class _RefinedShot(NamedTuple):
    """A shot refined: the path with it, or why it does not change.

    said : a diagnostic of its solver; given_up : whether a better refinement is not used because it would
        come into a picture
    """

    refined: ClockRefined
    path: PathIR
    why: str
    said: Diagnostic | None
    given_up: bool


def _tried(
    path: PathIR, subject: ClockSubject, name: str, *, unseen: bool, keeps_whole: bool
) -> _RefinedShot:
    """Return a shot refined; unseen : whether it has to keep the drones' pictures free."""
    refined = refine_clock(subject, unseen=unseen)
    message = _report(path, subject, refined, name)
    refined = _zoomed(subject, refined)
    whole = held_whole(subject, refined, unseen=unseen) if keeps_whole else None
    new, why = refined.leg, GUIDE_BETTER
    if new is not None and not no_less(subject, subject.leg, new):
        refined, why = replace(refined, leg=None), SHOWS_LESS
    freed = past_occluders(subject, whole or refined, unseen=unseen)
    freed, whole = (None if one is None else _zoomed(subject, one) for one in (freed, whole))
    reasons = ((freed, SIGHT), (whole, WHOLE), (refined, CALM))
    first = next((one for one, _ in reasons if one is not None and one.leg is not None), None)
    taken, moved = _first_flyable(path, reasons, unseen=unseen)
    given_up = taken is not first
    return _RefinedShot(
        taken or replace(refined, leg=None), moved, IN_PICTURE if given_up else why, message, given_up
    )


def _zoomed(subject: ClockSubject, refined: ClockRefined) -> ClockRefined:
    """Return a refinement with a lens that zooms, if this gains something and shows no less."""
    before = refined.leg or subject.leg
    leg = zoomed(subject, before)
    if leg is None or not as_whole(subject, before, leg):
        return refined
    return replace(refined, leg=leg)


def _first_flyable(
    path: PathIR, candidates: tuple[tuple[ClockRefined | None, str], ...], *, unseen: bool
) -> tuple[ClockRefined | None, PathIR]:
    """Return the first of a shot's refinements that may be flown, and the path with it.

    candidates : each with the reason why it leaves its ideal place
    unseen : whether it has to stay out of the drones' pictures, or at least come no deeper into them
    """
    for one, why in candidates:
        if one is None or one.leg is None:
            continue
        moved = with_leg(path, one.leg, why)
        if not unseen or least_out(moved) >= min(OUT_M, least_out(path)):
            return one, moved
    return None, path


def subject_of(path: PathIR, shot: str) -> ClockSubject:
    """Return a shot of a path that is on its own clock."""
    mission = path.keyframes.mission
    (placed,) = (p for p in path.keyframes.shots if p.shot.id == shot)
    legs = [leg for flown in path.timed for leg in flown.legs if isinstance(leg, ClockLeg)]
    (leg,) = (leg for leg in legs if leg.shot == shot)
    begun = placed_at(mission, placed, leg.start)
    return ClockSubject(path, mission.drone(placed.shot.drone), begun, leg)


def with_leg(path: PathIR, leg: ClockLeg, why: str) -> PathIR:
    """Return the path with another leg for a shot, and the deviations of that leg from its ideal.

    why : the cause of a deviation that is not one of the guide's
    """
    timed = tuple(
        TimedPath(
            flown.drone,
            tuple(leg if isinstance(old, ClockLeg) and old.shot == leg.shot else old for old in flown.legs),
        )
        for flown in path.timed
    )
    moved = replace(path, timed=timed)
    others = tuple(d for d in path.deviations if d.shot != leg.shot)
    mine = tuple(d for d in path.deviations if d.shot == leg.shot and isinstance(d, ClockDeviation))
    return replace(moved, deviations=(*others, *_deviations(subject_of(moved, leg.shot), mine, why)))


def _deviations(
    subject: ClockSubject, before: tuple[ClockDeviation, ...], why: str
) -> tuple[ClockDeviation, ...]:
    """Return the peak of every deviation from the ideal; the nearest one of the guide gives the cause."""
    leg = subject.leg
    t = np.append(np.arange(leg.start, leg.end, STEP_S), leg.end)
    ideal = ideal_places(subject.mission, subject.placed.shot, leg.start, t)
    deviation = np.linalg.norm(leg.curve(t)[:, :3] - ideal, axis=1)
    return tuple(
        ClockDeviation(leg.shot, float(deviation[k]), float(t[k]), _cause(before, float(t[k]), why))
        for k in worst_of_runs(deviation, LEFT_M, NOTICE_M)
    )


def _cause(before: tuple[ClockDeviation, ...], t: float, why: str) -> str:
    near = [d for d in before if why == CALM or abs(d.t - t) <= SAME_S]
    return min(near, key=lambda d: abs(d.t - t)).cause if near else why


def _report(path: PathIR, subject: ClockSubject, refined: ClockRefined, name: str) -> Diagnostic | None:
    """Return the diagnostic about one shot's solver, None if there is none."""
    solution = refined.solution
    if refined.leg is not None:
        return fallen_back(path, refined.shot, refined.first, solution)
    if refined.gap is None and solution.status == "solved":
        return None
    return unsolved(path, _state(subject, refined, name), solution)


def _state(subject: ClockSubject, refined: ClockRefined, name: str) -> SolverState:
    """Return the state of the problem of a shot that is not refined; name : of the refiner."""
    worst, breaks = refined.gap or _worst(refined), refined.breaks
    known = bool(worst.what) and isfinite(worst.lack)
    return SolverState(
        shot=refined.shot,
        refiner=name,
        solver=refined.solution.solver,
        stage=int(np.searchsorted(breaks, worst.time)) if known else None,
        stages=len(breaks) - 1,
        s=worst.time,
        time=worst.time - subject.leg.start,
        constraint=worst.what,
        excess=worst.lack,
        unit=worst.unit,
        inner=worst.what == MOTION,
    )


def _worst(refined: ClockRefined) -> UnprovedMoment:
    """Return the constraint that the solver violates most; its name is "" if it violates none."""
    solution = refined.solution
    what = solution.constraint
    return UnprovedMoment(float(refined.breaks[solution.stage]), what, solution.residual, UNITS.get(what, ""))


def _stats(refined: ClockRefined) -> tuple[tuple[str, float | str], ...]:
    solution, shot = refined.solution, refined.shot
    kept = refined.leg is None and refined.gap is None and solution.status == "solved"
    costs = () if refined.costs is None else refined.costs
    return (
        *((f"{shot}.{which}_cost", cost) for which, cost in zip(("refine", "guide"), costs, strict=False)),
        *stats(shot, refined.rounds, solution, KEPT if kept else None),
    )
