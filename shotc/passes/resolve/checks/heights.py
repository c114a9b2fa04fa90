"""Heights of cameras above the foot of their target and above the ground."""

from __future__ import annotations

from collections.abc import Iterator
from math import ceil, inf
from typing import NamedTuple

from shotc.diag.model import Diagnostic
from shotc.ir.begins import first_start
from shotc.ir.ground import counted_from
from shotc.ir.ideal import ideal_place
from shotc.ir.limits import Vec3
from shotc.ir.mission import MissionIR, Shot
from shotc.kinds.parameters import as_counted
from shotc.passes.resolve.lower.world import BURIED_SHARE
from shotc.planning.clearances import ROUNDING_M
from shotc.rounding import at_least, up

STEP_S = 0.5  # seconds between samples of a shot on its own clock
MOST_SAMPLES = 400  # most samples of one shot
STANDS_M = 0.1  # metres from z = 0 within which a target's foot is at z = 0
LEGAL_M = 120.0  # above ground, the limit of the open category in Europe; 400 ft in the United States


class CameraHeight(NamedTuple):
    """The place of a camera, metres of W, and the z of its target's foot at that time, if it has one."""

    at: Vec3
    foot: float | None


Way = tuple[CameraHeight, ...]
"""The ideal places of a shot's camera, from its first frame to its last."""


def check_heights(mission: MissionIR, shot: Shot, film: Way) -> Iterator[Diagnostic]:
    """Yield the faults of a camera too low beside its target, or too high above the ground."""
    yield from _below_foot(mission, shot, film)
    yield from _too_high(mission, shot, film)


def way_of(mission: MissionIR, shot: Shot) -> Way:
    """Return the ideal places of a shot's camera: its keyframes, or samples for a shot on its own clock."""
    target = next(
        (t for t in mission.every_target if t.name == shot.subject), None
    )  # None for an unknown name, which is reported
    duration = shot.timing.duration
    if shot.ideal is None or duration is None:
        foot = None if target is None else target.foot[2]
        return tuple(CameraHeight(k.at, foot) for k in shot.keyframes)
    start, pieces = first_start(mission, shot), max(1, min(MOST_SAMPLES, ceil(duration / STEP_S)))
    times = [start + duration * i / pieces for i in range(pieces + 1)]
    return tuple(
        CameraHeight(ideal_place(mission, shot, start, t), None if target is None else target.foot_at(t)[2])
        for t in times
    )


def check_reference(mission: MissionIR, shot: Shot, film: Way) -> Iterator[Diagnostic]:
    """Yield the fault of a height above a target's foot, which in version 0.1 was above z = 0.

    Version 0.1 had no terrain, so a mission that has one was written for the foot.
    """
    if mission.terrain is not None:
        return
    key = (*shot.path, "altitude")
    feet = [moment.foot for moment in film if moment.foot is not None]
    if shot.above != "target" or (*key, "above") in mission.origins.values or not feet:
        return
    buried = (
        min(feet) < -BURIED_SHARE * mission.target(shot.subject or "").height
    )  # which has a report of its own
    if buried or max(map(abs, feet)) < STANDS_M:
        return
    now = [moment.at[2] for moment in film]
    before = [z - foot for z, foot in zip(now, feet, strict=True)]
    written = _written(before)
    yield Diagnostic(
        "G020",
        f"the altitude of shot `{shot.id}` counts from the foot of target `{shot.subject}`",
        (mission.origins.value(key),),
        (f"its foot is at z = {_span(feet)}; the camera is at z = {_span(now)}, it was at {_span(before)}",),
        f"write `altitude: {{above: target, height: {written}}}` if that is meant, "
        f"or `altitude: {{above: origin, height: {written}}}` to keep the camera where it was",
    )


def _below_foot(mission: MissionIR, shot: Shot, film: Way) -> Iterator[Diagnostic]:
    """Yield the warning of a camera below its target's foot, though its height is above target or ground."""
    key = (*shot.path, "altitude")
    if shot.above in (None, "origin") or key not in mission.origins.values:
        return
    deepest = max(film, key=lambda moment: -inf if moment.foot is None else moment.foot - moment.at[2])
    if deepest.foot is None or deepest.foot - deepest.at[2] <= ROUNDING_M:
        return
    yield Diagnostic(
        "G021",
        f"the camera of shot `{shot.id}` is below the foot of target `{shot.subject}`",
        (mission.origins.value(key),),
        (f"it is at z = {deepest.at[2]:.2f} m, the target's foot at z = {deepest.foot:.2f} m",),
        f"raise it by {at_least(deepest.foot - deepest.at[2])} m, or write `altitude: {{above: origin, "
        f"height: {_written([m.at[2] for m in film])}}}` if it is to be that low",
    )


def _too_high(mission: MissionIR, shot: Shot, film: Way) -> Iterator[Diagnostic]:
    """Yield the fault of a camera above the mission's limit, or without one above the usual legal limit."""
    rule = mission.rules.max_height
    most = LEGAL_M if rule is None else rule
    high = max((m.at[2] - mission.ground(*m.at[:2]) for m in film), default=-inf)
    if high <= most + ROUNDING_M:
        return
    key = next((k for k in ("altitude", "at") if (*shot.path, k) in mission.origins.values), "kind")
    label = mission.origins.value((*shot.path, key))
    message = f"the camera of shot `{shot.id}` is {high:.2f} m above the ground"
    if rule is None:
        note = f"most countries allow {LEGAL_M:.0f} m without a permit"
        allow = f"write `rules: {{max_height: {ceil(high)}}}` or `rules: {{max_height: off}}`"
        help_ = f"lower it by {high - LEGAL_M:.2f} m, or {allow}"
        yield Diagnostic("G024", message, (label,), (note,), help_)
        return
    beside = mission.origins.value(("rules", "max_height"), "the rule")
    help_ = f"lower it by {high - most:.2f} m, or write `rules: {{max_height: {ceil(high)}}}`"
    yield Diagnostic("G022", message, (label, beside), (), help_)


def raised(mission: MissionIR, shot: Shot, film: Way, metres: float) -> str:
    """Return how to write a shot that is higher by so many metres."""
    above = shot.above
    if above is None or (*shot.path, "altitude") not in mission.origins.values:
        return f"raise it by {at_least(metres)} m"
    bases = (counted_from(above, mission.ground, at[:2], foot or 0.0) for at, foot in film)
    heights = [up(at[2] - base + metres) for (at, _), base in zip(film, bases, strict=True)]
    return f"write `altitude: {as_counted(mission, shot, _written(heights))}`"


def _span(values: list[float]) -> str:
    """Return metres, or their range, as text."""
    low, high = f"{min(values) + 0.0:.2f}", f"{max(values) + 0.0:.2f}"
    return f"{low} m" if low == high else f"{low} to {high} m"


def _written(heights: list[float]) -> str:
    """Return the heights of a shot as `altitude` has them."""
    first, last = (f"{round(heights[i], 2) + 0.0:g}" for i in (0, -1))
    return first if first == last else f"[{first}, {last}]"
