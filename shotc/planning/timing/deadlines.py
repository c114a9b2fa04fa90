"""Timing of a leg with deadlines: its duration and the times of its keyframes.

Between two deadlines all moves and parts of moves are slowed by the same factor from the fastest feasible
ones. After the last deadline the leg keeps its pace. If the deadlines are infeasible, the result says which
one, and how much later it could be.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import accumulate, pairwise
from typing import NamedTuple

import numpy as np

from shotc.ir.path import Mark, PathLeg
from shotc.planning.timing.leg import StopPlan, plan_of
from shotc.planning.timing.limits import Ceiling
from shotc.planning.timing.move import TimedMove
from shotc.planning.timing.profile import SAME_PLACE_M
from shotc.planning.timing.windows import windowed_move

# Least relative lateness of a flight that no single interval makes late; seconds taken as none.
LEAST_LATE_RATIO, SOON_S = 0.01, 1e-3
# Relative rounding by which a time may be shorter than the least one; and the accuracy of the solver's least
# time, by which a move may be faster: a tenth of its margin to the limits.
ROUNDING_SHARE, SOLVED_SHARE = 1e-9, 1e-7
# The search for the least feasible delay: first try, seconds; doublings; then bisection steps.
FIRST_DELAY_S, DOUBLINGS, HALVINGS = 0.05, 9, 5


@dataclass(frozen=True, slots=True)
class Timed:
    """The moves that meet the deadlines, and the plan with the necessary waits."""

    plan: StopPlan
    moves: tuple[TimedMove, ...]


@dataclass(frozen=True, slots=True)
class TooFast:
    """A deadline of a leg that is infeasible.

    mark : keyframe that is not reached in time; None for the end of the leg
    deadline, shortest : seconds from the leg's start; shortest is the earliest feasible time, None if no
        delay of it is feasible
    shifts_rest : whether all later times have to move by the same amount
    """

    mark: Mark | None
    deadline: float
    shortest: float | None
    shifts_rest: bool = False


@dataclass(frozen=True, slots=True)
class _Deadline:
    """A place with fixed times of arrival and departure, seconds from the leg's start."""

    s: float
    arrives: float
    leaves: float
    mark: Mark | None = None

    def later(self, seconds: float) -> _Deadline:
        return replace(self, arrives=self.arrives + seconds, leaves=self.leaves + seconds)


@dataclass(frozen=True, slots=True)
class _MovePart:
    """A part of a move: its end, its duration and its least one, seconds, and the index of its deadline."""

    move: int
    end: float
    duration: float
    least: float
    deadline: int


@dataclass(frozen=True, slots=True)
class _MissedDeadline:
    """The index of the deadline that is not reached, and the missing seconds if they are known."""

    deadline: int
    lack: float = 0.0


@dataclass(frozen=True, slots=True, eq=False)
class LegDeadlines:
    """A leg with deadlines.

    fast : its moves at full limits, which are ``ceiling``
    paced : its moves at its pace, for the part after the last deadline
    """

    leg: PathLeg
    plan: StopPlan
    fast: tuple[TimedMove, ...]
    paced: tuple[TimedMove, ...]
    ceiling: Ceiling

    def possible(self) -> bool:
        """Return whether the deadlines are feasible."""
        return isinstance(_attempt(self, _deadlines(self.leg, self.plan)), Timed)

    def lateness(self) -> float:
        """Return the relative lateness of the fastest flight between two deadlines, at least 0."""
        if self.possible():
            return 0.0
        late = LEAST_LATE_RATIO
        for a, b in pairwise(_deadlines(self.leg, self.plan)):
            least = sum(part.duration for part in _parts(self.plan, self.fast, a.s, b.s))
            late = max(late, least / max(_available(self.plan, a, b), SOON_S) - 1.0)
        return late

    def meet(self) -> Timed | TooFast:
        """Return the moves that meet the deadlines, or the first infeasible one and a feasible time."""
        deadlines = _deadlines(self.leg, self.plan)
        attempt = _attempt(self, deadlines)
        if isinstance(attempt, Timed):
            return attempt
        late = deadlines[attempt.deadline]
        at_end = late.mark is None
        time = late.leaves if at_end else late.arrives
        for shifts_rest in (False, True):
            delay = _least_delay(self, deadlines, attempt, shifts_rest)
            if delay is not None:
                return TooFast(late.mark, time, time + delay, shifts_rest)
        return TooFast(late.mark, time, None)


def has_times(leg: PathLeg) -> bool:
    """Return whether the leg has a duration or a keyframe with a time."""
    return leg.duration is not None or any(mark.time is not None for mark in leg.marks)


def flying_times(leg: PathLeg) -> tuple[tuple[float, float], ...]:
    """Return the places of a leg with a fixed time, its start first, and the flight time to each, seconds."""
    plan = plan_of(leg)
    deadlines = _deadlines(leg, plan)
    flown = accumulate((_available(plan, a, b) for a, b in pairwise(deadlines)), initial=0.0)
    return tuple((deadline.s, t) for deadline, t in zip(deadlines, flown, strict=True))


