"""Check that every shot of the mission is flown, at its time and through its keyframes."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from math import inf

import numpy as np

from shotc.geom.pieces import cut
from shotc.geom.proof import norm, sup_convex
from shotc.ir.framed import at_start
from shotc.ir.ideal import ideal_place
from shotc.ir.keyed import is_keyed, place_of
from shotc.ir.keyframes import PlacedKeyframe, PlacedShot
from shotc.ir.mission import Shot
from shotc.ir.path import HFOV, Z
from shotc.ir.phases import Phase
from shotc.ir.sampling import ticks_inside
from shotc.ir.tolerances import ON_TIME_S, PLACE_TOLERANCE
from shotc.ir.trajectory import Claim, TrajectoryIR
from shotc.passes.verify.claims import JudgedFlight, Limit, WorstValue, bounded, claim, gap
from shotc.passes.verify.explained import (
    ExpectedPlaces,
    believed,
    farthest,
    for_its_limits,
    for_the_picture,
    in_the_way,
)
from shotc.planning.framing.moments import placed_at

UNREPORTED_M = 1.0
"""Metres that a shot on its own clock may leave its ideal without a report; planning reports from 0.5
m on.
"""

IN_PLACE_M = 0.01
"""Tolerance of a camera's place given by the author while it follows a moving target, metres."""


def shots(flight: JudgedFlight, ir: TrajectoryIR) -> Iterator[Claim]:
    """Yield claims that this drone's shots are flown, on time, through placed keyframes, at rest in holds."""
    ends = {p.shot: p.end for t in ir.drones for p in t.phases if p.shot is not None}
    for placed in ir.keyframes.shots:
        if placed.shot.drone != flight.drone.name:
            continue
        flown = [p for p in flight.track.phases if p.shot == placed.shot.id]
        once = Limit("times flown", 1.0, "", placed.shot.path, upper=len(flown) > 0, shot=placed.shot.id)
        yield claim(flight, once, WorstValue(float(len(flown)), None, "exact"))
        if len(flown) == 1:
            yield from _timing(flight, placed.shot, flown[0], ends)
            yield from _keyframes(flight, placed_at(flight.mission, placed, flown[0].start), flown[0])
            yield from _place(flight, ir, placed.shot, flown[0])
    yield from _order(flight, ir)


def _order(flight: JudgedFlight, ir: TrajectoryIR) -> Iterator[Claim]:
    """Yield the claim that a drone's shots are flown in the order of the mission."""
    place = {placed.shot.id: k for k, placed in enumerate(ir.keyframes.shots)}
    flown = [p for p in flight.track.phases if p.shot in place]
    if len(flown) > 1:
        late = [b for a, b in pairwise(flown) if place[str(b.shot)] < place[str(a.shot)]]
        limit = Limit("shots out of order", 0.0, "", (*flight.drone.path,))
        yield claim(flight, limit, WorstValue(float(len(late)), late[0].start if late else None, "exact"))


def _timing(flight: JudgedFlight, shot: Shot, phase: Phase, ends: dict[str, float]) -> Iterator[Claim]:
    timing, path = shot.timing, (*shot.path, "timing")
    if timing.duration is not None:
        off = abs(phase.end - phase.start - timing.duration)
        limit = Limit("error of duration", ON_TIME_S, "s", (*path, "duration"), shot=shot.id)
        yield claim(flight, limit, WorstValue(off, phase.end, "exact"))
    elif shot.ideal is None and len(shot.keyframes) == 1:
        off = abs(phase.end - phase.start - shot.keyframes[0].hold)
        limit = Limit("error of duration", ON_TIME_S, "s", shot.path, shot=shot.id)
        yield claim(flight, limit, WorstValue(off, phase.end, "exact"))
    if timing.start is not None:
        limit = Limit("error of start", ON_TIME_S, "s", (*path, "start"), shot=shot.id)
        yield claim(flight, limit, WorstValue(abs(phase.start - timing.start), phase.start, "exact"))
    if timing.after is not None and timing.after in ends:
        limit = Limit("start too early", ON_TIME_S, "s", (*path, "after"), shot=shot.id)
        yield claim(flight, limit, WorstValue(ends[timing.after] - phase.start, phase.start, "exact"))


