"""Values of a generated path's parameters with which no obstacle is in its way."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

from shotc.ir.mission import Keyframe, MissionIR, Shot
from shotc.kinds.parameters import DISTANCES, as_counted, at_distance, distance_of, span
from shotc.planning.clearances import ROUNDING_M, clearances_of
from shotc.planning.framing.placing import place_shot

STEP_M = 1.0  # metres between candidate values
LARGEST_CHANGE_M = 40.0  # largest change of a value, metres
MOST_PAIRS = 1000  # pairs of places and obstacles, above which the search is too slow for a check

Moved = Callable[[Keyframe, float], Keyframe]


class ParameterChange(NamedTuple):
    """A parameter and the value to write."""

    key: str
    value: str

    def __str__(self) -> str:
        return f"`{self.key}: {self.value}`"


def clear_path(mission: MissionIR, shot: Shot) -> list[ParameterChange]:
    """Return the least changes of distance and of altitude, each by itself, that clear a path of everything.

    Empty for a kind without these parameters. A path is clear if all its keyframes are, and it has to show
    its target whole. A larger distance or altitude is preferred.
    """
    if shot.kind not in DISTANCES or shot.subject is None or not shot.keyframes:
        return []
    target = mission.target(shot.subject)
    centre = target.centre

    def at_shift(k: Keyframe, by: float) -> Keyframe:
        return at_distance(centre, k, distance_of(centre, k) + by)

    def above(k: Keyframe, by: float) -> Keyframe:
        return k._replace(at=(k.at[0], k.at[1], k.at[2] + by))

    def altitude(k: Keyframe) -> float:
        return k.at[2] - mission.base(shot.above or "origin", k.at[:2], target, 0.0)

    nearest = min(distance_of(centre, k) for k in shot.keyframes)
    ends = (shot.keyframes[0], shot.keyframes[-1])
    changes: list[ParameterChange] = []
    for key, move, least in (
        (DISTANCES[shot.kind], at_shift, STEP_M - nearest),
        ("altitude", above, -LARGEST_CHANGE_M),
    ):
        by = next(_free(mission, shot, move, least), None)
        if by is not None:
            now = [distance_of(centre, k) if move is at_shift else altitude(k) for k in ends]
            value = span(now[0] + by, now[1] + by)
            changes.append(
                ParameterChange(key, value if move is at_shift else as_counted(mission, shot, value))
            )
    return changes


def _free(mission: MissionIR, shot: Shot, move: Moved, least: float) -> Iterator[float]:
    """Yield the least increase, and the least decrease down to ``least``, that clear a path, metres."""
    drone = mission.drone(shot.drone)
    around = clearances_of(mission, drone)

    def blocked(k: Keyframe) -> bool:
        if k.at[2] < mission.lowest(k.at, drone.radius) - ROUNDING_M:
            return True
        met = next((i for i, o in enumerate(around) if o.lack(k.at) > ROUNDING_M), None)
        if met is not None:
            around.insert(0, around.pop(met))
        return met is not None

    # The keyframe that was blocked last comes first, as it is likely blocked again; repeated places of a ring
    # are checked once.
    order = list({tuple(round(c, 6) for c in k.at): k for k in shot.keyframes}.values())
    if len(order) * len(around) > MOST_PAIRS:
        return
    for sign in (1.0, -1.0):
        for step in range(1, int(LARGEST_CHANGE_M / STEP_M) + 1):
            by = sign * step * STEP_M
            if by < least:
                break
            met = next((i for i, k in enumerate(order) if blocked(move(k, by))), None)
            if met is not None:
                order.insert(0, order.pop(met))
                continue
            if _on_composition(mission, shot, [move(k, by) for k in order]):
                yield by
            break


def _on_composition(mission: MissionIR, shot: Shot, keyframes: Sequence[Keyframe]) -> bool:
    """Return whether the target is on its composition set at every keyframe."""
    return not place_shot(mission, shot._replace(keyframes=tuple(keyframes)))[1]
