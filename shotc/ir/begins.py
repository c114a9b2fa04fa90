"""When a shot can begin, as far as the mission alone says so. Plain Python."""

from shotc.ir.flown_order import flown_order
from shotc.ir.mission import MissionIR, Shot


def known_start(mission: MissionIR, shot: Shot) -> float | None:
    """Return the earliest mission time at which a shot can begin, seconds, or None where that is not known.

    That is its `start`, or else the end of what it comes after: the shot that it waits for, and the one that
    its drone flies before. An end is known where the beginning and the duration are.
    """
    if shot.timing.start is not None:
        return shot.timing.start
    ends: dict[str, float | None] = {}
    last: dict[str, str] = {}
    for other in flown_order(mission.shots):
        waits = (other.timing.after, last.get(other.drone))
        begin = _latest([ends.get(name) for name in waits if name is not None])
        begin = begin if other.timing.start is None else other.timing.start
        if other.id == shot.id:
            return begin
        lasts = other.timing.duration
        ends[other.id] = None if begin is None or lasts is None else begin + lasts
        last[other.drone] = other.id
    return None


def first_start(mission: MissionIR, shot: Shot) -> float:
    """Return when a shot begins, or where that is not known, when it may at the earliest."""
    if shot.timing.start is not None:
        return shot.timing.start
    tracks = (mission.target(s.target).track for s in shot.subjects)
    known = [track.since for track in tracks if track is not None]
    return max([known_start(mission, shot) or 0.0, *known])


def _latest(times: list[float | None]) -> float | None:
    known = [t for t in times if t is not None]
    return max(known) if known and len(known) == len(times) else None
