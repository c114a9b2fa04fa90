"""The map of the site and the report: volumes by arithmetic of the tests' own, files by readers of others."""

from __future__ import annotations

import re
from html.parser import HTMLParser
from io import BytesIO
from pathlib import Path
from xml.etree.ElementTree import Element, fromstring
from zipfile import ZipFile

import numpy as np
import pymap3d
import pytest
from scipy.spatial.distance import pdist

from shotc.emit.report import EMITTER as REPORT
from shotc.emit.report.nearness import nearness
from shotc.emit.site import EMITTER as SITE
from shotc.emit.site.volumes import volumes
from shotc.geom.fleet_spline import places
from shotc.ir.trajectory import VerifiedIR
from tests.support import show_flights
from tests.support.film_plans import orbit_plan
from tests.support.records import replace
from tests.support.show_plans import display, mission, plan
from tests.support.standing_worlds import SIDE, STEP, house, terrain
from tests.support.surfaces import grid

KML = "{http://www.opengis.net/kml/2.2}"
SHOW = show_flights.plan()


def flown_points(made: VerifiedIR) -> np.ndarray:
    """Places of all drones at many times, (k, 3)."""
    fleets = [
        places(f.breaks, f.coef, np.linspace(0.0, f.breaks[-1], 400)).reshape(-1, 3)
        for f in made.trajectory.fleets
    ]
    drones = [d.curve(np.linspace(0.0, d.curve.end, 2000))[:, :3] for d in made.trajectory.drones]
    return np.concatenate([*fleets, *drones])


def clearances(corners: np.ndarray, points: np.ndarray) -> np.ndarray:
    """How far inside of a counter-clockwise convex polygon points are, from its nearest side."""
    ahead = np.roll(corners, -1, axis=0) - corners
    inward = np.stack([-ahead[:, 1], ahead[:, 0]], axis=-1) / np.linalg.norm(ahead, axis=1)[:, None]
    return np.min(
        [(points - corner) @ normal for corner, normal in zip(corners, inward, strict=True)], axis=0
    )


@pytest.mark.parametrize("made", [SHOW, orbit_plan(), plan()], ids=["show", "film", "row of pads"])
def test_volumes_hold_the_flight_with_their_margins(made: VerifiedIR) -> None:
    found, points = volumes(made.trajectory), flown_points(made)
    radius = 0.3 if made.trajectory.fleets else made.trajectory.keyframes.mission.drones[0].radius
    assert clearances(found.flight.corners, points[:, :2]).min() >= radius - 1e-9
    assert found.flight.top >= points[:, 2].max() + radius - 1e-9
    for inner, outer, margin in (
        (found.flight, found.contingency, found.across),
        (found.contingency, found.risk, found.buffer),
    ):
        room = clearances(outer.corners, inner.corners)
        assert margin - 1e-9 <= room.min() <= room.max() < 1.02 * margin + 1.0
    assert found.buffer == pytest.approx(found.contingency.top - found.ground)
    limits = (made.trajectory.keyframes.mission.fleets or made.trajectory.keyframes.mission.drones)[0].limits
    assert found.across == pytest.approx(7.0 + limits.speed + limits.speed**2 / (2 * limits.acceleration))


def site(made: VerifiedIR) -> Element:
    (artifact,) = SITE.emit(made).artifacts
    assert artifact.name.endswith("-site.kmz")
    with ZipFile(BytesIO(artifact.data)) as archive:
        assert archive.namelist() == ["doc.kml"]
        return fromstring(archive.read("doc.kml"))


def coordinates(mark: Element) -> np.ndarray:
    """Places in W of what a mark draws."""
    origin = SHOW.trajectory.keyframes.mission.origin
    rows = [
        [float(x) for x in triple.split(",")]
        for element in mark.iter(f"{KML}coordinates")
        for triple in (element.text or "").split()
    ]
    lon, lat, alt = np.array(rows).T
    return np.stack(pymap3d.geodetic2enu(lat, lon, alt, *origin), axis=-1)


