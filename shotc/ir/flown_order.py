"""The order in which shots are flown: as written, unless `start` or `after` says otherwise."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from shotc.ir.limits import Timing
from shotc.ir.mission import Shot


def flown_order(shots: Sequence[Shot]) -> tuple[Shot, ...]:
    """Return the shots in flown order; those of one drone are in the order in which it flies them.

    Shots of one drone with a `start` are sorted by it, within the positions of such shots. A shot comes after
    the one that it waits for. Everything else stays as written, also a cycle of waits, which resolve rejects.
    """
    left = _by_start(shots)
    waits = waits_for({shot.id: shot.timing for shot in shots})
    flown: list[Shot] = []
    past: set[str] = set()
    while left:
        ready = next((s for s in left if waits[s.id] is None or waits[s.id] in past), left[0])
        left.remove(ready)
        flown.append(ready)
        past.add(ready.id)
    return tuple(flown)


def waits_for(timings: Mapping[str, Timing]) -> dict[str, str | None]:
    """Return the id of the shot that each shot waits for, by id; None if it waits for no known shot."""
    return {id_: t.after if t.after in timings else None for id_, t in timings.items()}


def _by_start(shots: Sequence[Shot]) -> list[Shot]:
    slots = list(shots)
    for drone in dict.fromkeys(s.drone for s in shots):
        places = [i for i, s in enumerate(shots) if s.drone == drone and s.timing.start is not None]
        risen = sorted((shots[i] for i in places), key=lambda s: s.timing.start or 0.0)
        for place, shot in zip(places, risen, strict=True):
            slots[place] = shot
    return slots
