"""How near flown drones come, against distances known or looked for finely."""

import numpy as np
import pytest

from shotc.ir.show import Apart
from shotc.simulation.fleets.near import nearest

BALL = Apart("ellipsoid", 1.0, 1.0, 0.0)


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


@pytest.mark.slow
@pytest.mark.parametrize("shape", ["ellipsoid", "cylinder"])
def test_as_near_as_a_fine_search_finds_them(shape):
    rng = np.random.default_rng(4)
    position = np.cumsum(rng.normal(0, 0.5, (25, 12, 3)), axis=1) + rng.uniform(-4, 4, (25, 1, 3))
    apart = Apart(shape, 1.0, 2.0, 0.0)
    times = np.arange(12.0)
    fine = np.stack([np.stack([np.interp(np.linspace(0, 11, 8801), times, p[:, d]) for d in range(3)], 1)
                     for p in position])  # fmt: skip
    i, j = np.triu_indices(25, 1)
    away = (fine[i] - fine[j]) * [1.0, 1.0, 0.5]
    across, up = np.linalg.norm(away[..., :2], axis=2), np.abs(away[..., 2])
    size = np.maximum(across, up) if shape == "cylinder" else np.hypot(across, up)
    found = nearest(times, position, apart, 0.3)
    assert found.distance == pytest.approx(size.min(), abs=2e-3)
    assert found.below == pytest.approx((size.min(axis=1) < 0.3).sum(), abs=1)
