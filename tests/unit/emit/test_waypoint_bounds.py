"""By how much places are too near to what binds a flight: zones to stay in, ground and height as well."""

from __future__ import annotations

import numpy as np
import pytest

from shotc.emit.waypoints.clearance import bounds, keep_outs, nearer_between, shortfall
from shotc.emit.waypoints.models import CURVED, ROUNDED
from shotc.emit.waypoints.route import Route
from shotc.emit.waypoints.timing import evenly
from shotc.geom.bernstein import bernstein_basis
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


def at_shares(curves, count):
    """Places (k * count, 3) of Bernstein cubics (k, 4, 3)."""
    basis = bernstein_basis(3, np.linspace(0.0, 1.0, count))
    return np.einsum("tk,nkd->ntd", basis, curves).reshape(-1, 3)


def test_what_no_sample_shows_is_found_between_them():
    # A straight leg that touches the clearance of the tower half-way between two samples of it.
    tower = BOUNDS["target tower"]
    y = 6.0 + float(shortfall(tower, np.array([[0.0, 6.0, 5.0]]))[0])
    leg = np.linspace([-20.0, y, 5.0], [20.0, y, 5.0], 4)[None]
    assert shortfall(tower, at_shares(leg, 160)).max() < -1e-4
    place, depth = nearer_between(tower, leg, -1e-5)
    assert np.abs(place[0]) < 0.05
    assert depth == pytest.approx(0.0, abs=1e-4)
    assert nearer_between(tower, leg, 1e-3) is None


@pytest.mark.slow
@pytest.mark.parametrize("owner", list(BOUNDS))
def test_what_is_proved_holds_at_every_place_and_what_is_not_does_not(owner):
    rng = np.random.default_rng(7)
    for _ in range(20):
        curves = rng.uniform([-90, -90, 1], [90, 90, 24], (3, 4, 3))
        lacks = float(shortfall(BOUNDS[owner], at_shares(curves, 2001)).max())
        assert nearer_between(BOUNDS[owner], curves, lacks + 0.1) is None
        assert nearer_between(BOUNDS[owner], curves, lacks - 1e-6) is not None


@pytest.mark.parametrize("shape", [*CURVED, *ROUNDED])
def test_the_cubics_of_a_shape_are_the_curves_that_it_samples(shape):
    points = np.array([[0.0, 0, 10], [10, 5, 12], [14, 15, 9], [3, 20, 11]])
    stops = np.array([True, False, False, True])
    route = Route(points, np.zeros(4), np.zeros(4), np.ones(4), stops, np.full(4, 1.5), ((),) * 4)
    dense = at_shares(shape.cubics(route), 1001)
    for place in shape.samples(route, 16).reshape(-1, 3):
        assert np.linalg.norm(dense - place, axis=1).min() < 0.02
