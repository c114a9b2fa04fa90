"""The check for geographic places that are too far from the origin to be intended."""

from math import hypot
from typing import NamedTuple

from shotc.geom.geodetic import to_world
from shotc.ir.mission import GeoOrigin

FARTHEST_M = 10_000.0  # metres; no camera drone flies so far, and z = 0 is 8 m above the curved sea there
NEAR_DEG = 0.05  # degrees; two such differences are at most 8 km, a fast test for files with many places


class Stray(NamedTuple):
    """The texts of a diagnostic for a place that is too far away, with its likely mistake."""

    message: str
    note: str
    help: str


def stray(origin: GeoOrigin, lat: float, lon: float) -> Stray | None:
    """Return the fault of a place, degrees, that is too far from the origin; else None."""
    if abs(lat - origin.lat_deg) < NEAR_DEG and abs(lon - origin.lon_deg) < NEAR_DEG:
        return None
    distance = _ground_distance((origin.lat_deg, origin.lon_deg), (lat, lon))
    if distance <= FARTHEST_M:
        return None
    return Stray(
        f"the place is {distance / 1000:.1f} km away from the world's origin",
        f"the origin is at {origin.lat_deg:g}, {origin.lon_deg:g}; the place is at {lat:g}, {lon:g} "
        f"(latitude, longitude), and no more than {FARTHEST_M / 1000:.0f} km apart can be flown",
        _remedy((origin.lat_deg, origin.lon_deg), (lat, lon)),
    )


def _remedy(origin: tuple[float, float], place: tuple[float, float]) -> str:
    lat, lon = place
    meant = {"swapped": (lon, lat), "longitude": (lat, -lon), "latitude": (-lat, lon)}
    near = [
        slip for slip, p in meant.items() if abs(p[0]) <= 90 and _ground_distance(origin, p) <= FARTHEST_M
    ]
    if "swapped" in near:
        return f"latitude and longitude look swapped; write `lat: {lon:g}, lon: {lat:g}`"
    if near:
        right = f"`lat: {meant[near[0]][0]:g}, lon: {meant[near[0]][1]:g}`"
        return f"the {near[0]} looks as if it had the wrong sign (west and south are negative); write {right}"
    if abs(origin[1]) <= 90 and _ground_distance((origin[1], origin[0]), place) <= FARTHEST_M:
        return "latitude and longitude of `world.origin` look swapped"
    return "correct the place, or move `world.origin` to where the mission is flown"


def _ground_distance(origin: tuple[float, float], place: tuple[float, float]) -> float:
    return hypot(*to_world((*place, 0.0), (*origin, 0.0)))
