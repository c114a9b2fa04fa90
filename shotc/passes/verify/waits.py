"""Check that a drone waits only for a reason: a time of the mission, a shot of another drone, or a passer-by.

Before a shot with a `start`, waiting is free. Without one, a shot on a path and the way home begin at once,
or after the shot of `after`. A drone may wait where its way, flown earlier, would come near to another drone
or to a moving target, or into a picture. So the flown way is put earlier, second by second: the least wait
from which on it meets nobody is needed, and ``WAIT_RATIO`` times that is allowed, since planning tries waits
in steps. A shot of what moves begins when the drone can be there, inside all fences, and at most ``FILM_S``
later.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import hypot
from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.framing import optical_axes
from shotc.geom.pieces import Mask
from shotc.geom.solids import signed_distance
from shotc.ir.bodies import centres, flying
from shotc.ir.framed import at_start
from shotc.ir.ideal import ideal_place
from shotc.ir.keyed import carriers
from shotc.ir.limits import Limits, Vec3
from shotc.ir.mission import MissionIR, Shot
from shotc.ir.sampling import cameras, phase_index
from shotc.ir.trajectory import Claim, DroneTrajectory, TrajectoryIR
from shotc.passes.verify.claims import JudgedFlight, Limit, WorstValue, claim
from shotc.passes.verify.lost_time import SLOWER_RATIO, UnfilmedFlight

WAITED, LATE, UNJUDGED = "wait without a reason", "delay of the start", "waits that are not judged"

WAIT_RATIO, WAIT_S = 1.5, 3.0
"""Largest wait over the needed one, and seconds beyond it."""

FILM_S, REACH_S = 90.0, 10.0
"""Seconds by which a film may begin later than its drone can be there; seconds for take-off and run-up."""

NEAR_M = 10.0
"""Metres beyond the clearances within which somebody is near: planning keeps room, and tries other ways."""

NEAR_RAD = np.radians(10.0)
"""Angle beyond a picture's corner within which a drone is near to it."""

HERE_M = 1e-9
"""Least distance that is divided by."""

STEP_S, WAITS_S = 0.5, 1.0
"""Seconds between samples of a flight, and between the waits that are tried."""

MOST_TIMES = 2000
"""Most of these times; an edited plan may last for years."""

AFTER_S = 3.0
"""Seconds after a shot in which planning keeps its end clear."""


class _Wait(NamedTuple):
    """Seconds of waiting beyond the allowed ones, and when the transfer begins."""

    over: float
    start: float


def waits(flight: JudgedFlight, ir: TrajectoryIR, between: Sequence[UnfilmedFlight]) -> Iterator[Claim]:
    """Yield claims on the waits of one drone before its shots, and on its way home.

    between : what it flies between its shots
    """
    mission, path = flight.mission, flight.drone.path
    ends = {p.shot: p.end for track in ir.drones for p in track.phases if p.shot is not None}
    lost, unjudged = [_Wait(0.0, 0.0)], 0
    for transfer in between:
        shot = None if transfer.shot is None else mission.shot(transfer.shot)
        if shot is not None and shot.timing.start is not None:
            continue
        if mission.displays:
            unjudged += 1
            continue
        after = None if shot is None else shot.timing.after
        ready = max(transfer.start, ends.get(after or "", 0.0))
        if shot is not None and shot.ideal is not None:
            yield _begun(flight, shot, transfer, ready)
        else:
            waited = min(transfer.idle, transfer.end - ready)
            lost.append(_Wait(_without_reason(flight, transfer, waited), transfer.start))
    worst = max(lost)
    yield claim(flight, Limit(WAITED, WAIT_S, "s", path), WorstValue(worst.over, worst.start, "sampled"))
    if unjudged:
        yield claim(flight, Limit(UNJUDGED, unjudged, "", path), WorstValue(unjudged, None, "exact"))


def _without_reason(flight: JudgedFlight, transfer: UnfilmedFlight, waited: float) -> float:
    """Return by how many seconds a wait is longer than ``WAIT_RATIO`` times the needed one."""
    if waited <= WAIT_S:
        return waited
    flown = _flown_at(flight, transfer, waited)
    earlier = waited - _spread(0.0, waited, WAITS_S)
    needed = next((waited - float(by) for by in earlier if not _meets(flight, flown, float(by))), waited)
    return waited - WAIT_RATIO * needed


class _Flown(NamedTuple):
    """Samples of a transfer without its rests, and of the shot after it, (M,) each but ``at``, (M, 3).

    own : mission times at which it was flown; times : the same without rests, to the end of the transfer
    """

    own: Array
    times: Array
    at: Array


