"""The tracks of moving targets: files, velocities and points made rows of time and place."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from itertools import accumulate, pairwise
from math import dist, inf
from typing import NamedTuple

from shotc.diag.model import Diagnostic
from shotc.geom.camera import yaw_of
from shotc.geom.track import Track, Vec3, unwrapped
from shotc.ir.origin import KeyPath, OriginMap
from shotc.kinds.base import bad_file
from shotc.kinds.files import FileFault, Table, read_table
from shotc.passes.resolve.world import Put
from shotc.spec.mission import MissionSpec
from shotc.spec.targets import TrackSpec

LAYOUTS = (("t", "x", "y", "z"), ("t", "x", "y", "z", "heading"))
SAME = 1e-6  # metres within which two points are one

Read = Callable[[str, KeyPath], bytes | Diagnostic]


class Tracks(NamedTuple):
    """The tracks that can be used, by target, and what is wrong with the others."""

    tracks: Mapping[str, Track]
    diagnostics: tuple[Diagnostic, ...]


def read_tracks(spec: MissionSpec, put: Put, origins: OriginMap, read: Read) -> Tracks:
    """Return the motion of every target that moves."""
    found: dict[str, Track] = {}
    faults: list[Diagnostic] = []
    for name, target in spec.targets.items():
        if target.track is None:
            continue
        track = _track(target.track, put, origins, read, ("targets", name, "track"))
        if isinstance(track, Track):
            found[name] = track
        else:
            faults.append(track)
    return Tracks(found, tuple(faults))


def _track(spec: TrackSpec, put: Put, origins: OriginMap, read: Read, path: KeyPath) -> Track | Diagnostic:
    if spec.file is not None:
        return _from_file(spec.file, origins, read, (*path, "file"))
    if spec.start is not None and spec.velocity is not None:
        return Track((0.0,), (put(spec.start),), after=spec.velocity)
    points = [put(point) for point in spec.points or ()]
    if spec.times is not None:
        return _timed(points, spec.times, origins, path)
    return _steady(points, spec.speed or inf, origins, path)


def _steady(points: list[Vec3], speed: float, origins: OriginMap, path: KeyPath) -> Track | Diagnostic:
    """Return the motion along points at one speed; points that repeat the one before are dropped."""
    kept = points[:1]
    kept += [p for o, p in pairwise(points) if dist(o, p) > SAME]
    if len(kept) < 2:
        label = origins.value((*path, "points"))
        return Diagnostic(
            "M001", "the track goes nowhere", (label,), help="give points apart, or `at` instead of `track`"
        )
    times = accumulate((dist(a, b) / speed for a, b in pairwise(kept)), initial=0.0)
    return Track(tuple(times), tuple(kept))


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
            help_ = f"set it later than {before:g} s"
            return Diagnostic("M001", "the times of the track do not rise", (label,), (note,), help_)
    return Track(times, tuple(points), since=times[0])


def _from_file(file: str, origins: OriginMap, read: Read, path: KeyPath) -> Track | Diagnostic:
    data = read(file, path)
    if isinstance(data, Diagnostic):
        return data
    table = read_table(data, LAYOUTS)
    wrong = table if isinstance(table, FileFault) else _fault(table)
    if wrong is not None:
        return bad_file(origins, path, file, wrong)
    assert isinstance(table, Table)
    column = {name: [row[i] for row in table.rows] for i, name in enumerate(table.columns)}
    points = tuple(zip(column["x"], column["y"], column["z"], strict=True))
    times = tuple(column["t"])
    headings = unwrapped([yaw_of(h) for h in column["heading"]]) if "heading" in column else ()
    return Track(times, points, headings, since=times[0], until=times[-1])


def _fault(table: Table) -> FileFault | None:
    if len(table.rows) < 2:
        return FileFault("a track needs two rows or more", None, "or give the target a place with `at`")
    clock = table.columns.index("t")
    times = [row[clock] for row in table.rows]
    for before, after in pairwise(times):
        if after <= before:
            return FileFault(f"its times do not rise: {after:g} s comes after {before:g} s", None, "sort it")
    return None
