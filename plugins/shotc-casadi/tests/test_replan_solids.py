"""Signed distances from solids: exact, and with the right gradients."""

from __future__ import annotations

from math import inf

import casadi as ca
import numpy as np
import pytest
from shotc_casadi.replan.solids import SolidConstraint, count, free_at, rooms

from shotc.geom.solids import Cylinder, Prism, box, signed_distance
from tests.support.replans import zone

SOLIDS = {
    "cylinder": Cylinder((1.0, -2.0), 2.0, 0.5, 4.0),
    "endless cylinder": Cylinder((1.0, -2.0), 2.0, -inf, inf),
    "tower": Cylinder((1.0, -2.0), 2.0, -inf, 4.0),
    "box": box((0.0, 1.0, 2.0), (3.0, 5.0, 2.0), 0.4),
    "endless prism": Prism(((-2.0, -1.0), (2.0, -1.0), (0.0, 3.0)), -inf, inf),
}
ELL = Prism(((0.0, 0.0), (6.0, 0.0), (6.0, 2.0), (2.0, 2.0), (2.0, 6.0), (0.0, 6.0)), 0.0, 5.0)
POINTS = np.random.default_rng(3).uniform([-6.0, -6.0, -3.0], [8.0, 8.0, 8.0], (400, 3))


def measured(room: SolidConstraint, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Room at points (M, 3), and its gradient (M, 3)."""
    p, sizes = ca.SX.sym("p", 3), ca.SX.sym("sizes", count(room.shape))
    free = free_at(room.shape, p, sizes)
    both = ca.Function("both", [p, sizes], [free, ca.gradient(free, p)])
    value, slope = both.map(len(points))(points.T, np.tile(room.parameters, (len(points), 1)).T)
    return np.array(value)[0], np.array(slope).T


@pytest.mark.parametrize("name", SOLIDS)
def test_the_distance_is_exact_inside_and_outside(name):
    (room,) = rooms(zone(SOLIDS[name], 0.3), 0.2)
    exact = [signed_distance(SOLIDS[name], tuple(p)) - 0.5 for p in POINTS]
    assert measured(room, POINTS)[0] == pytest.approx(exact, abs=1e-8)


@pytest.mark.parametrize("name", SOLIDS)
def test_the_gradient_is_that_of_the_distance(name):
    (room,) = rooms(zone(SOLIDS[name]), 0.0)
    value, slope = measured(room, POINTS)
    steps = 1e-6 * np.eye(3)
    numeric = np.column_stack(
        [(measured(room, POINTS + d)[0] - measured(room, POINTS - d)[0]) / 2e-6 for d in steps]
    )
    kinks = np.abs(slope - numeric).max(axis=1) > 1e-4
    assert kinks.mean() < 0.01  # where two faces are equally near
    assert np.linalg.norm(slope, axis=1) == pytest.approx(np.ones(len(POINTS)), abs=1e-6)
    assert value.min() < 0.0 < value.max()


@pytest.mark.parametrize("name", SOLIDS)
def test_where_its_linearisation_is_kept_the_distance_is(name):
    (room,) = rooms(zone(SOLIDS[name]), 0.0)
    value, slope = measured(room, POINTS)
    others = POINTS[::-1]
    linear = value + np.einsum("nd,nd->n", slope, others - POINTS)
    assert (linear <= measured(room, others)[0] + 1e-6).all()


def test_on_the_axis_of_a_cylinder_there_is_a_way_out():
    (room,) = rooms(zone(SOLIDS["endless cylinder"]), 0.0)
    value, slope = measured(room, np.array([[1.0, -2.0, 0.0], [1.0, 1.0, 0.0]]))
    assert value == pytest.approx([-2.0, 1.0], abs=1e-8)
    assert slope == pytest.approx(np.array([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]), abs=1e-8)


@pytest.mark.parametrize("solid", [*SOLIDS.values(), ELL], ids=[*SOLIDS, "ell"])
def test_a_place_is_inside_by_a_distance_where_no_room_lacks_it(solid):
    least = np.min([measured(room, POINTS)[0] for room in rooms(zone(solid, 0.1, inside=True), 0.1)], axis=0)
    exact = np.array([-signed_distance(solid, tuple(p)) - 0.2 for p in POINTS])
    clear = np.abs(exact) > 1e-6
    assert ((least > 0) == (exact > 0))[clear].all()
    inside = exact > 0
    assert inside.any()
    if solid is not ELL:
        assert least[inside] == pytest.approx(exact[inside], abs=1e-8)


def test_a_solid_with_a_notch_is_left_out_part_by_part():
    least = np.min([measured(room, POINTS)[0] for room in rooms(zone(ELL), 0.0)], axis=0)
    exact = np.array([signed_distance(ELL, tuple(p)) for p in POINTS])
    outside = exact > 0
    assert least[outside] == pytest.approx(exact[outside], abs=1e-8)
    assert (least[~outside] <= 1e-6).all()


@pytest.mark.parametrize("solid", [*SOLIDS.values(), ELL], ids=[*SOLIDS, "ell"])
def test_its_disc_is_nowhere_farther_off(solid):
    for room in rooms(zone(solid, 0.4), 0.1):
        x, y, radius = room.disc
        assert (
            np.hypot(POINTS[:, 0] - x, POINTS[:, 1] - y) - radius <= measured(room, POINTS)[0] + 1e-6
        ).all()
