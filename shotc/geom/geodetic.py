"""WGS84 positions to points of W. Plain Python, so that `check` can use it without numpy."""

from __future__ import annotations

from collections.abc import Callable
from math import cos, radians, sin, sqrt

from shotc.geom.vec import Vec2, Vec3

SEMI_MAJOR_M = 6378137.0  # metres, WGS84
FLATTENING = 1 / 298.257223563
_E2 = FLATTENING * (2 - FLATTENING)


def to_world(place: Vec3, origin: Vec3) -> Vec3:
    """Return a place as a point of W: East, North, Up of the origin, metres.

    place, origin : (latitude, longitude, altitude) in degrees and metres. The transformation is exact, by the
    earth-centred frame (e.g. Hofmann-Wellenhof et al., GNSS, Sec. 8.2), without a flat-earth approximation.
    """
    d = [a - b for a, b in zip(_earth_centred(place), _earth_centred(origin), strict=True)]
    lat, lon = radians(origin[0]), radians(origin[1])
    outward = cos(lon) * d[0] + sin(lon) * d[1]
    return (
        cos(lon) * d[1] - sin(lon) * d[0],
        cos(lat) * d[2] - sin(lat) * outward,
        sin(lat) * d[2] + cos(lat) * outward,
    )


def above_ground(place: Vec3, origin: Vec3) -> Vec3:
    """Return a place with a height over the plane z = 0 as a point of W, whose z is that height.

    place : (latitude, longitude, height) in degrees and metres; origin : as in ``to_world``
    East and North are those of the point at that height on the vertical of the place, so the inverse gives
    the same latitude and longitude. The plane is the tangent at the origin. At distance d the sea is d^2 / 2R
    below it, so the altitude of the inverse exceeds the origin's plus the height by 7 mm at 300 m, 8 cm at 1
    km, and 8 m at 10 km. Use ``to_world`` for an elevation above sea level.
    """
    lat, lon, height = place
    _, _, z = to_world((lat, lon, origin[2] + height), origin)
    x, y, _ = to_world((lat, lon, origin[2] + 2 * height - z), origin)  # the vertical is almost along z
    return (x, y, height)


def onto_plane(origin: Vec3) -> Callable[[float, float], Vec2]:
    """Return a function from latitude, longitude, degrees, to x, y at z = 0, as ``above_ground``.

    It is for many places: the parts that depend only on the origin are computed once.
    """
    base = _earth_centred(origin)
    lat, lon = radians(origin[0]), radians(origin[1])
    east = (-sin(lon), cos(lon))  # level on every meridian
    north = (-sin(lat) * cos(lon), -sin(lat) * sin(lon), cos(lat))
    up = (cos(lat) * cos(lon), cos(lat) * sin(lon), sin(lat))
    height = origin[2]

    def put(latitude: float, longitude: float) -> Vec2:
        b, turn = radians(latitude), radians(longitude)
        s, c, cl, sl = sin(b), cos(b), cos(turn), sin(turn)
        normal = SEMI_MAJOR_M / sqrt(1 - _E2 * s * s)
        ring = (normal + height) * c
        dx, dy, dz = ring * cl - base[0], ring * sl - base[1], (normal * (1 - _E2) + height) * s - base[2]
        z = up[0] * dx + up[1] * dy + up[2] * dz
        dx, dy, dz = dx - z * c * cl, dy - z * c * sl, dz - z * s  # along the vertical of the place
        return (east[0] * dx + east[1] * dy, north[0] * dx + north[1] * dy + north[2] * dz)

    return put


def _earth_centred(place: Vec3) -> Vec3:
    lat, lon, alt = radians(place[0]), radians(place[1]), place[2]
    normal = SEMI_MAJOR_M / sqrt(1 - _E2 * sin(lat) ** 2)
    ring = (normal + alt) * cos(lat)
    return (ring * cos(lon), ring * sin(lon), (normal * (1 - _E2) + alt) * sin(lat))
