"""KML tours: the planned camera as a playlist of smooth flights (gx:Tour), and the path as a line.

Format: developers.google.com/kml/documentation/touring and .../cameras. Camera tilt is 90 degrees
plus pitch, heading is clockwise from North, altitude is absolute.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import degrees, pi
from typing import ClassVar
from xml.etree.ElementTree import Element, SubElement, indent, register_namespace, tostring

import numpy as np
import pymap3d

from shotc.plugin_api import (
    CAM_PITCH,
    CAM_YAW,
    HFOV,
    Artifact,
    Diagnostic,
    DroneTrajectory,
    Emission,
    MissionIR,
    VerifiedIR,
)

KML = "http://www.opengis.net/kml/2.2"
GX = "http://www.google.com/kml/ext/2.2"
STEP_S = 0.5
"""Seconds between two cameras of the tour."""

register_namespace("", KML)
register_namespace("gx", GX)


@dataclass(frozen=True, slots=True)
class KmlTour:
    """Writes one tour a drone."""

    name: ClassVar[str] = "kml"
    summary: ClassVar[str] = "Google Earth tour of every filmed shot"
    api: ClassVar[int] = 1

    def emit(self, plan: VerifiedIR) -> Emission:
        """Return ``<drone>.kml`` for each drone, or a warning where the mission has no origin."""
        mission = plan.trajectory.keyframes.mission
        if mission.origin is None:
            warning = Diagnostic(
                "E101",
                "the KML tour needs to know where the mission is",
                (mission.origins.key(("world",)),),
                help="add `origin: {lat: ..., lon: ..., alt: ...}` under `world`",
            )
            return Emission((), (warning,))
        tours = tuple(
            Artifact(f"{drone.drone}.kml", document(mission, drone)) for drone in plan.trajectory.drones
        )
        fleets = ("fleets have no cameras and get no KML tours",) if plan.trajectory.fleets else ()
        return Emission(tours, notes=fleets)


EMITTER = KmlTour()


def document(mission: MissionIR, drone: DroneTrajectory) -> bytes:
    """Return the KML document of one drone."""
    root = Element(f"{{{KML}}}kml")
    folder = SubElement(root, f"{{{KML}}}Document")
    _text(folder, KML, "name", f"{mission.name}: {drone.drone}")
    _path(folder, mission, drone)
    for phase in drone.phases:
        if phase.shot is not None:
            _tour(folder, mission, drone, phase.shot, (phase.start, phase.end))
    indent(root)
    return tostring(root, encoding="utf-8", xml_declaration=True) + b"\n"


def _path(folder: Element, mission: MissionIR, drone: DroneTrajectory) -> None:
    times = np.arange(drone.curve.start, drone.curve.end + STEP_S, STEP_S)
    mark = SubElement(folder, f"{{{KML}}}Placemark")
    _text(mark, KML, "name", "flight path")
    line = SubElement(mark, f"{{{KML}}}LineString")
    _text(line, KML, "altitudeMode", "absolute")
    places = geodetic(mission, drone.curve(times)[:, :3])
    _text(line, KML, "coordinates", " ".join(f"{lon:.8f},{lat:.8f},{alt:.2f}" for lat, lon, alt in places))


def _tour(
    folder: Element, mission: MissionIR, drone: DroneTrajectory, shot: str, span: tuple[float, float]
) -> None:
    count = max(2, round((span[1] - span[0]) / STEP_S) + 1)
    times = np.linspace(*span, count)
    states = drone.curve(times)
    playlist = SubElement(SubElement(folder, f"{{{GX}}}Tour"), f"{{{GX}}}Playlist")
    places = geodetic(mission, states[:, :3])
    for index, (state, place) in enumerate(zip(states, places, strict=True)):
        leg = SubElement(playlist, f"{{{GX}}}FlyTo", {"id": f"{shot}-{index}".replace(" ", "-")})
        _text(leg, GX, "duration", f"{times[index] - times[index - 1] if index else 0.0:.6f}")
        _text(leg, GX, "flyToMode", "smooth")
        camera = SubElement(leg, f"{{{KML}}}Camera")
        _text(camera, KML, "longitude", f"{place[1]:.8f}")
        _text(camera, KML, "latitude", f"{place[0]:.8f}")
        _text(camera, KML, "altitude", f"{place[2]:.3f}")
        _text(camera, KML, "heading", f"{degrees((pi / 2 - state[CAM_YAW]) % (2 * pi)):.4f}")
        _text(camera, KML, "tilt", f"{90 + degrees(state[CAM_PITCH]):.4f}")
        _text(camera, KML, "roll", "0")
        _text(camera, KML, "altitudeMode", "absolute")
        _text(camera, GX, "horizFov", f"{degrees(state[HFOV]):.4f}")


def geodetic(mission: MissionIR, points: np.ndarray) -> list[tuple[float, float, float]]:
    """Turn points of W, shape (n, 3), into (latitude deg, longitude deg, altitude m)."""
    origin = mission.origin
    if origin is None:
        raise ValueError("the mission has no origin")
    east, north, up = points.T
    lat, lon, alt = pymap3d.enu2geodetic(east, north, up, origin.lat_deg, origin.lon_deg, origin.alt)
    return [(float(a), float(b), float(c)) for a, b, c in zip(lat, lon, alt, strict=True)]


def _text(parent: Element, namespace: str, tag: str, text: str) -> None:
    SubElement(parent, f"{{{namespace}}}{tag}").text = text
