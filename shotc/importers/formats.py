"""What is imported, by the names of the command line."""

WHAT = {
    "kml": "a tour of Google Earth",
    "blender-camera": "a camera of Blender",
    "qgc": "a plan of QGroundControl",
    "litchi": "a mission of Litchi",
}
"""Files of cameras."""
SHOWS = "show"
"""Shows of drones, flown as recorded."""
FORMATS = ("multidrone", *WHAT, SHOWS)
