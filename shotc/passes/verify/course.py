"""Check that a shot is flown as its kind asks: along its path, from start to end.

Keyframes that a kind generates are an ideal. Planning may leave them where an obstacle is in the way, or for
the picture. The plan states how far, and no more is allowed; where nothing is near its ends they bind.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import pairwise
from math import inf
from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.chord import sup_off_chord
from shotc.geom.proof import norm
from shotc.geom.solids import distance, signed_distance
from shotc.ir.drawn import half_widths, is_drawn
from shotc.ir.keyframes import PlacedKeyframe, PlacedShot
from shotc.ir.mission import MissionIR
from shotc.ir.phases import Phase
from shotc.ir.preference import PICTURE_SHARE
from shotc.ir.tolerances import BOW_SHARE, ON_TIME_S, PLACE_TOLERANCE
from shotc.ir.trajectory import Claim, TrajectoryIR
from shotc.passes.verify.claims import JudgedFlight, Limit, WorstValue, claim, flown_shots, gap
from shotc.passes.verify.explained import (
    NEAR_M,
    ExpectedPlaces,
    believed,
    farthest,
    for_the_picture,
    in_the_way,
)

UNREPORTED_M = 0.25
"""Metres that a path may leave generated keyframes without a report; planning reports from 0.1 m on."""

SWING_SHARE = 0.5
"""Share of the chord between two placed keyframes, or of a longer one beside it, by which it may be left."""

PLACES_PER_CHORD = 50
"""Samples of the chord between two keyframes, for obstacles."""

LONGER_RATIO = 1.5
"""Longest way between two keyframes over their distance, besides the way aside and back."""

PLACES_PER_WAY = 400
"""Samples of the way between two keyframes, for its length."""

AT_ENDS_M = 0.5
"""Metres from its ends within which a generated path begins and ends, where these are free."""


def course(flight: JudgedFlight, ir: TrajectoryIR) -> Iterator[Claim]:
    """Yield claims that this drone's shots with keyframes are flown in order and on their paths."""
    for placed, phase in flown_shots(flight, ir):
        if placed.shot.ideal is not None:
            continue
        times = [k.time for k in flight.track.keyframes if k.shot == placed.shot.id]
        yield _in_order(flight, placed, phase)
        if len(times) == len(placed.keyframes) and all(phase.start <= t <= phase.end for t in times):
            t = np.array(_times(flight, placed))
            yield from _along(flight, placed, t, ir)


def _allowance(flight: JudgedFlight, ir: TrajectoryIR, placed: PlacedShot, expected: ExpectedPlaces) -> float:
    """Return how far a shot may leave its path, metres: as reported, around obstacles and for its picture."""
    blocks = in_the_way(flight, expected)
    distances = believed((d for d in ir.deviations if d.shot == placed.shot.id), blocks)
    far = farthest(flight.mission, {k.target for k in placed.keyframes if k.target is not None}, expected)
    return min(sum(distances[:2]), sum(blocks.values()) + for_the_picture(flight.mission, far, placed=False))


def _chords(at: Array) -> ExpectedPlaces:
    """Return the polyline through places (K, 3), densely sampled."""
    share = np.linspace(0.0, 1.0, PLACES_PER_CHORD)[:, None]
    parts = [a + share * (b - a) for a, b in pairwise(at)]
    return ExpectedPlaces(np.concatenate(parts) if parts else at, None)


def _times(flight: JudgedFlight, placed: PlacedShot) -> list[float]:
    at = {k.index: k.time for k in flight.track.keyframes if k.shot == placed.shot.id}
    return [at.get(i, inf) for i in range(len(placed.keyframes))]


