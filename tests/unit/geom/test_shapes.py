"""Boxes and groups against brute force: corners projected one by one, points of surfaces, other solids."""

from itertools import product
from math import atan2, cos, hypot, pi, radians, sin

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from shotc.geom.camera import View, frustum_margins, view
from shotc.geom.shapes import BoxShape, CylinderShape, GroupShape, Part, TargetShape, bodies_of, touch
from shotc.geom.silhouette import project_loop, shape_contour
from shotc.geom.solids import Prism, box, convex_hull, distance

HFOV, ASPECT = radians(60), 16 / 9
angles = st.floats(0.0, 2 * pi)
sides = st.floats(0.2, 12.0)
boxes = st.builds(
    lambda length, width, height, yaw: BoxShape(length, width, height, (cos(yaw), sin(yaw))),
    sides, sides, sides, angles,
)  # fmt: skip
cylinders = st.builds(CylinderShape, st.floats(0.2, 6.0), sides)
offsets = st.tuples(st.floats(-15, 15), st.floats(-15, 15), st.floats(-10, 10))
groups = st.lists(st.builds(Part, offsets, boxes | cylinders), min_size=2, max_size=3).map(
    lambda parts: GroupShape(tuple(parts))
)
looks = st.tuples(st.floats(8, 60), angles, st.floats(-1.2, 1.2), st.floats(-0.3, 0.3), st.floats(-0.3, 0.3))


def surface(shape: TargetShape) -> np.ndarray:
    """Points whose hull is the shape, or next to it, about its centre, (n, 3)."""
    points = []
    for offset, body in bodies_of(shape):
        if isinstance(body, BoxShape):
            c, s = body.ahead
            ring = [
                (
                    a * body.length / 2 * c - b * body.width / 2 * s,
                    a * body.length / 2 * s + b * body.width / 2 * c,
                )
                for a, b in product((-1, 1), repeat=2)
            ]
        else:
            turn = np.linspace(0, 2 * pi, 3000, endpoint=False)
            ring = list(zip(body.radius * np.cos(turn), body.radius * np.sin(turn), strict=True))
        points += [np.add(offset, (x, y, z)) for x, y in ring for z in (-body.height / 2, body.height / 2)]
    return np.array(points)


def seen_from(look: tuple[float, ...]) -> tuple[View, tuple[float, float, float]]:
    """Return a camera that looks at a shape, nearly, and the offset of the shape's centre."""
    far, around, above, aside, up = look
    away = (far * cos(around) * cos(above), far * sin(around) * cos(above), far * sin(above))
    yaw, pitch = atan2(-away[1], -away[0]) + aside, -above + up
    return view(yaw, max(-1.5, min(1.5, pitch)), HFOV, ASPECT), (-away[0], -away[1], -away[2])


@pytest.mark.long
@given(boxes | groups, looks)
def test_the_outline_is_that_of_all_its_points(shape: TargetShape, look: tuple[float, ...]) -> None:
    camera, offset = seen_from(look)
    points = tuple((surface(shape) + offset).T)
    depth = camera.to_camera(points)[2]
    assert shape.nearest_depth(camera, offset) == pytest.approx(depth.min(), abs=1e-4)
    assume(depth.min() > 0.5)
    u, v, _ = camera.project(points)
    assert shape.bounds(camera, offset) == pytest.approx(
        (u.min(), u.max(), v.min(), v.max()), rel=1e-5, abs=1e-5
    )


@pytest.mark.slow
@given(boxes | groups, looks)
def test_margins_are_those_of_the_point_nearest_to_the_edge(
    shape: TargetShape, look: tuple[float, ...]
) -> None:
    camera, offset = seen_from(look)
    brute = np.min(frustum_margins(camera, tuple((surface(shape) + offset).T)), axis=1)
    assert frustum_margins(camera, offset, shape) == pytest.approx(brute, abs=1e-4)


@pytest.mark.parametrize("around", [0.2, 1.9, 4.0])
@pytest.mark.parametrize("above", [-0.6, 0.0, 0.9])
def test_margins_of_a_turned_box_are_those_of_its_nearest_corner(around: float, above: float) -> None:
    shape = BoxShape(6.0, 2.0, 3.0, (0.6, 0.8))
    camera, offset = seen_from((20.0, around, above, 0.2, -0.1))
    brute = np.min(frustum_margins(camera, tuple((surface(shape) + offset).T)), axis=1)
    assert frustum_margins(camera, offset, shape) == pytest.approx(brute, abs=1e-9)


