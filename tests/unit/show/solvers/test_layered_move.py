"""Layers that rise and sink, by dense samples of their splines."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from shotc.geom.fleet_spline import places
from shotc.ir.limits import Limits
from shotc.show.solvers.layered_move import PIECE_S, LayeredMove, rising, sinking

LIMITS = Limits(5.0, 2.5, 2.0, 2.5, 8.0, 1.0, 1.0)


def flown(move: LayeredMove, heights: list[float], down: bool) -> tuple[np.ndarray, np.ndarray]:
    """Return breaks and control points of one drone a layer, all over one place."""
    low, high = np.zeros((len(heights), 3)), np.array([[0.0, 0.0, height] for height in heights])
    ends = (high, low) if down else (low, high)
    coef = np.stack([ends[0]] * 3 + move.between(*ends) + [ends[1]] * 3, axis=1)
    return PIECE_S * np.arange(coef.shape[1] - 2, dtype=np.float64), coef


@pytest.mark.slow
@given(
    st.integers(2, 7),
    st.floats(0.5, 6.0),
    st.floats(0.3, 15.0),
    st.booleans(),
    st.tuples(st.floats(0.5, 6.0), st.floats(0.5, 6.0), st.floats(1.0, 8.0), st.floats(2.0, 30.0)),
)
@settings(max_examples=60)
def test_layers_in_the_air_are_a_step_apart(
    count: int, step: float, rise: float, down: bool, most: tuple[float, float, float, float]
) -> None:
    climb, descent, acceleration, jerk = most
    limits = LIMITS._replace(climb=climb, descent=descent, acceleration=acceleration, jerk=jerk)
    heights = [rise + step * (count - 1 - k) for k in range(count)]
    make = sinking if down else rising
    move = make(heights, step, np.arange(count), limits)
    breaks, coef = flown(move, heights, down)
    times = np.linspace(0.0, breaks[-1], 40 * (len(breaks) - 1) + 1)
    z = places(breaks, coef, times)[..., 2]
    aloft = z > 1e-9
    for upper, lower, both in zip(z, z[1:], aloft[:-1] & aloft[1:], strict=False):
        assert (upper - lower)[both].min(initial=np.inf) >= step - 1e-6
    # Whoever is below is in the air only while those above it are.
    assert not (aloft[1:] & ~aloft[:-1]).any()
    rate, bend = (places(breaks, coef, times, order)[..., 2] for order in (1, 2))
    assert rate.max() <= climb + 1e-9
    assert -rate.min() <= descent + 1e-9
    assert np.abs(bend).max() <= limits.usable_acceleration + 1e-9
    third = np.diff(coef[..., 2], 3, axis=1) / PIECE_S**3
    assert np.abs(third).max() <= jerk + 1e-9


def test_layers_rise_beside_each_other_in_time() -> None:
    """Each waits only till those above it are a step up: the next is on its way long before they stand."""
    heights = [27.5, 25.0, 22.5, 20.0, 17.5, 15.0, 12.5, 10.0]
    together = rising(heights, 2.5, np.arange(8), LIMITS).duration
    alone = [rising([height], 2.5, np.arange(1), LIMITS).duration for height in heights]
    assert together < 0.5 * sum(alone)
    assert alone[0] == pytest.approx(27.5 / 2.5 + 2.5 / 2.5 + 2.5 / 8, abs=2 * PIECE_S)


def test_a_take_off_ends_with_its_last_layer_and_a_landing_begins_with_its_first() -> None:
    layers = np.arange(3)
    up, down = (make([8.0, 6.0, 4.0], 2.0, layers, LIMITS) for make in (rising, sinking))
    assert up.shares[:, -4].min() < 1.0
    assert down.shares[:, 3].min() < 1.0
