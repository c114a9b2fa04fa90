"""The earliest start of a shot on its own clock. Its target moves on while the start is put off.

Each try plans the shot for a start, and the transfer to its first pose. The next start is the first that the
drone reaches in time by an estimate of its lateness. The estimate is corrected by its errors at the tries
before. So a shot whose target approaches the drone begins when the target comes by.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from itertools import pairwise, takewhile
from math import inf

import numpy as np

from shotc.geom.bernstein import Array
from shotc.ir.drone import Drone
from shotc.ir.keyed import carriers, is_keyed
from shotc.ir.keyframes import PlacedShot
from shotc.ir.mission import MissionIR, Shot
from shotc.ir.path import ClockLeg
from shotc.ir.phases import Phase
from shotc.planning.clock.departure import TargetConflict, Transfer
from shotc.planning.clock.ends import EndRequirement
from shotc.planning.clock.ideals import ideal_places
from shotc.planning.clock.run_up import lead_in, way_time
from shotc.planning.clock.shot import LESS_SHARE, NoMotion, TimedShot
from shotc.planning.framing.moments import placed_at
from shotc.planning.free_space import FreeSpace, bounds_slack
from shotc.planning.path.shots import Failure
from shotc.rounding import down, up

MOST_TRIES = 10
LATE_TRIES = 4  # tries in a row at which a drone gains nothing, after which it is given up
CLOSE_S = 0.3  # seconds between a late start and one in time, at which the search ends
SPARE_S = 0.1  # seconds by which a drone is early if the start is free
STEEPEST_RATIO = 0.95  # largest growth of the correction per second of delay
HORIZON_S = 300.0  # longest delay of a start, seconds
FINE_S = 0.1  # seconds between the first candidates
TRIES_PER_SCALE = 100  # candidates after which their spacing has doubled
SHORTEST_S = 1.0  # least seconds of track for a shot
LATER_S = (2.0, 4.0, 7.0, 10.0, 14.0, 18.0, 22.0, 26.0, 30.0, 35.0, 40.0)
"""Seconds by which a start is put off, to find a motion or a transfer to it."""
ROUNDING_S = 1e-6  # seconds
SLIGHT_M = 0.02  # metres, tolerance of a deviation
WHOLE_S, SOON_S, WIDER_RATIO = 1.0, 40.0, 1.05
"""Spacing of the starts that are tried for a fence, seconds; the delay from which on they lie farther apart,
and the ratio of two successive delays then."""


@dataclass(frozen=True, slots=True)
class OutsideTrack:
    """A shot that lasts longer than its target's track.

    start : earliest start, mission time in seconds
    left : rest of the track from then on, seconds
    """

    target: str
    start: float
    left: float


@dataclass(frozen=True, slots=True)
class Meets:
    """A transfer that comes too near to a target in all its variants.

    start : a start of the next shot with a clear transfer, seconds; None if none was found
    """

    met: TargetConflict
    start: float | None = None


@dataclass(frozen=True, slots=True)
class TooLate:
    """A shot that its drone cannot reach at the fixed start.

    late : delay at that start, seconds
    earliest : a feasible start, or None
    outside : the target whose track is too short from then on, or None
    before : phases of the drone until then, or until it arrives too late
    run_up : duration of the run-up, seconds; None if it goes on from the film before
    """

    late: float
    earliest: float | None
    outside: OutsideTrack | None
    before: tuple[Phase, ...]
    run_up: float | None


@dataclass(frozen=True, slots=True, eq=False)
class Reached:
    """A planned shot, the transfer to it, and the drone's delay there in seconds.

    placed : the shot as it is planned; it is shorter than stated if the track of its target ends first
    ends_aside : whether the shot begins, and whether it ends, away from moving obstacles
    cut : the leg before it with a shorter run-out, if this one goes on from there
    """

    placed: PlacedShot
    shot: TimedShot
    transfer: Transfer
    late: float
    ends_aside: tuple[bool, bool]
    cut: ClockLeg | None = None

    def better(self, near: Reached) -> bool:
        """Return whether this shot, with other ends, is better than one whose transfer or run-ups lack
        clearances.
        """
        if self.transfer.met is not None or self.late > max(0.0, near.late):
            return False
        return near.transfer.met is not None or (
            max(self.shot.lacks) < LESS_SHARE * max(near.shot.lacks)
            and self.shot.off <= near.shot.off + SLIGHT_M
        )


ClockFailure = Failure | NoMotion | OutsideTrack | Meets | TooLate
Lateness = Callable[[float], float]
"""The drone's delay in seconds for a start."""
Reach = Callable[[PlacedShot, float], Reached | ClockFailure]
"""Plans a shot for a start, and the transfer to it."""
ReachFrom = Callable[[tuple[EndRequirement, ...]], Reached | ClockFailure]
"""Plans a shot, and the transfer to it, with requirements on its ends."""


