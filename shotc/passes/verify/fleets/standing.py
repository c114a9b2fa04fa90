"""Check that the pictures of a display stand as long, and follow each other as fast, as the mission asks.

The move to a picture without `transition` or `at` takes the time that planning finds; so does the wait before
a display without a start. A picture before one with `at` stands until the move to that one begins.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise

from shotc.ir.fleet import FrameTimes
from shotc.ir.phases import Phase
from shotc.ir.show import Display, Model, Picture, RecordedFlight
from shotc.ir.tolerances import ON_TIME_S
from shotc.ir.trajectory import Claim
from shotc.passes.verify.claims import Limit, WorstValue, held

STOP_PERIODS = 2.0
"""Periods from the first frame of an animation to the second, and to the last one: the fleet stops there."""


def frames_of(picture: Picture) -> int | None:
    """Return how many frames a picture has; None for a recorded flight, whose file says it."""
    if isinstance(picture.source, RecordedFlight):
        return None
    return len(picture.source.files) if isinstance(picture.source, Model) else 1


def standing(fleet: str, display: Display, phase: Phase, frames: Sequence[FrameTimes]) -> Iterator[Claim]:
    """Yield claims on the length of holds, on the ends of a display, and on the periods of animations.

    frames : of the display, each of a picture that it has, in the order in which they are shown
    """
    if not frames:
        return
    holds = [(s.end - s.start - display.pictures[s.picture].hold, s) for s in _last_ones(display, frames)]
    if holds:
        excess, at = max(holds, key=lambda entry: entry[0])
        path = (*display.pictures[at.picture].path, "hold")
        limit = Limit("excess of hold", ON_TIME_S, "s", path, shot=display.id)
        yield held(fleet, limit, WorstValue(max(excess, 0.0), at.end, "exact"))
    if frames_of(display.pictures[0]) is not None:
        off = max(
            (abs(frames[0].start - phase.start), phase.start), (abs(phase.end - frames[-1].end), phase.end)
        )
        limit = Limit("display without a picture", ON_TIME_S, "s", display.path, shot=display.id)
        yield held(fleet, limit, WorstValue(*off, "exact"))
    yield from _periods(fleet, display, frames)


def _last_ones(display: Display, frames: Sequence[FrameTimes]) -> Iterator[FrameTimes]:
    """Yield the last frame of every picture that no picture with a fixed time follows in its display."""
    last = {s.picture: s for s in frames}
    for k, frame in last.items():
        if k + 1 == len(display.pictures) or display.pictures[k + 1].at is None:
            yield frame


def _periods(fleet: str, display: Display, frames: Sequence[FrameTimes]) -> Iterator[Claim]:
    """Yield the claim that frames of an animation follow each other as its period says."""
    errors: list[tuple[float, FrameTimes]] = []
    for one, other in pairwise(frames):
        source = display.pictures[other.picture].source
        if one.picture != other.picture or not isinstance(source, Model) or source.period is None:
            continue
        ends = one.index == 0 or other.index == len(source.files) - 1
        most = source.period * (STOP_PERIODS if ends else 1.0)
        passed = other.start - one.start
        errors.append((max(passed - most, source.period - passed, 0.0), other))
    if errors:
        error, at = max(errors, key=lambda entry: entry[0])
        path = (*display.pictures[at.picture].path, "period")
        limit = Limit("error of period", ON_TIME_S, "s", path, shot=display.id)
        yield held(fleet, limit, WorstValue(error, at.start, "exact"))
