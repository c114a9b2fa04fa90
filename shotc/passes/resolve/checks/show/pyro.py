"""Checks of pyro cues: drones that exist, and no drone that fires two at once."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations

from shotc.diag.model import Diagnostic
from shotc.ir.mission import MissionIR
from shotc.ir.show import Display, Fleet, spans
from shotc.rounding import at_least


def check_pyro(mission: MissionIR) -> list[Diagnostic]:
    """Return the faults of the pyro cues of a mission's displays."""
    fleets = {fleet.name: fleet for fleet in mission.fleets}
    return [
        fault
        for display in mission.displays
        if display.fleet in fleets
        for fault in (*_absent(mission, display, fleets[display.fleet]), *_twice(mission, display))
    ] + [fault for fleet in fleets for fault in _together(mission, fleet)]


def _absent(mission: MissionIR, display: Display, fleet: Fleet) -> Iterator[Diagnostic]:
    numbers = set(fleet.numbers)
    for cue in display.pyro:
        wrong = [(i, drone) for i, drone in enumerate(cue.drones) if drone not in numbers]
        if wrong:
            index, drone = wrong[0]
            labels = [mission.origins.value((*cue.path, "drones", index))]
            message = f"{fleet.words} has {len(numbers)} drones, and no drone {drone}"
            help_ = f"give numbers from 1 to {len(numbers)}"
            if fleet.group is not None:
                message = f"drone {drone} is not among the {len(numbers)} of {fleet.words}"
                labels.append(mission.origins.value(fleet.key, "its drones"))
                help_ = f"give their numbers in the fleet: {spans(fleet.numbers)}"
            yield Diagnostic("D132", message, tuple(labels), help=help_)


def _twice(mission: MissionIR, display: Display) -> Iterator[Diagnostic]:
    """Yield a cue in which one drone fires its product twice."""
    for cue in display.pyro:
        first = {drone: i for i, drone in reversed(list(enumerate(cue.drones)))}
        again = next((i for i, drone in enumerate(cue.drones) if first[drone] < i), None)
        if again is not None:
            drones, drone = (*cue.path, "drones"), cue.drones[again]
            labels = (
                mission.origins.value((*drones, again)),
                mission.origins.value((*drones, first[drone]), "here, too"),
            )
            message = f"drone {drone} fires two `{cue.product}` at once"
            yield Diagnostic("D133", message, labels, help="name every drone of the cue once")


def _together(mission: MissionIR, fleet: str) -> Iterator[Diagnostic]:
    """Yield two cues of any displays of a fleet where one drone fires one while the other burns."""
    cues = [cue for display in mission.displays if display.fleet == fleet for cue in display.pyro]
    for one, other in combinations(sorted(cues, key=lambda cue: cue.ignition), 2):
        both = sorted(set(one.drones) & set(other.drones))
        if both and other.ignition < one.end:
            labels = (
                mission.origins.key((*other.path, "at")),
                mission.origins.key((*one.path, "at"), "it burns still"),
            )
            message = f"drone {both[0]} fires `{other.product}` while its `{one.product}` burns"
            note = f"that burns until {one.end:.2f} s, and this is lit at {other.ignition:.2f} s"
            help_ = (
                f"write `at: {at_least(one.end + other.prefire)} s` or later, or fire it from another drone"
            )
            yield Diagnostic("D133", message, labels, (note,), help_)
