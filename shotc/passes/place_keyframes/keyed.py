"""Keyframes of moving targets, and the faults of those whose picture is known."""

from __future__ import annotations

from collections.abc import Sequence
from math import degrees

from shotc.diag.model import Diagnostic
from shotc.geom.camera import heading_of
from shotc.ir.begins import first_start
from shotc.ir.keyframes import PlacedShot, PlacedSubject
from shotc.ir.mission import Keyframe, MissionIR, Shot
from shotc.passes.place_keyframes.faults import report, while_following
from shotc.planning.framing.moments import is_sure, moments
from shotc.planning.framing.placing import NORTH_RAD, Unmet, explicit_aim, place_shot, setting_of
from shotc.rounding import at_least


def place_keyed(mission: MissionIR, shot: Shot) -> tuple[PlacedShot, list[Diagnostic]]:
    """Return a shot with its keyframes placed, and the faults of those whose picture is known."""
    start = first_start(mission, shot)
    then = moments(mission, shot, start)
    keyframes, misses = place_shot(mission, shot, then)
    subjects = tuple(PlacedSubject(s.target, None, s.size, s.view, s.path) for s in shot.subjects)
    sure = [is_sure(mission, shot, k) for k in shot.keyframes]
    faults = _diagnostics(shot, then, misses, sure)
    if all(sure):
        faults += while_following(mission, shot.keyframes, keyframes)
    return PlacedShot(shot, keyframes, subjects), faults


def misplaced(mission: MissionIR, placed: PlacedShot, start: float) -> list[Diagnostic]:
    """Return the faults of keyframes whose picture was not known before the shot's start, now ``start``.

    placed : the shot at that start
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
    diagnostics = _diagnostics(shot, then, place_shot(mission, shot, then)[1], open_)
    return [*diagnostics, *(while_following(mission, shot.keyframes, placed.keyframes) if any(open_) else [])]


def _diagnostics(
    shot: Shot, then: Sequence[MissionIR], misses: Sequence[Unmet], judged: Sequence[bool]
) -> list[Diagnostic]:
    """Return the misses of the keyframes that are judged, each for the mission at its own time."""
    diagnostics: list[Diagnostic] = []
    for keyframe, moment, mine in zip(shot.keyframes, then, judged, strict=True):
        missed = [miss for miss in misses if mine and miss.keyframe is keyframe]
        diagnostics += report(moment, shot, missed)
    return list(dict.fromkeys(diagnostics))


def _is_unseen(moment: MissionIR, shot: Shot, keyframe: Keyframe) -> bool:
    """Return whether no part of a keyframe's target is in the picture as the author framed it."""
    if keyframe.aim is None or keyframe.target is None:
        return False
    setting = setting_of(moment, moment.drone(shot.drone), keyframe, NORTH_RAD)
    return not setting.shows(explicit_aim(keyframe.at, keyframe.aim, NORTH_RAD))


def _unseen(moment: MissionIR, shot: Shot, keyframe: Keyframe, start: float) -> Diagnostic:
    setting = setting_of(moment, moment.drone(shot.drone), keyframe, NORTH_RAD)
    straight = setting.aim((0.0, 0.0)) or (NORTH_RAD, 0.0)
    right = f"heading: {degrees(heading_of(straight[0])):.0f} deg, pitch: {degrees(straight[1]):.0f} deg"
    key = "look_at" if keyframe.heading is None else "heading"
    return Diagnostic(
        "M016",
        f"`{keyframe.target}` is not in the picture of a keyframe of shot `{shot.id}`",
        (moment.origins.value((*keyframe.path, key)),),
        (f"the shot begins at {start:.1f} s, so the camera is there when its target is elsewhere",),
        f"write `look_at: {keyframe.target}`, or `{right}`, and `start: {at_least(start)} s` for the shot",
    )
