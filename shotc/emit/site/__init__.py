"""<mission>-site.kmz: the site of a mission on the map, for Google Earth.

It shows pads, the hull of the flight with its margins, zones, and audiences. Heights are absolute: the
altitude of `world.origin` plus z.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar
from xml.etree.ElementTree import Element, SubElement, indent, tostring

import numpy as np

from shotc.emit.base import Artifact, Emission, without_origin
from shotc.emit.kml import KML, text_element
from shotc.emit.site.volumes import AreaOutline, Volumes, volumes
from shotc.emit.zip_parts import archive_parts
from shotc.filenames import file_name
from shotc.geom.bernstein import Array
from shotc.geom.earth import of_world
from shotc.geom.solid_arrays.rings import ground_plan
from shotc.ir.mission import GeoOrigin, MissionIR
from shotc.ir.show import drone_names
from shotc.ir.trajectory import VerifiedIR
from shotc.rounding import at_least

MOST_NAMED_PADS = 500
"""Most pads of a fleet that get a placemark each. A larger fleet gets one placemark for all pads, because the
viewer is slow with more.
"""
STYLES = {
    "flight": ("ffb4e07a", "667ae0b4"),
    "contingency": ("ff00a5ff", "3300a5ff"),
    "risk": ("ff3c3cd2", "223c3cd2"),
    "in": ("ffd8b25a", "00000000"),
    "out": ("ff2828c8", "662828c8"),
}
"""Colours of lines and of faces in KML's order: alpha, blue, green, red."""


@dataclass(frozen=True, slots=True)
class SiteEmitter:
    """Writes one file for the whole mission; the same plan gives the same bytes."""

    name: ClassVar[str] = "site"
    summary: ClassVar[str] = "<mission>-site.kmz: pads, hull of the flight with margins, zones and audience"
    api: ClassVar[int] = 1

    def emit(self, plan: VerifiedIR) -> Emission:
        """Return the file, or a warning if the mission has no origin."""
        mission = plan.trajectory.keyframes.mission
        if mission.origin is None:
            why = "what stands on a map has latitudes and longitudes"
            return Emission((), (without_origin(mission, "site", "E130", "the map of the site is", why),))
        data = b"".join(archive_parts([("doc.kml", document(plan, mission.origin))]))
        return Emission((Artifact(f"{file_name(mission.name)}-site.kmz", data),))


EMITTER = SiteEmitter()


def document(plan: VerifiedIR, origin: GeoOrigin) -> bytes:
    """Return the KML document of a mission's site."""
    mission = plan.trajectory.keyframes.mission
    root = Element(f"{{{KML}}}kml")
    folder = SubElement(root, f"{{{KML}}}Document")
    text_element(folder, KML, "name", f"{mission.name}: site")
    for name, colors in STYLES.items():
        _style(folder, name, colors)
    _volumes(folder, origin, volumes(plan.trajectory))
    _zones(folder, mission, origin)
    _pads(folder, mission, origin)
    for display in mission.displays:
        if display.viewpoint is not None:
            mark = _mark(folder, f"audience of {display.id}")
            _point(mark, origin, np.array([display.viewpoint]))
    indent(root)
    return bytes(tostring(root, encoding="utf-8", xml_declaration=True)) + b"\n"


def _style(folder: Element, name: str, colors: tuple[str, str]) -> None:
    style = SubElement(folder, f"{{{KML}}}Style", {"id": name})
    line = SubElement(style, f"{{{KML}}}LineStyle")
    text_element(line, KML, "color", colors[0])
    text_element(line, KML, "width", "2")
    text_element(SubElement(style, f"{{{KML}}}PolyStyle"), KML, "color", colors[1])


def _mark(folder: Element, name: str, style: str = "", about: str = "") -> Element:
    mark = SubElement(folder, f"{{{KML}}}Placemark")
    text_element(mark, KML, "name", name)
    if about:
        text_element(mark, KML, "description", about)
    if style:
        text_element(mark, KML, "styleUrl", f"#{style}")
    return mark


def _volumes(folder: Element, origin: GeoOrigin, site: Volumes) -> None:
    flight, margin = site.flight, site.contingency
    high = f"up to {at_least(flight.top - site.ground, 1)} m over {site.base}; the hull of all flights"
    _polygon(_mark(folder, "flight geography", "flight", high), origin, flight)
    wide = f"{site.across:.1f} m across and {site.upright:.1f} m upright about the flight geography"
    _polygon(_mark(folder, "contingency volume", "contingency", wide), origin, margin)
    ground = f"{site.buffer:.1f} m about the contingency volume, as wide as that is high (1:1)"
    _polygon(_mark(folder, "ground risk buffer", "risk", ground), origin, site.risk, flat=True)


def _zones(folder: Element, mission: MissionIR, origin: GeoOrigin) -> None:
    for zone in mission.zones:
        words = "stay inside" if zone.keep == "in" else "keep out"
        outline = AreaOutline(ground_plan(zone.solid), zone.solid.top)
        _polygon(_mark(folder, f"zone {zone.name}", zone.keep, words), origin, outline)


def _polygon(mark: Element, origin: GeoOrigin, outline: AreaOutline, *, flat: bool = False) -> None:
    """Draw an outline, either with walls from its height down to the ground, or flat on the ground."""
    polygon = SubElement(mark, f"{{{KML}}}Polygon")
    if not flat:
        text_element(polygon, KML, "extrude", "1")
    text_element(polygon, KML, "altitudeMode", "clampToGround" if flat else "absolute")
    ring = SubElement(SubElement(polygon, f"{{{KML}}}outerBoundaryIs"), f"{{{KML}}}LinearRing")
    closed = np.concatenate([outline.corners, outline.corners[:1]])
    points = np.column_stack([closed, np.full(len(closed), outline.top)])
    text_element(ring, KML, "coordinates", " ".join(_coordinates(points, origin)))


def _pads(folder: Element, mission: MissionIR, origin: GeoOrigin) -> None:
    for drone in mission.drones:
        _point(_mark(folder, f"home of {drone.name}"), origin, np.array([drone.home]))
    for fleet in mission.fleets:
        pads, names = np.array(fleet.pads), drone_names(fleet)
        if len(pads) > MOST_NAMED_PADS:
            _point(_mark(folder, f"pads of {fleet.name}, {len(pads)} drones"), origin, pads)
            continue
        group = SubElement(folder, f"{{{KML}}}Folder")
        text_element(group, KML, "name", f"pads of {fleet.name}")
        for name, pad in zip(names, pads, strict=True):
            _point(_mark(group, name), origin, pad[None])


def _point(mark: Element, origin: GeoOrigin, points: Array) -> None:
    parent = mark if len(points) == 1 else SubElement(mark, f"{{{KML}}}MultiGeometry")
    for text in _coordinates(points, origin):
        point = SubElement(parent, f"{{{KML}}}Point")
        text_element(point, KML, "altitudeMode", "absolute")
        text_element(point, KML, "coordinates", text)


def _coordinates(points: Array, origin: GeoOrigin) -> Iterator[str]:
    for lat, lon, alt in of_world(points, origin).tolist():
        yield f"{lon:.9f},{lat:.9f},{alt:.3f}"
