"""The judge of flights beside meshes: what is claimed is what is flown, and what breaks it is found."""

from __future__ import annotations

import numpy as np
import pytest

from shotc.passes.verify import Verify
from tests.support.mesh_spaces import with_meshes
from tests.support.scenes import fine, house, turned
from tests.support.surfaces import distances
from tests.support.tampered_plans import MISSION, PLAN, with_mission
from tests.support.verdicts import CONTEXT, verdict_on

TRACK, DRONE = PLAN.drones[0], MISSION.drones[0]
HOUSE = fine(house(9.0, 8.0, 6.0, 9.0), 1)
NAME = "distance from scene"


def places(*phases: str) -> np.ndarray:
    spans = [np.arange(p.start, p.end, 0.02) for p in TRACK.phases if p.name in phases]
    return TRACK.curve(np.concatenate(spans))[:, :3]


def beside(at, *, more: float = 0.0):
    """The plan in a world with a house at a place, so much higher."""
    made = turned(HOUSE, 0.3, at) + np.array([0.0, 0.0, more])
    return made, with_mission(meshes=with_meshes(MISSION, made).meshes)


def claims(ir) -> dict:
    return {c.constraint: c for c in verdict_on(ir).certificate if NAME in c.constraint}


@pytest.mark.slow
def test_the_distance_that_is_claimed_is_that_of_the_body_as_it_flies():
    x, y, z = places("shot").mean(axis=0)
    made, ir = beside((x, y), more=z - 20.0)
    found = claims(ir)[NAME]
    flown = places("transit", "shot", "hold", "return")
    true = distances(made, flown[::20]).min() - DRONE.radius
    assert found.method == "bounded"
    assert found.limit == MISSION.rules.obstacle_clearance
    assert true - 0.3 <= found.worst <= true + 1e-6
    assert found.holds
    assert Verify().run(ir, CONTEXT).value is not None


@pytest.mark.slow
def test_a_flight_too_near_to_a_house_is_refused_at_the_rule():
    middle = places("shot")[len(places("shot")) // 2]
    made, ir = beside(middle[:2], more=middle[2] - 10.0)
    found = claims(ir)[NAME]
    assert not found.holds
    assert found.worst < 2.0
    outcome = Verify().run(ir, CONTEXT)
    assert outcome.value is None
    (told,) = (d for d in outcome.diagnostics if d.code == "V052")
    assert any(note.startswith("nearest is `part 0` of the scene, at (") for note in told.notes)
    assert told.labels[-1].text == "`part 0` of the scene stands there"
    assert distances(made, middle[None])[0] < 2.0 + DRONE.radius


@pytest.mark.slow
def test_a_flight_through_a_wall_is_as_near_as_can_be():
    middle = places("shot")[len(places("shot")) // 2]
    _, ir = beside(middle[:2], more=middle[2] - 3.0)
    assert claims(ir)[NAME].worst <= 0.0


def test_a_flight_inside_of_a_hall_is_no_flight_beside_it():
    x, y, _ = places("transit", "shot", "return").mean(axis=0)
    hall = turned(house(900.0, 900.0, 200.0, 300.0), 0.0, (x, y)) - np.array([0.0, 0.0, 50.0])
    ir = with_mission(meshes=with_meshes(MISSION, hall).meshes)
    assert claims(ir)[NAME].worst < -40.0


@pytest.mark.slow
def test_at_home_the_body_comes_no_nearer_than_its_pad_is():
    x, y, z = DRONE.home
    wall = np.array([[[x + 0.4, y - 9.0, 0.0], [x + 0.4, y + 9.0, 0.0], [x + 0.4, y, 9.0]]])
    found = claims(with_mission(meshes=with_meshes(MISSION, wall).meshes))
    at_home = found[f"{NAME} at home"]
    assert at_home.limit == pytest.approx(min(0.4, DRONE.radius) - DRONE.radius)
    assert at_home.holds
    roof = np.array([[[x - 9, y - 9, z + 2.0], [x + 9, y - 9, z + 2.0], [x, y + 18, z + 2.0]]])
    over = claims(with_mission(meshes=with_meshes(MISSION, roof).meshes))[f"{NAME} at home"]
    assert not over.holds
