"""The volumes of a flight on the map: flight geography, contingency volume and ground risk buffer.

The flight geography is the hull of the control points, which contains the curves at every instant. The margin
around it is the sum of what an operator usually accounts for: position errors, a second of reaction, and the
stopping distance. The ground risk buffer is as wide as the volume is high (1:1). Over terrain that height
counts from the lowest ground in the buffer, which may be far below the pads. The constants are assumptions of
this module and do not come from an authority's text. The margins are a proposal; the authority decides.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.spatial import ConvexHull, QhullError

from shotc.geom.bernstein import Array
from shotc.geom.solid_arrays.rings import ring
from shotc.ir.limits import Limits
from shotc.ir.terrain import Terrain
from shotc.ir.trajectory import TrajectoryIR

OFF_ACROSS_M, OFF_UPRIGHT_M = 7.0, 4.0
"""Assumed position errors, metres.

Horizontally 3 of the receiver, 3 of position hold and 1 of the map; vertically 4.
"""
REACTION_S = 1.0
POLYGON_SIDES = 32
"""Sides of the polygon around a circle that widens a hull."""


class AreaOutline(NamedTuple):
    """A convex area on the map.

    corners : counter-clockwise, in W, metres, shape (k, 2)
    top : greatest height, z in W, metres
    """

    corners: Array
    top: float

    @property
    def area(self) -> float:
        """Area, m^2."""
        x, y = self.corners.T
        return float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y)) / 2.0


class Volumes(NamedTuple):
    """The volumes of a flight.

    flight : hull of the drones' bodies
    contingency : the flight geography with the margins
    risk : the ground below and around
    across, upright, buffer : widths of the margins, metres
    ground : z from which heights count: of the lowest pad, or of the lowest ground in the buffer if there is
        terrain and that is lower
    base : what that is, in words
    """

    flight: AreaOutline
    contingency: AreaOutline
    risk: AreaOutline
    across: float
    upright: float
    buffer: float
    ground: float
    base: str


def volumes(flown: TrajectoryIR) -> Volumes:
    """Return the volumes of a plan, which has at least one flight."""
    mission = flown.keyframes.mission
    fleets = [mission.fleet(flight.fleet) for flight in flown.fleets]
    drones = [mission.drone(track.drone) for track in flown.drones]
    points = np.concatenate(
        [flight.coef.reshape(-1, 3) for flight in flown.fleets]
        + [track.curve.ctrl[..., :3].reshape(-1, 3) for track in flown.drones]
    )
    limits = [*(fleet.limits for fleet in fleets), *(drone.limits for drone in drones)]
    radius = max([*(fleet.radius for fleet in fleets), *(drone.radius for drone in drones)])
    ground = min([*(pad[2] for fleet in fleets for pad in fleet.pads), *(drone.home[2] for drone in drones)])
    across = max(OFF_ACROSS_M + _stopping(limit.speed, limit) for limit in limits)
    upright = max(OFF_UPRIGHT_M + _stopping(limit.climb, limit) for limit in limits)
    flat = points[:, :2]
    # A track along a line has no hull; with the radius of the body around it, it has one.
    own = widened(np.unique(flat, axis=0), radius)
    top = float(points[:, 2].max()) + radius
    margin = widened(own, across)
    risk = _risk(margin, top + upright, ground, mission.terrain)
    return Volumes(
        AreaOutline(own, top),
        AreaOutline(margin, top + upright),
        risk,
        across,
        upright,
        top + upright - risk.top,
        risk.top,
        "the lowest pad" if risk.top == ground else "the lowest ground below it",
    )


def _risk(margin: Array, top: float, ground: float, terrain: Terrain | None) -> AreaOutline:
    """Return the ground risk buffer about an outline (k, 2), on the lowest ground in it.

    top, ground : z of the volume's top and of the lowest pad, metres
    """
    while True:
        corners = widened(margin, top - ground)
        low, high = corners.min(axis=0), corners.max(axis=0)
        if terrain is None or not np.isfinite(ground):
            return AreaOutline(corners, ground)
        lowest, _ = terrain.span((float(low[0]), float(low[1])), (float(high[0]), float(high[1])))
        if lowest >= ground:
            return AreaOutline(corners, ground)
        ground = lowest  # the buffer is wider then, and may contain lower ground


def _stopping(speed: float, limits: Limits) -> float:
    """Return the distance, metres, in which a drone stops from a speed, m/s, after the reaction time."""
    return REACTION_S * speed + speed**2 / (2.0 * limits.acceleration)


def widened(corners: Array, margin: float) -> Array:
    """Return the hull of points (n, 2) widened by a margin, counter-clockwise, shape (k, 2).

    It is never narrower than the exact margin.
    """
    points = (_outermost(corners)[:, None] + ring(margin, POLYGON_SIDES)).reshape(-1, 2)
    return np.asarray(points[ConvexHull(points).vertices])


def _outermost(points: Array) -> Array:
    """Return the corners of the hull of points (n, 2); all points if they lie on a line."""
    try:
        return np.asarray(points[ConvexHull(points).vertices])
    except (QhullError, ValueError):
        return points