def straight_lateness(mission: MissionIR, drone: Drone, shot: Shot, here: Array, ready: float) -> Lateness:
    """Return the delay of a straight flight to a shot.

    here : where the flight begins, W, metres, shape (3,)
    ready : when it begins, mission time, seconds
    """

    def late(start: float) -> float:
        before = lead_in(mission, drone, shot, start)
        return ready + way_time(drone.limits, before.rest - here) - (start - before.seconds)

    return late


def tracks_begin(mission: MissionIR, placed: PlacedShot) -> float:
    """Return the mission time from which on all tracks that a shot depends on are known, seconds."""
    tracks = (mission.target(name).track for name in carriers(placed.shot))
    return max((track.since for track in tracks if track is not None), default=0.0)


def outside(mission: MissionIR, placed: PlacedShot, start: float) -> OutsideTrack | None:
    """Return the target whose track ends before a shot that begins at ``start`` does; None if there
    is none.
    """
    end = start + (placed.shot.timing.duration or 0.0)
    for name in carriers(placed.shot):
        track = mission.target(name).track
        if track is not None and end > track.until + ROUNDING_S:
            return OutsideTrack(name, start, max(0.0, track.until - start))
    return None


def inside(mission: MissionIR, space: FreeSpace, placed: PlacedShot, start: float) -> float:
    """Return the first start, from ``start`` on, at which the shot's ideal lies within all fences.

    Its target may be outside of them at first. If it is not inside for the whole shot before its track ends,
    or within ``HORIZON_S``, ``start`` is returned.
    """

    def fits(first: float, shot: Shot | None = None) -> bool:
        """Return whether a shot, by default as it is placed for a start, is inside for the start."""
        shot = placed_at(mission, placed, first).shot if shot is None else shot
        duration = shot.timing.duration or 0.0
        times = first + np.append(np.arange(0.0, duration, WHOLE_S), duration)
        return bool(bounds_slack(space, ideal_places(mission, shot, first, times)).min() >= 0.0)

    if outside(mission, placed, start) is not None or fits(start):
        return start
    tried = list(takewhile(lambda first: outside(mission, placed, first) is None, _later_starts(start)))
    # Placing a framing takes long. Placed for the first start, it is a good guess for the later ones.
    moved = placed_at(mission, placed, start).shot
    guess = next((i for i in range(len(tried)) if fits(tried[i], moved)), 0)
    index = next((i for i in (*range(guess, len(tried)), *range(guess)) if fits(tried[i])), None)
    if index is None:
        return start
    if index == guess:  # starts before the guess may fit as well
        index = next((i + 1 for i in range(guess - 1, -1, -1) if not fits(tried[i])), 0)
    last = start if index == 0 else tried[index - 1]
    earlier: list[float] = np.arange(tried[index] - WHOLE_S, last, -WHOLE_S).tolist()
    return min(takewhile(fits, earlier), default=tried[index])


def _later_starts(start: float) -> Iterator[float]:
    """Yield starts after a start, first ``WHOLE_S`` apart, then farther and farther."""
    delay = WHOLE_S
    while delay <= HORIZON_S:
        yield start + delay
        delay = max(delay + WHOLE_S, delay * WIDER_RATIO if delay >= SOON_S else 0.0)


