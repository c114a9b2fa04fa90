"""Segments and solids in the plane: who crosses whom, at the borders."""

from __future__ import annotations

import pytest

from shotc.geom.solids import Cylinder, Prism, convex_parts, segments_cross, signed_area, signed_distance
from shotc.geom.vec import Vec3

LONG = ((0.0, 0.0), (4.0, 0.0))


@pytest.mark.parametrize(
    ("other", "crosses"),
    [
        (((2.0, -1.0), (2.0, 1.0)), True),
        (((2.0, 1.0), (2.0, 0.0)), True),  # ends on it
        (((2.0, 0.0), (2.0, 1.0)), True),  # starts on it
        (((4.0, 0.0), (5.0, 1.0)), True),  # shares an end
        (((3.0, 0.0), (6.0, 0.0)), True),  # along it, and on
        (((5.0, 0.0), (6.0, 0.0)), False),  # along it, beyond
        (((2.0, 1.0), (2.0, 0.1)), False),
        (((5.0, -1.0), (3.9, 1.0)), False),  # boxes overlap
        (((5.0, -1.0), (3.0, 0.5)), True),
    ],
)
def test_two_segments_cross_or_touch_whichever_comes_first(other, crosses: bool) -> None:
    (a, b), (c, d) = LONG, other
    for first, second in (((a, b), (c, d)), ((b, a), (d, c))):
        assert segments_cross(*first, *second) is crosses
        assert segments_cross(*second, *first) is crosses


@pytest.mark.parametrize(
    ("points", "parts"),
    [
        (((0, 0), (4, 0), (4, 3), (0, 3)), 1),
        (((0, 0), (2, 0), (4, 0), (4, 3), (0, 3)), 1),  # a corner on a side
        (((0, 0), (0.1, 0.3), (0.2, 0.6), (-3, 1)), 1),  # on a side, but for rounding
        (((0, 0), (2, 0.1), (4, 0), (4, 3), (0, 3)), 3),  # a corner that points inside
        (((0, 0), (4, 0), (4, 3), (3.9, 1.5)), 2),
    ],
)
def test_a_footprint_is_one_part_unless_a_corner_of_it_points_inside(points, parts: int) -> None:
    split = convex_parts(Prism(points, 0.0, 2.0))
    assert len(split) == parts
    areas = [signed_area(part.points) for part in split if isinstance(part, Prism)]
    assert sum(areas) == pytest.approx(signed_area(points))
    assert min(areas) > 0.0


@pytest.mark.parametrize(
    ("p", "nearest"),
    [
        ((7.0, 8.0, 9.0), (4.0, 4.0, 5.0)),
        ((1.5, 0.0, 3.0), (1.5, 0.0, 3.0)),
        ((1.0, 0.0, -7.0), (1.0, 0.0, 2.0)),
        ((-9.0, 0.0, 4.0), (-4.0, 0.0, 4.0)),
    ],
)
def test_the_nearest_point_of_a_cylinder(p: Vec3, nearest: Vec3) -> None:
    assert Cylinder((1.0, 0.0), 5.0, 2.0, 5.0).closest(p) == pytest.approx(nearest)


def test_the_nearest_point_of_a_prism_is_on_the_side_that_is_nearest() -> None:
    wedge = Prism(((0.0, 0.0), (6.0, 0.0), (0.0, 8.0)), 1.0, 3.0)
    assert wedge.closest((1.0, 1.0, 9.0)) == (1.0, 1.0, 3.0)
    assert wedge.closest((2.0, -5.0, 2.0)) == pytest.approx((2.0, 0.0, 2.0))
    assert wedge.closest((7.0, 7.0, 0.0)) == pytest.approx((3.0, 4.0, 1.0))
    assert wedge.closest((-1.0, 9.0, 2.0)) == pytest.approx((0.0, 8.0, 2.0))


@pytest.mark.parametrize(
    ("p", "metres"),
    [
        ((1.0, 0.0, 3.0), -1.0),  # inside, nearest to the bottom
        ((1.0, 0.0, 4.5), -0.5),  # inside, nearest to the top
        ((5.5, 0.0, 3.5), -0.5),  # inside, nearest to the side
        ((9.0, 0.0, 3.5), 3.0),
        ((1.0, 0.0, 7.5), 2.5),
        ((1.0, 0.0, -2.0), 4.0),
        ((9.0, 0.0, 9.0), 5.0),  # beside and above
        ((1.0, 9.0, -2.0), 32**0.5),  # beside and below
    ],
)
def test_the_signed_distance_from_a_cylinder(p: Vec3, metres: float) -> None:
    assert signed_distance(Cylinder((1.0, 0.0), 5.0, 2.0, 5.0), p) == pytest.approx(metres)


@pytest.mark.parametrize(
    ("p", "metres"),
    [
        ((1.0, 0.75, 2.0), -0.75),
        ((1.0, 1.0, 2.9), -0.1),
        ((3.0, -2.0, 2.0), 2.0),
        ((7.0, 7.0, 2.0), 5.0),
        ((1.0, 1.0, 0.0), 1.0),
        ((7.0, 7.0, 15.0), 13.0),
    ],
)
def test_the_signed_distance_from_a_prism(p: Vec3, metres: float) -> None:
    wedge = Prism(((0.0, 0.0), (6.0, 0.0), (0.0, 8.0)), 1.0, 3.0)
    assert signed_distance(wedge, p) == pytest.approx(metres)
