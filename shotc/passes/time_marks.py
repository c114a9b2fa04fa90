"""Gives every move the time that a leg's duration and its keyframes' times ask for, or says what is too fast.

Times fixed by the mission are anchors; between two of them all moves and parts of moves are slowed
alike from the fastest that the limits allow. What follows the last anchor keeps its pace.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from shotc.ir.path import Leg, Mark
from shotc.passes.time_leg import Plan
from shotc.passes.time_limits import Ceiling
from shotc.passes.time_move import Move
from shotc.passes.time_profile import SAME
from shotc.passes.time_windows import windowed_move

# Rounding by which a time may be shorter than the shortest, relative and in seconds.
ROUNDING = 1e-9


@dataclass(frozen=True, slots=True)
class TooFast:
    """The leg cannot be that fast.

    mark : the keyframe that is not reached in time; None for the end of the leg
    asked, shortest : seconds from the leg's start
    """

    mark: Mark | None
    asked: float
    shortest: float


@dataclass(frozen=True, slots=True)
class _Anchor:
    s: float
    time: float
    mark: Mark | None


@dataclass(frozen=True, slots=True)
class _Part:
    """A part of a move: its index, where it ends, how long it is to last, how long it does at least."""

    move: int
    end: float
    seconds: float
    least: float
    anchor: int


def has_times(leg: Leg) -> bool:
    """Tell whether a keyframe's time or the leg's length is given."""
    return leg.duration is not None or any(mark.time is not None for mark in leg.marks)


def meet_times(
    leg: Leg, plan: Plan, fast: tuple[Move, ...], paced: tuple[Move, ...], ceiling: Ceiling
) -> tuple[Plan, tuple[Move, ...]] | TooFast:
    """Return the moves at the times asked for, and the plan with waits where keyframes ask for them.

    fast : the moves at full limits, ceiling; paced : at the leg's pace, for what has no time
    """
    anchors = _anchors(leg, plan)
    plan = _with_waits(leg, plan, anchors)
    parts: list[_Part] = []
    reached = 0.0
    for i, (a, b) in enumerate(pairwise(anchors)):
        found = _parts(plan, fast, a.s, b.s)
        least = sum(seconds for _, _, seconds in found)
        room = b.time - a.time - _holds(plan, a.s, b.s)
        whole = _whole_moves(plan, a.s) and _whole_moves(plan, b.s)
        if least > room * (1 + ROUNDING) + ROUNDING and (whole or room <= 0):
            return TooFast(b.mark, b.time, reached + least + b.time - a.time - room)
        share = room / least if least > 0 else 1.0
        parts += [_Part(m, end, share * seconds, seconds, i + 1) for m, end, seconds in found]
        reached = b.time
    last = anchors[-1].s
    for m, end, seconds in _parts(plan, paced, last, plan.stops[-1].s):
        parts.append(_Part(m, end, seconds, seconds, len(anchors)))
    moves: list[Move] = []
    for m, move in enumerate(fast):
        own = [p for p in parts if p.move == m]
        made = _timed_move(leg, move, own, ceiling)
        if not isinstance(made, Move):
            return _too_fast(leg, anchors, own, made)
        moves.append(made)
    return plan, tuple(moves)


def _anchors(leg: Leg, plan: Plan) -> list[_Anchor]:
    """Return the fixed times in order of s, the start first; keyframes at one place keep the first."""
    anchors = [_Anchor(plan.stops[0].s, 0.0, None)]
    for mark in sorted(leg.marks, key=lambda m: (m.s, m.index)):
        if mark.time is not None and (mark.s - anchors[-1].s > SAME or mark.time > anchors[-1].time):
            anchors.append(_Anchor(mark.s, mark.time, mark))
    if leg.duration is not None:
        end = plan.stops[-1]
        if end.s - anchors[-1].s > SAME:
            anchors.append(_Anchor(end.s, leg.duration - end.hold, None))
    return anchors


def _with_waits(leg: Leg, plan: Plan, anchors: list[_Anchor]) -> Plan:
    """Wait at a stop for which a later time is given than it takes to get there from the same place."""
    for a, b in pairwise(anchors):
        if b.s - a.s <= SAME:
            held = _holds(plan, a.s, a.s + 2 * SAME)
            plan = plan.waiting(a.s, max(0.0, b.time - a.time - held))
    end, last = plan.stops[-1], anchors[-1]
    if leg.duration is not None and last.mark is not None and end.s - last.s <= SAME:
        plan = plan.waiting(end.s, max(0.0, leg.duration - last.time - end.hold))
    return plan


def _holds(plan: Plan, start: float, end: float) -> float:
    """Return the seconds held from the arrival at ``start`` to the arrival at ``end``."""
    return sum(p.hold for p in plan.stops if start - SAME < p.s < end - SAME)


def _whole_moves(plan: Plan, s: float) -> bool:
    return any(abs(stop.s - s) < SAME for stop in plan.stops)


def _parts(plan: Plan, moves: tuple[Move, ...], start: float, end: float) -> list[tuple[int, float, float]]:
    """Return (move, where its part ends, seconds) for what is flown between two places."""
    found = []
    for m, ((s0, s1), move) in enumerate(zip(plan.spans, moves, strict=True)):
        low, high = max(s0, start), min(s1, end)
        if high - low > SAME:
            found.append((m, high, move.profile.arrival(high) - move.profile.departure(low)))
    return found


def _timed_move(leg: Leg, fast: Move, parts: list[_Part], ceiling: Ceiling) -> Move | np.ndarray:
    if len(parts) == 1:
        return fast.stretched(max(1.0, parts[0].seconds / fast.duration))
    ends = np.array([p.end for p in parts])
    seconds = np.array([p.seconds for p in parts])
    assert leg.curve is not None
    span = (float(fast.profile.s[0]), float(fast.profile.s[-1]))
    slower = min(p.seconds / p.least for p in parts)
    lasting = seconds
    # As gently as an even slowdown would be, if that will do; else with all that the drone has.
    for limits in ((ceiling.scaled(1.0 / slower),) if slower > 1.0 else ()) + (ceiling,):
        move, lasting = windowed_move(leg.curve, span, limits, ends, seconds)
        if move is not None:
            return move
    return lasting


def _too_fast(leg: Leg, anchors: list[_Anchor], parts: list[_Part], lasting: np.ndarray) -> TooFast:
    """Name the first anchor that a move's parts reach too late."""
    late = np.cumsum(lasting - np.array([p.seconds for p in parts]))
    known = [i for i, p in enumerate(parts) if p.anchor < len(anchors)]
    worst = next((i for i in known if late[i] > 1e-3), known[-1])
    anchor = anchors[parts[worst].anchor]
    return TooFast(anchor.mark, anchor.time, anchor.time + max(float(late[worst]), 1e-3))
