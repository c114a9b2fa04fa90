"""The damped step against numpy's solution of the same equations."""

from __future__ import annotations

import numpy as np
import pytest

from shotc.geom.pose_search import damped_step


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("damping", [0.0, 1e-3, 2.0])
def test_a_step_solves_the_damped_equations(seed: int, damping: float) -> None:
    random = np.random.default_rng(seed)
    jacobian = random.normal(size=(7, 1 + seed % 4)) * [10.0**k for k in range(1 + seed % 4)]
    normal, gradient = jacobian.T @ jacobian, random.normal(size=jacobian.shape[1])
    expected = np.linalg.solve(normal + damping * np.diag(np.diag(normal)), gradient)
    assert damped_step(normal.tolist(), gradient.tolist(), damping) == pytest.approx(expected.tolist())


def test_rows_are_exchanged_where_a_pivot_is_zero() -> None:
    assert damped_step([[0.0, 2.0], [3.0, 1.0]], [4.0, 5.0], 0.0) == pytest.approx([1.0, 2.0])


def test_an_unknown_on_which_nothing_depends_stays_nearly_where_it_is() -> None:
    step = damped_step([[4.0, 0.0], [0.0, 0.0]], [8.0, 0.0], 1e-3)
    assert step == pytest.approx([8.0 / 4.004, 0.0])
