"""Sampled framing against brute force: projected cylinders, in-frame flags, sight lines, margin rates."""

from math import pi, radians

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from shotc.geom import camera
from shotc.geom.framing import Cameras, frames, hidden, margin_rate
from shotc.geom.shapes import CylinderShape
from shotc.geom.solids import Cylinder, box
from shotc.geom.vec import Vec3

HFOV = radians(70)


def cameras(position, yaw, pitch, hfov=HFOV, aspect=16 / 9) -> Cameras:  # type: ignore[no-untyped-def]
    count = len(np.atleast_1d(yaw))
    return Cameras(
        np.atleast_2d(np.asarray(position, dtype=float)),
        np.atleast_1d(np.asarray(yaw, dtype=float)),
        np.atleast_1d(np.asarray(pitch, dtype=float)),
        np.full(count, hfov),
        aspect,
    )


def about(target: Cylinder) -> tuple[Vec3, CylinderShape]:
    tall = target.top - target.bottom
    return (*target.centre, target.bottom + tall / 2), CylinderShape(target.radius, tall)


def surface(target: Cylinder, count: int = 4000) -> np.ndarray:
    """Points of both rims, which span the outline."""
    a = np.linspace(0, 2 * pi, count, endpoint=False)
    ring = np.stack(
        [target.centre[0] + target.radius * np.cos(a), target.centre[1] + target.radius * np.sin(a)]
    )
    return np.concatenate(
        [np.stack([*ring, np.full(count, z)], axis=-1) for z in (target.bottom, target.top)]
    )


poses = st.tuples(
    st.floats(15, 90), st.floats(0, 2 * pi), st.floats(1, 60), st.floats(-0.3, 0.3), st.floats(-0.35, 0.35)
)


@pytest.mark.slow
@settings(deadline=None, max_examples=150)
@given(poses, st.floats(0.3, 8), st.floats(0.5, 30))
def test_size_and_flags_are_those_of_the_projected_cylinder(pose, radius: float, height: float) -> None:  # type: ignore[no-untyped-def]
    distance, azimuth, z, aside, tilt = pose
    target = Cylinder((3.0, -4.0), radius, 0.5, 0.5 + height)
    eye = np.array([3 + distance * np.cos(azimuth), -4 + distance * np.sin(azimuth), z])
    yaw = azimuth + pi + aside
    pitch = np.arctan2(0.5 + height / 2 - z, distance) + tilt
    look = cameras(eye, yaw, pitch)
    found = frames(look, *about(target))
    u, v, depth = camera.view(yaw, float(pitch), radians(70), 16 / 9).project(
        tuple((surface(target) - eye).T)
    )
    if depth.min() <= 0.1:
        return
    assert found.size[0] == pytest.approx((v.max() - v.min()) / 2, rel=1e-4, abs=1e-6)
    edge = max(np.abs(u).max(), np.abs(v).max())
    if abs(edge - 1) > 1e-4:
        assert bool(found.in_frame[0]) == (edge < 1)


def test_a_target_that_touches_the_edge_is_in_the_frame() -> None:
    target = Cylinder((0, 0), 1, 0, 1)
    fits = 1 / np.sin(HFOV / 2)
    away = fits - np.array([-0.01, 0.0, 1e-6, 1e-5])
    seen = frames(cameras([[-d, 0, 0.5] for d in away], [0.0] * 4, [0.0] * 4, aspect=0.5), *about(target))
    assert list(seen.in_frame) == [True, True, True, False]
    assert seen.margin[2] == pytest.approx(-1e-6 * np.sin(HFOV / 2), rel=1e-6)


def test_a_target_behind_the_camera_has_no_place_and_no_size() -> None:
    target = Cylinder((0, 0), 1, 0, 4)
    seen = frames(cameras([[-20, 0, 2], [-20, 0, 2]], [0.0, pi], [0.0, 0.0]), *about(target))
    assert seen.u[0] == pytest.approx(0.0)
    assert not np.isnan(seen.size[0])
    assert np.isnan([seen.u[1], seen.v[1], seen.size[1]]).all()
    assert list(seen.in_frame) == [True, False]
    assert seen.depth[1] == pytest.approx(-20)


def test_a_target_half_behind_the_camera_has_a_place_but_no_size() -> None:
    tall = Cylinder((0, 0), 0.5, 0, 60)
    seen = frames(cameras([-3, 0, 29], 0.0, radians(-25)), *about(tall))
    assert not np.isnan(seen.u[0])
    assert np.isnan(seen.size[0])
    assert not seen.in_frame[0]


