"""Read the file of a flight. Its name and its first line give the format."""

from __future__ import annotations

from typing import NamedTuple

from shotc.importers.cameras.takes import Refused
from shotc.importers.flights import items, litchi, skyc, wpml, zipped
from shotc.importers.flights.endings import SHOW, TABLE, TABLES, largest, suffix_of
from shotc.importers.flights.points import UNREADABLE, Unread, Waypoints, refuse
from shotc.importers.flights.rows import DroneRows, rows
from shotc.importers.words import CUT_IN_TWO
from shotc.importers.xml_tree import Node, readable_text

Found = Waypoints | tuple[DroneRows, ...] | skyc.SkycShow


class Read(NamedTuple):
    """A file that was read: its content or why it is refused, and the text for line numbers in messages."""

    file: str
    content: Found | Refused
    text: str


def read(data: bytes, name: str) -> Read:
    """Read any bytes as the file of a flight, in the format that the name gives.

    Messages about a ``.kmz`` refer to the lines and the name of its waylines; those about a ``.zip`` to the
    refused table. A table is Litchi's if its first line has a latitude.
    """
    suffix = suffix_of(name)
    text = ""
    try:
        if len(data) > largest(name):
            message = f"the file is larger than {largest(name) / 1e6:.0f} MB"
            refuse(UNREADABLE, message, Node("", 1, 1, wide=1), CUT_IN_TWO)
        if suffix == SHOW:
            return Read(name, skyc.show(data), "")
        if suffix == TABLES:
            return Read(name, zipped.tables(data), "")
        if suffix in (".kmz", ".wpml", ".kml"):
            inside = wpml.text_of(data)
            text = readable_text(inside)
            name = name if inside is data else f"{name}/{wpml.WAYLINES}"
            return Read(name, wpml.waypoints(inside), text)
        text = readable_text(data)
        if suffix == TABLE:
            head = text.partition("\n")[0]
            return Read(name, litchi.waypoints(text) if "latitude" in head else rows(text), text)
        return Read(name, items.plan(data, name) if suffix == ".plan" else items.table(text), text)
    except zipped.UnreadMember as stopped:
        return Read(f"{name}/{stopped.member}", stopped.refused, stopped.text)
    except Unread as stopped:
        return Read(name, stopped.refused, text)
