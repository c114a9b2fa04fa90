"""Keyframes of what moves: placed in the picture of the moment at which the camera is there.

What that picture is depends on when the shot begins. Where the mission does not say, it is placed for the
earliest time there is, and again, by ``placed_at``, for the one at which it begins.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import degrees

from shotc.diag.model import Diagnostic
from shotc.geom.camera import heading_of
from shotc.ir.begins import first_start
from shotc.ir.framed import at_start
from shotc.ir.keyed import arrivals, is_keyed, settled
from shotc.ir.keyframes import PlacedKeyframe, PlacedShot, PlacedSubject
from shotc.ir.mission import Keyframe, MissionIR, Shot, frozen
from shotc.passes.place_keyframes import NORTH, explicit_aim, place_shot, setting_of
from shotc.passes.place_keyframes.faults import Miss, report
from shotc.passes.place_keyframes.turns import while_following
from shotc.rounding import at_least, up


def placed_at(mission: MissionIR, placed: PlacedShot, start: float) -> PlacedShot:
    """Return a placed shot as it is where its first frame is at ``start``, seconds."""
    shot = at_start(mission, placed.shot, start)
    if not is_keyed(shot) or shot is placed.shot:
        return placed._replace(shot=shot)
    return placed._replace(shot=shot, keyframes=_placed(mission, shot, start))


def slowed(mission: MissionIR, placed: PlacedShot, start: float, times: float) -> PlacedShot:
    """Return a shot that takes that many times as long, and is at its keyframes that much later."""
    shot = placed.shot
    timing = shot.timing._replace(duration=up((shot.timing.duration or 0.0) * times, 1))
    later = tuple(k if k.time is None else k._replace(time=up(k.time * times, 1)) for k in shot.keyframes)
    longer = settled(mission, shot._replace(timing=timing, keyframes=later), start)
    return placed._replace(shot=longer, keyframes=_placed(mission, longer, start))


def moments(mission: MissionIR, shot: Shot, start: float) -> tuple[MissionIR, ...]:
    """Return, for every keyframe, the mission with its targets where they are when the camera is there."""
    return tuple(frozen(mission, start + t) for t in arrivals(shot))


def is_sure(mission: MissionIR, shot: Shot, keyframe: Keyframe) -> bool:
    """Tell whether what a keyframe shows is the same whenever its shot begins, or the mission says when."""
    if shot.timing.start is not None or not is_keyed(shot):
        return True
    if keyframe.beside is not None and keyframe.beside.turns:
        return False
    beside = None if keyframe.beside is None else keyframe.beside.target
    moves = keyframe.target is not None and mission.target(keyframe.target).track is not None
    at_point = keyframe.aim is not None and len(keyframe.aim) == 3
    return (keyframe.target if moves else None) == beside and not (at_point and beside is not None)


def place_keyed(mission: MissionIR, shot: Shot) -> tuple[PlacedShot, list[Diagnostic]]:
    """Return a shot with its keyframes placed, and what is wrong with those whose picture is known."""
    start = first_start(mission, shot)
    then = moments(mission, shot, start)
    keyframes, misses = place_shot(mission, shot, then)
    subjects = tuple(PlacedSubject(s.target, None, s.size, s.view, s.path) for s in shot.subjects)
    sure = [is_sure(mission, shot, k) for k in shot.keyframes]
    faults = _told(shot, then, misses, sure)
    if all(sure):
        faults += while_following(mission, shot.keyframes, keyframes)
    return PlacedShot(shot, keyframes, subjects), faults


def misplaced(mission: MissionIR, placed: PlacedShot, start: float) -> list[Diagnostic]:
    """Return what composition cannot give a shot that begins at ``start``, where that was not sure before.

    placed : the shot as it is then
    """
    shot, then = placed.shot, moments(mission, placed.shot, start)
    open_ = [not is_sure(mission, shot, k) for k in shot.keyframes]
    unseen = [
        _unseen(moment, shot, keyframe, start)
        for keyframe, moment, judged in zip(shot.keyframes, then, open_, strict=True)
        if judged and _is_unseen(moment, shot, keyframe)
    ]
    if unseen:
        return unseen
    found = _told(shot, then, place_shot(mission, shot, then)[1], open_)
    return [*found, *(while_following(mission, shot.keyframes, placed.keyframes) if any(open_) else [])]


def _told(
    shot: Shot, then: Sequence[MissionIR], misses: Sequence[Miss], judged: Sequence[bool]
) -> list[Diagnostic]:
    """Return the misses of the keyframes that are judged, each reported for its own moment."""
    found: list[Diagnostic] = []
    for keyframe, moment, mine in zip(shot.keyframes, then, judged, strict=True):
        missed = [miss for miss in misses if mine and miss.keyframe is keyframe]
        found += report(moment, shot, missed)
    return list(dict.fromkeys(found))


def _is_unseen(moment: MissionIR, shot: Shot, keyframe: Keyframe) -> bool:
    """Tell whether no part of a keyframe's target is in the picture as the author framed it."""
    if keyframe.aim is None or keyframe.target is None:
        return False
    setting = setting_of(moment, moment.drone(shot.drone), keyframe, NORTH)
    return not setting.shows(explicit_aim(keyframe.at, keyframe.aim, NORTH))


def _unseen(moment: MissionIR, shot: Shot, keyframe: Keyframe, start: float) -> Diagnostic:
    setting = setting_of(moment, moment.drone(shot.drone), keyframe, NORTH)
    straight = setting.aim((0.0, 0.0)) or (NORTH, 0.0)
    right = f"heading: {degrees(heading_of(straight[0])):.0f} deg, pitch: {degrees(straight[1]):.0f} deg"
    key = "look_at" if keyframe.heading is None else "heading"
    return Diagnostic(
        "M016",
        f"`{keyframe.target}` is not in the picture of a keyframe of shot `{shot.id}`",
        (moment.origins.value((*keyframe.path, key)),),
        (f"the shot begins at {start:.1f} s, so the camera is there when its target is elsewhere",),
        f"write `look_at: {keyframe.target}`, or `{right}`, and `start: {at_least(start)} s` for the shot",
    )


def _placed(mission: MissionIR, shot: Shot, start: float) -> tuple[PlacedKeyframe, ...]:
    return place_shot(mission, shot, moments(mission, shot, start))[0]
