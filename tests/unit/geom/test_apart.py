"""The metric of a fleet: the stretched ball holds what is kept free, and straight moves need sqrt(2)
balls."""

from __future__ import annotations

from math import hypot, sqrt

import numpy as np
import pytest

from shotc.geom.apart import ball, spacing, straight_spacing, stretch
from shotc.ir.show import Apart

ELLIPSOID = Apart("ellipsoid", 1.0, 2.0, 0.15)
CYLINDER = Apart("cylinder", 1.0, 2.0, 0.15)


def test_an_ellipsoid_is_a_ball_once_stretched() -> None:
    assert stretch(ELLIPSOID) == pytest.approx(1.15 / 2.15)
    assert ball(ELLIPSOID) == pytest.approx(1.15)
    assert spacing(ELLIPSOID) == pytest.approx(1.001 * 1.15)
    assert straight_spacing(ELLIPSOID) == pytest.approx(sqrt(2) * 1.15)


def test_the_ball_of_a_cylinder_holds_its_rim() -> None:
    rim = hypot(1.15, 2.15 * stretch(CYLINDER))
    assert ball(CYLINDER) == pytest.approx(rim)
    assert spacing(CYLINDER) == pytest.approx(1.001 * 1.15)
    assert straight_spacing(CYLINDER) == pytest.approx(2 * 1.15)


@pytest.mark.parametrize("apart", [ELLIPSOID, CYLINDER])
def test_whoever_is_a_ball_apart_is_clear(apart: Apart) -> None:
    rng = np.random.default_rng(0)
    ways = rng.normal(size=(1000, 3))
    off = ball(apart) * (1 + 1e-9) * ways / np.linalg.norm(ways, axis=1)[:, None] / (1, 1, stretch(apart))
    level, upright = np.hypot(off[:, 0], off[:, 1]), np.abs(off[:, 2])
    if apart.shape == "cylinder":
        assert ((level >= apart.across) | (upright >= apart.upright)).all()
    else:
        assert ((level / apart.across) ** 2 + (upright / apart.upright) ** 2 >= 1).all()


def test_straight_moves_between_spaced_formations_stay_a_ball_apart() -> None:
    rng = np.random.default_rng(1)
    r0, r1 = rng.normal(size=(2, 2000, 3))
    r0, r1 = (straight_spacing(ELLIPSOID) * r / np.linalg.norm(r, axis=1)[:, None] for r in (r0, r1))
    kept = np.einsum("nd,nd->n", r0, r1) >= 0
    s = np.linspace(0, 1, 51)[:, None, None]
    between = (1 - s) * r0[kept] + s * r1[kept]
    assert np.linalg.norm(between, axis=2).min() >= ball(ELLIPSOID) * (1 - 1e-12)