def test_the_map_has_pads_volumes_zones_and_audience_in_their_places() -> None:
    marks = {mark.findtext(f"{KML}name"): mark for mark in site(SHOW).iter(f"{KML}Placemark")}
    found, asked = volumes(SHOW.trajectory), SHOW.trajectory.keyframes.mission
    ring = coordinates(marks["contingency volume"])
    np.testing.assert_allclose(ring[0], ring[-1], atol=1e-6)
    np.testing.assert_allclose(ring[:-1, :2], found.contingency.corners, atol=2e-3)
    np.testing.assert_allclose(ring[:, 2], found.contingency.top, atol=2e-3)
    pads = np.array([coordinates(marks[f"swarm-{i:02d}"])[0] for i in range(1, 61)])
    np.testing.assert_allclose(pads, np.array(asked.fleets[0].pads), atol=2e-3)
    np.testing.assert_allclose(coordinates(marks["audience of shapes"])[0], (0.0, -50.0, 2.0), atol=2e-3)
    field = coordinates(marks["zone field"])[:-1, :2]
    np.testing.assert_allclose(field, np.array(asked.zones[0].solid.points), atol=2e-3)
    mast = np.linalg.norm(coordinates(marks["zone mast"])[:, :2] - (-40.0, 80.0), axis=1)
    np.testing.assert_allclose(mast, 3.0, rtol=3e-3)


@pytest.mark.parametrize("made", [SHOW, orbit_plan()], ids=["show", "film"])
def test_the_map_is_valid_and_read_by_another_library(made: VerifiedIR) -> None:
    etree = pytest.importorskip("lxml.etree", reason="lxml validates by schemas")
    fastkml = pytest.importorskip("fastkml", reason="it reads KML, and brings the schemas")
    (artifact,) = SITE.emit(made).artifacts
    with ZipFile(BytesIO(artifact.data)) as archive:
        data = archive.read("doc.kml")
    (path, *_) = sorted(Path(fastkml.__file__).parent.rglob("ogckml22.xsd"))
    schema = etree.XMLSchema(etree.parse(str(path)))
    assert schema.validate(etree.fromstring(data)), schema.error_log
    document = fastkml.KML.parse(BytesIO(data)).features[0]
    named = {feature.name: feature for feature in document.features}
    assert {"flight geography", "contingency volume", "ground risk buffer"} <= named.keys()
    assert named["flight geography"].geometry.has_z


@pytest.mark.slow
def test_many_pads_are_one_mark() -> None:
    made = show_flights.plan(show_flights.mission(600), step=4.0)
    marks = {mark.findtext(f"{KML}name"): mark for mark in site(made).iter(f"{KML}Placemark")}
    assert len(coordinates(marks["pads of swarm, 600 drones"])) == 600


def test_without_a_place_on_earth_there_is_no_map_and_a_warning() -> None:
    done = SITE.emit(plan(mission(origin=None)))
    assert done.artifacts == ()
    assert [d.code for d in done.diagnostics] == ["E130"]


