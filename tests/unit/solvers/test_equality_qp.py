"""The optimum under equalities alone: exact where weights differ by many orders, none if it is not unique."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.sparse import csr_matrix

from shotc.geom.bspline import count, energy_rows, value_rows
from shotc.solvers.equality_qp import minimise_under_equalities
from shotc.solvers.spline_problem import scalar_map


@pytest.mark.parametrize("length", [30.0, 3e3, 3e4])
def test_a_spline_of_long_and_short_pieces_meets_its_anchors_and_is_stationary(length: float) -> None:
    """Pieces from 5 m on, twice as long with each step from an anchor; the jerk is weighed as in the path
    programme, so that it outweighs an anchor by up to 1e15.
    """
    anchors = np.linspace(0.0, length, 7)
    near = 5.0 * 2.0 ** np.arange(20)
    steps = near[near < length / 12.0]
    breaks = np.unique(
        np.concatenate([anchors, *(a + steps for a in anchors), *(a - steps for a in anchors)])
    )
    breaks = breaks[(breaks >= 0.0) & (breaks <= length)]
    size, rows = count(breaks), energy_rows(breaks, 3)
    jerk = scalar_map(rows, size) * (length / 6.0) ** 2.5
    values = np.random.default_rng(1).uniform(-length / 3.0, length / 3.0, (7, 2))
    at = scalar_map(value_rows(breaks, anchors), size)
    found = minimise_under_equalities(jerk.T @ jerk, np.zeros((size, 2)), at, values)
    assert found is not None
    assert np.abs(at @ found - values).max() < 1e-7
    slope = jerk.T @ (jerk @ found)
    # Along the equalities there is no slope: what is left is a combination of their rows. Rounding grows with
    # the length, since the slope is a difference of numbers of which the largest is 1e15 of the least.
    weights = np.linalg.lstsq(at.toarray().T, slope, rcond=None)[0]
    assert np.abs(slope - at.T @ weights).max() < 1e-4 * np.abs(abs(jerk.T) @ abs(jerk @ found)).max()


def test_without_a_unique_optimum_there_is_none() -> None:
    nothing = csr_matrix((3, 3))
    assert (
        minimise_under_equalities(nothing, np.ones((3, 1)), csr_matrix(np.eye(3)[:1]), np.ones((1, 1)))
        is None
    )
