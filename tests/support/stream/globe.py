"""From a vehicle's local frame back to the globe, as its autopilot does it; written apart from the sender."""

from __future__ import annotations

from math import asin, atan2, cos, degrees, hypot, radians, sin

from shotc.geom.geodetic import to_world


def px4_place(north, east, origin):
    """Undo PX4's projection as PX4 does (``MapProjection::reproject``)."""
    x, y = north / 6371000.0, east / 6371000.0
    c = hypot(x, y)
    if c == 0:
        return origin[0], origin[1]
    phi, lam = radians(origin[0]), radians(origin[1])
    lat = asin(cos(c) * sin(phi) + x * sin(c) * cos(phi) / c)
    return degrees(lat), degrees(lam + atan2(y * sin(c), c * cos(phi) * cos(c) - x * sin(phi) * sin(c)))


def ardupilot_place(north, east, origin):
    """Undo ArduPilot's layout by the cosine of the mean latitude."""
    lat = origin[0] + degrees(north / 6378100.0)
    return lat, origin[1] + degrees(east / 6378100.0 / cos(radians((lat + origin[0]) / 2)))


def in_world(local, origin, world, back, raised=0.0):
    """Return a local place, North, East, Down, in the plan's frame; origin : of the local frame."""
    lat, lon = back(local[0], local[1], origin)
    return to_world((lat, lon, origin[2] - local[2] - raised), tuple(world))
