from itertools import product
from math import pi

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from shotc.geom.pieces import Pieces
from shotc.geom.proof import sup_norm
from shotc.solvers.conic import Status
from shotc.solvers.headings import DEFAULT, METHODS
from shotc.solvers.headings.bounded_cubic import bounded_cubic
from shotc.solvers.headings.energy import cubic, energy
from shotc.solvers.headings.solve import SOLVERS, solve_headings
from shotc.solvers.headings.task import HeadingTask, nearest_turns
from tests.support.heading_measures import distance, effort

YAWS = st.lists(st.floats(-pi, pi), min_size=2, max_size=7)
RATE, ACCELERATION = 1.5, 2.0


def task(yaw, *, each=4.0, **changes) -> HeadingTask:
    """Keyframes at even times, with time enough for the shorter ways."""
    at = each * np.arange(len(yaw))
    return HeadingTask(at, np.array(yaw), **{"rate": RATE, "acceleration": ACCELERATION, **changes})


def within(curve, rate: float = RATE, acceleration: float = ACCELERATION) -> bool:
    """Whether both limits are proved over continuous time."""
    pieces = Pieces(curve.breaks[:-1], curve.breaks[1:], curve.ctrl)
    bounds = []
    for _ in range(2):
        pieces = pieces.derivative()
        bounds.append(sup_norm(pieces, lambda _: 1e-7).proven)
    return bounds[0] <= rate + 1e-6 and bounds[1] <= acceleration + 1e-6


def turned_apart(a, b) -> float:
    return float(np.abs((np.asarray(a) - np.asarray(b) + pi) % (2 * pi) - pi).max())


def test_every_method_has_a_solver_and_the_default_is_one() -> None:
    assert set(SOLVERS) == set(METHODS)
    assert DEFAULT in METHODS


@pytest.mark.slow
@pytest.mark.parametrize("method", METHODS)
@settings(max_examples=25, deadline=None)
@given(yaw=YAWS)
def test_solutions_meet_keyframes_and_limits_at_every_instant(method: str, yaw: list[float]) -> None:
    problem = task(yaw)
    found = solve_headings(problem, method)
    if found.curve is None:
        assert found.status is not Status.SOLVED
        assert method in {"bounded", "virtual"}
        return
    assert found.status is Status.SOLVED
    np.testing.assert_allclose(found.curve(problem.at)[:, 0], found.angles, atol=1e-12)
    assert turned_apart(found.angles, yaw) < 1e-9
    assert within(found.curve)
    rates = found.curve.derivative()(problem.at[[0, -1]])[:, 0]
    np.testing.assert_allclose(rates, 0.0, atol=1e-6)


@pytest.mark.slow
@pytest.mark.parametrize("method", METHODS)
@settings(max_examples=25, deadline=None)
@given(yaw=YAWS)
def test_solutions_are_smooth(method: str, yaw: list[float]) -> None:
    found = solve_headings(task(yaw), method)
    assume(found.curve is not None)
    rate = found.curve.derivative()
    np.testing.assert_allclose(found.curve.ctrl[1:, 0], found.curve.ctrl[:-1, -1], atol=1e-12)
    np.testing.assert_allclose(rate.ctrl[1:, 0], rate.ctrl[:-1, -1], atol=1e-6)


@pytest.mark.slow
@pytest.mark.parametrize("method", ["winding", "nearest", "virtual"])
@settings(max_examples=25, deadline=None)
@given(yaw=YAWS, by=st.floats(-20.0, 20.0))
def test_turning_the_keyframes_turns_the_result(method: str, yaw: list[float], by: float) -> None:
    step = np.diff(yaw)
    assume(all(abs(abs((d + pi) % (2 * pi) - pi) - pi) > 1e-3 for d in step))
    one, other = (solve_headings(task(np.array(yaw) + b), method) for b in (0.0, by))
    assert one.status == other.status
    assume(one.curve is not None)
    # Two choices may cost the same, and rounding decides; their cost does not.
    assert effort(one.curve) == pytest.approx(effort(other.curve), rel=1e-2, abs=1e-6)
    if method != "winding":
        np.testing.assert_allclose(np.diff(one.angles), np.diff(other.angles), atol=1e-9)


@pytest.mark.long
@settings(max_examples=30, deadline=None)
@given(yaw=st.lists(st.floats(-pi, pi), min_size=3, max_size=4), each=st.floats(3.8, 9.0))
def test_winding_is_the_cheapest_of_all_windings(yaw: list[float], each: float) -> None:
    problem = task(yaw, each=each)
    found = solve_headings(problem, "winding")
    assert found.complete
    cost = energy(problem.at, problem.weight, problem.rates)

    def spent(curve) -> float:
        return cost.of(curve(problem.at)[:, 0], curve.derivative()(problem.at)[:, 0])

    shorter = np.concatenate([[0.0], np.cumsum(nearest_turns(problem.yaw))]) + yaw[0]
    best = np.inf
    for extra in product((-2, -1, 0, 1, 2), repeat=len(yaw) - 1):
        curve = bounded_cubic(problem, cost, shorter + 2 * pi * np.cumsum([0, *extra]))
        best = best if curve is None else min(best, spent(curve))
    assert spent(found.curve) == pytest.approx(best, rel=1e-6, abs=1e-9)


