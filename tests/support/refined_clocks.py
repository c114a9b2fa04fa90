"""All shots of a path on their own clock refined, one after another."""

from __future__ import annotations

from shotc_casadi.clock.refiner import refine_one

from shotc.plugin_api import Diagnostic, PathIR
from shotc.plugin_api.refiner import ClockLeg


def refine_clocks(path: PathIR, name: str) -> tuple[PathIR, tuple[Diagnostic, ...]]:
    """Return the path with its shots on their own clock refined, and the messages; name : of the refiner."""
    diagnostics: list[Diagnostic] = []
    for shot in [leg.shot for flown in path.timed for leg in flown.legs if isinstance(leg, ClockLeg)]:
        path, messages = refine_one(path, shot, name)
        diagnostics += messages
    return path, tuple(diagnostics)
