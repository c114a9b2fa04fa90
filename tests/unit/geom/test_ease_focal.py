"""The step of least jerk, and focal lengths of fields of view."""

from math import degrees, pi

import numpy as np
import pytest

from shotc.geom.ease import minimum_jerk
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
