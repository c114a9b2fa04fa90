"""Choices of least cost against all that there are."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest

from shotc.solvers.assignment import AssignmentProgramme, least_cost


@pytest.mark.parametrize("seed", range(4))
def test_the_choice_costs_least_of_all(seed: int) -> None:
    # Worth and weight are nearly alike, so that what is taken first is seldom best.
    random = np.random.default_rng(seed)
    weight = random.uniform(5.0, 10.0, (2, 11))
    cost = -weight.sum(axis=0) - random.uniform(0.0, 2.0, 11)
    most = 0.4 * weight.sum(axis=1)
    once = np.array([[1.0] * 3 + [0.0] * 8])
    found = least_cost(AssignmentProgramme(cost, np.ones(11), once, weight, most, 11))
    every = np.array(list(product((0.0, 1.0), repeat=11)))
    feasible = every[(every @ weight.T <= most).all(axis=1) & (every[:, :3].sum(axis=1) == 1.0)]
    assert found is not None
    assert found == pytest.approx(np.rint(found))
    assert (weight @ found <= most + 1e-6).all()
    assert cost @ found == pytest.approx((feasible @ cost).min())


def test_unknowns_beyond_the_whole_ones_are_shared_out() -> None:
    # x + y = 1, y <= 0.25 is cheaper: with a whole x there is y = 0, without there is a quarter.
    shared = AssignmentProgramme(
        np.array([2.0, 1.0]), np.array([1.0, 0.25]), np.ones((1, 2)), np.zeros((1, 2)), np.zeros(1), 0
    )
    assert least_cost(shared) == pytest.approx([0.75, 0.25])
    whole = AssignmentProgramme(
        *(getattr(shared, name) for name in ("cost", "highest", "once", "rows", "most")), 1
    )
    assert least_cost(whole) == pytest.approx([1.0, 0.0])


def test_there_is_none_where_nothing_satisfies_the_programme() -> None:
    assert (
        least_cost(
            AssignmentProgramme(np.ones(2), np.ones(2), np.ones((1, 2)), np.ones((1, 2)), np.zeros(1), 2)
        )
        is None
    )
