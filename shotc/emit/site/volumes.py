"""The volumes of a flight on the map: where it is flown, what lies around that, and where it may come down.

The flight's hull is that of its control points, in which its curves lie at every instant. The margin about
it is the sum of what an operator usually accounts for: errors of positions, a second to react, and the way to
stop. The ground risk buffer is as wide as the volume is high (1:1). The constants are assumptions of this
module and were taken from no authority's text. The margins are a proposal; the authority decides.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.spatial import ConvexHull, QhullError

from shotc.geom.bernstein import Array
from shotc.geom.solid_arrays.rings import ring
from shotc.ir.limits import Limits
from shotc.ir.trajectory import TrajectoryIR

OFF_ACROSS_M, OFF_UPRIGHT_M = 7.0, 4.0
"""Assumed errors of positions, metres: 3 of the receiver, 3 of holding a place, 1 of the map; of height."""
REACTION_S = 1.0
SIDES = 32
"""Of the polygon about a circle by which a hull is made wider."""


class AreaOutline(NamedTuple):
    """A convex area on the map, corners counter-clockwise (k, 2), metres in W, and its greatest height, z."""

    corners: Array
    top: float

    @property
    def area(self) -> float:
        """Return its area, m^2."""
        x, y = self.corners.T
        return float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y)) / 2.0


class Volumes(NamedTuple):
    """Where drones fly, with the margins about that.

    flight : of their bodies; contingency : with the margins across and upright; risk : ground below and about
    across, upright, buffer : widths of the margins, metres
    ground : z from which heights count, that of the lowest pad
    """

    flight: AreaOutline
    contingency: AreaOutline
    risk: AreaOutline
    across: float
    upright: float
    buffer: float
    ground: float


def volumes(flown: TrajectoryIR) -> Volumes:
    """Return the volumes of a flight; there is one."""
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
    # A track in a line has no hull of its own; with the bodies about it, it has.
    own = widened(np.unique(flat, axis=0), radius)
    top = float(points[:, 2].max()) + radius
    margin = widened(own, across)
    buffer = top + upright - ground
    return Volumes(
        AreaOutline(own, top),
        AreaOutline(margin, top + upright),
        AreaOutline(widened(margin, buffer), ground),
        across,
        upright,
        buffer,
        ground,
    )


def _stopping(speed: float, limits: Limits) -> float:
    """Return how far a drone goes before it stands, metres, from a speed, m/s."""
    return REACTION_S * speed + speed**2 / (2.0 * limits.acceleration)


def widened(corners: Array, margin: float) -> Array:
    """Return the hull of points (n, 2) with a margin about it, counter-clockwise, (k, 2); never narrower."""
    points = (_outermost(corners)[:, None] + ring(margin, SIDES)).reshape(-1, 2)
    return np.asarray(points[ConvexHull(points).vertices])


def _outermost(points: Array) -> Array:
    """Return the corners of the hull of points (n, 2), or all where they lie in a line and it has none."""
    try:
        return np.asarray(points[ConvexHull(points).vertices])
    except (QhullError, ValueError):
        return points
