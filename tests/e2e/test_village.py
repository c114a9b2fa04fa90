"""A mission among the footprints of a village, planned whole, and held against every triangle."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np
import pytest

from shotc import api
from shotc.geom.surface.triangles import closest
from shotc.planfile.write import plan_bytes
from tests.support.compiled import compiled
from tests.support.records import replace
from tests.support.second_opinion.compiled import case_of
from tests.support.second_opinion.judge import judge

VILLAGE = Path(__file__).parents[2] / "specs" / "village"
MISSION = VILLAGE / "church-tower.yaml"

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def planned():
    done = compiled(MISSION, "none")
    assert done.plan is not None, done.diagnostics
    return done.plan


@pytest.mark.long
def test_the_church_is_the_boxes_about_its_parts_and_other_eyes_see_it(planned):
    mission = planned.trajectory.keyframes.mission
    assert mission.target("church").parts == ("church.nave", "church.choir", "church.tower")
    assert judge(case_of(MISSION, "none")) == []


@pytest.mark.long
def test_the_village_is_of_houses_and_of_the_parts_of_a_church(planned):
    (mesh,) = planned.trajectory.keyframes.mission.meshes
    assert {"nave", "choir", "tower", "Tithe barn"} <= set(mesh.names)
    assert "St. Verena" not in mesh.names
    assert len(mesh.names) == 35
    assert mesh.closed.all()


@pytest.mark.long
def test_the_body_keeps_its_distance_from_every_triangle(planned):
    (mesh,) = planned.trajectory.keyframes.mission.meshes
    flight, radius = planned.trajectory.drones[0], planned.trajectory.keyframes.mission.drones[0].radius
    within = [p for p in flight.phases if p.name not in ("takeoff", "land")]
    times = np.concatenate([np.arange(p.start, p.end, 0.1) for p in within])
    places = flight.curve(times)[:, :3]
    triangles = mesh.surface.triangles
    least = min(
        float(closest(triangles, np.tile(p, (len(triangles), 1))).distance.min()) - radius for p in places
    )
    (claim,) = [c for c in planned.certificate if c.constraint == "distance from buildings"]
    assert claim.method == "bounded"
    assert 3.0 - 1e-6 <= claim.worst <= least + 1e-6
    assert not mesh.holds(places).any()


def test_the_plan_is_verified_with_its_footprints_and_not_without(planned, tmp_path):
    (tmp_path / "plan.json").write_bytes(plan_bytes(_elsewhere(planned)))
    name = (tmp_path / "plan.json").as_posix()
    data = (tmp_path / "plan.json").read_bytes()
    assert b"Tithe barn" not in data
    assert [d.code for d in api.verify_plan(data, name).diagnostics] == ["V042", "N011"]
    shutil.copy(VILLAGE / "houses.geojson", tmp_path)
    assert api.verify_plan(data, name).plan is not None
    text = (tmp_path / "houses.geojson").read_text()
    (tmp_path / "houses.geojson").write_text(text.replace('"34 m"', '"35 m"'))
    assert [d.code for d in api.verify_plan(data, name).diagnostics] == ["V042", "N012"]


def _elsewhere(plan):
    """Return the plan as if its mission had been in a folder that is not there."""
    mission = plan.trajectory.keyframes.mission
    moved = mission.origins._replace(file="no-such-folder/church-tower.yaml")
    keyframes = replace(plan.trajectory.keyframes, mission=mission._replace(origins=moved))
    return replace(plan, trajectory=replace(plan.trajectory, keyframes=keyframes))
