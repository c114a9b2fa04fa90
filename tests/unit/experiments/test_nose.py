"""The joint programme of place and heading, Eq. 12 to 19 of the yaw paper, beside ways that look ahead."""

from __future__ import annotations

from math import radians

import numpy as np
import pytest
from scipy.interpolate import CubicSpline
from scipy.optimize import check_grad

from tests.experiments.papers import nose

pytestmark = pytest.mark.slow


@pytest.mark.long
def test_both_keep_the_cone_and_the_limits_past_the_mast() -> None:
    who, of = nose.drone(), nose.instances(2)[1]
    (plain, _), (way, _) = nose.ours(who, of, look_ahead=False), nose.ours(who, of)
    assert nose.measured(plain, of, who.limits, 0.0).beyond > radians(5.0)
    found = nose.measured(way, of, who.limits, 0.0)
    assert found.beyond == 0.0
    assert found.kept
    joint = nose.joint(who, of, plain, 1.6 * found.takes)[0]
    made = nose.measured(joint, of, who.limits, 0.0)
    assert made.kept
    assert made.beyond < radians(nose.NEAR_DEG)
    # The rates of the heading are those of the direction that was found.
    yaw = np.unwrap(joint.yaw)
    assert joint.yaw_rate[1:-1] == pytest.approx(np.gradient(yaw, joint.t)[1:-1], abs=1e-3)
    inner = slice(2, -2)
    assert joint.yaw_acceleration[inner] == pytest.approx(
        np.gradient(joint.yaw_rate, joint.t)[inner], abs=2e-2
    )


def test_the_programme_s_gradient_is_that_of_its_cost() -> None:
    who, of, rng = nose.drone(), nose.instances(1)[0], np.random.default_rng(2)
    rest = (1, np.zeros(6))
    basis = CubicSpline(np.linspace(0.0, 9.0, 6), np.eye(6), bc_type=(rest, rest))
    cost = nose._cost(who, of, basis, rng.normal(size=(2, 5)), 10.0, coupled=True)
    at = rng.normal(1.0, 1.0, 20)
    size = np.linalg.norm(cost(at)[1])
    assert check_grad(lambda x: cost(x)[0], lambda x: cost(x)[1], at) < 1e-5 * size
