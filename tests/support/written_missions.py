"""The mission as its author wrote it, and where its targets are: read from the YAML, by nothing of shotc.

Only what the missions of the tree use is understood; anything else fails loudly.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from math import pi
from pathlib import Path
from typing import Any

import numpy as np
import yaml

from shotc.geom.bernstein import Array

NUMBER = re.compile(r"^([-+.\deE]+) ?(|m|s|m/s|deg)$")
PLAIN = ("", "m", "s", "m/s")
KINDS = ("chase", "lead", "lateral", "flyby")
"""Kinds that name a place beside a moving target."""
AROUND = 1.0
"""Seconds before and after a moment, between which the way that a target goes is taken."""

SAFE_LOADER = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
"""Ten times as fast where PyYAML is built with libyaml."""

Written = dict[str, Any]


def number(value: Any, *, angle: bool = False) -> float:
    """Return a quantity in metres, seconds, metres a second, or, where it is one, an angle in radians."""
    found = NUMBER.match(str(value))
    assert found is not None, value
    assert (found[2] == "deg") if angle else (found[2] in PLAIN), value
    return float(found[1]) * (pi / 180 if angle else 1.0)


def read(path: Path) -> Written:
    """Read a mission without any sense of what it means."""
    return dict(yaml.load(path.read_text(encoding="utf-8"), SAFE_LOADER))


@dataclass(frozen=True)
class Course:
    """A target's centre over mission time: straight and even between rows, standing before and after."""

    times: Array
    points: Array

    @property
    def moves(self) -> bool:
        return len(self.times) > 1

    def at(self, t: Array) -> Array:
        """Return the centre at times (M,), shape (M, 3)."""
        return np.stack([np.interp(t, self.times, column) for column in self.points.T], axis=1)

    def ahead(self, t: Array) -> Array:
        """Return the level direction of its motion over the seconds around times (M,), shape (M, 2)."""
        way = (self.at(t + AROUND) - self.at(t - AROUND))[:, :2]
        length = np.linalg.norm(way, axis=1, keepdims=True)
        assert length.min() > 0.1, "it stands, and no mission of the tree films that"
        return np.asarray(way / length)


def course(track: Written) -> Course:
    """Return the motion that a track asks for, with points at one speed or at given times."""
    assert set(track) in ({"points", "speed"}, {"points", "times"}), track
    points = np.array([[number(c) for c in point] for point in track["points"]])
    if "times" in track:
        return Course(np.array([number(time) for time in track["times"]]), points)
    legs = np.sqrt((np.diff(points, axis=0) ** 2).sum(axis=1))
    return Course(np.concatenate([[0.0], np.cumsum(legs / number(track["speed"]))]), points)


def place(shot: Written, target: Course, t: Array, share: Array) -> Array:
    """Return where a shot of a moving target has its camera, if nothing stands against it, shape (M, 3).

    share : how much of the shot is over at times t, 0 to 1
    """
    zero = np.zeros_like(t)
    if shot["kind"] in ("chase", "lead"):
        along = zero + number(shot["distance"]) * (-1 if shot["kind"] == "chase" else 1)
        left = zero
    elif shot["kind"] == "lateral":
        along = zero
        left = zero + number(shot["distance"]) * {"left": 1, "right": -1}[shot["side"]]
    else:
        assert shot["kind"] == "flyby", shot["kind"]
        behind, ahead = number(shot["behind"]), number(shot["ahead"])
        along = -behind + (behind + ahead) * share
        left = zero + number(shot.get("offset", 0))
    x, y = target.ahead(t).T
    level = target.at(t)[:, :2] + np.stack([along * x - left * y, along * y + left * x], axis=1)
    return np.column_stack([level, zero + number(shot["altitude"])])