@pytest.mark.slow
@given(boxes, looks)
def test_the_contour_of_a_box_is_the_hull_of_its_eight_corners(
    shape: BoxShape, look: tuple[float, ...]
) -> None:
    camera, offset = seen_from(look)
    corners = surface(shape) + offset
    assume(camera.to_camera(tuple(corners.T))[2].min() > 0.5)
    u, v, _ = camera.project(tuple(corners.T))
    hull = np.array(convex_hull(tuple(zip(map(float, u), map(float, v), strict=True))))
    loop = project_loop(camera, shape_contour(np.array(offset), shape))
    assert abs(area(loop)) == pytest.approx(area(hull), rel=1e-9, abs=1e-12)


def area(points: np.ndarray) -> float:
    x, y = points.T
    return float(0.5 * (x * np.roll(y, -1) - y * np.roll(x, -1)).sum())


@pytest.mark.parametrize("yaw", [0.0, 0.7, 2.0, -1.3])
def test_the_corners_of_a_box_are_those_of_its_surface(yaw: float) -> None:
    shape = BoxShape(6.0, 2.0, 3.0, (cos(yaw), sin(yaw)))
    corners = np.array(sorted(np.round(shape.corners((1.0, -2.0, 5.0)), 9).tolist()))
    expected = np.array(sorted(np.round(surface(shape) + np.array([1.0, -2.0, 5.0]), 9).tolist()))
    assert corners == pytest.approx(expected)


def test_from_inside_a_box_there_is_no_contour() -> None:
    inside = shape_contour(np.array([0.3, 0.2, -0.1]), BoxShape(4.0, 2.0, 1.0))
    assert np.isnan(inside).all()


@pytest.mark.slow
@given(boxes, st.lists(angles, min_size=3, max_size=3), looks)
def test_a_box_that_turns_is_a_box_at_every_time(
    shape: BoxShape, yaws: list[float], look: tuple[float, ...]
) -> None:
    camera, offset = seen_from(look)
    turning = shape.facing((np.cos(yaws), np.sin(yaws)))
    each = [shape.facing((cos(yaw), sin(yaw))) for yaw in yaws]
    wide = (np.full(3, part) for part in offset)
    bounds = np.array(turning.bounds(camera, tuple(wide)))
    np.testing.assert_allclose(bounds.T, [one.bounds(camera, offset) for one in each], rtol=1e-9, atol=1e-9)
    loops = shape_contour(np.tile(offset, (3, 1)), turning)
    for loop, one in zip(loops, each, strict=True):
        np.testing.assert_allclose(loop, shape_contour(np.array(offset), one), atol=1e-9)


@pytest.mark.slow
@given(boxes, offsets)
def test_the_gap_is_the_distance_from_its_solid(shape: BoxShape, place: tuple[float, float, float]) -> None:
    assert shape.gap(place) == pytest.approx(distance(shape.solid((0.0, 0.0, 0.0)), place), abs=1e-9)


def test_length_lies_along_the_course_where_the_depth_of_a_zone_does() -> None:
    heading = radians(30)
    solid = BoxShape(8.0, 3.0, 2.0, (sin(heading), cos(heading))).solid((1.0, 2.0, 3.0))
    zone = box((1.0, 2.0, 3.0), (3.0, 8.0, 2.0), heading)
    assert isinstance(solid, Prism)
    ours, theirs = ({(round(x, 9), round(y, 9)) for x, y in prism.points} for prism in (solid, zone))
    assert ours == theirs
    assert (solid.bottom, solid.top) == (zone.bottom, zone.top)


@settings(max_examples=25)
@given(boxes | cylinders, boxes | cylinders, offsets)
def test_bodies_touch_where_no_direction_parts_them(
    a: BoxShape | CylinderShape, b: BoxShape | CylinderShape, offset: tuple[float, float, float]
) -> None:
    turn = np.linspace(0, 2 * pi, 2001)
    x, y, z = offset
    across = (np.cos(turn), np.sin(turn))
    gap = abs(x * across[0] + y * across[1]) - a.half_width(across) - b.half_width(across)
    apart = max(float(np.max(gap)), abs(z) - 0.5 * (a.height + b.height))
    assume(abs(apart) > 0.02)
    assert bool(touch(a, b, offset)) is (apart < 0)
    assert bool(touch(b, a, (-x, -y, -z))) is (apart < 0)


