"""Keyframes of shots on their own clock: their times, and the ideal between them. Plain Python.

The place of a keyframe moves with the target that it is relative to, during the whole shot. The ideal is a
weighted mean of these places. The weights are cubic Hermite polynomials over time that rest at holds. So the
ideal is smooth relative to the target between two keyframes beside it, smooth in W between two places of W,
and blends smoothly between the two cases.
"""

from bisect import bisect_right
from functools import lru_cache
from itertools import pairwise
from math import cos, dist, sin
from typing import NamedTuple

from shotc.geom.ease import parts_of
from shotc.geom.same import Same
from shotc.geom.vec import Vec3
from shotc.ir.drone import LensRange
from shotc.ir.mission import Beside, Ideal, Keyframe, MissionIR, Near, Shot

TIMING_ROUNDS = 5  # iterations of times and of the lengths that depend on them
SHORTEST_WAY_SHARE = (
    0.1  # share of the mean length between keyframes that a shorter one counts as (turns on the spot)
)
SAME_PLACE_M = 1e-3
NO_TIME_S = 1e-9  # seconds, for an interval without time
NEARLY_SHARE = 1.0 - 1e-6  # share of a rate, for rounding


class Weight(NamedTuple):
    """The weight of one keyframe's place in the ideal; number : its index."""

    number: int
    share: float


def is_keyed(shot: Shot) -> bool:
    """Return whether keyframes describe a shot on its own clock."""
    return shot.ideal is not None and shot.ideal.frame == "keyframes"


def place_of(mission: MissionIR, keyframe: Keyframe, t: float) -> Vec3:
    """Return a keyframe's position at a mission time, metres; one beside a target moves with it."""
    return keyframe.at if keyframe.beside is None else _beside(mission, keyframe.beside, t)


def near_at(mission: MissionIR, near: Near, t: float) -> Vec3:
    """Return the position that a framing's camera stays near at a mission time, metres."""
    return near.at if near.beside is None else _beside(mission, near.beside, t)


def _beside(mission: MissionIR, beside: Beside, t: float) -> Vec3:
    target = mission.target(beside.target)
    x, y, _ = target.at(t)
    a, b, up = beside.offset
    if beside.turns and target.track is not None:
        facing = target.track.heading(t)
        c, s = cos(facing), sin(facing)
        a, b = c * a - s * b, s * a + c * b
    place = (x + a, y + b)
    return (*place, mission.base(beside.above, place, target, t) + up)


def stays(a: Keyframe, b: Keyframe) -> bool:
    """Return whether the camera keeps its position, in W or relative to a target, up to the next keyframe."""
    if a.beside is None or b.beside is None:
        return a.beside is b.beside and dist(a.at, b.at) <= SAME_PLACE_M
    return a.beside == b.beside


def keeps_a_place(shot: Shot) -> bool:
    """Return whether keyframes keep a camera in one place for some time, other than by holds in W."""
    rests = any(k.hold > 0 and k.beside is not None for k in shot.keyframes)
    return rests or any(stays(a, b) for a, b in pairwise(shot.keyframes))


def carriers(shot: Shot) -> tuple[str, ...]:
    """Return the targets of a shot on its own clock: those of its relative places and those it films."""
    ideal = () if shot.ideal is None or shot.ideal.target is None else (shot.ideal.target,)
    beside = (k.beside.target for k in shot.keyframes if k.beside is not None)
    return tuple(dict.fromkeys([*ideal, *beside, *(s.target for s in shot.subjects)]))


def settled(mission: MissionIR, shot: Shot, start: float) -> Shot:
    """Return a shot with keyframes, resolved for its first frame at mission time ``start``, seconds.

    Its keyframes get their positions at their times. A keyframe without a time gets one in proportion to the
    length of the way, between its neighbours with times.
    """
    ideal, duration = shot.ideal, shot.timing.duration
    assert ideal is not None
    assert duration is not None
    arrive = _by_length(shot.keyframes, duration, [1.0] * (len(shot.keyframes) - 1))
    for _ in range(TIMING_ROUNDS):
        lengths = [
            _distance(mission, shot.keyframes, i, (start + arrive[i], start + arrive[i + 1]))
            for i in _gaps(shot)
        ]
        arrive = _by_length(shot.keyframes, duration, lengths)
    placed = tuple(
        k._replace(at=place_of(mission, k, start + t)) for k, t in zip(shot.keyframes, arrive, strict=True)
    )
    points = tuple((t / max(duration, NO_TIME_S), k.at) for t, k in zip(arrive, placed, strict=True))
    return shot._replace(keyframes=placed, ideal=ideal._replace(points=points))


def arrivals(shot: Shot) -> tuple[float, ...]:
    """Return when each keyframe is reached, seconds from the shot's start."""
    assert shot.ideal is not None
    return tuple(share * (shot.timing.duration or 0.0) for share, _ in shot.ideal.points)


def zoom_parts(shot: Shot, lens: LensRange | None) -> tuple[int | None, ...]:
    """Return the parts of ``geom.ease`` for a zoom from each keyframe to the next within the lens's rate.

    None where it is too slow for the time between; an unknown lens is never too slow.
    """
    arrive, parts = arrivals(shot), list[int | None]()
    for i, (a, b) in enumerate(pairwise(shot.keyframes)):
        change = abs(b.hfov - a.hfov)
        seconds = max(arrive[i + 1] - arrive[i] - a.hold, NO_TIME_S)
        free = lens is None or not lens.zooms or change == 0.0
        parts.append(1 if free or lens is None else parts_of(NEARLY_SHARE * lens.rate * seconds / change))
    return tuple(parts)


