"""Read shows of Skybrush (``.skyc``): a ZIP with ``show.json`` and curves of each drone between key points.

Positions are metres in the show's frame: X points to the bearing that the show gives, Y to its left, Z up.
"""

from __future__ import annotations

import json
from base64 import b64decode
from dataclasses import dataclass
from itertools import pairwise
from math import cos, radians, sin
from posixpath import normpath
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from shotc.geom.geodetic import to_world
from shotc.importers.archive import Archive, ArchiveFault
from shotc.importers.cameras.places import LARGEST_COORDINATE_M, is_place
from shotc.importers.flights.endings import LARGEST_CLOCKED_BYTES
from shotc.importers.flights.light_program import KeyedLight, keyed
from shotc.importers.flights.points import BROKEN, FOREIGN, SWAPPED, UNREADABLE, refuse
from shotc.importers.flights.rows import LONGEST_S
from shotc.importers.notes import plain
from shotc.importers.words import EXPORT_AGAIN
from shotc.importers.xml_tree import Node
from shotc.ir.mission import GeoOrigin

Array = NDArray[np.float64]

SHOW = "show.json"
ORIGIN = "write it as [latitude, longitude, altitude], or leave it out"
KEY = "write `[seconds, [x, y, z], []]`"
WHOLE = Node("", 1, 1, wide=1)
MOST_DRONES, MOST_POINTS = 20_000, 20_000
MOST_UNPACKED_BYTES = 5 * LARGEST_CLOCKED_BYTES
"""Largest size of all parts of a show together, bytes."""
SHORTEST_S = 1e-3
DEGREE = 3


class Key(NamedTuple):
    """A time, s, a position, m, and the control points of the curve that ends there."""

    time: float
    place: list[float]
    control: list[list[float]]


@dataclass(frozen=True, slots=True, eq=False)
class ShowFlight:
    """The flight of one drone, in the show's frame rotated to East, North and Up.

    element : its place in the file, as text
    home    : position before the flight, metres, shape (3,)
    breaks  : times between the cubics, seconds, shape (P + 1,)
    ctrl    : Bernstein control points of the cubics, metres, shape (P, 4, 3)
    light   : light of the drone, None if it has none or lights are not read
    """

    name: str
    element: str
    home: Array
    breaks: Array
    ctrl: Array
    light: KeyedLight | None = None


class ShowOrigin(NamedTuple):
    """Where the frame of a show is: latitude and longitude, degrees, and altitude, metres, if it is given."""

    lat: float
    lon: float
    alt: float | None


@dataclass(frozen=True, slots=True, eq=False)
class SkycShow:
    """A show; origin : of its frame, None if not given."""

    flights: tuple[ShowFlight, ...]
    origin: ShowOrigin | None


def shift(origin: ShowOrigin | None, world: GeoOrigin | None) -> Array:
    """Return the position of the show's frame in the mission's frame, metres, shape (3,).

    It is zero if one of the origins is missing.

    origin : origin of the show's frame
    world  : origin of the mission's frame
    """
    if origin is None or world is None:
        return np.zeros(3)
    lat, lon, alt = origin
    east, north, up = to_world((lat, lon, world.alt if alt is None else alt), world)
    return np.array([east, north, 0.0 if alt is None else up])


def show(data: bytes, *, lit: bool = False) -> SkycShow:
    """Return the flights of a show, with their lights if ``lit``."""
    archive = Archive(data, LARGEST_CLOCKED_BYTES, MOST_UNPACKED_BYTES)
    content = _part(archive, SHOW)
    if not isinstance(content, dict) or content.get("version") != 1:
        said = plain(str(content.get("version")), 20) if isinstance(content, dict) else "none"
        refuse(FOREIGN, f"it is a show of version {said}; 1 is read", WHOLE, EXPORT_AGAIN)
    drones = _inside(content, "swarm").get("drones")
    if not isinstance(drones, list) or not 0 < len(drones) <= MOST_DRONES:
        refuse(
            BROKEN,
            f"its `swarm.drones` is no list of 1 to {MOST_DRONES} drones",
            WHOLE,
            f"give it 1 to {MOST_DRONES} drones",
        )
    location = _inside(_inside(content, "environment"), "location")
    turn = location.get("orientation", 0.0)
    if not _is_number(turn):
        refuse(
            BROKEN,
            "its `environment.location.orientation` is no number",
            WHOLE,
            "write it in degrees, or leave it out",
        )
    flights = tuple(_flight(archive, drone, i, (radians(turn), lit)) for i, drone in enumerate(drones))
    return SkycShow(flights, _origin(location.get("origin")))


