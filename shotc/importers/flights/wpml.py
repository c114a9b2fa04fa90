"""Read DJI WPML: the ``waylines.wpml`` of a ``.kmz``, which the drone flies.

Elements: developer.dji.com, Cloud API, "DJI WPML". Names are compared without their prefixes.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from shotc.importers.archive import MAGIC, ArchiveFault, member
from shotc.importers.cameras.kml import local
from shotc.importers.flights.points import (
    BROKEN,
    FOREIGN,
    HEIGHTS,
    UNREADABLE,
    FlightPoint,
    Level,
    Pace,
    Waypoints,
    checked,
    finite,
    placed,
    refuse,
)
from shotc.importers.notes import plain
from shotc.importers.xml_tree import LARGEST_BYTES, Node, XmlFault, parse_xml

WAYLINES = "wpmz/waylines.wpml"
NAMESPACE = re.compile(r"http://www\.(uav|dji)\.com/wpmz/1\.0\.[0-6]")
"""Accepted versions. They do not differ in the elements that this module reads."""
OWN = "export the mission again from DJI Fly, DJI Pilot 2 or FlightHub"
COORDINATES = "write `<coordinates>LONGITUDE,LATITUDE</coordinates>` in its `Point`"
HEIGHT = "write its height over the take-off, `<wpml:executeHeight>METRES</wpml:executeHeight>`"
STOPS = "toPointAndStop"
STRAIGHT = ("toPointAndStopWithDiscontinuityCurvature", "coordinateTurn")
LEVELS: dict[str, Level] = {"relativeToStartPoint": "home"}
ENDINGS = {
    "autoLand": "",
    "noAction": "it stays in the air there",
    "goHome": "it returns home at a height of its own settings",
    "gotoFirstWaypoint": "it goes back to its first waypoint",
}

MEANT = ", or ".join(f"`{name}`" for name in ENDINGS)


def text_of(data: bytes) -> bytes:
    """Return the XML of a file; for a ``.kmz``, that of its waylines."""
    if not data.startswith(MAGIC):
        return data
    inside = member(data, lambda name: name.lower().endswith(".wpml"), f"`{WAYLINES}`", LARGEST_BYTES)
    if isinstance(inside, ArchiveFault):
        refuse(UNREADABLE, inside.message, Node("", 1, 1, wide=1), inside.help)
    return inside


def waypoints(data: bytes) -> Waypoints:
    """Return the points of a wayline from the XML that ``text_of`` returns."""
    root = parse_xml(data)
    if isinstance(root, XmlFault):
        refuse(UNREADABLE, root.message, Node("", root.line, root.column, wide=1), root.help)
    _version(root)
    folders = [node for node in root.everything() if local(node) == "Folder"]
    if len(folders) != 1:
        message = f"it has {len(folders)} waylines in folders, and one is flown"
        refuse(FOREIGN, message, folders[1] if folders else root, "give each wayline a file of its own")
    folder = folders[0]
    mode = _inner(folder, "executeHeightMode")
    if mode is None or mode.text.strip() not in LEVELS:
        said = "nothing" if mode is None else f"`{plain(mode.text.strip(), 30)}`"
        message = f"heights count by {said} (`executeHeightMode`), which nothing here ties to the ground"
        refuse(HEIGHTS, message, mode or folder, "plan it relative to the take-off (relativeToStartPoint)")
    usual = _number(folder, "autoFlightSpeed")
    marks = [node for node in folder.children if local(node) == "Placemark"]
    points = tuple(_point(mark, i, usual) for i, mark in enumerate(marks))
    ending = _inner(root, "finishAction")
    what = "noAction" if ending is None else ending.text.strip()
    if what not in ENDINGS:
        refuse(
            BROKEN,
            f"`{plain(what, 30)}` is no `finishAction`",
            ending or root,
            f"write {MEANT}",
        )
    return checked(
        Waypoints(
            root,
            "dji",
            points,
            "a machine of DJI",
            climb=max(_number(root, "takeOffSecurityHeight") or 0.0, 0.0),
            landing=points[-1] if points and what == "autoLand" else None,
            ending=ENDINGS[what],
        )
    )


def _version(root: Node) -> None:
    """Refuse a document that is no WPML, or has an unknown version."""
    spaces = [
        value
        for node in root.everything()
        for key, value in node.attributes.items()
        if key.startswith("xmlns")
    ]
    own = next((space for space in spaces if "wpmz" in space), None)
    if local(root) != "kml" or own is None:
        message = "it is no WPML: it has no root `kml` with the namespace of `wpmz`"
        refuse(FOREIGN, message, root, OWN)
    if not NAMESPACE.fullmatch(own):
        message = f"it is WPML of another version, `{plain(own, 60)}`; 1.0.0 to 1.0.6 are read"
        refuse(FOREIGN, message, root, OWN)


def _point(mark: Node, index: int, usual: float | None) -> FlightPoint:
    name = f"waypoint {index + 1}"
    where = _inner(mark, "coordinates")
    parts = [] if where is None else where.text.strip().split(",")
    if where is None or len(parts) < 2:
        refuse(BROKEN, f"{name} has no `coordinates`, longitude and latitude", where or mark, COORDINATES)
    lon, lat = (finite(part.strip(), f"a coordinate of {name}", where) for part in parts[:2])
    placed(lat, lon, name, where)
    height = _number(mark, "executeHeight")
    if height is None:
        refuse(BROKEN, f"{name} has no `executeHeight`", mark, HEIGHT)
    speed = _number(mark, "waypointSpeed")
    speed = usual if speed is None else speed
    mode = _inner(mark, "waypointTurnMode")
    turn = "" if mode is None else mode.text.strip()
    straight = (_number(mark, "useStraightLine") or 0.0) > 0.0 or turn in STRAIGHT
    return FlightPoint(
        where,
        name,
        lat,
        lon,
        height,
        "home",
        pace=Pace(along=speed) if speed is not None and speed > 0.0 else None,
        stops=turn.startswith(STOPS),
        stay=max(sum(_numbers(mark, "hoverTime")), 0.0),
        curve=max(_number(mark, "waypointTurnDampingDist") or 0.0, 0.0),
        straight=straight,
        pitches=tuple(_pitches(mark)),
    )


def _pitches(mark: Node) -> Iterator[float]:
    for tag in ("waypointGimbalPitchAngle", "gimbalPitchRotateAngle"):
        yield from _numbers(mark, tag)


def _inner(node: Node, tag: str) -> Node | None:
    return next((inner for inner in node.everything() if local(inner) == tag), None)


def _number(node: Node, tag: str) -> float | None:
    return next(_numbers(node, tag), None)


def _numbers(node: Node, tag: str) -> Iterator[float]:
    for inner in node.everything():
        if local(inner) == tag:
            yield finite(inner.text.strip(), f"`{tag}`", inner)
