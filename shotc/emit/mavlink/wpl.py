"""Text waypoints (``QGC WPL 110``) for ArduPilot: row 0 is home, and tabs separate the columns."""

from __future__ import annotations

from math import nan

from shotc.emit.mavlink.items import FRAME_GLOBAL, FRAME_MISSION, WAYPOINT, MissionItem
from shotc.emit.waypoints.geo import Geo

HEADER = "QGC WPL 110"


def write_waypoints(items: list[MissionItem], geo: Geo) -> bytes:
    """Return the file's bytes; the same input gives the same bytes.

    Raises ValueError if an item has an empty parameter, which this format cannot hold.
    """
    home = MissionItem(WAYPOINT, FRAME_GLOBAL, (0.0, 0.0, 0.0, 0.0, geo.home_lat, geo.home_lon, geo.home_alt))
    rows = [_row(n, item) for n, item in enumerate((home, *items))]
    return ("\n".join((HEADER, *rows)) + "\n").encode()


def read_waypoints(data: bytes) -> tuple[list[MissionItem], tuple[float, float, float]]:
    """Return the items after the home row, and home: latitude and longitude in degrees, metres above sea
    level.

    Raises ValueError if the file has another header.
    """
    header, *rows = data.decode().splitlines()
    if header != HEADER:
        raise ValueError(f"not a waypoint file: {header!r}")
    items: list[MissionItem] = []
    for row in rows:
        _, _, frame, command, *params = row.split("\t")
        items.append(MissionItem(int(command), int(frame), tuple(float(p) for p in params[:7])))
    lat, lon, alt = (nan if p is None else p for p in items[0].params[4:])
    return items[1:], (lat, lon, alt)


def _row(number: int, item: MissionItem) -> str:
    if any(p is None for p in item.params):
        raise ValueError(f"command {item.command}: this format has no empty parameters")
    params = [0.0 if p is None else p for p in item.params]
    decimals = 4 if item.frame == FRAME_MISSION else 9
    texts = [f"{p:.4f}" for p in params[:4]]
    texts += [f"{p:.{decimals}f}" for p in params[4:6]] + [f"{params[6]:.4f}"]
    current = 1 if number == 0 else 0
    return "\t".join([str(number), str(current), str(item.frame), str(item.command), *texts, "1"])
