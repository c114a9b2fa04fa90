"""The drones of a show in the order of their numbers in files: fleet by fleet, with groups merged."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from heapq import merge
from operator import itemgetter
from typing import TypeVar

from shotc.ir.mission import MissionIR
from shotc.ir.show import fleet_name

Of = TypeVar("Of")


def by_number(mission: MissionIR, drones: Mapping[str, Iterable[Of]]) -> Iterator[tuple[int, Of]]:
    """Yield (number, item) for every drone that flies.

    The number counts from 1 in the whole fleet, after the drones of the fleets before.

    drones : items of each fleet or group, in the order of its drones; they are consumed lazily
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
