"""Quintic B-splines as linear maps onto Bernstein points, against scipy and calculus."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.interpolate import BSpline

from shotc.geom.bernstein import Piecewise
from shotc.geom.bspline import (
    DEGREE,
    control_rows,
    count,
    energy_rows,
    extraction,
    greville,
    hull_rows,
    restrict,
    spline,
    subdivide,
    value_rows,
)

widths = st.lists(st.floats(0.05, 20.0), min_size=1, max_size=9)


def breaks_of(steps):
    return np.concatenate([[0.0], np.cumsum(steps)])


def sample(breaks, seed=0):
    coef = np.random.default_rng(seed).normal(size=(count(breaks), 3))
    knots = np.concatenate([[breaks[0]] * DEGREE, breaks, [breaks[-1]] * DEGREE])
    return coef, BSpline(knots, coef, DEGREE)


@pytest.mark.slow
@given(widths)
def test_it_is_the_b_spline(steps):
    breaks = breaks_of(steps)
    coef, truth = sample(breaks)
    s = np.linspace(0, breaks[-1], 60)
    assert spline(breaks, coef)(s) == pytest.approx(truth(s), abs=1e-10)
    assert value_rows(breaks, s).apply(coef) == pytest.approx(truth(s), abs=1e-10)


@pytest.mark.slow
@given(widths)
def test_derivatives_up_to_the_fourth_are_continuous(steps):
    breaks = breaks_of(steps)
    curve = spline(breaks, sample(breaks)[0])
    for order in range(5):
        ctrl = curve.derivative(order).ctrl
        jump = np.abs(ctrl[1:, 0] - ctrl[:-1, -1]).max(initial=0.0)
        assert jump <= 1e-12 * np.abs(curve.ctrl).max() / min(steps) ** order + 1e-12


@pytest.mark.parametrize("order", [1, 2, 3])
def test_rows_give_the_control_points_of_derivatives(order):
    breaks = breaks_of([1.0, 0.3, 2.0, 5.0])
    coef, _ = sample(breaks)
    rows = control_rows(breaks, order).apply(coef)
    derivative = spline(breaks, coef).derivative(order)
    assert rows == pytest.approx(derivative.ctrl.reshape(-1, 3))
    s = np.linspace(0, breaks[-1], 30)
    assert value_rows(breaks, s, order).apply(coef) == pytest.approx(derivative(s), rel=1e-9, abs=1e-9)


@pytest.mark.parametrize("order", range(5))
def test_what_two_pieces_share_is_in_the_hull_once(order):
    breaks = breaks_of([1.0, 0.3, 2.0, 5.0])
    coef, _ = sample(breaks)
    every, once = control_rows(breaks, order).apply(coef), hull_rows(breaks, order).apply(coef)
    assert len(once) == len(every) - 3
    assert all(np.abs(once - point).max(axis=1).min() < 1e-9 * np.abs(every).max() for point in every)


@pytest.mark.parametrize("order", [1, 2, 3])
def test_energy_is_the_integral_of_the_squared_derivative(order):
    breaks = breaks_of([1.0, 0.7, 2.0])
    coef, truth = sample(breaks)
    exact = 0.0
    nodes, weights = np.polynomial.legendre.leggauss(8)  # exact for polynomials of degree 15
    for a, b in pairwise(breaks):
        s = 0.5 * (a + b) + 0.5 * (b - a) * nodes
        exact += 0.5 * (b - a) * float(weights @ (truth.derivative(order)(s) ** 2).sum(axis=1))
    assert float((energy_rows(breaks, order).apply(coef) ** 2).sum()) == pytest.approx(exact)


@pytest.mark.slow
@given(widths)
def test_linear_functions_are_reproduced(steps):
    breaks = breaks_of(steps)
    curve = spline(breaks, (3.0 * greville(breaks) - 1.0)[:, None])
    s = np.linspace(0, breaks[-1], 30)
    assert curve(s)[:, 0] == pytest.approx(3.0 * s - 1.0, abs=1e-9 * (1 + breaks[-1]))


@pytest.mark.slow
@given(widths, st.integers(1, 5))
def test_finer_breaks_change_nothing(steps, parts):
    breaks = breaks_of(steps)
    curve = spline(breaks, sample(breaks)[0])
    finer = subdivide(breaks, parts)
    assert len(finer) == parts * len(steps) + 1
    assert set(breaks) <= set(finer)
    s = np.linspace(0, breaks[-1], 60)
    assert restrict(curve, finer)(s) == pytest.approx(curve(s), abs=1e-10)


def test_a_part_of_a_curve_can_be_cut_out():
    breaks = breaks_of([1.0, 2.0, 1.0])
    curve = spline(breaks, sample(breaks)[0])
    part = restrict(curve, np.array([1.5, 2.25, 3.0]))
    s = np.linspace(1.5, 3.0, 20)
    assert part(s) == pytest.approx(curve(s), abs=1e-12)


@pytest.mark.slow
@settings(max_examples=40)
@given(widths, st.integers(0, 1000))
def test_the_curve_stays_in_the_hull_of_its_points(steps, seed):
    breaks = breaks_of(steps)
    curve = spline(breaks, sample(breaks, seed)[0])
    directions = np.random.default_rng(seed).normal(size=(20, 3))
    for i in range(len(steps)):
        piece = Piecewise(breaks[i : i + 2], curve.ctrl[i : i + 1])
        s = np.linspace(breaks[i], breaks[i + 1], 25)
        assert (
            (piece(s) @ directions.T).max(axis=0) <= (curve.ctrl[i] @ directions.T).max(axis=0) + 1e-12
        ).all()


def test_what_all_rows_of_a_spline_share_cannot_be_changed() -> None:
    assert not extraction(np.array([0.0, 1.0, 3.0])).flags.writeable
