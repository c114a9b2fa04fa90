"""Smoothing of recorded positions by local regression over time. Plain Python.

Every row moves onto the parabola that fits the rows around it by least squares, with Gaussian weights over
time (local regression of degree 2; Cleveland and Devlin, J. Am. Stat. Assoc. 83, 1988). A motion with
constant velocity or constant acceleration stays unchanged, also at its ends.
"""

from collections.abc import Sequence
from math import dist, exp

from shotc.geom.track import Track
from shotc.geom.vec import Vec3

REACH_DEVIATIONS = 3.0  # standard deviations within which rows count
SAME_SHARE = 1e-9  # tolerance of equal times, as a share of the standard deviation

_Weights = tuple[float, ...]


def smoothed(track: Track, deviation: float) -> Track:
    """Return a track with smoothed positions and headings; deviation : of the weights, seconds."""
    columns = [*zip(*track.points, strict=True), *([track.headings] if track.headings else [])]
    x, y, z, *facing = _filtered(track.times, columns, deviation)
    points = tuple(zip(x, y, z, strict=True))
    return track._replace(points=points, headings=tuple(facing[0]) if facing else ())


def farthest(before: Sequence[Vec3], after: Sequence[Vec3]) -> float:
    """Return the largest distance between positions before and after, metres."""
    return max((dist(p, q) for p, q in zip(before, after, strict=True)), default=0.0)


def _filtered(
    times: Sequence[float], columns: Sequence[Sequence[float]], deviation: float
) -> list[list[float]]:
    """Return columns of numbers at rising times, smoothed."""
    reach, first, end = REACH_DEVIATIONS * deviation, 0, 0
    out: list[list[float]] = [[] for _ in columns]
    known: dict[tuple[int, ...], _Weights] = {}
    for t in times:
        while times[first] < t - reach:
            first += 1
        while end < len(times) and times[end] <= t + reach:
            end += 1
        offsets = [(s - t) / deviation for s in times[first:end]]
        # Rows at a constant rate have the same weights.
        key = tuple(round(u / SAME_SHARE) for u in offsets)
        if key not in known:
            known[key] = _weights(offsets)
        for column, filtered in zip(columns, out, strict=True):
            filtered.append(sum(w * v for w, v in zip(known[key], column[first:end], strict=True)))
    return out


def _weights(offsets: Sequence[float]) -> _Weights:
    """Return the weight of each row in the value at offset 0; offsets in standard deviations, rising.

    The value of the parabola at 0 is e w V (V' w V)^-1, by Cramer's rule on its moments. With fewer than
    three rows it is the row at 0 itself.
    """
    if len(offsets) < 3:
        return tuple(1.0 if u == 0.0 else 0.0 for u in offsets)
    weights = [exp(-0.5 * u * u) for u in offsets]
    s0, s1, s2, s3, s4 = (sum(w * u**k for w, u in zip(weights, offsets, strict=True)) for k in range(5))
    a, b, c = s2 * s4 - s3 * s3, s2 * s3 - s1 * s4, s1 * s3 - s2 * s2
    whole = s0 * a + s1 * b + s2 * c
    return tuple(w * (a + b * u + c * u * u) / whole for w, u in zip(weights, offsets, strict=True))


def scatter(track: Track, deviation: float, start: float, end: float) -> list[tuple[float, Vec3]]:
    """Return the times of a track's rows between two times, and their offsets after smoothing, metres."""
    inside = [t for t in track.times if start <= t <= end]
    if not inside:
        return []
    reach = REACH_DEVIATIONS * deviation
    near = [i for i, t in enumerate(track.times) if inside[0] - reach <= t <= inside[-1] + reach]
    part = track._replace(
        times=tuple(track.times[i] for i in near), points=tuple(track.points[i] for i in near), headings=()
    )
    calm = smoothed(part, deviation)
    return [
        (t, (p[0] - q[0], p[1] - q[1], p[2] - q[2]))
        for t, p, q in zip(part.times, part.points, calm.points, strict=True)
        if start <= t <= end
    ]
