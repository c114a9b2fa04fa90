"""Separation of cameras from flying fleets at every instant, and the pictures that cameras film."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import product

import numpy as np

from shotc.geom.proof import norm
from shotc.ir.fleet import FrameTimes
from shotc.ir.light_colors import lit_drones
from shotc.ir.show import Display, kept_from_cameras
from shotc.ir.trajectory import Claim, DroneTrajectory
from shotc.passes.verify.claims import Limit, WorstValue, held
from shotc.passes.verify.fleets.flight import FleetFlight
from shotc.passes.verify.fleets.nearness import nearest


def from_cameras(
    flights: Sequence[FleetFlight], cameras: Sequence[DroneTrajectory], begin: float = 0.0
) -> Iterator[Claim]:
    """Yield claims on the separation of every drone with a camera from every drone of every flying fleet.

    begin : mission time from which on it is claimed, s
    """
    for camera, flight in product(cameras, flights):
        least = kept_from_cameras(flight.mission.rules.separation, flight.fleet)
        breaks, eye = flight.track.breaks, camera.curve.channels(0, 1, 2)
        span = (begin, max(eye.end, float(breaks[-1])))
        bound = nearest(eye, breaks, flight.flown.ctrl, span, least)
        at = camera.curve(bound.at)[:3]
        drone = int(norm(flight.at(bound.at) - at).argmin())
        place = (float(at[0]), float(at[1]), float(at[2]))
        limit = Limit(f"separation from {camera.drone}", least, "m", ("rules", "separation"), upper=False)
        worst = WorstValue(bound.proven, bound.at, "bounded", place)
        yield held(flight.fleet.name, limit, worst, (flight.names[drone], camera.drone))


def named_pictures(flight: FleetFlight, display: Display, frames: Sequence[FrameTimes]) -> Iterator[Claim]:
    """Yield claims that the lights of every named picture lie within the body that cameras frame for it."""
    for stand in frames:
        name = display.pictures[stand.picture].name if stand.picture < len(display.pictures) else None
        if name is None:
            continue
        target = flight.mission.target(name)
        lit = lit_drones(flight.track, np.array([stand.start]))[:, 0]
        offsets = flight.at(stand.start)[lit] - np.array(target.centre)
        out = max((target.shape.gap((float(x), float(y), float(z))) for x, y, z in offsets), default=0.0)
        path = (*display.pictures[stand.picture].path, "name")
        limit = Limit(f"lights outside {name}", 0.0, "m", path, shot=display.id)
        yield held(flight.fleet.name, limit, WorstValue(out, stand.start, "exact"))
