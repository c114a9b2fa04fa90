"""Thrust and tilt: closed forms, the paper's Euler angles, and the ball that keeps both."""

from math import asin, atan2, cos, inf, radians, sin, tan

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from shotc.geom.pieces import Pieces
from shotc.geom.proof import sup_convex
from shotc.ir.limits import G_M_S2, Limits
from shotc.ir.thrust import lean, thrust_to_weight

LIMITS = Limits(8.0, 3.0, 1.5, 3.0, 8.0, 1.0, 1.5)
VECTOR = arrays(np.float64, 3, elements=st.floats(-9.0, 9.0))


def test_hovering_is_upright_and_carries_the_weight() -> None:
    assert lean(np.zeros(3)) == 0.0
    assert thrust_to_weight(np.zeros(3)) == pytest.approx(1.0)


def test_a_turn_leans_by_the_angle_of_its_level_acceleration() -> None:
    level = np.array([3.0, -4.0, 0.0])
    assert lean(level) == pytest.approx(atan2(5.0, G_M_S2))
    assert thrust_to_weight(level) == pytest.approx(1.0 / cos(atan2(5.0, G_M_S2)))


def test_thrust_that_does_not_point_up_counts_as_upside_down() -> None:
    assert lean(np.array([1.0, 0.0, -G_M_S2])) == pytest.approx(np.pi)


@pytest.mark.slow
@given(VECTOR, st.floats(-3.0, 3.0))
def test_the_lean_is_that_of_roll_and_pitch_in_equation_4(a: np.ndarray, yaw: float) -> None:
    size = G_M_S2 * float(thrust_to_weight(a))
    roll = -asin((a[1] * cos(yaw) - a[0] * sin(yaw)) / size)
    pitch = atan2(a[0] * cos(yaw) + a[1] * sin(yaw), a[2] + G_M_S2)
    assert cos(float(lean(a))) == pytest.approx(cos(roll) * cos(pitch), abs=1e-9)


@pytest.mark.slow
@given(arrays(np.float64, (2, 4, 3), elements=st.floats(-9.0, 9.0)))
def test_no_instant_leans_further_than_the_bound(ctrl: np.ndarray) -> None:
    pieces = Pieces(np.array([0.0, 1.0]), np.array([1.0, 2.0]), ctrl)
    bound = sup_convex(pieces, lean, lambda _: 1e-6)
    x = np.linspace(0.0, 1.0, 101)[:, None]
    basis = np.hstack([(1 - x) ** 3, 3 * x * (1 - x) ** 2, 3 * x**2 * (1 - x), x**3])
    seen = float(lean(np.einsum("tk,mkd->mtd", basis, ctrl)).max())
    assert seen <= bound.proven + 1e-9
    assert bound.attained >= seen - 2e-6 or bound.proven == pytest.approx(bound.attained, abs=2e-6)


@pytest.mark.slow
@given(VECTOR, st.floats(2.0, 75.0), st.floats(1.03, 3.0))
def test_the_usable_ball_keeps_every_limit_and_touches_one(a: np.ndarray, tilt: float, ratio: float) -> None:
    limits = LIMITS._replace(tilt=radians(tilt), thrust_to_weight=ratio)
    most = limits.usable_acceleration
    inside = a * min(1.0, most / max(float(np.linalg.norm(a)), 1e-12))
    assert lean(inside) <= limits.tilt + 1e-9
    assert thrust_to_weight(inside) <= ratio + 1e-9
    assert np.linalg.norm(inside) <= limits.acceleration + 1e-9
    # Across the cone, and straight up, a larger ball would break one of them.
    across = 1.001 * most * np.array([cos(limits.tilt), 0.0, -sin(limits.tilt)])
    up = 1.001 * most * np.array([0.0, 0.0, 1.0])
    broken = lean(across) > limits.tilt, thrust_to_weight(up) > ratio, 1.001 * most > limits.acceleration
    assert any(broken)


def test_who_says_nothing_is_not_limited() -> None:
    assert LIMITS.usable_acceleration == LIMITS.acceleration
    assert LIMITS.acceleration_bounds["tilt"] == LIMITS.acceleration_bounds["thrust_to_weight"] == inf
    assert LIMITS._replace(tilt=radians(10)).usable_acceleration == pytest.approx(G_M_S2 * sin(radians(10)))
    assert G_M_S2 * sin(radians(10)) < G_M_S2 * tan(radians(10))