def _origin(value: Any) -> ShowOrigin | None:
    if value is None:
        return None
    if not isinstance(value, list) or len(value) < 2 or not all(map(_is_number, value[:2])):
        refuse(BROKEN, "its `environment.location.origin` is no latitude and longitude", WHOLE, ORIGIN)
    lat, lon = float(value[0]), float(value[1])
    if not is_place(lat, lon):
        refuse(
            BROKEN,
            f"its origin is at {lat:g}, {lon:g} deg, which is no latitude and longitude",
            WHOLE,
            SWAPPED,
        )
    alt = float(value[2]) if len(value) > 2 and _is_number(value[2]) else None
    return ShowOrigin(lat, lon, alt)


def _part(archive: Archive, name: str) -> Any:
    """Return the JSON value of a part of the archive."""
    data = archive.member(name)
    if isinstance(data, ArchiveFault):
        refuse(UNREADABLE, data.message, WHOLE, data.help)
    try:
        return json.loads(data)
    except (ValueError, RecursionError) as fault:
        refuse(UNREADABLE, f"`{name}` is no JSON: {plain(str(fault), 80)}", WHOLE, EXPORT_AGAIN)


def _inside(parent: dict[str, Any], key: str) -> dict[str, Any]:
    value = parent.get(key)
    return value if isinstance(value, dict) else {}


def _resolved(archive: Archive, value: Any) -> Any:
    """Return the value behind a reference inside the archive; any other value unchanged."""
    if isinstance(value, dict) and isinstance(value.get("$ref"), str):
        return _part(archive, normpath(value["$ref"].partition("#")[0]))
    return value


def _flight(archive: Archive, drone: Any, index: int, how: tuple[float, bool]) -> ShowFlight:
    turn, lit = how
    settings = _resolved(archive, drone.get("settings")) if isinstance(drone, dict) else None
    element = f"swarm.drones[{index}]"
    if not isinstance(settings, dict):
        refuse(BROKEN, f"`{element}` has no `settings`", WHOLE, EXPORT_AGAIN)
    name = settings.get("name")
    name = name if isinstance(name, str) else str(index + 1)
    path = _resolved(archive, settings.get("trajectory"))
    where = f"{element}.settings.trajectory"
    if not isinstance(path, dict) or path.get("version") != 1:
        refuse(BROKEN, f"`{where}` is no trajectory of version 1", WHOLE, EXPORT_AGAIN)
    keys, begin = _keys(path, where)
    value = settings.get("home")
    home = value if _is_place(value) else keys[0].place
    times = np.array([key.time for key in keys]) + begin
    curves = [[a.place, *b.control, b.place] for a, b in pairwise(keys)]
    if times[0] > 0.0:  # the drone stands until its first key
        times = np.append(0.0, times)
        curves.insert(0, [keys[0].place, keys[0].place])
    elif len(keys) == 1:
        times = np.array([0.0, 1.0])
        curves = [[keys[0].place, keys[0].place]]
    light = _light(archive, settings, element, float(times[-1])) if lit else None
    places, at_home = _turned(_cubics(curves), turn), _turned(np.array(home, dtype=float), turn)
    return ShowFlight(name, element, at_home, times, places, light)


def _light(archive: Archive, settings: dict[str, Any], element: str, end: float) -> KeyedLight | None:
    """Return the light of a drone, None if it has none. ``end``: end of its flight, s."""
    lights, where = _resolved(archive, settings.get("lights")), f"{element}.settings.lights"
    if lights is None:
        return None
    data = lights.get("data") if isinstance(lights, dict) and lights.get("version") == 1 else None
    try:
        program = b64decode(data, validate=True) if isinstance(data, str) else None
    except ValueError:
        program = None
    if program is None:
        refuse(BROKEN, f"`{where}` is no program of version 1", WHOLE, EXPORT_AGAIN)
    return keyed(program, f"{where}.data", end)


