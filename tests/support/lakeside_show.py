"""The show over the lake, as the command has planned it: its mission and its files."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import pytest

from shotc.geom.bernstein import Array
from tests.support import show_files, written_missions
from tests.support.show_files import Flown, Rows

LAKE = Path(__file__).parents[2] / "specs" / "lakeside-show.yaml"
COLORS = [(255, 165, 0), (51, 153, 255), (0, 255, 0), (255, 0, 0), (255, 255, 255)]
POSITION = ("x_m", "y_m", "z_m")
LIGHT = ("red", "green", "blue")
DIGITS = 1e-5
"""What nine digits of some hundred metres leave."""


@dataclass(frozen=True)
class Show:
    """A show that the command has planned: its folder, with the mission beside its outputs."""

    folder: Path
    said: str

    @property
    def out(self) -> Path:
        return self.folder / "out"

    @cached_property
    def document(self) -> dict[str, Any]:
        return dict(json.loads(self.bytes("plan.json")))

    @cached_property
    def fleet(self) -> Flown:
        (fleet,) = show_files.flown(self.bytes("plan.json"))
        return fleet

    @cached_property
    def rows(self) -> Rows:
        return show_files.rows(self.bytes("trajectory.csv"))

    @cached_property
    def mission(self) -> dict[str, Any]:
        """The mission as its author wrote it."""
        return written_missions.read(self.folder / LAKE.name)

    def bytes(self, name: str) -> bytes:
        return (self.out / name).read_bytes()

    def claim(self, name: str) -> dict[str, Any]:
        (found,) = (claim for claim in self.document["certificate"] if claim["constraint"] == name)
        return dict(found)


def asked(show: Show) -> tuple[float, float]:
    of = show.mission["fleets"]["swarm"]["separation"]
    margin = written_missions.number(of["margin"])
    across, upright = (written_missions.number(of[name]) for name in ("horizontal", "vertical"))
    return across + margin, upright + margin


def held(show: Show) -> Iterator[tuple[dict[str, Any], Array, Array]]:
    """Every picture with the places and the lights while it is held, (n, rows, 3)."""
    t = show.rows["t_s"][0]
    shown = show.fleet.flight["shown"]
    pictures = show.mission["shots"][0]["frames"]
    assert [s["picture"] for s in shown] == list(range(len(pictures)))
    for picture, stands in zip(pictures, shown, strict=True):
        assert stands["end"] - stands["start"] == pytest.approx(picture["hold"], abs=1e-3)
        during = (t >= stands["start"]) & (t <= stands["end"])
        assert during.sum() >= 5 * picture["hold"] - 1
        yield picture, show.rows[POSITION][:, during], show.rows[LIGHT][:, during]
