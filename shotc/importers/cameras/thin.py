"""Remove cameras whose picture hardly differs from the one interpolated between their neighbours.

A camera is removed if the camera interpolated linearly between its neighbours shows the corners and the
centre of its frame within ``PICTURE_ERROR_HALF_FRAMES`` of the original. The filmed objects are assumed at a
distance equal to the camera's height above ground, but at least ``NEAREST_M``.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import accumulate, pairwise
from math import cos, hypot, inf, radians, sin, tan
from typing import NamedTuple

from shotc.geom.vec import Vec3
from shotc.importers.cameras.takes import ImportedCamera

PICTURE_ERROR_HALF_FRAMES = 0.01
"""Largest error of the picture, half frames."""
NEAREST_M = 5.0
ASPECT = 16 / 9
"""Width over height of the frame."""
WIDEST_TURN_DEG = 120.0
"""Largest turn between remaining neighbours. The direction of a half turn would be ambiguous."""
MOST_CAMERAS_APART = 200
"""Most cameras from one that remains to the next. It bounds the run time for any file."""
CORNERS = ((0.0, 0.0), (-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0))


class _View(NamedTuple):
    """A camera for projections: its position, axes, and the tangents of its half fields of view."""

    at: Vec3
    right: Vec3
    up: Vec3
    forward: Vec3
    wide: float
    high: float


def thinned(
    cameras: Sequence[ImportedCamera], usual_hfov: float, *, on_clock: bool
) -> tuple[ImportedCamera, ...]:
    """Return the cameras that are needed, by the method of Ramer, Douglas and Peucker.

    The first, the last and every 200th camera remain, and those that rest or look at a place.

    on_clock : whether the picture must match at each camera's time, or only along the path
    """
    lens = [camera._replace(hfov=camera.hfov or usual_hfov) for camera in unwound(cameras)]
    parameters = _parameters(lens, on_clock=on_clock)
    needed = (i for i, camera in enumerate(lens) if camera.hold > 0 or camera.look_at)
    chosen = {*range(0, len(lens), MOST_CAMERAS_APART), len(lens) - 1, *needed}
    spans = list(pairwise(sorted(chosen)))
    while spans:
        first, last = spans.pop()
        worst, at = _worst(lens, parameters, first, last)
        if worst > PICTURE_ERROR_HALF_FRAMES:
            chosen.add(at)
            spans += [(first, at), (at, last)]
    return tuple(cameras[i] for i in sorted(chosen))


def unwound(cameras: Sequence[ImportedCamera]) -> list[ImportedCamera]:
    """Return the cameras with continuous headings, without jumps by whole turns."""
    out: list[ImportedCamera] = []
    for camera in cameras:
        turns = round((out[-1].heading - camera.heading) / 360.0) if out else 0
        out.append(camera._replace(heading=camera.heading + 360.0 * turns))
    return out


def picture_change(a: ImportedCamera, b: ImportedCamera) -> float:
    """Return the largest shift of the frame of ``a`` in the picture of ``b``, half frames.

    It is infinite if a corner is behind ``b``.
    """
    one, other = _view(a), _view(b)
    depth = max(NEAREST_M, a.at[2])
    worst = 0.0
    for u, v in CORNERS:
        offset = [
            p - q + depth * (f + u * one.wide * r + v * one.high * t)
            for p, q, f, r, t in zip(one.at, other.at, one.forward, one.right, one.up, strict=True)
        ]
        x, y, z = (sum(d * k for d, k in zip(offset, axis, strict=True)) for axis in other[1:4])
        if z <= 0.0:
            return inf
        worst = max(worst, hypot(x / z / other.wide - u, y / z / other.high - v))
    return worst


def _parameters(cameras: Sequence[ImportedCamera], *, on_clock: bool) -> list[float]:
    """Return the path parameter of each camera: its time, or the accumulated change of the picture."""
    if on_clock:
        return [camera.time or 0.0 for camera in cameras]
    steps = (min(picture_change(a, b), 1.0) for a, b in pairwise(cameras))
    return list(accumulate(steps, initial=0.0))


def _worst(
    cameras: Sequence[ImportedCamera], parameters: Sequence[float], first: int, last: int
) -> tuple[float, int]:
    """Return the largest error of the picture between two remaining cameras, and the camera that has it."""
    a, b = cameras[first], cameras[last]
    if last - first < 2:
        return 0.0, first
    if abs(b.heading - a.heading) > WIDEST_TURN_DEG:
        return inf, (first + last) // 2
    whole = parameters[last] - parameters[first]
    worst, at = 0.0, first
    for i in range(first + 1, last):
        share = (parameters[i] - parameters[first]) / whole if whole > 0 else 0.0
        off = picture_change(cameras[i], _between(a, b, share))
        if off > worst:
            worst, at = off, i
    return worst, at


def _between(a: ImportedCamera, b: ImportedCamera, share: float) -> ImportedCamera:
    def mixed(p: float, q: float) -> float:
        return p + share * (q - p)

    x, y, z = (mixed(p, q) for p, q in zip(a.at, b.at, strict=True))
    hfov = mixed(a.hfov or 0.0, b.hfov or 0.0)
    return a._replace(
        at=(x, y, z), heading=mixed(a.heading, b.heading), pitch=mixed(a.pitch, b.pitch), hfov=hfov
    )


def _view(camera: ImportedCamera) -> _View:
    h, p, wide = radians(camera.heading), radians(camera.pitch), tan(radians(camera.hfov or 0.0) / 2)
    forward = (sin(h) * cos(p), cos(h) * cos(p), sin(p))
    up = (-sin(h) * sin(p), -cos(h) * sin(p), cos(p))
    return _View(camera.at, (cos(h), -sin(h), 0.0), up, forward, wide, wide / ASPECT)
