"""The mission as its author wrote it, by the language guide alone."""

from __future__ import annotations

import csv
import io
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import yaml

from tests.support.second_opinion.buildings import building
from tests.support.second_opinion.flight import Array
from tests.support.second_opinion.quantities import number, place
from tests.support.second_opinion.solids import Cylinder, Prism, Solid
from tests.support.second_opinion.targets import Size, Target, group

SEPARATION, GROUND, BESIDE_TARGETS = 3.0, 2.0, 1.0  # metres, where the mission is silent

Read = Callable[[str], bytes]


@dataclass(frozen=True)
class Zone:
    """A zone, which keeps drones out or in."""

    name: str
    keeps_in: bool
    solid: Solid


@dataclass(frozen=True)
class Mission:
    """The YAML of a mission; read : gives the files that it names."""

    text: str
    read: Read

    @staticmethod
    def of(path: Path) -> Mission:
        return Mission(path.read_text(encoding="utf-8"), lambda name: (path.parent / name).read_bytes())

    @cached_property
    def written(self) -> dict[str, Any]:
        return dict(yaml.safe_load(self.text))

    @property
    def world(self) -> dict[str, Any]:
        return dict(self.written.get("world", {}))

    @property
    def rules(self) -> dict[str, Any]:
        return dict(self.written.get("rules", {}))

    @property
    def shots(self) -> list[dict[str, Any]]:
        return list(self.written["shots"])

    @property
    def origin(self) -> dict[str, Any] | None:
        return self.world.get("origin")

    @property
    def wind(self) -> float:
        """What a wind from any side takes off every drone's speed, m/s."""
        wind = self.world.get("wind", 0.0)
        if not isinstance(wind, dict):
            return number(wind)
        return 0.0 if "from" in wind else number(wind.get("speed", 0.0))

    @property
    def rate(self) -> float:
        return number(self.written.get("output", {}).get("rate", 50.0))

    def rule(self, name: str, silent: float) -> float:
        return number(self.rules.get(name, silent))

    @cached_property
    def targets(self) -> dict[str, Target]:
        found = self.written.get("targets", {})
        return {name: self._target(name, target) for name, target in found.items()}

    @cached_property
    def zones(self) -> tuple[Zone, ...]:
        return tuple(self._zone(name, zone) for name, zone in self.world.get("zones", {}).items())

    def at(self, value: Any) -> Array:
        return place(value, self.origin)

    def _target(self, name: str, target: dict[str, Any]) -> Target:
        if "parts" in target:
            return group(
                name, [self._target(part, self.written["targets"][part]) for part in target["parts"]]
            )
        if "building" in target:
            assert self.origin is not None
            data = self.read(self.world["buildings"]["file"])
            return building(name, str(target["building"]), data, self.origin)
        size = Size.written(target)
        if "at" in target:
            # The length of a box that stands lies along its heading, clockwise from North.
            facing = np.array([np.pi / 2 - number(target.get("heading", 0.0))])
            return Target(
                name, size, np.zeros(1), self._stands(target["at"], size)[None], np.zeros(3), facing
            )
        track = target["track"]
        if "velocity" in track:
            velocity = np.array([number(part) for part in track["velocity"]])
            return Target(name, size, np.zeros(1), self._stands(track["start"], size)[None], velocity)
        if "file" in track:
            times, points, facing = self._rows(track["file"])
            times = times + (number(track["begins"]) - times[0] if "begins" in track else 0.0)
            return Target(name, size, times, points, np.zeros(3), facing)
        points = np.array([self._stands(point, size) for point in track["points"]])
        if "times" in track:
            times = np.array([number(time) for time in track["times"]])
        else:
            legs = np.linalg.norm(np.diff(points, axis=0), axis=1)
            times = np.concatenate([[0.0], np.cumsum(legs) / number(track["speed"])])
        return Target(name, size, times, points, np.zeros(3))

    def _stands(self, at: Any, size: Size) -> Array:
        """Return a centre; what has no height stands on the ground, which is flat."""
        return self.at([*at, size.height / 2] if isinstance(at, list) and len(at) == 2 else at)

    def _rows(self, name: str) -> tuple[Array, Array, Array | None]:
        assert name.endswith(".csv"), name
        rows = list(csv.DictReader(io.StringIO(self.read(name).decode())))
        if "x" in rows[0]:
            points = [[float(row[part]) for part in "xyz"] for row in rows]
        else:
            points = [list(self.at({part: row[part] for part in ("lat", "lon", "height")})) for row in rows]
        # Headings are compass bearings; a camera's yaw, and ours, is counter-clockwise from East.
        unit = {"heading": 1.0, "heading_deg": np.pi / 180}
        facing = [np.pi / 2 - unit[key] * float(row[key]) for row in rows for key in unit if key in row]
        turned = np.unwrap(np.array(facing)) if facing else None
        return np.array([float(row["t"]) for row in rows]), np.array(points), turned

    def _zone(self, name: str, zone: dict[str, Any]) -> Zone:
        if "cylinder" in zone:
            shape = zone["cylinder"]
            bottom, top = (number(z) for z in shape["height"])
            solid: Solid = Cylinder(self._level(shape["center"]), number(shape["radius"]), bottom, top)
        elif "polygon" in zone:
            shape = zone["polygon"]
            bottom, top = (number(z) for z in shape["height"])
            solid = Prism(np.array([self._level(p) for p in shape["points"]]), bottom, top)
        else:
            solid = self._box(zone["box"])
        return Zone(name, zone["keep"] == "in", solid)

    def _level(self, point: Any) -> Array:
        """Return the East and North of a point that needs no height."""
        full = {"height": 0.0, **point} if isinstance(point, dict) else [*point, 0.0][:3]
        return self.at(full)[:2]

    def _box(self, box: dict[str, Any]) -> Prism:
        """Return a box; its sides along North turn with its heading, clockwise."""
        centre = self.at(box["center"])
        wide, deep, high = (number(side) for side in box["size"])
        turn = number(box.get("heading", 0.0))
        east = np.array([np.cos(turn), -np.sin(turn)]) * wide / 2
        north = np.array([np.sin(turn), np.cos(turn)]) * deep / 2
        corners = np.array([-east - north, east - north, east + north, -east + north])
        return Prism(centre[:2] + corners, centre[2] - high / 2, centre[2] + high / 2)
