"""Check that every display of the mission is flown, at its time, with its pictures in order.

What its pictures show is checked by ``lights`` and ``pictures``.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise
from math import inf

import numpy as np

from shotc.geom.fleet_pieces import FleetPieces
from shotc.geom.proof import norm, sup_convex
from shotc.ir.fleet import FrameTimes
from shotc.ir.origin import KeyPath
from shotc.ir.phases import Phase
from shotc.ir.show import Display
from shotc.ir.tolerances import ON_TIME_S, PLACE_TOLERANCE
from shotc.ir.trajectory import Claim, TrajectoryIR
from shotc.passes.verify.claims import LIMIT_TOLERANCE, Limit, WorstValue, gap, held
from shotc.passes.verify.fleets.cameras import named_pictures
from shotc.passes.verify.fleets.flight import FleetFlight, bounded
from shotc.passes.verify.fleets.lights import lights
from shotc.passes.verify.fleets.pictures import drawn
from shotc.passes.verify.fleets.standing import frames_of, standing

LEAST_WAY_M = 0.05
"""Least distance of a move, metres, for which the departure of drones is checked."""


def displays(flight: FleetFlight, ir: TrajectoryIR) -> Iterator[Claim]:
    """Yield claims that this fleet's displays are flown, on time, in full, and at rest during holds."""
    flights = [t.phases for t in ir.drones] + [t.phases for t in ir.fleets]
    ends = {p.shot: p.end for phases in flights for p in phases if p.shot is not None}
    for display in flight.mission.displays:
        if display.fleet != flight.fleet.name:
            continue
        flown = [p for p in flight.track.phases if p.shot == display.id]
        once = Limit("times flown", 1.0, "", display.path, upper=len(flown) > 0, shot=display.id)
        yield held(flight.fleet.name, once, WorstValue(float(len(flown)), None, "exact"))
        if len(flown) == 1:
            frames = [s for s in flight.track.shown if s.display == display.id]
            yield from _timing(flight, display, flown[0], ends)
            yield from _pictures(flight, display, flown[0], frames)
            known = [s for s in frames if s.picture in range(len(display.pictures))]
            yield from standing(flight.fleet.name, display, flown[0], known)
            yield from lights(flight, display, known)
            yield from drawn(flight, display, known)
            yield from _transitions(flight, display, frames)
            yield from _waves(flight, display, frames)
            yield from _holds(flight, display, frames)
            yield from named_pictures(flight, display, frames)


def _timing(flight: FleetFlight, display: Display, phase: Phase, ends: dict[str, float]) -> Iterator[Claim]:
    timing, path = display.timing, (*display.path, "timing")
    timings = [
        ("error of duration", "duration", _off(timing.duration, phase.end - phase.start), phase.end),
        ("error of start", "start", _off(timing.start, phase.start), phase.start),
        ("start too early", "after", _early(timing.after, ends, phase.start), phase.start),
    ]
    for name, key, off, time in timings:
        if off is not None:
            limit = Limit(name, ON_TIME_S, "s", (*path, key), shot=display.id)
            yield held(flight.fleet.name, limit, WorstValue(off, time, "exact"))


def _off(required: float | None, flown: float) -> float | None:
    return None if required is None else abs(flown - required)


def _early(after: str | None, ends: dict[str, float], start: float) -> float | None:
    return None if after is None or after not in ends else ends[after] - start


def _pictures(
    flight: FleetFlight, display: Display, phase: Phase, frames: Sequence[FrameTimes]
) -> Iterator[Claim]:
    """Yield claims that every frame is shown, in order, within the display, and each picture for its hold."""
    name, pictures = flight.fleet.name, range(len(display.pictures))
    order = [(s.picture, s.index) for s in frames]
    asked = set(_frames(display, order))
    missing = len({picture for picture, _ in asked - set(order)})
    astray = sum(b <= a for a, b in pairwise(order)) + sum(frame not in asked for frame in order)
    times = [phase.start, *(t for s in frames for t in (s.start, s.end)), phase.end]
    astray += sum(b < a - LIMIT_TOLERANCE for a, b in pairwise(times))
    limit = Limit("pictures left out", 0.0, "", (*display.path, "frames"), shot=display.id)
    yield held(name, limit, WorstValue(float(missing), None, "exact"))
    limit = Limit("pictures out of order", 0.0, "", (*display.path, "frames"), shot=display.id)
    yield held(name, limit, WorstValue(float(astray), None, "exact"))
    yield from _moments(flight, display, frames)
    last = {s.picture: s for s in frames}
    short = [(display.pictures[k].hold - (s.end - s.start), s) for k, s in last.items() if k in pictures]
    lack, at = max(short, key=lambda entry: entry[0], default=(-inf, None))
    if at is not None:
        path = (*display.pictures[at.picture].path, "hold")
        limit = Limit("lack of hold", ON_TIME_S, "s", path, shot=display.id)
        yield held(name, limit, WorstValue(max(lack, 0.0), at.start, "exact"))


