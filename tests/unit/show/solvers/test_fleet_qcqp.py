"""The fleet's quadratic programme against cvxpy on the same data, and its bounds between samples."""

from __future__ import annotations

import cvxpy as cp
import numpy as np
import pytest

from shotc.geom.bernstein import Array
from shotc.geom.fleet_spline import centres, differences, knots, places
from shotc.ir.limits import Limits
from shotc.show.solvers import qcqp as fleet_qcqp
from shotc.show.solvers.qcqp import DerivativeBounds, bounded, deviation, overdraft

LIMITS = Limits(3.5, 2.5, 1.5, 2.0, 8.0, 1.0, 1.0)


def walks(count: int, frames: int, size: float, period: float) -> tuple[Array, Array]:
    """Return breaks and control points of random walks, at rest at both ends."""
    goals = np.cumsum(np.random.default_rng(7).normal(scale=size, size=(count, frames, 3)), axis=1)
    coef = np.concatenate([goals[:, :1]] * 2 + [goals] + [goals[:, -1:]] * 2, axis=1)
    return period * np.arange(coef.shape[1] - 2.0), coef


def optimum(breaks: Array, wanted: Array, bounds: DerivativeBounds) -> float:
    """Return the least deviation of one drone, modelled independently in cvxpy."""
    x = cp.Variable(wanted.shape)
    root = np.linalg.cholesky(deviation(breaks) + 1e-13 * np.eye(len(wanted)))
    rows = [x[:3] == wanted[:3], x[-3:] == wanted[-3:]]
    limits = bounds.limits
    for order in (1, 2, 3):
        d = differences(breaks, order) @ x
        if order == 1:
            rows += [cp.norm(d[:, :2], axis=1) <= limits.speed, d[:, 2] <= limits.climb]
            rows += [d[:, 2] >= -limits.descent]
        elif order == 2 and bounds.per_axis:
            rows += [cp.abs(d) <= limits.acceleration]
        else:
            rows += [cp.norm(d, axis=1) <= (limits.acceleration if order == 2 else limits.jerk)]
    problem = cp.Problem(cp.Minimize(cp.sum_squares(root.T @ (x - wanted))), rows)
    problem.solve(solver=cp.CLARABEL)
    return float(problem.value)


def cost(breaks: Array, coef: Array, wanted: Array) -> Array:
    shift = coef - wanted
    return np.asarray(np.einsum("nkd,kl,nld->n", shift, deviation(breaks), shift))


@pytest.mark.slow
@pytest.mark.parametrize("per_axis", [False, True])
@pytest.mark.parametrize(("size", "period"), [(2.0, 1.5), (0.4, 0.4)])
def test_the_deviation_is_the_least_there_is(size: float, period: float, per_axis: bool) -> None:
    breaks, wanted = walks(4, 30, size, period)
    bounds = DerivativeBounds(LIMITS, per_axis)
    done = bounded(breaks, wanted, bounds)
    assert not done.failed.size
    assert done.changed
    reached = cost(breaks, done.coef, wanted)
    for k in range(len(wanted)):
        # Clarabel solves it for the limits that the iteration aims at.
        least = optimum(breaks, wanted[k], bounds.scaled(fleet_qcqp.LIMIT_SHARE))
        assert reached[k] == pytest.approx(least, rel=1e-3, abs=1e-6)
    assert (overdraft(breaks, done.coef, bounds) <= 0.0).all()


def test_the_bounds_hold_between_samples_and_the_ends_stay() -> None:
    breaks, wanted = walks(20, 60, 2.0, 1.5)
    coef = bounded(breaks, wanted, DerivativeBounds(LIMITS)).coef
    times = np.linspace(breaks[0], breaks[-1], 6001)
    velocity = places(breaks, coef, times, 1)
    assert np.hypot(velocity[..., 0], velocity[..., 1]).max() <= LIMITS.speed
    assert -LIMITS.descent <= velocity[..., 2].min()
    assert velocity[..., 2].max() <= LIMITS.climb
    assert np.linalg.norm(places(breaks, coef, times, 2), axis=-1).max() <= LIMITS.acceleration
    assert np.linalg.norm(places(breaks, coef, times, 3), axis=-1).max() <= LIMITS.jerk
    assert (coef[:, :3] == wanted[:, :3]).all()
    assert (coef[:, -3:] == wanted[:, -3:]).all()


