"""Keyframes of moving targets, placed by the picture at the time when the camera is there.

That picture depends on the start of the shot. Where the mission does not fix the start, the shot is placed
for the earliest one, and again by ``placed_at`` for the one at which it starts.
"""

from __future__ import annotations

from shotc.ir.framed import at_start
from shotc.ir.keyed import arrivals, is_keyed, settled
from shotc.ir.keyframes import PlacedKeyframe, PlacedShot
from shotc.ir.mission import Keyframe, MissionIR, Shot, frozen
from shotc.planning.framing.placing import place_shot
from shotc.rounding import up


def placed_at(mission: MissionIR, placed: PlacedShot, start: float) -> PlacedShot:
    """Return a placed shot for a first frame at mission time ``start``, seconds."""
    shot = at_start(mission, placed.shot, start)
    if not is_keyed(shot) or shot is placed.shot:
        return placed._replace(shot=shot)
    return placed._replace(shot=shot, keyframes=_placed(mission, shot, start))


def slowed(mission: MissionIR, placed: PlacedShot, start: float, times: float) -> PlacedShot:
    """Return a shot with its duration and its keyframes' times multiplied by ``times``."""
    shot = placed.shot
    timing = shot.timing._replace(duration=up((shot.timing.duration or 0.0) * times, 1))
    later = tuple(k if k.time is None else k._replace(time=up(k.time * times, 1)) for k in shot.keyframes)
    longer = settled(mission, shot._replace(timing=timing, keyframes=later), start)
    return placed._replace(shot=longer, keyframes=_placed(mission, longer, start))


def moments(mission: MissionIR, shot: Shot, start: float) -> tuple[MissionIR, ...]:
    """Return, for every keyframe, the mission with its targets at their places when the camera is there."""
    return tuple(frozen(mission, start + t) for t in arrivals(shot))


def is_sure(mission: MissionIR, shot: Shot, keyframe: Keyframe) -> bool:
    """Return whether a keyframe's picture is independent of the shot's start, or the mission fixes
    the start.
    """
    if shot.timing.start is not None or not is_keyed(shot):
        return True
    if keyframe.beside is not None and keyframe.beside.turns:
        return False
    beside = None if keyframe.beside is None else keyframe.beside.target
    moves = keyframe.target is not None and mission.target(keyframe.target).track is not None
    at_point = keyframe.aim is not None and len(keyframe.aim) == 3
    return (keyframe.target if moves else None) == beside and not (at_point and beside is not None)


def _placed(mission: MissionIR, shot: Shot, start: float) -> tuple[PlacedKeyframe, ...]:
    return place_shot(mission, shot, moments(mission, shot, start))[0]
