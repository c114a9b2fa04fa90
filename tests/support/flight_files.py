"""Small files of flights as other tools write them, made by hand, and what verification says of them."""

from __future__ import annotations

import json
from collections.abc import Sequence
from functools import cache
from io import BytesIO
from pathlib import Path
from zipfile import ZIP_DEFLATED, ZipFile

import numpy as np

from shotc.api import MissionFile
from shotc.flightfiles.verify import FlightFile, FlightsReport, verify_flights
from shotc.geom.earth import of_world
from shotc.ir.mission import GeoOrigin
from shotc.ir.trajectory import Claim

ORIGIN = GeoOrigin(47.3769, 8.5417, 408.0)
MISSION = """\
shotc: 1
mission: yard
world:
  origin: {lat: 47.3769, lon: 8.5417, alt: 408}
  zones:
    hut: {keep: out, box: {center: [0, 0, 5], size: [10, 10, 10]}}
drones:
  cam1: {model: x500, home: [0, -60, 0], limits: {speed: 8 m/s, climb: 3 m/s, descent: 2 m/s}}
shots:
  - {id: wide, kind: static, drone: cam1, at: [0, -50, 15], heading: 0 deg, pitch: 0 deg}
"""
TWO = MISSION.replace("shots:", "  cam2: {model: x500, home: [12, -60, 0]}\nshots:")
Places = Sequence[tuple[float, float, float]]
AROUND: Places = ((0.0, -60.0, 20.0), (-40.0, -40.0, 20.0), (-40.0, 40.0, 20.0), (0.0, -60.0, 20.0))
"""A way round the hut, which ends where it begins."""
ACROSS: Places = ((0.0, -60.0, 8.0), (0.0, 40.0, 8.0), (0.0, -60.0, 8.0))
"""A way through it."""


def globe(place: tuple[float, float, float]) -> tuple[float, float, float]:
    """Latitude, longitude and height above the pad of a place in W."""
    lat, lon, alt = of_world(np.array([place]), ORIGIN)[0]
    return float(lat), float(lon), float(alt) - ORIGIN.alt


def waypoints_file(places: Places, frame: int = 3, command: int = 16) -> bytes:
    rows = ["QGC WPL 110", "0\t1\t0\t16\t0\t0\t0\t0\t47.3769\t8.5417\t408\t1"]
    for i, place in enumerate(places, 1):
        lat, lon, height = globe(place)
        rows.append(f"{i}\t0\t{frame}\t{command}\t0\t0\t0\t0\t{lat:.9f}\t{lon:.9f}\t{height:.4f}\t1")
    return ("\n".join([*rows, f"{len(places) + 1}\t0\t3\t21" + "\t0" * 7 + "\t1", ""])).encode()


def qgc_item(place: tuple[float, float, float], command: int = 16, frame: int = 3) -> dict[str, object]:
    lat, lon, height = globe(place)
    return {"command": command, "frame": frame, "params": [0, 0, 0, None, lat, lon, height]}


def plan_file(places: Places, firmware: int = 12, items: Sequence[object] | None = None) -> bytes:
    listed = [qgc_item(place) for place in places] if items is None else list(items)
    mission = {"firmwareType": firmware, "plannedHomePosition": [47.3769, 8.5417, 408], "items": listed}
    return json.dumps({"fileType": "Plan", "mission": mission}, indent=1).encode()


def mark(place: tuple[float, float, float], speed: float = 5.0, more: str = "") -> str:
    lat, lon, height = globe(place)
    return (
        f"<Placemark><Point><coordinates>{lon:.9f},{lat:.9f}</coordinates></Point>\n"
        f"<wpml:executeHeight>{height:.2f}</wpml:executeHeight>"
        f"<wpml:waypointSpeed>{speed}</wpml:waypointSpeed>{more}</Placemark>"
    )


def wpml_text(
    marks: Sequence[str],
    version: str = "http://www.dji.com/wpmz/1.0.6",
    heights: str = "relativeToStartPoint",
    finish: str = "autoLand",
) -> str:
    body = "\n".join(marks)
    return (
        '<?xml version="1.0" encoding="UTF-8"?>\n'
        f'<kml xmlns="http://www.opengis.net/kml/2.2" xmlns:wpml="{version}"><Document>\n'
        f"<wpml:missionConfig><wpml:finishAction>{finish}</wpml:finishAction></wpml:missionConfig>\n"
        f"<Folder><wpml:executeHeightMode>{heights}</wpml:executeHeightMode>\n{body}\n</Folder></Document></kml>\n"
    )


def zipped(files: dict[str, bytes], how: int = ZIP_DEFLATED) -> bytes:
    stream = BytesIO()
    with ZipFile(stream, "w", how) as archive:
        for name, data in files.items():
            archive.writestr(name, data)
    return stream.getvalue()


@cache
def bomb(name: str) -> bytes:
    """A small archive of one table of 208 MB."""
    stream = BytesIO()
    with ZipFile(stream, "w", ZIP_DEFLATED, compresslevel=1) as archive:
        archive.writestr(name, b"0,0,0,0\n" * 26_000_000)
    return stream.getvalue()


def kmz(text: str) -> bytes:
    return zipped({"wpmz/template.kml": b"<kml/>", "wpmz/waylines.wpml": text.encode()})


LITCHI_HEAD = (
    "latitude,longitude,altitude(m),heading(deg),curvesize(m),"
    "gimbalmode,gimbalpitchangle,altitudemode,speed(m/s)"
)


def litchi_file(places: Places, curve: float = 0.0, mode: int = 0, speed: float = 5.0) -> bytes:
    rows = [LITCHI_HEAD]
    for place in places:
        lat, lon, height = globe(place)
        rows.append(f"{lat:.9f},{lon:.9f},{height:.2f},0,{curve},2,-10,{mode},{speed}")
    return "\n".join([*rows, ""]).encode()


def verified(
    *files: tuple[str, bytes], text: str = MISSION, drones: Sequence[str] = (), folder: Path | None = None
) -> FlightsReport:
    """What verification says of files against a mission's text; folder : of the files that it names."""
    mission = MissionFile(text.encode(), "mission.yaml", folder)
    return verify_flights([FlightFile(data, name) for name, data in files], mission, drones)


def codes(report: FlightsReport) -> list[str]:
    return [diagnostic.code for diagnostic in report.diagnostics]


def claims(report: FlightsReport, end: str) -> list[Claim]:
    """Return the claims whose constraint ends so."""
    return [claim for claim in report.certificate if claim.constraint.endswith(end)]
