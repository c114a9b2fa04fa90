"""Constraint generation asks few cones and finds the optimum under all of them."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from shotc.solvers import cone_rows
from shotc.solvers.cone_rows import Array, ConeRows, WarmStart
from shotc.solvers.conic import Status

TOLERANCE = 1e-9


def through(rng: np.random.Generator, count: int = 40) -> tuple[ConeRows, Array]:
    """Return a chain of places in the plane with bounds of all kinds, which (2, 1) keeps; what it wants."""
    rows, wanted = ConeRows(2 * count), rng.normal(0.0, 3.0, 2 * count)
    x, y = np.arange(0, 2 * count, 2), np.arange(1, 2 * count, 2)
    one = np.ones(count)
    rows.zero([(np.array([x[0]]), np.ones(1))], np.array([-2.0]))
    rows.positive(4.0 * one, [(x, -one)])
    rows.positive(1.0 * one, [(y, one)])
    rows.second_order(rng.uniform(3.0, 4.0, count), [[], [(x, one)], [(y, one)]])
    steps = np.ones(count - 1)
    rows.second_order(2.0 * steps, [[], *([(k[1:], steps), (k[:-1], -steps)] for k in (x, y))])
    return rows, wanted


@pytest.mark.slow
@given(st.integers(0, 2**32 - 1), st.sampled_from([0.3, 0.8, 1.0]))
def test_the_optimum_is_that_under_all_cones(seed: int, share: float) -> None:
    rows, wanted = through(np.random.default_rng(seed))
    whole, best = rows.solve(-wanted, TOLERANCE, np.ones(len(wanted)))
    some, found = rows.solve(
        -wanted, TOLERANCE, np.ones(len(wanted)), near=WarmStart(np.tile([2.0, 1.0], 40), share)
    )
    assert whole is some is Status.SOLVED
    # The cost has a curvature of 1: two places that far apart differ by half its square.
    cost = 0.5 * best @ best - wanted @ best
    assert 0.5 * ((found - best) ** 2).sum() < 2.0 * TOLERANCE * (1.0 + abs(cost))


def test_few_cones_are_asked(monkeypatch: pytest.MonkeyPatch) -> None:
    asked = []
    solve = cone_rows._solved
    monkeypatch.setattr(
        cone_rows, "_solved", lambda of, settings: (asked.append(of[2].shape[0]), solve(of, settings))[1]
    )
    rows = ConeRows(100)
    each, one = np.arange(100), np.ones(100)
    rows.positive(one, [(each, -one)])
    wanted = np.where(each == 50, 3.0, 0.0)
    status, x = rows.solve(-wanted, TOLERANCE, one, near=WarmStart(np.zeros(100), 1.0))
    assert status is Status.SOLVED
    assert np.abs(x - np.minimum(wanted, 1.0)).max() < 1e-6
    assert asked == [0, 2 * cone_rows.BESIDE_CONES + 1]


def test_what_no_place_keeps_is_infeasible_however_few_cones_are_asked() -> None:
    rows, one = ConeRows(1), np.ones(1)
    rows.positive(-2.0 * one, [(np.array([0]), one)])
    rows.positive(one, [(np.array([0]), -one)])
    status, _ = rows.solve(np.zeros(1), TOLERANCE, one, near=WarmStart(np.zeros(1), 1.0))
    assert status is Status.INFEASIBLE


def test_a_cost_that_falls_for_ever_under_some_cones_is_solved_under_all() -> None:
    rows, one = ConeRows(1), np.ones(1)
    rows.positive(5.0 * one, [(np.array([0]), -one)])
    status, x = rows.solve(-one, TOLERANCE, near=WarmStart(np.zeros(1), 1.0))
    assert status is Status.SOLVED
    assert x[0] == pytest.approx(5.0, abs=1e-6)
