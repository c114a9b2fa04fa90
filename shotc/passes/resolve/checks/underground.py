"""Targets with a considerable part below the ground, at their place or along their tracks."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from shotc.diag.model import Diagnostic
from shotc.geom.track import Track
from shotc.ir.begins import film_end
from shotc.ir.limits import Vec3
from shotc.ir.mission import MissionIR
from shotc.ir.target import Target
from shotc.kinds.base import stands
from shotc.passes.resolve.lower.world import BURIED_SHARE
from shotc.rounding import at_least
from shotc.spec.heights import AboveGround
from shotc.spec.mission import MissionSpec
from shotc.spec.world import TrackSpec


class _Deepest(NamedTuple):
    """The deepest point of a moving target's foot: its time, and its height above the ground, metres."""

    time: float
    over: float


def check_underground(mission: MissionIR, spec: MissionSpec, level: frozenset[str]) -> Iterator[Diagnostic]:
    """Yield warnings for targets that are deeper in the ground than rounding explains.

    level : names of targets whose tracks follow the ground, whatever their places
    """
    for target in mission.targets:
        written = spec.targets[str(target.path[1])].track
        if target.track is None or written is None:
            yield from _standing(mission, target)
        else:
            yield from _moving(mission, target, written, level=target.name in level)


def _standing(mission: MissionIR, target: Target) -> Iterator[Diagnostic]:
    x, y, _ = target.centre
    if mission.terrain is not None and mission.terrain.height(x, y) is None:
        return
    z = mission.ground(x, y)
    if target.foot[2] >= z - target.height * BURIED_SHARE:
        return
    yield Diagnostic(
        "G018",
        f"target `{target.name}` reaches {z - target.foot[2]:.2f} m into the ground",
        (mission.origins.value((*target.path, "at")),),
        (f"`at` is the middle of its {target.height:.2f} m, and the ground is z = {z:g}",),
        f"if it stands on the ground, put its middle at z = {round(z + target.height / 2, 2):g}",
    )


def _moving(mission: MissionIR, target: Target, written: TrackSpec, *, level: bool) -> Iterator[Diagnostic]:
    assert target.track is not None
    deepest = _deepest(mission, target, target.track)
    if deepest is None or deepest.over >= -target.height * BURIED_SHARE:
        return
    x, y, z = target.foot_at(deepest.time)
    key = "file" if written.file is not None else "start" if written.points is None else "points"
    on_ground = level or _without_heights(written)
    yield Diagnostic(
        "G018",
        f"target `{target.name}` reaches {-deepest.over:.2f} m into the ground on its way",
        (mission.origins.value((*target.path, "track", key)),),
        (
            f"deepest at t = {deepest.time:.2f} s, at ({x:.1f}, {y:.1f}): its foot is at z = {z:.2f}, "
            f"the ground at z = {z - deepest.over:.2f}",
            "it goes straight from row to row, and the rows are its middle",
        ),
        _higher(target, written, -deepest.over, on_ground=on_ground),
    )


def _higher(target: Target, written: TrackSpec, by: float, *, on_ground: bool) -> str:
    """Return a remedy that raises a track out of the ground.

    by : metres
    on_ground : whether its places have no height
    """
    half, closer = target.height / 2, "or give rows nearer to each other there"
    if isinstance(written.lift, AboveGround):
        height = at_least(written.lift.height + by)
        return f"write `lift: {{above: ground, height: {height} m}}` in the track, {closer}"
    now = written.lift if written.lift is not None else half if on_ground else 0.0
    raised = f"write `lift: {at_least(now + by)} m` in the track"
    if on_ground:
        return f"{raised}, {closer}"
    keeps = f"`lift: {{above: ground, height: {at_least(half)} m}}` if it keeps to the ground"
    return f"{raised}, or {keeps}, {closer}"


def _deepest(mission: MissionIR, target: Target, track: Track) -> _Deepest | None:
    """Return where a target is deepest in the ground along its track; None where there is no ground."""
    end = max(film_end(mission), track.times[-1])
    times = (*track.times, *([end] if any(track.after) and end > track.times[-1] else []))
    feet: list[Vec3] = [target.foot_at(t) for t in times]
    if mission.terrain is None or len(times) < 2:
        over = [z - mission.ground(x, y) for x, y, z in feet]
        lowest = min(range(len(over)), key=over.__getitem__)
        return _Deepest(times[lowest], over[lowest])
    least = mission.terrain.least_over(times, feet)
    return None if least is None else _Deepest(*least)


def _without_heights(written: TrackSpec) -> bool:
    """Return whether no place of a track in the mission has a height."""
    places = (written.start,) if written.points is None else written.points
    return all(place is not None and stands(place) for place in places)
