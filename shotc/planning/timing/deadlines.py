"""Timing of a leg with deadlines: its duration and the times of its keyframes.

Times fixed by the mission are anchors. Between two anchors all moves and parts of moves are slowed by the
same factor from the fastest feasible ones. After the last anchor the leg keeps its pace. If the deadlines are
infeasible, the result says which one, and how much later it could be.
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
LITTLE, SOON = 0.01, 1e-3
# Relative rounding by which a time may be shorter than the least one; and the accuracy of the solver's least
# time, by which a move may be faster: a tenth of its margin to the limits.
ROUNDING, SOLVED_TO = 1e-9, 1e-7
# The search for the least feasible delay: first try, seconds; doublings; then bisection steps.
FIRST_DELAY, DOUBLINGS, HALVINGS = 0.05, 9, 5


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
class _Anchor:
    """A place with fixed times of arrival and departure, seconds from the leg's start."""

    s: float
    arrives: float
    leaves: float
    mark: Mark | None = None

    def later(self, seconds: float) -> _Anchor:
        return replace(self, arrives=self.arrives + seconds, leaves=self.leaves + seconds)


@dataclass(frozen=True, slots=True)
class _Part:
    """A part of a move: its end, its duration, its least duration, seconds, and the anchor at its end."""

    move: int
    end: float
    seconds: float
    least: float
    anchor: int


@dataclass(frozen=True, slots=True)
class _Late:
    """The anchor that is not reached in time, and the missing seconds if they are known."""

    anchor: int
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
        return isinstance(_attempt(self, _anchors(self.leg, self.plan)), Timed)

    def lateness(self) -> float:
        """Return the relative lateness of the fastest flight between two anchors, at least 0."""
        if self.possible():
            return 0.0
        late = LITTLE
        for a, b in pairwise(_anchors(self.leg, self.plan)):
            least = sum(seconds for _, _, seconds in _parts(self.plan, self.fast, a.s, b.s))
            late = max(late, least / max(_available(self.plan, a, b), SOON) - 1.0)
        return late

    def meet(self) -> Timed | TooFast:
        """Return the moves that meet the deadlines, or the first infeasible one and a feasible time."""
        anchors = _anchors(self.leg, self.plan)
        attempt = _attempt(self, anchors)
        if isinstance(attempt, Timed):
            return attempt
        late = anchors[attempt.anchor]
        at_end = late.mark is None
        time = late.leaves if at_end else late.arrives
        for shifts_rest in (False, True):
            delay = _least_delay(self, anchors, attempt, shifts_rest)
            if delay is not None:
                return TooFast(late.mark, time, time + delay, shifts_rest)
        return TooFast(late.mark, time, None)


def has_times(leg: PathLeg) -> bool:
    """Return whether the leg has a duration or a keyframe with a time."""
    return leg.duration is not None or any(mark.time is not None for mark in leg.marks)


def flying_times(leg: PathLeg) -> tuple[tuple[float, float], ...]:
    """Return the places of a leg with a fixed time, its start first, and the flight time to each, seconds."""
    plan = plan_of(leg)
    anchors = _anchors(leg, plan)
    flown = accumulate((_available(plan, a, b) for a, b in pairwise(anchors)), initial=0.0)
    return tuple((anchor.s, t) for anchor, t in zip(anchors, flown, strict=True))


def _anchors(leg: PathLeg, plan: StopPlan) -> list[_Anchor]:
    """Return the fixed times in order of s, the start first, one per place."""
    first = plan.stops[0]
    anchors = [_Anchor(first.s, 0.0, first.hold)]
    for mark in sorted(leg.marks, key=lambda m: (m.s, m.index)):
        if mark.time is None:
            continue
        last = anchors[-1]
        held = plan.hold_at(mark.s)
        if mark.s - last.s > SAME_PLACE_M:
            anchors.append(_Anchor(mark.s, mark.time, mark.time + held, mark))
        elif last.mark is None:
            anchors[-1] = _Anchor(last.s, 0.0, mark.time + held, mark)
        else:
            anchors[-1] = replace(last, leaves=max(last.leaves, mark.time))
    if leg.duration is not None:
        end, last = plan.stops[-1], anchors[-1]
        if end.s - last.s > SAME_PLACE_M:
            anchors.append(_Anchor(end.s, leg.duration - end.hold, leg.duration))
        else:
            anchors[-1] = replace(last, leaves=max(last.leaves, leg.duration))
    return anchors


