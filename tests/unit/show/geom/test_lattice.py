"""Lattices and layers: how near their points are, and how many a shape holds, against closed forms."""

from __future__ import annotations

from math import pi, sqrt

import numpy as np
import pytest
from scipy.spatial import cKDTree

from shotc.geom.bernstein import Array
from shotc.show.geom import lattice as module
from shotc.show.geom.depth_layers import layered, layers_of
from shotc.show.geom.lattice import Mould, laid, lattice, widest

DENSITY = {(2, False): 2 / sqrt(3), (2, True): 1.0, (3, False): sqrt(2), (3, True): 2 / sqrt(3)}


def nearest(points: Array, *, upright: bool) -> float:
    """The least distance of two points: of upright cylinders the larger of the level and the upright one."""
    away = np.abs(points[:, None] - points)
    level = np.linalg.norm(away[..., :-1], axis=2)
    size = np.maximum(level, away[..., -1]) if upright else np.linalg.norm(away, axis=2)
    np.fill_diagonal(size, np.inf)
    return float(size.min())


@pytest.mark.slow
@pytest.mark.parametrize(("dimensions", "upright"), list(DENSITY))
def test_a_lattice_is_apart_and_as_dense_as_any(dimensions: int, upright: bool) -> None:
    size = np.full(dimensions, 40.0 if dimensions == 2 else 20.0)
    points = lattice(np.zeros(dimensions), size, 0.9, upright)
    assert nearest(points[:1500], upright=upright) == pytest.approx(0.9)
    whole = (
        float(np.prod(size + 0.9)) / 0.9**dimensions
    )  # each point has a cell, half of it beyond the border
    assert len(points) == pytest.approx(DENSITY[dimensions, upright] * whole, rel=0.1)


@pytest.mark.slow
@pytest.mark.parametrize("upright", [False, True])
def test_as_many_places_are_in_a_ball_as_the_closed_form_says(upright: bool) -> None:
    rng = np.random.default_rng(0)
    ball = rng.normal(size=(40_000, 3))
    ball *= 8.0 * rng.random((40_000, 1)) ** (1 / 3) / np.linalg.norm(ball, axis=1)[:, None]
    mould = Mould(cKDTree(ball), 0.5, upright)
    held = len(laid(mould, 1.0))
    assert held == pytest.approx(DENSITY[3, upright] * 4 / 3 * pi * 8.3**3, rel=0.06)
    few = widest(mould, held // 2, 1.0)
    assert few is not None
    assert len(few) == held // 2
    assert nearest(few, upright=upright) == pytest.approx(2 ** (1 / 3), rel=0.03)
    assert widest(mould, held + 200, 1.0) is None


@pytest.mark.slow
@pytest.mark.parametrize("upright", [False, True])
@pytest.mark.parametrize("count", [2, 3, 4])
def test_layers_are_apart_in_space_and_denser_to_the_eye(count: int, upright: bool) -> None:
    rng = np.random.default_rng(1)
    mould = Mould(cKDTree(rng.random((40_000, 2)) * 14.0), 0.1, upright)
    layers = layers_of(count, upright)
    flat, layer = layered(mould, layers, 1.0)
    space = np.column_stack([flat[:, 0], layer * layers.depth, flat[:, 1]])
    assert nearest(space, upright=upright) >= 1.0 - 1e-9
    assert nearest(flat, upright=False) == pytest.approx(layers.seen)
    ball = {2: sqrt(0.5), 3: sqrt(1 / 3), 4: 0.5}[count]
    assert layers.seen == pytest.approx(
        ball if not upright else {2: sqrt(0.5), 3: sqrt(2) / 3, 4: 0.5}[count]
    )
    assert layers.depth == pytest.approx(1.0 if upright else sqrt(1.0 - ball**2))
    one = 1.0 if upright or count == 2 else 2 / sqrt(3)
    assert len(flat) == pytest.approx(count * one * 14.4**2, rel=0.08)


@pytest.mark.parametrize(("number", "step"), [(100, 10.0 / 9.0), (64, 10.0 / 7.0), (36, 10.0 / 5.0)])
def test_the_widest_lattice_that_holds_a_number_is_hardly_finer_than_squares_of_that_number(
    number: int, step: float
) -> None:
    side = np.linspace(0.0, 10.0, 101)
    square = np.column_stack([axis.ravel() for axis in np.meshgrid(side, side)])
    for least in (0.4, 0.9):
        found = widest(Mould(cKDTree(square), 0.06, True), number, least)
        assert found is not None
        assert len(found) == number
        assert 0.84 * step < nearest(found, upright=False) < 1.02 * step
    assert widest(Mould(cKDTree(square), 0.06, True), number, 1.05 * step) is None


def test_a_lattice_lies_in_its_box_about_its_first_corner() -> None:
    low, high = np.array([3.0, -1.0]), np.array([5.0, 2.5])
    points = lattice(low, high, 1.0, True)
    assert sorted(points.tolist()) == [[x, y] for x in (3.0, 4.0, 5.0) for y in (-1.0, 0.0, 1.0, 2.0)]
    hexagons = lattice(low, high, 1.0, False)
    rows = {round(float(y), 9): sorted(hexagons[hexagons[:, 1] == y, 0].tolist()) for y in hexagons[:, 1]}
    assert [*rows] == pytest.approx([-1.0 + k * sqrt(3.0) / 2.0 for k in range(5)])
    assert [*rows.values()] == [[3.0, 4.0, 5.0], [3.5, 4.5]] * 2 + [[3.0, 4.0, 5.0]]


@pytest.mark.parametrize("upright", [False, True])
def test_a_lattice_fills_its_mould_from_end_to_end(upright: bool) -> None:
    bar = np.column_stack([np.linspace(0.0, 12.0, 121), np.zeros((121, 2))])
    slack = 1.5
    found = laid(Mould(cKDTree(bar), slack, upright), 1.0)
    assert found[:, 0].min() < 1.0 - slack
    assert found[:, 0].max() > 12.0 + slack - 1.0
    assert found[:, 1].min() < 0.0 < found[:, 1].max()
    assert np.linalg.norm(found[:, None] - bar, axis=2).min(axis=1).max() <= slack


@pytest.mark.parametrize(("most", "empty"), [(63, True), (64, False)])
def test_a_lattice_of_too_many_points_is_not_laid(
    most: int, empty: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A box of 2.5 steps has at most four rows, four columns and four layers."""
    monkeypatch.setattr(module, "MOST_POINTS", most)
    filled = np.stack(np.meshgrid(*[np.linspace(0.0, 2.1, 22)] * 3), axis=-1).reshape(-1, 3)
    assert (len(laid(Mould(cKDTree(filled), 0.2, True), 1.0)) == 0) == empty