class Reader(HTMLParser):
    """Tags that are closed in the order in which they were opened, and all text."""

    VOID = ("meta", "rect", "polygon", "path", "circle", "polyline")

    def __init__(self, text: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.texts: list[str] = []
        self.feed(text)
        assert self.open == []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        assert not {"src", "href"}.intersection(name for name, _ in attrs)
        if tag not in self.VOID:
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        if tag not in self.VOID:
            assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        self.texts.append(data.strip())


@pytest.mark.parametrize("made", [plan(), orbit_plan()], ids=["show", "film"])
def test_the_report_has_every_requirement_and_needs_nothing_else(made: VerifiedIR) -> None:
    (artifact,) = REPORT.emit(made).artifacts
    text = artifact.data.decode()
    assert not re.search(r"https?://(?!www\.w3\.org/2000/svg)|@import|url\(", text)
    texts = Reader(text).texts
    assert made.certificate
    for claim in made.certificate:
        assert claim.constraint in texts
    hard = [claim for claim in made.certificate if claim.hard]
    assert f"{sum(c.holds for c in hard)} of {len(hard)} requirements hold" in text
    assert made.trajectory.keyframes.mission.source_sha256 in text


def test_what_is_broken_stands_out_and_names_are_escaped() -> None:
    made = plan(mission(name="<b>show</b>"))
    broken = replace(made.certificate[0], holds=False, hard=True)
    (artifact,) = REPORT.emit(replace(made, certificate=(broken, *made.certificate[1:]))).artifacts
    text = artifact.data.decode()
    assert '<tr class="broken"><td>BROKEN</td>' in text
    assert "<b>" not in text


@pytest.mark.parametrize("shape", ["ellipsoid", "cylinder"])
def test_the_nearest_pairs_are_those_of_all_pairs(shape: str) -> None:
    asked = show_flights.mission(40)
    swarm = asked.fleets[0]
    fleets = (swarm._replace(apart=swarm.apart._replace(shape=shape)),)
    made = show_flights.plan(asked._replace(fleets=fleets))
    (found,) = nearness(made.trajectory)
    flight = made.trajectory.fleets[0]
    at = np.moveaxis(places(flight.breaks, flight.coef, found.times), 1, 0) / (1.15, 1.15, 2.15)
    if shape == "ellipsoid":
        wanted = [pdist(row).min() for row in at]
    else:
        wanted = [np.maximum(pdist(row[:, :2]), pdist(row[:, 2:])).min() for row in at]
    np.testing.assert_allclose(found.distances, 1.15 * np.array(wanted), rtol=1e-9)
    assert found.needed == pytest.approx(1.15)


def test_an_audience_in_the_ground_risk_buffer_is_told() -> None:
    near = display()._replace(viewpoint=(6.0, -30.0, 2.0))
    far = display()._replace(viewpoint=(6.0, -300.0, 2.0))
    for seat, words in (
        (near, "stands inside the ground risk buffer"),
        (far, "outside the ground risk buffer"),
    ):
        (artifact,) = REPORT.emit(plan(mission(displays=(seat,)))).artifacts
        assert words in artifact.data.decode()


def over_a_slope(fall: float) -> VerifiedIR:
    """A show on pads at z = 0 over ground that falls by so many metres to each metre to the South."""
    y = (np.arange(SIDE) - SIDE // 2) * STEP
    shape = grid(np.repeat(np.minimum(fall * y, 0.0)[None], SIDE, axis=0), STEP)
    built = (house((30.0, 20.0, 5.0), (10.0, 10.0, 10.0)),)
    return plan(mission(terrain=terrain(shape), meshes=built))


@pytest.mark.slow
def test_over_terrain_the_ground_risk_buffer_is_as_wide_as_the_flight_is_high_over_its_lowest_ground() -> (
    None
):
    flat, slope = volumes(over_a_slope(0.0).trajectory), volumes(over_a_slope(0.3).trajectory)
    assert flat.base == "the lowest pad"
    assert flat.buffer == volumes(plan().trajectory).buffer
    south = float(slope.risk.corners[:, 1].min())
    assert slope.base == "the lowest ground below it"
    assert slope.ground <= 0.3 * south  # the ground at the southern end of the buffer
    assert slope.ground >= 0.3 * (south - STEP) - 1e-9
    assert slope.buffer == pytest.approx(slope.contingency.top - slope.ground)
    assert slope.buffer > flat.buffer + 10.0


def test_the_report_of_a_show_over_terrain_names_what_stands_there_and_draws_it() -> None:
    (artifact,) = REPORT.emit(over_a_slope(0.3)).artifacts
    page = artifact.data.decode()
    assert "the mission knows terrain (`relief.csv`)" in page
    assert "`houses.geojson`; drones keep 2 m from it" in page
    assert "over the lowest ground below it" in page
    assert page.count('<polygon class="house"') == 1
    assert "beyond `relief.csv`" not in page
