"""Routes: shortest where that is known, free of everything, and sensible about flying over."""

from __future__ import annotations

from math import acos, asin, sqrt

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from shotc.geom.solid_arrays.segments import segment_distances
from shotc.geom.solids import Cylinder, Prism, box
from shotc.planning.free_space import FreeSpace, Obstacle, Wall, breaches
from shotc.planning.path import route as route_module
from shotc.planning.path.route import DETOUR_RATIO, find_route, length
from tests.support.owners import owner

GROUND = Wall(owner("ground"), (0.0, 0.0, 1.0), 2.6)
ROOF = Wall(owner("zone yard"), (0.0, 0.0, -1.0), -19.4)


def block(x, y, z):
    return Prism(((x[0], y[0]), (x[1], y[0]), (x[1], y[1]), (x[0], y[1])), *z)


def space(*solids, clearance=0.6, walls=(GROUND,)):
    return FreeSpace(tuple(Obstacle(f"zone {i}", s, clearance) for i, s in enumerate(solids)), walls, ())


def way(made, a, b):
    return find_route(made, np.array(a, dtype=float), np.array(b, dtype=float))


def test_a_free_way_is_straight():
    route = way(space(box((0, 50, 5), (4, 4, 10), 0)), (-10, 0, 5), (10, 0, 9))
    assert route.tolist() == [[-10, 0, 5], [10, 0, 9]]


def test_round_a_wall_the_way_is_hardly_longer_than_the_shortest():
    made = space(block((-1, 1), (-40, 12), (0, 60)))
    route = way(made, (-20, 0, 8), (20, 0, 8))
    corner = 2 * sqrt(19**2 + 12**2) + 2  # taut string round the wall itself
    assert corner <= length(route) <= 1.1 * (corner + 1.5)
    assert route[1:-1, 1].min() > 12
    assert np.ptp(route[:, 2]) == 0


def test_round_a_cylinder_it_is_a_tangent_and_an_arc():
    radius, away = 5.0, 30.0
    route = way(
        space(Cylinder((0.0, 0.0), radius, 0.0, 80.0), walls=(GROUND, ROOF)), (-away, 0, 8), (away, 0, 8)
    )
    reach = radius + 0.6
    taut = 2 * sqrt(away**2 - reach**2) + reach * (np.pi - 2 * acos(reach / away))
    assert taut <= length(route) <= 1.03 * taut
    assert asin(reach / away) > 0


def test_a_long_low_wall_is_flown_over_and_a_short_high_one_is_not():
    over = way(space(block((-1, 1), (-200, 200), (0, 10))), (-30, 0, 8), (30, 0, 8))
    assert over[:, 2].max() > 10.6
    assert np.abs(over[:, 1]).max() < 1
    beside = way(space(block((-1, 1), (-6, 6), (0, 12))), (-30, 0, 8), (30, 0, 8))
    assert np.abs(beside[:, 1]).max() > 6.6
    assert np.ptp(beside[:, 2]) < 1e-9


def test_it_flies_beneath_what_hangs():
    route = way(space(block((-1, 1), (-200, 200), (8, 60))), (-30, 0, 10), (30, 0, 10))
    crossing = np.interp(0.0, route[:, 0], route[:, 2])
    assert 2.6 <= crossing <= 7.4


def test_heights_change_evenly_along_the_way():
    route = way(space(block((-1, 1), (-8, 8), (0, 60))), (-30, 0, 5), (30, 0, 15))
    flat = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(route[:, :2], axis=0), axis=1))])
    assert route[:, 2] == pytest.approx(5 + 10 * flat / flat[-1])


@pytest.mark.slow
def test_corners_above_one_another_are_one_where_heights_change_evenly():
    """The way ends close over a roof, whose corner right above the end is levelled down onto it."""
    roof, tower = Cylinder((112.6, -108.8), 119.4, 0.0, 11.75), Cylinder((24.7, 94.3), 110.0, 0.0, 12.4)
    route = way(space(roof, tower, clearance=4.6), (244, 245, 17), (0, -60, 16.45))
    assert len(route) > 2
    assert np.linalg.norm(np.diff(route, axis=0), axis=1).min() > 1e-3


def test_there_may_be_no_way():
    yard = (
        GROUND,
        ROOF,
        Wall(owner("zone yard"), (0.0, 1.0, 0.0), -30.0),
        Wall(owner("zone yard"), (0.0, -1.0, 0.0), -30.0),
    )
    assert way(space(block((-1, 1), (-40, 40), (0, 60)), walls=yard), (-20, 0, 8), (20, 0, 8)) is None
    open_side = space(block((-1, 1), (-40, 25), (0, 60)), walls=yard)
    assert way(open_side, (-20, 0, 8), (20, 0, 8))[1:-1, 1].min() > 25.6


def test_a_roomy_way_is_taken_only_where_it_is_hardly_longer():
    gap = (block((-1, 1), (-90, -0.8), (0, 60)), block((-1, 1), (0.8, 20), (0, 60)))
    through = way(space(*gap), (-20, 3, 8), (20, 3, 8))
    assert np.abs(through[1:-1, 1]).max() < 0.8
    alone = way(space(block((-1, 1), (-4, 4), (0, 60))), (-20, 0, 8), (20, 0, 8))
    assert np.abs(alone[1:-1, 1]).max() > 4 + 0.6 + 0.9  # there is room: keep a metre off
    assert DETOUR_RATIO > 1


def test_ends_close_to_a_face_find_their_way_out():
    made = space(block((-1, 1), (-10, 10), (0, 60)))
    route = way(made, (-1.601, 0, 8), (1.601, 0, 8))
    assert np.abs(route[1:-1, 1]).max() > 10.6


@pytest.mark.long
@settings(max_examples=40, deadline=None)
@given(
    st.lists(
        st.tuples(st.floats(-20, 20), st.floats(-20, 20), st.floats(0.5, 5), st.floats(4, 30)),
        min_size=1,
        max_size=6,
    )
)
def test_every_leg_keeps_its_clearance(trees):
    made = space(*(Cylinder((x, y), r, 0.0, h) for x, y, r, h in trees))
    a, b = np.array([-30.0, 0.0, 6.0]), np.array([30.0, 3.0, 9.0])
    assume(not breaches(made, a) and not breaches(made, b))
    route = find_route(made, a, b)
    assert route is not None
    for o in made.obstacles:
        assert segment_distances(o.part, route[:-1], route[1:]).min() >= o.clearance - 1e-9
    assert route[:, 2].min() >= 2.6
    assert (route[0] == a).all()
    assert (route[-1] == b).all()


def test_a_way_to_the_edge_of_a_wood_tests_few_edges(monkeypatch):
    """Each edge was tested against all trees, also those that lead away: 24 such searches took minutes."""
    rng = np.random.default_rng(4)
    trees = [
        Cylinder(
            (x + rng.uniform(-2, 2), y + rng.uniform(-2, 2)), rng.uniform(1.2, 2), 0.0, rng.uniform(8, 14)
        )
        for y in (14.0, 23.0)
        for x in range(-50, 60, 9)
    ]
    made, tested, clip = space(*trees, clearance=2.5), [0], route_module._clip

    def counted(g, a, b, reach):
        tested[0] += len(a)
        return clip(g, a, b, reach)

    monkeypatch.setattr(route_module, "_clip", counted)
    route = way(made, (-30, -20, 3), (-19, 18.5, 3.8))
    assert route is not None
    assert length(route) == pytest.approx(41.303, abs=0.01)
    assert tested[0] < 20_000  # it was 381,289
