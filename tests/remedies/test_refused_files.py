"""Files of other tools that are refused: each help leads from the refused file to one that is read."""

from __future__ import annotations

import json
from typing import Any, NamedTuple
from zipfile import ZIP_LZMA

import pytest

from shotc.importers.cameras.takes import Refused
from shotc.importers.flights.read import read
from shotc.importers.flights.rows import EXAMPLE
from tests.support.camera_files import GOOD as CAMERAS
from tests.support.camera_files import made
from tests.support.flight_files import (
    AROUND,
    kmz,
    litchi_file,
    mark,
    plan_file,
    waypoints_file,
    wpml_text,
    zipped,
)
from tests.support.multidrone_files import MISSION, action


class Case(NamedTuple):
    """A refused file and the same file as its help wants it.

    name : of the file of a flight, or the format of a file of cameras
    said : what the help says of it
    """

    name: str
    bad: bytes
    said: str
    mended: bytes


def edited(name: str, mended: bytes, old: str, new: str, said: str) -> Case:
    """Return a case whose refused file is the mended one with its first ``old`` written as ``new``."""
    assert old.encode() in mended, f"{name}: {old}"
    return Case(name, mended.replace(old.encode(), new.encode(), 1), said, mended)


def wpml(old: str, new: str, said: str) -> Case:
    return edited("cam1.wpml", wpml_text([mark(place) for place in AROUND]).encode(), old, new, said)


def skyc(said: str, **changes: Any) -> Case:
    """Return a show of one drone, of which values are changed by their key paths, `__` between keys."""

    def show() -> dict[str, Any]:
        points = [[0.0, [0, 0, 0], []], [10.0, [0, 0, 9], []], [20.0, [0, 0, 0], []]]
        settings = {"name": "a", "trajectory": {"version": 1, "points": points, "takeoffTime": 0}}
        location = {"origin": [47, 8, 400], "orientation": 0}
        return {
            "version": 1,
            "environment": {"location": location},
            "swarm": {"drones": [{"settings": settings}]},
        }

    bad: Any = show()
    for path, value in changes.items():
        inner, *keys = bad, *[int(key) if key.isdigit() else key for key in path.split("__")]
        for key in keys[:-1]:
            inner = inner[key]
        inner[keys[-1]] = value
    parts = [zipped({"show.json": json.dumps(each).encode()}) for each in (bad, show())]
    return Case("show.skyc", parts[0], said, parts[1])


