"""Check that a plan's framing data are those of the mission: targets and references at the keyframes.

Without this check an edited plan could keep every promise by framing nothing, or by taking what it shows as
its reference.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array
from shotc.ir.keyed import is_keyed
from shotc.ir.keyframes import PlacedKeyframe, PlacedShot
from shotc.ir.mission import Shot
from shotc.ir.phases import Phase
from shotc.ir.sampling import framed, references, ticks, ticks_inside
from shotc.ir.tolerances import OFF_LINE_HALF_FRAMES
from shotc.ir.trajectory import Claim
from shotc.passes.verify.claims import JudgedFlight, Limit, WorstValue, claim
from shotc.passes.verify.pictured import KeyframedSpan, frames_beside, spans_of, ways_unframed


def reference_framing(flight: JudgedFlight, placed: PlacedShot, phase: Phase) -> Iterator[Claim]:
    """Yield claims that targets at keyframes and between them are framed, with the keyframes' references, and
    nothing else.

    Between two references the wanted one lies on the straight line from one to the other. The claims are hard
    even where the shot promises nothing: the tables of a plan state what it frames, and where.
    """
    shot = placed.shot
    if shot.ideal is not None and not is_keyed(shot):
        yield from _all_along(flight, placed, phase)
    else:
        yield from _at_and_between(flight, placed, phase)
    beside, first = frames_beside(flight, placed, phase)
    if any(f.shot == shot.id for f in flight.track.framing):
        limit = Limit("frames of another target", 0.0, "", shot.path, shot=shot.id)
        yield claim(flight, limit, WorstValue(beside, first, "sampled"))


def _at_and_between(flight: JudgedFlight, placed: PlacedShot, phase: Phase) -> Iterator[Claim]:
    shot, spans = placed.shot, spans_of(flight, placed, phase)
    if spans is None:
        met = {k.index for k in flight.track.keyframes if k.shot == shot.id}
        missing = float(len(set(range(len(placed.keyframes))) - met))
        limit = Limit("keyframes without a time", 0.0, "", shot.path, shot=shot.id)
        yield claim(flight, limit, WorstValue(missing, None, "exact"))
        return
    legs = list(_sampled(flight, [span for span in spans if span.keeps]))
    unframed = [
        *((_unseen(flight, shot, leg.times, leg.before.target), float(leg.times[0])) for leg in legs),
        *_at_keyframes(flight, placed, phase),
        *ways_unframed(flight, placed, phase),
    ]
    if not unframed:
        return
    yield claim(flight, _unframed(shot), WorstValue(*max(unframed), "sampled"))
    errors = [_off(flight, shot.id, leg) for leg in legs if leg.before.reference and leg.after.reference]
    if errors:
        worst, time = max(errors)
        limit = _off_place(shot, "reference off its keyframes")
        yield claim(flight, limit, WorstValue(worst, time, "sampled"))


def _at_keyframes(flight: JudgedFlight, placed: PlacedShot, phase: Phase) -> Iterator[tuple[float, float]]:
    """Yield for each keyframe with a target how many frames of its hold lack it, and when it is reached."""
    times = {k.index: k.time for k in flight.track.keyframes if k.shot == placed.shot.id}
    for i, keyframe in enumerate(placed.keyframes):
        if keyframe.target is not None:
            end = min(times[i] + keyframe.hold, phase.end)
            held = np.unique(ticks(flight.mission.rate, times[i], max(end, times[i])))
            yield _unseen(flight, placed.shot, held, keyframe.target), times[i]


def _unseen(flight: JudgedFlight, shot: Shot, times: Array, target: str | None) -> float:
    """Return the number of times, shape (M,), at which a target is not framed."""
    return float((~framed(flight.track, shot.id, str(target), times)).sum())


def _all_along(flight: JudgedFlight, placed: PlacedShot, phase: Phase) -> Iterator[Claim]:
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
    limit = _off_place(shot, "reference off its composition")
    yield claim(flight, limit, WorstValue(off, when, "sampled"))


def _unframed(shot: Shot) -> Limit:
    return Limit("frames without their target", 0.0, "", shot.path, shot=shot.id)


def _off_place(shot: Shot, constraint: str) -> Limit:
    return Limit(constraint, OFF_LINE_HALF_FRAMES, "of half a frame", shot.path, shot=shot.id)


class _SampledLeg(NamedTuple):
    """Times of an interval between two keyframes, shape (M,), and the keyframes."""

    times: Array
    before: PlacedKeyframe
    after: PlacedKeyframe


def _sampled(flight: JudgedFlight, legs: Iterable[KeyframedSpan]) -> Iterator[_SampledLeg]:
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
