"""Arrays of points and solids agree with one point and a solid at a time, wherever the point is."""

from __future__ import annotations

from math import inf, pi

import numpy as np
import pytest

from shotc.geom import solids
from shotc.geom.solid_arrays.points import (
    FAR_M,
    bounded,
    closest_points,
    distances,
    footprint_distances,
    in_convex,
    in_footprint,
    separation,
    signed_distance,
    support,
)
from shotc.geom.solids import Cylinder, Prism, Solid, convex_parts

ROUND = Cylinder((3.0, -4.0), 6.0, -5.0, 8.0)
SQUARE = Prism(((-10.0, -10.0), (10.0, -10.0), (10.0, 10.0), (-10.0, 10.0)), -5.0, 8.0)
BENT = Prism(((0.0, 0.0), (20.0, 0.0), (20.0, 5.0), (5.0, 5.0), (5.0, 20.0), (0.0, 20.0)), -5.0, 8.0)
POINTS = np.random.default_rng(1).uniform(-30.0, 30.0, (300, 3))


@pytest.mark.parametrize("solid", [ROUND, SQUARE, BENT])
def test_signed_distances_are_those_of_one_point_at_a_time(solid: Solid) -> None:
    exact = [solids.signed_distance(solid, tuple(p)) for p in POINTS]
    assert min(exact) < -1.0
    assert signed_distance(solid, POINTS) == pytest.approx(exact, abs=1e-9)


@pytest.mark.slow
def test_a_prism_that_is_not_convex_has_no_seam_within() -> None:
    # A star's parts are fans of triangles: on a diagonal, rounding may put a point between two of them.
    turns = np.arange(14) * pi / 7
    reach = np.where(np.arange(14) % 2, 0.37, 1.03)
    star = Prism(tuple(zip(reach * np.cos(turns), reach * np.sin(turns), strict=True)), -1.0, 1.0)
    shares = np.random.default_rng(0).uniform(0.1, 0.9, 4000)[:, None]
    for part in convex_parts(star):
        assert isinstance(part, Prism)
        corners = np.array(part.points)
        for a, b in ((0, 1), (1, 2), (2, 0)):
            flat = corners[a] + shares * (corners[b] - corners[a])
            middle = corners.mean(axis=0)
            within = flat[footprint_distances(star, flat + 1e-6 * (flat - middle)) == 0.0]
            assert (signed_distance(star, np.column_stack([within, 0.0 * within[:, 0]])) <= 0.0).all()


@pytest.mark.parametrize("part", [ROUND, SQUARE])
def test_inside_a_solid_a_point_is_its_own_closest_one(part: Solid) -> None:
    away, normals = separation(part, POINTS)
    inside = signed_distance(part, POINTS) <= 0
    assert inside.any()
    assert (away[inside] == 0.0).all()
    assert (normals[inside] == 0.0).all()
    assert (closest_points(part, POINTS)[inside] == POINTS[inside]).all()
    assert np.linalg.norm(normals[~inside], axis=1) == pytest.approx(1.0)
    assert away == pytest.approx(distances(part, POINTS))


@pytest.mark.parametrize("solid", [ROUND, SQUARE, BENT])
def test_a_footprint_is_what_a_solid_of_unlimited_height_is(solid: Solid) -> None:
    tall = solid._replace(bottom=-inf, top=inf)
    exact = [solids.distance(tall, tuple(p)) for p in POINTS]
    assert footprint_distances(solid, POINTS[:, :2]) == pytest.approx(exact, abs=1e-9)
    assert in_footprint(solid, POINTS[:, :2]).tolist() == [d == 0.0 for d in exact]


def test_the_border_of_a_convex_polygon_is_in_it() -> None:
    corners = np.array(SQUARE.points)
    assert in_convex(corners, np.array([[10.0, 3.0], [-10.0, -10.0], [10.0 + 1e-9, 3.0]])).tolist() == [
        True,
        True,
        False,
    ]


def test_a_height_without_limit_is_one_that_nobody_reaches() -> None:
    column = ROUND._replace(bottom=-inf, top=inf)
    assert bounded(column) == ROUND._replace(bottom=-FAR_M, top=FAR_M)
    assert support(column, np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0]])).tolist() == [FAR_M, 9.0]
    above = np.array([[30.0, -4.0, 1e6]])
    assert distances(column, above).tolist() == [21.0]
