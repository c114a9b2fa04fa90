"""The stretched clock: no limit is broken at any time, and nothing takes longer than it would all alike."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from shotc.geom.bernstein import Array
from shotc.geom.fleet_spline import places
from shotc.ir.limits import Limits
from shotc.show.recorded.clock import clocked, worst

LIMITS = Limits(5.0, 2.5, 2.0, 2.5, 8.0, 1.0, 1.0)
STEP_S = 0.25


def moving(seed: int, seconds: float, drones: int = 4) -> Array:
    """Control points of three moves between random places, so many seconds each, from rest to rest."""
    rng = np.random.default_rng(seed)
    stops = rng.uniform(-15.0, 15.0, (4, drones, 3))
    share = np.linspace(0.0, 1.0, max(4, round(seconds / STEP_S)))
    eased = share**3 * (10.0 - 15.0 * share + 6.0 * share**2)
    ways = [a + eased[:, None, None] * (b - a) for a, b in pairwise(stops)]
    rest = [np.repeat(stop[None], 6, axis=0) for stop in stops]
    parts = [rest[0], ways[0], rest[1], ways[1], rest[2], ways[2], rest[3]]
    return np.moveaxis(np.concatenate(parts), 1, 0)


@pytest.mark.slow
@settings(max_examples=40, deadline=None)
@given(st.integers(0, 10_000), st.floats(0.8, 30.0))
def test_all_limits_hold_at_dense_samples_and_stretching_all_alike_is_no_faster(
    seed: int, seconds: float
) -> None:
    coef = moving(seed, seconds)
    count = coef.shape[1] - 3
    even = worst(np.full(count, STEP_S), coef, LIMITS).factor
    breaks, need = clocked(coef, STEP_S, LIMITS, 0.0)
    at = np.linspace(0.0, breaks[-1], 40 * count)
    rate, bend, jerk = (places(breaks, coef, at, order) for order in (1, 2, 3))
    assert np.hypot(rate[..., 0], rate[..., 1]).max() <= LIMITS.speed * (1 + 1e-6)
    assert rate[..., 2].max() <= LIMITS.climb * (1 + 1e-6)
    assert -rate[..., 2].min() <= LIMITS.descent * (1 + 1e-6)
    assert np.linalg.norm(bend, axis=2).max() <= LIMITS.acceleration * (1 + 1e-6)
    assert np.linalg.norm(jerk, axis=2).max() <= LIMITS.jerk * (1 + 1e-6)
    whole = count * STEP_S
    assert breaks[-1] <= whole * max(even, 1.0) * (1 + 2e-4)
    assert (need is None) == (even <= 1.0 + 1e-9)
    if need is None:
        assert breaks == pytest.approx(STEP_S * np.arange(count + 1), abs=1e-9)


def test_a_line_flown_twice_too_fast_takes_twice_as_long_and_the_rest_its_own_time() -> None:
    # Slow, then 10 m/s for 20 s, then slow: of the whole that part alone is to take 40 s.
    speed = np.concatenate([np.full(120, 1.0), np.full(80, 10.0), np.full(120, 1.0)])
    smooth = np.convolve(np.pad(speed, 20, mode="edge"), np.full(41, 1 / 41), "valid")
    x = np.concatenate([np.zeros(3), np.cumsum(smooth) * STEP_S])
    x = np.concatenate([x, np.full(2, x[-1])])
    coef = np.stack([x, np.zeros_like(x), np.full_like(x, 20.0)], axis=1)[None]
    breaks, need = clocked(coef, STEP_S, LIMITS, 0.0)
    assert need is not None
    assert (need.limit, need.value) == ("speed", pytest.approx(10.0))
    assert need.factor == pytest.approx(2.0, abs=1e-6)
    widths = np.diff(breaks)
    assert widths[146:184] == pytest.approx(2 * STEP_S, rel=0.01)
    assert widths[20:70] == pytest.approx(STEP_S)
    assert widths[-70:-20] == pytest.approx(STEP_S)
    assert breaks[-1] - len(widths) * STEP_S < 1.2 * 20.0


def test_what_the_rounding_of_a_file_adds_is_no_reason_to_go_slower() -> None:
    x = np.concatenate([np.zeros(3), 1.2 * np.arange(1, 80), np.full(3, 1.2 * 79)])
    x[:20] = np.interp(np.arange(20), [0, 2, 19], [0.0, 0.0, x[19]])
    way = np.cumsum(np.clip(np.minimum(np.arange(-2, 98) * 0.04, (98 - np.arange(100)) * 0.04), 0, 1.249))
    line = np.concatenate([np.zeros(3), way, np.full(3, way[-1])])
    smooth = np.convolve(np.pad(line, 6, mode="edge"), np.full(13, 1 / 13), "valid")
    smooth[:3], smooth[-3:] = smooth[2], smooth[-3]
    coef = np.stack([smooth, 0 * smooth, 0 * smooth + 20.0], axis=1)[None]
    exact = clocked(coef, STEP_S, LIMITS, 0.0)
    noisy = coef + np.random.default_rng(1).uniform(-5e-4, 5e-4, coef.shape)
    noisy[:, :3], noisy[:, -3:] = noisy[:, 2:3], noisy[:, -3:-2]
    assert exact.need is None
    assert clocked(noisy, STEP_S, LIMITS, 5e-4).need is None
    assert clocked(noisy, STEP_S, LIMITS._replace(speed=4.0), 5e-4).need is not None
