"""Litchi's table of 46 columns, one row for each waypoint: writing and reading."""

from __future__ import annotations

import csv
from dataclasses import replace
from io import StringIO
from math import ceil

from shotc.emit.waypoints.geo import GeoPosition
from shotc.emit.waypoints.route import PointAction, Waypoint
from shotc.ir.photos import Photos

MOST_POINTS = 99  # points of a block in Litchi
MOST_ACTIONS = 15  # actions at a point
LONGEST_STAY_S = 32.0  # seconds of one stay action
NONE, STAY, START, STOP = -1, 0, 2, 3
COLUMNS = (
    "latitude",
    "longitude",
    "altitude(m)",
    "heading(deg)",
    "curvesize(m)",
    "rotationdir",
    "gimbalmode",
    "gimbalpitchangle",
    *(f"action{what}{n}" for n in range(1, MOST_ACTIONS + 1) for what in ("type", "param")),
    "altitudemode",
    "speed(m/s)",
    "poi_latitude",
    "poi_longitude",
    "poi_altitude(m)",
    "poi_altitudemode",
    "photo_timeinterval",
    "photo_distinterval",
)


def write_table(points: list[Waypoint]) -> bytes:
    """Return the table's bytes; the same input gives the same bytes.

    Each point has its own heading (Heading Mode Custom), the pitch is interpolated, and heights count from
    take-off.
    """
    stream = StringIO()
    table = csv.writer(stream, lineterminator="\n")
    table.writerow(COLUMNS)
    photos: Photos | None = None
    for point in points:
        for action in point.actions:
            photos = action.photos if action.kind == "start" else None if action.kind == "stop" else photos
        table.writerow(_row(point, photos))
    return stream.getvalue().encode()


def read_table(data: bytes) -> list[Waypoint]:
    """Return the points of a table.

    The drone stops at both ends of the mission and at every point with an action.
    """
    rows = list(csv.DictReader(StringIO(data.decode())))
    points: list[Waypoint] = []
    photos: Photos | None = None
    for row in rows:
        before, photos = photos, _interval(row)
        point, turned = _waypoint(row), before != photos
        ended = [PointAction("stop", photos=before)] if turned and before else []
        begun = [PointAction("start", photos=photos)] if turned and photos else []
        points.append(replace(point, actions=(*ended, *point.actions, *begun)))
    last = len(points) - 1
    return [replace(p, stops=i in (0, last) or bool(p.actions)) for i, p in enumerate(points)]


def _row(point: Waypoint, photos: Photos | None) -> list[str]:
    place = point.place
    every = photos or Photos(-1.0, -1.0)
    actions = [pair for action in point.actions if not action.photos for pair in _pairs(action)]
    actions += [(NONE, 0)] * (MOST_ACTIONS - len(actions))
    return [
        f"{place.lat:.9f}",
        f"{place.lon:.9f}",
        f"{place.alt:.2f}",
        f"{round(point.heading % 360.0, 1) % 360.0:.1f}",
        f"{point.curve:.2f}",
        "0",
        "2",
        f"{point.pitch:.1f}",
        *(str(number) for pair in actions[:MOST_ACTIONS] for number in pair),
        "0",
        f"{point.speed:.2f}",
        *_focus(point.watched),
        *(f"{-1.0 if number is None else number:g}" for number in every),
    ]


def _focus(watched: GeoPosition | None) -> tuple[str, ...]:
    """Return the point of interest of a row, with its height above take-off; zeros if there is none."""
    if watched is None:
        return ("0", "0", "0", "0")
    return (f"{watched.lat:.9f}", f"{watched.lon:.9f}", f"{watched.alt:.2f}", "0")


def _interval(row: dict[str, str]) -> Photos | None:
    """Return the photos that begin or go on at a point, or None."""
    seconds, metres = float(row["photo_timeinterval"]), float(row["photo_distinterval"])
    if seconds <= 0 and metres <= 0:
        return None
    return Photos(seconds if seconds > 0 else None, metres if metres > 0 else None)


def _pairs(action: PointAction) -> list[tuple[int, int]]:
    """Return type and parameter of an action; a stay longer than LONGEST_STAY_S is divided into several."""
    if action.kind != "stay":
        return [(START if action.kind == "start" else STOP, 0)]
    count = ceil(action.seconds / LONGEST_STAY_S)
    return [(STAY, round(1000 * action.seconds / count))] * count


def _waypoint(row: dict[str, str]) -> Waypoint:
    heading = float(row["heading(deg)"])
    lat, lon, alt = (float(row[f"poi_{name}"]) for name in ("latitude", "longitude", "altitude(m)"))
    pairs = [(int(row[f"actiontype{n}"]), int(row[f"actionparam{n}"])) for n in range(1, MOST_ACTIONS + 1)]
    return Waypoint(
        GeoPosition(float(row["latitude"]), float(row["longitude"]), float(row["altitude(m)"])),
        heading - 360.0 if heading >= 180.0 else heading,
        float(row["gimbalpitchangle"]),
        float(row["speed(m/s)"]),
        stops=False,
        actions=tuple(_action(kind, value) for kind, value in pairs if kind != NONE),
        curve=float(row["curvesize(m)"]),
        watched=None if lat == lon == 0.0 else GeoPosition(lat, lon, alt),
    )


def _action(kind: int, value: int) -> PointAction:
    return (
        PointAction("stay", value / 1000)
        if kind == STAY
        else PointAction("start" if kind == START else "stop")
    )
