"""Refines a shot on its own clock in rounds: solve, prove at every instant, update the surroundings.

The rounds end when the cost does not improve any more. Then the camera is computed.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial
from math import inf
from typing import NamedTuple

from shotc.plugin_api import Piecewise
from shotc.plugin_api.refiner import (
    Array,
    ClockLeg,
    HalfSpaces,
    Mask,
    Surroundings,
    restrict,
    surroundings,
)
from shotc_casadi.clock.bodies import MovingEllipsoid, acts_anew, bodies_of, kept_from
from shotc_casadi.clock.curve import curve_of, filmed
from shotc_casadi.clock.gain_bound import gain_bound
from shotc_casadi.clock.guess import guess_past
from shotc_casadi.clock.occluders import Occluder, hides_anew, with_occluders
from shotc_casadi.clock.problem import ClockProblem, Use, breaks_of, guess, problem
from shotc_casadi.clock.program import cost, solve
from shotc_casadi.clock.proof import UnprovedMoment, astray, gap_in
from shotc_casadi.clock.references import ClockReferences, ClockSubject, filmed_at, references_at
from shotc_casadi.clock.several import turned
from shotc_casadi.clock.side import Overflight, guess_to_side, held, passes
from shotc_casadi.solving import SOLVERS, Solution, by_one_of

MOST_ROUNDS = 6
REACH_M = 8.0  # an obstacle counts up to this far beyond its clearance, metres
ROOM_SHARE = 0.5  # share of the room beside a wall that is kept
NEARLY_SHARE = 0.998  # share of each limit that is used, so that rounding breaks none
ALLOWED_RAD = 0.01  # rad: a camera may miss its reference by this, or by as much as its guide does
FIRST = Use(NEARLY_SHARE)
NARROWER_SHARE = 0.1  # factor on the allowed error of the ends, if the clearances are not proved
GAIN_SHARE = 0.02  # of the cost: a round that gains less is the last one
LEAST_GAIN_SHARE = 0.01  # of the cost: a round that can gain at most this is left out


@dataclass(frozen=True, slots=True, eq=False)
class ClockRefined:
    """One shot refined.

    leg : with its new curve; None if no solver found one that holds, or if its camera or its cost is worse
        than the guide's
    rounds : number of solves
    solution : that of the leg, or the last one
    seconds : of all solves
    first : the solution of the solver that failed before
    gap : what stands against the motion of a solved problem
    costs : for a camera in the problem, the costs of the flown leg and of the guide
    """

    shot: str
    leg: ClockLeg | None
    breaks: Array
    rounds: int
    solution: Solution
    seconds: float
    first: Solution | None
    gap: UnprovedMoment | None
    costs: tuple[float, float] | None = None


class _Best(NamedTuple):
    """A round that holds: its motion, its solution and its problem."""

    position: Piecewise
    solution: Solution
    task: ClockProblem


class _Surroundings(NamedTuple):
    """The surroundings of a round: references with the ellipsoids near its course, and half-spaces there."""

    references: ClockReferences
    planes: HalfSpaces


@dataclass(frozen=True, slots=True, eq=False)
class _Shot:
    """What is the same in all rounds.

    occluders, bodies : to look past, and to keep away from
    shown : whether each node is in the film
    unseen, bounded : as in ``refine_clock``
    """

    subject: ClockSubject
    occluders: tuple[Occluder, ...]
    breaks: Array
    around: Surroundings
    bodies: tuple[MovingEllipsoid, ...]
    shown: Mask
    unseen: bool
    bounded: bool

    @property
    def guide(self) -> Piecewise:
        """The guide's position, on the nodes."""
        return restrict(self.subject.leg.curve.channels(0, 1, 2), self.breaks)

    def guess(self, position: Piecewise) -> tuple[Array, Array]:
        """Return a motion as initial guess, with the guide's camera if the camera is part of the problem."""
        return guess(position, self.breaks, self.subject.leg.curve if self.subject.together else None)


