"""The tracks of moving targets: files, velocities and points as rows of time and place."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import accumulate, pairwise
from math import dist, hypot, inf
from typing import NamedTuple

from shotc.diag.model import Diagnostic
from shotc.geom.smoothed import farthest, smoothed
from shotc.geom.track import Track
from shotc.geom.vec import Vec3
from shotc.ir.origin import KeyPath, OriginMap
from shotc.kinds.base import stands
from shotc.passes.resolve.lower.files import Files
from shotc.passes.resolve.lower.recordings import Recording, read_recording
from shotc.passes.resolve.lower.track_jumps import CheckedTrack, check_gap, check_jump, check_velocity
from shotc.passes.resolve.lower.world import Put
from shotc.spec.heights import STANDING, AboveGround
from shotc.spec.mission import MissionSpec
from shotc.spec.presets import TOP_SPEED_M_S
from shotc.spec.world import TargetSpec, TrackSpec

SAME_POINT_M = 1e-6  # metres within which two points are equal
MOST_WRITTEN_TIMES = 12  # most times that a remedy lists


class TargetTracks(NamedTuple):
    """The usable tracks, by target, and the faults of the others.

    level : targets whose tracks follow the ground: from files without heights, or with a lift above it
    """

    tracks: Mapping[str, Track]
    diagnostics: tuple[Diagnostic, ...]
    level: frozenset[str]


def read_tracks(spec: MissionSpec, put: Put, files: Files) -> TargetTracks:
    """Return the motion of every target that moves."""
    tracks: dict[str, Track] = {}
    faults: list[Diagnostic] = []
    level: set[str] = set()
    for name, target in spec.targets.items():
        if target.track is None:
            continue
        path: KeyPath = ("targets", name, "track")
        track = _track(target.track, _standing(target, put), files, path)
        if isinstance(track, Diagnostic):
            faults.append(track)
            continue
        course = CheckedTrack(name, path, track.track, target.top_speed or TOP_SPEED_M_S)
        if target.track.file is not None:
            course = course._replace(file=target.track.file, lines=track.lines)
        wrong = [fault for fault in _too_fast(target.track, course, files.origins) if fault is not None]
        faults += wrong
        if not wrong:
            tracks[name] = _finished(target, track, put)
            level |= {name} if track.level or isinstance(target.track.lift, AboveGround) else set()
            gap = check_gap(course, files.origins) if course.file else None
            faults += [] if gap is None else [gap]
    return TargetTracks(tracks, tuple(faults), frozenset(level))


def _standing(target: TargetSpec, put: Put) -> Put:
    """Return the function from places of a track to its centre in W; without a height it is above the
    ground.
    """
    assert target.track is not None
    lift = target.track.lift
    if isinstance(lift, AboveGround):
        over = lift.height
        return lambda place: _raised(put((*put(place)[:2], STANDING)), over)
    stood = target.tall / 2 if lift is None else lift
    return lambda place: _raised(put(place), stood if stands(place) else lift or 0.0)


def _raised(place: Vec3, by: float) -> Vec3:
    x, y, z = place
    return (x, y, z + by)


def _finished(target: TargetSpec, recording: Recording, put: Put) -> Track:
    """Return a track in its final form: a recorded one is smoothed and lifted."""
    spec, track = target.track, recording.track
    assert spec is not None
    if spec.file is None:
        return track
    if spec.smooth is not None:
        calm = smoothed(track, spec.smooth)
        track = calm._replace(smoothed=farthest(track.points, calm.points))
    centre = _standing(target, put)
    if recording.level:
        return track._replace(points=tuple(centre((x, y, STANDING)) for x, y, _ in track.points))
    return track._replace(points=tuple(centre(p) for p in track.points))


def _too_fast(spec: TrackSpec, course: CheckedTrack, origins: OriginMap) -> Iterator[Diagnostic | None]:
    if spec.velocity is not None:
        yield check_velocity(course, hypot(*spec.velocity), origins, "velocity")
    elif spec.speed is not None:
        yield check_velocity(course, spec.speed, origins, "speed")
    else:
        yield check_jump(course, origins)


def _track(spec: TrackSpec, put: Put, files: Files, path: KeyPath) -> Recording | Diagnostic:
    """Return a track; only one from a file has lines."""
    if spec.file is not None:
        recording = read_recording(spec.file, files, (*path, "file"))
        if isinstance(recording, Diagnostic) or spec.begins is None:
            return recording
        return recording._replace(track=recording.track.beginning(spec.begins))
    if spec.start is not None and spec.velocity is not None:
        return Recording(Track((0.0,), (put(spec.start),), after=spec.velocity), ())
    points = [put(point) for point in spec.points or ()]
    track = (
        _timed(points, spec.times, files.origins, path)
        if spec.times is not None
        else _steady(points, spec.speed or inf, files.origins, path)
    )
    return Recording(track, ()) if isinstance(track, Track) else track


def _steady(points: list[Vec3], speed: float, origins: OriginMap, path: KeyPath) -> Track | Diagnostic:
    """Return the motion along points at one speed; repeated points are dropped."""
    chosen = points[:1]
    chosen += [p for o, p in pairwise(points) if dist(o, p) > SAME_POINT_M]
    if len(chosen) < 2:
        label = origins.value((*path, "points"))
        return Diagnostic(
            "M001", "the track goes nowhere", (label,), help="give points apart, or `at` instead of `track`"
        )
    times = accumulate((dist(a, b) / speed for a, b in pairwise(chosen)), initial=0.0)
    return Track(tuple(times), tuple(chosen))


def _in_order(times: tuple[float, ...], i: int) -> str:
    """Return how to correct a time that is not later than the one before."""
    if i + 1 < len(times) and times[i + 1] > times[i - 1]:
        return f"set it to {(times[i - 1] + times[i + 1]) / 2:g} s, between its neighbours"
    ordered = sorted(times)
    if len(times) <= MOST_WRITTEN_TIMES and all(a < b for a, b in pairwise(ordered)):
        return f"write `times: [{', '.join(f'{t:g}' for t in ordered)}]`"
    return f"set it later than {times[i - 1]:g} s"


def _timed(
    points: list[Vec3], times: tuple[float, ...], origins: OriginMap, path: KeyPath
) -> Track | Diagnostic:
    if len(times) != len(points):
        label = origins.value((*path, "times"))
        note = f"there are {len(points)} points and {len(times)} times"
        return Diagnostic("M001", "a track has one time a point", (label,), (note,), "write one for each")
    for i, (before, after) in enumerate(pairwise(times)):
        if after <= before:
            label = origins.value((*path, "times", i + 1))
            note = f"{after:g} s comes after {before:g} s"
            help_ = _in_order(times, i + 1)
            return Diagnostic("M001", "the times of the track do not rise", (label,), (note,), help_)
    return Track(times, tuple(points), since=times[0])