def put_off(
    mission: MissionIR, reach: Reach, placed: PlacedShot, start: float, about: Lateness
) -> Reached | ClockFailure:
    """Return a shot planned for the first start, from ``start`` on, that its drone reaches in time.

    If the track ends too soon, the shot is planned for the rest of the track. A result that is late means
    that the drone does not catch up.

    about : estimate of the delay for a start
    """
    there: Reached | None = None  # earliest start known to be in time
    span = (start, inf)  # last start known to be late, and that one
    off: list[tuple[float, float]] = []  # starts tried, and errors of the estimate
    now: float | None = start
    reached: Reached | ClockFailure
    for _ in range(MOST_TRIES):
        assert now is not None
        reached = _as_long(mission, reach, placed, now)
        if not isinstance(reached, Reached):
            break
        off.append((now, reached.late - about(now)))
        if reached.late <= 0.0:
            there, span = reached, (span[0], now)
        else:
            span = (now, span[1])
        now = _first(about, off, span)
        if now is None:
            break
    return there or reached


def later(reach: Reach, placed: PlacedShot, start: float) -> Reached | None:
    """Return the shot at the first of some later starts to which there is a clear transfer."""
    for more in LATER_S:
        reached = reach(placed, start + more)
        if isinstance(reached, Reached) and reached.late <= 0.0 and reached.transfer.clear:
            return reached
    return None


def too_late(
    phases: Iterable[Phase], requested: Reached, first: Reached, short: OutsideTrack | None
) -> TooLate:
    """Return the failure of a shot that its drone reaches too late.

    phases : of the drone with the shot at its earliest feasible start, or at the last start that was tried
    first : the shot then
    """
    leg, there = first.shot.leg, first.late <= ROUNDING_S
    before = [phase for phase in phases if phase.end <= leg.start + ROUNDING_S]
    if not there:
        before[-1] = replace(before[-1], end=leg.start + first.late)
    run_up = leg.start - float(leg.curve.start) if first.cut is None else None
    return TooLate(requested.late, leg.start if there else None, short, tuple(before), run_up)


def _first(about: Lateness, off: list[tuple[float, float]], span: tuple[float, float]) -> float | None:
    """Return the first start within a span that is in time by the corrected estimate; None if there is none.

    If the correction grew, that may be the cost of another transfer, or of a wait for somebody who passes,
    which occurs once. Therefore the correction is taken as constant until some tries in a row gain nothing.
    """
    (before, less), (last, lack) = off[-2:] if len(off) > 1 else (off[-1], off[-1])
    rate = (lack - less) / (last - before) if last != before else 0.0
    start = _soonest(about, off, span, min(max(rate, 0.0), STEEPEST_RATIO))
    late = [about(at) + lack for at, lack in off[-LATE_TRIES:]]
    gains_nothing = len(late) == LATE_TRIES and all(a <= b for a, b in pairwise(late))
    return _soonest(about, off, span, 0.0) if start is None and not gains_nothing else start


def _soonest(
    about: Lateness, off: list[tuple[float, float]], span: tuple[float, float], rate: float
) -> float | None:
    """Return the same for a correction that grows at ``rate`` from the last try on."""
    (last, lack), begin = off[-1], span[0] + FINE_S
    latest = min(span[1] - CLOSE_S, off[0][0] + HORIZON_S)
    steps = 0
    while (now := up(begin + FINE_S * steps * (1.0 + steps / TRIES_PER_SCALE))) <= latest:
        if about(now) + lack + rate * (now - last) <= -SPARE_S:
            return now
        steps += 1
    return None


def _as_long(mission: MissionIR, reach: Reach, placed: PlacedShot, start: float) -> Reached | ClockFailure:
    """Plan a shot for a start, with its own duration or the rest of the track."""
    short = outside(mission, placed, start)
    if short is None:
        return reach(placed, start)
    # A shot with keyframes is not cut short, because they have their times.
    if short.left < SHORTEST_S or is_keyed(placed.shot):
        return short
    return reach(lasting(placed, short.left), start)


def lasting(placed: PlacedShot, seconds: float) -> PlacedShot:
    """Return a shot with another duration, rounded down."""
    shot = placed.shot
    timing = shot.timing._replace(duration=down(seconds))
    return placed._replace(shot=shot._replace(timing=timing))
