"""File name extensions of flights, and the largest sizes of their files."""

from pathlib import PurePath

from shotc.importers.xml_tree import LARGEST_BYTES

WAYPOINTS = (".plan", ".waypoints", ".kmz", ".wpml", ".kml")
TABLE, SHOW, TABLES = ".csv", ".skyc", ".zip"
SUFFIXES = (*WAYPOINTS, TABLE, SHOW, TABLES)
"""File name extensions of flights, in lower case."""
LARGEST_CLOCKED_BYTES = 200_000_000
"""Largest size of a table, a show or an archive of tables, bytes. Waypoints have the size of other
importers."""


def suffix_of(name: str) -> str:
    """Return the extension of a file name, in lower case."""
    return PurePath(name).suffix.lower()


def is_flight(name: str) -> bool:
    """Return whether a file name is that of a flight, not of a plan.json."""
    return suffix_of(name) in SUFFIXES


def largest(name: str) -> int:
    """Return the largest size of a file with this name, bytes."""
    return LARGEST_BYTES if suffix_of(name) in WAYPOINTS else LARGEST_CLOCKED_BYTES
