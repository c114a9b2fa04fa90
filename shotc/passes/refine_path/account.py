"""Report which shots of a plan are refined: in its statistics, and by a warning where no reason is given."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import Any, NamedTuple

from shotc.diag.model import Diagnostic
from shotc.ir.mission import MissionIR, Shot
from shotc.ir.path import HoldLeg, PathIR, filmed
from shotc.ir.trajectory import VerifiedIR
from shotc.passes.refine_path.seat import KeepPath, Seat
from shotc.passes.refine_path.settle import same
from shotc.passes.solver_reports import UNREFINED, unrefined

KEPT = "R003"
STANDS = "its camera stands still"
DONE = "yes"
"""The value of the statistic ``SHOT.refined`` of a refined shot; for another shot it is the reason."""


class Account(NamedTuple):
    """For every shot whether it is refined, as statistics; and a warning for each without a reason."""

    entries: tuple[tuple[str, float | str], ...] = ()
    warnings: tuple[Diagnostic, ...] = ()

    def noted_in(self, value: Any) -> Any:
        """Return a verified plan with these statistics, and any other value unchanged."""
        if not isinstance(value, VerifiedIR):
            return value
        flown = value.trajectory
        return replace(value, trajectory=replace(flown, stats=(*flown.stats, *self.entries)))


def account(seat: Seat, paths: tuple[PathIR, PathIR], diagnostics: Iterable[Diagnostic]) -> Account:
    """Return which shots of a plan are refined.

    A camera that stands still has nothing to refine, so it gets no warning. The refiner `none` is exempt.

    paths : the convex one and the one that is flown
    diagnostics : all diagnostics so far
    """
    if isinstance(seat.refiner, KeepPath):
        return Account()
    before, after = paths
    mission = before.keyframes.mission
    entries: list[tuple[str, float | str]] = []
    missing: list[Diagnostic] = []
    for shot in mission.shots:
        was, now = filmed(before, shot.id), filmed(after, shot.id)
        still = isinstance(was, HoldLeg)
        why = STANDS if still else DONE
        if not still and same(was, now):
            reason = _reason(mission, shot, diagnostics)
            why = reason or f"{seat.named} left it as it was"
            missing += [] if reason else [unrefined(before, shot.id, why)]
        entries.append((f"{shot.id}.refined", why))
    return Account(tuple(entries), tuple(missing))


def _reason(mission: MissionIR, shot: Shot, diagnostics: Iterable[Diagnostic]) -> str:
    """Return why a shot is not refined, from the diagnostics; empty if none says it."""
    find = mission.origins.key
    spans = {find(shot.path).span, find((*shot.path, "refine")).span}
    about = [d for d in diagnostics if d.code in {KEPT, UNREFINED} and any(m.span in spans for m in d.labels)]
    return about[0].message.partition(": " if about[0].code == UNREFINED else ", ")[2] if about else ""
