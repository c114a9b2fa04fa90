"""The four points of a cylinder in the frame: known positions, and how they differ from its silhouette."""

from __future__ import annotations

from math import atan2, hypot, radians, tan

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from shotc.geom.camera import frustum_margins, point_margins, view
from shotc.geom.framing import Cameras, frames, points_in_frame
from shotc.geom.shapes import CylinderShape

HFOV, ASPECT = radians(70), 16 / 9
HALF = tan(HFOV / 2)
LEVEL = view(0.0, 0.0, HFOV, ASPECT)


def test_seen_level_the_points_stand_where_they_are_said_to():
    across, along = (1 + HALF**2) ** -0.5, (1 + (HALF / ASPECT) ** 2) ** -0.5
    left, right, bottom, top = point_margins(LEVEL, (50.0, 0.0, 0.0), CylinderShape(3.0, 20.0))
    # A radius aside and half the height up, all of them as far away as the axis.
    assert left == pytest.approx(across * (50 * HALF - 3))
    assert right == pytest.approx(left)
    assert bottom == pytest.approx(along * (50 * HALF / ASPECT - 10))
    assert top == pytest.approx(bottom)


@pytest.mark.slow
@given(
    st.floats(8, 90),
    st.floats(-0.4, 0.4),
    st.floats(-1.2, 1.2),
    st.floats(-30, 30),
    st.floats(0.2, 7),
    st.floats(0.5, 40),
)
def test_no_point_is_farther_out_than_the_silhouette(away, aside, pitch, up, radius, height):
    camera = view(aside, pitch, HFOV, ASPECT)
    exact = frustum_margins(camera, (away, 0.0, up), CylinderShape(radius, height))
    points = point_margins(camera, (away, 0.0, up), CylinderShape(radius, height))
    assert all(p >= e - 1e-9 for p, e in zip(points, exact, strict=True))


def test_all_four_points_may_be_in_a_frame_that_crops_the_target():
    centre, shape = (0.0, 0.0, 30.0), CylinderShape(6.0, 60.0)
    away = 30.0 / (HALF / ASPECT) * 1.02
    look = cameras([(-away, 0.0, 30.0)])
    assert points_in_frame(look, centre, shape).all()
    assert not frames(look, centre, shape).in_frame.any()


def test_arrays_give_what_single_poses_give():
    eyes = [(-70.0, 5.0, 12.0), (-40.0, -30.0, 50.0), (-9.0, 0.0, 3.0)]
    look = cameras(eyes)
    for i, eye in enumerate(eyes):
        camera = view(float(look.yaw[i]), float(look.pitch[i]), HFOV, ASPECT)
        margins = point_margins(camera, (-eye[0], -eye[1], 12.0 - eye[2]), CylinderShape(4.0, 24.0))
        assert points_in_frame(look, (0.0, 0.0, 12.0), CylinderShape(4.0, 24.0))[i] == (min(margins) >= 0)


def test_straight_above_the_points_are_still_numbers():
    assert np.isfinite(
        point_margins(view(0.0, radians(-90), HFOV, ASPECT), (0.0, 0.0, -40.0), CylinderShape(3.0, 9.0))
    ).all()


def cameras(eyes) -> Cameras:
    """Return cameras that look at (0, 0, 12) from some places, or level from the height of 30 m."""
    at = np.array(eyes)
    yaw = np.array([atan2(-y, -x) for x, y, _ in eyes])
    pitch = np.array([0.0 if z == 30.0 else atan2(12 - z, hypot(x, y)) for x, y, z in eyes])
    return Cameras(at, yaw, pitch, np.full(len(eyes), HFOV), ASPECT)