def _frames(display: Display, order: Sequence[tuple[int, int]]) -> Iterator[tuple[int, int]]:
    """Yield (picture, index) of the frames that a display has; of a recorded flight as many as are shown."""
    for k, picture in enumerate(display.pictures):
        count = frames_of(picture)
        shown = max(1, sum(p == k for p, _ in order))
        yield from ((k, index) for index in range(shown if count is None else count))


def _moments(flight: FleetFlight, display: Display, frames: Sequence[FrameTimes]) -> Iterator[Claim]:
    """Yield the claim that pictures stand at their given times."""
    first = {s.picture: s for s in reversed(frames)}
    timed = [(k, p) for k, p in enumerate(display.pictures) if p.at is not None and k in first]
    off = [(abs(first[k].start - (p.at or 0.0)), first[k].start, p.path) for k, p in timed]
    if off:
        error, time, path = max(off)
        limit = Limit("error of moment", ON_TIME_S, "s", (*path, "at"), shot=display.id)
        yield held(flight.fleet.name, limit, WorstValue(error, time, "exact"))


def _transitions(flight: FleetFlight, display: Display, frames: Sequence[FrameTimes]) -> Iterator[Claim]:
    """Yield the claim that transitions between pictures take their given time, and how many have none.

    Nothing judges how long a transition without a time takes.
    """
    transitions: list[tuple[float, float, KeyPath]] = []
    for one, other in pairwise(frames):
        if one.picture != other.picture and other.picture in range(len(display.pictures)):
            picture = display.pictures[other.picture]
            if picture.transition is not None:
                off = abs(other.start - one.end - picture.transition)
                transitions.append((off, other.start, (*picture.path, "transition")))
    if transitions:
        off, time, path = max(transitions, key=lambda item: item[0])
        limit = Limit("error of transition", ON_TIME_S, "s", path, shot=display.id)
        yield held(flight.fleet.name, limit, WorstValue(off, time, "exact"))
    free = float(sum(p.transition is None and p.at is None for p in display.pictures[1:]))
    if free:
        limit = Limit("transitions without a time", free, "", (*display.path, "frames"), shot=display.id)
        yield held(flight.fleet.name, limit, WorstValue(free, None, "exact"))


def _waves(flight: FleetFlight, display: Display, frames: Sequence[FrameTimes]) -> Iterator[Claim]:
    """Yield the claim that the drones depart within the time of a wave, to two pieces of their splines.

    For a move of millimetres rounding hides the departure, and a drone that stays never departs. So there is
    no claim if any drone moves less than ``LEAST_WAY_M``.
    """
    breaks, coef = flight.track.breaks, flight.track.coef
    claims: list[tuple[float, Limit, WorstValue]] = []
    first = {s.picture: s for s in reversed(frames)}
    for k, picture in enumerate(display.pictures):
        if picture.wave is None or k not in first:
            continue
        end = first[k].start
        begin = max((s.end for s in flight.track.shown if s.end <= end), default=flight.track.phases[0].end)
        on_way = np.flatnonzero(
            (breaks[:-1] > begin - LIMIT_TOLERANCE) & (breaks[1:] < end + LIMIT_TOLERANCE)
        )
        if (
            not len(on_way)
            or np.linalg.norm(coef[:, on_way[-1] + 3] - coef[:, on_way[0]], axis=1).min() < LEAST_WAY_M
        ):
            continue
        # A drone moves on a piece if its four control points are not all equal.
        steps = (np.diff(coef[:, : on_way[-1] + 4], axis=1) != 0.0).any(axis=2)
        moving = np.stack([steps[:, j : j + 3].any(axis=1) for j in on_way], axis=1)
        departs = breaks[on_way[moving.argmax(axis=1)]]
        off = abs(float(np.ptp(departs)) - picture.wave.time)
        most = 2.0 * float(np.diff(breaks)[on_way].max())
        limit = Limit("error of wave", most, "s", (*picture.path, "transition", "wave"), shot=display.id)
        claims.append((off - most, limit, WorstValue(off, float(departs.max()), "exact")))
    if claims:
        _, limit, worst = max(claims, key=lambda item: item[0])
        yield held(flight.fleet.name, limit, worst)


def _holds(flight: FleetFlight, display: Display, frames: Sequence[FrameTimes]) -> Iterator[Claim]:
    """Yield the claim that no drone moves while a picture is held."""
    parts = [flight.flown.between([(s.start, s.end)]) for s in frames]
    parts = [part for part in parts if len(part.low)]
    if not parts:
        return
    from_place = FleetPieces(
        np.concatenate([p.low for p in parts]),
        np.concatenate([p.high for p in parts]),
        np.concatenate([p.ctrl - p.ctrl[:, :1, :1] for p in parts], axis=1),
    )
    drift = sup_convex(from_place.bag(), norm, gap(PLACE_TOLERANCE))
    begin = max((s.start for s in frames if s.start <= drift.at), default=0.0)
    place = flight.at(begin)
    limit = Limit("drift at rest", PLACE_TOLERANCE, "m", (*display.path, "frames"), shot=display.id)
    yield bounded(flight, limit, drift, lambda p: norm(p - place))