@dataclass(frozen=True, slots=True, eq=False)
class _Round:
    """The state before a round.

    course : the motion that the half-spaces are set up around
    start : the initial guess
    setting : the surroundings there, if they are known
    over : passes over the target that are held to one side
    guess_aside : whether the initial guess leaves the guide to choose a side
    reach : obstacles count up to this far beyond their clearance, metres
    use : how much of the limits, and of the error of the ends, is used
    rounds, last, seconds : number of solves, the last solution, and time of all solves
    first : the solution of a solver that failed before another one succeeded
    gap : what was not proved in the last round
    best : the best round that holds
    ended : whether there are no more rounds
    """

    references: ClockReferences
    course: Piecewise
    start: tuple[Array, Array]
    over: tuple[Overflight, ...]
    guess_aside: bool
    reach: float = REACH_M
    use: Use = FIRST
    rounds: int = 0
    seconds: float = 0.0
    last: Solution | None = None
    first: Solution | None = None
    gap: UnprovedMoment | None = None
    best: _Best | None = None
    setting: _Surroundings | None = None
    ended: bool = False


def refine_clock(
    subject: ClockSubject,
    occluders: tuple[Occluder, ...] = (),
    *,
    unseen: bool = True,
    bounded: bool = False,
) -> ClockRefined:
    """Return one shot refined.

    occluders : what it has to look past
    unseen : whether it stays as far outside the drones' pictures as its guide
    bounded : whether a camera that looks past something stays as near to its place as verification accepts
    """
    breaks = breaks_of(subject)
    around = surroundings(subject.path, subject.drone, breaks)
    filmed = filmed_at(subject.leg, breaks)
    shot = _Shot(subject, occluders, breaks, around, bodies_of(around, breaks), filmed, unseen, bounded)
    now = _begun(shot)
    while not now.ended and now.rounds < MOST_ROUNDS:
        now = _next(shot, now)
    return _refined(shot, now)


def _begun(shot: _Shot) -> _Round:
    """Return the first round: from the guide, moved aside if it has to choose a side."""
    subject, guide = shot.subject, shot.guide
    references = references_at(subject, shot.breaks)
    over = () if subject.together else passes(subject, shot.breaks, references)
    first = guess_past(guess_to_side(guide, over), references, shot.occluders, shot.shown, subject.drone)
    course = first if shot.occluders else guide
    return _Round(references, course, shot.guess(first), over, guess_aside=bool(over or shot.occluders))


def _next(shot: _Shot, now: _Round) -> _Round:
    """Return the next round: set up the problem around the course, solve it, prove it at every instant."""
    references, planes = now.setting or _surroundings_of(shot, now)
    task = problem(shot.subject, shot.breaks, references, planes, now.use, now.start)
    optional = now.best is not None or now.guess_aside
    solution, failed = attempt = by_one_of(SOLVERS[:1] if optional else SOLVERS, partial(solve, task))
    seconds = now.seconds + attempt.seconds
    after = replace(now, references=references, rounds=now.rounds + 1, seconds=seconds, last=solution)
    after = replace(after, setting=None)
    if solution.status != "solved":
        return _unsolved(shot, after)
    curve = curve_of(shot.subject, shot.breaks, solution)
    gap = gap_in(shot.subject.drone, shot.around, curve, planes)
    start = (solution.states, solution.inputs)
    after = replace(after, first=now.first or failed, gap=gap, course=curve, start=start)
    if gap is not None:
        return _tightened(after, gap)
    # The cost before does not contain new occluders.
    anew = references.screened > now.references.screened
    best = _Best(curve, solution, task)
    return _continued(shot, _improved(after, best, anew=anew), best)


def _continued(shot: _Shot, after: _Round, best: _Best) -> _Round:
    """Return the round with the surroundings of the next one; it is the last if the next can gain little."""
    if after.ended:
        return after
    setting = _surroundings_of(shot, after)
    if _counts_anew(shot, after, setting.references):
        return replace(after, setting=setting)
    little = gain_bound(best.task, best.solution, setting.planes, after.reach) < LEAST_GAIN_SHARE
    return replace(after, setting=setting, ended=little)


def _counts_anew(shot: _Shot, after: _Round, references: ClockReferences) -> bool:
    """Return whether an ellipsoid acts on the motion that was not part of the problem of its round."""
    before, eyes = after.references, after.course(shot.breaks)
    return hides_anew(shot.occluders, before.near, references, eyes) or acts_anew(
        shot.bodies, before.beside, references, eyes
    )


