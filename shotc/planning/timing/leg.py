"""One leg over time: its moves between stops, its holds, and its given duration."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from shotc.geom.bernstein import Piecewise, concatenate
from shotc.ir.path import HoldLeg, PathLeg, Stop
from shotc.planning.timing.limits import Ceiling
from shotc.planning.timing.move import TimedMove, time_move
from shotc.planning.timing.profile import SAME_PLACE_M, Profile

Array = NDArray[np.float64]

# Seconds below which a hold is ignored.
SHORTEST_HOLD_S = 1e-6


@dataclass(frozen=True, slots=True, eq=False)
class LegMotion:
    """One leg over its own time from 0.

    profile : s over t, with its holds
    curve : the seven channels; its breaks are the profile's knots
    moves : its moves
    """

    profile: Profile
    curve: Piecewise
    moves: tuple[TimedMove, ...]

    @property
    def duration(self) -> float:
        """Seconds."""
        return self.profile.duration


@dataclass(frozen=True, slots=True)
class StopPlan:
    """The distinct stops of a leg, in order of s, with a move between any two."""

    stops: tuple[Stop, ...]

    @property
    def spans(self) -> tuple[tuple[float, float], ...]:
        """The intervals of s between stops."""
        return tuple((a.s, b.s) for a, b in zip(self.stops[:-1], self.stops[1:], strict=True))

    def hold_at(self, s: float) -> float:
        """Return the seconds that it rests at a place, 0 where it does not stop."""
        return sum(stop.hold for stop in self.stops if abs(stop.s - s) <= SAME_PLACE_M)

    def holds_between(self, start: float, end: float) -> float:
        """Return the seconds that it rests strictly between two places."""
        return sum(stop.hold for stop in self.stops if start + SAME_PLACE_M < stop.s < end - SAME_PLACE_M)

    def rests_at(self, s: float) -> bool:
        """Return whether there is a stop at a place."""
        return any(abs(stop.s - s) <= SAME_PLACE_M for stop in self.stops)

    def leaving(self, holds: dict[float, float]) -> StopPlan:
        """Return the plan with other holds at some of its stops, given by place."""
        stops = self.stops
        for s, hold in holds.items():
            stops = tuple(replace(p, hold=hold) if abs(p.s - s) <= SAME_PLACE_M else p for p in stops)
        return StopPlan(stops)


def plan_of(leg: PathLeg) -> StopPlan:
    """Return the leg's stops, with those at the same place merged; a still leg lasts its given duration."""
    if isinstance(leg, HoldLeg):
        return StopPlan((Stop(0.0, leg.hold if leg.duration is None else leg.duration),))
    merged: list[Stop] = []
    for stop in leg.stops:
        if merged and stop.s - merged[-1].s < SAME_PLACE_M:
            merged[-1] = Stop(merged[-1].s, merged[-1].hold + stop.hold)
        else:
            merged.append(stop)
    return StopPlan(tuple(merged))


def fastest_moves(leg: PathLeg, plan: StopPlan, ceiling: Ceiling) -> tuple[TimedMove, ...]:
    """Return every move of the leg as fast as the ceiling allows."""
    if isinstance(leg, HoldLeg):
        return ()
    keyframes = tuple(mark.s for mark in leg.marks)
    path = SamePath.of(leg.curve)
    return tuple(timed_once(path, span, ceiling, keyframes) for span in plan.spans)


@dataclass(frozen=True, slots=True)
class SamePath:
    """A path that compares equal to any other with the same numbers."""

    numbers: bytes
    path: Piecewise = field(compare=False)

    @staticmethod
    def of(path: Piecewise) -> SamePath:
        """Return a path, compared by shape, breaks and control points."""
        shape = np.array(path.ctrl.shape).tobytes()
        return SamePath(shape + path.breaks.tobytes() + path.ctrl.tobytes(), path)


@lru_cache(maxsize=256)
def timed_once(
    path: SamePath, span: tuple[float, float], ceiling: Ceiling, through: tuple[float, ...]
) -> TimedMove:
    """Return ``time_move`` of a path, cached; arguments as there.

    A leg is timed when it is planned, again where alternatives are tried, and in the time pass.
    """
    return time_move(path.path, span, ceiling, through)


def assemble(
    leg: PathLeg, plan: StopPlan, moves: tuple[TimedMove, ...], duration: float | None
) -> LegMotion | None:
    """Return the leg over time, or None where it has neither moves nor holds.

    duration : its exact duration, which removes rounding from the last knot; None to keep the sum
    """
    parts: list[tuple[Profile, Piecewise]] = []
    clock = 0.0
    pose = np.array(leg.pose)
    for i, stop in enumerate(plan.stops):
        if stop.hold >= SHORTEST_HOLD_S:
            ends = np.array([clock, clock + stop.hold])
            parts.append((Profile(ends, np.full(2, stop.s), np.zeros(2), np.zeros(2)), rest(pose, ends)))
            clock = float(ends[1])
        if i < len(moves):
            profile = moves[i].profile
            t = clock + profile.t
            parts.append((replace(profile, t=t), Piecewise(t, moves[i].curve.ctrl)))
            clock = float(t[-1])
            pose = moves[i].curve.ctrl[-1, -1]
    if not parts:
        return None
    profile = _joined([p for p, _ in parts])
    if duration is not None:
        profile = replace(profile, t=np.concatenate([profile.t[:-1], [duration]]))
    ctrl = concatenate([c for _, c in parts]).ctrl
    return LegMotion(profile, Piecewise(profile.t, ctrl), moves)


def rest(pose: Array, ends: Array) -> Piecewise:
    """Return the quintic that stays at one pose, shape (7,), between two times."""
    return Piecewise(ends, np.tile(pose, (1, 6, 1)))


def _joined(parts: list[Profile]) -> Profile:
    first, *others = parts
    columns = [
        np.concatenate([getattr(first, name), *(getattr(p, name)[1:] for p in others)])
        for name in ("t", "s", "sd", "sdd")
    ]
    return Profile(*columns)