def _keys(path: dict[str, Any], where: str) -> tuple[list[Key], float]:
    """Return the key points of a trajectory and its start time, s."""
    points, begin = path.get("points"), path.get("takeoffTime", 0.0)
    if not isinstance(points, list) or not 0 < len(points) <= MOST_POINTS:
        refuse(
            BROKEN,
            f"`{where}.points` is no list of 1 to {MOST_POINTS} key points",
            WHOLE,
            f"give it 1 to {MOST_POINTS} key points",
        )
    if not _is_number(begin) or begin < 0.0:
        refuse(
            BROKEN, f"`{where}.takeoffTime` is no time", WHOLE, "write seconds of 0 or more, or leave it out"
        )
    keys = [_key(point, f"{where}.points[{i}]") for i, point in enumerate(points)]
    for i, (a, b) in enumerate(pairwise(keys)):
        if b.time - a.time < SHORTEST_S:
            late = f"the time of `{where}.points[{i + 1}]`, {b.time:g} s,"
            later = f"let it be {a.time + SHORTEST_S:g} s or later, or leave the point out"
            refuse(BROKEN, f"{late} does not come after {a.time:g} s", WHOLE, later)
    if keys[0].time + begin < 0.0:
        refuse(
            BROKEN, f"`{where}.points[0]` is before the show begins", WHOLE, "let its time be 0 s or later"
        )
    if keys[-1].time + begin > LONGEST_S:
        message = f"`{where}` lasts until {keys[-1].time + begin:g} s, which is no flight"
        refuse(BROKEN, message, WHOLE, f"let it end by {LONGEST_S:g} s")
    return keys, float(begin)


def _key(point: Any, where: str) -> Key:
    if not isinstance(point, list) or len(point) != 3 or not isinstance(point[2], list):
        refuse(BROKEN, f"`{where}` is no list of 3: a time, a place and control points", WHOLE, KEY)
    time, place, control = point
    if not _is_number(time):
        refuse(BROKEN, f"the time of `{where}` is no number of seconds", WHOLE, KEY)
    if len(control) > DEGREE - 1:
        many = f"{len(control)} control points, which make no line, quadratic or cubic"
        refuse(BROKEN, f"`{where}` has {many}: 0 to {DEGREE - 1} are possible", WHOLE, KEY)
    for name, at in (("the place", place), *((f"control point {i + 1}", p) for i, p in enumerate(control))):
        if not _is_place(at):
            message = f"{name} of `{where}` is no list of 3 finite numbers"
            refuse(BROKEN, message, WHOLE, "write [x, y, z] in metres")
    return Key(float(time), place[:3], [each[:3] for each in control])


def _cubics(curves: list[list[list[float]]]) -> Array:
    """Return the control points (P, 4, 3) of curves of degree one to three."""
    cubics = np.empty((len(curves), DEGREE + 1, 3))
    counts = np.array([len(points) for points in curves])
    for count in np.unique(counts):
        some = np.flatnonzero(counts == count)
        cubics[some] = _raised(np.array([curves[k] for k in some], dtype=float))
    return cubics


def _raised(ctrl: Array) -> Array:
    """Return Bezier curves (k, n, 3), raised to cubics (Farin, *Curves and Surfaces for CAGD*, sec. 6.1)."""
    while ctrl.shape[1] <= DEGREE:
        n = ctrl.shape[1]
        share = (np.arange(1, n) / n)[:, None]
        inner = share * ctrl[:, :-1] + (1.0 - share) * ctrl[:, 1:]
        ctrl = np.concatenate([ctrl[:, :1], inner, ctrl[:, -1:]], axis=1)
    return ctrl


def _turned(points: Array, turn: float) -> Array:
    """Return points of the show's frame as East, North and Up. ``turn``: bearing of its X axis, rad."""
    x, y, z = points[..., 0], points[..., 1], points[..., 2]
    return np.stack([x * sin(turn) - y * cos(turn), x * cos(turn) + y * sin(turn), z], axis=-1)


def _is_number(value: Any) -> bool:
    return (
        not isinstance(value, bool) and isinstance(value, int | float) and abs(value) < LARGEST_COORDINATE_M
    )


def _is_place(value: Any) -> bool:
    return isinstance(value, list) and len(value) >= 3 and all(map(_is_number, value[:3]))
