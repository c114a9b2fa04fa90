"""Words that importers share: the formats on the command line, safe names, remedies."""

from __future__ import annotations

import re

EXPORT_AGAIN = "export it whole from the program that made it"
"""For a file that breaks off or is damaged."""

CUT_IN_TWO = "cut it in two files"
"""For a file that is too large."""
LONGEST_NAME_CHARACTERS = 40
CAMERA_FORMATS = {
    "kml": "a tour of Google Earth",
    "blender-camera": "a camera of Blender",
    "qgc": "a plan of QGroundControl",
    "litchi": "a mission of Litchi",
}
"""Formats of files of cameras."""
SHOW_FORMAT = "show"
"""Format of drone shows, flown as recorded."""
FORMATS = ("multidrone", *CAMERA_FORMATS, SHOW_FORMAT)


def cut_into(most: int, what: str) -> str:
    """Return the remedy to cut a file that has too many of something."""
    return f"cut it into files of {most} {what} at most"


def safe_name(name: str, otherwise: str = "mission") -> str:
    """Return a name of letters, digits and `-`, or ``otherwise`` if none of these is left."""
    words = re.sub(r"[^A-Za-z0-9]+", "-", name).strip("-")[:LONGEST_NAME_CHARACTERS].strip("-")
    return words or otherwise
