"""The terrain that a mission names, read around the places of the mission."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from importlib.util import find_spec
from math import ceil, sqrt
from typing import TYPE_CHECKING, Any

from shotc.diag.model import Diagnostic
from shotc.ir.limits import Vec2, Vec3
from shotc.kinds.base import Place, bad_file
from shotc.kinds.files import FileFault
from shotc.passes.resolve.lower.files import Files
from shotc.passes.resolve.lower.obstacles import not_judged
from shotc.passes.resolve.lower.world import zone_counts_from_ground
from shotc.spec.fields import Geodetic, OnMap
from shotc.spec.mission import MissionSpec
from shotc.spec.shot import ShotBase

if TYPE_CHECKING:
    from shotc.ir.terrain import Terrain

AROUND_M, FAR_M = 1_000.0, 10_000.0
FILE = ("world", "terrain", "file")


def read_terrain(
    spec: MissionSpec, put: Callable[[Place], Vec3], files: Files
) -> Terrain | Diagnostic | None:
    """Return the ground that a mission names, or its fault, or None where it names none.

    put : converts places on flat ground into W
    files : reader of files, and the origin
    """
    written = spec.world.terrain
    if written is None:
        return None
    data = files.read.large(written.file, FILE, linked=False)
    if isinstance(data, Diagnostic):
        return data
    if find_spec("numpy") is None:
        return not_judged("terrain", written.file, FILE, files)
    if written.datum == "home" and not spec.drones and not any(_pads(spec)):
        fault = FileFault(
            "its datum is the first drone's home, and no drone, grid or circle says where one is",
            help="write `datum: sea`, or lay the fleet out by a `grid` or a `circle`",
        )
        return bad_file(files.origins, FILE, written.file, fault)
    from shotc.passes.resolve.lower.relief import relief

    return relief(written, data, (map(put, _places(spec)), _beyond(spec)), files)


def _beyond(spec: MissionSpec) -> float:
    """Return how far around the places of a mission its terrain is read, metres.

    Where files and velocities determine places, it is the largest range of a mission.
    """
    tracks = [target.track for target in spec.targets.values() if target.track is not None]
    led = any(track.file is not None or track.velocity is not None for track in tracks)
    led = led or any(fleet.layout.file is not None for fleet in spec.fleets.values())
    led = led or any(hasattr(getattr(shot, "frames", None), "flight") for shot in spec.shots)
    return FAR_M if led or any(getattr(shot, "file", None) for shot in spec.shots) else AROUND_M


def _places(spec: MissionSpec) -> Iterator[Place]:
    """Yield the places written in a mission, homes and pads first, whatever their heights count from."""
    yield from (drone.home for drone in spec.drones.values())
    yield from _pads(spec)
    for target in spec.targets.values():
        track = target.track
        written: tuple[Any, ...] = (target.at,)
        if track is not None:
            written = (track.start, *(track.points or ()))
        yield from (place for place in written if place is not None)
    yield from _zones(spec)
    for shot in spec.shots:
        keyframes = getattr(shot, "keyframes", None) or ()
        spots = (
            getattr(shot, "at", None),
            *(getattr(shot, "points", None) or ()),
            *(k.at for k in keyframes),
        )
        yield from (spot for spot in spots if isinstance(spot, tuple | Geodetic))
        yield from _picture_places(shot)


def _pads(spec: MissionSpec) -> Iterator[Place]:
    """Yield the places by which fleets are laid out, and how far they reach from there."""
    for fleet in spec.fleets.values():
        grid, circle = fleet.layout.grid, fleet.layout.circle
        if grid is not None:
            yield from _about(grid.origin, ceil(sqrt(fleet.count)) * grid.spacing)
        elif circle is not None:
            yield from _about(circle.center, circle.radius)


def _about(place: Place, reach: float) -> Iterator[Place]:
    """Yield a place, and two corners of a square about it where it is in metres of W."""
    yield place
    if not isinstance(place, Geodetic):
        x, y, z = place
        yield from ((x + side * reach, y + side * reach, z) for side in (-1.0, 1.0))


def _picture_places(shot: ShotBase) -> Iterator[Place]:
    """Yield where the pictures of a display are, and its audience; frames are of the kind's own models."""
    if (viewpoint := getattr(shot, "viewpoint", None)) is not None:
        yield viewpoint
    frames = getattr(shot, "frames", ())
    for frame in frames if isinstance(frames, tuple) else (frames,):
        sources = (frame, *(getattr(frame, key, None) for key in type(frame).model_fields))
        for source in sources:
            center = getattr(source, "center", None)
            if isinstance(center, tuple | Geodetic):
                yield center


def _zones(spec: MissionSpec) -> Iterator[Place]:
    """Yield the centres and corners of the zones with heights above ground."""
    for zone in spec.world.zones.values():
        if not zone_counts_from_ground(zone):
            continue
        if zone.box is not None:
            yield zone.box.center
        elif zone.cylinder is not None:
            yield _on_plane(zone.cylinder.center)
        elif zone.polygon is not None:
            yield from map(_on_plane, zone.polygon.points)


def _on_plane(place: Vec2 | OnMap) -> Place:
    """Return a place of the map at z = 0."""
    return Geodetic(lat=place.lat, lon=place.lon, height=0.0) if isinstance(place, OnMap) else (*place, 0.0)
