"""The earliest starts of shots, as far as they follow from the mission alone. Plain Python."""

from functools import lru_cache

from shotc.geom.same import Same
from shotc.ir.flown_order import flown_order
from shotc.ir.keyed import carriers
from shotc.ir.mission import MissionIR, Shot


def known_start(mission: MissionIR, shot: Shot) -> float | None:
    """Return the earliest mission time at which a shot can start, seconds, or None if it is unknown.

    It is the shot's `start`. Without one it is the end of the shots before it: the one that it waits for, and
    the previous one of its drone. An end is known if the start and the duration are.
    """
    if shot.timing.start is not None:
        return shot.timing.start
    return _starts(Same(mission.shots)).get(shot.id)


def first_start(mission: MissionIR, shot: Shot) -> float:
    """Return the start of a shot, or if it is unknown a lower bound on it, seconds."""
    if shot.timing.start is not None:
        return shot.timing.start
    tracks = (mission.target(name).track for name in carriers(shot))
    known = [track.since for track in tracks if track is not None]
    return max([known_start(mission, shot) or 0.0, *known])


def film_end(mission: MissionIR) -> float:
    """Return the end of the last shot, or if it is unknown the longest endurance, seconds."""
    ends: list[float] = []
    for shot in mission.shots:
        begin, duration = known_start(mission, shot), shot.timing.duration
        if begin is None or duration is None:
            return max((drone.endurance for drone in mission.drones), default=0.0)
        ends.append(begin + duration)
    return max(ends, default=0.0)


@lru_cache(maxsize=8)
def _starts(shots: Same[tuple[Shot, ...]]) -> dict[str, float | None]:
    """Return the earliest start of each shot by id; cached, because many parts use it."""
    starts: dict[str, float | None] = {}
    ends: dict[str, float | None] = {}
    last: dict[str, str] = {}
    for shot in flown_order(shots.it):
        waits = (shot.timing.after, last.get(shot.drone))
        begin = _latest([ends.get(name) for name in waits if name is not None])
        begin = begin if shot.timing.start is None else shot.timing.start
        duration = shot.timing.duration
        starts.setdefault(shot.id, begin)
        ends[shot.id] = None if begin is None or duration is None else begin + duration
        last[shot.drone] = shot.id
    return starts


def _latest(times: list[float | None]) -> float | None:
    known = [t for t in times if t is not None]
    return max(known) if known and len(known) == len(times) else None
