"""What wind of a known direction leaves of the speed over ground, in the fastest motions along a path."""

from __future__ import annotations

from dataclasses import replace
from math import cos, pi, sin, sqrt

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from shotc.geom.bernstein import Piecewise
from shotc.ir.limits import Limits
from shotc.planning.timing.limits import Ceiling, axes
from shotc.planning.timing.move import time_move
from tests.support.timing_paths import CEILING

CALM = Limits(8.0, 3.0, 1.5, 3.0, 8.0, 1.0, 1.5)
WIND = st.tuples(st.floats(0.0, 0.95), st.floats(-pi, pi)).map(
    lambda w: (8 * w[0] * cos(w[1]), 8 * w[0] * sin(w[1]))
)
VELOCITY = arrays(np.float64, 2, elements=st.floats(-20.0, 20.0))


def speed_used(velocity: np.ndarray, wind: tuple[float, float]) -> float:
    """Return the share of the limit of speed that a velocity uses."""
    level = axes(replace(CEILING, wind=wind), zoom_only=False)[0]
    return float(level.rate_used(velocity)) / CEILING.speed


@pytest.mark.slow
@given(VELOCITY, WIND)
def test_a_velocity_slowed_by_what_it_uses_is_at_the_limit_of_airspeed(
    velocity: np.ndarray, wind: tuple[float, float]
) -> None:
    used = speed_used(velocity, wind)
    if used > 1e-6:
        assert np.hypot(*(velocity / used - wind)) == pytest.approx(CEILING.speed, rel=1e-6)


@pytest.mark.slow
@given(VELOCITY, VELOCITY, WIND)
def test_between_two_velocities_no_more_is_used_than_at_them(
    a: np.ndarray, b: np.ndarray, wind: tuple[float, float]
) -> None:
    middle = speed_used(0.5 * (a + b), wind)
    assert middle <= 0.5 * (speed_used(a, wind) + speed_used(b, wind)) + 1e-9


@pytest.mark.slow
@given(VELOCITY, WIND, st.floats(0.3, 1.0))
def test_a_pace_in_wind_is_within_the_limits(
    velocity: np.ndarray, wind: tuple[float, float], pace: float
) -> None:
    slow = replace(CEILING, wind=wind).scaled(pace)
    used = float(axes(slow, zoom_only=False)[0].rate_used(velocity)) / slow.speed
    if used > 1e-6:
        assert np.hypot(*(velocity / used - wind)) <= CEILING.speed * (1 + 1e-6)


@pytest.mark.slow
@given(WIND, st.floats(-pi, pi))
def test_the_speed_along_a_way_is_the_largest_that_the_airspeed_allows(
    wind: tuple[float, float], course: float
) -> None:
    limits = CALM._replace(wind=wind)
    east, north = cos(course), sin(course)
    fast = limits.speed_along(3.0 * east, 3.0 * north)
    assert limits.airspeed(fast * east, fast * north) == pytest.approx(limits.speed)
    assert limits.slowest - 1e-9 <= fast <= limits.fastest + 1e-9


def line(course: float, length: float) -> Piecewise:
    """Return a straight level path, its body and camera ahead."""
    ctrl = np.zeros((1, 6, 7))
    ctrl[0, :, 0] = np.linspace(0.0, length * cos(course), 6)
    ctrl[0, :, 1] = np.linspace(0.0, length * sin(course), 6)
    ctrl[0, :, 6] = 1.0
    return Piecewise(np.array([0.0, length]), ctrl)


@pytest.mark.parametrize(
    ("course", "cruise"),
    [(0.0, 12.0), (pi, 4.0), (pi / 2, sqrt(8.0**2 - 4.0**2)), (-pi / 3, 2.0 + sqrt(52.0))],
)
def test_a_long_way_is_cruised_at_the_ground_speed_of_its_course(course: float, cruise: float) -> None:
    windy: Ceiling = replace(CEILING, wind=(4.0, 0.0))
    times = [time_move(line(course, length), (0.0, length), windy).duration for length in (300.0, 500.0)]
    assert 200.0 / (times[1] - times[0]) == pytest.approx(cruise, rel=5e-3)
