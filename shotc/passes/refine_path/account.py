"""Which shots of a path are refined: in its statistics, and by a warning where nobody says why one is not."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from shotc.diag.model import Diagnostic
from shotc.ir.mission import MissionIR, Shot
from shotc.ir.path import PathIR
from shotc.passes.base import Outcome
from shotc.passes.refine_path.faults import UNREFINED, filmed, unrefined
from shotc.passes.refine_path.seat import KeepPath, Seat
from shotc.passes.refine_path.settle import same

KEPT = "R003"
STANDS = "its camera stands still"
CONVEX = "its convex path is flown, since the refined one is refused"
DONE = "yes"
"""The value of the statistic ``SHOT.refined`` of a shot that is; of another it says why not."""


def accounted(before: PathIR, seat: Seat, outcome: Outcome[PathIR]) -> Outcome[PathIR]:
    """Return a path that tells of every shot whether it is refined, with a warning for each that is not.

    A camera that stands still is no fault: there is nothing to refine. The refiner `none` owes nothing.
    """
    path, said = outcome.value, outcome.diagnostics
    if path is None or isinstance(seat.refiner, KeepPath):
        return outcome
    mission = before.keyframes.mission
    entries: list[tuple[str, float | str]] = []
    missing: list[Diagnostic] = []
    for shot in mission.shots:
        was, now = filmed(before, shot.id), filmed(path, shot.id)
        why = STANDS if was.curve is None else DONE
        if was.curve is not None and same(was, now):
            told = _reason(mission, shot, said)
            why = told or f"{seat.named} left it as it was"
            missing += [] if told else [unrefined(path, shot.id, why)]
        entries.append((f"{shot.id}.refined", why))
    return Outcome(replace(path, stats=(*path.stats, *entries)), (*said, *missing))


def left_convex(path: PathIR) -> PathIR:
    """Return a convex path that is flown since the refined one is refused, telling that of every shot."""
    shots = path.keyframes.mission.shots
    entries = ((f"{s.id}.refined", CONVEX if filmed(path, s.id).curve else STANDS) for s in shots)
    return replace(path, stats=(*path.stats, *entries))


def _reason(mission: MissionIR, shot: Shot, said: Iterable[Diagnostic]) -> str:
    """Return why a shot stays as it was, by what was said of it; empty where nobody says."""
    find = mission.origins.key
    spans = {find(shot.path).span, find((*shot.path, "refine")).span}
    about = [d for d in said if d.code in {KEPT, UNREFINED} and any(m.span in spans for m in d.labels)]
    return about[0].message.partition(": " if about[0].code == UNREFINED else ", ")[2] if about else ""