def _available(plan: StopPlan, a: _Anchor, b: _Anchor) -> float:
    """Return the flight time between two anchors, without holds, seconds."""
    return b.arrives - a.leaves - plan.holds_between(a.s, b.s)


def _attempt(timed: LegDeadlines, anchors: list[_Anchor]) -> Timed | _Late:
    parts: list[_Part] = []
    plan = timed.plan.leaving({a.s: a.leaves - a.arrives for a in anchors})
    for i, (a, b) in enumerate(pairwise(anchors)):
        split = _parts(plan, timed.fast, a.s, b.s)
        least = sum(seconds for _, _, seconds in split)
        available = _available(plan, a, b)
        lack = least - available
        if lack > ROUNDING * (1 + available) + SOLVED_TO * least and (
            available <= 0 or (plan.rests_at(a.s) and plan.rests_at(b.s))
        ):
            return _Late(i + 1, lack)
        parts += [_Part(m, end, available * seconds / least, seconds, i + 1) for m, end, seconds in split]
    rest = _parts(plan, timed.paced, anchors[-1].s, plan.stops[-1].s)
    parts += [_Part(m, end, seconds, seconds, len(anchors)) for m, end, seconds in rest]
    moves: list[TimedMove] = []
    for m, move in enumerate(timed.fast):
        own = [p for p in parts if p.move == m]
        made = _made(timed, move, own)
        if made is None:
            known = [p for p in own if p.anchor < len(anchors)]
            return _Late(min(known, key=lambda p: p.seconds / p.least).anchor)
        moves.append(made)
    return Timed(plan, tuple(moves))


class _FlownPart(NamedTuple):
    """A part of a move: index of the move, end of the part, and its duration in seconds."""

    move: int
    end: float
    seconds: float


def _parts(plan: StopPlan, moves: tuple[TimedMove, ...], start: float, end: float) -> list[_FlownPart]:
    """Return the parts of moves between two places."""
    parts = []
    for m, ((s0, s1), move) in enumerate(zip(plan.spans, moves, strict=True)):
        low, high = max(s0, start), min(s1, end)
        if high - low > SAME_PLACE_M:
            seconds = move.profile.arrival(high) - move.profile.departure(low)
            parts.append(_FlownPart(m, high, seconds))
    return parts


def _made(timed: LegDeadlines, fast: TimedMove, parts: list[_Part]) -> TimedMove | None:
    if len(parts) == 1:
        return fast.stretched(max(1.0 - SOLVED_TO, parts[0].seconds / fast.duration))
    span = (float(fast.profile.s[0]), float(fast.profile.s[-1]))
    ends = np.array([p.end for p in parts])
    seconds = np.array([p.seconds for p in parts])
    return windowed_move(fast.path, span, timed.ceiling, ends, seconds)


def _least_delay(timed: LegDeadlines, anchors: list[_Anchor], late: _Late, shifts_rest: bool) -> float | None:
    """Return the least feasible delay of the late anchor (and of all after it), seconds, or None."""

    def enough(delay: float) -> bool:
        k = late.anchor
        moved = [a.later(delay) if i == k or (shifts_rest and i > k) else a for i, a in enumerate(anchors)]
        return isinstance(_attempt(timed, moved), Timed)

    if late.lack > 0 and enough(late.lack):
        return late.lack
    return _first_enough(enough, max(FIRST_DELAY, late.lack))


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
