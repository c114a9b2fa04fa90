"""Read a mission of Litchi from the table that its Hub exports. Heights are relative to the take-off.

Columns: litchiutilities.com/docs/litchiCsv.php. Litchi turns the camera evenly between waypoints, so each
waypoint becomes a keyframe. Curve sizes are not read, because a plan passes through its keyframes.
"""

from __future__ import annotations

from collections.abc import Iterator

from shotc.importers.cameras.places import aim, is_place, origin_at, reached, without_far, world
from shotc.importers.cameras.table import TableRow, table_of
from shotc.importers.cameras.takes import (
    MOST_CAMERAS,
    ImportedCamera,
    ImportedTakes,
    ImportOptions,
    Refused,
    recorded,
)
from shotc.importers.notes import Notes
from shotc.importers.words import cut_into
from shotc.ir.mission import GeoOrigin

EXAMPLE = "latitude,longitude,altitude(m),heading(deg),...,gimbalmode,gimbalpitchangle,..."
PLACES = "give each row numbers in the columns `latitude` and `longitude`"
FOOT_M = 0.3048
ACTIONS = range(1, 16)
STAY, START, STOP, TILT = 0, 2, 3, 5
FOCUS_GIMBAL_MODE = 1
"""Gimbal mode in which the camera follows the point of interest."""


def footage(text: str, options: ImportOptions, notes: Notes) -> ImportedTakes | Refused:
    """Return the takes of a Litchi mission: the recorded parts, or all of it if nothing is recorded."""
    height = ("altitude(m)", "altitude(ft)")
    table = table_of(text, [("latitude",), ("longitude",), height, ("heading(deg)",)], EXAMPLE)
    if isinstance(table, Refused):
        return table
    if len(table.rows) > MOST_CAMERAS:
        message = f"it has {len(table.rows)} waypoints; at most {MOST_CAMERAS} are read"
        return Refused("I001", message, table.rows[MOST_CAMERAS].node, cut_into(MOST_CAMERAS, "waypoints"))
    rows = [row for row in table.rows if _is_placed(row, notes)]
    if not rows:
        return Refused("I003", "it holds no waypoint that says where it is", table.node, PLACES)
    origin = origin_at(
        rows[0].number("latitude", notes) or 0.0,
        rows[0].number("longitude", notes) or 0.0,
        options.ground or 0.0,
    )
    feet = height[0] not in table.heads
    if options.ground is None:
        message = "heights count from the take-off, whose altitude the file does not have"
        notes.assume(table.node, message, "flat ground at sea level; `--ground` is its altitude")
    if any(row.number("altitudemode", Notes()) == 1 for row in rows):
        notes.assume(table.heads["altitudemode"], "heights over the ground", "the ground is flat")
    if any((row.number("curvesize(m)", Notes()) or row.number("curvesize(ft)", Notes())) for row in rows):
        message = "Litchi cuts the corners of waypoints with a curve size"
        notes.assume(table.node, message, "the camera passes through all of them")
    unheard = Notes()
    cameras = list(_cameras(rows, origin, notes, feet=feet))
    kinds = [{kind for kind, _ in actions_of(row, unheard)} for row in rows]
    if any(row.number("speed(m/s)", unheard) or row.number("speed(ft/s)", unheard) for row in rows):
        notes.assume(table.node, "speeds of waypoints are not read", "the drone goes at its own pace")
    takes = recorded(table.node, cameras, [START in tags for tags in kinds], [STOP in tags for tags in kinds])
    return ImportedTakes(table.node, without_far(takes, notes), origin)


def _is_placed(row: TableRow, notes: Notes) -> bool:
    lat, lon = row.number("latitude", notes), row.number("longitude", notes)
    if is_place(lat, lon):
        return True
    notes.assume(row.node, "a waypoint without a latitude and a longitude", "it is left out")
    return False


def _cameras(
    rows: list[TableRow], origin: GeoOrigin, notes: Notes, *, feet: bool
) -> Iterator[ImportedCamera]:
    pitch = 0.0
    for row in rows:
        unit = FOOT_M if feet else 1.0
        height = row.number("altitude(ft)" if feet else "altitude(m)", notes)
        if height is None:
            notes.assume(row.node, "a waypoint without an altitude", "0 m")
        place = (row.number("latitude", notes) or 0.0, row.number("longitude", notes) or 0.0)
        at = world(origin, *place, unit * (height or 0.0), absolute=False)
        mode, angle = row.number("gimbalmode", notes), row.number("gimbalpitchangle", notes)
        tilted = [value for kind, value in actions_of(row, notes) if kind == TILT]
        if mode is not None and mode > 0 and angle is not None:
            pitch = angle
        pitch = tilted[-1] if tilted else pitch
        heading = row.number("heading(deg)", notes)
        if heading is None:
            notes.assume(row.node, "a waypoint without a heading", "0 deg, North")
        hold = sum(value for kind, value in actions_of(row, notes) if kind == STAY) / 1000.0
        focus = _focus(row, origin, notes, feet=feet)
        if focus is None or mode != FOCUS_GIMBAL_MODE:
            reach = reached(row.cells.get("gimbalpitchangle", row.node), pitch, notes)
            yield ImportedCamera(row.node, at, (heading or 0.0) % 360.0, reach, hold=max(0.0, hold))
        else:
            bearing, tilt = aim(at, focus)
            reached(row.node, tilt, notes)
            yield ImportedCamera(row.node, at, bearing, tilt, hold=max(0.0, hold), look_at=focus)


def _focus(
    row: TableRow, origin: GeoOrigin, notes: Notes, *, feet: bool
) -> tuple[float, float, float] | None:
    """Return a waypoint's point of interest, None if it has none, written (0, 0)."""
    lat, lon = row.number("poi_latitude", notes), row.number("poi_longitude", notes)
    if not is_place(lat, lon) or lat is None or lon is None or (lat == 0.0 and lon == 0.0):
        return None
    height = row.number("poi_altitude(ft)" if feet else "poi_altitude(m)", notes) or 0.0
    return world(origin, lat, lon, height * (FOOT_M if feet else 1.0), absolute=False)


def actions_of(row: TableRow, notes: Notes) -> Iterator[tuple[int, float]]:
    """Yield the actions at a waypoint: their numbers and parameters."""
    for i in ACTIONS:
        kind = row.number(f"actiontype{i}", notes)
        if kind is not None and kind >= 0:
            yield int(kind), row.number(f"actionparam{i}", notes) or 0.0
