"""Which products each drone of a fleet carries."""

from __future__ import annotations

from collections.abc import Sequence

from shotc.ir.show import Display, PyroCue


def carried(displays: Sequence[Display], fleet: str, count: int) -> list[list[PyroCue]]:
    """Return the pyro cues of every drone of a fleet, in the order of their ignition."""
    found: list[list[PyroCue]] = [[] for _ in range(count)]
    cues = [cue for display in displays if display.fleet == fleet for cue in display.pyro]
    for cue in sorted(cues, key=lambda cue: cue.ignition):
        for number in cue.drones:
            found[number - 1].append(cue)
    return found
