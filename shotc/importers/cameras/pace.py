"""Check whether a drone can fly a take in the take's own time, with a margin for its curves."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise
from math import degrees, dist, hypot, sqrt
from typing import NamedTuple

from shotc.importers.cameras.takes import ImportedCamera
from shotc.importers.cameras.thin import unwound
from shotc.ir.limits import Limits
from shotc.spec.presets import ZOOM_RATE_RAD_S

PACE_SHARE = 0.75
"""Largest share of the available time that the fastest flight of a take may need."""


class _PartOfTake(NamedTuple):
    """A part of a take from a camera on: the time that the take gives it, and the least one, seconds."""

    camera: ImportedCamera
    given: float
    least: float


def too_fast(cameras: Sequence[ImportedCamera], limits: Limits) -> ImportedCamera | None:
    """Return the first camera from which a drone is late at the next one, None if it is always in time."""
    parts = (*_turns(unwound(cameras), limits), *_stretches(cameras, limits))
    return next((part.camera for part in parts if part.least > PACE_SHARE * part.given), None)


def _turns(cameras: Sequence[ImportedCamera], limits: Limits) -> Iterator[_PartOfTake]:
    """Yield the parts from each camera to the next one; the least time is that of turn, path and zoom."""
    for a, b in pairwise(cameras):
        up = b.at[2] - a.at[2]
        across = dist(a.at[:2], b.at[:2]) / limits.speed
        upright = up / limits.climb if up > 0 else -up / limits.descent
        turn = abs(b.heading - a.heading) / degrees(limits.yaw_rate)
        zoom = abs((b.hfov or 0.0) - (a.hfov or 0.0)) / degrees(ZOOM_RATE_RAD_S)
        given = (b.time or 0.0) - (a.time or 0.0) - a.hold
        yield _PartOfTake(a, given, max(across, upright, turn, zoom))


def _stretches(cameras: Sequence[ImportedCamera], limits: Limits) -> Iterator[_PartOfTake]:
    """Yield the parts from rest to rest."""
    inner = [i for i in range(1, len(cameras) - 1) if cameras[i].hold > 0.0]
    for i, j in pairwise([0, *inner, len(cameras) - 1]):
        some = cameras[i : j + 1]
        steps = [[q - p for p, q in zip(a.at, b.at, strict=True)] for a, b in pairwise(some)]
        across = sum(hypot(x, y) for x, y, _ in steps)
        up, down = sum(max(z, 0.0) for _, _, z in steps), sum(max(-z, 0.0) for _, _, z in steps)
        parts = ((across, limits.speed), (up, limits.climb), (down, limits.descent))
        least = max(_least(length, speed, limits.acceleration) for length, speed in parts)
        given = (some[-1].time or 0.0) - (some[0].time or 0.0) - some[0].hold
        yield _PartOfTake(some[0], given, least)


def _least(length: float, speed: float, push: float) -> float:
    """Return the least duration from rest to rest, s. length : m; speed : m/s; push : m/s^2."""
    return length / speed + speed / push if length * push > speed * speed else 2.0 * sqrt(length / push)
