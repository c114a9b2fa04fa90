"""The KML tours: valid by the schemas, and each camera where the plan has it."""

from __future__ import annotations

from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pymap3d
import pytest

from shotc.emit.kml import EMITTER, GX, KML
from shotc.geom.bernstein import Piecewise
from shotc.ir.path import CAM_PITCH, CAM_YAW, HFOV
from shotc.ir.trajectory import VerifiedIR
from tests.support.film_plans import orbit_plan
from tests.support.records import replace
from tests.support.show_plans import plan as show_plan

PLAN = orbit_plan()
CHILDREN = ["horizFov", "longitude", "latitude", "altitude", "heading", "tilt", "roll", "altitudeMode"]


def tour(plan: VerifiedIR) -> ElementTree.Element:
    (artifact,) = EMITTER.emit(plan).artifacts
    assert artifact.name == "cam1.kml"
    return ElementTree.fromstring(artifact.data)


def zoomed(to: float) -> VerifiedIR:
    ir = PLAN.trajectory
    (drone,) = ir.drones
    ctrl = drone.curve.ctrl.copy()
    ctrl[:, :, HFOV] = np.radians(to)
    moved = replace(drone, curve=Piecewise(drone.curve.breaks, ctrl))
    return VerifiedIR(replace(ir, drones=(moved,)), PLAN.certificate)


def test_every_camera_is_that_of_the_plan() -> None:
    root = tour(PLAN)
    legs = root.findall(f".//{{{GX}}}FlyTo")
    times = 22.0 + np.cumsum([float(leg.findtext(f"{{{GX}}}duration")) for leg in legs])
    assert (times[0], times[-1]) == pytest.approx((22.0, 52.0), abs=1e-4)
    states = PLAN.trajectory.drones[0].curve(times)
    for leg, state in zip(legs, states, strict=True):
        camera = leg.find(f"{{{KML}}}Camera")
        assert [child.tag.rpartition("}")[2] for child in camera] == CHILDREN
        value = {child.tag.rpartition("}")[2]: child.text for child in camera}
        place = [float(value[k]) for k in ("latitude", "longitude", "altitude")]
        at = pymap3d.geodetic2enu(*place, 47.3769, 8.5417, 408.0)
        assert np.linalg.norm(at - state[:3]) < 1e-3
        turn = np.radians(90.0 - float(value["heading"])) - state[CAM_YAW]
        assert np.degrees(np.abs(np.angle(np.exp(1j * turn)))) < 1e-4
        assert np.radians(float(value["tilt"]) - 90.0) == pytest.approx(state[CAM_PITCH], abs=1e-6)
        assert np.radians(float(value["horizFov"])) == pytest.approx(state[HFOV], abs=1e-6)
    assert [leg.findtext(f"{{{GX}}}flyToMode") for leg in legs[:2]] == ["bounce", "smooth"]


def test_the_file_is_valid_by_the_schemas_of_ogc_and_google() -> None:
    etree = pytest.importorskip("lxml.etree", reason="lxml validates by schemas")
    fastkml = pytest.importorskip("fastkml", reason="it brings the schemas")
    schemas = sorted(Path(fastkml.__file__).parent.rglob("ogckml22.xsd"))
    schema = etree.XMLSchema(etree.parse(str(schemas[0])))
    (artifact,) = EMITTER.emit(PLAN).artifacts
    document = etree.fromstring(artifact.data)
    assert schema.validate(document), schema.error_log
    camera = document.find(f".//{{{KML}}}Camera")
    camera.append(camera[0])  # what an earlier version wrote
    assert not schema.validate(document)


def test_a_lens_that_the_viewer_has_not_is_told() -> None:
    assert EMITTER.emit(PLAN).notes == ()
    assert "shows 10 to 170 deg" in EMITTER.emit(zoomed(8.0)).notes[0]


def test_a_mission_without_an_origin_gets_a_warning_and_no_file() -> None:
    emission = EMITTER.emit(orbit_plan(origin=False))
    assert emission.artifacts == ()
    assert [d.code for d in emission.diagnostics] == ["E101"]


def test_a_fleet_gets_no_tour_and_a_note_says_so() -> None:
    emission = EMITTER.emit(show_plan())
    assert emission.artifacts == ()
    assert "fleets" in emission.notes[0]
