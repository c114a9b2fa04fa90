"""Setpoints: what is asked at them, between them and after them."""

from __future__ import annotations

from itertools import pairwise
from math import log, pi

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from shotc.ir.setpoints import Asked, Setpoint, required_at

FIRST = Asked((-0.3, 0.1), 0.2, (3.0, 0.2))
times = st.lists(st.floats(0.5, 60.0), min_size=1, max_size=4, unique=True).map(sorted)


def led(time, place=None, size=None, view=None):
    return Setpoint(time, place, size, view, ())


def test_without_setpoints_all_stays_as_it_is() -> None:
    assert required_at(FIRST, (), 7.0) is FIRST


@pytest.mark.slow
@given(times=times, sizes=st.lists(st.floats(0.02, 3.0), min_size=4, max_size=4))
def test_it_is_as_asked_at_each_setpoint_goes_there_monotonously_and_then_stays(times, sizes) -> None:
    setpoints = [led(t, size=s) for t, s in zip(times, sizes, strict=False)]
    known = [(0.0, 0.2), *((p.time, p.size) for p in setpoints)]
    for time, size in known:
        assert required_at(FIRST, setpoints, time).size == pytest.approx(size)
    for (a, low), (b, high) in pairwise(known):
        between = [required_at(FIRST, setpoints, float(t)).size for t in np.linspace(a, b, 30)]
        assert (np.diff(between) * np.sign(high - low) >= -1e-9).all()
    assert required_at(FIRST, setpoints, times[-1] + 9.0).size == pytest.approx(known[-1][1])


def test_what_a_setpoint_does_not_say_is_led_by_those_that_do() -> None:
    setpoints = (led(4.0, place=(0.3, 0.1)), led(6.0, size=0.8), led(8.0, view=(None, 0.6)))
    early, late = required_at(FIRST, setpoints, 2.0), required_at(FIRST, setpoints, 7.0)
    assert early.place == pytest.approx((0.0, 0.1))  # half way, over 4 s
    assert required_at(FIRST, setpoints, 3.0).size == pytest.approx(0.4)  # by logarithms, over 6 s
    assert (late.place, late.size) == (pytest.approx((0.3, 0.1)), pytest.approx(0.8))
    assert late.view == (3.0, pytest.approx(0.2 + 0.4 * 0.9838, abs=1e-3))


def test_a_bearing_takes_the_shorter_way() -> None:
    turned = required_at(FIRST, (led(2.0, view=(-3.0, None)),), 1.0).view
    assert turned == (pytest.approx(pi), 0.2)


def test_it_rests_where_it_is_led_so_that_a_camera_can_follow() -> None:
    setpoints = (led(4.0, size=0.4), led(8.0, size=0.8))
    h = 1e-3
    for time in (0.0, 4.0, 8.0):
        a, b, c = (log(required_at(FIRST, setpoints, time + k * h).size) for k in (-1, 0, 1))
        assert abs(c - a) / (2 * h) < 1e-5
        assert abs(a - 2 * b + c) / h**2 < 1e-2
