"""Cameras against fleets that fly: how near they come at every instant, and the pictures that they film."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import product
from math import inf

import numpy as np

from shotc.geom.bernstein import Array, Piecewise
from shotc.geom.bspline import held_until, restrict
from shotc.geom.pieces import Pieces
from shotc.geom.proof import Bound, box_gap, inf_distance, norm
from shotc.geom.solids import point
from shotc.ir.fleet import Shown
from shotc.ir.sampling import light_colors
from shotc.ir.show import Display, kept_from_cameras
from shotc.ir.trajectory import Claim, DroneTrajectory
from shotc.passes.verify.claims import Limit, Worst, gap, held
from shotc.passes.verify.fleets.flight import FleetFlight

POINT = point((0.0, 0.0, 0.0))
BLOCK = 200
"""Drones that are looked at together."""


def from_cameras(flights: Sequence[FleetFlight], cameras: Sequence[DroneTrajectory]) -> Iterator[Claim]:
    """Claim the separation of every drone with a camera from every drone of every fleet that flies."""
    for camera, flight in product(cameras, flights):
        least = kept_from_cameras(flight.mission.rules.separation, flight.fleet)
        bound = _nearest(camera.curve.channels(0, 1, 2), flight, least)
        at = camera.curve(np.clip(bound.at, camera.curve.start, camera.curve.end))[:3]
        drone = int(norm(flight.at(min(bound.at, float(flight.track.breaks[-1]))) - at).argmin())
        place = (float(at[0]), float(at[1]), float(at[2]))
        limit = Limit(f"separation from {camera.drone}", least, "m", ("rules", "separation"), upper=False)
        worst = Worst(bound.proven, bound.at, "bounded", place)
        yield held(flight.fleet.name, limit, worst, (flight.names[drone], camera.drone))


def _nearest(camera: Piecewise, flight: FleetFlight, least: float) -> Bound:
    """Bound the distance of a camera from the nearest drone, block by block, near pieces alone."""
    end = max(camera.end, float(flight.track.breaks[-1]))
    breaks = np.union1d(camera.breaks, flight.track.breaks)
    eye = restrict(held_until(camera, end), breaks).ctrl
    best = Bound(inf, inf, 0.0)
    for first in range(0, len(flight.names), BLOCK):
        ctrl = flight.flown.ctrl[first : first + BLOCK]
        # All drones of the block as the channels of one curve, which is cut at the common breaks.
        n, q, k, _ = ctrl.shape
        whole = Piecewise(flight.track.breaks, ctrl.transpose(1, 2, 0, 3).reshape(q, k, 3 * n))
        cut = restrict(held_until(whole, end), breaks).ctrl.reshape(len(breaks) - 1, k, n, 3)
        apart = (
            (eye[:, :, None] - _raised(cut, camera.degree))
            .transpose(2, 0, 1, 3)
            .reshape(-1, camera.degree + 1, 3)
        )
        far = box_gap(apart, POINT)
        near = far <= min(best.proven, float(norm(apart[:, 0]).min()))
        if near.any():
            spans = np.tile(breaks[:-1], n)[near], np.tile(breaks[1:], n)[near]
            bound = inf_distance(Pieces(*spans, apart[near]), POINT, gap(least))
            best = bound if bound.proven < best.proven else best
    return best


def _raised(ctrl: Array, degree: int) -> Array:
    """Return the Bernstein points (P, k + 1, ...) of the same curves with a higher degree."""
    while ctrl.shape[1] <= degree:
        k = ctrl.shape[1]
        share = (np.arange(k + 1) / k).reshape(1, -1, *[1] * (ctrl.ndim - 2))
        before = np.concatenate([ctrl[:, :1], ctrl], axis=1)
        after = np.concatenate([ctrl, ctrl[:, -1:]], axis=1)
        ctrl = share * before + (1.0 - share) * after
    return ctrl


def named_pictures(flight: FleetFlight, display: Display, shown: Sequence[Shown]) -> Iterator[Claim]:
    """Claim that the lights of every named picture are in the body that cameras frame in its place."""
    for stand in shown:
        name = display.pictures[stand.picture].name if stand.picture < len(display.pictures) else None
        if name is None:
            continue
        target = flight.mission.target(name)
        lit = light_colors(flight.track.lights, np.array([stand.start]))[:, 0].any(axis=1)
        away = flight.at(stand.start)[lit] - np.array(target.centre)
        out = max((target.shape.gap((float(x), float(y), float(z))) for x, y, z in away), default=0.0)
        path = (*display.pictures[stand.picture].path, "name")
        limit = Limit(f"lights outside {name}", 0.0, "m", path, shot=display.id)
        yield held(flight.fleet.name, limit, Worst(out, stand.start, "exact"))
