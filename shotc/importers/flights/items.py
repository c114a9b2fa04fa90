"""Read mission items of MAVLink: ``.plan`` of QGroundControl, and ``.waypoints`` (QGC WPL 110).

Commands: mavlink.io, common.xml. A command that moves the drone in an unknown way is refused. A command that
does not move it is skipped.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal, NamedTuple

from shotc.importers.cameras.places import number
from shotc.importers.cameras.qgc import Opened, node_at, number_of, opened
from shotc.importers.cameras.takes import Refused
from shotc.importers.flights.points import (
    BROKEN,
    FOREIGN,
    HEIGHTS,
    UNREADABLE,
    FlightPoint,
    Level,
    Pace,
    Unread,
    Waypoints,
    checked,
    placed,
    refuse,
)
from shotc.importers.notes import plain
from shotc.importers.xml_tree import Node

WAYPOINT, RETURN, LAND, TAKEOFF, LOITER_TIME, SPLINE, DELAY = 16, 20, 21, 22, 19, 82, 93
SPEED, GIMBAL, MOUNT = 178, 1000, 205
LAST_NAVIGATION_COMMAND = 95
"""Commands up to this number move the drone."""
ASTRAY = {
    17: "circles without end",
    18: "turns round a place",
    177: "a jump to another item",
    179: "a new home",
}
LEVELS: dict[int, Level] = {0: "sea", 5: "sea", 3: "home", 6: "home"}
PX4, ARDUPILOT = 12, 3
HEADER = "QGC WPL 110"
PARAMETER_COUNT = 7
CLIMB, DESCENT = 2, 3


class FlightCommand(NamedTuple):
    """One command. params : seven numbers, each None if absent."""

    node: Node
    name: str
    command: int
    frame: int
    params: tuple[float | None, ...]


FIRMWARE = f"write {PX4} or {ARDUPILOT}, or plan it in QGroundControl for one of these"
WAYPOINTS = f"fly that part by waypoints, command {WAYPOINT}"


@dataclass(slots=True)
class _ItemReader:
    """The points read so far, and the values in force."""

    pace: Pace = field(default_factory=Pace)
    points: list[FlightPoint] = field(default_factory=list)
    climb: float = 0.0
    landing: FlightPoint | None = None
    ending: str = ""
    stay: float = 0.0
    pitches: tuple[float, ...] = ()


def plan(data: bytes, name: str) -> Waypoints:
    """Return the points of a ``.plan``; raise Unread with the fault of a file that is none."""
    document = opened(data, name)
    if isinstance(document, Refused):
        raise Unread(document._replace(code=FOREIGN if document.code == "I002" else UNREADABLE))
    firmware = document.mission.get("firmwareType")
    if firmware not in (PX4, ARDUPILOT):
        message = f"its `firmwareType` is {plain(str(firmware), 20)}; PX4 is {PX4}, ArduPilot {ARDUPILOT}"
        refuse(FOREIGN, message, node_at(document.document, "mission", "firmwareType"), FIRMWARE)
    return _flown(document.whole, list(_of_plan(document)), "px4" if firmware == PX4 else "ardupilot")


def table(text: str) -> Waypoints:
    """Return the points of a ``.waypoints``. Its first row is the home, which the autopilot sets again."""
    lines = text.splitlines()
    start = Node("", 1, 1, wide=max(1, len(lines[0]) if lines else 1))
    if not lines or lines[0].strip() != HEADER:
        refuse(FOREIGN, f"it does not begin with the line `{HEADER}`", start, f"begin it with `{HEADER}`")
    items = [_row(line, i) for i, line in enumerate(lines[1:], 2) if line.strip()]
    return _flown(start, items[1:], "ardupilot")


def _row(line: str, index: int) -> FlightCommand:
    cells = line.split("\t") if "\t" in line else line.split()
    node = Node("", index, 1, wide=max(1, len(line)))
    if len(cells) != 12:
        refuse(
            BROKEN, f"it has {len(cells)} columns; a row has 12", node, "give it 12 columns with tabs between"
        )
    numbers = [number(cell.strip()) for cell in cells]
    wrong = next((k for k, value in enumerate(numbers) if value is None), None)
    if wrong is not None:
        refuse(BROKEN, f"`{plain(cells[wrong], 20)}` is no number", node, "write a number there")
    known = [0.0 if value is None else value for value in numbers]
    return FlightCommand(node, f"item {known[0]:.0f}", int(known[3]), int(known[2]), tuple(known[4:11]))


def _of_plan(document: Opened) -> Iterator[FlightCommand]:
    for i, item in enumerate(document.items):
        node = node_at(document.document, "mission", "items", i)
        inner = item.get("TransectStyleComplexItem") if isinstance(item, dict) else None
        listed = inner.get("Items") if isinstance(inner, dict) else None
        if isinstance(listed, list):  # a survey contains the items that it generates
            for k, part in enumerate(listed):
                yield _simple(part, f"item {i + 1}.{k + 1}", node)
        else:
            yield _simple(item, f"item {i + 1}", node)


def _simple(item: Any, name: str, node: Node) -> FlightCommand:
    command = item.get("command") if isinstance(item, dict) else None
    params = item.get("params") if isinstance(item, dict) else None
    frame = item.get("frame") if isinstance(item, dict) else None
    if not isinstance(command, int) or not isinstance(params, list) or not isinstance(frame, int):
        kind = item.get("complexItemType") if isinstance(item, dict) else None
        what = f"a `{plain(kind, 30)}`" if isinstance(kind, str) else "no simple item"
        message = f"{name} is {what}: it has no `command`, `frame` and `params`"
        refuse(BROKEN, message, node, "save the plan with its items laid out")
    numbers = [number_of(value) for value in params[:PARAMETER_COUNT]]
    return FlightCommand(node, name, command, frame, (*numbers, *[None] * (PARAMETER_COUNT - len(numbers))))


def _flown(whole: Node, items: Sequence[FlightCommand], autopilot: Literal["px4", "ardupilot"]) -> Waypoints:
    run = _ItemReader()
    for item in items:
        if run.landing is not None or run.ending:
            break
        _take(run, item)
    if not run.landing and not run.ending:
        run.ending = "it stays in the air there"
    words = {"px4": "PX4", "ardupilot": "ArduPilot"}[autopilot]
    points = tuple(run.points)
    if points:  # commands after the last point
        points = (*points[:-1], _stayed(points[-1], run))
    return checked(Waypoints(whole, "mavlink", points, words, autopilot, run.climb, run.landing, run.ending))


def _take(run: _ItemReader, item: FlightCommand) -> None:
    """Apply one item."""
    command, p = item.command, item.params
    if command in (WAYPOINT, SPLINE, LOITER_TIME):
        _pass(run, _point(item, straight=command != SPLINE))
        run.stay = max(p[0] or 0.0, 0.0) if command != SPLINE else 0.0
    elif command == TAKEOFF:
        _level(item)
        run.climb = max(run.climb, p[6] or 0.0)
    elif command == LAND:
        run.landing = _landing(run, item)
    elif command == RETURN:
        run.ending = "it returns home at a height of its own settings"
    elif command == DELAY:
        run.stay += max(p[0] or 0.0, 0.0)
    else:
        _do(run, item)


def _do(run: _ItemReader, item: FlightCommand) -> None:
    """Apply an item that is not a place to fly to."""
    command, p = item.command, item.params
    if command in ASTRAY or command <= LAST_NAVIGATION_COMMAND:
        what = ASTRAY.get(command, "a way that no model here has")
        refuse(BROKEN, f"{item.name} is command {command}, {what}, which is not judged", item.node, WAYPOINTS)
    if command == SPEED:
        _speed(run, item)
    elif command in (GIMBAL, MOUNT) and p[0] is not None:
        run.pitches = (*run.pitches, p[0])


def _landing(run: _ItemReader, item: FlightCommand) -> FlightPoint | None:
    """Return the landing point: the item's place, or the last point if it has none."""
    p = item.params
    if p[4] is None or p[5] is None or (p[4], p[5]) == (0.0, 0.0):
        return run.points[-1] if run.points else None
    return _point(item._replace(params=(*p[:6], p[6] or 0.0)), straight=True)