def _surroundings_of(shot: _Shot, now: _Round) -> _Surroundings:
    """Return the surroundings of a round along its course."""
    eyes = now.course(shot.breaks)
    references = with_occluders(shot.occluders, now.references, eyes, shot.shown, bounded=shot.bounded)
    return _Surroundings(kept_from(shot.bodies, references, eyes), _planes(shot, now))


def _planes(shot: _Shot, now: _Round) -> HalfSpaces:
    """Return the half-spaces around the course of a round."""
    subject, leg = shot.subject, shot.subject.leg
    planes = held(shot.around.half_spaces(now.course.ctrl, now.reach, ROOM_SHARE), now.references, now.over)
    if not shot.unseen:
        return planes
    return planes.and_also(shot.around.free(subject.camera_task, (leg.start, leg.end), now.course))


def _unsolved(shot: _Shot, after: _Round) -> _Round:
    """Return the state after a round without a solution: with the guide itself, unless that was tried."""
    if after.best is not None or not after.guess_aside:
        return replace(after, ended=True)
    # There may be no room on that side. A camera that cannot follow the guide is rejected later.
    return replace(after, over=(), guess_aside=False, course=shot.guide, start=shot.guess(shot.guide))


def _tightened(after: _Round, gap: UnprovedMoment) -> _Round:
    """Return the state after a round that does not hold: with clearances, or limits, that leave it less."""
    if gap.unit == "m":
        return replace(
            after, reach=2 * after.reach, use=after.use._replace(ends=NARROWER_SHARE * after.use.ends)
        )
    return replace(after, use=after.use._replace(share=after.use.share * NEARLY_SHARE))


def _improved(after: _Round, latest: _Best, *, anew: bool) -> _Round:
    """Return the state after a round that holds; anew : its cost is not comparable with earlier ones."""
    solution, best = latest.solution, after.best
    least = inf if best is None or anew else best.solution.objective
    return replace(
        after,
        best=latest if solution.objective < least else best,
        ended=not solution.objective < (1 - GAIN_SHARE) * least,
    )


def _refined(shot: _Shot, now: _Round) -> ClockRefined:
    """Return the result of all rounds."""
    assert now.last is not None
    name, best = shot.subject.leg.shot, now.best
    if best is None:
        return ClockRefined(name, None, shot.breaks, now.rounds, now.last, now.seconds, now.first, now.gap)
    leg, costs, gap = _weighed(shot.subject, best)
    return ClockRefined(name, leg, shot.breaks, now.rounds, best.solution, now.seconds, now.first, gap, costs)


class _Weighed(NamedTuple):
    """The best leg compared with the guide.

    leg : None if it is worse than the guide, or fails
    costs : of the leg and of the guide; None where they are not compared
    gap : where the leg fails
    """

    leg: ClockLeg | None
    costs: tuple[float, float] | None = None
    gap: UnprovedMoment | None = None


def _weighed(subject: ClockSubject, best: _Best) -> _Weighed:
    leg, whole = subject.leg, _filmed(subject, best.position, best.solution)
    if whole is None:
        return _Weighed(None, None, UnprovedMoment(leg.start, "the camera's limits", float("nan"), ""))
    if not subject.together:
        worse = astray(subject, whole) > max(ALLOWED_RAD, astray(subject, leg))
        return _Weighed(None if worse else whole)
    breaks = best.position.breaks
    costs = flown_cost(best.task, breaks, whole), flown_cost(best.task, breaks, leg)
    return _Weighed(None if costs[0] > costs[1] else whole, costs)


def _filmed(subject: ClockSubject, position: Piecewise, solution: Solution) -> ClockLeg | None:
    camera = turned(position.breaks, solution.states) if subject.together else None
    return filmed(subject, position, camera)


def flown_cost(task: ClockProblem, breaks: Array, leg: ClockLeg) -> float:
    """Return the cost of a leg by a programme that contains the camera, with the leg's own camera.

    breaks : the times of the nodes, shape (N + 1,)
    """
    return cost(task, *guess(leg.curve, breaks, leg.curve))
