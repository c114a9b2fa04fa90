from __future__ import annotations

from math import cos, pi, sin

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from shotc.geom.camera import view
from shotc.geom.framing import Cameras
from shotc.geom.shapes import CylinderShape
from shotc.geom.silhouette import (
    NEAR_PLANE_M,
    cylinder_contour,
    edge_strips,
    project_loop,
    project_loops,
    shape_outline,
    solid_edges,
    solid_outlines,
)
from shotc.geom.solids import Cylinder, Prism, Solid, box
from shotc.geom.vec import Vec3

ASPECT = 16 / 9
angle = st.floats(-pi, pi)
pitch = st.floats(-1.5, 1.5)
hfov = st.floats(0.3, 2.2)


def surface(rng: np.random.Generator, radius: float, height: float, count: int = 400) -> np.ndarray:
    """Points of a cylinder about the origin: rims, side and caps."""
    a = rng.uniform(-pi, pi, count)
    r = radius * np.sqrt(rng.uniform(0, 1, count))
    r[: count // 2] = radius
    z = rng.uniform(-height / 2, height / 2, count)
    z[::4], z[1::4] = height / 2, -height / 2
    return np.stack([r * np.cos(a), r * np.sin(a), z], axis=-1)


def overshoot(polygon: np.ndarray, points: np.ndarray) -> float:
    """How far points stick out of a convex polygon of either sense, in its own units."""
    a, b = polygon, np.roll(polygon, -1, axis=0)
    side = b - a
    length = np.hypot(side[:, 0], side[:, 1])
    keep = length > 1e-12
    a, side, length = a[keep], side[keep], length[keep]
    area = np.sum(polygon[:, 0] * np.roll(polygon[:, 1], -1) - np.roll(polygon[:, 0], -1) * polygon[:, 1])
    normal = np.sign(area) * np.stack([side[:, 1], -side[:, 0]], axis=-1) / length[:, None]
    return float(np.max(np.einsum("kd,nkd->nk", normal, points[:, None, :] - a[None])))


def ahead(pose: tuple[float, float, float], depth: float, spread: tuple[float, float]) -> Vec3:
    """An offset at some depth of a camera, as far off its axis as ``spread`` says."""
    yaw, tilt, _ = pose
    along = depth * (cos(tilt) - spread[1] * sin(tilt))
    across = depth * spread[0]
    return (
        along * cos(yaw) + across * sin(yaw),
        along * sin(yaw) - across * cos(yaw),
        depth * (sin(tilt) + spread[1] * cos(tilt)),
    )


@pytest.mark.slow
@settings(max_examples=120, deadline=None)
@given(
    st.tuples(angle, pitch, hfov),
    st.tuples(st.floats(5, 90), st.tuples(st.floats(-1, 1), st.floats(-1, 1))),
    st.floats(0.3, 10),
    st.floats(0.3, 40),
)
def test_outline_contains_every_point_and_touches_the_exact_extremes(
    pose: Vec3, place: tuple[float, tuple[float, float]], radius: float, height: float
) -> None:
    offset = ahead(pose, radius + height / 2 + place[0], place[1])
    camera = view(*pose, ASPECT)
    assume(CylinderShape(radius, height).nearest_depth(camera, offset) > 0.5)
    outline = shape_outline(camera, offset, CylinderShape(radius, height), count=300)
    points = surface(np.random.default_rng(1), radius, height) + np.array(offset)
    u, v, _ = camera.project((points[:, 0], points[:, 1], points[:, 2]))
    bounds = np.array(CylinderShape(radius, height).bounds(camera, offset))
    scale = max(1e-9, float(np.ptp(bounds[:2])), float(np.ptp(bounds[2:])))
    assert overshoot(outline, np.stack([u, v], axis=-1)) < 1e-3 * scale
    found = [outline[:, 0].min(), outline[:, 0].max(), outline[:, 1].min(), outline[:, 1].max()]
    np.testing.assert_allclose(found, bounds, atol=1e-3 * scale)


@pytest.mark.slow
@settings(max_examples=80, deadline=None)
@given(angle, st.floats(-1.0, 1.0), st.floats(7, 25), st.floats(-1.5, 1.5), st.floats(-20, 20))
def test_what_is_in_front_of_a_cut_cylinder_is_inside_its_outline(
    yaw: float, tilt: float, away: float, bearing: float, z: float
) -> None:
    camera = view(yaw, tilt, 1.2, ASPECT)
    radius, height = 6.0, 20.0
    x, y = away * cos(yaw + bearing), away * sin(yaw + bearing)
    points = surface(np.random.default_rng(2), radius, height) + np.array([x, y, z])
    u, v, depth = camera.project((points[:, 0], points[:, 1], points[:, 2]))
    on_screen = (depth > NEAR_PLANE_M) & (abs(u) < 1) & (abs(v) < 1)
    outline = shape_outline(camera, (x, y, z), CylinderShape(radius, height), count=400)
    if on_screen.any():
        assert overshoot(outline, np.stack([u, v], axis=-1)[on_screen]) < 5e-3


def test_eye_over_the_disc_sees_one_rim() -> None:
    camera = view(0.0, -pi / 2 + 0.01, 1.0, 1.0)
    outline = shape_outline(camera, (0.5, 0.2, -20.0), CylinderShape(3.0, 10.0))
    rim = cylinder_contour(np.array([0.5, 0.2, -20.0]), 3.0, 10.0)
    assert np.allclose(rim[:, 2], -15.0)
    assert len(outline) == len(rim)


def test_no_outline_from_inside_and_none_behind() -> None:
    assert len(shape_outline(view(0, 0, 1, 1), (0.5, 0.0, 0.0), CylinderShape(3.0, 10.0))) == 0
    assert len(shape_outline(view(0, 0, 1, 1), (-30.0, 0.0, 0.0), CylinderShape(3.0, 10.0))) == 0
    assert solid_outlines(view(0, 0, 1, 1), (0, 0, 5), box((-20, 0, 5), (4, 4, 4), 0.3)) == []


def test_contours_of_many_eyes_agree_with_those_of_each() -> None:
    offsets = np.random.default_rng(3).uniform(-30, 30, (20, 3))
    many = cylinder_contour(offsets, 2.0, 8.0)
    for offset, loop in zip(offsets, many, strict=True):
        np.testing.assert_array_equal(cylinder_contour(offset, 2.0, 8.0), loop)


@pytest.mark.slow
@settings(max_examples=60, deadline=None)
@given(angle, st.floats(-1.0, 1.0), st.floats(8.5, 40), st.floats(-1.5, 1.5), st.floats(0, 40))
def test_prism_outline_contains_its_points_even_when_cut(
    yaw: float, tilt: float, away: float, bearing: float, z: float
) -> None:
    x, y = -away * cos(yaw + bearing), -away * sin(yaw + bearing)
    prism = box((0, 0, 6), (12, 5, 12), 0.4)
    eye = (x, y, z)
    camera = view(yaw, tilt, 1.2, ASPECT)
    rng = np.random.default_rng(4)
    weights = rng.dirichlet(np.ones(4), 300)
    xy = weights @ np.array(prism.points)
    points = np.column_stack([xy, rng.uniform(0, 12, 300)]) - np.array(eye)
    u, v, depth = camera.project((points[:, 0], points[:, 1], points[:, 2]))
    inside = (depth > NEAR_PLANE_M) & (abs(u) < 3) & (abs(v) < 3)
    if inside.any():
        (outline,) = solid_outlines(camera, eye, prism)
        assert overshoot(outline, np.stack([u, v], axis=-1)[inside]) < 1e-9


def test_a_hollow_prism_has_one_outline_per_convex_part() -> None:
    ell = Prism(((0, 0), (10, 0), (10, 4), (4, 4), (4, 10), (0, 10)), 0.0, 5.0)
    outlines = solid_outlines(view(0, -0.1, 1.2, ASPECT), (-30.0, 0.0, 8.0), ell)
    assert len(outlines) >= 2


def test_polygons_of_many_cameras_agree_with_those_of_each() -> None:
    rng = np.random.default_rng(5)
    n = 30
    pose = np.column_stack([rng.uniform(-20, 20, (n, 3)), rng.uniform(-3, 3, n), rng.uniform(-1, 1, n)])
    many = Cameras(pose[:, :3], pose[:, 3], pose[:, 4], np.full(n, 1.1), ASPECT)
    loops = cylinder_contour(-pose[:, :3], 2.0, 8.0)
    polygons = project_loops(many.view, loops)
    for p, loop, polygon in zip(pose, loops, polygons, strict=True):
        np.testing.assert_allclose(project_loop(view(p[3], p[4], 1.1, ASPECT), loop), polygon, atol=1e-9)
    assert {len(polygon) > 0 for polygon in polygons} == {True, False}


@pytest.mark.parametrize(
    ("solid", "strips"), [(box((0, 0, 2), (4, 4, 4), 0), 6), (Cylinder((0, 0), 2, 0, 4), 2)]
)
def test_edges_in_the_world_and_on_screen(solid: Solid, strips: int) -> None:
    assert len(edge_strips(solid)) == strips
    assert len(solid_edges(view(0, 0, 1.2, ASPECT), (-20.0, 0.0, 2.0), solid)) == strips
    # From between its edges, looking away, some of them are cut at the near plane.
    cut = solid_edges(view(0.5, 0, 1.2, ASPECT), (0.0, 0.0, 2.0), solid)
    assert cut
    assert all(np.isfinite(strip).all() for strip in cut)


def test_an_edge_that_is_cut_is_one_line_in_front() -> None:
    """The eye stands inside: half of each rim is behind it, and either end of the other half is cut."""
    around = Cylinder((0.0, 0.0), 5.0, -1.0, 1.0)
    found = solid_edges(view(0.0, 0.0, 1.0, 1.0), (0.0, 0.0, 0.0), around)
    assert [len(line) for line in found] == [13, 13, 13, 13]


def test_the_edges_of_a_cylinder_are_its_rims() -> None:
    bottom, top = edge_strips(Cylinder((3.0, -2.0), 5.0, -1.0, 7.0))
    for strip, height in ((bottom, -1.0), (top, 7.0)):
        assert np.hypot(strip[:, 0] - 3.0, strip[:, 1] + 2.0) == pytest.approx(np.full(len(strip), 5.0))
        assert (strip[:, 2] == height).all()
        assert strip[0] == pytest.approx(strip[-1])
        assert np.ptp(strip[:, 0]) == pytest.approx(np.ptp(strip[:, 1]), rel=0.01)
    square, _ = edge_strips(Cylinder((3.0, -2.0), 5.0, -1.0, 7.0), 4)
    assert square[:, :2] == pytest.approx(np.array([[8, -2], [3, 3], [-2, -2], [3, -7], [8, -2]]), abs=1e-9)


def test_what_is_seen_as_a_triangle_is_an_outline() -> None:
    up = view(0.0, 1.5, 1.2, ASPECT)
    prism = Prism(((-1.0, -1.0), (2.0, -1.0), (0.0, 2.0)), 5.0, 9.0)
    (outline,) = solid_outlines(up, (0.0, 0.0, 0.0), prism)
    assert len(outline) == 3
    ahead_of = np.array([[1.0, 0.0, 0.2], [-1.0, 0.5, 0.0], [-1.0, -0.5, 0.0]])
    assert project_loop(view(0.0, 0.0, 1.2, ASPECT), ahead_of).shape == (3, 2)


def test_a_plate_that_is_seen_edge_on_has_no_outline() -> None:
    plate = Prism(((5.0, -1.0), (7.0, -1.0), (7.0, 1.0), (5.0, 1.0)), 0.0, 0.0)
    assert solid_outlines(view(0.0, 0.0, 1.2, ASPECT), (0.0, 0.0, 0.0), plate) == []
    assert len(solid_outlines(view(0.0, 0.0, 1.2, ASPECT), (0.0, 0.0, 1.0), plate)) == 1
