"""Time laws through places at given times, against the closed form and each limit alone."""

from __future__ import annotations

import numpy as np
import pytest

from shotc.solvers.conic import Status
from shotc.solvers.timed_qp import PathLimits, TimeLaw, time_law

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
