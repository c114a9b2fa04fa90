"""Read a ``.plan`` of QGroundControl: waypoints and camera commands.

Format: docs.qgroundcontrol.com, file_formats/plan; commands: mavlink.io, common.xml. Heights are relative to
the plan's home unless their frame is another. Commands between two waypoints apply from the first of them on:
angles of the gimbal relative to the body, or a place to look at.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import degrees, dist
from typing import Any, NamedTuple

from shotc.geom.focal import field_of_view
from shotc.geom.vec import Vec3
from shotc.importers.cameras.places import (
    LARGEST_COORDINATE_M,
    aim,
    clamped_hfov,
    is_place,
    origin_at,
    reached,
    without_far,
    world,
)
from shotc.importers.cameras.takes import (
    MOST_CAMERAS,
    ImportedCamera,
    ImportedTakes,
    ImportOptions,
    Refused,
    Take,
    recorded,
)
from shotc.importers.notes import Notes, plain
from shotc.importers.words import EXPORT_AGAIN, cut_into
from shotc.importers.xml_tree import Node
from shotc.ir.mission import GeoOrigin
from shotc.source.file import Span
from shotc.source.yaml_tree import Document, parse

WAYPOINT, SPLINE = 16, 82
SPEED, LOOK, LOOK_NO_MORE, LOOK_OLD, GIMBAL, MOUNT, START, STOP = 178, 195, 197, 201, 1000, 205, 2500, 2501
PHOTOS_BY_WAY, MODE, ZOOM, FOCUS, PHOTOS, NO_PHOTOS = 206, 530, 531, 532, 2000, 2001
_AIMING = (SPEED, LOOK, LOOK_NO_MORE, LOOK_OLD, GIMBAL, MOUNT)
_TAKING = (START, STOP, PHOTOS_BY_WAY, MODE, ZOOM, FOCUS, PHOTOS, NO_PHOTOS)
QUIET = frozenset((20, 21, 22, 1001, 115, *_AIMING, *_TAKING))
"""Commands that need no note: they are read, or every plan has them (take-off, landing, return, control of
the gimbal, mode and focus of the camera)."""
FOCAL_LENGTH_ZOOM_TYPE = 3
"""Zoom type of command 531 that means a focal length in mm."""
SEA_LEVEL, HOME_LEVEL, TERRAIN = (0, 5), (3, 6), (10, 11)
"""MAVLink frames by the reference of their heights."""
YAW_LOCK_FLAG = 16
"""Flag of command 1000: yaw is relative to North, not to the body."""
PARAMETER_COUNT = 7
LARGEST_FOCAL_MM = 2000.0


class CameraCommand(NamedTuple):
    """One command. params : seven numbers, each None if absent."""

    node: Node
    command: int
    frame: int
    params: tuple[float | None, ...]


@dataclass(slots=True)
class _Aim:
    """The aim of the camera: a place in W, or gimbal angles in degrees.

    yaw  : relative to North if ``locked``, else to the body
    hfov : degrees, None if no zoom command gives it
    """

    place: Vec3 | None = None
    pitch: float | None = None
    yaw: float = 0.0
    locked: bool = False
    hfov: float | None = None


class Opened(NamedTuple):
    """A plan: its document, the part `mission`, the items in that, and the place of the whole."""

    document: Document
    mission: dict[str, Any]
    items: list[Any]
    whole: Node


PLAN = 'give a `.plan` of QGroundControl, `{"mission": {"items": [...]}}`'
WAYPOINTS = "add waypoints, command 16, each with latitude, longitude and altitude"
HOME = "write it as [latitude, longitude, altitude], or leave it out"


def opened(data: bytes, name: str) -> Opened | Refused:
    """Return the parts of a plan. It is refused with code I001 if it is no JSON, I002 if it is no plan."""
    document = parse(data.replace(b"\t", b" "), name)  # JSON allows tabs between values, YAML does not
    if document.faults:
        fault = document.faults[0]
        return Refused(
            "I001",
            f"it is no JSON: {fault.message}",
            _node(fault.span),
            f"correct it there, or {EXPORT_AGAIN}",
        )
    mission = document.root.get("mission") if isinstance(document.root, dict) else None
    listed = mission.get("items") if isinstance(mission, dict) else None
    whole = _node(document.values.get((), Span(1, 1, 1, 2)))
    if not isinstance(mission, dict) or not isinstance(listed, list):
        return Refused(
            "I002", "it is no plan of QGroundControl: it has no `mission` with `items`", whole, PLAN
        )
    return Opened(document, mission, listed, whole)


def footage(data: bytes, name: str, options: ImportOptions, notes: Notes) -> ImportedTakes | Refused:
    """Return the takes of a plan: the recorded parts, or all waypoints if nothing is recorded."""
    plan = opened(data, name)
    if isinstance(plan, Refused):
        return plan
    document, mission, listed, whole = plan
    if len(listed) > MOST_CAMERAS:
        message = f"it has {len(listed)} items; at most {MOST_CAMERAS} are read"
        return Refused(
            "I001",
            message,
            node_at(document, "mission", "items", MOST_CAMERAS),
            cut_into(MOST_CAMERAS, "items"),
        )
    items = list(_items(document, listed, notes))
    waypoints = [item for item in items if item.command in (WAYPOINT, SPLINE)]
    if not waypoints:
        return Refused("I003", "it holds no waypoint that says where it is", whole, WAYPOINTS)
    origin = _origin(document, mission, waypoints[0], options, notes)
    absolute = [item for item in waypoints if item.frame in SEA_LEVEL]
    if isinstance(origin, Refused):
        return origin
    if (
        absolute
        and len(absolute) < len(waypoints)
        and "plannedHomePosition" not in mission
        and options.ground is None
    ):
        message = "some waypoints count from sea level, others from a home that the file does not have"
        return Refused(
            "I007", message, absolute[0].node, "give the altitude of the ground: `--ground METRES`"
        )
    for part in ("geoFence", "rallyPoints"):
        content = document.root.get(part)
        if isinstance(content, dict) and any(isinstance(v, list) and v for v in content.values()):
            notes.assume(node_at(document, part), f"`{part}` is not imported", "zones of your own, or none")
    if (fast := next((item for item in items if item.command == SPEED), None)) is not None:
        notes.assume(fast.node, "speeds between waypoints are not read", "the drone goes at its own pace")
    _assumed(items, notes)
    takes = _takes(whole, items, origin, notes)
    return ImportedTakes(whole, without_far(takes, notes), origin, home=(0.0, 0.0, 0.0))


def _assumed(items: Sequence[CameraCommand], notes: Notes) -> None:
    """Note the assumptions about camera commands, once each."""
    zooms = [item for item in items if item.command == ZOOM]
    for item in [item for item in zooms if item.params[0] == FOCAL_LENGTH_ZOOM_TYPE][:1]:
        notes.assume(item.node, "a focal length without the sensor's width", "a frame 36 mm wide")
    for item in [item for item in zooms if item.params[0] != FOCAL_LENGTH_ZOOM_TYPE][:1]:
        notes.assume(item.node, "a zoom that is no focal length", "the lens stays as it is")
    for item in [item for item in items if item.command in (PHOTOS, PHOTOS_BY_WAY)][:1]:
        notes.assume(item.node, "photos are taken", "a film of the same way")


def _items(document: Document, listed: Sequence[Any], notes: Notes) -> Iterator[CameraCommand]:
    for i, item in enumerate(listed):
        node = node_at(document, "mission", "items", i)
        command = item.get("command") if isinstance(item, dict) else None
        params = item.get("params") if isinstance(item, dict) else None
        if not isinstance(command, int) or not isinstance(params, list):
            kind = item.get("complexItemType") if isinstance(item, dict) else None
            what = f"a `{plain(kind, 30)}`" if isinstance(kind, str) else "no simple item"
            notes.assume(node, f"item {i + 1} is {what}", "it is left out")
            continue
        numbers = [number_of(value) for value in params[:PARAMETER_COUNT]]
        numbers += [None] * (PARAMETER_COUNT - len(numbers))
        frame = item.get("frame")
        camera_command = CameraCommand(
            node, command, frame if isinstance(frame, int) else HOME_LEVEL[0], tuple(numbers)
        )
        if command in (WAYPOINT, SPLINE) and not _is_placed(camera_command):
            notes.assume(node, f"item {i + 1} is a waypoint without a place", "it is left out")
            continue
        if command not in QUIET and command not in (WAYPOINT, SPLINE):
            notes.assume(node, f"item {i + 1} is command {command}, which no camera needs", "it is left out")
            continue
        yield camera_command


def _is_placed(item: CameraCommand) -> bool:
    return is_place(item.params[4], item.params[5]) and item.params[6] is not None


def _origin(
    document: Document, mission: dict[str, Any], first: CameraCommand, options: ImportOptions, notes: Notes
) -> GeoOrigin | Refused:
    home = mission.get("plannedHomePosition")
    if home is not None:
        place = [number_of(value) for value in home] if isinstance(home, list) else []
        lat, lon, alt = place if len(place) == 3 else (None, None, None)
        if lat is None or lon is None or not is_place(lat, lon):
            node = node_at(document, "mission", "plannedHomePosition")
            return Refused(
                "I002", "its `plannedHomePosition` is no latitude, longitude and altitude", node, HOME
            )
        return origin_at(lat, lon, options.ground if options.ground is not None else (alt or 0.0))
    if options.ground is None:
        message = "the file has no `plannedHomePosition`"
        taken = "home is at the first waypoint, at sea level; `--ground` is its altitude"
        notes.assume(first.node, message, taken)
    return origin_at(first.params[4] or 0.0, first.params[5] or 0.0, options.ground or 0.0)


def _takes(whole: Node, items: Sequence[CameraCommand], origin: GeoOrigin, notes: Notes) -> list[Take]:
    """Return the waypoints as cameras. The commands after a waypoint belong to it."""
    cameras: list[ImportedCamera] = []
    starts: list[bool] = []
    stops: list[bool] = []
    looks, heading = _Aim(), 0.0
    first = next(i for i, item in enumerate(items) if item.command in (WAYPOINT, SPLINE))
    for item in items[:first]:
        _turn(item, looks, origin)
    i = first
    while i < len(items):
        item, i = items[i], i + 1
        at = _place(item, origin, notes)
        heading = item.params[3] if item.params[3] is not None else _ahead(items, i, at, origin, heading)
        after = []
        while i < len(items) and items[i].command not in (WAYPOINT, SPLINE):
            after.append(items[i])
            _turn(items[i], looks, origin)
            i += 1
        hold = max(0.0, item.params[0] or 0.0) if item.command == WAYPOINT else 0.0
        cameras.append(_camera(item, at, heading, looks, notes)._replace(hold=hold, hfov=looks.hfov))
        starts.append(any(_starts_recording(command) for command in after))
        stops.append(any(_ends(command) for command in after))
    return recorded(whole, cameras, starts, stops)


def _starts_recording(item: CameraCommand) -> bool:
    """Return whether a command starts a recording or photos."""
    return item.command in (START, PHOTOS) or (item.command == PHOTOS_BY_WAY and bool(item.params[0]))


def _ends(item: CameraCommand) -> bool:
    return item.command in (STOP, NO_PHOTOS) or (item.command == PHOTOS_BY_WAY and not item.params[0])


def _place(item: CameraCommand, origin: GeoOrigin, notes: Notes) -> Vec3:
    _, _, _, _, lat, lon, height = item.params
    if item.frame in TERRAIN:
        notes.assume(item.node, "a height over terrain", "the ground is flat")
    above = (height or 0.0) + (0.0 if item.frame in SEA_LEVEL else origin.alt)
    return world(origin, lat or 0.0, lon or 0.0, above, absolute=True)


def _ahead(items: Sequence[CameraCommand], i: int, at: Vec3, origin: GeoOrigin, otherwise: float) -> float:
    """Return the compass bearing to the next waypoint, degrees: the default heading of a vehicle."""
    for item in items[i:]:
        if item.command in (WAYPOINT, SPLINE):
            to = _place(item, origin, Notes())
            return aim(at, to)[0] if dist(at[:2], to[:2]) > 0.1 else otherwise
    return otherwise


def _turn(item: CameraCommand, looks: _Aim, origin: GeoOrigin) -> None:
    """Apply a command to the aim of the camera."""
    p = item.params
    if item.command in (LOOK, LOOK_OLD) and is_place(p[4], p[5]) and (p[4], p[5]) != (0.0, 0.0):
        looks.place = _place(item, origin, Notes())
    elif item.command == LOOK_NO_MORE:
        looks.place = None
    elif item.command == GIMBAL and p[0] is not None:
        looks.pitch, looks.yaw, looks.place = p[0], p[1] or 0.0, None
        looks.locked = bool(int(p[4] or 0.0) & YAW_LOCK_FLAG)
    elif item.command == ZOOM and p[0] == FOCAL_LENGTH_ZOOM_TYPE and 0 < (p[1] or 0.0) < LARGEST_FOCAL_MM:
        looks.hfov = clamped_hfov(degrees(field_of_view((p[1] or 0.0) / 1e3)))
    elif item.command == MOUNT and p[0] is not None:
        looks.pitch, looks.yaw, looks.locked, looks.place = p[0], p[2] or 0.0, False, None


def _camera(item: CameraCommand, at: Vec3, heading: float, looks: _Aim, notes: Notes) -> ImportedCamera:
    if looks.place is not None and dist(at, looks.place) > 0.1:
        bearing, pitch = aim(at, looks.place)
        if reached(item.node, pitch, notes) == pitch:
            return ImportedCamera(item.node, at, bearing, pitch, look_at=looks.place)
        return ImportedCamera(item.node, at, bearing, reached(item.node, pitch, notes))
    if looks.pitch is None:
        notes.assume(item.node, "no command says where the gimbal points", "level, straight ahead")
    bearing = looks.yaw if looks.locked else heading + looks.yaw
    return ImportedCamera(item.node, at, bearing % 360.0, reached(item.node, looks.pitch or 0.0, notes))


def number_of(value: Any) -> float | None:
    """Return a JSON number, None for any other value."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        return None
    return float(value) if abs(value) < LARGEST_COORDINATE_M else None


def node_at(document: Document, *path: str | int) -> Node:
    """Return the place of a value."""
    return _node(document.values.get(path, Span(1, 1, 1, 2)))


def _node(span: Span) -> Node:
    wide = span.end_column - span.column if span.end_line == span.line else 1
    return Node("", span.line, span.column, wide=max(1, wide))
