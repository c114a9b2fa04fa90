"""The parameter of a generated path, and its value, with which no obstacle stands in the path."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

from shotc.ir.mission import Keyframe, MissionIR, Shot
from shotc.kinds.parameters import DISTANCES, at_distance, distance_of, span
from shotc.passes.place_keyframes import place_shot
from shotc.passes.resolve.obstacles import ROUNDING, obstacles_of

STEP = 0.5  # metres between the values that are tried
MOST = 60.0  # metres by which a value is changed at most

Moved = Callable[[Keyframe, float], Keyframe]


class Change(NamedTuple):
    """A parameter and what to write there."""

    key: str
    value: str

    def __str__(self) -> str:
        return f"`{self.key}: {self.value}`"


def clear_path(mission: MissionIR, shot: Shot) -> list[Change]:
    """Return the least changes of distance and of altitude, each by itself, that free a path of everything.

    None for a kind without these parameters. A path is as free as its keyframes are, and still shows its
    target whole; one farther away, or higher, is preferred.
    """
    if shot.kind not in DISTANCES or shot.subject is None or not shot.keyframes:
        return []
    centre = mission.target(shot.subject).centre

    def aside(k: Keyframe, by: float) -> Keyframe:
        return at_distance(centre, k, distance_of(centre, k) + by)

    def above(k: Keyframe, by: float) -> Keyframe:
        return k._replace(at=(k.at[0], k.at[1], k.at[2] + by))

    nearest = min(distance_of(centre, k) for k in shot.keyframes)
    ends = (shot.keyframes[0], shot.keyframes[-1])
    found: list[Change] = []
    for key, move, least in ((DISTANCES[shot.kind], aside, STEP - nearest), ("altitude", above, -MOST)):
        by = next(_free(mission, shot, move, least), None)
        if by is not None:
            now = [distance_of(centre, k) if move is aside else k.at[2] for k in ends]
            found.append(Change(key, span(now[0] + by, now[1] + by)))
    return found


def _free(mission: MissionIR, shot: Shot, move: Moved, least: float) -> Iterator[float]:
    """Yield the least change up, and the least one down to ``least``, that free a path, metres."""
    drone = mission.drone(shot.drone)
    around, floor = obstacles_of(mission, drone), mission.rules.ground_clearance + drone.radius

    def blocked(k: Keyframe) -> bool:
        return k.at[2] < floor - ROUNDING or any(o.lack(k.at) > ROUNDING for o in around)

    # Those that are blocked now are the first to be blocked after a small change.
    order = sorted(shot.keyframes, key=blocked, reverse=True)
    for sign in (1.0, -1.0):
        for step in range(1, int(MOST / STEP) + 1):
            by = sign * step * STEP
            if by < least:
                break
            if not any(blocked(move(k, by)) for k in order):
                if _shown(mission, shot, [move(k, by) for k in shot.keyframes]):
                    yield by
                break


def _shown(mission: MissionIR, shot: Shot, keyframes: Sequence[Keyframe]) -> bool:
    """Tell whether the target is on its composition set in every keyframe."""
    return not place_shot(mission, shot._replace(keyframes=tuple(keyframes)))[1]
