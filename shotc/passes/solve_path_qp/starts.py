"""When a shot on its own clock can begin at the earliest, for its target moves on while its start is put off.

Each try plans the shot for a start, and the way to where it begins then. By how much the drone is late there
tells the next start, with the rate at which it catches up once there are two of them. One that is put off by
too much is led back by halves.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from shotc.ir.keyed import carriers, is_keyed
from shotc.ir.keyframes import PlacedShot
from shotc.ir.mission import MissionIR
from shotc.ir.phases import Phase
from shotc.passes.solve_path_qp.departure import Meeting, Way
from shotc.passes.solve_path_qp.shots import Failure
from shotc.passes.timed_route.shot import NoMotion, TimedShot
from shotc.rounding import down, up

TRIES = 10
CLOSE = 0.5  # seconds between starts that are late and in time, the second of which is taken
SPARE = 0.2  # seconds by which a drone is early where the mission does not fix the start
SLOWEST = 0.1  # seconds that it catches up with each second that the start is put off; less is no gain
SHORTEST = 1.0  # seconds of track that are worth a shot
ROUNDING = 1e-6  # seconds


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
    """A planned shot, the way to it, and by how many seconds the drone is late there."""

    shot: TimedShot
    way: Way
    late: float


Trouble = Failure | NoMotion | OutsideTrack | Meets | TooLate
Reach = Callable[[PlacedShot, float], Reached | Trouble]
"""Plans a shot for a start, and the way to it."""


def outside(mission: MissionIR, placed: PlacedShot, start: float) -> OutsideTrack | None:
    """Return the target whose track ends before a shot that begins at ``start`` does; None without one."""
    end = start + (placed.shot.timing.duration or 0.0)
    for name in carriers(placed.shot):
        track = mission.target(name).track
        if track is not None and end > track.until + ROUNDING:
            return OutsideTrack(name, start, max(0.0, track.until - start))
    return None


def put_off(mission: MissionIR, reach: Reach, placed: PlacedShot, start: float) -> Reached | Trouble:
    """Return a shot planned for the first start, from ``start`` on, at which its drone is there.

    Where the track ends too soon, the shot is planned as long as the track lasts. One that is returned late
    has a drone that does not catch up.
    """
    behind: tuple[float, float] | None = None  # the last start at which it is late, and by how much
    there: Reached | None = None  # the first one known at which it is not
    reached: Reached | Trouble
    for _ in range(TRIES):
        reached = _as_long(mission, reach, placed, start)
        if not isinstance(reached, Reached):
            break
        if reached.late <= 0.0:
            there = reached
        else:
            gain = 1.0 if behind is None else (behind[1] - reached.late) / (start - behind[0])
            behind = (start, reached.late)
            if there is None:
                if gain < SLOWEST:
                    break
                start = later(start, reached.late / gain)
                continue
        first = there.shot.leg.start
        if behind is None or first - behind[0] < CLOSE:
            break
        start = up(0.5 * (behind[0] + first))
    return there or reached


def _as_long(mission: MissionIR, reach: Reach, placed: PlacedShot, start: float) -> Reached | Trouble:
    """Plan a shot for a start, as long as it is to be or as the track lasts."""
    short = outside(mission, placed, start)
    if short is None:
        return reach(placed, start)
    # Keyframes have their times: what they tell is not cut short.
    if short.left < SHORTEST or is_keyed(placed.shot):
        return short
    return reach(lasting(placed, short.left), start)


def later(start: float, seconds: float) -> float:
    """Return a start so much later that the drone has time to spare, in whole hundredths of a second."""
    return up(start + seconds + SPARE)


def lasting(placed: PlacedShot, seconds: float) -> PlacedShot:
    """Return a shot that is to last so long, less what is lost to rounding."""
    shot = placed.shot
    timing = shot.timing._replace(duration=down(seconds))
    return placed._replace(shot=shot._replace(timing=timing))
