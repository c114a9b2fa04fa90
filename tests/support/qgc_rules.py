"""What QGroundControl's plan loader and the autopilots' upload checks demand of a ``.plan`` file.

Written after the loader's own rules, stricter than the libraries that merely import plans.
"""

from __future__ import annotations

import json
from math import isfinite
from typing import Any

POSITION = {16, 21, 22, 195}
FLOWN_TO = {16, 21, 22}
PX4_MISSION_FRAME = {20, 178, 197, 205, 1000, 1001, 2500, 2501}
ARDUPILOT_KNOWN = {16, 21, 22, 115, 178, 195, 197, 205, 1000, 2500, 2501}
NULLABLE = {16: {3}, 21: {3}, 22: {3}, 1000: {2, 3}}


def check_plan(data: bytes) -> dict[str, Any]:
    """Assert every rule; return the document."""
    document = json.loads(data, parse_constant=_no_constant)
    assert document["fileType"] == "Plan"
    assert document["version"] == 1
    assert set(document) == {"fileType", "version", "groundStation", "mission", "geoFence", "rallyPoints"}
    mission = document["mission"]
    assert mission["version"] == 2
    assert mission["firmwareType"] in (3, 12)
    assert mission["vehicleType"] == 2
    for key in ("cruiseSpeed", "hoverSpeed"):
        assert mission[key] > 0
    assert mission["globalPlanAltitudeMode"] == 1
    _place(mission["plannedHomePosition"][:2])
    assert len(mission["plannedHomePosition"]) == 3
    for number, item in enumerate(mission["items"], start=1):
        _item(item, number)
    (_px4 if mission["firmwareType"] == 12 else _ardupilot)(mission["items"])
    _order(mission["items"])
    _fence(document["geoFence"])
    assert document["rallyPoints"] == {"version": 2, "points": []}
    return document


def _no_constant(name: str) -> None:
    raise AssertionError(f"{name} is not JSON")


def _item(item: dict[str, Any], number: int) -> None:
    assert item["type"] == "SimpleItem"
    assert item["autoContinue"] is True
    assert item["doJumpId"] == number
    assert isinstance(item["command"], int)
    assert isinstance(item["frame"], int)
    assert len(item["params"]) == 7
    for index, value in enumerate(item["params"]):
        if value is None:
            assert index in NULLABLE.get(item["command"], set())
        else:
            assert isfinite(value)
    # A place in frame 2 would be cut to whole degrees on its way to the vehicle.
    assert item["frame"] == (3 if item["command"] in POSITION else 2)
    if item["command"] in POSITION:
        _place(item["params"][4:6])
    told = {"Altitude", "AltitudeMode", "AMSLAltAboveTerrain"} & set(item)
    assert len(told) in (0, 3)
    if told:
        assert item["Altitude"] == item["params"][6]
        assert item["AltitudeMode"] == 1


def _order(items: list[dict[str, Any]]) -> None:
    flown = [i["command"] for i in items if i["command"] in FLOWN_TO]
    assert flown[0] == 22
    assert flown[-1] == 21
    assert 22 not in flown[1:]
    assert 21 not in flown[:-1]
    assert items[-1]["command"] == 21
    recording = [i["command"] for i in items if i["command"] in (2500, 2501)]
    assert recording == [2500, 2501] * (len(recording) // 2)
    for item in items:
        if item["command"] == 178:
            assert item["params"][0] in (1, 2, 3)
            assert item["params"][1] > 0


def _px4(items: list[dict[str, Any]]) -> None:
    assert len(items) <= 500
    commands = [i["command"] for i in items]
    assert set(commands) <= POSITION | PX4_MISSION_FRAME
    if 1000 in commands:
        assert 1001 in commands[: commands.index(1000)]
    for item in items:
        if item["command"] == 16:
            assert item["params"][1] > 0


def _ardupilot(items: list[dict[str, Any]]) -> None:
    assert len(items) <= 649
    previous = None
    for item in items:
        assert item["command"] in ARDUPILOT_KNOWN
        assert None not in item["params"]
        if item["command"] == 16:
            assert item["params"][0] == int(item["params"][0])
        if item["command"] == 115:
            assert item["params"][1] > 0
        # A CONDITION command holds back the actions behind it.
        assert previous != 115 or item["command"] in FLOWN_TO
        previous = item["command"]


def _fence(fence: dict[str, Any]) -> None:
    assert fence["version"] == 2
    for polygon in fence["polygons"]:
        assert polygon["version"] == 1
        assert isinstance(polygon["inclusion"], bool)
        corners = polygon["polygon"]
        assert len(corners) >= 3
        assert corners[0] != corners[-1]
        for corner in corners:
            _place(corner)
        pairs = zip(corners, [*corners[1:], corners[0]], strict=True)
        # Longitude is x and latitude y: clockwise is negative.
        assert sum(a[1] * b[0] - b[1] * a[0] for a, b in pairs) < 0
    for circle in fence["circles"]:
        assert circle["version"] == 1
        assert isinstance(circle["inclusion"], bool)
        _place(circle["circle"]["center"])
        assert circle["circle"]["radius"] > 0


def _place(lat_lon: list[float]) -> None:
    lat, lon = lat_lon
    assert -90 <= lat <= 90
    assert -180 <= lon <= 180
    assert (lat, lon) != (0, 0)
