"""Shots on their own clock told by keyframes: their times, their places, and what is sure before planning.

Such a shot may begin whenever its drone is there, and its target moves on meanwhile. What depends on when is
judged here where the mission says when the shot begins, and in planning where it does not.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from math import cos, sin

from shotc.diag.model import Diagnostic
from shotc.ir.begins import first_start
from shotc.ir.keyed import arrivals, in_order, is_keyed, settled
from shotc.ir.limits import Vec3
from shotc.ir.mission import Keyframe, MissionIR, Shot, Target
from shotc.ir.origin import KeyPath
from shotc.passes.resolve.geometry import blocked, too_low
from shotc.passes.resolve.timing import SLACK, too_long
from shotc.planning.clearances import free_place, move, obstacles_of
from shotc.planning.framing.moments import moments
from shotc.rounding import at_least


def with_times(mission: MissionIR) -> MissionIR:
    """Return the mission with all such shots as they are if they begin as early as they may."""
    shots = (
        settled(mission, shot, first_start(mission, shot)) if is_keyed(shot) else shot
        for shot in mission.shots
    )
    return mission._replace(shots=tuple(shots))


def check_times(mission: MissionIR, shot: Shot) -> Iterator[Diagnostic]:
    """Yield what is wrong with the times of keyframes, or with how long the shot lasts."""
    duration, drone = shot.timing.duration or 0.0, mission.drone(shot.drone)
    if duration > drone.endurance:
        yield too_long(mission, shot, drone, duration)
        return
    holds = sum(k.hold for k in shot.keyframes)
    if holds >= duration > 0.0:
        held = [k for k in shot.keyframes if k.hold > 0]
        yield Diagnostic(
            "K003",
            f"shot `{shot.id}` holds longer than it lasts",
            tuple(mission.origins.value((*k.path, "hold")) for k in held),
            (f"its holds alone last {holds:.1f} s; the shot is given {duration:.1f} s",),
            f"give it more than {at_least(holds, 1)} s",
        )
        return
    yield from _order(mission, shot, duration)


def _order(mission: MissionIR, shot: Shot, duration: float) -> Iterator[Diagnostic]:
    """Yield keyframes whose time is not after the one before, with its holds, or is after the end."""
    known = [(0, 0.0), *((i, k.time) for i, k in enumerate(shot.keyframes) if k.time is not None)]
    for (i, start), (j, end) in pairwise(known):
        a, b = shot.keyframes[i], shot.keyframes[j]
        holds = sum(k.hold for k in shot.keyframes[i:j])
        if j == 0 or end - start > holds + SLACK:
            continue
        labels = (
            mission.origins.value((*b.path, "time")),
            mission.origins.value((*a.path, "time"), "the earlier keyframe"),
        )
        held = f", and {holds:.1f} s of holds lie between" if holds else ""
        note = f"keyframe {j + 1} is at {end:.1f} s, keyframe {i + 1} before it at {start:.1f} s{held}"
        help_ = f"set it later than {at_least(start + holds, 1)} s"
        yield Diagnostic("K001", "keyframe times do not rise", labels, (note,), help_)
        return
    i, start = known[-1]
    last = len(shot.keyframes) - 1
    least = start + sum(k.hold for k in shot.keyframes[i:])
    if least < duration - SLACK or (i == last and least <= duration + SLACK):
        return
    yield Diagnostic(
        "K002",
        "a keyframe ends after its shot",
        (mission.origins.value((*shot.keyframes[i].path, "time")),),
        (f"with what follows it ends at {least:.1f} s; the shot lasts {duration:.1f} s",),
        f"give the shot a duration of {'' if i == last else 'more than '}{at_least(least, 1)} s",
    )


def check_carried(mission: MissionIR, shot: Shot) -> Iterator[tuple[KeyPath, Diagnostic]]:
    """Yield the faults of where keyframes are, with their lines; each as it is when the camera is there."""
    if not in_order(shot):
        return
    drone, start = mission.drone(shot.drone), first_start(mission, shot)
    times = (start + t for t in arrivals(shot))
    for keyframe, then, t in zip(shot.keyframes, moments(mission, shot, start), times, strict=True):
        beside = None if keyframe.beside is None else mission.target(keyframe.beside.target)
        sure = beside is None or shot.timing.start is not None
        found = []
        if sure or (beside is not None and _level(beside)):
            found += list(too_low(mission, shot, drone, keyframe.path, [keyframe]))
        for obstacle in obstacles_of(then, drone):
            if not sure and (beside is None or obstacle.path != beside.path):
                continue
            if beside is None and shot.timing.start is None and _moves(mission, obstacle.path):
                continue
            for fault in blocked(then, shot, [keyframe], obstacle, list):
                place = free_place(then, drone, keyframe.at, obstacle)
                told = beside is not None and keyframe.placed and place is not None
                help_ = _by_offset(mission, keyframe, place, t) if told and place is not None else fault.help
                found.append(fault._replace(help=help_))
        yield from ((keyframe.path, fault) for fault in found)


def _level(target: Target) -> bool:
    """Tell whether a target stays at one height, so that what is over the ground beside it is always so."""
    track = target.track
    return track is None or (len({p[2] for p in track.points}) == 1 and track.after[2] == 0.0)


def _moves(mission: MissionIR, path: KeyPath) -> bool:
    return any(t.path == path and t.track is not None for t in mission.targets)


def _by_offset(mission: MissionIR, keyframe: Keyframe, place: Vec3, t: float) -> str:
    """Say how to move a keyframe beside a target to another place, in the numbers that it is written in."""
    assert keyframe.beside is not None
    track, offset = mission.target(keyframe.beside.target).track, keyframe.beside.offset
    x, y, z = (b - a for a, b in zip(keyframe.at, place, strict=True))
    if keyframe.beside.turns and track is not None:
        c, s = cos(track.heading(t)), sin(track.heading(t))
        x, y = c * x + s * y, c * y - s * x
    written = ", ".join(f"{round(a + b, 2) + 0.0:.2f}" for a, b in zip(offset, (x, y, z), strict=True))
    return f"{move(keyframe.at, place).rpartition(', to ')[0]}, by `offset: [{written}]`"
