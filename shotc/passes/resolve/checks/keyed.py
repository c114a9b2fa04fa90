"""Checks of shots on their own clock with keyframes: times, places, and what is known before planning.

Such a shot may begin whenever its drone arrives, and its target moves meanwhile. What depends on the start is
checked here if the mission gives the start; otherwise planning checks it.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from math import ceil, cos, degrees, floor, sin

from shotc.diag.model import Diagnostic
from shotc.geom.ease import MOST_PARTS
from shotc.ir.begins import first_start
from shotc.ir.drone import LensRange
from shotc.ir.keyed import arrivals, in_order, zoom_parts
from shotc.ir.limits import Vec3
from shotc.ir.mission import Keyframe, MissionIR, Shot
from shotc.ir.origin import KeyPath
from shotc.ir.target import Target
from shotc.passes.resolve.checks.places import blocked, too_low
from shotc.planning.clearances import clearances_of, free_place, move
from shotc.planning.framing.moments import moments
from shotc.rounding import at_least, up

ZOOM_RATE_SHARE = 1.0 - 1.0 / MOST_PARTS - 1e-5
"""Largest mean rate of a zoom over the lens's rate, because the zoom accelerates and decelerates."""


def check_carried(mission: MissionIR, shot: Shot) -> Iterator[tuple[KeyPath, Diagnostic]]:
    """Yield the faults of the places of keyframes, with their key paths, each at the time of the keyframe."""
    if not in_order(shot):
        return
    yield from _zooms(mission, shot)
    drone, start = mission.drone(shot.drone), first_start(mission, shot)
    times = (start + t for t in arrivals(shot))
    for keyframe, then, t in zip(shot.keyframes, moments(mission, shot, start), times, strict=True):
        beside = None if keyframe.beside is None else mission.target(keyframe.beside.target)
        sure = beside is None or shot.timing.start is not None
        diagnostics = []
        if sure or (beside is not None and _level(beside)):
            diagnostics += list(too_low(mission, shot, drone, keyframe.path, [keyframe]))
        for obstacle in clearances_of(then, drone):
            if not sure and (beside is None or obstacle.owner.path != beside.path):
                continue
            if beside is None and shot.timing.start is None and _moves(mission, obstacle.owner.path):
                continue
            for fault in blocked(then, shot, [keyframe], obstacle, list):
                place = free_place(then, drone, keyframe.at, obstacle)
                apart = beside is not None and keyframe.placed and place is not None
                help_ = _by_offset(mission, keyframe, place, t) if apart and place is not None else fault.help
                diagnostics.append(fault._replace(help=help_))
        yield from ((keyframe.path, fault) for fault in diagnostics)


def _zooms(mission: MissionIR, shot: Shot) -> Iterator[tuple[KeyPath, Diagnostic]]:
    """Yield the zooms for which the lens is too slow."""
    lens, arrive = mission.drone(shot.drone).lens, arrivals(shot)
    for i, (a, b) in enumerate(pairwise(shot.keyframes)):
        seconds = arrive[i + 1] - arrive[i] - a.hold
        if lens is None or zoom_parts(shot, lens)[i] is not None or seconds <= 0.0:
            continue
        change, reach = abs(b.hfov - a.hfov), ZOOM_RATE_SHARE * lens.rate * seconds
        needed = change / (ZOOM_RATE_SHARE * lens.rate)
        inside = degrees(a.hfov + (reach if b.hfov > a.hfov else -reach))
        nearer = f"{(floor if b.hfov > a.hfov else ceil)(10 * inside) / 10:g}"
        label = mission.origins.value((*b.path, "hfov"))
        yield (
            b.path,
            Diagnostic(
                "K020",
                f"the lens of `{shot.drone}` is too slow for a zoom from {degrees(a.hfov):.4g} to"
                f" {degrees(b.hfov):.4g} deg in {seconds:.3g} s",
                (label,),
                (
                    f"it has {degrees(lens.rate):.4g} deg/s (`zoom_rate`), and speeds up and slows down:"
                    f" the zoom takes {at_least(needed)} s",
                ),
                f"write `hfov: {nearer} deg`{_longer(shot, lens, i, needed)}",
            ),
        )


def _longer(shot: Shot, lens: LensRange, i: int, needed: float) -> str:
    """Return the duration that gives the zoom from keyframe ``i`` its time, or else that time."""
    arrive, duration = arrivals(shot), shot.timing.duration
    holds = sum(k.hold for k in shot.keyframes)
    if duration is not None and all(k.time is None for k in shot.keyframes):
        share = needed / (arrive[i + 1] - arrive[i] - shot.keyframes[i].hold)
        seconds = up(holds + (duration - holds) * share, 1)
        longer = shot._replace(timing=shot.timing._replace(duration=seconds))
        if zoom_parts(longer, lens)[i] is not None:
            return f", or write `duration: {seconds:g} s`"
    return f", or give it {at_least(needed)} s"


def _level(target: Target) -> bool:
    """Return whether a target stays at one height, so that the height beside it is constant."""
    track = target.track
    return track is None or (len({p[2] for p in track.points}) == 1 and track.after[2] == 0.0)


def _moves(mission: MissionIR, path: KeyPath) -> bool:
    return any(t.path == path and t.track is not None for t in mission.targets)


def _by_offset(mission: MissionIR, keyframe: Keyframe, place: Vec3, t: float) -> str:
    """Return how to move a keyframe beside a target to another place, in its own numbers."""
    assert keyframe.beside is not None
    track, offset = mission.target(keyframe.beside.target).track, keyframe.beside.offset
    x, y, z = (b - a for a, b in zip(keyframe.at, place, strict=True))
    if keyframe.beside.turns and track is not None:
        c, s = cos(track.heading(t)), sin(track.heading(t))
        x, y = c * x + s * y, c * y - s * x
    written = ", ".join(f"{round(a + b, 2) + 0.0:.2f}" for a, b in zip(offset, (x, y, z), strict=True))
    return f"{move(keyframe.at, place).rpartition(', to ')[0]}, by `offset: [{written}]`"
