"""Check that no time is lost where the mission leaves it free: between keyframes, and between shots.

The least time of a way follows from its shape (``least_time``). A flight may take a multiple of it, because
the estimate has no limit of jerk between the ends, and a constant. In a shot with a duration
the least times are scaled to the duration first. Where the time is free, rest between two keyframes is lost
in whole, but for the holds that the mission asks for. On transits turns count once, from end to end, and the
way is bounded by the straight line and by what stands, so that neither a turning camera nor circles take up
time.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import groupby, pairwise
from math import inf, pi
from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array, Piecewise
from shotc.geom.bspline import restrict
from shotc.ir.drone import Drone
from shotc.ir.keyframes import PlacedShot
from shotc.ir.mission import MissionIR
from shotc.ir.path import BODY_YAW, CAM_PITCH, CAM_YAW
from shotc.ir.phases import Phase
from shotc.ir.tolerances import ON_TIME_S
from shotc.ir.trajectory import Claim, TrajectoryIR
from shotc.passes.verify.claims import JudgedFlight, Limit, WorstValue, claim, flown_shots
from shotc.passes.verify.explained import size_of
from shotc.passes.verify.least_time import least_times

BETWEEN = "time lost between keyframes"
BETWEEN_SHOTS, WAY = "time lost between shots", "detour between shots"

SLOWER_RATIO = 1.5
"""Ratio of a flown time to the least one up to which no time is lost."""

TRANSIT_RATIO = 3.0
"""The same between shots, where nobody films, and where turns and several legs take their time."""

KEYFRAMES_S, TRANSITS_S = 0.5, 5.0
"""Seconds beyond it: for the ends of a leg between two keyframes, and for the joints of legs on a transit."""

DETOUR_RATIO, DETOUR_M, SIZES = 2.0, 100.0, 4.0
"""Longest transit: ratio to the straight line, metres for what moves, ratio to the sizes of what stands."""

MOST_TURN_RAD = 4.0 * pi
"""Largest turn of an axis that counts: at both ends of a way the body may turn round on the spot."""

TRANSIT_SAMPLES = 2000
"""Samples of a transit, for the length of its way and for its turns."""

STILL_TOLERANCE = 1e-9
"""Change of any channel in a piece up to which the drone rests, metres or radians."""


class UnfilmedFlight(NamedTuple):
    """What a drone flies between two shots, or from and to its pad.

    start, end : mission times, seconds; shot : the next one, None on the way home
    moves : the intervals in which it moves, shape (K, 2)
    """

    start: float
    end: float
    shot: str | None
    moves: Array

    @property
    def idle(self) -> float:
        """Seconds of rest."""
        return _idle((self.start, self.end), self.moves)


def lost_time(flight: JudgedFlight, ir: TrajectoryIR, between: Sequence[UnfilmedFlight]) -> Iterator[Claim]:
    """Yield claims on the time that this drone loses in its shots on paths, and between its shots.

    between : what it flies between its shots
    """
    for placed, phase in flown_shots(flight, ir):
        if placed.shot.ideal is None:
            yield from _between(flight, placed, phase)
    yield from _on_transits(flight, between)


def transfers(flight: JudgedFlight) -> tuple[UnfilmedFlight, ...]:
    """Return what a drone flies between its shots, in order."""
    found: list[UnfilmedFlight] = []
    runs = [(shot, list(run)) for shot, run in groupby(flight.track.phases, lambda p: p.shot)]
    for i, (shot, run) in enumerate(runs):
        if shot is None:
            then = runs[i + 1][0] if i + 1 < len(runs) else None
            span = run[0].start, run[-1].end
            found.append(UnfilmedFlight(*span, then, _moves(flight.track.curve, span)))
    return tuple(found)


def _moves(curve: Piecewise, span: tuple[float, float]) -> Array:
    inner = curve.breaks[(curve.breaks > span[0]) & (curve.breaks < span[1])]
    breaks = np.concatenate([span[:1], inner, span[1:]])
    still = np.ptp(restrict(curve, breaks).ctrl, axis=1).max(axis=1) <= STILL_TOLERANCE
    moves = [list(part) for rests, part in groupby(range(len(still)), lambda k: still[k]) if not rests]
    return np.array([(breaks[part[0]], breaks[part[-1] + 1]) for part in moves]).reshape(-1, 2)


def _idle(span: tuple[float, float], moves: Array) -> float:
    return span[1] - span[0] - float(np.diff(moves, axis=1).sum())


def _rest(curve: Piecewise, span: tuple[float, float]) -> float:
    """Return the seconds of rest between two times; 0 where the second one is no later than the first."""
    return _idle(span, _moves(curve, span)) if span[0] < span[1] else 0.0


def _between(flight: JudgedFlight, placed: PlacedShot, phase: Phase) -> Iterator[Claim]:
    """Yield the claim on the time that a shot loses on its legs between keyframes."""
    known = {k.index: k.time for k in flight.track.keyframes if k.shot == placed.shot.id}
    count = len(placed.keyframes)
    first, last = phase.start - ON_TIME_S, phase.end + ON_TIME_S
    if count < 2 or any(not first <= known.get(i, inf) <= last for i in range(count)):
        return  # the order of its keyframes refuses the second
    at = {i: min(max(known[i], phase.start), phase.end) for i in range(count)}
    lost = [(0.0, phase.start)]
    for stretch in _stretches(placed):
        legs = _legs(flight, placed, at, stretch)
        lasts, least = sum(leg.lasts for leg in legs), sum(leg.least for leg in legs)
        if not stretch.timed or least > 0.0:
            scale = max(1.0, lasts / least) if stretch.timed else 1.0
            lost += [(leg.lasts - SLOWER_RATIO * scale * leg.least, leg.start) for leg in legs]
            # The constant of each of many short legs would add up.
            lost.append((lasts - SLOWER_RATIO * scale * least, legs[0].start))
        if not stretch.timed:
            lost += _rests(flight.track.curve, [leg for leg in legs if leg.least > 0.0])
    worst, when = max(lost)
    limit = Limit(BETWEEN, KEYFRAMES_S, "s", placed.shot.path, shot=placed.shot.id)
    yield claim(flight, limit, WorstValue(worst, when, "sampled"))


def _rests(curve: Piecewise, legs: Sequence[_Leg]) -> Iterator[tuple[float, float]]:
    """Yield the seconds of rest on all of some legs, with the start of the one that has most of them."""
    rests = [(_rest(curve, (leg.start, leg.end)), leg.start) for leg in legs]
    if rests:
        yield sum(rest for rest, _ in rests), max(rests, key=lambda rest: rest[0])[1]


class _Stretch(NamedTuple):
    """Keyframes from one with a known time to the next such one, or to the end of a free shot.

    first, last : their indices; timed : whether the time of the last one is known
    """

    first: int
    last: int
    timed: bool


def _stretches(placed: PlacedShot) -> Iterator[_Stretch]:
    end = len(placed.keyframes) - 1
    known = {0} | {i for i, k in enumerate(placed.keyframes) if k.time is not None}
    known |= {end} if placed.shot.timing.duration is not None else set()
    for first, last in pairwise(sorted(known)):
        yield _Stretch(first, last, timed=True)
    if max(known) < end:
        yield _Stretch(max(known), end, timed=False)


class _Leg(NamedTuple):
    """A way from one keyframe to the next: its mission times, and its least seconds."""

    start: float
    end: float
    least: float

    @property
    def lasts(self) -> float:
        """Its flown seconds."""
        return self.end - self.start


def _legs(flight: JudgedFlight, placed: PlacedShot, at: dict[int, float], stretch: _Stretch) -> list[_Leg]:
    """Return the legs between the keyframes of a stretch; at : mission times of all keyframes, seconds."""
    first, last, timed = stretch
    share, smoother = (1.0, 1.0) if timed else (placed.shot.pace, placed.shot.smoother)
    holds = [k.hold for k in placed.keyframes]
    rests = [first, *(i for i in range(first + 1, last) if holds[i] > 0.0), last]
    legs: list[_Leg] = []
    for a, b in pairwise(rests):
        begins = [at[i] + (holds[i] if i == a else 0.0) for i in range(a, b)]
        ends = [at[i] for i in range(a + 1, b + 1)]
        whole = least_times(flight.track.curve, (begins[0], ends[-1]), flight.drone, share, smoother)
        legs += [_Leg(t, u, whole.between(t, u)) for t, u in zip(begins, ends, strict=True)]
    return legs


def _on_transits(flight: JudgedFlight, between: Sequence[UnfilmedFlight]) -> Iterator[Claim]:
    """Yield the claims on the time that a drone loses on its transits, and on how long these are."""
    curve, path = flight.track.curve, flight.drone.path
    stands = DETOUR_M + SIZES * sum(_sizes(flight.mission))
    lost, detours = [(0.0, 0.0)], [_Detour(0.0, 0.0, 0.0, stands)]
    for transfer in between:
        ways = (least_times(curve, (a, b), flight.drone, 1.0, turns=False) for a, b in transfer.moves)
        least = sum(float(way.least[-1]) for way in ways)
        took = transfer.end - transfer.start - transfer.idle
        poses = curve(np.linspace(transfer.start, transfer.end, TRANSIT_SAMPLES))
        lost.append((took - TRANSIT_RATIO * least - _turning(flight.drone, poses), transfer.start))
        at = poses[:, :3]
        way = float(np.linalg.norm(np.diff(at, axis=0), axis=1).sum())
        most = DETOUR_RATIO * float(np.linalg.norm(at[-1] - at[0])) + stands
        detours.append(_Detour(way / most, transfer.start, way, most))
    worst, when = max(lost)
    yield claim(flight, Limit(BETWEEN_SHOTS, TRANSITS_S, "s", path), WorstValue(worst, when, "sampled"))
    longest = max(detours)
    yield claim(
        flight, Limit(WAY, longest.most, "m", path), WorstValue(longest.way, longest.start, "sampled")
    )


class _Detour(NamedTuple):
    """A transit: its share of the longest allowed way, its start, seconds, and both ways, metres."""

    share: float
    start: float
    way: float
    most: float


def _turning(drone: Drone, at: Array) -> float:
    """Return the seconds that the turns of a transfer take, each axis by ``MOST_TURN_RAD`` at most.

    at : poses on the transfer, (M, 7)
    """
    gimbal, limits = drone.gimbal, drone.limits
    angles = (
        (at[:, BODY_YAW], limits.yaw_rate, limits.yaw_acceleration),
        (at[:, CAM_YAW] - at[:, BODY_YAW], gimbal.rate, gimbal.acceleration),
        (at[:, CAM_PITCH], gimbal.rate, gimbal.acceleration),
    )
    turns = [(min(float(np.abs(np.diff(angle)).sum()), MOST_TURN_RAD), *most) for angle, *most in angles]
    return sum(
        turn / rate + rate / acceleration for turn, rate, acceleration in turns if turn > STILL_TOLERANCE
    )


def _sizes(mission: MissionIR) -> Iterator[float]:
    """Yield the sizes of what stands: zones, targets, meshes, and the relief of the terrain, metres."""
    yield from (size_of(zone.solid) for zone in mission.zones)
    yield from (max(2.0 * target.radius, target.height) for target in mission.targets)
    for mesh in mission.meshes:
        yield float(np.linalg.norm(np.ptp(mesh.surface.triangles, axis=(0, 1))))
    if mission.terrain is not None:
        yield float(np.ptp(mission.terrain.ground.surface.triangles[:, :, 2]))
