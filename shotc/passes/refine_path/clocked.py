"""Whether refined shots on their own clock are the same shots: their times, their ends, the legs around."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from shotc.geom.bernstein import Piecewise
from shotc.ir.path import FramingSpan, Leg, PathIR, TimedLeg
from shotc.passes.refine_path.finding import Finding
from shotc.passes.refine_path.form import broken, jumps
from shotc.passes.verify.shape import AT_REST

EQUAL = 1e-9
"""Seconds, metres or radians, m/s and so on: the legs around a shot stay, so it joins them to rounding."""


def on_clock(before: PathIR, after: PathIR) -> Iterator[Finding]:
    """Find what is wrong with drones on the mission's clock; both paths have the same legs."""
    for old, new in zip(before.timed, after.timed, strict=True):
        for was, now in zip(old.legs, new.legs, strict=True):
            if was is now:
                continue
            if isinstance(was, TimedLeg) and isinstance(now, TimedLeg):
                yield from _shot(was, now)
            elif isinstance(was, Leg) and isinstance(now, Leg) and not _alike(was, now):
                note = f"of `{new.drone}`, whose flight is timed already"
                yield Finding("R005", f"changed the {was.phase}", (note,), was.shot)


def _shot(was: TimedLeg, now: TimedLeg) -> Iterator[Finding]:
    for fault in _changed(was, now):
        yield Finding("R005", f"changed what shot `{was.shot}` is to do", (fault,), was.shot)
    for note in _ends(was.curve, now.curve):
        yield broken(note, was.shot)
    yield from jumps(now, now.curve)


def _changed(was: TimedLeg, now: TimedLeg) -> Iterator[str]:
    """Say what of a shot is not as it was."""
    if max(abs(was.start - now.start), abs(was.end - now.end)) > EQUAL or was.path != now.path:
        yield "its first or its last frame is at another time"
    if len(was.framing) != len(now.framing) or not all(map(_same_span, was.framing, now.framing)):
        yield "it frames other targets, or at other places on screen"


def _same_span(a: FramingSpan, b: FramingSpan) -> bool:
    if a is b:
        return True
    times = abs(a.start - b.start) <= EQUAL and abs(a.end - b.end) <= EQUAL
    return times and a.target == b.target and _same_curve(a.reference, b.reference)


def _ends(was: Piecewise, now: Piecewise) -> Iterator[str]:
    """Say how a leg leaves the rest poses that its neighbours join."""
    off = max(abs(was.start - now.start), abs(was.end - now.end))
    if off > EQUAL:
        yield f"its way into or out of the film takes {off:.3g} s more or less"
        return
    for name, k in (("begins", 0), ("ends", -1)):
        away = float(np.abs(was.ctrl[k, k] - now.ctrl[k, k]).max())
        if away > EQUAL:
            yield f"it {name} {away:.3g} from where the guide does (m or rad)"
    ends = np.array([now.start, now.end])
    moving = max(float(np.abs(now.derivative(order)(ends)).max()) for order in (1, 2))
    if moving > AT_REST:
        yield f"it does not begin and end at rest: {moving:.3g} (m/s, rad/s, m/s^2 or rad/s^2)"


def _alike(a: Leg, b: Leg) -> bool:
    """Tell whether two legs of the same kind are flown the same."""
    same = (a.pose, a.stops, a.marks, a.pace, a.duration, a.start, a.path) == (
        b.pose,
        b.stops,
        b.marks,
        b.pace,
        b.duration,
        b.start,
        b.path,
    )
    framed = len(a.framing) == len(b.framing) and all(map(_same_span, a.framing, b.framing))
    return same and framed and a.phase == b.phase and _same_curve(a.curve, b.curve)


def _same_curve(a: Piecewise | None, b: Piecewise | None) -> bool:
    if a is b:
        return True
    if a is None or b is None:
        return False
    return np.array_equal(a.breaks, b.breaks) and np.array_equal(a.ctrl, b.ctrl)
