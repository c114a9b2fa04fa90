"""The path programme judged by analytic optima and residuals, not by its solver's word."""

from __future__ import annotations

from dataclasses import replace

import cvxpy as cp
import numpy as np
import pytest
from scipy.interpolate import make_interp_spline

from shotc.geom.bspline import (
    SplineFunctionals,
    control_rows,
    count,
    energy_rows,
    spline,
    subdivide,
    value_rows,
)
from shotc.solvers import cone_rows, spline_qp
from shotc.solvers.conic import Status
from shotc.solvers.spline_fit import Fit, fit
from shotc.solvers.spline_problem import (
    Cones,
    Equalities,
    Goal,
    HalfSpaceRows,
    SplineProblem,
    centred,
    scalar_map,
)
from shotc.solvers.spline_qp import least_of, minimise, squares_of
from shotc.solvers.spline_relax import relax


def waypoints(count_, seed=0, step=10.0):
    p = np.random.default_rng(seed).normal(size=(count_, 3)).cumsum(axis=0) * step
    s = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(p, axis=0), axis=1))])
    return p, s


def least_jerk(p, s, pieces=3, half_spaces=(), cones=()):
    breaks = subdivide(s, pieces)
    scale = s[-1] / (len(s) - 1)
    jerk = energy_rows(breaks, 3)
    goal = Goal(SplineFunctionals(jerk.piece, jerk.weight * scale**2.5), np.zeros((len(jerk.piece), 3)))
    fixed = Equalities(value_rows(breaks, s), p)
    return breaks, SplineProblem(count(breaks), (goal,), fixed, tuple(half_spaces), tuple(cones))


def energy(problem, coef):
    return sum(float(((g.rows.apply(coef) - g.value) ** 2).sum()) for g in problem.goals)


def floor_on(breaks, normal, offset, owner=0):
    rows = control_rows(breaks)
    size = len(rows.piece)
    return HalfSpaceRows(rows, np.tile(normal, (size, 1)), np.full(size, offset), np.full(size, owner))


@pytest.mark.parametrize("pieces", [1, 2, 3])
@pytest.mark.parametrize("count_", [6, 20])
def test_free_it_is_the_natural_quintic_spline(count_, pieces):
    p, s = waypoints(count_)
    breaks, problem = least_jerk(p, s, pieces)
    found = minimise(problem)
    natural = [(3, np.zeros(3)), (4, np.zeros(3))]
    truth = make_interp_spline(s, p, k=5, bc_type=(natural, natural))
    at = np.linspace(0, s[-1], 300)
    assert found.status is Status.SOLVED
    assert np.abs(spline(breaks, found.coef)(at) - truth(at)).max() < 1e-7


def test_three_points_make_a_parabola_without_energy():
    s = np.array([0.0, 4.0, 10.0])
    p = np.column_stack([s, 0.1 * s**2, 5 - s])
    breaks, problem = least_jerk(p, s)
    found = minimise(problem)
    at = np.linspace(0, 10, 50)
    assert spline(breaks, found.coef)(at) == pytest.approx(
        np.column_stack([at, 0.1 * at**2, 5 - at]), abs=1e-6
    )
    assert found.objective == pytest.approx(0.0, abs=1e-6)


def test_stationarity_on_the_waypoints_null_space():
    p, s = waypoints(8, seed=4)
    _, problem = least_jerk(p, s)
    coef = minimise(problem).coef
    jerk = scalar_map(problem.goals[0].rows, problem.size).toarray()
    fixed = scalar_map(problem.equalities.rows, problem.size).toarray()
    gradient = jerk.T @ (jerk @ coef)
    multipliers = np.linalg.lstsq(fixed.T, gradient, rcond=None)[0]
    residual = gradient - fixed.T @ multipliers
    assert np.abs(residual).max() <= 1e-6 * np.abs(jerk.T @ jerk).max()


