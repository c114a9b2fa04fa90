"""Read the map of an action, which shows its trajectory: KML in JSON in the text of an element."""

from __future__ import annotations

import json
from typing import NamedTuple

from shotc.importers.multidrone.read import ShootingAction, below
from shotc.importers.xml_tree import Node, XmlFault, parse_xml

MOST_COORDINATES = 1000  # most coordinates of a line


class MapLine(NamedTuple):
    """The line of a map. ``node``: the element that holds it; ``points``: (lat, lon) in degrees."""

    node: Node
    points: tuple[tuple[float, float], ...]


def drawn(action: ShootingAction) -> MapLine | None:
    """Return the first readable line of an action's maps, or None."""
    for holder in below(action.node, "Map"):
        node = holder.first("description")
        points = () if node is None else _line(node.text)
        if node is not None and points:
            return MapLine(node, points)
    return None


def _line(text: str) -> tuple[tuple[float, float], ...]:
    try:
        table = json.loads(text)
    except (ValueError, RecursionError):
        return ()
    kml = table.get("KML") if isinstance(table, dict) else None
    if not isinstance(kml, str):
        return ()
    root = parse_xml(kml.encode("utf-8", "replace"))
    if isinstance(root, XmlFault):
        return ()
    for line in below(root, "LineString"):
        words = line.value("coordinates").split()[:MOST_COORDINATES]
        points = [_place(word) for word in words]
        if points and all(points):
            return tuple(p for p in points if p is not None)
    return ()


def _place(word: str) -> tuple[float, float] | None:
    """Return (lat, lon) from ``lon,lat`` or ``lon,lat,altitude``, or None."""
    parts = word.split(",")
    try:
        lon, lat = float(parts[0]), float(parts[1])
    except (ValueError, IndexError):
        return None
    return (lat, lon) if abs(lat) <= 90 and abs(lon) <= 180 else None
