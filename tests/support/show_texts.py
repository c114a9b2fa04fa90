"""A show to spoil, and what the front half of the compiler makes of it."""

from __future__ import annotations

from pathlib import Path

from shotc.diag.model import Diagnostic
from shotc.ir.mission import MissionIR
from tests.support.front_passes import resolved

FLEET = "swarm: {count: 60, layout: {grid: {spacing: 4, origin: [0, 0, 0]}}, separation: 2}"
SPHERE = "{sphere: {center: [0, 0, 40], radius: 15}, hold: 4}"


def show(*pictures: str, fleet: str = FLEET, head: str = "", display: str = "", more: str = "") -> str:
    """Return a mission of one display, ``head`` before its fleets and ``more`` after its display."""
    frames = "".join(f"      - {p}\n" for p in pictures or (SPHERE,))
    start = f"shotc: 1\nmission: show\n{head}fleets:\n  {fleet}\n"
    shot = f"shots:\n  - id: a\n    kind: display\n    fleet: swarm\n{display}    frames:\n{frames}"
    return start + shot + more


def resolve(text: str, folder: Path | None = None) -> MissionIR:
    """Resolve a show of which nothing is to be said."""
    mission, found = resolved(text, folder)
    assert not found, found
    assert mission is not None
    return mission


def faults(text: str, folder: Path | None = None) -> list[Diagnostic]:
    return resolved(text, folder)[1]


def only(text: str, folder: Path | None = None) -> Diagnostic:
    found = faults(text, folder)
    assert len(found) == 1, found
    return found[0]


def marked(d: Diagnostic, text: str, label: int = 0) -> str:
    """Return what a diagnostic's label underlines."""
    span = d.labels[label].span
    assert span.line == span.end_line
    return text.splitlines()[span.line - 1][span.column - 1 : span.end_column - 1]