def test_bounds_that_do_not_bite_need_no_programme(monkeypatch):
    p, s = waypoints(8, seed=4)
    breaks, loose = least_jerk(p, s)
    low = float(control_rows(breaks).apply(minimise(loose).coef)[:, 2].min())
    rows = control_rows(breaks, 1)
    fast = np.linalg.norm(rows.apply(minimise(loose).coef), axis=1).max()

    def bounded(speed, floor):
        size = len(rows.piece)
        zero, owner = np.zeros((size, 3)), np.zeros(size, dtype=int)
        cone = Cones(rows, (0, 1, 2), zero, np.full(size, speed), np.ones(size), owner)
        return least_jerk(p, s, half_spaces=[floor_on(breaks, (0.0, 0.0, 1.0), floor)], cones=[cone])[1]

    wide, slow, high = (
        bounded(1.01 * fast, low - 0.1),
        bounded(0.95 * fast, low - 0.1),
        bounded(fast, low + 0.1),
    )
    programme, asked = spline_qp.programme, []
    monkeypatch.setattr(spline_qp, "programme", lambda q, *given: asked.append(q) or programme(q, *given))
    found, reference = minimise(wide), programme(wide, squares_of(wide))
    assert not asked
    assert found.objective == pytest.approx(reference.objective, rel=1e-7)
    assert found.excess == 0.0
    centre = wide.equalities.value.mean(axis=0)
    middle = centred(wide, centre)
    assert np.abs(found.coef - centre - programme(middle, squares_of(middle)).coef).max() < 1e-5
    for tight in (slow, high):
        asked.clear()
        minimise(tight)
        assert len(asked) == 1


def test_a_problem_with_other_bounds_is_solved_alike_from_what_is_known(monkeypatch):
    p, s = waypoints(7, seed=2)
    p[:, 2] = [10, 12, 10, 10, 12, 10, 10]
    breaks, loose = least_jerk(p, s)
    lowest = spline(breaks, minimise(loose).coef).ctrl[:, :, 2].min()
    known = least_of(loose)
    half_spaces = (floor_on(breaks, (0.0, 0.0, 1.0), 0.5 * (lowest + 10)),)
    held = replace(loose, half_spaces=half_spaces)
    alone = minimise(held)
    assert np.abs(minimise(held, least=known).coef - alone.coef).max() < 1e-9
    solved, calls = cone_rows._solved, []
    monkeypatch.setattr(cone_rows, "_solved", lambda *given: calls.append(0) or solved(*given))
    found = minimise(held, least=known, near=alone.coef)
    assert len(calls) == 1  # what binds is known, so nothing is asked twice
    assert np.abs(found.coef - alone.coef).max() < 1e-5
    far = minimise(held, near=alone.coef + 100.0)
    assert np.abs(far.coef - alone.coef).max() < 1e-5


def test_floors_hold_and_cost_what_they_must():
    p, s = waypoints(7, seed=2)
    p[:, 2] = [10, 12, 10, 10, 12, 10, 10]
    breaks, loose = least_jerk(p, s)
    free = minimise(loose)
    lowest = spline(breaks, free.coef).ctrl[:, :, 2].min()
    floor = 0.5 * (lowest + 10)
    _, tight = least_jerk(p, s, half_spaces=[floor_on(breaks, np.array([0.0, 0.0, 1.0]), floor)])
    found = minimise(tight)
    assert found.status is Status.SOLVED
    assert spline(breaks, found.coef).ctrl[:, :, 2].min() >= floor - 1e-6
    assert np.abs(tight.equalities.rows.apply(found.coef) - p).max() < 1e-6
    assert found.objective > free.objective + 1e-9
    # No feasible curve between the two is cheaper: the optimum is optimal along the segment.
    for x in (0.01, 0.1):
        mixed = (1 - x) * found.coef + x * free.coef
        below = spline(breaks, mixed).ctrl[:, :, 2].min() < floor - 1e-9
        assert below or energy(tight, mixed) >= found.objective - 1e-6


def test_hard_cones_bound_the_norm():
    p, s = waypoints(6, seed=5)
    p[:, :2] *= 0.2
    breaks = subdivide(s, 3)
    rows = control_rows(breaks)
    bound = np.full(len(rows.piece), 1.05 * np.linalg.norm(p[:, :2], axis=1).max())
    disc = Cones(rows, (0, 1), np.zeros((len(bound), 2)), bound, None, np.zeros(len(bound), dtype=np.intp))
    _, problem = least_jerk(p, s, cones=[disc])
    found = minimise(problem)
    assert found.status is Status.SOLVED
    assert np.linalg.norm(rows.apply(found.coef)[:, :2], axis=1).max() <= bound[0] + 1e-6


