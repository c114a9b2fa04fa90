"""Missions compiled once a process: a plan is frozen, so all tests may look at the same one."""

from __future__ import annotations

from functools import cache, lru_cache
from pathlib import Path

from shotc.api import Compilation, PlanOptions, compile_source
from shotc.ir.source import Autopilot
from shotc.planning.timing.leg import timed_once


def compiled(path: Path, refiner: str | None = None, autopilot: Autopilot | None = None) -> Compilation:
    """Compile a file, named as one that stands in the current folder."""
    return _kept(path, refiner, autopilot)


def freshly_compiled(
    path: Path, refiner: str | None = None, autopilot: Autopilot | None = None
) -> Compilation:
    """Compile a file anew, no move at hand from before: for a test of two runs."""
    timed_once.cache_clear()
    return _compiled(path, refiner, autopilot)


def _compiled(path: Path, refiner: str | None, autopilot: Autopilot | None) -> Compilation:
    options = PlanOptions(refiner=refiner, autopilot=autopilot)
    return compile_source(path.read_bytes(), path.name, path.parent, options)


_kept = cache(_compiled)


@lru_cache(maxsize=64)
def compiled_text(text: str, refiner: str | None = None, name: str = "mission.yaml") -> Compilation:
    """Compile a text that names no files."""
    return compile_source(text.encode(), name, None, PlanOptions(refiner=refiner))
