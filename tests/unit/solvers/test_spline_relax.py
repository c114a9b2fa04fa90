"""What has to give way, beside the same programme in a modelling layer."""

from __future__ import annotations

import cvxpy as cp
import numpy as np
import pytest

from shotc.geom.bspline import control_rows, count, subdivide, value_rows
from shotc.solvers.conic import Status
from shotc.solvers.spline_problem import Cones, Equalities, HalfSpaceRows, SplineProblem, scalar_map
from shotc.solvers.spline_relax import POINT_PRICE, relax

OWNERS = 4


def crowded(seed: int) -> SplineProblem:
    """Five points between two walls that leave no room, in a ring that is too small, climbing too fast."""
    rng = np.random.default_rng(seed)
    s = np.linspace(0.0, 20.0, 5)
    points = rng.normal(size=(5, 3)) * 4.0 + np.array([500.0, -300.0, 20.0])
    breaks = subdivide(s, 2)
    values, rates = control_rows(breaks), control_rows(breaks, 1)
    size = len(values.piece)
    away = rng.normal(size=3)
    away /= np.linalg.norm(away)
    most = points @ away
    middle = points.mean(axis=0)

    def wall(sign: float, owner: int) -> HalfSpaceRows:
        offset = sign * np.quantile(most, 0.5 + 0.2 * sign)
        return HalfSpaceRows(
            values, np.tile(sign * away, (size, 1)), np.full(size, offset), np.full(size, owner)
        )

    def bound(rows, axes, centre, most, owner, price=None):
        rows_count = len(rows.piece)
        centres, asked = np.tile(centre, (rows_count, 1)), np.full(rows_count, most)
        cost = None if price is None else np.full(rows_count, price)
        return Cones(rows, axes, centres, asked, cost, np.full(rows_count, owner))

    cones = (
        bound(values, (0, 1), middle[:2], 2.0, 2),
        bound(rates, (2,), np.zeros(1), 0.1, 3),
        bound(values, (0, 1, 2), middle, 0.01, 0, 1.0),  # priced: it stops nothing
    )
    return SplineProblem(
        count(breaks), (), Equalities(value_rows(breaks, s), points), (wall(1.0, 0), wall(-1.0, 1)), cones
    )


def modelled(problem: SplineProblem) -> tuple[float, np.ndarray, np.ndarray]:
    x = cp.Variable((problem.size, 3))
    lack, shift = cp.Variable(OWNERS, nonneg=True), cp.Variable(len(problem.equalities.value), nonneg=True)
    miss = scalar_map(problem.equalities.rows, problem.size) @ x - problem.equalities.value
    rows = [cp.norm(miss, axis=1) <= shift]
    for f in problem.half_spaces:
        along = cp.sum(cp.multiply(scalar_map(f.rows, problem.size) @ x, f.normal), axis=1)
        rows += [along + lack[f.owner] >= f.offset]
    for c in problem.cones:
        if c.price is None:
            off = (scalar_map(c.rows, problem.size) @ x)[:, list(c.axes)] - c.centre
            rows += [cp.norm(off, axis=1) <= c.bound + lack[c.owner]]
    programme = cp.Problem(cp.Minimize(cp.sum(lack) + POINT_PRICE * cp.sum(shift)), rows)
    programme.solve(solver=cp.CLARABEL, tol_feas=1e-9, tol_gap_rel=1e-9, tol_gap_abs=1e-9)
    return programme.value, lack.value, shift.value


@pytest.mark.parametrize("seed", range(4))
def test_the_least_give_way_is_the_one_that_a_modelling_layer_finds(seed: int) -> None:
    problem = crowded(seed)
    found, (cost, lack, shift) = relax(problem, OWNERS), modelled(problem)
    assert found.status is Status.SOLVED
    assert cost > 1.0
    assert found.owner_lack.sum() + POINT_PRICE * found.point_shift.sum() == pytest.approx(cost, rel=1e-6)
    assert found.owner_lack == pytest.approx(lack, abs=1e-4)
    assert found.point_shift == pytest.approx(shift, abs=1e-4)
    assert found.coef is not None
    miss = problem.equalities.rows.apply(found.coef) - problem.equalities.value
    assert (np.linalg.norm(miss, axis=1) <= found.point_shift + 1e-6).all()
    for wall in problem.half_spaces:
        along = (wall.rows.apply(found.coef) * wall.normal).sum(axis=1)
        assert (along + found.owner_lack[wall.owner] >= wall.offset - 1e-6).all()


def test_without_owners_or_bounds_nothing_gives_way() -> None:
    problem = crowded(0)
    found = relax(SplineProblem(problem.size, (), problem.equalities), 0)
    assert found.status is Status.SOLVED
    assert found.owner_lack.shape == (0,)
    assert found.point_shift == pytest.approx(np.zeros(5), abs=1e-6)