def test_priced_cones_bend_the_path_towards_the_limit_and_never_stop_it():
    p, s = waypoints(6, seed=7)
    breaks = subdivide(s, 3)
    rows = control_rows(breaks, 2)
    size = len(rows.piece)

    def bent(bound):
        price = np.full(size, 1e4)
        cone = Cones(
            rows, (0, 1, 2), np.zeros((size, 3)), np.full(size, bound), price, np.zeros(size, dtype=np.intp)
        )
        found = minimise(least_jerk(p, s, cones=[cone])[1])
        assert found.status is Status.SOLVED
        return np.linalg.norm(rows.apply(found.coef), axis=1), found

    sharp, loose = bent(1e3)
    bound = 0.6 * sharp.max()
    soft, tight = bent(bound)
    assert loose.excess == pytest.approx(0.0, abs=1e-4)
    assert tight.excess == pytest.approx(1e4 * np.maximum(soft - bound, 0).sum(), rel=1e-3, abs=1e-3)
    assert np.maximum(soft - bound, 0).sum() < 0.8 * np.maximum(sharp - bound, 0).sum()
    assert tight.objective >= loose.objective - 1e-6
    assert bent(1e-3)[1].coef is not None


def modelled(problem):
    """The least cost of a problem, modelled in cvxpy: goals, and the price of what leaves its bounds."""
    x = cp.Variable((problem.size, 3))
    rows = [scalar_map(problem.equalities.rows, problem.size) @ x == problem.equalities.value]
    for f in problem.half_spaces:
        along = cp.sum(cp.multiply(scalar_map(f.rows, problem.size) @ x, f.normal), axis=1)
        rows += [along >= f.offset]
    cost = 0.0
    for g in problem.goals:
        off = scalar_map(g.rows, problem.size) @ x - g.value
        cost += cp.sum_squares(off[:, list(g.axes)])
    for c in problem.cones:
        length = cp.norm((scalar_map(c.rows, problem.size) @ x)[:, list(c.axes)] - c.centre, axis=1)
        if c.price is None:
            rows.append(length <= c.bound)
        else:
            cost += c.price @ cp.pos(length - c.bound)
    programme = cp.Problem(cp.Minimize(cost), rows)
    programme.solve(solver=cp.CLARABEL, tol_feas=1e-9, tol_gap_rel=1e-9, tol_gap_abs=1e-9)
    return programme.value, x.value


@pytest.mark.parametrize("seed", range(4))
def test_the_optimum_is_the_one_that_a_modelling_layer_finds(seed):
    """Half-spaces, hard and priced norms of one, two and three components, and goals of some components."""
    p, s = waypoints(6, seed=seed)
    breaks, free = least_jerk(p, s)
    course = spline(breaks, minimise(free).coef)
    owner = {"owner": np.zeros(6 * len(course.ctrl), dtype=np.intp)}
    values = control_rows(breaks)
    size, middle = len(values.piece), p.mean(axis=0)
    reach = np.linalg.norm(course.ctrl[:, :, :2] - middle[:2], axis=2).max()
    inside = max(0.97 * reach, 1.001 * np.linalg.norm(p[:, :2] - middle[:2], axis=1).max())
    ceiling = 0.5 * (course.ctrl[:, :, 2].max() + p[:, 2].max())
    bent, fast = control_rows(breaks, 2), control_rows(breaks, 1)
    most = np.linalg.norm(bent.apply(minimise(free).coef), axis=1).max()
    steep = np.abs(fast.apply(minimise(free).coef)[:, 2]).max()

    def cone(rows, axes, centre, bound, price):
        count = len(rows.piece)
        cost = None if price is None else np.full(count, price)
        zero = np.zeros(count, dtype=np.intp)
        return Cones(rows, axes, np.tile(centre, (count, 1)), np.full(count, bound), cost, zero)

    cones = (
        cone(values, (0, 1), middle[:2], inside, None),
        cone(bent, (0, 1, 2), np.zeros(3), 0.8 * most, 1e3),
        cone(fast, (2,), np.full(1, 0.1), 0.9 * steep, 1e2),
    )
    pull = Goal(value_rows(breaks, s[1:3]), p[1:3] + 1.0, (0, 2))
    down = HalfSpaceRows(values, np.tile([0.0, 0.0, -1.0], (size, 1)), np.full(size, -ceiling), **owner)
    problem = replace(free, goals=(*free.goals, pull), half_spaces=(down,), cones=cones)
    found, (cost, coef) = minimise(problem), modelled(problem)
    assert found.status is Status.SOLVED
    assert found.objective + found.excess == pytest.approx(cost, rel=1e-6, abs=1e-6)
    assert found.excess > 1e-3
    assert np.abs(spline(breaks, found.coef).ctrl - spline(breaks, coef).ctrl).max() < 1e-3


