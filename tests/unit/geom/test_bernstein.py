"""Piecewise polynomials against numpy's, and what they refuse."""

from __future__ import annotations

import numpy as np
import pytest

from shotc.geom.bernstein import (
    Piecewise,
    bernstein_basis,
    concatenate,
    lift_off,
    quintic_hermite,
    split_half,
)

BREAKS = np.array([1.0, 1.5, 4.0])
CURVE = Piecewise(BREAKS, np.random.default_rng(1).normal(size=(2, 4, 2)))


def test_a_basis_sums_to_one_and_makes_powers() -> None:
    x = np.linspace(0.0, 1.0, 7)
    for degree in (0, 1, 3, 6):
        basis = bernstein_basis(degree, x)
        assert basis.sum(axis=-1) == pytest.approx(1.0)
        if degree:
            assert basis @ (np.arange(degree + 1) / degree) == pytest.approx(x)  # of linear precision


def test_a_curve_is_the_polynomial_of_each_piece_and_its_ends_beyond_them() -> None:
    for piece, (low, high) in enumerate(((1.0, 1.5), (1.5, 4.0))):
        t = np.linspace(low, high, 8)[1:-1]
        x = ((t - low) / (high - low))[:, None]
        a, b, c, d = CURVE.ctrl[piece]
        assert CURVE(t) == pytest.approx(
            a * (1 - x) ** 3 + 3 * b * x * (1 - x) ** 2 + 3 * c * x**2 * (1 - x) + d * x**3
        )
    assert CURVE(-9.0) == pytest.approx(CURVE.ctrl[0, 0])
    assert CURVE(9.0) == pytest.approx(CURVE.ctrl[-1, -1])
    assert CURVE(1.5) == pytest.approx(CURVE.ctrl[1, 0])
    assert (CURVE.start, CURVE.end, CURVE.degree) == (1.0, 4.0, 3)
    assert CURVE.channels(1)(2.0) == pytest.approx(CURVE(2.0)[1:])


@pytest.mark.parametrize("order", [1, 2, 3])
def test_a_derivative_is_the_limit_of_differences(order: int) -> None:
    before, after = CURVE.derivative(order - 1) if order > 1 else CURVE, CURVE.derivative(order)
    t = np.array([1.1, 1.4, 1.9, 3.7])
    assert after(t) == pytest.approx((before(t + 1e-6) - before(t - 1e-6)) / 2e-6, rel=1e-4, abs=1e-4)
    assert after.degree == 3 - order


def test_what_is_even_has_a_derivative_that_is_none() -> None:
    gone = CURVE.derivative(4)
    assert (gone.degree, np.abs(gone.ctrl).max()) == (0, 0.0)


def test_halves_are_the_same_polynomial() -> None:
    left, right = split_half(CURVE.ctrl)
    halves = Piecewise(
        np.array([1.0, 1.25, 1.5, 2.75, 4.0]), np.stack([left, right], axis=1).reshape(4, 4, 2)
    )
    t = np.linspace(1.0, 4.0, 31)
    assert halves(t) == pytest.approx(CURVE(t))


def test_a_hermite_quintic_has_the_values_and_derivatives_that_are_given() -> None:
    given = np.random.default_rng(2).normal(size=(3, 3, 2))
    curve = quintic_hermite(BREAKS, *given)
    for order in range(3):
        for side in (0.0, -1e-9):
            found = (curve.derivative(order) if order else curve)(BREAKS + side)
            assert found[1:] == pytest.approx(given[order, 1:], abs=1e-5)
    assert curve.derivative(2)(1.0) == pytest.approx(given[2, 0])


def test_a_curve_lifts_off_where_it_first_leaves_its_start() -> None:
    still = np.zeros((1, 4, 2))
    later = concatenate([Piecewise(np.array([0.0, 0.5, 1.0]), np.repeat(still, 2, axis=0)), CURVE])
    assert lift_off(later) == 1.0
    assert lift_off(CURVE) == 1.0
    back = Piecewise(np.array([0.0, 1.0, 2.0]), np.concatenate([CURVE.ctrl[:1] * 0 + 1.0, still]))
    assert lift_off(back) == 1.0
    assert lift_off(Piecewise(np.array([0.0, 3.0]), still)) == 3.0
    t = np.linspace(1.01, 4.0, 9)
    assert later(t) == pytest.approx(CURVE(t))
    assert later.breaks.tolist() == [0.0, 0.5, 1.0, 1.5, 4.0]


@pytest.mark.parametrize(
    ("breaks", "ctrl"),
    [
        (np.array([0.0, 1.0]), np.zeros((2, 4, 3))),
        (np.array([0.0, 1.0]), np.zeros((4, 3))),
        (np.array([0.0, 1.0]), np.zeros((1, 4))),
        (np.array([[0.0, 1.0]]), np.zeros((1, 4, 3))),
        (np.array([[0.0], [1.0]]), np.zeros((1, 4, 3))),
        (np.array([0.0]), np.zeros((0, 4, 3))),
        (np.array([0.0, np.nan]), np.zeros((1, 4, 3))),
        (np.array([0.0, 1.0]), np.full((1, 4, 3), np.inf)),
        (np.array([0.0, 0.0]), np.zeros((1, 4, 3))),
        (np.array([0.0, 2.0, 1.0]), np.zeros((2, 4, 3))),
    ],
)
def test_what_does_not_fit_is_refused(breaks: np.ndarray, ctrl: np.ndarray) -> None:
    with pytest.raises(ValueError, match="breaks"):
        Piecewise(breaks, ctrl)


def test_a_curve_is_not_written_to() -> None:
    for array in (CURVE.breaks, CURVE.ctrl):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 0.0


def test_lists_of_numbers_become_arrays_that_nobody_can_change() -> None:
    curve = Piecewise([0, 2], [[[1], [3]]])  # type: ignore[arg-type]
    assert curve(np.array([1.0])).tolist() == [[2.0]]
    for array in (curve.breaks, curve.ctrl):
        assert array.dtype == np.float64
        assert not array.flags.writeable