def test_whoever_keeps_the_limits_is_left_alone() -> None:
    breaks, wanted = walks(8, 20, 1.5, 1.5)
    wanted[3] = wanted[3, :1] + 0.05 * (wanted[3] - wanted[3, :1])
    done = bounded(breaks, wanted, DerivativeBounds(LIMITS))
    assert (done.coef[3] == wanted[3]).all()
    assert done.changed == 7


def test_stragglers_are_solved_by_the_interior_point_method(monkeypatch: pytest.MonkeyPatch) -> None:
    breaks, wanted = walks(2, 20, 2.0, 1.5)
    bounds = DerivativeBounds(LIMITS)
    usual = bounded(breaks, wanted, bounds)
    monkeypatch.setattr(fleet_qcqp, "MOST_ROUNDS", 1)
    monkeypatch.setattr(fleet_qcqp, "ROUND_ITERATIONS", 1)
    exact = bounded(breaks, wanted, bounds)
    assert exact.exact == 2
    assert cost(breaks, exact.coef, wanted) == pytest.approx(cost(breaks, usual.coef, wanted), rel=1e-3)


def test_what_nobody_could_fly_fails() -> None:
    breaks, wanted = walks(2, 6, 0.1, 0.5)
    wanted[1, -3:] += 100.0
    done = bounded(breaks, wanted, DerivativeBounds(LIMITS))
    assert done.failed.tolist() == [1]
    assert (done.coef[1] == wanted[1]).all()


def test_the_gram_matrix_is_the_integral() -> None:
    breaks = np.array([0.0, 0.5, 2.0, 3.0, 3.2])
    coef = np.random.default_rng(0).normal(size=(1, 7, 3))
    times = np.linspace(0.0, 3.2, 200_001)
    squares = (places(breaks, coef, times)[0] ** 2).sum(axis=-1)
    assert len(knots(breaks)) == 11
    assert cost(breaks, coef, 0.0 * coef)[0] == pytest.approx(np.trapezoid(squares, times), rel=1e-7)


@pytest.mark.parametrize(
    ("velocity", "excess"),
    [
        ((2.1, 2.8, 0.0), 0.0),  # 3.5 m/s across, which is the limit
        ((2.4, 3.2, 0.0), 4.0 / 3.5 - 1.0),
        ((0.0, 0.0, 2.5), 0.0),
        ((0.0, 0.0, 3.0), 0.2),
        ((0.0, 0.0, -1.8), 0.2),
        ((2.4, 3.2, -3.0), 1.0),
    ],
)
def test_what_is_too_fast_is_told_by_its_worst_share(velocity: tuple[float, ...], excess: float) -> None:
    breaks = np.array([0.0, 1.0, 2.5, 3.0])
    slow = np.zeros((6, 3))
    coef = np.stack([slow, centres(breaks)[:, None] * np.array(velocity), slow])
    assert overdraft(breaks, coef, DerivativeBounds(LIMITS)) == pytest.approx([0.0, excess, 0.0], abs=1e-9)