@pytest.mark.parametrize("yaw", [0.0, 0.5, 2.0, -1.0])
@pytest.mark.parametrize(
    ("one", "other", "along", "aside"),
    [
        (BoxShape(10.0, 1.0, 2.0), BoxShape(8.0, 1.4, 2.0), 9.0, 1.2),
        (BoxShape(10.0, 1.0, 2.0), CylinderShape(0.7, 2.0), 5.7, 1.2),
        (CylinderShape(1.0, 2.0), CylinderShape(0.7, 2.0), 1.7, 1.7),
    ],
)
def test_bodies_side_by_side_touch_where_their_sides_meet(
    one: BoxShape | CylinderShape, other: BoxShape | CylinderShape, along: float, aside: float, yaw: float
) -> None:
    ahead = (cos(yaw), sin(yaw))
    a, b = one.facing(ahead), other.facing(ahead)
    for way, least in (((ahead[0], ahead[1]), along), ((-ahead[1], ahead[0]), aside)):
        for far, met in ((least - 0.01, True), (least, True), (least + 0.01, False)):
            assert bool(touch(a, b, (far * way[0], far * way[1], 1.0))) is met
            assert bool(touch(b, a, (-far * way[0], -far * way[1], -1.0))) is met
    assert touch(a, b, (0.0, 0.0, 2.0))
    assert not touch(a, b, (0.0, 0.0, 2.01))


@pytest.mark.long
@given(boxes | cylinders, angles)
def test_the_cylinder_about_a_body_holds_it(shape: BoxShape | CylinderShape, yaw: float) -> None:
    turned = surface(shape.facing((cos(yaw), sin(yaw))))
    assert np.hypot(turned[:, 0], turned[:, 1]).max() <= shape.radius + 1e-9
    assert shape.radius <= hypot(*turned[np.hypot(turned[:, 0], turned[:, 1]).argmax(), :2]) + 1e-6


def test_the_cylinder_about_a_group_is_the_least_one_about_its_centre() -> None:
    parts = (
        Part((3.0, 4.0, 1.0), CylinderShape(2.0, 3.0)),
        Part((-1.0, 0.0, -4.0), CylinderShape(0.5, 1.0)),
    )
    group = GroupShape(parts)
    points = surface(group)
    assert group.radius == pytest.approx(np.hypot(points[:, 0], points[:, 1]).max(), abs=1e-5)
    assert group.height == pytest.approx(2.0 * np.abs(points[:, 2]).max())
    assert group.half_width((0.6, 0.8)) == pytest.approx(np.abs(points[:, :2] @ (0.6, 0.8)).max(), abs=1e-5)


def test_a_wider_box_has_every_upright_side_farther_out_and_is_no_higher() -> None:
    box = BoxShape(6.0, 2.0, 3.0, (0.6, 0.8)).wider(0.5)
    assert (box.length, box.width, box.height, box.ahead) == (7.0, 3.0, 3.0, (0.6, 0.8))


@pytest.mark.parametrize("around", [0.3, 2.0])
@pytest.mark.parametrize("above", [-0.5, 0.0, 0.8])
def test_a_group_is_seen_from_the_first_of_its_parts_to_the_last(around: float, above: float) -> None:
    parts = (
        Part((3.0, -4.0, 2.0), CylinderShape(1.0, 3.0)),
        Part((-5.0, 1.0, -1.0), BoxShape(2.0, 4.0, 1.0)),
    )
    shape = GroupShape(parts)
    camera, offset = seen_from((30.0, around, above, 0.1, -0.1))
    points = tuple((surface(shape) + offset).T)
    u, v, depth = camera.project(points)
    assert shape.bounds(camera, offset) == pytest.approx((u.min(), u.max(), v.min(), v.max()), abs=1e-5)
    assert shape.nearest_depth(camera, offset) == pytest.approx(depth.min(), abs=1e-4)
