"""Quantities and places as a mission's author writes them, in SI and radians."""

from __future__ import annotations

import re
from math import pi
from typing import Any

import numpy as np
import pymap3d

from tests.support.second_opinion.flight import Array

UNITS = {
    "": 1.0, "m": 1.0, "mm": 1e-3, "cm": 1e-2, "km": 1e3, "ft": 0.3048,
    "s": 1.0, "ms": 1e-3, "min": 60.0, "h": 3600.0,
    "m/s": 1.0, "km/h": 1 / 3.6, "mph": 0.44704, "kn": 1852 / 3600, "ft/s": 0.3048,
    "m/s^2": 1.0, "m/s^3": 1.0,
    "deg": pi / 180, "rad": 1.0, "deg/s": pi / 180, "rad/s": 1.0, "rpm": 2 * pi / 60,
    "deg/s^2": pi / 180, "rad/s^2": 1.0, "%": 0.01,
}  # fmt: skip
QUANTITY = re.compile(r"^\s*([-+]?[\d.]+(?:[eE][-+]?\d+)?)\s*(\S*)\s*$")


def number(value: Any) -> float:
    """Return a quantity: a number, or text with a unit."""
    found = QUANTITY.match(str(value))
    assert found is not None, value
    return float(found[1]) * UNITS[found[2]]


def place(value: Any, origin: dict[str, Any] | None) -> Array:
    """Return a position in metres East, North, Up of the origin; ``height`` is z.

    The plane z = 0 is level at the origin and the Earth is not: the place is where the vertical through the
    latitude and longitude meets the plane of that z.
    """
    if not isinstance(value, dict):
        return np.array([number(part) for part in value])
    assert origin is not None
    z, alt = number(value["height"]), number(origin.get("alt", 0.0))
    lat, lon = float(value["lat"]), float(value["lon"])
    h, e, n = alt + z, 0.0, 0.0
    for _ in range(8):
        e, n, u = pymap3d.geodetic2enu(lat, lon, h, float(origin["lat"]), float(origin["lon"]), alt)
        h += z - u
    return np.array([e, n, z])
