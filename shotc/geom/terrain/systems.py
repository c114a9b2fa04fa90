"""Coordinate systems: WGS84 degrees, UTM, and by pyproj any other with an EPSG code."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.geodetic import FLATTENING, SEMI_MAJOR_M
from shotc.geom.terrain.posts import TerrainFault

WGS84_EPSG = 4326
GEOGRAPHIC = frozenset({WGS84_EPSG, 4979})
"""EPSG codes of WGS84 latitudes and longitudes, without and with heights."""
UTM_NORTH, UTM_SOUTH = 32600, 32700
"""EPSG codes minus the zone, 1 to 60."""
_MERIDIAN_RATIO = 0.9996  # of the central meridian
_FALSE_EAST_M, _FALSE_NORTH_M = 500_000.0, 10_000_000.0  # metres; the second in the South
_N = FLATTENING / (2.0 - FLATTENING)
_E = float(np.sqrt(FLATTENING * (2.0 - FLATTENING)))
_RADIUS = SEMI_MAJOR_M / (1.0 + _N) * (1.0 + _N**2 / 4 + _N**4 / 64)  # metres, of the rectifying sphere


def _series(*rows: tuple[float, ...]) -> tuple[float, ...]:
    """Return the coefficients of the sines of 2x, 4x, ...: row j belongs to the powers n^j, n^(j + 1), ..."""
    return tuple(sum(c * _N ** (j + k) for k, c in enumerate(row)) for j, row in enumerate(rows, 1))


_ALPHA = _series(
    (1 / 2, -2 / 3, 5 / 16, 41 / 180),
    (13 / 48, -3 / 5, 557 / 1440),
    (61 / 240, -103 / 140),
    (49561 / 161280,),
)
_BETA = _series(
    (1 / 2, -2 / 3, 37 / 96, -1 / 360), (1 / 48, 1 / 15, -437 / 1440), (17 / 480, -37 / 840), (4397 / 161280,)
)
_DELTA = _series((2, -2 / 3, -2, 116 / 45), (7 / 3, -8 / 5, -227 / 45), (56 / 15, -136 / 35), (4279 / 630,))

Both = tuple[Array, Array]


class System(NamedTuple):
    """A coordinate system with its maps to and from WGS84.

    to_degrees : x, y of the system to latitudes and longitudes, degrees; arrays of the same shape
    of_degrees : latitudes and longitudes to x, y
    """

    name: str
    to_degrees: Callable[[Array, Array], Both]
    of_degrees: Callable[[Array, Array], Both]


def system_of(code: int) -> System | TerrainFault:
    """Return the system of an EPSG code, or the fault if there is none."""
    if code in GEOGRAPHIC:
        return System("WGS84", lambda x, y: (y, x), lambda lat, lon: (lon, lat))
    for base, north in ((UTM_NORTH, True), (UTM_SOUTH, False)):
        zone = code - base
        if 1 <= zone <= 60:
            return System(
                f"UTM zone {zone}{'N' if north else 'S'}",
                partial(degrees_of_utm, zone=zone, north=north),
                partial(utm_of_degrees, zone=zone, north=north),
            )
    return _by_pyproj(code)


def _by_pyproj(code: int) -> System | TerrainFault:
    try:
        import pyproj
    except ImportError:
        message = f"EPSG:{code} takes pyproj, which is not installed"
        return TerrainFault(
            "pyproj", message, None, "pip install 'shotc[geo]', or bring the file to WGS84 or UTM"
        )
    try:
        there: Any = pyproj.Transformer.from_crs(code, WGS84_EPSG, always_xy=True)
    except pyproj.exceptions.CRSError:
        return TerrainFault("system", f"EPSG has no system of coordinates with the number {code}")

    def to_degrees(x: Array, y: Array) -> Both:
        lon, lat = there.transform(x, y)
        return np.asarray(lat), np.asarray(lon)

    def of_degrees(lat: Array, lon: Array) -> Both:
        x, y = there.transform(lon, lat, direction="INVERSE")
        return np.asarray(x), np.asarray(y)

    return System(f"EPSG:{code}", to_degrees, of_degrees)


def utm_of_degrees(lat: Array, lon: Array, zone: int, north: bool) -> Both:
    """Return eastings and northings, metres (Krueger 1912, by Karney 2011, Eqs. 7 to 13, to n^4).

    lat, lon : degrees, of the same shape, which is that of both results
    The error is a few micrometres within a zone.
    """
    tau, away = np.tan(np.radians(lat)), np.radians(_turned(lon - _meridian(zone)))
    sigma = np.sinh(_E * np.arctanh(_E * tau / np.hypot(1.0, tau)))
    conformal = tau * np.hypot(1.0, sigma) - sigma * np.hypot(1.0, tau)
    xi = np.arctan2(conformal, np.cos(away))
    eta = np.arcsinh(np.sin(away) / np.hypot(conformal, np.cos(away)))
    xi, eta = _bent(xi, eta, _ALPHA, 1.0)
    return (
        _FALSE_EAST_M + _MERIDIAN_RATIO * _RADIUS * eta,
        (0.0 if north else _FALSE_NORTH_M) + _MERIDIAN_RATIO * _RADIUS * xi,
    )


def degrees_of_utm(x: Array, y: Array, zone: int, north: bool) -> Both:
    """Return latitudes and longitudes, degrees, of eastings and northings, metres, all of the same shape."""
    xi = (y - (0.0 if north else _FALSE_NORTH_M)) / (_MERIDIAN_RATIO * _RADIUS)
    eta = (x - _FALSE_EAST_M) / (_MERIDIAN_RATIO * _RADIUS)
    xi, eta = _bent(xi, eta, _BETA, -1.0)
    chi = np.arcsin(np.sin(xi) / np.cosh(eta))
    lat = chi + sum(c * np.sin(2 * j * chi) for j, c in enumerate(_DELTA, 1))
    return np.degrees(lat), _meridian(zone) + np.degrees(np.arctan2(np.sinh(eta), np.cos(xi)))


def _bent(xi: Array, eta: Array, series: tuple[float, ...], sign: float) -> Both:
    terms = [(2 * j, sign * c) for j, c in enumerate(series, 1)]
    return (
        xi + sum(c * np.sin(k * xi) * np.cosh(k * eta) for k, c in terms),
        eta + sum(c * np.cos(k * xi) * np.sinh(k * eta) for k, c in terms),
    )


def _meridian(zone: int) -> float:
    return 6.0 * zone - 183.0


def _turned(degrees: Array) -> Array:
    """Return the equivalent angles from -180 to 180."""
    return np.asarray((degrees + 180.0) % 360.0 - 180.0)
