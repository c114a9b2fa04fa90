"""The names of the importable formats on the command line."""

WHAT = {
    "kml": "a tour of Google Earth",
    "blender-camera": "a camera of Blender",
    "qgc": "a plan of QGroundControl",
    "litchi": "a mission of Litchi",
}
"""Formats of files of cameras."""
SHOWS = "show"
"""Format of drone shows, flown as recorded."""
FORMATS = ("multidrone", *WHAT, SHOWS)
