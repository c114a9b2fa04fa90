"""Which target a shot frames when, as its mission asks. Pictures are judged by this, not by the plan's data.

Between two keyframes of one target that target is framed. On the way from one target to another, or to none,
the picture of the first ends and that of the second begins in the middle of the way.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from math import dist, inf
from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.pieces import Mask
from shotc.ir.keyed import is_keyed
from shotc.ir.keyframes import PlacedKeyframe, PlacedShot
from shotc.ir.path import CAM_PITCH, CAM_YAW, Z
from shotc.ir.phases import Phase
from shotc.ir.sampling import SAME_TIME_S, framed, ticks
from shotc.passes.verify.claims import JudgedFlight

SAME_PLACE_M = 0.01
"""Distance of two keyframes up to which the camera turns on the spot, metres."""

MIDDLE, NEAR_MIDDLE = 0.5, 0.2
"""Share of the way at which a picture changes, and by how much a plan may differ from it. Planning takes the
middle of the path parameter, which the flown length follows only roughly in bends."""

WAY_SAMPLES = 200
"""Samples of a way, for its length."""

TURN_M = 1.0
"""Metres of a way that a radian of the camera's turn counts as, so that a turn on the spot has a middle."""


class KeyframedSpan(NamedTuple):
    """An interval between two keyframes, seconds, without the hold before it."""

    start: float
    end: float
    before: PlacedKeyframe
    after: PlacedKeyframe

    @property
    def keeps(self) -> bool:
        """Whether one target is framed at both ends."""
        return self.before.target is not None and self.before.target == self.after.target

    @property
    def on_the_spot(self) -> bool:
        """Whether the camera only turns."""
        return dist(self.before.at, self.after.at) <= SAME_PLACE_M


class TargetSpan(NamedTuple):
    """An interval in which a target is framed, seconds."""

    start: float
    end: float

    def holds(self, times: Array) -> Mask:
        """Return which times (M,) are inside."""
        return np.asarray((times >= self.start - SAME_TIME_S) & (times <= self.end + SAME_TIME_S))


def spans_of(flight: JudgedFlight, placed: PlacedShot, phase: Phase) -> list[KeyframedSpan] | None:
    """Return the intervals between neighbouring keyframes; None where a keyframe has no time.

    A single keyframe spans the whole shot.
    """
    times = {k.index: k.time for k in flight.track.keyframes if k.shot == placed.shot.id}
    keyframes = placed.keyframes
    if any(i not in times for i in range(len(keyframes))):
        return None
    if len(keyframes) == 1:
        return [KeyframedSpan(phase.start, phase.end, keyframes[0], keyframes[0])]
    return [
        KeyframedSpan(times[i] + a.hold, times[i + 1], a, b) for i, (a, b) in enumerate(pairwise(keyframes))
    ]


def asked(flight: JudgedFlight, placed: PlacedShot, phase: Phase, target: str, times: Array) -> Mask:
    """Return at which times (M,) of a shot a target is judged.

    Those are the times between two keyframes of its own, because while the camera turns from one target to
    the next, neither can be whole in the frame. If a shot never has its target at two consecutive keyframes,
    it is judged up to the middle of its ways, and as far as the plan frames it beyond that.
    """
    if placed.shot.ideal is not None and not is_keyed(placed.shot):
        return np.full(len(times), any(s.target == target for s in placed.subjects))
    spans = spans_of(flight, placed, phase)
    if spans is None:  # refused for its keyframes without a time
        return framed(flight.track, placed.shot.id, target, times)
    own = [span for span in spans if span.keeps and span.before.target == target]
    judged = [TargetSpan(s.start - s.before.hold, s.end + s.after.hold) for s in own]
    if judged:
        return _in_any(judged, times)
    halves = [part for s in spans for part in _parts(flight, s, target)]
    # A plan may frame it a little longer; what it shows then counts, too.
    return _in_any(halves, times) | framed(flight.track, placed.shot.id, target, times)