def way_at(mission: MissionIR, shot: Shot, start: float, t: float) -> Vec3:
    """Return the ideal position at a mission time, metres; before the first keyframe and after the last it
    keeps their places.

    start : mission time of the shot's first frame
    """
    x = y = z = 0.0
    for number, share in _weights(_bends(Same(mission), Same(shot), start), t - start):
        a, b, c = place_of(mission, shot.keyframes[number], t)
        x, y, z = x + share * a, y + share * b, z + share * c
    return (x, y, z)


class _Bends(NamedTuple):
    """The times at which each keyframe is reached and left, seconds, and the slope of the ideal there.

    slopes : weights of the places of the keyframe before, this one and the one after, 1/s
    """

    arrive: tuple[float, ...]
    leave: tuple[float, ...]
    slopes: tuple[Vec3, ...]


@lru_cache(maxsize=32)
def _bends(mission: Same[MissionIR], shot: Same[Shot], start: float) -> _Bends:
    keyframes, arrive = shot.it.keyframes, arrivals(shot.it)
    leave = tuple(t + k.hold for t, k in zip(arrive, keyframes, strict=True))
    speeds: list[tuple[float, float]] = []
    for i in _gaps(shot.it):
        # K001 and K003 refuse keyframes without time between them. Planning may still evaluate the ideal.
        seconds = max(arrive[i + 1] - leave[i], NO_TIME_S)
        distance = _distance(mission.it, keyframes, i, (start + leave[i], start + arrive[i + 1]))
        speeds.append((distance / seconds, seconds))
    rests = [k.hold > 0 for k in keyframes]
    rests[0] |= arrive[0] > 0
    slopes = tuple(_slope(speeds, i, rests=rests[i]) for i in range(len(keyframes)))
    return _Bends(arrive, leave, slopes)


def _slope(speeds: list[tuple[float, float]], i: int, *, rests: bool) -> Vec3:
    """Return the slope at a keyframe; speeds : speed, m/s, and duration, seconds, of every way.

    The mean velocity of the slower way has the larger weight, which limits overshoot (Fritsch and Butland,
    1984).
    """
    if rests:
        return (0.0, 0.0, 0.0)
    if i == 0:
        return (0.0, -1 / speeds[0][1], 1 / speeds[0][1])
    if i == len(speeds):
        return (-1 / speeds[-1][1], 1 / speeds[-1][1], 0.0)
    (before, came), (after, goes) = speeds[i - 1], speeds[i]
    share = after / (before + after) if before + after > 0 else 0.5
    first, second = share / came, (1 - share) / goes
    return (-first, first - second, second)


def _weights(bends: _Bends, t: float) -> tuple[Weight, ...]:
    """Return the weight of each keyframe at a time, seconds from the shot's start.

    The weights add up to 1.
    """
    i = bisect_right(bends.arrive, t) - 1
    if i < 0:
        return (Weight(0, 1.0),)
    if i == len(bends.arrive) - 1 or t <= bends.leave[i]:
        return (Weight(i, 1.0),)
    length = bends.arrive[i + 1] - bends.leave[i]
    x = (t - bends.leave[i]) / length
    weights = {i: (1 - x) ** 2 * (1 + 2 * x), i + 1: x * x * (3 - 2 * x)}
    for end, bend in ((i, x * (1 - x) ** 2), (i + 1, x * x * (x - 1))):
        for number, slope in enumerate(bends.slopes[end], end - 1):
            weights[number] = weights.get(number, 0.0) + bend * length * slope
    return tuple(Weight(number, share) for number, share in weights.items() if share != 0.0)


def _gaps(shot: Shot) -> range:
    return range(len(shot.keyframes) - 1)


def _distance(
    mission: MissionIR, keyframes: tuple[Keyframe, ...], i: int, times: tuple[float, float]
) -> float:
    """Return the distance from a keyframe to the next; relative to the target if both are beside the same
    one.

    times : mission times at which the first is left and the second is reached
    """
    a, b = keyframes[i], keyframes[i + 1]
    leave, reach = times
    if a.beside is not None and b.beside is not None and a.beside.target == b.beside.target:
        leave = reach
    return dist(place_of(mission, a, leave), place_of(mission, b, reach))


def _by_length(keyframes: tuple[Keyframe, ...], duration: float, distances: list[float]) -> tuple[float, ...]:
    """Return the times of all keyframes; between two known times they are in proportion to length."""
    last = len(keyframes) - 1
    known = {i: k.time for i, k in enumerate(keyframes) if k.time is not None}
    known.setdefault(0, 0.0)
    known.setdefault(last, duration - keyframes[last].hold)
    least = SHORTEST_WAY_SHARE * sum(distances) / len(distances) or 1.0
    times = [0.0] * len(keyframes)
    for i, j in pairwise(sorted(known)):
        lengths = [max(least, distance) for distance in distances[i:j]]
        free = known[j] - known[i] - sum(k.hold for k in keyframes[i:j])
        clock = known[i]
        for k, length in zip(range(i, j), lengths, strict=True):
            times[k] = clock
            clock += keyframes[k].hold + free * length / sum(lengths)
        times[j] = known[j]
    return tuple(times)


def in_order(shot: Shot) -> bool:
    """Return whether every keyframe is left before the next one is reached."""
    arrive = arrivals(shot)
    pairs = zip(shot.keyframes, pairwise(arrive), strict=False)
    return all(reach - leave - k.hold > NO_TIME_S for k, (leave, reach) in pairs)


KEYED = Ideal("keyframes", None, (), placed=True)
"""The ideal of a shot before its keyframes have times; its kind gives the ways between them."""
