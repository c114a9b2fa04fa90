"""KML tours: the planned camera as a playlist of smooth flights (gx:Tour), and the path as a line.

Format: developers.google.com/kml/documentation/touring and .../cameras. Elements have the order that the
schemas ogckml22.xsd and kml22gx.xsd demand. Camera tilt is 90 degrees plus pitch, heading is clockwise from
North, and altitude is absolute.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import degrees, pi
from typing import ClassVar
from xml.etree.ElementTree import Element, SubElement, indent, register_namespace, tostring

import numpy as np

from shotc.emit.base import Artifact, Emission, without_origin
from shotc.emit.cameras import without_fleets
from shotc.geom.earth import of_world
from shotc.ir.mission import GeoOrigin, MissionIR
from shotc.ir.path import CAM_PITCH, CAM_YAW, HFOV
from shotc.ir.phases import Phase
from shotc.ir.trajectory import DroneTrajectory, VerifiedIR

KML = "http://www.opengis.net/kml/2.2"
GX = "http://www.google.com/kml/ext/2.2"
STEP_S = 0.5
"""Seconds between two cameras of the tour."""
NARROWEST_DEG, WIDEST_DEG = 10.0, 170.0
"""Degrees, the range of fields of view that Google Earth shows, according to the comment in its schema."""

register_namespace("", KML)
register_namespace("gx", GX)


@dataclass(frozen=True, slots=True)
class KmlTour:
    """Writes one tour for each drone."""

    name: ClassVar[str] = "kml"
    summary: ClassVar[str] = "NAME.kml: a Google Earth tour of every filmed shot"
    api: ClassVar[int] = 1

    def emit(self, plan: VerifiedIR) -> Emission:
        """Return ``<drone>.kml`` for each drone, or a warning if the mission has no origin."""
        mission = plan.trajectory.keyframes.mission
        if mission.origin is None:
            why = "cameras of a tour are latitudes, longitudes and altitudes"
            return Emission((), (without_origin(mission, "kml", "E101", "the KML tours are", why),))
        tours, notes = [], [*without_fleets(plan, "kml")]
        for drone in plan.trajectory.drones:
            tours.append(Artifact(f"{drone.drone}.kml", document(mission, mission.origin, drone)))
            notes += _lens(drone)
        return Emission(tuple(tours), notes=tuple(notes))


EMITTER = KmlTour()


def document(mission: MissionIR, origin: GeoOrigin, drone: DroneTrajectory) -> bytes:
    """Return the KML document of one drone."""
    root = Element(f"{{{KML}}}kml")
    folder = SubElement(root, f"{{{KML}}}Document")
    text_element(folder, KML, "name", f"{mission.name}: {drone.drone}")
    _path(folder, origin, drone)
    for number, phase in enumerate(drone.phases):
        if phase.shot is not None:
            _tour(folder, origin, drone, phase, f"tour{number}")
    indent(root)
    return bytes(tostring(root, encoding="utf-8", xml_declaration=True)) + b"\n"


def _lens(drone: DroneTrajectory) -> list[str]:
    """Return a note if the viewer cannot show the camera's field of view."""
    spans = [np.linspace(p.start, p.end, 101) for p in drone.phases if p.shot is not None]
    if not spans:
        return []
    hfov = np.degrees(drone.curve(np.concatenate(spans))[:, HFOV])
    if hfov.min() >= NARROWEST_DEG and hfov.max() <= WIDEST_DEG:
        return []
    seen = f"{hfov.min():.1f} to {hfov.max():.1f} deg"
    return [f"kml {drone.drone}.kml: fields of view of {seen}; Google Earth shows 10 to 170 deg"]


def _path(folder: Element, origin: GeoOrigin, drone: DroneTrajectory) -> None:
    end = drone.curve.end
    times = np.linspace(drone.curve.start, end, max(2, round((end - drone.curve.start) / STEP_S) + 1))
    mark = SubElement(folder, f"{{{KML}}}Placemark")
    text_element(mark, KML, "name", "flight path")
    line = SubElement(mark, f"{{{KML}}}LineString")
    text_element(line, KML, "altitudeMode", "absolute")
    places = of_world(drone.curve(times)[:, :3], origin).tolist()
    text_element(
        line, KML, "coordinates", " ".join(f"{lon:.9f},{lat:.9f},{alt:.4f}" for lat, lon, alt in places)
    )


def _tour(folder: Element, origin: GeoOrigin, drone: DroneTrajectory, phase: Phase, ident: str) -> None:
    times = np.linspace(phase.start, phase.end, max(2, round((phase.end - phase.start) / STEP_S) + 1))
    states = drone.curve(times)
    tour = SubElement(folder, f"{{{GX}}}Tour", {"id": ident})
    text_element(tour, KML, "name", str(phase.shot))
    playlist = SubElement(tour, f"{{{GX}}}Playlist")
    for index, (state, place) in enumerate(zip(states, of_world(states[:, :3], origin), strict=True)):
        leg = SubElement(playlist, f"{{{GX}}}FlyTo", {"id": f"{ident}-{index}"})
        text_element(leg, GX, "duration", f"{times[index] - times[index - 1] if index else 0.0:.6f}")
        text_element(leg, GX, "flyToMode", "smooth" if index else "bounce")
        camera = SubElement(leg, f"{{{KML}}}Camera")
        text_element(camera, GX, "horizFov", f"{degrees(state[HFOV]):.6f}")
        text_element(camera, KML, "longitude", f"{place[1]:.9f}")
        text_element(camera, KML, "latitude", f"{place[0]:.9f}")
        text_element(camera, KML, "altitude", f"{place[2]:.4f}")
        text_element(camera, KML, "heading", f"{degrees((pi / 2 - state[CAM_YAW]) % (2 * pi)):.6f}")
        text_element(camera, KML, "tilt", f"{90 + degrees(state[CAM_PITCH]):.6f}")
        text_element(camera, KML, "roll", "0")
        text_element(camera, KML, "altitudeMode", "absolute")


def text_element(parent: Element, namespace: str, tag: str, text: str) -> None:
    """Append an element with a text to its parent."""
    SubElement(parent, f"{{{namespace}}}{tag}").text = text
