"""Time laws through places at given times, against the closed form and each limit alone."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from shotc.solvers.conic import Status
from shotc.solvers.timed_qp import PathLimits, TimeLaw, _Model, time_law

CELLS, LENGTH, TIME = 60, 30.0, 12.0
KNOTS = np.linspace(4.0, 4.0 + TIME, CELLS + 1)
ENDS = ((0, 10.0), (CELLS, 10.0 + LENGTH))
MEAN = LENGTH / TIME
"""m/s"""


def straight(limit: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Derivatives of a straight way by its length, over a limit: shape (N + 1, 3) each."""
    first = np.tile([0.6 / limit, 0.8 / limit, 0.0], (CELLS + 1, 1))
    return first, np.zeros_like(first), np.zeros_like(first)


def free() -> TimeLaw:
    return time_law(KNOTS, ENDS, None, None)


def held(speed: float = 1e6, acceleration: float = 1e6, jerk: float = 1e6) -> TimeLaw:
    limits = PathLimits(np.full(CELLS + 1, speed), (straight(acceleration),), (straight(jerk),))
    return time_law(KNOTS, ENDS, limits, free())


def test_without_limits_it_is_the_quintic_of_least_jerk() -> None:
    law = free()
    u = (KNOTS - KNOTS[0]) / TIME
    assert law.status is Status.SOLVED
    assert law.s == pytest.approx(10.0 + LENGTH * (10 * u**3 - 15 * u**4 + 6 * u**5), abs=2e-3 * LENGTH)
    energy = float((law.j**2 * np.diff(KNOTS)).sum())
    assert energy == pytest.approx(720 * LENGTH**2 / TIME**5, rel=1e-2)
    assert law.v.max() == pytest.approx(1.875 * MEAN, rel=5e-3)


def test_a_speed_limit_alone_binds() -> None:
    law = held(speed=1.4 * MEAN)
    assert law.status is Status.SOLVED
    assert law.overdraft == pytest.approx(0.0, abs=1e-6)
    assert law.v.max() == pytest.approx(1.4 * MEAN, rel=1e-5)


def test_an_acceleration_limit_alone_binds() -> None:
    most = 0.9 * float(np.abs(free().a).max())
    law = held(acceleration=most)
    assert law.overdraft == pytest.approx(0.0, abs=1e-6)
    assert np.abs(law.a).max() == pytest.approx(most, rel=1e-5)


def test_a_jerk_limit_alone_binds() -> None:
    most = 0.8 * float(np.abs(free().j).max())
    law = held(jerk=most)
    assert law.overdraft == pytest.approx(0.0, abs=1e-6)
    assert np.abs(law.j).max() == pytest.approx(most, rel=1e-5)


def test_a_speed_that_cannot_do_is_overdrawn_by_what_the_law_exceeds() -> None:
    law = held(speed=0.9 * MEAN)
    assert law.overdraft > 1 / 0.9 - 1
    assert law.v.max() == pytest.approx(0.9 * MEAN * (1 + law.overdraft), rel=1e-4)


def test_it_goes_through_places_between() -> None:
    law = time_law(KNOTS, (ENDS[0], (20, 15.0), (45, 36.0), ENDS[1]), None, None)
    assert law.s[[20, 45]] == pytest.approx([15.0, 36.0], abs=1e-5)
    assert law.v[[0, -1]] == pytest.approx([0.0, 0.0], abs=1e-6)
    assert law.a[[0, -1]] == pytest.approx([0.0, 0.0], abs=1e-6)
    assert (law.v >= -1e-6).all()


@pytest.mark.parametrize("side", [slice(None, -1), slice(1, None)])
def test_the_rows_of_a_jerk_are_its_tangent_at_the_last_law(side: slice) -> None:
    """Beside the last law the rows miss q' j + 3 q'' v a + q''' v^3 by the square of how far it is."""
    rng = np.random.default_rng(3)
    nodes, size, time = 5, 2.0, 3.0
    v, a, jerk = rng.uniform(1.0, 2.0, nodes), rng.normal(size=nodes), rng.normal(size=nodes - 1)
    d1, d2, d3 = rng.normal(size=(3, nodes - 1, 2))
    kept: list[Any] = []
    model: Any = SimpleNamespace(nodes=nodes, size=size, time=time, norm=kept.extend)
    _Model._jerk(model, side, d1, d2, d3, SimpleNamespace(v=v, a=a))  # type: ignore[arg-type]
    off_v, off_a = rng.normal(size=(2, nodes))
    for step in (0.0, 1e-4):
        near_v, near_a = v + step * off_v, a + step * off_a
        units = [np.zeros(nodes), near_v * time / size, near_a * time**2 / size, jerk * time**3 / size]
        x = np.concatenate(units)
        exact = d1.T * jerk + 3 * d2.T * (near_v * near_a)[side] + d3.T * near_v[side] ** 3
        for (terms, constant), value in zip(kept, exact, strict=True):
            found = constant + sum(coefficient * x[columns] for columns, coefficient in terms)
            assert found == pytest.approx(value, abs=1e-12 + 100.0 * step**2)
