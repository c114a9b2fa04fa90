"""Angles by whole turns: in their range, on the same place of the circle, floats and arrays alike."""

from math import cos, pi, sin

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from shotc.geom.vec import TURN_RAD, direction, minus, plus, wrapped

angles = st.floats(-50, 50)


@given(angle=angles)
def test_a_wrapped_angle_is_in_its_range_and_leads_to_the_same_place(angle):
    for found in (wrapped(angle), direction(angle)):
        assert (cos(found), sin(found)) == pytest.approx((cos(angle), sin(angle)), abs=1e-13)
    assert -pi <= wrapped(angle) <= pi  # at its end by rounding only
    assert -pi < direction(angle) <= pi


@pytest.mark.slow
@given(some=st.lists(angles, min_size=1, max_size=9))
def test_arrays_are_wrapped_to_the_bit_as_floats_are(some):
    assert wrapped(np.array(some)).tolist() == [wrapped(angle) for angle in some]


@pytest.mark.parametrize("turns", [-2, -1, 0, 1, 2])
def test_half_a_turn_is_at_the_end_that_each_convention_says(turns):
    assert wrapped(pi + turns * TURN_RAD) == -pi
    assert direction(pi + turns * TURN_RAD) == direction(-pi + turns * TURN_RAD) == pi


def test_sums_and_differences_are_taken_axis_by_axis():
    assert plus((1.0, 20.0, 300.0), (4.0, 50.0, 600.0)) == (5.0, 70.0, 900.0)
    assert minus((1.0, 20.0, 300.0), (4.0, 55.0, 666.0)) == (-3.0, -35.0, -366.0)
