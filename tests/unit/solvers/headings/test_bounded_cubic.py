"""Whether a cubic keeps its limits, against dense samples of it."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from shotc.solvers.headings.bounded_cubic import PIECE_PARTS, _rows, within_limits
from shotc.solvers.headings.energy import cubic
from shotc.solvers.headings.task import HeadingTask

AT = np.array([0.0, 1.0, 3.0])
FREE = 100.0


@pytest.mark.parametrize("seed", range(12))
def test_the_largest_rate_and_acceleration_decide_wherever_they_are(seed: int) -> None:
    rng = np.random.default_rng(seed)
    angles, slope = rng.uniform(-3, 3, 3), rng.uniform(-1, 1, 3) * (seed % 3)
    curve = cubic(AT, angles, slope)
    t = np.linspace(0.0, 3.0, 6001)
    rate, acceleration = (float(np.abs(curve.derivative(k)(t)).max()) for k in (1, 2))

    def kept(rate: float, acceleration: float) -> bool:
        task = HeadingTask(AT, angles, rate=rate, acceleration=acceleration)
        return within_limits(task, angles, slope)

    assert kept(1.001 * rate, 1.01 * acceleration)
    assert not kept(0.999 * rate, FREE)
    assert not kept(FREE, 0.99 * acceleration)


@pytest.mark.parametrize("seed", range(3))
def test_rows_are_rates_at_the_ends_of_parts_and_hold_them_in_between(seed: int) -> None:
    rng = np.random.default_rng(seed)
    angles, slope = rng.uniform(-3, 3, 3), rng.uniform(-2, 2, 3)
    matrix, limits = _rows(HeadingTask(AT, angles, rate=2.0, acceleration=5.0))
    rows = matrix @ np.concatenate([angles, slope])
    rates, bends = rows[limits == 2.0].reshape(2, -1), rows[limits == 5.0].reshape(2, 2)
    curve = cubic(AT, angles, slope)
    for begin, end, its, bend in zip(AT[:-1], AT[1:], rates, bends, strict=True):
        parts = its.reshape(PIECE_PARTS, 3)
        grid = np.linspace(begin, end, PIECE_PARTS + 1)
        assert parts[:, 0] == pytest.approx(curve.derivative()(grid[:-1])[:, 0])
        assert parts[:-1, 2] == pytest.approx(curve.derivative()(grid[1:-1])[:, 0])
        for (low, high), points in zip(pairwise(grid), parts, strict=True):
            dense = curve.derivative()(np.linspace(low, high, 50)[:-1])
            assert points.min() - 1e-9 <= dense.min() <= dense.max() <= points.max() + 1e-9
        inside = np.array([begin + 1e-9, end - 1e-9])
        assert bend == pytest.approx(curve.derivative(2)(inside)[:, 0], abs=1e-6)


def test_a_turn_at_one_rate_has_that_rate() -> None:
    angles, slope = np.array([0.0, 1.0, 3.0]), np.ones(3)
    task = HeadingTask(AT, angles, rate=1.0, acceleration=1e-9)
    assert within_limits(task, angles, slope)
    assert not within_limits(HeadingTask(AT, angles, rate=0.999), angles, slope)
