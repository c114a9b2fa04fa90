"""A mission to spoil, and what resolve finds of it."""

from __future__ import annotations

from pathlib import Path

from shotc.diag.model import Diagnostic
from tests.support.front_passes import placed

HEAD = """\
shotc: 1
mission: faults
world:
  zones:
    tree: {keep: out, cylinder: {center: [-30, 20], radius: 3, height: [0, 12]}}
    field: {keep: in, polygon: {points: [[-80, -80], [80, -80], [80, 80], [-80, 80]], height: [2, 60]}}
    house: {keep: out, box: {center: [30, 30, 4], size: [10, 8, 8]}}
targets:
  tower: {at: [0, 0, 12], radius: 4, height: 24}
drones:
  cam1: {model: x500, home: [0, -60, 0], radius: 0.6,
         limits: {speed: 8, climb: 4, descent: 3, acceleration: 3}}
shots:
"""
FIRST = HEAD.count("\n") + 1


def mission(*shots: str) -> str:
    return HEAD + "".join(f"  - {{drone: cam1, {s}}}\n" for s in shots)


def faults(text: str, folder: Path | None = None) -> list[Diagnostic]:
    return placed(text, folder)[1]


def only(text: str, folder: Path | None = None) -> Diagnostic:
    found = faults(text, folder)
    assert len(found) == 1, found
    return found[0]


def at(x: float, y: float, z: float) -> str:
    """A still camera that looks along the horizon, so that only its place can be at fault."""
    return f"id: a, kind: static, at: [{x}, {y}, {z}], heading: 0 deg, pitch: 0 deg"


def span(d: Diagnostic) -> tuple[int, int, int]:
    s = d.labels[0].span
    return (s.line, s.column, s.end_column)
