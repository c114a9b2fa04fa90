"""The ideal of a shot on its own clock, evaluated in W. Plain Python."""

from bisect import bisect_right
from math import cos, sin
from operator import itemgetter

from shotc.geom.track import between
from shotc.ir.ground import counted_from
from shotc.ir.keyed import way_at
from shotc.ir.limits import Vec3
from shotc.ir.mission import MissionIR, OffsetPoints, Shot

CATCH_UP_RATIO = 1.25
"""Factor on the speed of a moving place; with this speed a drone that is behind catches up in acceptable
time."""


def ideal_place(mission: MissionIR, shot: Shot, start: float, t: float) -> Vec3:
    """Return the ideal position at a mission time, metres; before and after the shot the end offsets are
    held.

    start : mission time of the shot's first frame
    """
    ideal, duration = shot.ideal, shot.timing.duration
    assert ideal is not None
    assert duration is not None
    if ideal.frame == "keyframes":
        return way_at(mission, shot, start, t)
    offset = offset_at(ideal.points, min(1.0, max(0.0, (t - start) / duration)))
    if ideal.target is None:
        return offset
    target = mission.target(ideal.target)
    x, y, z = target.at(t)
    if ideal.frame == "about":
        return (x + offset[0], y + offset[1], z + offset[2])
    east, north, up = offset
    if ideal.frame == "heading":
        facing = 0.0 if target.track is None else target.track.heading(t)
        c, s = cos(facing), sin(facing)
        east, north = c * east - s * north, s * east + c * north
    place = (x + east, y + north)
    return (*place, counted_from(ideal.above, mission.ground, place, z - target.height / 2) + up)


def offset_at(points: OffsetPoints, share: float) -> Vec3:
    """Return the offset at a share of a shot's time, linear between two points."""
    i = min(bisect_right(points, share, key=_share_of), len(points) - 1)
    (low, a), (high, b) = points[max(i - 1, 0)], points[i]
    return between(a, b, (share - low) / (high - low) if high > low else 0.0)


_share_of = itemgetter(0)
