"""Read KML or KMZ of Google Earth: tours (``gx:Tour``) of cameras, or the cameras of placemarks.

Format: developers.google.com/kml/documentation/touring and .../cameras. Names are compared without their
prefixes. A ``LookAt`` is a camera that looks at a place from the distance ``range``.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import cos, radians, sin
from statistics import median
from typing import NamedTuple

from shotc.geom.vec import Vec3
from shotc.importers.archive import MAGIC, ArchiveFault, member
from shotc.importers.cameras.places import (
    clamped_hfov,
    is_place,
    level,
    number,
    origin_at,
    reached,
    without_far,
    world,
)
from shotc.importers.cameras.takes import (
    MOST_CAMERAS,
    ImportedCamera,
    ImportedTakes,
    ImportOptions,
    Refused,
    Take,
)
from shotc.importers.notes import Notes, plain
from shotc.importers.words import cut_into
from shotc.importers.xml_tree import LARGEST_BYTES, Node, XmlFault
from shotc.ir.mission import GeoOrigin

OVER_GROUND_M = 10.0
"""Assumed height of the lowest camera above the ground if the ground's altitude is unknown, metres."""
USUAL_HFOV_DEG = 60.0
"""Google Earth's field of view for a camera without one, degrees."""
GROUND_MODES = ("relativeToGround", "clampToGround", "relativeToSeaFloor", "clampToSeaFloor")
SILENT = {"TourControl": "a pause", "SoundCue": "a sound", "AnimatedUpdate": "an update of the map"}


class KmlView(NamedTuple):
    """A camera as the file describes it.

    place    : latitude, longitude (degrees) and altitude (metres) of the camera, or of the place it looks at
    absolute : whether the altitude is above sea level, not above ground
    tilt     : degrees, 0 is straight down
    range    : distance to the place it looks at, metres; 0 for a Camera
    """

    node: Node
    place: Vec3
    absolute: bool
    heading: float
    tilt: float
    range: float
    hfov: float | None
    time: float | None = None
    hold: float = 0.0


def unpacked(data: bytes) -> bytes | XmlFault:
    """Return the KML in a file: the first document of a KMZ, or the bytes themselves."""
    if not data.startswith(MAGIC):
        return data
    document = member(data, lambda name: name.lower().endswith(".kml"), "a KML document", LARGEST_BYTES)
    return XmlFault(*document) if isinstance(document, ArchiveFault) else document


def footage(root: Node, options: ImportOptions, notes: Notes) -> ImportedTakes | Refused:
    """Return the takes of a KML document."""
    if local(root) != "kml":
        return Refused("I002", f"it is no KML: its root is `{plain(root.tag, 30)}`", root, KML)
    tours = [node for node in root.everything() if local(node) == "Tour"]
    toured = [(tour, list(_tour(tour, notes))) for tour in tours]
    if not tours:
        views = [view for node in _marked(root) if (view := _view(node, notes)) is not None]
        toured = [(root, views)]
        if views:
            message = "the file has no tour, but placemarks with cameras"
            notes.assume(root, message, "one shot through all of them, in their order")
    views = [view for _, some in toured for view in some]
    if len(views) > MOST_CAMERAS:
        message = f"it has {len(views)} cameras; at most {MOST_CAMERAS} are read"
        return Refused("I001", message, views[MOST_CAMERAS].node, cut_into(MOST_CAMERAS, "cameras"))
    if not views:
        return Refused("I003", "it holds no camera that says where it is", root, RECORD)
    _lens(views, notes)
    ground = _ground(views, options, notes)
    if isinstance(ground, Refused):
        return ground
    origin = origin_at(median(v.place[0] for v in views), median(v.place[1] for v in views), ground)
    takes = [
        Take(_name(tour), tour, tuple(_camera(view, origin, notes) for view in some)) for tour, some in toured
    ]
    return ImportedTakes(root, without_far(takes, notes), origin)


KML = "give a `.kml` or `.kmz`, whose root is `kml`"
RECORD = (
    "record a tour in Google Earth, or save placemarks with their views (Camera or LookAt), and import that"
)


def local(node: Node) -> str:
    """Return an element's name without its prefix."""
    return node.tag.rpartition(":")[2]


def child(node: Node, *names: str) -> Node | None:
    """Return the first child of one of these names, or None."""
    return next((inner for inner in node.children if local(inner) in names), None)


def _name(tour: Node) -> str:
    name = child(tour, "name")
    return "" if name is None or local(tour) != "Tour" else name.text.strip()


def _marked(root: Node) -> Iterator[Node]:
    """Yield the cameras of placemarks."""
    for mark in root.everything():
        if local(mark) == "Placemark" and (view := child(mark, "Camera", "LookAt")) is not None:
            yield view


