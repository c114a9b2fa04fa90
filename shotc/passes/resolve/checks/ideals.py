"""Checks of shots on their own clock by their ideal: the track's times, the drone's speed, the height.

The ideal is the position of the camera without limits. A plan may leave it, but not for the whole shot.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import inf

from shotc.diag.model import Diagnostic
from shotc.geom.track import Track
from shotc.ir.begins import known_start
from shotc.ir.keyed import carriers, in_order, is_keyed
from shotc.ir.mission import MissionIR, Shot
from shotc.passes.resolve.checks.framing import beyond_gimbal
from shotc.passes.resolve.checks.heights import Way, raised
from shotc.passes.resolve.checks.keeping_up import check_speed
from shotc.passes.resolve.checks.timing import timing_label
from shotc.planning.clearances import ROUNDING_M
from shotc.rounding import down, up


def check_ideal(mission: MissionIR, shot: Shot, film: Way) -> Iterator[Diagnostic]:
    """Yield the faults of a shot on its own clock; one without a start is checked from its earliest
    start on.
    """
    if shot.ideal is None or shot.timing.duration is None:
        return
    if is_keyed(shot) and not in_order(shot):
        return
    outside = list(_outside(mission, shot))
    yield from outside
    yield from _low(mission, shot, film)
    yield from _tilted(mission, shot)
    if not outside:
        yield from check_speed(mission, shot)


def _outside(mission: MissionIR, shot: Shot) -> Iterator[Diagnostic]:
    """Yield the faults of targets whose track ends before the shot does, or begins after it.

    A shot without a start may begin at any time from the earliest on, so only a track that ends too early is
    a fault.
    """
    duration, start, known = shot.timing.duration or 0.0, shot.timing.start, known_start(mission, shot)
    for name in carriers(shot):
        track = mission.target(name).track
        if track is None:
            continue
        begin = max(known or 0.0, track.since) if start is None else start
        if begin >= track.since - ROUNDING_M and begin + duration <= track.until + ROUNDING_M:
            continue
        beside = mission.origins.value((*mission.target(name).path, "track"), "the track")
        end = f"to {track.until:.2f} s" if track.until < inf else "on"
        filmed = "" if known is None else f" and begins at {known:.2f} s at the earliest"
        filmed = filmed if start is None else f", from {start:.2f} s to {start + duration:.2f} s"
        yield Diagnostic(
            "M004",
            f"shot `{shot.id}` reaches beyond the track of `{name}`",
            (timing_label(mission, shot), beside),
            (f"`{name}` is known from {track.since:.2f} s {end}; the shot lasts {duration:.2f} s{filmed}",),
            _within(track, duration),
        )


def _within(track: Track, duration: float) -> str:
    """Return when a shot of a track can be filmed, as a remedy."""
    first = max(0.0, up(track.since))
    if track.until == inf:
        return f"start it at {first:.2f} s or later, or let the track begin earlier"
    last = down(track.until - duration)
    if last >= first:
        times = f"between {first:.2f} s and {last:.2f} s" if last > first else f"at {first:.2f} s"
        return f"start it {times}, or give the track more rows"
    left = down(track.until - first)
    if left > 0:
        return f"shorten it to {left:.2f} s or less, or give the track more rows"
    return "give the track rows after the start of the mission, which is time 0"


def _low(mission: MissionIR, shot: Shot, film: Way) -> Iterator[Diagnostic]:
    """Yield the fault of an altitude that the user wrote, below the ground clearance."""
    ideal = shot.ideal
    if ideal is None or ideal.frame in ("about", "keyframes"):
        return
    need = mission.rules.over_ground(mission.drone(shot.drone).radius)
    lowest = min(z - mission.ground(x, y) for (x, y, z), _ in film)
    if lowest >= need - ROUNDING_M:
        return
    key = "altitude" if (*shot.path, "altitude") in mission.origins.values else "kind"
    yield Diagnostic(
        "M006",
        f"shot `{shot.id}` is too low: {lowest:.2f} m over the ground",
        (mission.origins.value((*shot.path, key)),),
        (f"the ground clearance and the body radius need {need:.2f} m",),
        raised(mission, shot, film, need - lowest),
    )


def _tilted(mission: MissionIR, shot: Shot) -> Iterator[Diagnostic]:
    """Yield the fault of a fixed pitch out of the gimbal's range."""
    if shot.ideal is None or shot.ideal.aim is None:
        return
    drone, pitch = mission.drone(shot.drone), shot.ideal.aim[1]
    if not drone.gimbal.reaches(pitch):
        key = "pitch" if (*shot.path, "pitch") in mission.origins.values else "look_at"
        yield beyond_gimbal(mission, drone, (*shot.path, key), pitch)
