"""Check whether a drone can fly a take in the take's own time, with a margin for its curves."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise
from math import degrees, dist, hypot, sqrt

from shotc.importers.cameras.takes import ImportedCamera
from shotc.importers.cameras.thin import unwound
from shotc.ir.limits import Limits
from shotc.spec.presets import ZOOM_RATE_RAD_S

PACE_SHARE = 0.75
"""Largest share of the available time that the fastest flight of a take may need."""


def too_fast(cameras: Sequence[ImportedCamera], limits: Limits) -> ImportedCamera | None:
    """Return the first camera from which a drone is late at the next one, None if it is always in time."""
    for camera, duration, least in (*_turns(unwound(cameras), limits), *_stretches(cameras, limits)):
        if least > PACE_SHARE * duration:
            return camera
    return None


def _turns(
    cameras: Sequence[ImportedCamera], limits: Limits
) -> Iterator[tuple[ImportedCamera, float, float]]:
    """Yield each camera with the time to the next one, and the least time for turn, way and zoom, seconds."""
    for a, b in pairwise(cameras):
        up = b.at[2] - a.at[2]
        across = dist(a.at[:2], b.at[:2]) / limits.speed
        upright = up / limits.climb if up > 0 else -up / limits.descent
        turn = abs(b.heading - a.heading) / degrees(limits.yaw_rate)
        zoom = abs((b.hfov or 0.0) - (a.hfov or 0.0)) / degrees(ZOOM_RATE_RAD_S)
        yield a, (b.time or 0.0) - (a.time or 0.0) - a.hold, max(across, upright, turn, zoom)


def _stretches(
    cameras: Sequence[ImportedCamera], limits: Limits
) -> Iterator[tuple[ImportedCamera, float, float]]:
    """Yield the first camera of each flight from rest to rest, its duration and least duration, s."""
    inner = [i for i in range(1, len(cameras) - 1) if cameras[i].hold > 0.0]
    for i, j in pairwise([0, *inner, len(cameras) - 1]):
        some = cameras[i : j + 1]
        steps = [[q - p for p, q in zip(a.at, b.at, strict=True)] for a, b in pairwise(some)]
        across = sum(hypot(x, y) for x, y, _ in steps)
        up, down = sum(max(z, 0.0) for _, _, z in steps), sum(max(-z, 0.0) for _, _, z in steps)
        ways = ((across, limits.speed), (up, limits.climb), (down, limits.descent))
        least = max(_least(length, speed, limits.acceleration) for length, speed in ways)
        yield some[0], (some[-1].time or 0.0) - (some[0].time or 0.0) - some[0].hold, least


def _least(length: float, speed: float, push: float) -> float:
    """Return the least duration from rest to rest, s. way : m; speed : m/s; push : m/s^2."""
    return length / speed + speed / push if length * push > speed * speed else 2.0 * sqrt(length / push)