def _in_order(flight: JudgedFlight, placed: PlacedShot, phase: Phase) -> Claim:
    """Return the claim that each keyframe is met once, in order, with the first and last at the shot's ends.

    A keyframe with a time of its own is not bound to an end: the camera may stand before it, or after it.
    """
    keyframes = placed.keyframes
    entries = [k for k in flight.track.keyframes if k.shot == placed.shot.id]
    times = _times(flight, placed)
    spans = [(t, t + k.hold) for t, k in zip(times, keyframes, strict=True)]
    late = [before - start for (_, before), (start, _) in pairwise(spans)]
    ends = [abs(times[0] - phase.start)] if keyframes[0].time is None else [phase.start - times[0]]
    if len(keyframes) > 1:
        beyond = spans[-1][1] - phase.end
        ends.append(abs(beyond) if keyframes[-1].time is None else beyond)
    worst = max([*late, *ends]) if len(entries) == len(keyframes) else inf
    limit = Limit("keyframes out of order", ON_TIME_S, "s", placed.shot.path, shot=placed.shot.id)
    return claim(flight, limit, WorstValue(max(worst, 0.0), None, "exact"))


def _along(flight: JudgedFlight, placed: PlacedShot, t: Array, ir: TrajectoryIR) -> Iterator[Claim]:
    """Yield claims that a generated path is left only as reported, at its ends only where they are
    blocked.
    """
    keyframes, shot = placed.keyframes, placed.shot
    at = np.array([k.at for k in keyframes])
    if any(k.placed for k in keyframes):
        yield from _swing(flight, placed, t)
        return
    reported = _allowance(flight, ir, placed, _chords(at))
    deviation = np.linalg.norm(flight.track.curve(t)[:, :3] - at, axis=1)
    k = int(deviation.argmax())
    worst = WorstValue(float(deviation[k]), float(t[k]), "exact")
    ways: list[_Way] = []
    for i in range(len(t) - 1):
        between = _between(flight, (t[i], t[i + 1]), (at[i], at[i + 1]))
        worst = between if between.value > worst.value else worst
        chord = float(norm(at[i + 1] - at[i]))
        ways.append(_way(flight, (t[i], t[i + 1]), chord, BOW_SHARE * chord + reported + UNREPORTED_M))
    path = Limit("distance from its path", reported + UNREPORTED_M, "m", shot.path, shot=shot.id)
    yield claim(flight, path, worst)
    yield from _longest(flight, placed, ways)
    free = np.array([_is_free(flight, keyframe) for keyframe in keyframes])
    ends = [i for i in (0, len(t) - 1) if free[i]]
    if ends:
        k = max(ends, key=lambda i: float(deviation[i]))
        limit = Limit("distance from its ends", AT_ENDS_M, "m", shot.path, shot=shot.id)
        yield claim(flight, limit, WorstValue(float(deviation[k]), float(t[k]), "exact"))
    share = np.where(free, deviation / np.maximum(_distances(flight.mission, keyframes), 1e-9), 0.0)
    k = int(share.argmax())
    limit = Limit("detour where it is free", PICTURE_SHARE, "of the distance", shot.path, shot=shot.id)
    yield claim(flight, limit, WorstValue(float(share[k]), float(t[k]), "exact"))


def _swing(flight: JudgedFlight, placed: PlacedShot, t: Array) -> Iterator[Claim]:
    """Yield the claim that the path between placed keyframes stays near the chord where it is free.

    On a path that the author draws, near is the half-width of each leg.
    """
    keyframes, shot = placed.keyframes, placed.shot
    at = np.array([k.at for k in keyframes])
    lengths = norm(np.diff(at, axis=0))
    drawn = half_widths([k.at for k in keyframes]) if is_drawn(shot) else None
    swings: list[tuple[float, float, WorstValue]] = []
    ways: list[_Way] = []
    for i, (start, end) in enumerate(pairwise(t)):
        times, ends = (float(start) + keyframes[i].hold, float(end)), (at[i], at[i + 1])
        longest = float(lengths[max(i - 1, 0) : i + 2].max())
        near = SWING_SHARE * longest + UNREPORTED_M if drawn is None else drawn[i] + PLACE_TOLERANCE
        most = near + sum(in_the_way(flight, _chords(at[i : i + 2])).values())
        worst = _off_chord(flight, times, ends, most)
        swings.append((worst.value / most, most, worst))
        ways.append(_way(flight, times, float(lengths[i]), most))
    if swings:
        _, most, worst = max(swings, key=lambda one: one[0])
        limit = Limit("way between keyframes", most, "m", shot.path, shot=shot.id)
        yield claim(flight, limit, worst)
    yield from _longest(flight, placed, ways)


