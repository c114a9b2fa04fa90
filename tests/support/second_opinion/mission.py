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

from tests.support.second_opinion.flight import Array
from tests.support.second_opinion.quantities import number, place
from tests.support.second_opinion.solids import Cylinder, Prism, Solid

SEPARATION, GROUND, BESIDE_TARGETS = 3.0, 2.0, 1.0  # metres, where the mission is silent

Read = Callable[[str], bytes]


@dataclass(frozen=True)
class Target:
    """An upright cylinder about its centre; ``velocity`` is that after the last row."""

    name: str
    radius: float
    height: float
    times: Array
    points: Array
    velocity: Array

    def at(self, t: Array) -> Array:
        """Return its centre at times (M,), shape (M, 3)."""
        rows = np.stack([np.interp(t, self.times, part) for part in self.points.T], axis=1)
        return np.asarray(rows + np.maximum(t - self.times[-1], 0.0)[:, None] * self.velocity)

    def solid(self, t: Array) -> Cylinder:
        """Return the cylinder at every one of some times."""
        at = self.at(t)
        return Cylinder(at[:, :2], self.radius, at[:, 2] - self.height / 2, at[:, 2] + self.height / 2)

    @property
    def moves(self) -> bool:
        return len(self.times) > 1 or bool(self.velocity.any())


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
        return number(self.world.get("wind", 0.0))

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
        size = number(target["radius"]), number(target["height"])
        if "at" in target:
            return Target(name, *size, np.zeros(1), self.at(target["at"])[None], np.zeros(3))
        track = target["track"]
        if "velocity" in track:
            velocity = np.array([number(part) for part in track["velocity"]])
            return Target(name, *size, np.zeros(1), self.at(track["start"])[None], velocity)
        if "file" in track:
            times, points = self._rows(track["file"])
            times = times + (number(track["begins"]) - times[0] if "begins" in track else 0.0)
            return Target(name, *size, times, points, np.zeros(3))
        points = np.array([self.at(point) for point in track["points"]])
        if "times" in track:
            times = np.array([number(time) for time in track["times"]])
        else:
            legs = np.linalg.norm(np.diff(points, axis=0), axis=1)
            times = np.concatenate([[0.0], np.cumsum(legs) / number(track["speed"])])
        return Target(name, *size, times, points, np.zeros(3))

    def _rows(self, name: str) -> tuple[Array, Array]:
        assert name.endswith(".csv"), name
        rows = list(csv.DictReader(io.StringIO(self.read(name).decode())))
        if "x" in rows[0]:
            points = [[float(row[part]) for part in "xyz"] for row in rows]
        else:
            points = [list(self.at({part: row[part] for part in ("lat", "lon", "height")})) for row in rows]
        return np.array([float(row["t"]) for row in rows]), np.array(points)

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
