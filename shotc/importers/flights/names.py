"""Which names files of flights have, and how large they may be."""

from pathlib import PurePath

from shotc.importers.xml_tree import LARGEST

WAYPOINTS = (".plan", ".waypoints", ".kmz", ".wpml", ".kml")
TABLE, SHOW, TABLES = ".csv", ".skyc", ".zip"
SUFFIXES = (*WAYPOINTS, TABLE, SHOW, TABLES)
"""Endings of names of flights, in small letters."""
LARGEST_CLOCKED = 200_000_000
"""Bytes of the largest table or show, and of an archive of tables; of waypoints that of other importers."""


def suffix_of(name: str) -> str:
    """Return the ending of a name, in small letters."""
    return PurePath(name).suffix.lower()


def is_flight(name: str) -> bool:
    """Return whether a file of this name is one of a flight, and no plan.json."""
    return suffix_of(name) in SUFFIXES


def largest(name: str) -> int:
    """Return how many bytes of a file are read."""
    return LARGEST if suffix_of(name) in WAYPOINTS else LARGEST_CLOCKED
