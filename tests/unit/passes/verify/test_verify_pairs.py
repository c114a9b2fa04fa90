"""Two flights on one clock, taken from each other piece by piece."""

from __future__ import annotations

import numpy as np
import pytest

from shotc.geom.bernstein import Piecewise
from shotc.passes.verify.pair import _difference


@pytest.mark.parametrize("seed", range(6))
def test_the_difference_of_two_flights_holds_at_every_instant(seed: int) -> None:
    """Breaks that differ, that are shared but for rounding, and one drone that stands after it has landed."""
    draw = np.random.default_rng(seed)

    def flight(breaks: np.ndarray) -> Piecewise:
        return Piecewise(breaks, draw.normal(scale=20.0, size=(len(breaks) - 1, 6, 3)))

    breaks = np.concatenate([[0.0], np.cumsum(draw.uniform(0.01, 5.0, 7))])
    other = breaks[:5] * (1 + 1e-15) if seed % 2 else np.concatenate([[0.0], np.sort(draw.uniform(0, 30, 9))])
    one, two = flight(breaks), flight(other)
    apart = _difference(one, two)
    assert apart.low[0] == 0.0
    assert apart.high[-1] == max(one.end, two.end)
    assert (apart.low[1:] == apart.high[:-1]).all()
    wide = apart.high - apart.low > 1e-9
    middle = 0.5 * (apart.low + apart.high)[wide]
    found = Piecewise(np.append(apart.low, apart.high[-1]), apart.ctrl)(middle)
    assert np.abs(found - (one(middle) - two(middle))).max() < 1e-9