def _keyframes(flight: JudgedFlight, placed: PlacedShot, phase: Phase) -> Iterator[Claim]:
    times = {k.index: k.time for k in flight.track.keyframes if k.shot == placed.shot.id}
    met: list[tuple[WorstValue, PlacedKeyframe]] = []
    late: list[tuple[WorstValue, PlacedKeyframe]] = []
    for index, keyframe in enumerate(placed.keyframes):
        time = times.get(index)
        if keyframe.placed:
            met += [(_miss(flight, (placed, index), phase, t), keyframe) for t in _there(placed, index, time)]
        if keyframe.time is not None:
            off = inf if time is None else abs(time - phase.start - keyframe.time)
            late.append((WorstValue(off, time, "exact"), keyframe))
        rests = keyframe.hold > 0 and placed.shot.keyframes[index].beside is None
        if rests or len(placed.keyframes) == 1:
            end = phase.end if len(placed.keyframes) == 1 or time is None else time + keyframe.hold
            name = f"drift at keyframe {index + 1}"
            drift = Limit(name, PLACE_TOLERANCE, "m", keyframe.path, shot=placed.shot.id)
            yield _still(flight, drift, (time, end), placed.shot, phase)
    for name, unit, limit, errors in (
        ("distance from keyframes", "m", PLACE_TOLERANCE, met),
        ("delay of keyframes", "s", ON_TIME_S, late),
    ):
        if errors:
            worst, keyframe = max(errors, key=lambda pair: pair[0].value)
            yield claim(flight, Limit(name, limit, unit, keyframe.path, shot=placed.shot.id), worst)


def _place(flight: JudgedFlight, ir: TrajectoryIR, shot: Shot, phase: Phase) -> Iterator[Claim]:
    """Yield the claim that a shot on its own clock leaves its ideal only as far as reported and explained."""
    if shot.ideal is None:
        return
    inside = ticks_inside(flight.mission.rate, phase.start, phase.end)
    t = np.union1d(inside, [phase.start, phase.end])
    begun = at_start(flight.mission, shot, phase.start)
    ideal = np.array([ideal_place(flight.mission, begun, phase.start, float(u)) for u in t])
    deviation = np.linalg.norm(flight.track.curve(t)[:, :3] - ideal, axis=1)
    k = int(np.argmax(deviation))
    limit = Limit(
        "distance from its place",
        _allowed(flight, ir, begun, ExpectedPlaces(ideal, t)),
        "m",
        shot.path,
        shot=shot.id,
    )
    yield claim(flight, limit, WorstValue(float(deviation[k]), float(t[k]), "sampled"))


def _allowed(flight: JudgedFlight, ir: TrajectoryIR, shot: Shot, course: ExpectedPlaces) -> float:
    """Return how far a shot may be from its ideal, metres, as the plan reports and the mission explains."""
    assert shot.ideal is not None
    placed = shot.ideal.placed
    blocks = in_the_way(flight, course, placed=placed)
    far = farthest(flight.mission, (s.target for s in shot.subjects), course)
    explained = sum(blocks.values()) + for_the_picture(flight.mission, far, placed=placed)
    explained += for_its_limits(flight, course, shot.smoothing)
    reported = max(believed((d for d in ir.deviations if d.shot == shot.id), blocks), default=0.0)
    allowed = min(reported, explained) + UNREPORTED_M
    stands = placed and not np.ptp(course.places, axis=0).any()
    return min(allowed, max(explained, IN_PLACE_M)) if stands else allowed


def _there(placed: PlacedShot, index: int, time: float | None) -> tuple[float | None, ...]:
    """Return when the camera has to be at a keyframe; beside a target also when a hold there ends."""
    hold = placed.keyframes[index].hold
    if time is None or hold <= 0 or placed.shot.keyframes[index].beside is None:
        return (time,)
    return (time, time + hold)


def _miss(
    flight: JudgedFlight, which: tuple[PlacedShot, int], phase: Phase, time: float | None
) -> WorstValue:
    if time is None or not phase.start - ON_TIME_S <= time <= phase.end + ON_TIME_S:
        return WorstValue(inf, None, "exact")
    placed, index = which
    written = placed.shot.keyframes[index]
    at = placed.keyframes[index].at if written.beside is None else place_of(flight.mission, written, time)
    offset = flight.track.curve(time)[:3] - np.array(at)
    return WorstValue(float(np.linalg.norm(offset)), time, "exact")


def _still(
    flight: JudgedFlight, limit: Limit, span: tuple[float | None, float], shot: Shot, phase: Phase
) -> Claim:
    start, end = span
    if start is None or start < phase.start - ON_TIME_S or end > phase.end + ON_TIME_S:
        return claim(flight, limit, WorstValue(inf, start, "exact"))
    # A camera that follows a moving target turns while it rests.
    curve = flight.track.curve.channels(*range(Z + 1 if is_keyed(shot) else HFOV + 1))
    pose = curve(start)
    drift = sup_convex(cut(curve, start, end), lambda c: norm(c - pose), gap(PLACE_TOLERANCE))
    return bounded(flight, limit, drift)
