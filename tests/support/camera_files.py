"""Files of cameras by other tools, small and written by hand, and what the importers make of them."""

from __future__ import annotations

import json
from typing import Any

from shotc.importers.cameras.takes import ImportOptions
from shotc.importers.mission import Imported, imported

LAT, LON = 47.3769, 8.5417
KML = (
    '<?xml version="1.0" encoding="UTF-8"?>\n<kml xmlns="http://www.opengis.net/kml/2.2"\n'
    ' xmlns:gx="http://www.google.com/kml/ext/2.2"><Document>\n{body}\n</Document></kml>\n'
)
LITCHI_HEAD = (
    "latitude,longitude,altitude(m),heading(deg),curvesize(m),rotationdir,gimbalmode,gimbalpitchangle,"
    "actiontype1,actionparam1,altitudemode,speed(m/s),poi_latitude,poi_longitude,poi_altitude(m)"
)
BLENDER = "frame,x,y,z,rx_deg,ry_deg,rz_deg,lens\n1,0,-40,20,75,0,0,24\n25,10,-40,20,75,0,10,24\n"


def camera(
    lat: float = LAT, lon: float = LON, alt: float = 440.0, mode: str = "absolute", **more: Any
) -> str:
    """A Camera, each part on a line of its own."""
    told = {"longitude": lon, "latitude": lat, "altitude": alt, "heading": 0, "tilt": 80, **more}
    parts = [f"<{name}>{value}</{name}>" for name, value in told.items() if value is not None]
    return "\n".join(
        [
            "<Camera>",
            "<gx:horizFov>60</gx:horizFov>",
            *parts,
            f"<altitudeMode>{mode}</altitudeMode>",
            "</Camera>",
        ]
    )


def fly(view: str, duration: float = 5.0) -> str:
    mode = "<gx:flyToMode>smooth</gx:flyToMode>"
    return f"<gx:FlyTo><gx:duration>{duration}</gx:duration>{mode}\n{view}\n</gx:FlyTo>"


def tour(*steps: str, name: str = "fly past") -> str:
    return f"<gx:Tour><name>{name}</name><gx:Playlist>\n" + "\n".join(steps) + "\n</gx:Playlist></gx:Tour>"


def kml(*parts: str) -> bytes:
    return KML.format(body="\n".join(parts)).encode()


GOOD_TOUR = kml(
    tour(fly(camera()), fly(camera(lat=LAT + 2e-4), 6.0), fly(camera(lat=LAT + 3e-4, heading=20)))
)


def waypoint(
    north: float, alt: float = 20.0, heading: float | None = 0.0, frame: int = 3, hold: float = 0
) -> dict[str, Any]:
    return item(16, hold, 0, 0, heading, LAT + north * 1e-5, LON, alt, frame=frame)


def item(command: int, *params: float | None, frame: int = 2) -> dict[str, Any]:
    return {
        "type": "SimpleItem",
        "command": command,
        "frame": frame,
        "params": [*params, *[0] * (7 - len(params))],
    }


def plan_file(*items: dict[str, Any], home: Any = (LAT, LON, 408.0), **more: Any) -> bytes:
    mission = {"items": list(items), **({} if home is None else {"plannedHomePosition": home})}
    return json.dumps({"fileType": "Plan", "mission": mission, **more}, indent=1).encode()


GOOD_PLAN = plan_file(item(1000, -10, 0), waypoint(0), waypoint(20, 25.0), waypoint(40, 30.0, hold=2))


def litchi(*rows: str) -> bytes:
    return "\n".join([LITCHI_HEAD, *rows, ""]).encode()


GOOD_LITCHI = litchi(
    f"{LAT},{LON},20,0,0,0,2,-10,-1,0,0,0,0,0,0",
    f"{LAT + 2e-4},{LON},25,30,0,0,2,-20,0,3000,0,0,0,0,0",
    f"{LAT + 4e-4},{LON},25,60,0,0,1,0,-1,0,0,0,{LAT},{LON},5",
)
GOOD = {"kml": GOOD_TOUR, "blender-camera": BLENDER.encode(), "qgc": GOOD_PLAN, "litchi": GOOD_LITCHI}


def made(format: str, data: bytes, *, strict: bool = False, **asked: Any) -> Imported:
    return imported(format, data, "file", strict=strict, options=ImportOptions(**asked))


def assumed(result: Imported) -> list[tuple[int, str]]:
    """Lines and messages of what is told."""
    return [(d.labels[0].span.line, d.message) for d in result.diagnostics]
