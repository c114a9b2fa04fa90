"""A shot on its own clock refined in rounds: solved, proved at every instant, put beside its surroundings
anew, and solved again while that helps; then the camera.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from math import inf

from shotc.plugin_api import Piecewise
from shotc.refiner_api import (
    Array,
    Looker,
    TimedLeg,
    restrict,
    surroundings,
)
from shotc_casadi.clock.aside import led_past
from shotc_casadi.clock.bodies import bodies_of, kept_from
from shotc_casadi.clock.curve import curve_of, filmed
from shotc_casadi.clock.problem import ClockProblem, breaks_of, guess, problem
from shotc_casadi.clock.program import cost, solve
from shotc_casadi.clock.proof import Gap, astray, gap_in
from shotc_casadi.clock.screens import Screen, looked_past
from shotc_casadi.clock.several import turned
from shotc_casadi.clock.side import held, led, passes
from shotc_casadi.clock.wishes import ClockSubject, wishes
from shotc_casadi.solving import SOLVERS, Solution, by_one_of

ROUNDS = 6
REACH = 8.0  # metres beyond its clearance within which a wall counts
SHARE = 0.5  # of the room beside a wall that is kept
NEARLY = 0.998  # of each limit that is used, so that rounding breaks none
ALLOWED = 0.01  # rad by which a camera may miss its aim, if its guide misses it by less
GAIN = 0.01  # of the cost: a round that gains less is the last


@dataclass(frozen=True, slots=True, eq=False)
class ClockRefined:
    """One shot refined.

    leg : with its new curve, or None where no solver found one that holds, or where its camera follows less
        well than the guide's
    rounds : how often it was solved; solution : the leg's, or the last one; first : the solver that failed
        before it; seconds : of all solves; gap : what stands against the motion of a solved problem
    costs : of several subjects, what its flown leg and the guide cost by the problem's own cost
    """

    shot: str
    leg: TimedLeg | None
    breaks: Array
    rounds: int
    solution: Solution
    seconds: float
    first: Solution | None
    gap: Gap | None
    costs: tuple[float, float] | None = None


def refine_clock(subject: ClockSubject, screens: tuple[Screen, ...] = ()) -> ClockRefined:
    """Refine one shot; screens : what it is to look past."""
    leg, breaks = subject.leg, breaks_of(subject)
    around = surroundings(subject.path, subject.drone, breaks)
    wanted = wishes(subject, breaks)
    guide = restrict(leg.curve.channels(0, 1, 2), breaks)
    over = [] if subject.together else passes(subject, breaks, wanted)
    camera, bodies = leg.curve if subject.together else None, bodies_of(around, breaks)
    shown = (breaks >= leg.start) & (breaks <= leg.end)
    first_guess = led_past(led(guide, wanted, over), wanted, screens, shown)
    course, start, share = first_guess if screens else guide, guess(first_guess, breaks, camera), NEARLY
    aside = bool(over or screens)
    looker = Looker(subject.mission, subject.drone, subject.placed.subjects)
    best: tuple[Piecewise, Solution, ClockProblem] | None = None
    first: Solution | None = None
    gap: Gap | None = None
    seconds, reach = 0.0, REACH
    rounds = 0
    while rounds < ROUNDS:
        rounds += 1
        planes = held(around.half_spaces(course.ctrl, reach, SHARE), wanted, over)
        planes = planes.and_also(around.free(looker, (leg.start, leg.end), course))
        before, wanted = wanted, looked_past(screens, wanted, course(breaks), shown)
        wanted = kept_from(bodies, wanted, course(breaks))
        task = problem(subject, breaks, wanted, planes, share, start)
        optional = best is not None or aside
        solution, failed = attempt = by_one_of(SOLVERS[:1] if optional else SOLVERS, partial(solve, task))
        seconds += attempt.seconds
        if solution.status != "solved" and best is None and aside:
            # The room may leave no place on that side; a camera that cannot follow then is not taken.
            over, aside, course, start = [], False, guide, guess(guide, breaks, camera)
            continue
        if solution.status != "solved":
            break
        first = first or failed
        found = curve_of(subject, breaks, solution)
        gap = gap_in(subject.drone, around, found)
        if gap is not None:
            reach, share = (2 * reach, share) if gap.unit == "m" else (reach, share * NEARLY)
            course = found
            continue
        # What is looked past anew has a price that the motion before did not pay.
        anew = wanted.screened > before.screened
        least = inf if best is None or anew else best[1].objective
        gained = solution.objective < (1 - GAIN) * least
        if solution.objective < least:
            best = found, solution, task
        if not gained:
            break
        course, start = found, (solution.states, solution.inputs)
    if best is None:
        return ClockRefined(leg.shot, None, breaks, rounds, solution, seconds, first, gap)
    whole, costs, gap = _weighed(subject, best)
    return ClockRefined(leg.shot, whole, breaks, rounds, best[1], seconds, first, gap, costs)


def _weighed(
    subject: ClockSubject, best: tuple[Piecewise, Solution, ClockProblem]
) -> tuple[TimedLeg | None, tuple[float, float] | None, Gap | None]:
    """Return the leg of the best round where it is no worse than the guide, the costs, and what is amiss."""
    leg, whole = subject.leg, _filmed(subject, *best[:2])
    if whole is None:
        return None, None, Gap(leg.start, "the camera's limits", float("nan"), "")
    if not subject.together:
        worse = astray(subject, whole) > max(ALLOWED, astray(subject, leg))
        return None if worse else whole, None, None
    breaks = best[0].breaks
    costs = flown_cost(best[2], breaks, whole), flown_cost(best[2], breaks, leg)
    return None if costs[0] > costs[1] else whole, costs, None


def _filmed(subject: ClockSubject, position: Piecewise, solution: Solution) -> TimedLeg | None:
    camera = turned(position.breaks, solution.states) if subject.together else None
    return filmed(subject, position, camera)


def flown_cost(task: ClockProblem, breaks: Array, leg: TimedLeg) -> float:
    """Return what a leg costs by a programme of several subjects, with the camera that it has."""
    return cost(task, *guess(leg.curve, breaks, leg.curve))
