"""The pyrotechnic products of each drone in a fleet."""

from __future__ import annotations

from collections.abc import Sequence

from shotc.ir.show import Display, Fleet, PyroCue, rows_of


def carried(displays: Sequence[Display], fleet: Fleet) -> list[list[PyroCue]]:
    """Return the pyro cues of every drone of a fleet, in the order of ignition."""
    by_drone: list[list[PyroCue]] = [[] for _ in fleet.pads]
    cues = [cue for display in displays if display.fleet == fleet.name for cue in display.pyro]
    for cue in sorted(cues, key=lambda cue: cue.ignition):
        for row in rows_of(fleet, cue):
            by_drone[row].append(cue)
    return by_drone
