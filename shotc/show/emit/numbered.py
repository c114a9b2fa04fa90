"""The drones of a show in the order in which files number them: fleet by fleet, groups among each other."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from heapq import merge
from operator import itemgetter
from typing import TypeVar

from shotc.ir.mission import MissionIR
from shotc.ir.show import fleet_name

Of = TypeVar("Of")


def by_number(mission: MissionIR, drones: Mapping[str, Iterable[Of]]) -> Iterator[tuple[int, Of]]:
    """Yield (number, what) of every drone that flies: its number in the whole fleet, from 1, after those
    of the fleets before.

    drones : of each fleet, or group of one, in the order of its own drones; read no faster than needed
    """
    whole: dict[str, list[str]] = {}
    for name in drones:
        whole.setdefault(fleet_name(name), []).append(name)
    before = 0
    for names in whole.values():
        rows = (zip(mission.fleet(name).numbers, drones[name], strict=True) for name in names)
        for number, drone in merge(*rows, key=itemgetter(0)):
            yield before + number, drone
        first = mission.fleet(names[0])
        before += len(first.pads) if first.group is None else first.group.total
