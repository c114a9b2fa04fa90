"""QGroundControl ``.plan`` files: written in the form that its loader demands, and read back."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Any

from shotc.emit.mavlink.fence import Fence
from shotc.emit.mavlink.items import FRAME_RELATIVE, POSITION_COMMANDS, MissionItem
from shotc.emit.waypoints.geo import Geo, GeoPosition

QUADROTOR = 2
CRUISE_M_S = 15  # m/s; the loader demands a number, a multirotor never uses it
RELATIVE_ALTITUDE_MODE = 1  # altitude mode: relative to home


def write_plan(
    items: list[MissionItem],
    geo: Geo,
    fence: Fence,
    firmware: int,
    hover_speed: float,
    rally: Sequence[GeoPosition] = (),
) -> bytes:
    """Return the plan's bytes; the same input gives the same bytes.

    firmware : MAV_AUTOPILOT
    hover_speed : m/s, only displayed by the ground station
    rally : places where the vehicle may land instead of at home, with the height of its arrival
    """
    mission = {
        "version": 2,
        "firmwareType": firmware,
        "vehicleType": QUADROTOR,
        "cruiseSpeed": CRUISE_M_S,
        "hoverSpeed": _number(hover_speed),
        "globalPlanAltitudeMode": RELATIVE_ALTITUDE_MODE,
        "plannedHomePosition": [geo.home_lat, geo.home_lon, geo.home_alt],
        "items": "@items",
    }
    document = {
        "fileType": "Plan",
        "version": 1,
        "groundStation": "shotc",
        "mission": mission,
        "geoFence": _fence(fence),
        "rallyPoints": {"version": 2, "points": [[p.lat, p.lon, _number(p.alt)] for p in rally]},
    }
    rows = ",\n".join("      " + json.dumps(_item(item, n)) for n, item in enumerate(items, start=1))
    text = json.dumps(document, indent=2).replace('"@items"', f"[\n{rows}\n    ]")
    return (text + "\n").encode()


def read_plan(data: bytes) -> tuple[list[MissionItem], tuple[float, float, float]]:
    """Return the items of a plan and its home: latitude and longitude in degrees, metres above sea level."""
    mission = json.loads(data)["mission"]
    items = [MissionItem(i["command"], i["frame"], tuple(i["params"])) for i in mission["items"]]
    lat, lon, alt = mission["plannedHomePosition"]
    return items, (lat, lon, alt)


def _item(item: MissionItem, number: int) -> dict[str, Any]:
    row: dict[str, Any] = {
        "type": "SimpleItem",
        "autoContinue": True,
        "command": item.command,
        "doJumpId": number,
        "frame": item.frame,
        "params": [None if p is None else _number(p) for p in item.params],
    }
    if item.frame == FRAME_RELATIVE and item.command in POSITION_COMMANDS:
        altitude = row["params"][6]
        row |= {"Altitude": altitude, "AltitudeMode": RELATIVE_ALTITUDE_MODE, "AMSLAltAboveTerrain": None}
    return row


def _fence(fence: Fence) -> dict[str, Any]:
    return {
        "version": 2,
        "polygons": [
            {"version": 1, "inclusion": p.inclusion, "polygon": [list(c) for c in p.corners]}
            for p in fence.polygons
        ],
        "circles": [
            {
                "version": 1,
                "inclusion": c.inclusion,
                "circle": {"center": list(c.centre), "radius": _number(c.radius)},
            }
            for c in fence.circles
        ],
    }


def _number(value: float) -> float | int:
    return int(value) if value == int(value) else value
