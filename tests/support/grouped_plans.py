"""The show of ``show_plans`` whose drones are in groups: the same flights, in parts."""

from __future__ import annotations

from shotc.ir.mission import MissionIR
from shotc.ir.show import Fleet, FleetGroup, group_name
from tests.support.show_plans import PADS, display, fleet, mission

NUMBERS = {"": (1, 4), "middle": (2, 3)}
"""Drones of the fleet that are in no group, and those of one."""


def part(name: str, numbers: tuple[int, ...]) -> Fleet:
    pads = tuple(PADS[number - 1] for number in numbers)
    group = FleetGroup("swarm", name, numbers, len(PADS))
    return fleet(pads)._replace(name=group_name("swarm", name or None), group=group)


def grouped(**changes: object) -> MissionIR:
    """Return the mission with a display a group."""
    fleets = tuple(part(name, numbers) for name, numbers in NUMBERS.items())
    displays = tuple(display(f"globe{i or ''}", one.name, i) for i, one in enumerate(fleets))
    return mission(fleets=fleets, displays=displays, **changes)