class _Way(NamedTuple):
    """A leg between two keyframes: its share of the longest allowed one, both lengths, metres, its start."""

    share: float
    flown: float
    most: float
    start: float


def _way(flight: JudgedFlight, times: tuple[float, float], chord: float, aside: float) -> _Way:
    """Return a leg with its longest allowed way: along the chord, and aside once and back.

    aside : how far it may leave the chord, metres
    """
    most, flown = LONGER_RATIO * chord + 2.0 * aside, 0.0
    if times[0] < times[1] < inf:
        places = flight.track.curve(np.linspace(*times, PLACES_PER_WAY))[:, :3]
        flown = float(norm(np.diff(places, axis=0)).sum())
    return _Way(flown / most, flown, most, float(times[0]))


def _longest(flight: JudgedFlight, placed: PlacedShot, ways: Sequence[_Way]) -> Iterator[Claim]:
    """Yield the claim that no leg is longer than its chord and what it may leave it by, as with loops."""
    if ways:
        longest = max(ways)
        limit = Limit("detour between keyframes", longest.most, "m", placed.shot.path, shot=placed.shot.id)
        yield claim(flight, limit, WorstValue(longest.flown, longest.start, "sampled"))


def _between(flight: JudgedFlight, times: tuple[float, float], ends: tuple[Array, Array]) -> WorstValue:
    """Return how far the flight is from the chord between two keyframes, minus its allowed bow."""
    bow = BOW_SHARE * float(np.linalg.norm(ends[1] - ends[0]))
    worst = _off_chord(flight, times, ends, bow + UNREPORTED_M)
    return replace(worst, value=max(worst.value - bow, 0.0))


def _off_chord(
    flight: JudgedFlight, times: tuple[float, float], ends: tuple[Array, Array], most: float
) -> WorstValue:
    """Return how far the flight is from the chord between two keyframes; most : limit, metres."""
    if times[1] <= times[0]:
        return WorstValue(0.0, times[0])
    bound = sup_off_chord(flight.track.curve.channels(0, 1, 2), times, ends, gap(most))
    return WorstValue(bound.proven, bound.at)


def _distances(mission: MissionIR, keyframes: tuple[PlacedKeyframe, ...]) -> Array:
    return np.array(
        [
            inf
            if k.target is None
            else float(np.linalg.norm(np.subtract(mission.target(k.target).centre, k.at)))
            for k in keyframes
        ]
    )


def _is_free(flight: JudgedFlight, keyframe: PlacedKeyframe) -> bool:
    """Return whether no obstacle is near a keyframe that could explain a deviation from it."""
    mission, at, body = flight.mission, keyframe.at, flight.drone.radius + NEAR_M
    rules = mission.rules
    if at[2] < mission.ground(at[0], at[1]) + rules.ground_clearance + body:
        return False
    for zone in mission.zones:
        apart = signed_distance(zone.solid, at)
        if (apart if zone.keep == "out" else -apart) < body:
            return False
    need = rules.beside_obstacle(flight.drone.radius) + NEAR_M
    if any(mesh.signed_distance(np.array([at]))[0] < need + mesh.spacing for mesh in mission.meshes):
        return False
    standing = [target for target in mission.targets if target.track is None]
    return all(distance(target.solid, at) >= rules.target_clearance + body for target in standing)
