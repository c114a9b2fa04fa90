"""Buildings of a GeoJSON file as targets, by the language guide alone: the bodies about them."""

from __future__ import annotations

import json
from typing import Any, NamedTuple

import numpy as np
import pymap3d
from scipy.spatial import ConvexHull

from tests.support.second_opinion.flight import Array
from tests.support.second_opinion.quantities import number
from tests.support.second_opinion.targets import Size, Target, group

LEVEL = 3.0  # metres
FILLED = 0.8  # of its box, by a footprint that is not cut


class Footprint(NamedTuple):
    """A building, or a part of one: corners (K, 2), metres of the world, and what the file says of it."""

    ring: Array
    tags: dict[str, Any]
    names: tuple[str, ...]

    @property
    def part(self) -> bool:
        return "building:part" in self.tags

    @property
    def extent(self) -> tuple[float, float] | None:
        """From where to where it reaches over flat ground, None where the file does not say it."""
        bottom = number(self.tags.get("min_height", 0.0))
        if "height" in self.tags:
            return bottom, number(self.tags["height"])
        if "building:levels" in self.tags:
            levels = float(self.tags["building:levels"]) + float(self.tags.get("roof:levels", 0.0))
            return bottom, LEVEL * levels
        return None


def building(name: str, wanted: str, data: bytes, origin: dict[str, Any]) -> Target:
    """Return the target ``name``, which is the one building that is called so."""
    every = [_footprint(feature, origin) for feature in json.loads(data)["features"]]
    (own,) = (f for f in every if wanted in f.names)
    parts = [] if own.part else [f for f in every if f.part and _inside(own.ring, f.ring.mean(axis=0))]
    bodies = [_body(name, f, own) for f in parts or [own]]
    return bodies[0] if len(bodies) == 1 else group(name, bodies)


def _footprint(feature: dict[str, Any], origin: dict[str, Any]) -> Footprint:
    lon, lat = np.array(feature["geometry"]["coordinates"][0][:-1], dtype=float)[:, :2].T
    alt = number(origin.get("alt", 0.0))
    # Straight down from the ellipsoid's surface at the origin's altitude: heights are none of a footprint's.
    east, north, _ = pymap3d.geodetic2enu(lat, lon, alt, float(origin["lat"]), float(origin["lon"]), alt)
    tags = feature["properties"]
    names = tuple(str(n) for n in (tags.get("name"), feature.get("id"), tags.get("@id")) if n is not None)
    return Footprint(np.column_stack([east, north]), tags, names)


def _inside(ring: Array, p: Array) -> bool:
    a, b = ring, np.roll(ring, -1, axis=0)
    over = (a[:, 1] > p[1]) != (b[:, 1] > p[1])
    with np.errstate(divide="ignore", invalid="ignore"):
        at = a[:, 0] + (p[1] - a[:, 1]) / (b[:, 1] - a[:, 1]) * (b[:, 0] - a[:, 0])
    return bool(np.count_nonzero(over & (p[0] < at)) % 2)


def _body(name: str, footprint: Footprint, whole: Footprint) -> Target:
    """Return the smaller one of the least box about a footprint and the cylinder about the box's middle."""
    extent = footprint.extent or whole.extent
    assert extent is not None
    hull = footprint.ring[ConvexHull(footprint.ring).vertices]
    sides = np.roll(hull, -1, axis=0) - hull
    boxes = [_box(hull, float(np.arctan2(dy, dx))) for dx, dy in sides]
    yaw, middle, half = min(boxes, key=lambda box: float(np.prod(box[2])))
    radius = float(np.linalg.norm(hull - middle, axis=1).max())
    height = extent[1] - extent[0]
    size = Size(float(np.hypot(*half)), height, (float(half[0]), float(half[1])))
    assert _area(footprint.ring) >= FILLED * 4 * np.prod(half), "it is cut into several boxes"
    if np.pi * radius**2 < 4 * np.prod(half):
        size = Size(radius, height)
    centre = np.array([[*middle, sum(extent) / 2]])
    return Target(name, size, np.zeros(1), centre, np.zeros(3), np.array([yaw]))


def _box(hull: Array, yaw: float) -> tuple[float, Array, Array]:
    """Return the box about points whose length lies along an angle: it, its middle and half its sides."""
    axes = np.array([[np.cos(yaw), np.sin(yaw)], [-np.sin(yaw), np.cos(yaw)]])
    along = hull @ axes.T
    low, high = along.min(axis=0), along.max(axis=0)
    return yaw, (low + high) / 2 @ axes, (high - low) / 2


def _area(ring: Array) -> float:
    x, y = ring.T
    return float(abs(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1))) / 2)
