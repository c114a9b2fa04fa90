"""Lower bounds on flight time, which hold for any drone within its limits, and remedies with less wind."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from math import hypot, sqrt

from shotc.ir.drone import Drone
from shotc.ir.limits import Limits, Vec3
from shotc.ir.mission import Keyframe, MissionIR, Shot
from shotc.rounding import at_least, down

FASTEST_M_S = 100.0  # m/s, above which speed is not the cause


def least_travel(points: Sequence[Vec3], limits: Limits, *, rests: bool = True) -> float:
    """Return the least time along points joined by straight lines, seconds.

    Horizontal and vertical motion are bounded separately, each with its own speed and the full acceleration,
    and the slower one counts. In wind the mean velocity over a line is bounded by the ground speed in its
    direction, whatever the flown path.

    rests : whether the drone starts and ends at rest
    """
    chords = [tuple(b - a for a, b in zip(p, q, strict=True)) for p, q in pairwise(points)]
    across = sum(hypot(c[0], c[1]) for c in chords)
    up, down = sum(max(0.0, c[2]) for c in chords), sum(max(0.0, -c[2]) for c in chords)
    a = limits.acceleration if rests else None
    against = 0.0
    if limits.wind != (0.0, 0.0):
        against = sum(hypot(c[0], c[1]) / limits.speed_along(c[0], c[1]) for c in chords)
    return max(
        against,
        _least(across, limits.fastest, a),
        _least(up, limits.climb, a) if down == 0 else up / limits.climb + down / limits.descent,
        _least(down, limits.descent, a) if up == 0 else 0.0,
    )


def least_shot(keyframes: Sequence[Keyframe], limits: Limits) -> float:
    """Return the least duration of a shot, seconds: its holds, and travel between rests.

    The drone rests at both ends and at each hold.
    """
    total = sum(k.hold for k in keyframes)
    stretch: list[Vec3] = []
    for index, keyframe in enumerate(keyframes):
        stretch.append(keyframe.at)
        if index == len(keyframes) - 1 or keyframe.hold > 0:
            total += least_travel(stretch, limits)
            stretch = [keyframe.at]
    return total


def length(keyframes: Sequence[Keyframe]) -> float:
    """Return the length of the polyline through keyframes, metres."""
    return sum(hypot(*(b - a for a, b in zip(p.at, q.at, strict=True))) for p, q in pairwise(keyframes))


def _least(distance: float, speed: float, acceleration: float | None) -> float:
    """Return the least time over ``distance`` metres, from rest to rest where acceleration is given."""
    if acceleration is None:
        return distance / speed
    if distance * acceleration <= speed * speed:
        return 2 * sqrt(distance / acceleration)
    return distance / speed + speed / acceleration


def less_wind(mission: MissionIR, shot: Shot, drone: Drone, seconds: float) -> list[str]:
    """Return remedies with less wind and with more speed, for which a shot takes at most ``seconds``.

    Empty where the wind is at most half of the drone's speed, or where no speed is sufficient.
    """
    limits, wind, taken = drone.limits, mission.wind, mission.wind_taken
    if wind <= (limits.speed + taken) / 2:
        return []
    needed = _needed(shot, limits, seconds)
    if needed is None:
        return []
    faster = f"take a drone that flies more than {at_least(needed + taken, 1)} m/s"
    calm = down(limits.speed + taken - needed if taken else wind * _calmer(shot, limits, seconds), 1)
    return [f"wait for wind below {calm:.1f} m/s", faster] if calm > 0 else [faster]


def _calmer(shot: Shot, limits: Limits, seconds: float) -> float:
    """Return the largest share of the wind in which a shot may take ``seconds``, by bisection; 0 if none."""

    def takes(share: float) -> float:
        wind = (share * limits.wind[0], share * limits.wind[1])
        return least_shot(shot.keyframes, limits._replace(wind=wind))

    low, high = 0.0, 1.0
    while high - low > 1e-4:
        middle = (low + high) / 2
        low, high = (middle, high) if takes(middle) <= seconds else (low, middle)
    return low


def _needed(shot: Shot, limits: Limits, seconds: float) -> float | None:
    """Return the least horizontal speed with which a shot may take ``seconds``, m/s, by bisection, or
    None.
    """

    def takes(speed: float) -> float:
        return least_shot(shot.keyframes, limits._replace(speed=speed))

    low, high = limits.speed, FASTEST_M_S
    if takes(high) > seconds:
        return None
    while high - low > 1e-4:
        middle = (low + high) / 2
        low, high = (low, middle) if takes(middle) <= seconds else (middle, high)
    return high
