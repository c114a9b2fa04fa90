"""What a show flies, by its files alone: plan.json's splines evaluated anew, trajectory.csv drone by drone.

Nothing here is shared with what is tested: knots, distances and derivatives are the tests' own.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from scipy.interpolate import BSpline
from scipy.spatial.distance import pdist

from shotc.geom.bernstein import Array
from tests.support import csv_tables
from tests.support.csv_tables import Table

RATE = 50.0
"""Samples a second of the dense checks, at least."""


@dataclass(frozen=True)
class Flown:
    """One fleet of a plan file: its splines, and what the mission asks of them."""

    asked: dict[str, Any]
    flight: dict[str, Any]

    @cached_property
    def spline(self) -> BSpline:
        """The cubic B-splines of all drones; a value has shape (T, n, 3)."""
        breaks = np.array(self.flight["breaks"])
        first, last = breaks[1] - breaks[0], breaks[-1] - breaks[-2]
        knots = [
            *(breaks[0] - first * k for k in (3, 2, 1)),
            *breaks,
            *(breaks[-1] + last * k for k in (1, 2, 3)),
        ]
        coef = np.array(self.flight["coef"])
        assert coef.shape == (len(self.asked["pads"]), len(breaks) + 2, 3)
        return BSpline(np.array(knots), np.swapaxes(coef, 0, 1), 3)

    @property
    def end(self) -> float:
        return float(self.flight["breaks"][-1])

    @cached_property
    def times(self) -> Array:
        """Dense times from start to end."""
        return np.linspace(0, self.end, int(self.end * RATE) + 2)

    @cached_property
    def apart(self) -> Array:
        """How near the nearest two are at the dense times, by the larger share of what is asked, (T,)."""
        return nearest(self.spline(self.times), self.asked["apart"])

    def phase(self, name: str) -> tuple[float, float]:
        (found,) = (p for p in self.flight["phases"] if p["name"] == name)
        return found["start"], found["end"]


def flown(document: bytes) -> list[Flown]:
    """Return the fleets of a plan file."""
    plan = json.loads(document)
    asked = {fleet["name"]: fleet for fleet in plan["mission"]["fleets"]}
    assert [flight["fleet"] for flight in plan["fleets"]] == list(asked)
    return [Flown(asked[flight["fleet"]], flight) for flight in plan["fleets"]]


def nearest(places: Array, apart: dict[str, Any]) -> Array:
    """Return for places (T, n, 3) the least share of the separation that a pair keeps; 1 is just enough."""
    across, upright = (apart[axis] + apart["margin"] for axis in ("horizontal", "vertical"))
    scaled = places / [across, across, upright]
    if apart["shape"] == "ellipsoid":
        return np.array([pdist(row).min() for row in scaled])
    return np.array([np.maximum(pdist(row[:, :2]), pdist(row[:, 2:])).min() for row in scaled])


def beyond_limits(fleet: Flown) -> dict[str, float]:
    """Return the largest rates at dense times as shares of the fleet's limits."""
    limits = fleet.asked["limits"]
    rate, second, third = (fleet.spline.derivative(k)(fleet.times) for k in (1, 2, 3))
    return {
        "speed": np.linalg.norm(rate[..., :2], axis=2).max() / limits["speed"],
        "climb": rate[..., 2].max() / limits["climb"],
        "descent": -rate[..., 2].min() / limits["descent"],
        "acceleration": np.linalg.norm(second, axis=2).max() / limits["acceleration"],
        "jerk": np.linalg.norm(third, axis=2).max() / limits["jerk"],
    }


@dataclass(frozen=True)
class Rows:
    """trajectory.csv of one fleet as arrays, drones first."""

    table: Table

    @cached_property
    def names(self) -> list[str]:
        return list(dict.fromkeys(self.table["drone"].tolist()))

    def __getitem__(self, names: str | tuple[str, ...]) -> Array:
        """Return a column as (n, T), or several as (n, T, k)."""
        if isinstance(names, str):
            return np.asarray(self.table[names].reshape(len(self.names), -1))
        return np.stack([self[name] for name in names], axis=2)


def rows(data: bytes) -> Rows:
    return Rows(csv_tables.read(data))
