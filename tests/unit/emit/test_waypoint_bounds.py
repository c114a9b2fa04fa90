"""By how much places are too near to what binds a flight: zones to stay in, ground and height as well."""

from __future__ import annotations

import numpy as np
import pytest

from shotc.emit.waypoints.clearance import bounds, keep_outs, shortfall
from shotc.emit.waypoints.timing import evenly
from tests.support.film_plans import orbit_mission
from tests.support.records import replace

MISSION = replace(orbit_mission(), rules=orbit_mission().rules._replace(max_height=20.0))
BOUNDS = {str(o.owner): o for o in bounds(MISSION, MISSION.drones[0])}


@pytest.mark.parametrize(
    ("owner", "place", "lacking"),
    [
        ("ceiling", (0.0, -60.0, 21.0), 1.0),
        ("ceiling", (0.0, -60.0, 18.5), -1.5),
        ("ground", (0.0, -60.0, 2.0), 0.6),  # 2 m of ground clearance and a radius of 0.6 m
        ("zone field", (79.9, 0.0, 20.0), 0.5),
        ("zone field", (81.0, 0.0, 20.0), 1.6),
        ("zone field", (70.0, 0.0, 20.0), -9.4),
        ("zone tree", (-16.5, 10.0, 5.0), 0.1),
        ("target tower", (6.0, 0.0, 5.0), -0.4),
    ],
)
def test_what_is_lacking_is_what_is_asked_less_what_there_is(owner, place, lacking):
    assert shortfall(BOUNDS[owner], np.array([place]))[0] == pytest.approx(lacking, abs=1e-6)


def test_all_that_binds_is_what_is_kept_out_of_and_more():
    kept_out = {str(o.owner) for o in keep_outs(MISSION, MISSION.drones[0])}
    assert kept_out == {"zone tree", "target tower"}
    assert set(BOUNDS) == kept_out | {"zone field", "ground", "ceiling"}


def test_a_way_has_a_place_every_half_metre():
    way = evenly(np.array([[0.0, 0, 0], [3, 0, 0], [3, 4, 0]]))
    assert np.linalg.norm(np.diff(way, axis=0), axis=1).max() <= 0.5
    assert way[0].tolist() == [0, 0, 0]
    assert way[-1].tolist() == [3, 4, 0]