def _flown_at(flight: JudgedFlight, transfer: UnfilmedFlight, waited: float) -> _Flown:
    """Return the samples of a transfer and of its shot, or of the time on the pad that waiting has taken."""
    curve = flight.track.curve
    phase = next((p for p in flight.track.phases if p.shot == transfer.shot and transfer.shot), None)
    end = transfer.end + waited if phase is None else phase.end + AFTER_S
    own = _spread(transfer.end, end, STEP_S)
    times, left = own, transfer.end
    for low, high in transfer.moves[::-1]:
        part = _spread(low, high, STEP_S)
        own, times = np.append(part, own), np.append(left - high + part, times)
        left -= high - low
    return _Flown(own, times, flying(curve, own))


def _meets(flight: JudgedFlight, flown: _Flown, by: float) -> bool:
    """Return whether a flown way comes near to somebody if it is flown earlier by some seconds."""
    times = flown.times - by
    if any(_beside(flight, other, flown, times).any() for other in flight.others):
        return True
    rules = flight.mission.rules
    clearance = max(rules.target_clearance, rules.transits.filmed, rules.transits.other) + flight.drone.radius
    for target in flight.mission.targets:
        if target.track is not None:
            near = hypot(target.radius, target.height) + clearance + NEAR_M
            if (np.linalg.norm(centres(target, times) - flown.at, axis=1) < near).any():
                return True
    return False


def _beside(flight: JudgedFlight, other: DroneTrajectory, flown: _Flown, times: Array) -> Mask:
    """Return at which samples another drone is near, or one of both is near to the other's picture."""
    there = flying(other.curve, times)
    near = np.linalg.norm(there - flown.at, axis=1) < flight.mission.rules.separation + NEAR_M
    if flight.mission.rules.visibility == "off":
        return np.asarray(near)
    near |= _in_picture(flight, other, times, flown.at)
    return np.asarray(near | _in_picture(flight, flight.track, flown.own, there))


def _in_picture(flight: JudgedFlight, camera: DroneTrajectory, times: Array, places: Array) -> Mask:
    """Return at which of the times (M,) a place (M, 3) is near to the picture of a drone that films."""
    inside = np.clip(times, camera.curve.start, camera.curve.end)
    films = np.array([p.shot is not None for p in camera.phases])[phase_index(camera.phases, inside)]
    eyes = cameras(flight.mission, camera, inside)
    ahead = optical_axes(eyes.yaw, eyes.pitch)
    offset = places - eyes.position
    along = np.einsum("md,md->m", ahead, offset) / np.maximum(np.linalg.norm(offset, axis=1), HERE_M)
    angle = np.arccos(np.clip(along, -1.0, 1.0))
    corner = np.arctan(np.tan(eyes.hfov / 2.0) * hypot(1.0, 1.0 / eyes.aspect))
    corner = np.maximum(corner, flight.mission.rules.half_angle or 0.0)
    return np.asarray(films & (angle < corner + NEAR_RAD))


def _begun(flight: JudgedFlight, shot: Shot, transfer: UnfilmedFlight, ready: float) -> Claim:
    """Return the claim that a shot of what moves begins when its drone can be there."""
    mission, here = flight.mission, flight.track.curve(transfer.start)[:3]
    tracks = (mission.target(name).track for name in carriers(shot))
    first = max([ready, *(track.since for track in tracks if track is not None)])
    for t in _spread(first, transfer.end - FILM_S, WAITS_S):
        begun = at_start(mission, shot, float(t))
        place = ideal_place(mission, begun, float(t), float(t))
        way = _straight(flight.drone.limits, np.array(place) - here)
        if _is_inside(mission, place) and t - transfer.start >= SLOWER_RATIO * way + REACH_S:
            first = float(t)
            break
    else:
        first = max(first, transfer.end - FILM_S)
    limit = Limit(LATE, FILM_S, "s", (*shot.path, "timing"), shot=shot.id)
    return claim(flight, limit, WorstValue(transfer.end - first, transfer.end, "sampled"))


def _is_inside(mission: MissionIR, place: Vec3) -> bool:
    """Return whether a place is inside all fences; a drone waits until its place for the target is."""
    fences = (zone.solid for zone in mission.zones if zone.keep == "in")
    return all(signed_distance(fence, place) <= 0.0 for fence in fences)


def _spread(start: float, end: float, step: float) -> Array:
    """Return times from a start on, before an end, at a step, or farther apart where these are too many."""
    return np.arange(start, end, max(step, (end - start) / MOST_TIMES))


def _straight(limits: Limits, way: Array) -> float:
    """Return the seconds of a straight way, its climb after its level part, from rest to rest."""
    level, rise = float(np.hypot(way[0], way[1])), abs(float(way[2]))
    ramp = limits.speed / limits.usable_acceleration + limits.usable_acceleration / limits.jerk
    return level / limits.slowest + rise / min(limits.climb, limits.descent) + 2.0 * ramp
