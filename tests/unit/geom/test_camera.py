"""The pinhole camera against closed forms: margins of points, and poses that show a point at a place."""

from __future__ import annotations

from math import cos, pi, radians, sin, tan

import numpy as np
import pytest

from shotc.geom.camera import aim_at, frustum_margins, heading_of, view, yaw_of

ASPECT = 16 / 9
HFOV = radians(70)
VFOV = 2 * np.arctan(np.tan(HFOV / 2) / ASPECT)


def offset(eye, right: float, down: float, forward: float) -> tuple[float, float, float]:
    """Return a vector of C in W."""
    east = forward * eye.cos_pitch * eye.cos_yaw + right * eye.sin_yaw + down * eye.sin_pitch * eye.cos_yaw
    north = forward * eye.cos_pitch * eye.sin_yaw - right * eye.cos_yaw + down * eye.sin_pitch * eye.sin_yaw
    return (east, north, forward * eye.sin_pitch - down * eye.cos_pitch)


@pytest.mark.parametrize(("yaw", "pitch"), [(0.0, 0.0), (2.1, -0.6), (-0.7, 0.9)])
def test_margins_of_a_point_are_its_distances_from_the_planes_of_the_frustum(
    yaw: float, pitch: float
) -> None:
    eye = view(yaw, pitch, HFOV, ASPECT)
    on_axis = frustum_margins(eye, offset(eye, 0.0, 0.0, 20.0))
    assert on_axis == pytest.approx(20.0 * np.sin(np.array([HFOV, HFOV, VFOV, VFOV]) / 2))
    # 1 m out of the right plane, along its normal, from a point in it; then likewise below.
    aside = offset(eye, 20 * sin(HFOV / 2) + cos(HFOV / 2), 0.0, 20 * cos(HFOV / 2) - sin(HFOV / 2))
    assert frustum_margins(eye, aside).right == pytest.approx(-1.0)
    below = offset(eye, 0.0, 20 * sin(VFOV / 2) + cos(VFOV / 2), 20 * cos(VFOV / 2) - sin(VFOV / 2))
    assert frustum_margins(eye, below).bottom == pytest.approx(-1.0)


def test_a_point_is_shown_where_it_is_asked_for_by_the_pose_of_smaller_pitch() -> None:
    rng = np.random.default_rng(5)
    for _ in range(100):
        place = tuple(rng.uniform(-30.0, 30.0, 3) * [1.0, 1.0, 0.6])
        uv = tuple(rng.uniform(-0.9, 0.9, 2))
        pose = aim_at(place, uv, HFOV, ASPECT)
        if pose is None:
            continue
        u, v, depth = view(*pose, HFOV, ASPECT).project(place)
        assert (u, v) == pytest.approx(uv, abs=1e-9)
        assert depth > 0.0
        # The other pose looks the other way over the zenith: both see the point at one angle to the axis.
        lean = np.arctan2(uv[1] * tan(HFOV / 2) / ASPECT, 1.0)
        other = pi - 2 * lean - pose[1]
        assert abs(pose[1]) <= abs((other + pi) % (2 * pi) - pi) + 1e-9


def test_no_pose_without_roll_shows_what_is_too_steep_aside_and_none_the_eye_itself() -> None:
    assert aim_at((0.0, 0.0, -10.0), (0.5, 0.0), HFOV, ASPECT) is None
    assert aim_at((0.1, 0.0, -10.0), (0.5, 0.0), HFOV, ASPECT) is None
    assert aim_at((10.0, 0.0, -5.0), (0.5, 0.0), HFOV, ASPECT) is not None
    assert aim_at((0.0, 0.0, 0.0), (0.0, 0.0), HFOV, ASPECT) is None


def test_straight_down_the_heading_is_the_one_that_is_given() -> None:
    assert aim_at((0.0, 0.0, -10.0), (0.0, 0.0), HFOV, ASPECT, 1.2) == pytest.approx((1.2, -pi / 2))
    assert aim_at((0.0, 0.0, -10.0), (0.0, 0.0), HFOV, ASPECT) == pytest.approx((0.0, -pi / 2))
    assert aim_at((0.0, 0.01, -10.0), (0.0, 0.0), HFOV, ASPECT, 1.2) == pytest.approx(
        (pi / 2, -pi / 2), abs=2e-3
    )


@pytest.mark.parametrize(("heading", "yaw"), [(0, 90), (90, 0), (180, -90), (270, 180), (45, 45), (300, 150)])
def test_headings_are_clockwise_from_north_and_yaws_counter_clockwise_from_east(
    heading: float, yaw: float
) -> None:
    assert yaw_of(radians(heading)) == pytest.approx(radians(yaw))
    assert heading_of(radians(yaw)) == pytest.approx(radians(heading))
    assert heading_of(radians(yaw) + 2 * pi) == pytest.approx(radians(heading))
