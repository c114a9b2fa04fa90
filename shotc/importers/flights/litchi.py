"""Read the table of Litchi's Hub as a flight."""

from __future__ import annotations

from shotc.importers.cameras.litchi import EXAMPLE, FOOT_M, STAY, actions_of
from shotc.importers.cameras.table import TableRow, table_of
from shotc.importers.cameras.takes import Refused
from shotc.importers.flights.points import (
    BROKEN,
    FOREIGN,
    UNREADABLE,
    FlightPoint,
    Level,
    Pace,
    Unread,
    Waypoints,
    checked,
    placed,
    refuse,
)
from shotc.importers.notes import Note, Notes

HEIGHT, SPEED, CURVE = "altitude", "speed", "curvesize"
PACES = {SPEED: "m/s", HEIGHT: "m", CURVE: "m"}
FEET = {SPEED: "ft/s", HEIGHT: "ft", CURVE: "ft"}


def waypoints(text: str) -> Waypoints:
    """Return the points of a mission; raise Unread with the fault of a file that is no such table."""
    heights = (f"{HEIGHT}(m)", f"{HEIGHT}(ft)")
    table = table_of(text, [("latitude",), ("longitude",), heights, ("heading(deg)",)], EXAMPLE)
    if isinstance(table, Refused):
        code = FOREIGN if table.code == "I002" else UNREADABLE
        raise Unread(table._replace(code=code))
    units = PACES if heights[0] in table.heads else FEET
    points = tuple(_point(row, i, units) for i, row in enumerate(table.rows))
    return checked(Waypoints(table.node, "litchi", points, "Litchi", ending=_ENDING))


_ENDING = "it does what the mission's settings in Litchi say, which the table does not hold"


def _point(row: TableRow, index: int, units: dict[str, str]) -> FlightPoint:
    name, notes = f"waypoint {index + 1}", Notes()
    foot = 1.0 if units is PACES else FOOT_M
    lat, lon = (_needed(row, column, name, notes) for column in ("latitude", "longitude"))
    placed(lat, lon, name, row.node)
    height = foot * _needed(row, f"{HEIGHT}({units[HEIGHT]})", name, notes)
    speed = foot * (row.number(f"{SPEED}({units[SPEED]})", notes) or 0.0)
    curve = foot * (row.number(f"{CURVE}({units[CURVE]})", notes) or 0.0)
    pitch = row.number("gimbalpitchangle", notes) if row.number("gimbalmode", notes) else None
    level: Level = "ground" if row.number("altitudemode", notes) == 1 else "home"
    actions = list(actions_of(row, notes))
    wrong: Note | None = next(iter(notes.assumptions), None)
    if wrong is not None:
        refuse(BROKEN, f"{wrong.message} of {name}", wrong.node, "write a number there")
    return FlightPoint(
        row.node,
        name,
        lat,
        lon,
        height,
        level,
        pace=Pace(along=speed) if speed > 0.0 else None,
        stops=bool(actions),
        stay=sum(max(value, 0.0) for kind, value in actions if kind == STAY) / 1000.0,
        curve=max(curve, 0.0),
        pitches=() if pitch is None else (pitch,),
    )


def _needed(row: TableRow, column: str, name: str, notes: Notes) -> float:
    value = row.number(column, notes)
    if value is None:
        cell = row.cells.get(column, row.node)
        refuse(BROKEN, f"{name} has no number in its column `{column}`", cell, "write a number there")
    return value