def test_the_least_give_way_is_the_distance_that_is_missing():
    """Two points under a ceiling that is 1.5 m too low: the ceiling gives 1.5 m, or both points move."""
    p, s = waypoints(2)
    p[:, 2] = 4.0
    breaks, problem = least_jerk(
        p, s, half_spaces=[floor_on(subdivide(s, 3), np.array([0.0, 0.0, -1.0]), -2.5, 1)]
    )
    assert minimise(problem).status is Status.INFEASIBLE
    found = relax(problem, 3)
    assert found.status in {Status.SOLVED, Status.INACCURATE}
    assert found.owner_lack == pytest.approx([0.0, 1.5, 0.0], abs=1e-3)
    assert found.point_shift == pytest.approx([0.0, 0.0], abs=1e-3)
    assert spline(breaks, found.coef).ctrl[:, :, 2].max() <= 4.0 + 1e-3


def test_one_point_moves_where_that_is_less_than_a_wall():
    """One of three points is 1 m beyond one wall and 1 m beyond another: moving it is the smallest change."""
    s = np.array([0.0, 10.0, 20.0])
    p = np.array([[0.0, 0, 0], [10.0, 1, 1], [20.0, 0, 0]])
    breaks = subdivide(s, 4)
    half_spaces = [
        floor_on(breaks, np.array([0.0, -1.0, 0.0]), 0.0, 0),
        floor_on(breaks, np.array([0.0, 0.0, -1.0]), 0.0, 1),
    ]
    found = relax(least_jerk(p, s, 4, half_spaces=half_spaces)[1], 2)
    total = found.owner_lack.sum() + found.point_shift.sum()
    assert total == pytest.approx(np.sqrt(2), abs=5e-3)  # less than the 2 m of both walls
    assert found.point_shift[1] == pytest.approx(np.sqrt(2), abs=5e-3)


def test_a_fit_without_bounds_is_the_exact_quadratic_optimum():
    breaks = np.linspace(0, 10, 9)
    at = np.linspace(0.1, 9.9, 60)
    value = np.sin(at)
    task = Fit(breaks, at, value, np.ones(60), np.array([0.0, 10.0]), np.array([0.2, -0.5]), (1e-6, 1e-8))
    status, coef = fit(task)
    assert status is Status.SOLVED
    assert value_rows(breaks, task.anchor_at).apply(coef[:, None])[:, 0] == pytest.approx(task.anchor)
    rng = np.random.default_rng(0)
    fixed = scalar_map(value_rows(breaks, task.anchor_at), len(coef)).toarray()
    _, _, basis = np.linalg.svd(fixed)

    def cost(c):
        miss = value_rows(breaks, at).apply(c[:, None])[:, 0] - value
        rate = energy_rows(breaks, 1).apply(c[:, None])
        third = energy_rows(breaks, 3).apply(c[:, None])
        return (miss**2).sum() + 1e-6 * (rate**2).sum() + 1e-8 * (third**2).sum()

    for _ in range(20):
        step = basis[2:].T @ rng.normal(size=len(coef) - 2) * 1e-3
        assert cost(coef + step) >= cost(coef) - 1e-12


@pytest.mark.parametrize("bounded", [False, True])
def test_slopes_that_bind_are_met(bounded):
    breaks, at = np.linspace(0, 10, 9), np.linspace(0.1, 9.9, 60)
    edge = np.full((8, 6), 0.9 if bounded else 10.0)
    anchors, slopes = np.array([0.0, 4.0, 10.0]), np.array([4.0, 7.0])
    task = Fit(breaks, at, np.sin(at), np.ones(60), anchors, 0 * anchors, (1e-6, 1e-8), -edge, edge)
    status, coef = fit(replace(task, slope_at=slopes, slope=np.array([0.3, -0.1])))
    assert status is Status.SOLVED
    assert value_rows(breaks, anchors).apply(coef[:, None])[:, 0] == pytest.approx(0 * anchors, abs=1e-6)
    assert value_rows(breaks, slopes, 1).apply(coef[:, None])[:, 0] == pytest.approx([0.3, -0.1], abs=1e-6)
    assert np.abs(control_rows(breaks).apply(coef[:, None])).max() <= edge.max() + 1e-6


