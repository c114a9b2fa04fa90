"""Tracks along which no target can have moved: jumps, and gaps without data."""

from collections.abc import Iterator
from itertools import pairwise
from math import dist
from typing import NamedTuple

from shotc.diag.model import Diagnostic, Label
from shotc.geom.track import Track
from shotc.geom.vec import Vec3
from shotc.ir.origin import KeyPath, OriginMap
from shotc.rounding import at_least

GAP_RATIO = 10.0  # gap over the usual time between rows; smart recorders skip up to that much
LEAST_GAP_S = 3.0  # seconds; over a shorter gap a straight line is a good estimate
SPEED_ROUNDING_SHARE = 1e-6  # relative tolerance of a speed
FASTEST_M_S = 1000.0  # m/s, largest speed that the language reads
STOOD_M = 0.1  # metres of motion in a gap, below which the target stood; recorders may pause


class CheckedTrack(NamedTuple):
    """A track with its metadata.

    name : of the target
    path : of its track in the mission
    top_speed : m/s
    file, lines : the file and the lines of its rows; empty where the mission contains the track
    """

    name: str
    path: KeyPath
    track: Track
    top_speed: float
    file: str = ""
    lines: tuple[int, ...] = ()


def check_jump(course: CheckedTrack, origins: OriginMap) -> Diagnostic | None:
    """Return the fault of the first two rows between which the target exceeds its top speed, or None."""
    track, top = course.track, course.top_speed * (1 + SPEED_ROUNDING_SHARE)
    jumps = [i for i, ((s, t), (p, q)) in enumerate(_stretches(track)) if dist(p, q) > top * (t - s)]
    if not jumps:
        return None
    i = jumps[0]
    distance, duration = dist(track.points[i], track.points[i + 1]), track.times[i + 1] - track.times[i]
    notes = [f"{_rows(course, i)}: {distance:.2f} m in {duration:.3g} s, at t = {track.times[i]:.10g} s"]
    if len(jumps) > 1:
        notes.append(f"it does so {len(jumps)} times")
    remedy = _remedy(course, i)
    fastest = max(dist(p, q) / (t - s) for (s, t), (p, q) in _stretches(track))
    labels, raised = _labels(course, origins, _place(course, i), fastest)
    return Diagnostic(
        "M021",
        f"target `{course.name}` jumps: {_speed(distance / duration)} is more than its top speed, "
        f"{_speed(course.top_speed)}",
        labels,
        tuple(notes),
        f"{remedy}, or {raised} if it is as fast as that",
    )


def check_velocity(
    course: CheckedTrack, speed: float, origins: OriginMap, *key: str | int
) -> Diagnostic | None:
    """Return the fault of a speed, written at ``key`` below the track, above the target's top speed,
    or None.
    """
    if speed <= course.top_speed * (1 + SPEED_ROUNDING_SHARE):
        return None
    labels, raised = _labels(course, origins, (*course.path, *key), speed)
    return Diagnostic(
        "M021",
        f"target `{course.name}` moves at {_speed(speed)}; its top speed is {_speed(course.top_speed)}",
        labels,
        ("a bare number is in m/s",),
        f"slow it down, or {raised} if it is as fast as that",
    )


def check_gap(course: CheckedTrack, origins: OriginMap) -> Diagnostic | None:
    """Return the warning of the longest gap of a recorded track in which its target moves, or None."""
    times, points = course.track.times, course.track.points
    spaces = [t - s for s, t in pairwise(times)]
    usual = sorted(spaces)[(len(spaces) - 1) // 2]
    least = max(LEAST_GAP_S, GAP_RATIO * usual)
    gaps = [i for i, s in enumerate(spaces) if s > least and dist(points[i], points[i + 1]) > STOOD_M]
    if not gaps:
        return None
    i = max(gaps, key=lambda k: spaces[k])
    distance = dist(points[i], points[i + 1])
    more = f"; it is the longest of {len(gaps)} gaps" if len(gaps) > 1 else ""
    return Diagnostic(
        "M022",
        f"the track of `{course.name}` has a gap of {spaces[i]:.1f} s",
        (origins.value((*course.path, "file")),),
        (
            f"{_rows(course, i)}: nothing from t = {times[i]:.10g} s to {times[i + 1]:.10g} s, "
            f"where rows are {usual:.3g} s apart as a rule{more}",
            f"a straight line of {distance:.1f} m is assumed across it",
        ),
        "give the rows in between, or film before or after the gap",
    )


def _rows(course: CheckedTrack, i: int) -> str:
    if course.file:
        return f"{course.file}, line {course.lines[i + 1]}, after line {course.lines[i]}"
    return f"point {i + 2}, after point {i + 1}"


def _place(course: CheckedTrack, i: int) -> KeyPath:
    return (*course.path, "file") if course.file else (*course.path, "times", i + 1)


def _remedy(course: CheckedTrack, i: int) -> str:
    """Return which row to correct: the one without which the target keeps its top speed."""
    times, points = course.track.times, course.track.points
    for k in (i + 1, i):
        if 0 < k < len(times) - 1:
            speed = dist(points[k - 1], points[k + 1]) / (times[k + 1] - times[k - 1])
            if speed <= course.top_speed:
                row = f"line {course.lines[k]}" if course.file else f"point {k + 1}"
                return f"correct or drop {row}: without it the target moves there at {_speed(speed)}"
    one, other = (course.lines[i], course.lines[i + 1]) if course.file else (i + 1, i + 2)
    return f"correct {'line' if course.file else 'point'} {one} or {other}, or the time between them"


def _stretches(track: Track) -> Iterator[tuple[tuple[float, float], tuple[Vec3, Vec3]]]:
    """Yield the times and places of each two consecutive rows of a track."""
    return zip(pairwise(track.times), pairwise(track.points), strict=True)


def _labels(
    course: CheckedTrack, origins: OriginMap, path: KeyPath, speed: float
) -> tuple[tuple[Label, ...], str]:
    """Return labels on a fault and on the top speed, where one is written, and the remedy for the latter."""
    written = (*course.path[:-1], "top_speed")
    key = f"`top_speed: {at_least(speed, 1)} m/s`" if speed < FASTEST_M_S else "a `top_speed`"
    if written in origins.values:
        return (
            origins.value(path),
            origins.value(written, "its top speed"),
        ), f"raise {key.removeprefix('a ')}"
    return (origins.value(path),), f"give it {key}"


def _speed(speed: float) -> str:
    return f"{speed:.1f} m/s" if speed < 1e6 else f"{speed:.1e} m/s"