def _deadlines(leg: PathLeg, plan: StopPlan) -> list[_Deadline]:
    """Return the fixed times in order of s, the start first, one per place."""
    first = plan.stops[0]
    deadlines = [_Deadline(first.s, 0.0, first.hold)]
    for mark in sorted(leg.marks, key=lambda m: (m.s, m.index)):
        if mark.time is None:
            continue
        last = deadlines[-1]
        held = plan.hold_at(mark.s)
        if mark.s - last.s > SAME_PLACE_M:
            deadlines.append(_Deadline(mark.s, mark.time, mark.time + held, mark))
        elif last.mark is None:
            deadlines[-1] = _Deadline(last.s, 0.0, mark.time + held, mark)
        else:
            deadlines[-1] = replace(last, leaves=max(last.leaves, mark.time))
    if leg.duration is not None:
        end, last = plan.stops[-1], deadlines[-1]
        if end.s - last.s > SAME_PLACE_M:
            deadlines.append(_Deadline(end.s, leg.duration - end.hold, leg.duration))
        else:
            deadlines[-1] = replace(last, leaves=max(last.leaves, leg.duration))
    return deadlines


def _available(plan: StopPlan, a: _Deadline, b: _Deadline) -> float:
    """Return the flight time between two deadlines, without holds, seconds."""
    return b.arrives - a.leaves - plan.holds_between(a.s, b.s)


def _attempt(timed: LegDeadlines, deadlines: list[_Deadline]) -> Timed | _MissedDeadline:
    parts: list[_MovePart] = []
    plan = timed.plan.leaving({a.s: a.leaves - a.arrives for a in deadlines})
    for i, (a, b) in enumerate(pairwise(deadlines)):
        split = _parts(plan, timed.fast, a.s, b.s)
        least = sum(part.duration for part in split)
        available = _available(plan, a, b)
        lack = least - available
        if lack > ROUNDING_SHARE * (1 + available) + SOLVED_SHARE * least and (
            available <= 0 or (plan.rests_at(a.s) and plan.rests_at(b.s))
        ):
            return _MissedDeadline(i + 1, lack)
        parts += [_MovePart(p.move, p.end, available * p.duration / least, p.duration, i + 1) for p in split]
    rest = _parts(plan, timed.paced, deadlines[-1].s, plan.stops[-1].s)
    parts += [_MovePart(p.move, p.end, p.duration, p.duration, len(deadlines)) for p in rest]
    moves: list[TimedMove] = []
    for m, move in enumerate(timed.fast):
        own = [p for p in parts if p.move == m]
        after = all(p.deadline == len(deadlines) for p in own)
        slowed = timed.paced[m] if after else _move_of(timed, move, own)
        if slowed is None:
            known = [p for p in own if p.deadline < len(deadlines)]
            return _MissedDeadline(min(known, key=lambda p: p.duration / p.least).deadline)
        moves.append(slowed)
    return Timed(plan, tuple(moves))


class _FlownPart(NamedTuple):
    """A part of a move: index of the move, end of the part, and its duration in seconds."""

    move: int
    end: float
    duration: float


def _parts(plan: StopPlan, moves: tuple[TimedMove, ...], start: float, end: float) -> list[_FlownPart]:
    """Return the parts of moves between two places."""
    parts = []
    for m, ((s0, s1), move) in enumerate(zip(plan.spans, moves, strict=True)):
        low, high = max(s0, start), min(s1, end)
        if high - low > SAME_PLACE_M:
            duration = move.profile.arrival(high) - move.profile.departure(low)
            parts.append(_FlownPart(m, high, duration))
    return parts


def _move_of(timed: LegDeadlines, fast: TimedMove, parts: list[_MovePart]) -> TimedMove | None:
    if len(parts) == 1:
        return fast.stretched(max(1.0 - SOLVED_SHARE, parts[0].duration / fast.duration))
    span = (float(fast.profile.s[0]), float(fast.profile.s[-1]))
    ends = np.array([p.end for p in parts])
    durations = np.array([p.duration for p in parts])
    return windowed_move(fast.path, span, timed.ceiling, ends, durations)


def _least_delay(
    timed: LegDeadlines, deadlines: list[_Deadline], late: _MissedDeadline, shifts_rest: bool
) -> float | None:
    """Return the least feasible delay of the late deadline (and of all after it), seconds, or None."""

    def enough(delay: float) -> bool:
        k = late.deadline
        moved = [a.later(delay) if i == k or (shifts_rest and i > k) else a for i, a in enumerate(deadlines)]
        return isinstance(_attempt(timed, moved), Timed)

    if late.lack > 0 and enough(late.lack):
        return late.lack
    return _first_enough(enough, max(FIRST_DELAY_S, late.lack))


def _first_enough(enough: Callable[[float], bool], first: float) -> float | None:
    high = first
    for _ in range(DOUBLINGS):
        if enough(high):
            break
        high *= 2.0
    else:
        return None
    low = high / 2.0 if high > first else 0.0
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if enough(middle) else (middle, high)
    return high
