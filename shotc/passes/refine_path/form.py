"""Check the form of a refined path, and that it is of the same mission: legs, stops, keyframes,
references.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from math import factorial, isfinite
from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array, Piecewise
from shotc.ir.origin import KeyPath
from shotc.ir.path import (
    CHANNELS,
    ClockLeg,
    DronePath,
    FramingSpan,
    HoldLeg,
    Leg,
    MovingLeg,
    PathIR,
    PathLeg,
    Pose,
    TimedPath,
)
from shotc.ir.phases import UPRIGHT
from shotc.ir.tolerances import OFF_LINE_HALF_FRAMES
from shotc.passes.refine_path.finding import RefinerFinding
from shotc.passes.solver_reports import place

SAME_PLACE_TOLERANCE = 1e-6
"""Tolerance in metres, radians or screen units for equal places."""

SMOOTH_JUMP_SHARE = 1e-6
"""Tolerance of a jump of value, first or second derivative, relative to the scale of its channel."""

UNFILMED = ("transit", "return")
DEGREE = 5
_DENSE_SAMPLES = 257
ROUNDING_SHARE = 16 * np.finfo(float).eps
ORDERS = ("value", "rate", "acceleration")


class Jump(NamedTuple):
    """The largest jump of a derivative, relative to its scale, and its parameter."""

    size: float
    at: float


def largest_jump(curve: Piecewise, order: int) -> Jump:
    """Return the largest jump of a derivative at a break, relative to its scale.

    The scale of a channel is its largest control value, at least one unit. The part that rounding of the
    control points can cause is subtracted: the n-th difference of values of size c over h carries 2^n c eps /
    h^n.
    """
    derived = curve.derivative(order).ctrl
    if len(derived) == 1:
        return Jump(0.0, curve.start)
    scale = np.maximum(1.0, np.abs(derived).max(axis=(0, 1)))
    jump = np.abs(derived[1:, 0] - derived[:-1, -1])
    excess = np.maximum(jump - _rounding(curve, order), 0.0) / scale
    k = int(np.argmax(excess.max(axis=1)))
    return Jump(float(excess[k].max()), float(curve.breaks[k + 1]))


def _rounding(curve: Piecewise, order: int) -> Array:
    width = np.diff(curve.breaks)
    shortest = np.minimum(width[1:], width[:-1])
    degree = curve.degree
    factor = factorial(degree) / factorial(max(degree - order, 0)) * 2**order
    size = np.abs(curve.ctrl).max(axis=(0, 1))
    return np.asarray(ROUNDING_SHARE * factor * size / shortest[:, None] ** order)


def structure(before: PathIR, after: object) -> Iterator[RefinerFinding]:
    """Yield what makes the legs of two paths impossible to compare."""
    if not isinstance(after, PathIR):
        yield broken(f"it is a {type(after).__name__}, not a PathIR")
        return
    tracks: tuple[DronePath | TimedPath, ...] = (*after.drones, *after.timed)
    every = [leg for track in tracks for leg in track.legs]
    if not all(_has_form(leg) for leg in every):
        yield broken("one of its legs is none, or has no curve")
        return
    if after.keyframes is not before.keyframes and after.keyframes != before.keyframes:
        yield RefinerFinding(
            "R005", "changed the mission", ("the keyframes it returned are not those it was given",)
        )
    if _skeleton(before) != _skeleton(after) or any(map(_doubled, after.drones)):
        yield broken("its legs are not those of the convex path")
        return
    if not all(isinstance(name, str) and _is_told(value) for name, value in after.stats):
        yield broken("its statistics are not pairs of a name and a number or a word")
    yield from _shapes(after)


def form(before: PathIR, after: PathIR) -> Iterator[RefinerFinding]:
    """Yield where a path of known structure does not join, jumps, or differs from the mission."""
    for old, new in zip(before.drones, after.drones, strict=True):
        yield from _joints(new)
        yield from _pads(old, new)
        for leg in new.legs:
            if isinstance(leg, MovingLeg):
                yield from jumps(leg, leg.curve)
        for was, now in zip(_shots(old), _shots(new), strict=True):
            for fault in changed_shot(was, now):
                yield RefinerFinding("R005", f"changed what shot `{was.shot}` is to do", (fault,), was.shot)


def _shapes(path: PathIR) -> Iterator[RefinerFinding]:
    for drone in path.drones:
        for leg in drone.legs:
            fault = _shapeless(leg)
            if fault:
                yield broken(f"the {leg.phase} {fault}", leg.shot)
    for clocked in path.timed:
        for filmed in clocked.legs:
            fault = _misshapen(filmed.curve) if isinstance(filmed, ClockLeg) else _shapeless(filmed)
            if fault:
                yield broken(f"the {'shot' if filmed.shot else 'way'} {fault}", filmed.shot)


def broken(note: str, shot: str | None = None) -> RefinerFinding:
    """Return the finding of a path that cannot be flown."""
    return RefinerFinding("R002", "returned a path that cannot be flown", (note,), shot)


def _skeleton(path: PathIR) -> list[tuple[str, list[tuple[str, str | None]]]]:
    """Return what has to stay: on the clock every leg, else the filmed legs, take-off and landing."""
    shots: list[tuple[str, list[tuple[str, str | None]]]] = [
        (d.drone, [(leg.phase, leg.shot) for leg in d.legs if leg.phase not in UNFILMED]) for d in path.drones
    ]
    shots += [(d.drone, [(_kind(leg), leg.shot) for leg in d.legs]) for d in path.timed]
    return shots


def _kind(leg: Leg) -> str:
    return leg.phase if isinstance(leg, PathLeg) else type(leg).__name__


def _doubled(drone: DronePath) -> bool:
    """Return whether unfilmed legs follow one another; between two poses there is at most one."""
    return any(a.phase in UNFILMED and b.phase in UNFILMED for a, b in pairwise(drone.legs))


def _is_told(value: object) -> bool:
    return isinstance(value, str) or (isinstance(value, float | int) and isfinite(value))


def _shapeless(leg: PathLeg) -> str:
    """Return what is wrong with the numbers of a leg, or an empty string."""
    fault = "" if isinstance(leg, HoldLeg) else _misshapen(leg.curve)
    if fault:
        return fault
    if len(leg.pose) != len(CHANNELS) or not all(map(isfinite, leg.pose)):
        return f"starts where there are not {len(CHANNELS)} finite numbers"
    rests = [leg.hold] if isinstance(leg, HoldLeg) else [n for p in leg.stops for n in (p.s, p.hold)]
    numbers = rests + [mark.s for mark in leg.marks]
    numbers += [n for span in leg.framing for n in (span.start, span.end)]
    if not rests or not all(map(isfinite, numbers)):
        return "has stops, keyframes or framings that are nowhere"
    if isinstance(leg, HoldLeg):
        return ""
    low, high = leg.curve.start - SAME_PLACE_TOLERANCE, leg.curve.end + SAME_PLACE_TOLERANCE
    places = [stop.s for stop in leg.stops], [mark.s for mark in leg.marks]
    if any(a > b for run in places for a, b in pairwise([low, *run, high])):
        return "has stops or keyframes that are out of order, or off its curve"
    return ""


def _has_form(leg: object) -> bool:
    """Return whether a leg is of one of the three types, with a curve if it moves."""
    return isinstance(leg, HoldLeg) or (
        isinstance(leg, MovingLeg | ClockLeg) and isinstance(leg.curve, Piecewise)
    )


def _misshapen(curve: Piecewise) -> str:
    if curve.ctrl.shape[1:] != (DEGREE + 1, len(CHANNELS)):
        return f"is no curve of degree {DEGREE} with {len(CHANNELS)} channels"
    if not (np.isfinite(curve.ctrl).all() and np.isfinite(curve.breaks).all()):
        return "has numbers that are not finite"
    return ""


def _joints(drone: DronePath) -> Iterator[RefinerFinding]:
    for a, b in pairwise(drone.legs):
        gap = float(np.abs(np.array(a.end_pose) - np.array(b.pose)).max())
        if gap > SAME_PLACE_TOLERANCE:
            note = f"the {b.phase} begins {gap:.3g} from where the {a.phase} ends"
            yield broken(f"{drone.drone}: {note} (m or rad)")
    for leg in drone.legs:
        if isinstance(leg, HoldLeg):
            continue
        ends = (leg.stops[0].s - leg.curve.start, leg.curve.end - leg.stops[-1].s)
        if max(map(abs, ends)) > 1e-9:
            yield broken(
                f"{drone.drone}: the {leg.phase} does not begin and end at rest at its ends", leg.shot
            )


def _pads(old: DronePath, new: DronePath) -> Iterator[RefinerFinding]:
    """Yield take-offs and landings that have moved."""
    for was, now in zip(_lifts(old), _lifts(new), strict=True):
        ends = ((was.pose, now.pose), (was.end_pose, now.end_pose))
        moved = max(_apart(old_end, new_end) for old_end, new_end in ends)
        drift = float(np.ptp(now.curve.ctrl[:, :, :2], axis=(0, 1)).max())
        if moved > SAME_PLACE_TOLERANCE or drift > SAME_PLACE_TOLERANCE:
            yield RefinerFinding(
                "R005", f"moved the {now.phase} of `{new.drone}`", (f"by {max(moved, drift):.3f} m",)
            )


def _apart(a: Pose, b: Pose) -> float:
    """Return the largest difference of two places along an axis, metres."""
    return float(np.abs(np.array(a[:3]) - np.array(b[:3])).max())


def jumps(leg: Leg, curve: Piecewise) -> Iterator[RefinerFinding]:
    """Yield where a leg is not smooth, for the lowest order only; at a stop it may turn."""
    stops = leg.stops if isinstance(leg, MovingLeg) else ()
    rests = np.searchsorted(curve.breaks, [stop.s - SAME_PLACE_TOLERANCE for stop in stops])
    cuts = sorted({0, len(curve.ctrl), *map(int, rests)})
    whole = [(0, len(curve.ctrl))]
    for order, name in enumerate(ORDERS):
        for i, j in pairwise(cuts) if order else whole:
            stretch = Piecewise(curve.breaks[i : j + 1], curve.ctrl[i:j])
            jump = largest_jump(stretch, order)
            if jump.size > SMOOTH_JUMP_SHARE:
                text = f"its {name} jumps by {jump.size:.3g} of its scale, {place(leg, jump.at)}"
                yield broken(text, leg.shot)
                return


def _shots(drone: DronePath) -> list[PathLeg]:
    return [leg for leg in drone.legs if leg.phase == "shot"]


def _lifts(drone: DronePath) -> list[MovingLeg]:
    return [leg for leg in drone.legs if isinstance(leg, MovingLeg) and leg.phase in UPRIGHT]


def changed_shot(was: PathLeg, now: PathLeg) -> Iterator[str]:
    """Yield the changes of a shot's data."""
    if _timing(was) != _timing(now):
        yield "its timing is another"
    if _holds(was) != _holds(now):
        yield "its stops are others"
    if [(m.index, m.time, m.path) for m in was.marks] != [(m.index, m.time, m.path) for m in now.marks]:
        yield "its keyframes are others"
    if isinstance(was, HoldLeg) != isinstance(now, HoldLeg):
        yield "a still camera moves now, or a moving one stands still"
    elif isinstance(was, HoldLeg) and _apart(was.pose, now.pose) > SAME_PLACE_TOLERANCE:
        yield "its still camera is elsewhere"
    if [(f.target, f.reference is None) for f in was.framing] != [
        (f.target, f.reference is None) for f in now.framing
    ]:
        yield "it frames other targets"
        return
    for old, new in zip(was.framing, now.framing, strict=True):
        off = _off(old, new)
        if off > OFF_LINE_HALF_FRAMES:
            yield f"the wanted place of `{old.target}` on screen is {off:.3f} of half a frame off"


class _Timing(NamedTuple):
    """What the mission says about the time of a leg."""

    pace: float
    smoother: float
    duration: float | None
    start: float | None
    path: KeyPath


def _timing(leg: PathLeg) -> _Timing:
    shares = (1.0, 1.0) if isinstance(leg, HoldLeg) else (leg.pace, leg.smoother)
    return _Timing(*shares, leg.duration, leg.start, leg.path)


def _holds(leg: PathLeg) -> list[float]:
    return [leg.hold] if isinstance(leg, HoldLeg) else [stop.hold for stop in leg.stops]


def _off(old: FramingSpan, new: FramingSpan) -> float:
    """Return how far the new reference leaves the line of the old one on screen, and how far its ends
    differ.
    """
    if old.reference is None or new.reference is None or old.reference is new.reference:
        return 0.0
    a, b = old.reference, new.reference
    line, points = (
        a(np.linspace(a.start, a.end, _DENSE_SAMPLES)),
        b(np.linspace(b.start, b.end, _DENSE_SAMPLES)),
    )
    ends = float(np.abs(line[[0, -1]] - points[[0, -1]]).max())
    between = np.linalg.norm(points[:, None] - line[None], axis=2).min(axis=1)
    return max(ends, float(between.max()))
