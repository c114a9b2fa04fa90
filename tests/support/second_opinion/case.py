"""What is judged: the files of one plan and the mission that they are to fly."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from tests.support.second_opinion.flight import Array, Flight
from tests.support.second_opinion.mission import Mission


class Finding(NamedTuple):
    """One thing that is wrong: which rule, of whom, by how much, when."""

    rule: str
    subject: str
    found: float
    limit: float
    time: float | None = None


Findings = Iterator[Finding]


@dataclass(frozen=True)
class Case:
    """The files of a plan, by name, and its mission as the YAML says it."""

    mission: Mission
    files: Mapping[str, bytes]
    notes: tuple[str, ...] = ()

    @cached_property
    def plan(self) -> dict[str, Any]:
        return dict(json.loads(self.files["plan.json"]))

    @cached_property
    def flights(self) -> dict[str, Flight]:
        return {found["drone"]: Flight.read(found) for found in self.plan["drones"]}

    @cached_property
    def drones(self) -> dict[str, dict[str, Any]]:
        """All drones as they are resolved in plan.json, presets included, by name."""
        return {drone["name"]: drone for drone in self.plan["mission"]["drones"]}

    @property
    def end(self) -> float:
        """When the last drone has landed."""
        return max((flight.end for flight in self.flights.values()), default=0.0)

    @cached_property
    def motion(self) -> list[dict[str, str]]:
        return table(self.files["trajectory.csv"])

    @cached_property
    def framing(self) -> list[dict[str, str]]:
        return table(self.files["framing.csv"])

    def place(self, drone: str, t: Array) -> Array:
        """Return where a drone is at times (M,), shape (M, 3): on its pad before and after it flies."""
        if drone in self.flights:
            return self.flights[drone].at(t)[:, :3]
        return np.tile(np.array(self.drones[drone]["home"], dtype=float), (len(t), 1))


def table(data: bytes) -> list[dict[str, str]]:
    """Return the rows of a CSV file by column."""
    return list(csv.DictReader(io.StringIO(data.decode())))


def column(rows: list[dict[str, str]], name: str) -> Array:
    """Return a column as numbers, NaN where it is empty."""
    return np.array([float(row[name]) if row[name] else np.nan for row in rows])
