"""The step of least jerk, and focal lengths of fields of view."""

from math import degrees, pi

import numpy as np
import pytest

from shotc.geom.bernstein import Piecewise
from shotc.geom.ease import control, minimum_jerk, parts_of
from shotc.geom.focal import field_of_view, focal_length


def test_the_step_is_the_one_of_least_jerk():
    x = np.linspace(0.0, 1.0, 2001)
    step = minimum_jerk(x)
    assert step[[0, 1000, 2000]] == pytest.approx([0.0, 0.5, 1.0])
    # Euler-Lagrange: the sixth derivative of a curve of least jerk is none, and it rests at both ends.
    rates = np.gradient(step, x), np.gradient(np.gradient(step, x), x)
    assert all(abs(rate[k]) < 0.02 for rate in rates for k in (0, -1))
    assert np.polyfit(x, step, 6)[0] == pytest.approx(0.0, abs=1e-8)
    assert minimum_jerk(0.25) == pytest.approx(float(step[500]))


@pytest.mark.parametrize(("millimetres", "deg"), [(18, 90.0), (24, 73.74), (35, 54.43), (50, 39.60)])
def test_full_frame_lenses_have_the_angles_that_their_makers_print(millimetres, deg):
    assert degrees(field_of_view(millimetres / 1e3)) == pytest.approx(deg, abs=0.01)
    assert 1e3 * focal_length(field_of_view(millimetres / 1e3)) == pytest.approx(millimetres)
    assert focal_length(pi / 2, 36.0) == pytest.approx(18.0)


@pytest.mark.parametrize("room", [1.03, 1.1, 1.5, 1.87, 2.0, 100.0])
def test_a_step_in_parts_keeps_its_speed_and_is_smooth_from_rest_to_rest(room: float) -> None:
    parts = parts_of(room)
    assert parts is not None
    pieces = control(parts)
    curve = Piecewise(
        np.array([*(low for low, _, _ in pieces), 1.0]), np.array([way for *_, way in pieces])[:, :, None]
    )
    speed, bend = curve.derivative(), curve.derivative(2)
    assert curve(0.0)[0] == 0.0
    assert curve(1.0)[0] == pytest.approx(1.0)
    # Control points of the speed bound it at every instant.
    assert speed.ctrl.min() >= -1e-12
    assert parts == 1 or speed.ctrl.max() <= room + 1e-9
    assert float(speed(np.linspace(0, 1, 1001)).max()) <= room + 1e-9
    for order in (curve, speed, bend):
        joints = order.ctrl[1:, 0] - order.ctrl[:-1, -1]
        assert np.abs(joints).max(initial=0.0) < 1e-9 * 40**2
    assert np.abs([speed.ctrl[0, 0], speed.ctrl[-1, -1], bend.ctrl[0, 0], bend.ctrl[-1, -1]]).max() < 1e-9


def test_what_leaves_no_time_to_speed_up_has_no_parts() -> None:
    assert parts_of(1.0) is None
    assert parts_of(0.5) is None
    assert parts_of(1.02) is None
    assert parts_of(15 / 8) == 1


def test_a_step_has_as_many_parts_as_its_speed_needs_and_none_beyond_forty() -> None:
    assert parts_of(1.26) == 5
    assert parts_of(40.0 / 39.0 + 1e-9) == 40
    assert parts_of(41.0 / 40.0 + 1e-9) is None
