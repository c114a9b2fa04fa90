"""The splines of fleets and their pieces in Bernstein form, against each other and against differences."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from shotc.geom.bernstein import Array, Piecewise
from shotc.geom.fleet_pieces import FleetPieces, rates, velocity
from shotc.geom.fleet_spline import NEAR_S, centres, differences, pieces, places, rest_of

BREAKS = np.array([1.0, 1.5, 4.0, 4.8, 7.0])
COEF = np.random.default_rng(3).normal(size=(2, 7, 3)) * 5
TIMES = np.linspace(1.0, 7.0, 61)


def test_control_points_at_their_centres_of_an_even_flight_give_an_even_flight() -> None:
    even = (centres(BREAKS)[:, None] * [2.0, -1.0, 0.5] + [3.0, 0.0, 9.0])[None]
    assert places(BREAKS, even, TIMES)[0] == pytest.approx(
        TIMES[:, None] * [2.0, -1.0, 0.5] + [3.0, 0.0, 9.0]
    )
    assert places(BREAKS, even, TIMES, 1)[0] == pytest.approx(np.tile([2.0, -1.0, 0.5], (61, 1)))
    assert places(BREAKS, even, np.array([-9.0, 99.0])) == pytest.approx(
        places(BREAKS, even, BREAKS[[0, -1]])
    )


def test_three_equal_control_points_are_an_end_at_rest() -> None:
    coef = COEF.copy()
    coef[:, :3], coef[:, -3:] = coef[:, :1], coef[:, -1:]
    ends = BREAKS[[0, -1]]
    assert places(BREAKS, coef, ends) == pytest.approx(coef[:, [0, -1]])
    for order in (1, 2):
        assert places(BREAKS, coef, ends, order) == pytest.approx(np.zeros((2, 2, 3)), abs=1e-9)


def test_pieces_in_bernstein_form_are_the_same_flight() -> None:
    ctrl = pieces(BREAKS, COEF)
    for drone in range(2):
        assert Piecewise(BREAKS, ctrl[drone])(TIMES) == pytest.approx(places(BREAKS, COEF, TIMES)[drone])


@pytest.mark.parametrize("order", [1, 2, 3])
def test_control_points_of_a_derivative_hold_it_and_are_those_of_the_matrix(order: int) -> None:
    control = rates(BREAKS, COEF, order)
    assert control == pytest.approx(np.einsum("kp,npd->nkd", differences(BREAKS, order), COEF))
    derivative = places(BREAKS, COEF, TIMES, order)
    assert (derivative <= control.max(axis=1, keepdims=True) + 1e-9).all()
    assert (derivative >= control.min(axis=1, keepdims=True) - 1e-9).all()
    if order == 2:
        assert places(BREAKS, COEF, BREAKS, 2) == pytest.approx(control)


def of(flown: FleetPieces, drone: int, times: Array) -> Array:
    """Return the values at times within the pieces."""
    own = flown.of(drone)
    k = np.clip(np.searchsorted(own.low, times, side="right") - 1, 0, len(own.low) - 1)
    curves = [
        Piecewise(np.array([own.low[i], own.high[i]]), own.ctrl[i : i + 1]) for i in range(len(own.low))
    ]
    return np.array([curves[i](t) for i, t in zip(k, times, strict=True)])


def test_the_velocity_in_bernstein_form_is_the_derivative() -> None:
    found = velocity(BREAKS, COEF)
    for drone in range(2):
        assert of(found, drone, TIMES) == pytest.approx(places(BREAKS, COEF, TIMES, 1)[drone])
    bag = found.bag()
    assert bag.low.tolist() == [*BREAKS[:-1]] * 2
    assert bag.high.tolist() == [*BREAKS[1:]] * 2
    assert bag.ctrl[4:] == pytest.approx(found.ctrl[1])


@pytest.mark.parametrize(
    ("spans", "cuts"),
    [
        ([(1.2, 4.5)], [(1.2, 1.5), (1.5, 4.0), (4.0, 4.5)]),
        ([(1.7, 2.6)], [(1.7, 2.6)]),  # within one piece
        ([(1.5, 4.0)], [(1.5, 4.0)]),  # from break to break
        ([(0.0, 1.3), (6.0, 9.0)], [(1.0, 1.3), (6.0, 7.0)]),  # beyond the ends there is nothing
        ([(3.0, 3.0), (2.0, 1.0), (8.0, 9.0)], []),
    ],
)
def test_pieces_between_times_are_the_same_flight(spans, cuts) -> None:
    found = velocity(BREAKS, COEF).between(spans)
    assert list(zip(found.low, found.high, strict=True)) == cuts
    for low, high in cuts:
        t = np.linspace(low, high, 7)[:-1]
        assert of(found, 1, t) == pytest.approx(places(BREAKS, COEF, t, 1)[1])


@pytest.mark.parametrize("time", [1.0, 1.2, 1.4999, 1.5, 2.0, 4.79, 5.0, 6.9])
def test_the_rest_of_a_flight_is_the_same_flight(time: float) -> None:
    left, coef = rest_of(BREAKS, COEF, time)
    at_break = [b for b in BREAKS if 0.0 <= b - time < NEAR_S]
    assert left[0] == (at_break[0] if at_break else time)
    assert left[1:].tolist() == [b for b in BREAKS if b > left[0]]
    times = np.linspace(left[0], 7.0, 40)
    for order in (0, 1, 2):
        assert places(left, coef, times, order) == pytest.approx(places(BREAKS, COEF, times, order), abs=1e-6)


def test_after_its_end_everybody_stands_for_a_second() -> None:
    for time in (7.0, 9.5):
        left, coef = rest_of(BREAKS, COEF, time)
        assert left.tolist() == [time, time + 1.0]
        there = np.linspace(time, time + 1.0, 5)
        assert places(left, coef, there) == pytest.approx(
            np.repeat(places(BREAKS, COEF, BREAKS[-1:]), 5, axis=1)
        )


def test_steps_between_breaks_may_be_of_any_length() -> None:
    # The derivative jumps nowhere, however uneven the breaks.
    breaks = np.cumsum([0.0, 0.1, 3.0, 0.2, 5.0])
    coef = np.random.default_rng(5).normal(size=(1, 7, 3))
    found = velocity(breaks, coef)
    for a, b in pairwise(range(4)):
        assert found.ctrl[0, a, -1] == pytest.approx(found.ctrl[0, b, 0])