def _parts(
    flight: JudgedFlight, span: KeyframedSpan, target: str, shift: float = 0.0
) -> Iterator[TargetSpan]:
    """Yield the part of a way to another target on which a target is framed, with its hold.

    shift : of the middle, away from the target's keyframe, as a share of the way
    """
    if span.before.target == target:
        yield TargetSpan(span.start - span.before.hold, share_at(flight, span, MIDDLE + shift))
    if span.after.target == target:
        yield TargetSpan(share_at(flight, span, MIDDLE - shift), span.end + span.after.hold)


def share_at(flight: JudgedFlight, span: KeyframedSpan, share: float) -> float:
    """Return when a share of the way between two keyframes is flown and turned, seconds."""
    if span.end <= span.start:
        return span.end
    t = np.linspace(span.start, span.end, WAY_SAMPLES)
    steps = np.diff(flight.track.curve(t), axis=0)
    way = np.linalg.norm(steps[:, : Z + 1], axis=1)
    way += TURN_M * np.hypot(steps[:, CAM_YAW], steps[:, CAM_PITCH])
    flown = np.concatenate([[0.0], np.cumsum(way)])
    return float(np.interp(share * flown[-1], flown, t)) if flown[-1] > 0 else float(t[-1] * share)


def ways_unframed(flight: JudgedFlight, placed: PlacedShot, phase: Phase) -> Iterator[tuple[float, float]]:
    """Yield for each way to another target, or to none, how many frames lack their target, and its start.

    What lies within ``NEAR_MIDDLE`` of its middle is left to the plan.
    """
    for span in spans_of(flight, placed, phase) or []:
        if span.keeps or span.on_the_spot:
            continue
        t = ticks(flight.mission.rate, span.start, span.end)[1:-1]
        for name in {span.before.target, span.after.target} - {None}:
            required = _in_any(_parts(flight, span, str(name), -NEAR_MIDDLE), t)
            missing = required & ~framed(flight.track, placed.shot.id, str(name), t)
            yield float(missing.sum()), span.start


def frames_beside(flight: JudgedFlight, placed: PlacedShot, phase: Phase) -> tuple[float, float | None]:
    """Return in how many frames of a shot its plan frames a target that the mission does not, and the first.

    On the spot the change of the picture is left to the plan, elsewhere its place near the middle is.
    """
    t = ticks(flight.mission.rate, phase.start, phase.end)
    excess = np.zeros(len(t), dtype=np.bool_)
    for name in {f.target for f in flight.track.framing if f.shot == placed.shot.id}:
        excess |= framed(flight.track, placed.shot.id, name, t) & ~_allowed(flight, placed, phase, name, t)
    return float(excess.sum()), float(t[int(excess.argmax())]) if excess.any() else None


def _allowed(flight: JudgedFlight, placed: PlacedShot, phase: Phase, target: str, times: Array) -> Mask:
    """Return at which times (M,) a plan may frame a target."""
    spans = spans_of(flight, placed, phase)
    if spans is None or (placed.shot.ideal is not None and not is_keyed(placed.shot)):
        return asked(flight, placed, phase, target, times)
    keyframes = placed.keyframes
    allowed: list[TargetSpan] = []
    for span in spans:
        if span.keeps or span.on_the_spot:
            of_both = target in (span.before.target, span.after.target)
            allowed += [TargetSpan(span.start - span.before.hold, span.end + span.after.hold)] * of_both
        else:
            allowed += _parts(flight, span, target, NEAR_MIDDLE)
    # Before the first keyframe and after the last one the camera stands.
    allowed += [TargetSpan(-inf, spans[0].start)] * (keyframes[0].target == target)
    allowed += [TargetSpan(spans[-1].end, inf)] * (keyframes[-1].target == target)
    return _in_any(allowed, times)


def _in_any(spans: list[TargetSpan] | Iterator[TargetSpan], times: Array) -> Mask:
    inside = np.zeros(len(times), dtype=np.bool_)
    for span in spans:
        inside |= span.holds(times)
    return inside