def test_what_hides_and_what_does_not() -> None:
    target = Cylinder((0, 0), 1, 0, 10)
    point = np.array([0.0, 0.0, 5.0])
    eyes = np.array([[-30.0, 0, 5], [30.0, 0, 5], [-30.0, 0, 40], [-15.5, 0, 5]])
    wall = box((-15, 0, 10), (2, 20, 20), 0)
    assert list(hidden(eyes, point, [wall])) == [True, False, False, False]  # the last stands inside the wall
    around = Cylinder((0, 0), 4, 0, 12)
    assert hidden(eyes, point, [around]).all()  # nobody looks into it from outside
    assert list(frames(cameras(eyes, [0, pi, 0, 0], [0, 0, 0, 0]), *about(target), [wall]).hidden) == [
        1,
        0,
        0,
        0,
    ]


@pytest.mark.slow
@settings(deadline=None, max_examples=80)
@given(st.integers(0, 10_000))
def test_margins_change_no_faster_than_their_bound(seed: int) -> None:
    rng = np.random.default_rng(seed)
    target = Cylinder((0.0, 0.0), float(rng.uniform(0.1, 6)), 0.0, float(rng.uniform(0.5, 30)))
    start, step = rng.uniform(-40, 40, 3) + np.array([0, 0, 45]), rng.normal(size=3) * 0.01
    yaw, pitch = rng.uniform(-pi, pi), rng.uniform(-1.4, 0.4)
    dyaw, dpitch, dzoom = rng.normal(size=3) * 0.003
    hfov, aspect = rng.uniform(0.4, 1.8), rng.uniform(0.6, 2.4)
    look = Cameras(
        np.stack([start, start + step]),
        np.array([yaw, yaw + dyaw]),
        np.array([pitch, pitch + dpitch]),
        np.array([hfov, hfov + dzoom]),
        aspect,
    )
    margins = frames(look, *about(target)).margin
    far = max(np.linalg.norm(p - [0, 0, target.top / 2]) for p in look.position)
    rate = margin_rate(
        far + target.top / 2 + target.radius,
        float(np.linalg.norm(step)),
        abs(dyaw) + abs(dpitch),
        abs(dzoom),
        aspect,
    )
    assert abs(margins[1] - margins[0]) <= rate + 1e-9


@pytest.mark.parametrize(("aspect", "hfov"), [(16 / 9, radians(160)), (9 / 16, radians(10))])
def test_the_upper_edge_may_turn_faster_than_the_lens_opens(aspect: float, hfov: float) -> None:
    # A point above, beside the upper edge: wide frames of wide lenses, and upright frames of narrow ones.
    point = Cylinder((20.0, 0.0), 1e-6, 0.0, 1e-6)
    step = 1e-6
    margins = []
    for angle in (hfov, hfov + step):
        up = float(np.arctan(np.tan(hfov / 2) / aspect))
        margins.append(frames(cameras([0.0, 0.0, 0.0], 0.0, -up, angle, aspect), *about(point)).margin[0])
    rate = abs(margins[1] - margins[0]) / step
    assert rate > 1.2 * 20.0 * 0.5
    assert rate <= margin_rate(20.0, 0.0, 0.0, 1.0, aspect) + 1e-3


@pytest.mark.parametrize(("aspect", "wider"), [(16 / 9, 16 / 9), (9 / 16, 16 / 9), (1.0, 1.0)])
def test_a_margin_changes_with_the_camera_its_turn_and_its_zoom(aspect: float, wider: float) -> None:
    assert margin_rate(20.0, 3.0, 0.0, 0.0, aspect) == 3.0
    assert margin_rate(20.0, 0.0, 0.5, 0.0, aspect) == 10.0
    assert margin_rate(20.0, 0.0, 0.0, 0.1, aspect) == pytest.approx(20.0 * 0.05 * wider)


def test_a_target_right_before_the_camera_has_a_place_in_the_picture_and_one_behind_it_has_none() -> None:
    look = cameras([[0.0, 0.0, 1.0], [1.0, 0.0, 1.0]], [0.0, 0.0], [0.0, 0.0])
    seen = frames(look, (0.5, 0.0, 1.0), CylinderShape(0.1, 0.1))
    assert (seen.u[0], seen.v[0]) == (0.0, 0.0)
    assert np.isnan([seen.u[1], seen.v[1]]).all()
