"""Check that a shot whose time is free is flown within its pace: a share of every limit, at every instant.

The share that a motion uses of a limit is its value over the limit; in a known wind it is the factor by which
the ground speeds that the limit allows are scaled to reach it. ``ir.pace`` says which share is allowed.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from math import inf
from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.pieces import Pieces, cut
from shotc.geom.proof import ProvedExtreme, norm, sup_convex
from shotc.ir.drone import Drone
from shotc.ir.keyframes import PlacedShot
from shotc.ir.limits import Limits
from shotc.ir.pace import leaves_time, most_share, on_clock
from shotc.ir.path import BODY_YAW, CAM_PITCH, CAM_YAW, HFOV
from shotc.ir.trajectory import Claim, TrajectoryIR
from shotc.passes.verify.claims import JudgedFlight, Limit, bounded, flown_shots, gap

CONSTRAINT = "pace"

Value = Callable[[Array], Array]


class LimitUse(NamedTuple):
    """How a motion uses one limit.

    name : of the limit, as the mission writes it
    pieces : the derivative that the limit binds
    share : convex, maps control points (..., D) to shares of the limit (...)
    """

    name: str
    pieces: Pieces
    share: Value


def pace(flight: JudgedFlight, ir: TrajectoryIR) -> Iterator[Claim]:
    """Yield the claims that this drone's shots keep their pace, of shots whose time is free."""
    beside = on_clock(ir.keyframes)
    for placed, phase in flown_shots(flight, ir):
        start = free_from(flight, placed, phase.start)
        if start is None or not start < phase.end:
            continue
        share = most_share(placed.shot.pace) if beside else placed.shot.pace
        limit = Limit(CONSTRAINT, share, "of the limits", (*placed.shot.path, "pace"), shot=placed.shot.id)
        uses = limit_uses(flight.drone, cut(flight.track.curve, start, phase.end), placed.shot.smoother)
        bounds = [sup_convex(use.pieces, use.share, gap(share)) for use in uses]
        yield bounded(flight, limit, _first_worst(bounds, gap(share)))


def free_from(flight: JudgedFlight, placed: PlacedShot, start: float) -> float | None:
    """Return from when on a shot has no time of the mission to meet, seconds; None where it always has one.

    After the last keyframe with a time that is the next one at which the drone rests.
    """
    if leaves_time(placed):
        return start
    if placed.shot.ideal is not None or placed.shot.timing.duration is not None:
        return None
    last = max(i for i, k in enumerate(placed.keyframes) if k.time is not None)
    times = {k.index: k.time for k in flight.track.keyframes if k.shot == placed.shot.id}
    rests = [i for i, k in enumerate(placed.keyframes) if i >= last and k.hold > 0.0]
    return times.get(rests[0]) if rests else None


def pace_note(ir: TrajectoryIR, claim: Claim) -> Iterator[str]:
    """Yield which limit a shot uses most, and its pace; nothing of another claim."""
    if claim.constraint != CONSTRAINT or claim.shot is None:
        return
    mission = ir.keyframes.mission
    shot = mission.shot(claim.shot)
    track = next(track for track in ir.drones if track.drone == claim.subject)
    phase = next(p for p in track.phases if p.shot == shot.id)
    uses = limit_uses(mission.drone(track.drone), cut(track.curve, phase.start, phase.end), shot.smoother)
    most = max(uses, key=lambda use: sup_convex(use.pieces, use.share, gap(1.0)).proven)
    yield f"it uses `{most.name}` most; the shot's `pace` is {shot.pace:g}"


def limit_uses(drone: Drone, flown: Pieces, smoother: float) -> tuple[LimitUse, ...]:
    """Return how a motion uses every limit; smoother : as of ``Shot``, by which the jerk is lower."""
    limits, gimbal, lens = drone.limits, drone.gimbal, drone.lens
    rate, acceleration = flown.derivative(), flown.derivative().derivative()
    body, swing = (order.channels(BODY_YAW) for order in (rate, acceleration))
    climb = rate.channels(2)
    uses = [
        LimitUse("speed", rate.channels(0, 1), lambda c: _airspeed_share(limits, c)),
        LimitUse("climb", climb, lambda c: c[..., 0] / limits.climb),
        LimitUse("descent", climb, lambda c: -c[..., 0] / limits.descent),
        LimitUse("acceleration", acceleration.channels(0, 1, 2), _over(limits.usable_acceleration)),
        LimitUse(
            "jerk", acceleration.derivative().channels(0, 1, 2), _over(limits.jerk / max(1.0, smoother))
        ),
        LimitUse("yaw_rate", body, _over(limits.yaw_rate)),
        LimitUse("yaw_acceleration", swing, _over(limits.yaw_acceleration)),
    ]
    for angle in (_against_body, lambda c: c[..., [CAM_PITCH]]):
        turn, surge = (Pieces(p.low, p.high, angle(p.ctrl)) for p in (rate, acceleration))
        uses.append(LimitUse("gimbal.rate", turn, _over(gimbal.rate)))
        uses.append(LimitUse("gimbal.acceleration", surge, _over(gimbal.acceleration)))
    if lens is not None and lens.zooms:
        uses.append(LimitUse("zoom_rate", rate.channels(HFOV), _over(lens.rate)))
    return tuple(uses)


def _against_body(ctrl: Array) -> Array:
    return np.asarray(ctrl[..., [CAM_YAW]] - ctrl[..., [BODY_YAW]])


def _over(limit: float) -> Value:
    return lambda c: norm(c) / limit


def _airspeed_share(limits: Limits, ground: Array) -> Array:
    """Return the shares k of the speed limit that ground speeds use, (...); ground : (..., 2), m/s.

    k is the least number with |v - k w| <= k V for the velocity v, the wind w and the limit V, a root of
    k^2 (V^2 - w^2) + 2 k v.w - v^2 = 0.
    """
    wind = np.array(limits.wind)
    left = limits.speed**2 - float(wind @ wind)
    with_it = ground @ wind
    square = np.einsum("...d,...d->...", ground, ground)
    return np.asarray((np.sqrt(with_it**2 + left * square) - with_it) / left)


def _first_worst(bounds: list[ProvedExtreme], near: Callable[[float], float]) -> ProvedExtreme:
    """Return the largest bound, with the time of the first that is as large up to a gap."""
    worst = max(bound.proven for bound in bounds)
    first = next(bound for bound in bounds if bound.proven >= worst - near(worst))
    return ProvedExtreme(worst, -inf, first.at)
