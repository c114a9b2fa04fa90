"""Check that a plan's framing data are those of the mission: targets and references at the keyframes.

Without this check an edited plan could keep every promise by framing nothing, or by taking what it shows as
its reference.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from math import dist
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from shotc.geom.bernstein import Array
from shotc.ir.keyed import is_keyed
from shotc.ir.keyframes import PlacedKeyframe, PlacedShot
from shotc.ir.mission import Shot
from shotc.ir.phases import Phase
from shotc.ir.promise import Promise
from shotc.ir.sampling import framed, references, ticks_inside
from shotc.ir.tolerances import OFF_LINE_HALF_FRAMES
from shotc.ir.trajectory import Claim
from shotc.passes.verify.claims import JudgedFlight, Limit, WorstValue, claim

SAME_PLACE_M = 0.01
"""Distance of two keyframes up to which the camera turns on the spot, metres."""

Mask = NDArray[np.bool_]


class _KeyframedSpan(NamedTuple):
    """An interval between two keyframes of one target, seconds, without the hold before it."""

    start: float
    end: float
    before: PlacedKeyframe
    after: PlacedKeyframe


class _Watched(NamedTuple):
    """Times, shape (M,), seconds, and the targets of which one is framed then."""

    times: Array
    targets: tuple[str | None, ...]


def reference_framing(flight: JudgedFlight, placed: PlacedShot, phase: Phase) -> Iterator[Claim]:
    """Yield claims that targets at keyframes and between them are framed, with the keyframes' references.

    Between two references the wanted one lies on the straight line from one to the other. The first claim is
    always hard: other claims judge the picture of the target only while the target is framed. The second one
    is hard where the shot promises something, else soft.
    """
    shot, hard = placed.shot, placed.shot.promise != Promise()
    if shot.ideal is not None and not is_keyed(shot):
        yield from _all_along(flight, placed, phase, hard=hard)
        return
    times = {k.index: k.time for k in flight.track.keyframes if k.shot == shot.id}
    if len(times) < len(placed.keyframes):
        limit = Limit("keyframes without a time", 0.0, "", shot.path, hard=hard, shot=shot.id)
        yield claim(flight, limit, WorstValue(float(len(placed.keyframes) - len(times)), None, "exact"))
        return
    legs = list(_sampled(flight, _legs(placed, times, phase)))
    shown = [
        *(_Watched(leg.times, (leg.before.target,)) for leg in legs),
        *_at_keyframes(placed, times, phase),
        *_in_changes(flight, placed, times),
    ]
    if not shown:
        return
    missing, when = max((_unseen(flight, shot, t, names), float(t[0])) for t, names in shown)
    yield claim(flight, _unframed(shot), WorstValue(missing, when, "sampled"))
    errors = [_off(flight, shot.id, leg) for leg in legs if leg.before.reference and leg.after.reference]
    if errors:
        worst, time = max(errors)
        limit = _off_place(shot, "reference off its keyframes", hard=hard)
        yield claim(flight, limit, WorstValue(worst, time, "sampled"))


def _at_keyframes(placed: PlacedShot, times: dict[int, float], phase: Phase) -> Iterator[_Watched]:
    """Yield the times of each keyframe with a target, where its hold begins and ends."""
    for i, keyframe in enumerate(placed.keyframes):
        if keyframe.target is not None:
            ends = np.unique([times[i], min(times[i] + keyframe.hold, phase.end)])
            yield _Watched(ends, (keyframe.target,))


def _in_changes(flight: JudgedFlight, placed: PlacedShot, times: dict[int, float]) -> Iterator[_Watched]:
    """Yield the times of each way from one target to another, on which one of both is framed.

    Where the picture changes is left to the plan: whichever of the two it says to frame is judged.
    """
    for (i, a), (j, b) in pairwise(enumerate(placed.keyframes)):
        start, end = times[i] + a.hold, times[j]
        inside = ticks_inside(flight.mission.rate, start, end)
        if a.target is None or b.target is None or a.target == b.target or not len(inside):
            continue
        if dist(a.at, b.at) > SAME_PLACE_M:
            yield _Watched(inside, (a.target, b.target))


def _unseen(flight: JudgedFlight, shot: Shot, times: Array, names: tuple[str | None, ...]) -> float:
    """Return the number of times, shape (M,), at which none of some targets is framed."""
    seen = [framed(flight.track, shot.id, str(name), times) for name in names]
    return float((~np.any(seen, axis=0)).sum())


def _all_along(flight: JudgedFlight, placed: PlacedShot, phase: Phase, *, hard: bool) -> Iterator[Claim]:
    """Yield claims that the subjects of a shot on its own clock are framed throughout, with their
    references.
    """
    shot = placed.shot
    inside = ticks_inside(flight.mission.rate, phase.start, phase.end)
    t = np.union1d(inside, [phase.start, phase.end])
    missing, off, when = 0.0, 0.0, phase.start
    for subject in placed.subjects:
        missing += float((~framed(flight.track, shot.id, subject.target, t)).sum())
        if subject.reference is None:
            continue
        reference = np.array([subject.asked(float(u) - phase.start).place for u in t], dtype=np.float64)
        deviation = np.linalg.norm(references(flight.track, shot.id, subject.target, t) - reference, axis=1)
        deviation = np.where(np.isnan(deviation), np.inf, deviation)
        k = int(np.argmax(deviation))
        if deviation[k] > off:
            off, when = float(deviation[k]), float(t[k])
    yield claim(flight, _unframed(shot), WorstValue(missing, when, "sampled"))
    limit = _off_place(shot, "reference off its composition", hard=hard)
    yield claim(flight, limit, WorstValue(off, when, "sampled"))


def _unframed(shot: Shot) -> Limit:
    return Limit("frames without their target", 0.0, "", shot.path, shot=shot.id)


def _off_place(shot: Shot, constraint: str, *, hard: bool) -> Limit:
    return Limit(constraint, OFF_LINE_HALF_FRAMES, "of half a frame", shot.path, hard=hard, shot=shot.id)


def held(flight: JudgedFlight, placed: PlacedShot, phase: Phase, target: str, times: Array) -> Mask:
    """Return at which times (M,) of a shot a target is framed between two keyframes of its own.

    While the camera turns from one target to the next, neither can be whole in the frame. If a shot never has
    its target at two consecutive keyframes, all of its frames count.
    """
    at = {k.index: k.time for k in flight.track.keyframes if k.shot == placed.shot.id}
    if len(at) < len(placed.keyframes):
        return np.ones(len(times), dtype=np.bool_)
    inside = np.zeros(len(times), dtype=np.bool_)
    for start, end, a, b in _legs(placed, at, phase):
        inside |= (times >= start - a.hold) & (times <= end + b.hold) & (a.target == target)
    return inside if inside.any() else ~inside


def _legs(placed: PlacedShot, times: dict[int, float], phase: Phase) -> Iterator[_KeyframedSpan]:
    """Yield the intervals between neighbouring keyframes of one target."""
    if len(placed.keyframes) == 1:
        only = placed.keyframes[0]
        if only.target is not None:
            yield _KeyframedSpan(phase.start, phase.end, only, only)
        return
    for (i, a), (j, b) in pairwise(enumerate(placed.keyframes)):
        if a.target is not None and a.target == b.target:
            yield _KeyframedSpan(times[i] + a.hold, times[j], a, b)


class _SampledLeg(NamedTuple):
    """Times of an interval between two keyframes, shape (M,), and the keyframes."""

    times: Array
    before: PlacedKeyframe
    after: PlacedKeyframe


def _sampled(flight: JudgedFlight, legs: Iterator[_KeyframedSpan]) -> Iterator[_SampledLeg]:
    for start, end, a, b in legs:
        inside = ticks_inside(flight.mission.rate, start, end)
        yield _SampledLeg(
            np.concatenate([[start], inside, [end]]) if end > start else np.array([start]), a, b
        )


def _off(flight: JudgedFlight, shot: str, leg: _SampledLeg) -> tuple[float, float]:
    t, a, b = leg
    first, second = np.array(a.reference), np.array(b.reference)
    reference = references(flight.track, shot, str(a.target), t)
    off = _from_line(reference, first, second)
    off[0] = np.hypot(*(reference[0] - first))
    off[-1] = np.hypot(*(reference[-1] - second))
    off = np.where(np.isnan(off), np.inf, off)
    k = int(np.argmax(off))
    return float(off[k]), float(t[k])


def _from_line(points: Array, first: Array, second: Array) -> Array:
    along = second - first
    squared = float(along @ along)
    share = np.clip((points - first) @ along / squared, 0.0, 1.0) if squared > 0 else np.zeros(len(points))
    return np.asarray(np.linalg.norm(points - first - share[:, None] * along, axis=1))