def _tour(tour: Node, notes: Notes) -> Iterator[KmlView]:
    """Yield the cameras of a tour with their times since the first one, seconds."""
    last: KmlView | None = None
    time = 0.0
    steps = [
        step for playlist in tour.children if local(playlist) == "Playlist" for step in playlist.children
    ]
    for step in steps:
        kind = local(step)
        seconds = _seconds(step, notes)
        if kind == "Wait" and last is not None:
            last = last._replace(hold=last.hold + seconds)
            time += seconds
        elif kind == "FlyTo":
            view = child(step, "Camera", "LookAt")
            camera = None if view is None else _view(view, notes)
            if camera is None:
                notes.assume(step, "a flight to no camera", "it is left out")
                continue
            if last is not None:
                yield last
                time += seconds
                if (mode := child(step, "flyToMode")) is None or mode.text.strip() != "smooth":
                    notes.assume(step, "a flight that bounces", "the camera goes straight there")
            last = camera._replace(time=time)
        elif kind in SILENT:
            notes.assume(step, f"{SILENT[kind]} in the tour", "it is left out")
    if last is not None:
        yield last


def _seconds(step: Node, notes: Notes) -> float:
    node = child(step, "duration")
    if node is None:
        return 0.0
    value = number(node.text.strip())
    if value is None or value < 0.0:
        notes.assume(node, f"`{plain(node.text.strip(), 20)}` is no duration", "0 s")
        return 0.0
    return value


def _view(node: Node, notes: Notes) -> KmlView | None:
    """Return a Camera or a LookAt, None if it has no position."""
    lat, lon = _number(node, "latitude", None, notes), _number(node, "longitude", None, notes)
    if lat is None or lon is None or not is_place(lat, lon):
        notes.assume(node, "a camera without a latitude and a longitude", "it is left out")
        return None
    alt = _number(node, "altitude", 0.0, notes) or 0.0
    mode_node = child(node, "altitudeMode")
    mode = mode_node.text.strip() if mode_node is not None else "clampToGround"
    if mode != "absolute" and mode not in GROUND_MODES:
        notes.assume(
            mode_node or node,
            f"an altitude mode `{plain(mode, 30)}` that KML does not have",
            "relativeToGround",
        )
    if mode.startswith("clamp"):
        if alt > 0.0 and local(node) == "Camera":
            message = f"a camera {alt:g} m high that is clamped to the ground"
            notes.assume(mode_node or node, message, "its altitude counts from the ground")
        else:
            alt = 0.0
    far = (_number(node, "range", 0.0, notes) or 0.0) if local(node) == "LookAt" else 0.0
    tilt = _number(node, "tilt", 0.0, notes) or 0.0
    level(node, _number(node, "roll", 0.0, notes) or 0.0, notes)
    return KmlView(
        node=node,
        place=(lat, (lon + 180.0) % 360.0 - 180.0, alt),
        absolute=mode == "absolute",
        heading=(_number(node, "heading", 0.0, notes) or 0.0) % 360.0,
        tilt=tilt,
        range=max(far, 0.0),
        hfov=_number(node, "horizFov", None, notes),
    )


def _number(node: Node, tag: str, otherwise: float | None, notes: Notes) -> float | None:
    field = child(node, tag)
    if field is None:
        return otherwise
    value = number(field.text.strip())
    if value is None:
        default = "left out" if otherwise is None else f"{otherwise:g}"
        notes.assume(field, f"`{plain(field.text.strip(), 20)}` is no number", default)
        return otherwise
    return value


def _lens(views: list[KmlView], notes: Notes) -> None:
    bare = [view for view in views if view.hfov is None]
    if bare:
        message = f"{len(bare)} of {len(views)} cameras have no field of view"
        notes.assume(bare[0].node, message, f"{USUAL_HFOV_DEG:g} deg, as Google Earth does")


def _ground(views: list[KmlView], options: ImportOptions, notes: Notes) -> float | Refused:
    """Return the altitude of the ground (the plane z = 0) above sea level, metres."""
    absolute = [view for view in views if view.absolute]
    if options.ground is not None:
        return options.ground
    if not absolute:
        message = "heights count from the ground, whose altitude the file does not have"
        notes.assume(views[0].node, message, "flat ground at sea level; `--ground` is its altitude")
        return 0.0
    if len(absolute) < len(views):
        other = next(view for view in views if not view.absolute)
        message = "some cameras count from sea level, this one from ground of unknown altitude"
        return Refused("I007", message, other.node, "give the altitude of the ground: `--ground METRES`")
    low = min(view.place[2] + view.range * cos(radians(view.tilt)) for view in views)
    message = "altitudes count from sea level, and the file does not say how high the ground is"
    taken = f"flat ground {OVER_GROUND_M:g} m below the lowest camera; `--ground` is its altitude"
    notes.assume(views[0].node, message, taken)
    return low - OVER_GROUND_M


def _camera(view: KmlView, origin: GeoOrigin, notes: Notes) -> ImportedCamera:
    x, y, z = world(origin, *view.place, absolute=view.absolute)
    heading, tilt = radians(view.heading), radians(view.tilt)
    back = view.range * sin(tilt)
    at = (x - back * sin(heading), y - back * cos(heading), z + view.range * cos(tilt))
    pitch = reached(view.node, view.tilt - 90.0, notes)
    hfov = USUAL_HFOV_DEG if view.hfov is None else clamped_hfov(view.hfov)
    return ImportedCamera(view.node, at, view.heading, pitch, hfov, view.time, view.hold)