PATH = "swarm__drones__0__settings__trajectory"
ROWS = f"{EXAMPLE}\n0,cam1,0,0,0,0,0,0\n1,cam1,1,0,0,0,0,0\n2,cam1,1,0,1,0,0,0\n".encode()
ITEMS, TABLE, LITCHI = plan_file(AROUND), waypoints_file(AROUND), litchi_file(AROUND)
CSV = b"0,0,0,0,9,9,9\n1000,0,0,1,9,9,9\n2000,0,0,0,9,9,9\n"
SHOW = zipped({"a.csv": CSV})
TEXT = kmz(wpml_text([mark(place) for place in AROUND]))
AGAIN, NUMBER = "export it whole", "write a number there"
FLIGHTS = [
    Case("cam1.kmz", TEXT[:200], AGAIN, TEXT),
    Case("cam1.kmz", zipped({"a.txt": b"x"}), "put `wpmz/waylines.wpml` into it", TEXT),
    Case("cam1.kmz", zipped({"wpmz/waylines.wpml": b" " * 5_000_000}), "cut it in two files", TEXT),
    Case("cam1.kmz", zipped({"wpmz/waylines.wpml": b" "}, ZIP_LZMA), "method `deflate`", TEXT),
    Case("cam1.kmz", b"PK" + b" " * 4_000_001, "cut it in two files", TEXT),
    wpml('<?xml version="1.0" encoding="UTF-8"?>', "<!DOCTYPE a>", "remove `<!DOCTYPE ...>`"),
    wpml("</Folder>", "", "correct it there, or export it whole"),
    wpml("</Folder>", "</Folder><Folder></Folder>", "give each wayline a file of its own"),
    wpml("http://www.dji.com/wpmz/1.0.6", "http://www.dji.com/wpmz/2.0.0", "export the mission again"),
    wpml("http://www.dji.com/wpmz/1.0.6", "http://example.org/", "export the mission again"),
    wpml("relativeToStartPoint", "WGS84", "relativeToStartPoint"),
    wpml("autoLand", "explode", "write `autoLand`"),
    wpml("<coordinates>", "<!--", "correct it there"),
    wpml("<Point>", "<Point/><Point x='", "correct it there"),
    wpml("<wpml:executeHeight>20.00</wpml:executeHeight>", "", "<wpml:executeHeight>METRES"),
    wpml("20.00</wpml:executeHeight>", "high</wpml:executeHeight>", NUMBER),
    edited("cam1.plan", ITEMS, '"items"', '"parts"', '{"mission": {"items": [...]}}'),
    edited("cam1.plan", ITEMS, "{", "", "correct it there"),
    edited("cam1.plan", ITEMS, '"firmwareType": 12', '"firmwareType": 99', "write 12 or 3"),
    edited("cam1.plan", ITEMS, '"command": 16', '"command": 18', "by waypoints, command 16"),
    edited("cam1.plan", ITEMS, '"command": 16', '"order": 16', "save the plan with its items laid out"),
    edited("cam1.plan", ITEMS, '"frame": 3', '"frame": 10', "count heights from home (frame 3)"),
    edited("cam1.plan", ITEMS, '"frame": 3', '"frame": 0', "let all waypoints count from one level"),
    Case("cam1.plan", plan_file(AROUND, items=[]), "add a waypoint", ITEMS),
    edited("cam1.plan", ITEMS, "\n     47.3763", "\n     147.3763", "the latitude from -90 to 90 deg"),
    edited("cam1.plan", ITEMS, "\n     47.3763", "\n     null,\n     47.3763", "write all three"),
    edited("cam1.waypoints", TABLE, "QGC WPL 110", "QGC WPL", "begin it with `QGC WPL 110`"),
    edited("cam1.waypoints", TABLE, "\t20.", "\thigh", NUMBER),
    edited("cam1.waypoints", TABLE, "\t20.", "\t1\t20.", "give it 12 columns"),
    edited("cam1.csv", LITCHI, "latitude,", "latitude,x", "begin it with a line such as"),
    edited("cam1.csv", LITCHI, ",20.00,", ",high,", NUMBER),
    edited("cam1.csv", LITCHI, ",20.00,0,0.0", ",20.00,0,tight", NUMBER),
    Case("cam1.csv", b"", "begin it with a line such as", LITCHI),
    edited("all.csv", ROWS, "t_s", "time", "begin it with a line such as"),
    edited("all.csv", ROWS, "1,cam1,1", "1,cam1,here", "with a point for decimals"),
    edited("all.csv", ROWS, "\n1,", "\n0,", "let the times of each drone rise"),
    edited("all.csv", ROWS, "\n0,", "\n-1,", "let its times count from 0 s"),
    edited("all.csv", ROWS, "\n2,", "\n90000,", "let it end by 86400 s"),
    edited("all.csv", ROWS, "\n2,cam1", "\n2,cam2", "give each drone two rows or more"),
    Case("all.csv", ROWS.splitlines()[0], "give each drone two rows or more", ROWS),
    Case("show.zip", zipped({"a.txt": CSV}), "with a CSV file for each drone", SHOW),
    Case("show.zip", zipped({"a.csv": b""}), "give it rows of", SHOW),
    Case("show.zip", zipped({"a.csv": b"hello\n" + CSV}), "begin with", SHOW),
    Case("show.zip", zipped({"a.csv": b"Time [msec],x,y,z\n"}), "give it rows of", SHOW),
    Case("show.zip", zipped({"a.csv": CSV.replace(b"9", b"900", 1)}), "a whole number from 0 to 255", SHOW),
    Case("show.zip", zipped({"a.csv": CSV, "b/a.csv": CSV}), "a name of its own", SHOW),
    Case("show.zip", SHOW[:40], AGAIN, SHOW),
    skyc(AGAIN, version=2),
    skyc("give it 1 to", swarm__drones=[]),
    skyc("write it in degrees", environment__location__orientation="north"),
    skyc("[latitude, longitude, altitude]", environment__location__origin=["here"]),
    skyc("the latitude from -90 to 90 deg", environment__location__origin=[470, 8]),
    skyc(AGAIN, swarm__drones__0__settings=None),
    skyc(AGAIN, **{f"{PATH}__version": 2}),
    skyc("key points", **{f"{PATH}__points": []}),
    skyc("seconds of 0 or more", **{f"{PATH}__takeoffTime": -1}),
    skyc("let it be 0.001 s or later", **{f"{PATH}__points__1__0": 0.0}),
    skyc("let its time be 0 s or later", **{f"{PATH}__points__0__0": -5.0}),
    skyc("let it end by 86400 s", **{f"{PATH}__points__2__0": 1e6}),
    skyc("[seconds, [x, y, z], []]", **{f"{PATH}__points__1": [1.0]}),
    skyc("[seconds, [x, y, z], []]", **{f"{PATH}__points__1__0": "soon"}),
    skyc("[seconds, [x, y, z], []]", **{f"{PATH}__points__1__2": [[0, 0, 0]] * 3}),
    skyc("write [x, y, z] in metres", **{f"{PATH}__points__1__1": [0, 0]}),
    Case("show.skyc", zipped({"a.json": b"{}"}), "put `show.json` into it", skyc("").mended),
    Case("show.skyc", zipped({"show.json": b"{"}), AGAIN, skyc("").mended),
]
TOUR, PLAN, FRAMES, HUB = (CAMERAS[name] for name in ("kml", "qgc", "blender-camera", "litchi"))
FILM = MISSION.format(actions=action("LATERAL", "<param><name>x</name></param>")).encode()
IMPORTS = [
    Case("kml", b"<gpx/>", "whose root is `kml`", TOUR),
    Case("kml", TOUR[:-9], "correct it there", TOUR),
    Case("kml", TOUR + b" " * 4_000_001, "cut it in two files", TOUR),
    edited("qgc", PLAN, "{", "", "correct it there"),
    edited("qgc", PLAN, '"items"', '"parts"', '{"mission": {"items": [...]}}'),
    Case("qgc", PLAN.replace(b'"command": 16', b'"command": 2000'), "add waypoints, command 16", PLAN),
    edited("qgc", PLAN, '"plannedHomePosition": [', '"plannedHomePosition": [9, ', "[latitude, longitude,"),
    Case("litchi", b"", "begins with `latitude,longitude,altitude(m)", HUB),
    Case("litchi", HUB.splitlines()[0] + b"\n,,20,0,0,0,2,-10\n", "numbers in the columns `latitude`", HUB),
    edited("blender-camera", FRAMES, "frame,", "picture,", "begin it with a line such as"),
    edited("blender-camera", FRAMES, "rx_deg,", "roll,", "begin it with a line such as"),
    Case("multidrone", b"<kml/>", "with the root `mission`", FILM),
    Case("multidrone", b"<mission/>", "a `shootingAction` an `RTTrajectory`", FILM),
    Case("multidrone", FILM[:-12], "correct it there", FILM),
]


@pytest.mark.parametrize("case", FLIGHTS, ids=[f"{case.name}-{i}" for i, case in enumerate(FLIGHTS)])
def test_a_flight_that_is_written_as_the_help_says_is_read(case: Case) -> None:
    refused = read(case.bad, case.name).content
    assert isinstance(refused, Refused)
    assert case.said in refused.help
    assert not isinstance(read(case.mended, case.name).content, Refused)


@pytest.mark.parametrize("case", IMPORTS, ids=[f"{case.name}-{i}" for i, case in enumerate(IMPORTS)])
def test_a_file_of_cameras_that_is_written_as_the_help_says_becomes_a_mission(case: Case) -> None:
    refused = made(case.name, case.bad)
    assert refused.text is None
    assert case.said in str(refused.diagnostics[-1].help)
    assert made(case.name, case.mended).text is not None
