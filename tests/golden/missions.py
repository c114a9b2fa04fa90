"""The missions whose plans are recorded, and their plans as text."""

from __future__ import annotations

from pathlib import Path

from shotc.api import Compilation
from tests.golden.sample import sampled

HERE = Path(__file__).parent
SPECS = Path(__file__).parents[2] / "specs"
DRAWN = HERE / "drawn"
BESIDE_FILES = (
    "shapes/delivery-van",
    "village/church-tower",
    "identified/quay-identified",
    "terrain/jacksboro-ridge",
)
"""Missions in folders of their own, with what they need, that are planned in seconds."""


def missions() -> dict[str, Path]:
    """Return the files of all missions, by name: films, shows, and both at once."""
    specs = [*sorted(SPECS.glob("*.yaml")), *(SPECS / f"{name}.yaml" for name in BESIDE_FILES)]
    return {p.stem: p for p in specs} | {p.parent.name: p for p in sorted(DRAWN.glob("*/mission.yaml"))}


def recorded(name: str) -> Path:
    """Return where the plan of a mission is recorded."""
    return DRAWN / name / "plan.txt" if (DRAWN / name).is_dir() else HERE / "specs" / f"{name}.txt"


def as_text(done: Compilation) -> str:
    """Return a plan as text; AssertionError where there is none."""
    assert done.plan is not None, [(d.code, d.message) for d in done.diagnostics]
    return sampled(done.plan, done.diagnostics)