def _pass(run: _ItemReader, point: FlightPoint) -> None:
    """Add a point. The speeds in force become the pace of the point before it."""
    if run.points:
        pace = run.pace if run.pace != Pace() else None
        run.points[-1] = _stayed(run.points[-1], run)._replace(pace=pace)
        run.pitches = ()
    run.points.append(point)


def _stayed(point: FlightPoint, run: _ItemReader) -> FlightPoint:
    return point._replace(stay=run.stay, stops=run.stay > 0.0, pitches=run.pitches)


def _speed(run: _ItemReader, item: FlightCommand) -> None:
    kind, value = item.params[0] or 0.0, item.params[1]
    if value is None or value <= 0.0:
        return
    if kind == CLIMB:
        run.pace = run.pace._replace(climb=value)
    elif kind == DESCENT:
        run.pace = run.pace._replace(descent=value)
    else:
        run.pace = run.pace._replace(ground=value)


def _level(item: FlightCommand) -> Level:
    if item.frame not in LEVELS:
        message = (
            f"{item.name} counts its height in frame {item.frame}, which nothing here ties to the ground"
        )
        refuse(HEIGHTS, message, item.node, "count heights from home (frame 3) or from sea level (frame 0)")
    return LEVELS[item.frame]


def _point(item: FlightCommand, *, straight: bool) -> FlightPoint:
    lat, lon, height = item.params[4:7]
    if lat is None or lon is None or height is None:
        refuse(
            BROKEN,
            f"{item.name} has no latitude, longitude and altitude",
            item.node,
            "write all three, or leave the item out",
        )
    placed(lat, lon, item.name, item.node)
    return FlightPoint(item.node, item.name, lat, lon, height, _level(item), straight=straight)