def test_two_keyframes_give_the_cubic_from_rest_to_rest() -> None:
    found = solve_headings(task([0.0, 1.0], each=3.0, weight=0.0), "winding")
    x = np.linspace(0.0, 1.0, 21)
    np.testing.assert_allclose(found.curve(3.0 * x)[:, 0], 3 * x**2 - 2 * x**3, atol=1e-12)
    assert effort(found.curve) == pytest.approx(12.0 / 27.0)
    assert distance(found.curve) == pytest.approx(1.0)


def test_without_limits_the_curve_is_the_clamped_spline() -> None:
    from scipy.interpolate import CubicSpline

    at, yaw = np.array([0.0, 1.0, 2.5, 3.0, 5.0]), np.array([0.0, 0.8, -0.4, 0.3, 0.1])
    found = solve_headings(HeadingTask(at, yaw, rates=(0.2, -0.1)), "nearest")
    wanted = CubicSpline(at, yaw, bc_type=((1, 0.2), (1, -0.1)))
    t = np.linspace(0.0, 5.0, 101)
    np.testing.assert_allclose(found.curve(t)[:, 0], wanted(t), atol=1e-12)


def test_a_limit_that_binds_is_met_by_the_best_curve() -> None:
    skew = task([0.0, 2.0, 2.2], each=3.0, acceleration=0.9, rate=np.inf)
    cost = energy(skew.at, 0.0, skew.rates)
    free = cost.slopes(skew.yaw)
    assert free[1] == pytest.approx(0.55)
    assert not within(cubic(skew.at, skew.yaw, free), rate=9.0, acceleration=0.9)
    curve = bounded_cubic(skew, cost, skew.yaw)
    assert curve is not None
    assert within(curve, rate=9.0, acceleration=0.9)
    # The acceleration begins with 6 * 2 / 9 - 2 v / 3 and the energy is convex in the slope v: it binds.
    assert curve.derivative()(3.0)[0] == pytest.approx(0.65, abs=1e-5)


@pytest.mark.long
def test_a_limit_on_the_rate_that_binds_is_met_by_the_best_curve() -> None:
    problem = task([0.0, 3.0], each=3.0, acceleration=np.inf, rate=1.45)
    cost = energy(problem.at, 0.0, problem.rates)
    assert bounded_cubic(problem, cost, problem.yaw) is None  # from rest to rest it takes 1.5 rad/s
    for limit in (1.37, 1.45):
        problem = task([0.0, 3.0, 6.0], each=3.0, acceleration=np.inf, rate=limit)
        cost = energy(problem.at, 0.0, problem.rates)
        curve = bounded_cubic(problem, cost, problem.yaw)
        assert curve is not None
        assert within(curve, rate=limit, acceleration=9.0)
        slopes = np.linspace(0.0, limit, 2001)
        fits = [
            v for v in slopes if within(cubic(problem.at, problem.yaw, np.array([0.0, v, 0.0])), limit, 9.0)
        ]
        least = min(cost.of(problem.yaw, np.array([0.0, v, 0.0])) for v in fits)
        assert effort(curve) == pytest.approx(least, rel=0.03)


def test_too_little_time_is_told() -> None:
    for method in METHODS:
        found = solve_headings(task([0.0, 2.0, 0.0], each=0.5), method)
        assert found.status is Status.INFEASIBLE
        assert found.curve is None


@pytest.mark.parametrize("method", METHODS)
def test_one_keyframe_has_no_curve(method: str) -> None:
    found = solve_headings(HeadingTask(np.array([3.0]), np.array([1.0])), method)
    assert found.status is Status.SOLVED
    assert found.curve is None
    assert found.angles.tolist() == [1.0]


@pytest.mark.parametrize("method", METHODS)
def test_equal_yaws_do_not_turn(method: str) -> None:
    found = solve_headings(task([2.0, 2.0, 2.0, 2.0]), method)
    assert distance(found.curve) == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize("base", [0.0, 0.1, 1.0, pi / 2, -pi / 2, -3.0])
def test_half_a_turn_goes_counter_clockwise_whatever_the_rounding(base: float) -> None:
    assert nearest_turns(np.array([base, base + pi]))[0] == pytest.approx(pi)
    assert nearest_turns(np.array([base + pi, base]))[0] == pytest.approx(pi)
    for method in ("winding", "nearest"):
        found = solve_headings(task([base, base + pi, base], each=6.0), method)
        assert found.status is Status.SOLVED


def test_half_a_turn_is_no_collapse_of_the_virtual_curve() -> None:
    found = solve_headings(task([0.0, pi, 0.3], each=9.0), "virtual")
    assert found.status is Status.SOLVED
    assert within(found.curve)


