"""Checks of a show before it is planned, from numbers alone."""

from __future__ import annotations

from collections.abc import Iterator

from shotc.diag.model import Diagnostic
from shotc.ir.mission import MissionIR
from shotc.ir.show import Fleet, group_name
from shotc.passes.resolve.checks.show.clock import check_clock
from shotc.passes.resolve.checks.show.pads import check_pads
from shotc.passes.resolve.checks.show.pictures import check_pictures
from shotc.passes.resolve.checks.show.pyro import check_pyro
from shotc.spec.fleets import in_no_group
from shotc.spec.mission import MissionSpec

NAMED_GROUPS = 4  # groups of a fleet that a help lists


def check_show(mission: MissionIR, spec: MissionSpec, *, order: bool) -> list[Diagnostic]:
    """Return the faults of pads, pictures and times.

    order : whether to check the times; this needs displays with valid names and dependencies
    """
    fleets = {fleet.name: fleet for fleet in mission.fleets}
    faults = [*_idle(mission, spec), *_nobody_left(mission, spec), *check_pads(mission)]
    for display in mission.displays:
        if display.fleet in fleets:
            faults += check_pictures(mission, display, fleets[display.fleet])
    if order:
        faults += [*check_clock(mission), *check_pyro(mission)]
    return faults


def _idle(mission: MissionIR, spec: MissionSpec) -> Iterator[Diagnostic]:
    """Yield the fleets that no display names."""
    displays = [shot for shot in spec.shots if hasattr(shot, "fleet")]
    used = {group_name(shot.fleet, getattr(shot, "group", None)) for shot in displays}
    known = {group_name(name, group) for name, f in spec.fleets.items() for group in (None, *f.groups)}
    if not used <= known:  # an unknown name, which is reported, may stand for any of them
        return
    for fleet in mission.fleets:
        if fleet.name not in used:
            yield _shows_nothing(mission, fleet)


def _shows_nothing(mission: MissionIR, fleet: Fleet) -> Diagnostic:
    label, group = mission.origins.key(fleet.key), fleet.group
    message = f"{fleet.words} shows nothing"
    note = "it stays on its pads, and others keep clear of it"
    help_ = "remove it, or name it as the `fleet` of a display"
    if group is not None:
        note = "its drones stay on their pads, and others keep clear of them"
        help_ = f"remove it, or write `group: {group.name}` in a display"
    if group is not None and not group.name:
        some = f"{len(fleet.pads)} of {group.total} drones of {fleet.words}"
        message = f"{some} are in no group, and show nothing"
        note = "they stay on their pads, and others keep clear of them"
        help_ = f"put them into a group, or name `{fleet.name}` as the `fleet` of a display without a `group`"
    return Diagnostic("D023", message, (label,), (note,), help_)


def _nobody_left(mission: MissionIR, spec: MissionSpec) -> Iterator[Diagnostic]:
    """Yield displays of the drones that are in no group, in fleets where every drone is in a group."""
    for display in mission.displays:
        fleet = spec.fleets.get(display.fleet)
        if fleet is not None and not in_no_group(fleet):
            labels = (
                mission.origins.value((*display.path, "fleet")),
                mission.origins.key(("fleets", display.fleet, "groups"), "its groups"),
            )
            note = "a display without a `group` is drawn by the drones that are in none"
            some = " or ".join(f"`group: {name}`" for name in list(fleet.groups)[:NAMED_GROUPS])
            help_ = (
                f"write {some}; for a picture by all, give each group a display with its part of it, and all "
                "the same `start`"
            )
            message = f"every drone of fleet `{display.fleet}` is in a group, and `{display.id}` names none"
            yield Diagnostic("D136", message, labels, (note,), help_)
