"""Write takes as a mission with shots of kind ``keyframes``, and every assumption as a comment."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from math import ceil, cos, degrees, dist, floor, radians, sin
from typing import NamedTuple

from shotc.geom.focal import focal_length
from shotc.importers.cameras.pace import too_fast
from shotc.importers.cameras.takes import ImportedCamera, ImportedTakes, ImportOptions, Take
from shotc.importers.cameras.thin import PICTURE_ERROR_HALF_FRAMES, thinned
from shotc.importers.notes import Notes
from shotc.importers.words import safe_name
from shotc.spec.presets import PRESETS

MODEL = "pro"
BEHIND_M = 10.0
"""Distance of the drone's home behind the first camera if the file gives no home, metres."""
SAME_M, SAME_DEG = 1e-3, 1e-3
"""Largest differences, metres and degrees, at which two cameras count as equal."""
SAME_LENS_DEG = 1e-3
"""Largest difference, degrees, at which two fields of view count as equal."""


class CameraMission(NamedTuple):
    """A mission as text, with its numbers of shots and keyframes, and the number of cameras in the file."""

    text: str
    shots: int
    keyframes: int
    cameras: int


def written(
    name: str, what: str, footage: ImportedTakes, options: ImportOptions, notes: Notes
) -> CameraMission | None:
    """Return a mission, None if no take has two cameras.

    name : name of the mission
    what : description of the source
    """
    takes = [take for take in map(_rested, footage.takes) if len(take.cameras) > 1]
    for take in footage.takes:
        if len(take.cameras) == 1 and len(footage.takes) > 1:
            notes.assume(take.cameras[0].node, "a take of one camera", "it is left out")
    if not takes:
        return None
    widest, narrowest = _lenses(takes)
    usual, lenses = takes[0].cameras[0].hfov or widest, widest - narrowest > SAME_LENS_DEG
    drawn = [
        take if options.every else take._replace(cameras=thinned(take.cameras, usual, on_clock=options.times))
        for take in takes
    ]
    counts = (sum(len(take.cameras) for take in takes), sum(len(take.cameras) for take in drawn))
    shots = [
        line
        for i, take in enumerate(drawn)
        for line in _shot(_id(drawn, i), take, options, notes, lenses=lenses)
    ]
    drone = _drone(footage, drawn[0].cameras[0], notes, zoom=(widest, narrowest) if lenses else None)
    head = [f"# Imported from {what}."]
    if counts[1] < counts[0]:
        kept_of = f"{counts[1]} of {counts[0]} cameras"
        head.append(
            f"# {kept_of}: between them the picture is within {PICTURE_ERROR_HALF_FRAMES:g} half frames "
            "of the file's."
        )
    said = {f"# {note.comment}": None for note in notes.assumptions}
    body = ["shotc: 1", f"mission: {safe_name(name)}", *_world(footage), "drones:", *drone, "shots:", *shots]
    return CameraMission("\n".join([*head, *said, *body, ""]), len(drawn), counts[1], counts[0])


def _rested(take: Take) -> Take:
    """Return a take without repeated cameras: they become a rest at the first of them."""
    out: list[ImportedCamera] = []
    for camera in take.cameras:
        if not out or not _same(out[-1], camera):
            out.append(camera)
        elif camera.time is not None and out[-1].time is not None:
            out[-1] = out[-1]._replace(hold=camera.time + camera.hold - out[-1].time)
    return take._replace(cameras=tuple(out))


def _same(a: ImportedCamera, b: ImportedCamera) -> bool:
    turned = abs((b.heading - a.heading + 180.0) % 360.0 - 180.0) + abs(b.pitch - a.pitch)
    zoomed = abs((a.hfov or 0.0) - (b.hfov or 0.0))
    return dist(a.at, b.at) < SAME_M and turned < SAME_DEG and zoomed < SAME_LENS_DEG


def _lenses(takes: list[Take]) -> tuple[float, float]:
    """Return the widest and the narrowest field of view, degrees; the drone's own if the file has none."""
    lenses = [camera.hfov for take in takes for camera in take.cameras if camera.hfov is not None]
    own = degrees(PRESETS[MODEL].hfov)
    return max(lenses, default=own), min(lenses, default=own)


