"""All that numbers tell of a show before it is planned."""

from __future__ import annotations

from collections.abc import Iterator

from shotc.diag.model import Diagnostic
from shotc.ir.mission import MissionIR
from shotc.passes.resolve.checks.show.clock import check_clock
from shotc.passes.resolve.checks.show.pads import check_pads
from shotc.passes.resolve.checks.show.pictures import check_pictures
from shotc.passes.resolve.checks.show.pyro import check_pyro
from shotc.spec.mission import MissionSpec


def check_show(mission: MissionIR, spec: MissionSpec, *, order: bool) -> list[Diagnostic]:
    """Return what is wrong with pads, pictures and times.

    order : whether to judge the times; they need displays whose names and waits all stand
    """
    fleets = {fleet.name: fleet for fleet in mission.fleets}
    faults = [*_idle(mission, spec), *check_pads(mission)]
    for display in mission.displays:
        if display.fleet in fleets:
            faults += check_pictures(mission, display, fleets[display.fleet])
    if order:
        faults += [*check_clock(mission), *check_pyro(mission)]
    return faults


def _idle(mission: MissionIR, spec: MissionSpec) -> Iterator[Diagnostic]:
    """Yield the fleets that no display names."""
    used = {getattr(shot, "fleet", None) for shot in spec.shots} - {None}
    if not used <= spec.fleets.keys():  # a name is unknown, which is told, and may be meant for any of them
        return
    for fleet in mission.fleets:
        if fleet.name not in used:
            label = mission.origins.key(fleet.path)
            message = f"fleet `{fleet.name}` shows nothing"
            note = "it stays on its pads, and others keep clear of it"
            help_ = "remove it, or name it as the `fleet` of a display"
            yield Diagnostic("D023", message, (label,), (note,), help_)
