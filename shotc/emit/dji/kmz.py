"""The ``.kmz`` container: written in the form that DJI's apps accept, read back by local element names."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from dataclasses import replace
from io import BytesIO
from zipfile import ZIP_DEFLATED, ZipFile, ZipInfo

from shotc.emit.dji.wpml import KML, PASS, WpmlMission, profile_of
from shotc.emit.waypoints.geo import GeoPosition
from shotc.emit.waypoints.link import NOTHING
from shotc.emit.waypoints.route import PointAction, Waypoint
from shotc.ir.drone import Drone
from shotc.ir.photos import Photos

TEMPLATE, WAYLINES = "wpmz/template.kml", "wpmz/waylines.wpml"
MOST_POINTS = 200  # waypoints of a mission in DJI Fly
_KINDS = {"startRecord": "start", "stopRecord": "stop", "hover": "stay", "zoom": "zoom"}
_INTERVALS = {
    "multipleTiming": lambda every: Photos(seconds=every),
    "multipleDistance": lambda every: Photos(metres=every),
}


def write_kmz(points: list[Waypoint], drone: Drone) -> bytes:
    """Return the file's bytes; the same input gives the same bytes.

    The archive holds two files and no folder entries: the apps find no waypoints in an archive with folder
    entries.
    """
    document = WpmlMission(points, profile_of(drone), drone.safety or NOTHING)
    ET.register_namespace("", KML)
    ET.register_namespace("wpml", document.profile.namespace)
    stream = BytesIO()
    with ZipFile(stream, "w") as archive:
        for name, data in ((TEMPLATE, document.template()), (WAYLINES, document.waylines())):
            archive.writestr(ZipInfo(name), data, ZIP_DEFLATED)
    return stream.getvalue()


def read_kmz(data: bytes) -> list[Waypoint]:
    """Return the points of a mission that shotc wrote; ``curve`` is 0, because these machines pass through
    points.
    """
    with ZipFile(BytesIO(data)) as archive:
        root = ET.fromstring(archive.read(WAYLINES))
    points = [_waypoint(mark) for mark in root.iter() if _local(mark) == "Placemark"]
    for group in (each for each in root.iter() if _local(each) == "actionGroup"):
        trigger = _text(group, "actionTriggerType")
        if trigger in _INTERVALS:
            photos = _INTERVALS[trigger](float(_text(group, "actionTriggerParam")))
            first, last = (int(_text(group, f"actionGroup{end}Index")) for end in ("Start", "End"))
            start, stop = (PointAction(kind, photos=photos) for kind in ("start", "stop"))
            points[first] = replace(points[first], actions=(*points[first].actions, start))
            points[last] = replace(points[last], actions=(stop, *points[last].actions))
    return points


def _waypoint(mark: ET.Element) -> Waypoint:
    lon, lat = (float(part) for part in _text(mark, "coordinates").split(","))
    return Waypoint(
        GeoPosition(lat, lon, float(_text(mark, "executeHeight"))),
        float(_text(mark, "waypointHeadingAngle")),
        float(_text(mark, "waypointGimbalPitchAngle")),
        float(_text(mark, "waypointSpeed")),
        _text(mark, "waypointTurnMode") != PASS,
        tuple(_action(each) for each in mark.iter() if _local(each) == "action" and _kind(each) in _KINDS),
    )


def _kind(action: ET.Element) -> str:
    return _text(action, "actionActuatorFunc")


def _action(action: ET.Element) -> PointAction:
    kind = _KINDS[_kind(action)]
    if kind == "stay":
        return PointAction("stay", float(_text(action, "hoverTime")))
    if kind == "zoom":
        return PointAction("zoom", focal=float(_text(action, "focalLength")))
    return PointAction("start" if kind == "start" else "stop")


def _text(parent: ET.Element, name: str) -> str:
    return next(each.text or "" for each in parent.iter() if _local(each) == name)


def _local(element: ET.Element) -> str:
    return element.tag.rpartition("}")[2]