@pytest.mark.parametrize(
    ("rate", "per_axis", "excess"),
    [
        ((1.2, 1.6, 0.0), False, 0.0),
        ((1.2, 1.6, 1.5), False, 0.25),
        ((1.2, -1.6, 1.5), True, 0.0),
        ((1.2, -2.2, 1.5), True, 0.1),
    ],
)
def test_acceleration_counts_whole_or_axis_by_axis(
    rate: tuple[float, ...], per_axis: bool, excess: float
) -> None:
    # x = a t^2 / 2: its control points are the products of pairs of knots, in the mean.
    breaks = np.linspace(0.0, 0.9, 4)
    t = knots(breaks)[1:-1]
    halves = np.array([(a * b + a * c + b * c) / 6 for a, b, c in zip(t, t[1:], t[2:], strict=False)])
    found = overdraft(breaks, (halves[:, None] * np.array(rate))[None], DerivativeBounds(LIMITS, per_axis))
    assert found == pytest.approx([excess], abs=1e-9)


@pytest.mark.parametrize("per_axis", [False, True])
def test_rows_are_projected_to_the_nearest_ones_within_the_bounds(per_axis: bool) -> None:
    """For all rows w within the bounds the angle at P(v) between v and w is at least a right one."""
    breaks, _ = walks(6, 8, 2.0, 1.0)
    programme = fleet_qcqp.FleetProgramme(breaks, DerivativeBounds(LIMITS, per_axis))
    rng = np.random.default_rng(3)
    for part in programme.rows:
        far = rng.normal(size=(len(part.scale), 6, 3)) * 3.0 * part.scale[:, None, None] * 3.0**part.order
        near, others = far.copy(), 0.1 * far[::-1].copy()
        for values in (near, others):
            fleet_qcqp._project(values, part, programme.bounds)
        unscaled = np.moveaxis(near / part.scale[:, None, None], 0, 1)
        excess = fleet_qcqp._excess(unscaled, part.order, programme.bounds)
        assert excess.max() == pytest.approx(0.0, abs=1e-12)
        assert (excess.max(axis=0) >= -1e-12).mean() > 0.5
        assert (((far - near) * (others - near)).sum(axis=2) <= 1e-12).all()


@pytest.mark.parametrize("per_axis", [False, True])
def test_the_iteration_ends_where_the_interior_point_method_does(per_axis: bool) -> None:
    breaks, wanted = walks(3, 10, 2.5, 1.2)
    programme = fleet_qcqp.FleetProgramme(breaks, DerivativeBounds(LIMITS, per_axis))
    found = programme.solve(wanted)
    assert found.done.all()
    for points, reference in zip(found.points, wanted, strict=True):
        exact = programme.solve_exactly(reference)
        assert exact is not None
        assert np.abs(points - exact).max() < 2e-3 * np.abs(exact - reference).max() + 1e-5


@pytest.mark.parametrize(("size", "period"), [(2.5, 1.2), (0.1, 0.2), (60.0, 20.0)])
def test_who_is_done_exceeds_no_bound_by_more_than_the_share_that_is_left_for_it(
    size: float, period: float
) -> None:
    """Pieces of any length, though their third differences are larger by the cube of it."""
    breaks, wanted = walks(3, 10, size, period)
    bounds = DerivativeBounds(LIMITS)
    found = fleet_qcqp.FleetProgramme(breaks, bounds).solve(wanted)
    assert found.done.any()
    excess = overdraft(breaks, found.points, bounds)[found.done]
    assert (excess <= fleet_qcqp.EXACT_SHARE).all()
    assert (excess > 0.0).any()


def test_drones_within_their_bounds_are_returned_bit_for_bit() -> None:
    breaks, slow = walks(5, 10, 0.01, 2.0)
    done = bounded(breaks, slow, DerivativeBounds(LIMITS))
    assert np.array_equal(done.coef, slow)
    assert (done.failed.size, done.changed, done.iterations, done.exact) == (0, 0, 0, 0)
    mixed = slow.copy()
    mixed[2, 5] += [0.0, 0.0, 20.0]
    some = bounded(breaks, mixed, DerivativeBounds(LIMITS))
    assert some.changed == 1
    assert np.array_equal(np.delete(some.coef, 2, axis=0), np.delete(slow, 2, axis=0))
