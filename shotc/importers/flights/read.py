"""What a file of a flight is, by its name and its first line, and what it holds."""

from __future__ import annotations

from pathlib import PurePath
from typing import NamedTuple

from shotc.importers.cameras.takes import Refused
from shotc.importers.flights import items, litchi, wpml
from shotc.importers.flights.points import UNREADABLE, Unread, Waypoints, refuse
from shotc.importers.xml_tree import LARGEST, Node, shown

SUFFIXES = (".plan", ".waypoints", ".kmz", ".wpml", ".kml", ".csv")
"""Endings of names of flights, in small letters."""
LARGEST_BYTES = LARGEST
"""Bytes of the largest file that is read."""


class Read(NamedTuple):
    """A file that was read: what it holds or why not, and the text that its lines are of."""

    file: str
    found: Waypoints | Refused
    text: str


def is_flight(name: str) -> bool:
    """Tell whether a file of this name is one of a flight, and no plan.json."""
    return PurePath(name).suffix.lower() in SUFFIXES


def read(data: bytes, name: str) -> Read:
    """Read any bytes as the file of a flight that their name says.

    The lines of a ``.kmz`` are those of its waylines, and its name is shown with theirs.
    """
    suffix = PurePath(name).suffix.lower()
    text = ""
    try:
        if len(data) > LARGEST_BYTES:
            message = f"the file is larger than {LARGEST_BYTES / 1e6:.0f} MB"
            refuse(UNREADABLE, message, Node("", 1, 1, wide=1))
        if suffix in (".kmz", ".wpml", ".kml"):
            inside = wpml.text_of(data)
            text = shown(inside)
            name = name if inside is data else f"{name}/{wpml.WAYLINES}"
            return Read(name, wpml.waypoints(inside), text)
        text = shown(data)
        if suffix == ".plan":
            return Read(name, items.plan(data, name), text)
        if suffix == ".waypoints":
            return Read(name, items.table(text), text)
        return Read(name, litchi.waypoints(text), text)
    except Unread as stopped:
        return Read(name, stopped.refused, text)
