"""A guess that steps aside is a motion that its drone could fly, wherever its subject is hidden."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from shotc_casadi.clock.guess import SPREAD_S, least_time, step_aside

from shotc.plugin_api.refiner import quintic_hermite

LIMITS = SimpleNamespace(speed=8.0, climb=3.0, descent=2.0, usable_acceleration=4.0, jerk=6.0)
DRONE = SimpleNamespace(limits=LIMITS)
BREAKS = np.linspace(0.0, 30.0, 121)


@pytest.mark.parametrize("span", [(0.2, 8.0), (12.0, 14.0), (20.0, 29.9), (0.0, 30.0), (1.0, 1.0)])
@pytest.mark.parametrize("detour", [(0.0, 0.0, 4.0), (9.0, -9.0, 0.0), (3.0, 0.0, -2.0), (0.1, 0.0, 0.0)])
def test_a_step_aside_keeps_the_limits_and_both_ends(span, detour) -> None:
    offset = np.array(detour)
    seconds = least_time(offset, DRONE)
    values = [share[:, None] * offset for share in step_aside(BREAKS, span, seconds)]
    curve = quintic_hermite(BREAKS, *values)
    at = np.linspace(0.0, 30.0, 3001)
    speed, acceleration = (curve.derivative(order)(at) for order in (1, 2))
    jerk = np.diff(values[2], axis=0) / np.diff(BREAKS)[:, None]  # as the programme takes it
    assert np.hypot(speed[:, 0], speed[:, 1]).max() <= LIMITS.speed + 1e-9
    assert -LIMITS.descent - 1e-9 <= speed[:, 2].min() <= speed[:, 2].max() <= LIMITS.climb + 1e-9
    assert np.linalg.norm(acceleration, axis=1).max() <= 1.01 * LIMITS.usable_acceleration
    assert np.linalg.norm(jerk, axis=1).max() <= LIMITS.jerk + 1e-9
    for order in range(3):
        assert abs(values[order][[0, -1]]).max() == pytest.approx(0.0, abs=1e-12)
    # The camera is aside in all of the span but where an end is too near.
    aside = np.clip(span, BREAKS[0] + seconds, BREAKS[-1] - seconds)
    inside = (at >= aside[0]) & (at <= aside[1])
    assert np.abs(curve(at[inside]) - offset).max(initial=0.0) < 1e-3  # m, between the nodes
    assert seconds >= SPREAD_S


def test_a_step_takes_as_long_as_the_limit_that_binds() -> None:
    for detour, bound, order, most in (
        ((15.0, 0.0, 0.0), LIMITS.jerk, 3, 60.0),
        ((0.0, 0.0, 8.0), LIMITS.descent, 1, 15 / 8),
        ((0.0, 80.0, 0.0), LIMITS.speed, 1, 15 / 8),
    ):
        far = float(np.linalg.norm(detour))
        assert least_time(np.array(detour), DRONE) == pytest.approx((most * far / bound) ** (1.0 / order))
