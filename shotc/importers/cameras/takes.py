"""What a file of cameras holds: takes, each a row of cameras, in W (East, North, Up, metres), degrees."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from shotc.geom.vec import Vec3
from shotc.importers.xml_tree import Node
from shotc.ir.mission import GeoOrigin

MOST_CAMERAS = 10_000
"""How many cameras of a file are read: more is no shot, and would take minutes."""


class ImportedCamera(NamedTuple):
    """One camera.

    node : where it stands in the file; heading : compass bearing, pitch : over the horizon, deg
    hfov : deg, None where the file has no lens; time : seconds from the take's first, None without a clock
    hold : seconds at rest; look_at : a place of W that it looks at, which heading and pitch are of, if any
    """

    node: Node
    at: Vec3
    heading: float
    pitch: float
    hfov: float | None = None
    time: float | None = None
    hold: float = 0.0
    look_at: Vec3 | None = None


class Take(NamedTuple):
    """Cameras that are flown through in one go. name : as the file has it, maybe empty."""

    name: str
    node: Node
    cameras: tuple[ImportedCamera, ...]


def recorded(
    node: Node, cameras: Sequence[ImportedCamera], starts: Sequence[bool], stops: Sequence[bool]
) -> list[Take]:
    """Return what is recorded, take by take; all in one where recording is never started.

    node : of the whole file; starts, stops : whether it is started and stopped at each camera
    """
    if not any(starts):
        return [Take("", node, tuple(cameras))]
    takes: list[list[ImportedCamera]] = []
    running = False
    for camera, starts_here, stops_here in zip(cameras, starts, stops, strict=True):
        if running:
            takes[-1].append(camera)
        running = running and not stops_here
        if starts_here and not running:
            takes.append([camera])
            running = True
    return [Take("", some[0].node, tuple(some)) for some in takes]


class ImportedTakes(NamedTuple):
    """All that is imported of a file.

    node : of the whole file; origin : None where the file is in metres already
    home : where the drone stands, None where the file does not say
    """

    node: Node
    takes: tuple[Take, ...]
    origin: GeoOrigin | None = None
    home: Vec3 | None = None


class ImportOptions(NamedTuple):
    """What the user says about a file.

    every : keep cameras that the others imply; times : keep when each camera is reached
    fps : frames a second; ground : its altitude, metres above sea level; None where they say nothing
    """

    every: bool = False
    times: bool = False
    fps: float | None = None
    ground: float | None = None


class Refused(NamedTuple):
    """Why a file is not imported: a code, what is wrong, where, and what to do."""

    code: str
    message: str
    node: Node
    help: str = ""