@pytest.mark.parametrize("sloped", [False, True])
def test_a_fit_between_bounds_is_the_one_that_a_modelling_layer_finds(sloped):
    breaks, at = np.linspace(0, 10, 9), np.linspace(0.1, 9.9, 60)
    low, high = np.full((8, 6), -0.7), np.full((8, 6), 0.9)
    high[:2] = np.inf
    anchors = np.array([0.0, 4.0])
    task = Fit(breaks, at, np.sin(at), np.ones(60), anchors, 0 * anchors, (1e-4, 1e-5), low, high)
    if sloped:
        task = replace(task, slope_at=np.array([4.0]), slope=np.array([-0.2]))
    x = cp.Variable(count(breaks))

    def of(rows):
        return scalar_map(rows, count(breaks)) @ x

    points, upper = of(control_rows(breaks)), np.flatnonzero(np.isfinite(high.ravel()))
    rows = [of(value_rows(breaks, anchors)) == 0.0, points >= -0.7, points[upper] <= 0.9]
    rows += [of(value_rows(breaks, np.array([4.0]), 1)) == -0.2] if sloped else []
    stiff = 1e-4 * cp.sum_squares(of(energy_rows(breaks, 1))) + 1e-5 * cp.sum_squares(
        of(energy_rows(breaks, 3))
    )
    cost = cp.sum_squares(of(value_rows(breaks, at)) - np.sin(at)) + stiff
    cp.Problem(cp.Minimize(cost), rows).solve(solver=cp.CLARABEL, tol_gap_rel=1e-10, tol_gap_abs=1e-10)
    status, coef = fit(task)
    assert status is Status.SOLVED
    assert np.abs(coef - x.value).max() < 1e-4


def test_bounds_hold_on_every_control_point():
    breaks = np.linspace(0, 10, 11)
    at = np.linspace(0, 10, 80)
    low, high = np.full((10, 6), -0.4), np.full((10, 6), 0.6)
    task = Fit(breaks, at, np.sin(at), np.ones(80), np.array([0.0]), np.array([0.0]), (1e-9, 1e-9), low, high)
    status, coef = fit(task)
    assert status is Status.SOLVED
    ctrl = spline(breaks, coef[:, None]).ctrl[:, :, 0]
    assert ctrl.min() >= -0.4 - 1e-7
    assert ctrl.max() <= 0.6 + 1e-7
    inside = np.abs(np.sin(at)) < 0.2
    miss = value_rows(breaks, at).apply(coef[:, None])[:, 0] - np.sin(at)
    assert np.abs(miss[inside]).max() < 0.1


@pytest.mark.parametrize(("wanted", "got"), [(10.0, 3.0), (-10.0, 1.0), (2.5, 2.5)])
def test_a_bound_of_one_component_is_about_its_centre(wanted, got):
    """As near to what is wanted as |y - 2| <= 1 lets it be; x and z are free."""
    breaks = np.array([0.0, 1.0, 2.0])
    rows = control_rows(breaks)
    size = len(rows.piece)
    band = Cones(rows, (1,), np.full((size, 1), 2.0), np.ones(size), None, np.zeros(size, dtype=int))
    goal = Goal(rows, np.tile([5.0, wanted, -5.0], (size, 1)))
    fixed = Equalities(value_rows(breaks, np.array([1.0])), np.array([[5.0, got, -5.0]]))
    free = SplineProblem(count(breaks), (goal,), fixed, (), (band,))
    for about in (np.zeros(3), np.array([7.0, -4.0, 1.0])):
        found = minimise(centred(free, about))
        assert found.status is Status.SOLVED
        places = spline(breaks, found.coef)(np.linspace(0.0, 2.0, 9)) + about
        assert places == pytest.approx(np.tile([5.0, got, -5.0], (9, 1)), abs=1e-5)