@pytest.mark.parametrize("method", METHODS)
def test_stated_turns_bind(method: str) -> None:
    stated = (4 * pi + 0.5, None, -2 * pi)
    found = solve_headings(task([0.0, 0.5, 1.0, 1.0], each=16.0, stated=stated), method)
    turns = np.diff(found.angles)
    assert turns[[0, 2]] == pytest.approx([4 * pi + 0.5, -2 * pi])
    assert turned_apart(found.angles, [0.0, 0.5, 1.0, 1.0]) < 1e-9
    if found.curve is not None:
        np.testing.assert_allclose(found.curve(16.0 * np.arange(4))[:, 0], found.angles, atol=1e-9)


def test_winding_turns_on_where_nearest_swings_back() -> None:
    yaw = np.array([0.0, 2.0, 4.0 + 1.3, 8.5]) % (2 * pi)
    winding, nearest = (solve_headings(task(yaw, each=5.0), m) for m in ("winding", "nearest"))
    assert effort(winding.curve) < effort(nearest.curve)
    assert (np.diff(winding.angles) > 0).all()


def test_more_time_never_costs_winding_more_than_nearest() -> None:
    random = np.random.default_rng(3)
    for _ in range(20):
        problem = task(random.uniform(-pi, pi, 8))
        cost = energy(problem.at, problem.weight, problem.rates)
        spent = []
        for method in ("winding", "nearest"):
            curve = solve_headings(problem, method).curve
            spent.append(cost.of(curve(problem.at)[:, 0], curve.derivative()(problem.at)[:, 0]))
        assert spent[0] <= spent[1] * (1 + 1e-9)


@pytest.mark.parametrize(
    ("at", "yaw", "changes"),
    [
        ([0.0, 1.0, 1.0], [0.0, 0.0, 0.0], {}),
        ([0.0, 2.0, 1.0], [0.0, 0.0, 0.0], {}),
        ([0.0, 1.0], [0.0], {}),
        ([], [], {}),
        ([0.0, 1.0], [0.0, np.nan], {}),
        ([0.0, 1.0], [0.0, 1.0], {"rate": 0.0}),
        ([0.0, 1.0], [0.0, 1.0], {"weight": -1.0}),
        ([0.0, 1.0], [0.0, 1.0], {"stated": (0.5,)}),
        ([0.0, 1.0], [0.0, 1.0], {"stated": (1.0, 1.0)}),
    ],
)
def test_bad_tasks_are_refused(at, yaw, changes) -> None:
    with pytest.raises(ValueError, match=r"."):
        HeadingTask(np.array(at), np.array(yaw), **changes)


@pytest.mark.parametrize("count", [2, 3, 5])
def test_the_least_energy_through_values_is_that_of_its_slopes(count: int) -> None:
    rng = np.random.default_rng(count)
    at = np.cumsum(rng.uniform(0.5, 2.0, count))
    cost = energy(at, 0.3, (0.4, -0.7))
    matrix, linear, constant = cost.reduced()
    for value in rng.normal(size=(3, count)):
        slope = cost.slopes(value)
        assert (slope[0], slope[-1]) == (0.4, -0.7)
        least = cost.of(value, slope)
        assert value @ matrix @ value + 2.0 * linear @ value + constant == pytest.approx(least)
        for k in range(1, count - 1):
            assert cost.of(value, slope + 0.01 * np.eye(count)[k]) > least
            assert cost.of(value, slope - 0.01 * np.eye(count)[k]) > least


def test_the_energy_of_a_straight_line_is_that_of_its_slope_alone() -> None:
    at = np.array([0.0, 1.0, 3.0])
    assert energy(at, 2.0, (0.5, 0.5)).of(0.5 * at, np.full(3, 0.5)) == pytest.approx(2.0 * 0.25 * 3.0)


def test_of_two_ways_that_cost_the_same_one_is_flown_and_nothing_is_left_open() -> None:
    """Half a turn goes as well to the left as to the right."""
    found = solve_headings(task([0.0, pi]), "winding")
    assert found.complete
    assert abs(found.angles[1]) == pytest.approx(pi)


def test_the_virtual_curve_begins_and_ends_with_the_asked_headings_to_the_last_bit() -> None:
    problem = task([-1.02, 1.73, -1.18, -0.28])
    found = solve_headings(problem, "virtual")
    assert found.curve is not None
    at_keyframes = found.curve.ctrl[0, 0], *(found.curve(t) for t in problem.at[1:])
    assert [float(one[0]) for one in at_keyframes] == found.angles.tolist()


@pytest.mark.parametrize("method", METHODS)
def test_only_a_method_that_compares_choices_says_that_none_is_cheaper(method: str) -> None:
    assert solve_headings(task([0.0, 1.0, 2.5]), method).complete is (method == "winding")
    assert solve_headings(task([0.4]), method).complete
