"""QGC plans and text waypoints, read as their formats say: items, and where they lie in the world."""

from __future__ import annotations

import json
from dataclasses import dataclass
from math import nan
from typing import Any, NamedTuple

import numpy as np
import pymap3d

from tests.support.second_opinion.flight import Array
from tests.support.second_opinion.quantities import number

HEADER = "QGC WPL 110"
RELATIVE = 3  # MAV_FRAME with altitudes above home
WHOLE = {"fileType": "Plan", "version": 1}


class Item(NamedTuple):
    """One MAV_CMD with its seven parameters, NaN where there is none."""

    command: int
    frame: int
    params: tuple[float, ...]


@dataclass(frozen=True)
class MissionFile:
    """The items of one file; home : latitude, longitude, metres above the sea."""

    items: tuple[Item, ...]
    home: tuple[float, float, float]
    origin: dict[str, Any]

    def at_home(self) -> Array:
        """Return the place of home, metres East, North, Up of the mission's origin."""
        return self._local(self.home)

    def place(self, item: Item) -> Array:
        """Return the place of an item with a position."""
        lat, lon, alt = item.params[4:]
        return self._local((lat, lon, alt + (self.home[2] if item.frame == RELATIVE else 0.0)))

    def _local(self, geo: tuple[float, float, float]) -> Array:
        alt = number(self.origin.get("alt", 0.0))
        return np.array(pymap3d.geodetic2enu(*geo, float(self.origin["lat"]), float(self.origin["lon"]), alt))


def read(name: str, data: bytes, origin: dict[str, Any]) -> MissionFile:
    """Read a mission file by its ending."""
    return (_plan if name.endswith(".plan") else _waypoints)(data.decode(), origin)


def _plan(text: str, origin: dict[str, Any]) -> MissionFile:
    found = json.loads(text)
    assert {key: found[key] for key in WHOLE} == WHOLE
    assert found["mission"]["version"] == 2
    assert {"geoFence", "rallyPoints"} <= found.keys()
    items = [
        Item(item["command"], item["frame"], tuple(nan if p is None else float(p) for p in item["params"]))
        for item in found["mission"]["items"]
    ]
    lat, lon, alt = found["mission"]["plannedHomePosition"]
    return MissionFile(tuple(items), (lat, lon, alt), origin)


def _waypoints(text: str, origin: dict[str, Any]) -> MissionFile:
    header, *rows = text.splitlines()
    assert header == HEADER
    cells = [row.split("\t") for row in rows]
    assert [int(row[0]) for row in cells] == list(range(len(cells)))
    items = [Item(int(row[3]), int(row[2]), tuple(float(p) for p in row[4:11])) for row in cells]
    lat, lon, alt = items[0].params[4:]
    return MissionFile(tuple(items[1:]), (lat, lon, alt), origin)
