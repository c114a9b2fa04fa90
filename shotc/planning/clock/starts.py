"""When a shot on its own clock can begin at the earliest, for its target moves on while its start is put off.

Each try plans the shot for a start, and the way to where it begins then. The next start is the first at which
the drone is there by a rough estimate of its lateness, corrected by how far that was off at the tries before.
So a shot whose target comes to the drone begins as it comes by, not once the drone has followed it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import inf

import numpy as np

from shotc.ir.keyed import carriers, is_keyed
from shotc.ir.keyframes import PlacedShot
from shotc.ir.mission import MissionIR
from shotc.ir.phases import Phase
from shotc.planning.clock.departure import Meeting, Transfer
from shotc.planning.clock.ideals import ideal_places
from shotc.planning.clock.shot import LESS_SHARE, NoMotion, TimedShot
from shotc.planning.framing.moments import placed_at
from shotc.planning.free_space import FreeSpace, bounds_slack
from shotc.planning.path.shots import Failure
from shotc.rounding import down, up

TRIES = 10
GIVES_UP = 4  # tries, after which a drone that falls behind ever more is given up
CLOSE_S = 0.3  # seconds between starts that are late and in time, the second of which is taken
SPARE_S = 0.1  # seconds by which a drone is early where the mission does not fix the start
STEEPEST_RATE = 0.95  # seconds that an estimate may get worse by with each second that the start is put off
HORIZON_S = 300.0  # seconds that a start may be put off by
FINE_S = 0.1  # seconds between the first starts that are looked at
COARSER = 100  # of them, after which they lie twice as far apart
SHORTEST_S = 1.0  # seconds of track that are worth a shot
ROUNDING_S = 1e-6  # seconds
SLIGHT_M = 0.02  # metres, of which nobody takes notice
SOON_S, WHOLE_S = 40.0, 1.0
"""Seconds by which a start is put off for a fence, and between the starts that are looked at."""


@dataclass(frozen=True, slots=True)
class OutsideTrack:
    """A shot that cannot be filmed while its target's track lasts.

    start : when it would begin at the earliest; left : what there is of the track then, both seconds
    """

    target: str
    start: float
    left: float


@dataclass(frozen=True, slots=True)
class Meets:
    """An unfilmed way on which a target is met, whichever way it is.

    start : seconds, a start of the shot that it leads to with which nothing is met; None if none was found
    """

    met: Meeting
    start: float | None = None


@dataclass(frozen=True, slots=True)
class TooLate:
    """A shot whose drone is not there at the start that the mission fixes.

    late : seconds, at that start; earliest : a start at which it is there, or None
    outside : the target whose track is too short for the shot from then on, or None
    before : what the drone does until then, or until it is there too late; run_up : the last of that, seconds
    """

    late: float
    earliest: float | None
    outside: OutsideTrack | None
    before: tuple[Phase, ...]
    run_up: float


@dataclass(frozen=True, slots=True, eq=False)
class Reached:
    """A planned shot, the way to it, and by how many seconds the drone is late there.

    aside : whether it begins and whether it ends aside of what passes
    """

    shot: TimedShot
    way: Transfer
    late: float
    aside: tuple[bool, bool]

    def better(self, near: Reached) -> bool:
        """Tell whether a shot whose ends lead elsewhere is better than one whose ways are in trouble."""
        if self.way.met is not None or self.late > max(0.0, near.late):
            return False
        return near.way.met is not None or (
            max(self.shot.lacks) < LESS_SHARE * max(near.shot.lacks)
            and self.shot.off <= near.shot.off + SLIGHT_M
        )


ClockFailure = Failure | NoMotion | OutsideTrack | Meets | TooLate
Lateness = Callable[[float], float]
"""By how many seconds a drone is late for a start."""
Reach = Callable[[PlacedShot, float], Reached | ClockFailure]
"""Plans a shot for a start, and the way to it."""


def outside(mission: MissionIR, placed: PlacedShot, start: float) -> OutsideTrack | None:
    """Return the target whose track ends before a shot that begins at ``start`` does; None without one."""
    end = start + (placed.shot.timing.duration or 0.0)
    for name in carriers(placed.shot):
        track = mission.target(name).track
        if track is not None and end > track.until + ROUNDING_S:
            return OutsideTrack(name, start, max(0.0, track.until - start))
    return None


def inside(mission: MissionIR, space: FreeSpace, placed: PlacedShot, start: float) -> float:
    """Return the first start, from one on, at which no fence keeps the camera from its place.

    Its target may still be where no drone may go. The start that is given, where there is none soon.
    """
    lasts = placed.shot.timing.duration or 0.0
    for more in np.arange(0.0, SOON_S + WHOLE_S, WHOLE_S):
        first = start + float(more)
        if outside(mission, placed, first) is not None:
            break
        there = placed_at(mission, placed, first).shot
        times = first + np.append(np.arange(0.0, lasts, WHOLE_S), lasts)
        if bounds_slack(space, ideal_places(mission, there, first, times)).min() >= 0.0:
            return first
    return start


def put_off(
    mission: MissionIR, reach: Reach, placed: PlacedShot, start: float, about: Lateness
) -> Reached | ClockFailure:
    """Return a shot planned for the first start, from ``start`` on, at which its drone is there.

    about : by how many seconds it is late for a start, roughly
    Where the track ends too soon, the shot is planned as long as the track lasts. One that is returned late
    has a drone that does not catch up.
    """
    there: Reached | None = None  # the first start known at which it is there
    span = (start, inf)  # the last start known at which it is late, and that one
    off: list[
        tuple[float, float]
    ] = []  # starts that were tried, and by how much later they are than estimated
    now: float | None = start
    reached: Reached | ClockFailure
    for _ in range(TRIES):
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


def _first(about: Lateness, off: list[tuple[float, float]], span: tuple[float, float]) -> float | None:
    """Return the first start inside a span at which a drone is there by the corrected estimate; or None.

    That the correction grew may be the cost of another way there, which is paid once: a few times it is taken
    to stay as it is before the drone is given up.
    """
    (before, less), (last, lack) = off[-2:] if len(off) > 1 else (off[-1], off[-1])
    rate = (lack - less) / (last - before) if last != before else 0.0
    found = _soonest(about, off, span, min(max(rate, 0.0), STEEPEST_RATE))
    return _soonest(about, off, span, 0.0) if found is None and len(off) < GIVES_UP else found


def _soonest(
    about: Lateness, off: list[tuple[float, float]], span: tuple[float, float], rate: float
) -> float | None:
    """Return the same, for an estimate that gets worse at a rate from the last try on."""
    (last, lack), begin = off[-1], span[0] + FINE_S
    until = min(span[1] - CLOSE_S, off[0][0] + HORIZON_S)
    steps = 0
    while (now := up(begin + FINE_S * steps * (1.0 + steps / COARSER))) <= until:
        if about(now) + lack + rate * (now - last) <= -SPARE_S:
            return now
        steps += 1
    return None


def _as_long(mission: MissionIR, reach: Reach, placed: PlacedShot, start: float) -> Reached | ClockFailure:
    """Plan a shot for a start, as long as it is to be or as the track lasts."""
    short = outside(mission, placed, start)
    if short is None:
        return reach(placed, start)
    # Keyframes have their times: what they tell is not cut short.
    if short.left < SHORTEST_S or is_keyed(placed.shot):
        return short
    return reach(lasting(placed, short.left), start)


def lasting(placed: PlacedShot, seconds: float) -> PlacedShot:
    """Return a shot that is to last so long, less what is lost to rounding."""
    shot = placed.shot
    timing = shot.timing._replace(duration=down(seconds))
    return placed._replace(shot=shot._replace(timing=timing))
