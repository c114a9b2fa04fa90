"""The geofence: zones as polygons and circles on the map, without height.

A keep-out zone that the flight passes above or below would stop the flight. So would a keep-in zone that the
flight leaves. Both are left out of the fence and reported.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from shotc.emit.waypoints.geo import METRE_DECIMALS, Geo
from shotc.geom.solid_arrays.points import footprint_distances
from shotc.geom.solids import Cylinder, signed_area
from shotc.ir.mission import MissionIR, Zone

Array = NDArray[np.float64]

MARGIN_M = 0.25  # metres that thinning may add to the flight


@dataclass(frozen=True, slots=True)
class FencePolygon:
    """A polygon to stay in or out of.

    corners : (lat, lon) in degrees, clockwise seen from above
    """

    inclusion: bool
    corners: tuple[tuple[float, float], ...]


@dataclass(frozen=True, slots=True)
class FenceCircle:
    """A circle to stay in or out of.

    centre : (lat, lon) in degrees
    radius : metres
    """

    inclusion: bool
    centre: tuple[float, float]
    radius: float


@dataclass(frozen=True, slots=True)
class OmittedZone:
    """A zone that is left out of the fence, and the reason."""

    zone: Zone
    reason: str


@dataclass(frozen=True, slots=True)
class Fence:
    """The fence of one drone's plan."""

    polygons: tuple[FencePolygon, ...]
    circles: tuple[FenceCircle, ...]
    left_out: tuple[OmittedZone, ...]


def fence_of(mission: MissionIR, geo: Geo, track: Array, *, one_inclusion: bool) -> Fence:
    """Return the fence of a flight.

    track : all points of the flight, those on the pad included, in W, metres, shape (n, 3)
    one_inclusion : the autopilot demands any one keep-in area instead of all (PX4), so only the smallest is
        written
    """
    polygons: list[FencePolygon] = []
    circles: list[FenceCircle] = []
    left: list[OmittedZone] = []
    misfits = [_misfit(zone, track[:, :2]) for zone in mission.zones]
    inside = [z for z, misfit in zip(mission.zones, misfits, strict=True) if z.keep == "in" and not misfit]
    smallest = min(inside, key=_area, default=None)
    for zone, misfit in zip(mission.zones, misfits, strict=True):
        reason = misfit
        if not reason and one_inclusion and zone.keep == "in" and zone is not smallest:
            reason = "the autopilot asks for any one keep-in area, and a smaller one is written"
        if reason:
            left.append(OmittedZone(zone, reason))
        elif isinstance(zone.solid, Cylinder):
            circles.append(_circle(zone, zone.solid, geo))
        else:
            # Polygons of solids run counter-clockwise; those of the fence run clockwise.
            corners = geo.places(np.array([(x, y, 0.0) for x, y in reversed(zone.solid.points)]))
            polygons.append(FencePolygon(zone.keep == "in", tuple((c.lat, c.lon) for c in corners)))
    return Fence(tuple(polygons), tuple(circles), tuple(left))


def _misfit(zone: Zone, xy: Array) -> str:
    distance = footprint_distances(zone.solid, xy)
    if zone.keep == "in":
        return "" if float(distance.max()) == 0.0 else "the flight's ground track leaves it"
    if float(distance.min()) < MARGIN_M:
        return "the plan passes over or under it, and a fence has no height"
    return ""


def _area(zone: Zone) -> float:
    if isinstance(zone.solid, Cylinder):
        return float(np.pi * zone.solid.radius**2)
    return signed_area(zone.solid.points)


def _circle(zone: Zone, solid: Cylinder, geo: Geo) -> FenceCircle:
    centre = geo.place((solid.centre[0], solid.centre[1], 0.0))
    return FenceCircle(zone.keep == "in", (centre.lat, centre.lon), round(solid.radius, METRE_DECIMALS))
