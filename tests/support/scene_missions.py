"""Missions beside a scene or buildings: their text, and the files that they name, generated."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np

from shotc.diag.model import Diagnostic
from shotc.ir.mission import MissionIR
from shotc.ir.obstacle_mesh import ObstacleMesh
from shotc.ir.passes import PassContext
from shotc.passes.resolve.lower import lowered
from tests.support.front_passes import EMITTERS, KINDS, loaded
from tests.support.meshes import box_mesh

LAT, LON = 46.68, 7.68
BEFORE_SHOT = """\
shotc: 1
mission: village
world:
  origin: {lat: 46.68, lon: 7.68, alt: 500}
  WORLD
targets:
  statue: {at: [60, 0], radius: 1, height: 4}
drones:
  cam: {model: x500, home: [0, -40]}
shots:
"""
LOOK = (
    "  - {id: look, kind: static, drone: cam, at: [40, -20, {above: ground, height: 6}], look_at: statue}\n"
)


def text(world: str) -> str:
    """Return a mission whose fifth line is a key of its world."""
    return (BEFORE_SHOT + LOOK).replace("WORLD", world)


def house() -> np.ndarray:
    """Return a house of 10 x 8 x 6 m about the origin, on the plane z = 0, as 12 triangles."""
    return box_mesh((0.0, 0.0, 3.0), (10.0, 8.0, 6.0))


def found(world: str, folder: Path) -> tuple[MissionIR, list[Diagnostic]]:
    """Lower a mission, and return it with what is wrong with its words and files."""
    mission, faults = loaded(text(world), folder)
    assert mission is not None, faults
    result = lowered(mission, KINDS, EMITTERS, PassContext().progress)
    return result.mission, list(result.faults)


def mesh(world: str, folder: Path) -> ObstacleMesh:
    """Return the one mesh of a mission about whose world nothing is said."""
    mission, faults = found(world, folder)
    assert not faults, faults
    (only,) = mission.meshes
    return only


def fault(world: str, folder: Path) -> Diagnostic:
    """Return the one thing that is wrong with a mission's world."""
    (only,) = found(world, folder)[1]
    return only


def corners(shape: ObstacleMesh) -> np.ndarray:
    """Return the lowest and the highest corner of a mesh, (2, 3)."""
    points = shape.surface.triangles.reshape(-1, 3)
    return np.array([points.min(axis=0), points.max(axis=0)])


def degrees(x: float, y: float) -> list[float]:
    """Return [longitude, latitude] of a place near the origin of W, to a millimetre within 300 m."""
    from shotc.geom.earth import of_world

    lat, lon, _ = of_world(np.array([[x, y, 0.0]]), (LAT, LON, 500.0))[0]
    return [float(lon), float(lat)]


def feature(ring: list[tuple[float, float]], id: str | None = None, **tags: Any) -> dict[str, Any]:
    """Return a polygon whose corners are places of W; the first is repeated, as GeoJSON has it."""
    closed = [degrees(x, y) for x, y in [*ring, ring[0]]]
    own = {} if id is None else {"id": id}
    return {
        "type": "Feature",
        **own,
        "properties": {key.replace("__", ":"): value for key, value in tags.items()},
        "geometry": {"type": "Polygon", "coordinates": [closed]},
    }


def square(x: float, y: float, side: float) -> list[tuple[float, float]]:
    """Return the corners of a square about a place, counter-clockwise."""
    h = side / 2
    return [(x - h, y - h), (x + h, y - h), (x + h, y + h), (x - h, y + h)]


def geojson(*features: dict[str, Any], **members: Any) -> bytes:
    """Return a collection of features."""
    return json.dumps({"type": "FeatureCollection", **members, "features": features}).encode()