def _world(footage: ImportedTakes) -> Iterator[str]:
    if footage.origin is not None:
        lat, lon, alt = footage.origin
        yield f"world: {{origin: {{lat: {lat:.7f}, lon: {lon:.7f}, alt: {alt:.3f}}}}}"


def _drone(
    footage: ImportedTakes, first: ImportedCamera, notes: Notes, *, zoom: tuple[float, float] | None
) -> list[str]:
    """Return the line of the drone.

    zoom : its widest and narrowest field of view, degrees, if it has several
    """
    home = footage.home
    if home is None:
        x, y, _ = first.at
        heading = radians(first.heading)
        home = (x - BEHIND_M * sin(heading), y - BEHIND_M * cos(heading), 0.0)
        message = "the file does not say which drone it is, nor where it stands"
        notes.assume(footage.node, message, f"model {MODEL}, {BEHIND_M:g} m behind the first camera")
    else:
        notes.assume(footage.node, "the file does not say which drone it is", f"model {MODEL}")
    at = ", ".join(f"{value + 0.0:.4f}" for value in home)
    lens = ""
    if zoom is not None:
        lens = f", camera: {{zoom: [{_focal(zoom[0], floor)} mm, {_focal(zoom[1], ceil)} mm]}}"
    elif first.hfov is not None:
        lens = f", camera: {{hfov: {first.hfov:.4f} deg}}"
    return [f"  cam1: {{model: {MODEL}, home: [{at}]{lens}}}"]


def _focal(hfov: float, rounded: Callable[[float], int]) -> str:
    """Return the focal length of a field of view on a frame 36 mm wide, millimetres."""
    return f"{rounded(1e7 * focal_length(radians(hfov))) / 1e4:.4f}"


def _id(takes: list[Take], i: int) -> str:
    """Return a shot's id: its take's name, with a number if another take has the same name."""
    names = [safe_name(take.name, "take") for take in takes]
    return names[i] if names.count(names[i]) == 1 else f"{names[i]}-{names[: i + 1].count(names[i])}"


def _shot(name: str, take: Take, options: ImportOptions, notes: Notes, *, lenses: bool) -> Iterator[str]:
    yield f"  - id: {name}"
    yield "    kind: keyframes"
    yield "    drone: cam1"
    timed = _timed(take, notes)
    if timed:
        first, last = take.cameras[0], take.cameras[-1]
        yield f"    timing: {{duration: {(last.time or 0.0) + last.hold - (first.time or 0.0):.3f}}}"
    yield "    keyframes:"
    for camera in take.cameras:
        parts = [f"at: [{', '.join(f'{value + 0.0:.4f}' for value in camera.at)}]"]
        if camera.look_at is not None:
            parts.append(f"look_at: [{', '.join(f'{value + 0.0:.4f}' for value in camera.look_at)}]")
        else:
            parts += [f"heading: {_compass(camera.heading)} deg", f"pitch: {camera.pitch + 0.0:.4f} deg"]
        if lenses and camera.hfov is not None:
            parts.append(f"hfov: {camera.hfov:.4f} deg")
        if camera.hold > 0.0:
            parts.append(f"hold: {camera.hold:.3f}")
        if timed and options.times and camera.time is not None:
            parts.append(f"time: {camera.time - (take.cameras[0].time or 0.0):.3f}")
        yield f"      - {{{', '.join(parts)}}}"


def _compass(heading: float) -> str:
    """Return a heading as a direction below 360 deg, without turns."""
    text = f"{heading % 360.0:.4f}"
    return "0.0000" if text == "360.0000" else text


def _timed(take: Take, notes: Notes) -> bool:
    """Return whether a take is flown in its own time. A take that is too fast gets the time of the drone."""
    if any(camera.time is None for camera in take.cameras):
        return False
    fast = too_fast(take.cameras, PRESETS[MODEL].limits)
    if fast is not None:
        message = "from this camera on the take is too fast for the drone"
        notes.assume(fast.node, message, "the shot takes as long as the drone needs")
    return fast is None
