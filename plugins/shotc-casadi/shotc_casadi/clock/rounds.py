"""A shot on its own clock refined in rounds: solved, proved at every instant, put beside its surroundings
anew, and solved again while that helps; then the camera.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from shotc.plugin_api import Piecewise
from shotc.refiner_api import (
    BODY_YAW,
    CAM_PITCH,
    CAM_YAW,
    HFOV,
    Array,
    Clock,
    TimedLeg,
    Watch,
    quintic_hermite,
    restrict,
    surroundings,
    turn,
)
from shotc_casadi.clock.problem import ClockProblem, breaks_of, guess, problem
from shotc_casadi.clock.program import ClockSolution, solve
from shotc_casadi.clock.proof import Gap, astray, gap_in
from shotc_casadi.clock.side import held, led, passes
from shotc_casadi.clock.wishes import ClockSubject, wishes
from shotc_casadi.program import Solver

SOLVERS: tuple[Solver, ...] = ("fatrop", "ipopt")  # IPOPT is the fallback, and it is announced
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
    """

    shot: str
    leg: TimedLeg | None
    breaks: Array
    rounds: int
    solution: ClockSolution
    seconds: float
    first: ClockSolution | None
    gap: Gap | None


def refine_clock(subject: ClockSubject) -> ClockRefined:
    """Refine one shot."""
    leg, breaks = subject.leg, breaks_of(subject)
    around = surroundings(subject.path, subject.drone, breaks)
    wanted = wishes(subject, breaks)
    guide = restrict(leg.curve.channels(0, 1, 2), breaks)
    over = passes(subject, breaks, wanted)
    hulls, start, share = guide.ctrl, guess(led(guide, wanted, over), breaks), NEARLY
    best: tuple[Piecewise, ClockSolution] | None = None
    first: ClockSolution | None = None
    gap: Gap | None = None
    seconds, reach = 0.0, REACH
    rounds = 0
    while rounds < ROUNDS:
        rounds += 1
        planes = held(around.half_spaces(hulls, reach, SHARE), wanted, over)
        task = problem(subject, breaks, wanted, planes, share, start)
        solution, failed = _solved(task)
        seconds += solution.seconds + (failed.seconds if failed else 0.0)
        if solution.status != "solved":
            break
        first = first or failed
        found = curve_of(subject, breaks, solution)
        gap = gap_in(subject.drone, around, found)
        if gap is not None:
            reach, share = (2 * reach, share) if gap.unit == "m" else (reach, share * NEARLY)
            hulls = found.ctrl
            continue
        gained = best is None or solution.objective < (1 - GAIN) * best[1].objective
        if best is None or solution.objective < best[1].objective:
            best = found, solution
        if not gained:
            break
        hulls, start = found.ctrl, (solution.states, solution.inputs)
    if best is None:
        return ClockRefined(leg.shot, None, breaks, rounds, solution, seconds, first, gap)
    whole, unaimed = _filmed(subject, best[0]), Gap(leg.start, "the camera's limits", float("nan"), "")
    if whole is None:
        return ClockRefined(leg.shot, None, breaks, rounds, best[1], seconds, first, unaimed)
    worse = astray(subject, whole) > max(ALLOWED, astray(subject, leg))
    return ClockRefined(leg.shot, None if worse else whole, breaks, rounds, best[1], seconds, first, None)


def _solved(task: ClockProblem) -> tuple[ClockSolution, ClockSolution | None]:
    """Solve by the first of the solvers, or else by the second; the second value is the first's failure."""
    solution = solve(task, SOLVERS[0])
    return (solution, None) if solution.status == "solved" else (solve(task, SOLVERS[1]), solution)


def curve_of(subject: ClockSubject, breaks: Array, solution: ClockSolution) -> Piecewise:
    """Return the position of a solution, C2, with the guide's ends to the last digit.

    What the nodes at both ends are off is taken back over the ways into and out of the film.
    """
    states = solution.states.copy()
    leg = subject.leg
    rest = guess(leg.curve.channels(0, 1, 2), breaks[[0, -1]])[0]
    for k, edge in ((0, leg.start), (-1, leg.end)):
        off = (rest[k] - states[k]).reshape(3, 1, 3)
        zero = np.zeros((1, 3))
        ends = [np.concatenate([o, zero] if k == 0 else [zero, o]) for o in off]
        over = np.sort(np.array([breaks[k], edge]))
        blend = quintic_hermite(over, ends[0], ends[1], ends[2])
        mine = (breaks >= over[0]) & (breaks <= over[1])
        for order in range(3):
            states[mine, 3 * order : 3 * order + 3] += blend.derivative(order)(breaks[mine])
        states[k] = rest[k]
    return quintic_hermite(breaks, states[:, :3], states[:, 3:6], states[:, 6:])


def _filmed(subject: ClockSubject, position: Piecewise) -> TimedLeg | None:
    """Return the leg with a new position and the camera that follows from it, or None without one."""
    leg, angles = subject.leg, [CAM_YAW, CAM_PITCH, BODY_YAW]
    ends = np.array([leg.curve.ctrl[0, 0, angles], leg.curve.ctrl[-1, -1, angles]])
    clock = Clock(leg.curve.breaks, leg.start, leg.end)
    watch = Watch(subject.mission, subject.drone, subject.placed.subjects, subject.kept, ends)
    turned = turn(watch, clock, position)
    if turned.curve is None:
        return None
    breaks = position.breaks
    parts = [position, restrict(turned.curve, breaks), restrict(leg.curve.channels(HFOV), breaks)]
    ctrl = np.concatenate([part.ctrl for part in parts], axis=2)
    ctrl[0, 0], ctrl[-1, -1] = leg.curve.ctrl[0, 0], leg.curve.ctrl[-1, -1]
    return replace(leg, curve=Piecewise(breaks, ctrl))
