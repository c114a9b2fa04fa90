"""Moves of a keyframe out of an obstacle, to a place that is clear of everything and shows its target
whole.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import dist

from shotc.geom.vec import Vec3
from shotc.ir.mission import Keyframe, MissionIR, Shot
from shotc.planning.clearances import ROUNDING_M, Clearance, clearances_of, free_place, move, outward
from shotc.planning.framing.placing import place_shot

DISTANCE_STEP_RATIO = 1.1  # ratio of distances to the target between consecutive candidates
TRIES_PER_WAY = 40  # candidates in each direction
NEAREST_WAYS = 6  # directions out of an obstacle, the nearest ones


def move_out(mission: MissionIR, shot: Shot, keyframe: Keyframe, obstacle: Clearance) -> str:
    """Return the move to the nearest suitable place, in words; to a clear one where none shows the target.

    Candidates are the places just outside of the obstacle, and others behind them as seen from the target. A
    camera with given angles does not turn to its target, so its picture is not checked.
    """
    p, drone = keyframe.at, mission.drone(shot.drone)
    free = free_place(mission, drone, p, obstacle)
    looks = keyframe.target is not None and keyframe.aim is None
    if not looks or (free is not None and _on_composition(mission, shot, keyframe, free)):
        return "move it to a free place" if free is None else move(p, free)
    around = clearances_of(mission, drone)
    centre = mission.target(str(keyframe.target)).centre
    places: list[Vec3] = []
    for outside in sorted(obstacle.ways_out(p), key=lambda q: dist(p, q))[:NEAREST_WAYS]:
        for q in _farther(centre, outside):
            place = outward(p, q)
            low = mission.lowest(place, drone.radius)
            if place[2] < low - ROUNDING_M or any(o.lack(place) > ROUNDING_M for o in around):
                continue
            if _on_composition(mission, shot, keyframe, place):
                places.append(place)
                break
    if not places:
        return "move it to a free place" if free is None else move(p, free)
    best = min(places, key=lambda place: dist(p, place))
    return f"{move(p, best)}, from where `{keyframe.target}` fits into the frame"


def _farther(centre: Vec3, place: Vec3) -> Iterator[Vec3]:
    """Yield a place and others behind it as seen from a target, at its height and straight back."""
    for i in range(TRIES_PER_WAY):
        x, y, z = (c + (p - c) * DISTANCE_STEP_RATIO**i for c, p in zip(centre, place, strict=True))
        yield (x, y, place[2])
        yield (x, y, z)


def _on_composition(mission: MissionIR, shot: Shot, keyframe: Keyframe, at: Vec3) -> bool:
    """Return whether the target is on its composition set from a place."""
    return not place_shot(mission, shot._replace(keyframes=(keyframe._replace(at=at),)))[1]
