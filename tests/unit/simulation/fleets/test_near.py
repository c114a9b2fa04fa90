"""How near flown drones come, against distances known or looked for finely."""

import numpy as np
import pytest

from shotc.ir.show import Apart
from shotc.simulation.fleets.near import Across
from tests.support.fleet_flights import nearest

BALL = Apart("ellipsoid", 1.0, 1.0, 0.0)
SPLIT = 20


def test_two_that_pass_between_two_records():
    # They pass at 0.3 m, half way between two records.
    t = np.array([0.0, 1.0])
    one = np.array([[-1.0, 0.0, 5.0], [1.0, 0.0, 5.0]])
    other = np.array([[1.0, 0.3, 5.0], [-1.0, 0.3, 5.0]])
    found = nearest(t, np.stack([one, other, one + np.array([0.0, 9.0, 0.0])]), BALL, 0.5)
    assert found.distance == pytest.approx(0.3, abs=1e-9)
    assert found.time == pytest.approx(0.5, abs=1e-6)
    assert {found.first, found.second} == {0, 1}
    assert found.below == 1


def test_heights_are_stretched():
    still = np.array([[0.0, 0.0, 5.0], [0.0, 0.0, 7.0]])[:, None].repeat(2, axis=1)
    apart = Apart("ellipsoid", 1.0, 3.0, 0.0)
    assert nearest(np.array([0.0, 1.0]), still, apart, 1.0).distance == pytest.approx(2.0 / 3.0)


def walks(apart):
    """Return times, walks of 25, how near each two come between, (300, T), and their indices."""
    rng = np.random.default_rng(4)
    position = np.cumsum(rng.normal(0, 0.5, (25, 12, 3)), axis=1) + rng.uniform(-4, 4, (25, 1, 3))
    times, often = np.arange(12.0), np.linspace(0, 11, 8801)
    fine = np.stack([np.stack([np.interp(often, times, p[:, d]) for d in range(3)], 1) for p in position])
    i, j = np.triu_indices(25, 1)
    away = (fine[i] - fine[j]) * [1.0, 1.0, 0.5]
    across, up = np.linalg.norm(away[..., :2], axis=2), np.abs(away[..., 2])
    size = np.maximum(across, up) if apart.shape == "cylinder" else np.hypot(across, up)
    return times, position, size, (i, j)


@pytest.mark.slow
@pytest.mark.parametrize("shape", ["ellipsoid", "cylinder"])
def test_as_near_as_a_fine_search_finds_them(shape):
    apart = Apart(shape, 1.0, 2.0, 0.0)
    times, position, size, _ = walks(apart)
    found = nearest(times, position, apart, 0.3)
    assert found.distance == pytest.approx(size.min(), abs=2e-3)
    assert found.below == pytest.approx((size.min(axis=1) < 0.3).sum(), abs=1)


@pytest.mark.slow
@pytest.mark.parametrize("limit", [0.01, 1.0])
@pytest.mark.parametrize("shape", ["ellipsoid", "cylinder"])
def test_of_two_fleets_those_of_one_do_not_count(shape, limit):
    apart = Apart(shape, 1.0, 2.0, 0.0)
    times, position, size, (i, j) = walks(apart)
    search = Across(apart, limit)
    for time, places in zip(times.tolist(), np.moveaxis(position, 1, 0), strict=True):
        search.add(time, places[:SPLIT], places[SPLIT:])
    found, crossing = search.nearest(), (i < SPLIT) & (j >= SPLIT)
    least = size.min(axis=1)
    k = np.flatnonzero(crossing)[least[crossing].argmin()]
    assert least[~crossing].min() < least[k]
    assert found.distance == pytest.approx(least[k], abs=2e-3)
    assert (found.first, found.second + SPLIT) == (i[k], j[k])
    assert found.below == pytest.approx((least[crossing] < limit).sum(), abs=1)
