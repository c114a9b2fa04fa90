"""Energy by momentum theory: closed forms, tables, and bounds of its integral."""

from math import pi, sqrt

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from shotc.geom.bernstein import quintic_hermite
from shotc.geom.integral import integral_convex
from shotc.geom.pieces import Pieces, pieces
from shotc.ir.limits import G_M_S2
from shotc.ir.power import Power, density_at
from shotc.ir.thrust import drawn, hover_ratio
from shotc.spec.presets import PRESETS

POWER = Power(2.0, 77 * 3600.0, 4, 0.127, 0.5, 0.2)


def test_hovering_costs_what_momentum_theory_says() -> None:
    weight, disc = 2.0 * G_M_S2, 4 * pi * 0.127**2
    assert POWER.ideal == pytest.approx(weight * sqrt(weight / (2 * 1.225 * disc)))
    assert POWER.hover == 2 * POWER.ideal
    assert POWER.endurance == pytest.approx(0.8 * 77 * 3600 / POWER.hover)


def test_a_hovering_time_gives_the_efficiency() -> None:
    power = POWER.hovering_for(18 * 60)
    assert power.hover * 18 * 60 == pytest.approx(power.battery)


def test_the_x500_hovers_as_long_as_its_maker_says_with_plausible_rotors() -> None:
    power = PRESETS["x500"].power
    assert power is not None
    assert power.endurance == PRESETS["x500"].endurance == pytest.approx(0.8 * 18 * 60)
    assert 0.4 < power.efficiency < 0.65  # blades of 10 inches give 0.55 to 0.75, motors about 0.8


@pytest.mark.parametrize(
    ("altitude", "density"), [(0, 1.2250), (1000, 1.1116), (3000, 0.9091), (5000, 0.7361)]
)
def test_the_air_is_as_thin_as_in_the_table_of_the_standard_atmosphere(
    altitude: float, density: float
) -> None:
    assert density_at(altitude) == pytest.approx(density, abs=2e-4)


def test_power_of_even_motion() -> None:
    still = np.zeros(3)
    climbing = drawn(POWER, np.array([0.0, 0.0, 2.0]), still)
    assert drawn(POWER, still, still) == pytest.approx(POWER.hover)
    assert drawn(POWER, np.array([8.0, 0.0, 0.0]), still) == pytest.approx(POWER.hover)
    # To first order of what an actuator disc takes that climbs.
    induced = sqrt(2.0 * G_M_S2 / (2 * 1.225 * 4 * pi * 0.127**2))
    exact = 2.0 * G_M_S2 * (1.0 + sqrt(1.0 + induced**2)) / 0.5
    assert climbing == pytest.approx(exact, rel=0.02)


def test_what_climbing_adds_comes_back_on_the_way_down() -> None:
    t = np.array([0.0, 8.0, 20.0])
    curve = quintic_hermite(
        t, np.array([[0.0, 0, 0], [9, 0, 20], [0, 0, 0]]), np.zeros((3, 3)), np.zeros((3, 3))
    )
    at = np.linspace(0.0, 20.0, 20001)
    watts = drawn(POWER, curve.derivative()(at), curve.derivative(2)(at))
    joules = float(np.sum(0.5 * (watts[1:] + watts[:-1]) * np.diff(at)))
    found = integral_convex(pieces(curve.derivative(2)), hover_ratio, 1e-6)
    assert POWER.hover * found.low <= joules * (1 + 1e-6)
    assert joules == pytest.approx(POWER.hover * found.high, rel=1e-5)
    assert joules > POWER.hover * 20.0  # Jensen: no flight from rest to rest takes less than hovering


@pytest.mark.slow
@given(arrays(np.float64, (3, 4, 3), elements=st.floats(-6.0, 6.0)))
def test_the_bounds_hold_the_integral_between_them(ctrl: np.ndarray) -> None:
    found = integral_convex(Pieces(np.arange(3.0), np.arange(3.0) + 1.0, ctrl), hover_ratio, 1e-4)
    x = (np.arange(4000) + 0.5)[:, None] / 4000
    basis = np.hstack([(1 - x) ** 3, 3 * x * (1 - x) ** 2, 3 * x**2 * (1 - x), x**3])
    mean = hover_ratio(np.einsum("tk,mkd->mtd", basis, ctrl)).mean(axis=1).sum()
    assert found.low * (1 - 1e-6) <= mean <= found.high * (1 + 1e-6)
    assert found.high - found.low <= 2e-4 * found.high
