"""The content of a file of cameras: takes of cameras in W (East, North, Up, metres), degrees."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from shotc.geom.vec import Vec3
from shotc.importers.xml_tree import Node
from shotc.ir.mission import GeoOrigin

MOST_CAMERAS = 10_000
"""Most cameras of a file. More are not a shot, and would take minutes."""


class ImportedCamera(NamedTuple):
    """One camera.

    node    : its place in the file
    at      : its position in W, metres
    heading : compass bearing, degrees
    pitch   : angle above the horizon, degrees
    hfov    : degrees, None if the file has no lens
    time    : seconds since the take's first camera, None without a clock
    hold    : time at rest, seconds
    look_at : the place in W that heading and pitch point at, or None
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
    """Cameras that are flown through without a break. ``name``: as in the file, may be empty."""

    name: str
    node: Node
    cameras: tuple[ImportedCamera, ...]


def recorded(
    node: Node, cameras: Sequence[ImportedCamera], starts: Sequence[bool], stops: Sequence[bool]
) -> list[Take]:
    """Return one take for each recorded part; one take of all cameras if recording is never started.

    node   : the whole file
    starts : whether recording starts at each camera
    stops  : whether recording stops at each camera
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
    """The takes of a file, with its place on earth.

    node   : the whole file
    origin : origin of W, None if the file is in metres
    home   : position of the drone before the flight, None if the file does not give it
    """

    node: Node
    takes: tuple[Take, ...]
    origin: GeoOrigin | None = None
    home: Vec3 | None = None


class ImportOptions(NamedTuple):
    """Options of the user for a file.

    every  : keep all cameras, also those that interpolation replaces
    times  : keep the time of each camera
    fps    : frames per second, None if not given
    ground : altitude of the ground, metres above sea level, None if not given
    """

    every: bool = False
    times: bool = False
    fps: float | None = None
    ground: float | None = None


class Refused(NamedTuple):
    """Why a file is not imported: a code, the fault, its place, and a remedy."""

    code: str
    message: str
    node: Node
    help: str
