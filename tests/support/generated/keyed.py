"""Keyframes beside a subject that moves: places about it, in its own frame or along East and North."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from tests.support.generated.takes import Array, bearing

if TYPE_CHECKING:
    from tests.support.generated.moving import Chance, Draft

STEP_DEG = (15, 55)  # of azimuth from keyframe to keyframe
SLOWEST = 3.0  # seconds from keyframe to keyframe, at least


def keyframes(chance: Chance) -> Draft | None:
    """Two to four places about the subject; those between turn and recede evenly, as it sees them."""
    dice = chance.dice
    count = min(dice.whole(2, 4), 1 + int(chance.lasts // SLOWEST))
    turns = dice.chance(0.5)  # with its course, or not
    azimuth, turn = float(dice.whole(0, 359)), dice.sign()
    legs: list[tuple[float, float, float]] = []
    for _ in range(count):
        z = chance.height()
        distance = chance.distance(z)
        if distance is None:
            return None
        legs.append((azimuth, distance, z))
        azimuth += turn * dice.whole(*STEP_DEG)
    times = np.linspace(0.0, chance.lasts, count)
    places = _between(chance, np.array(legs), times, turns=turns)
    timed = dice.chance(0.4)
    rows = [_row(chance, leg, turns=turns) for leg in legs]
    if timed:
        rows = [row | {"time": round(float(t), 2)} for row, t in zip(rows, times, strict=True)]
    return {"target": chance.subject.name, "keyframes": rows}, places


def _row(chance: Chance, leg: tuple[float, float, float], *, turns: bool) -> dict[str, Any]:
    offset = [round(float(c), 2) for c in leg[1] * bearing(leg[0])[:2]]
    at = {"from": chance.subject.name, "offset": [*offset, leg[2]]} | ({"turn": "course"} if turns else {})
    return {"at": at, "look_at": chance.subject.name}


def _between(chance: Chance, legs: Array, times: Array, *, turns: bool) -> Array:
    """Return places at the shot's times, (n, 3), from legs (azimuth in degrees, distance, z) at times."""
    t = chance.times - chance.start
    azimuth, distance, z = (np.interp(t, times, column) for column in legs.T)
    about = distance[:, None] * np.array([bearing(a) for a in azimuth])
    if turns:
        return chance.carried(np.column_stack([about[:, :2], z]))
    return np.column_stack([(chance.subject.at(chance.times) + about)[:, :2], z])
