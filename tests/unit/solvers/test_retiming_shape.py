"""What the cone programme of a profile assumes in its cells, against motions at constant jerks."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from shotc.solvers.retiming_socp import (
    Iterate,
    NormLimit,
    _Model,
    _SpeedShape,
    cell_times,
    start_from,
    triangular,
)


class Motion:
    """Cells of random durations and jerks, one after the other, by their closed forms."""

    def __init__(self, seed: int, count: int = 6) -> None:
        rng = np.random.default_rng(seed)
        self.times, self.jerks = rng.uniform(0.2, 1.0, count), rng.uniform(-1.0, 1.0, count)
        v, a = [4.0], [0.5]
        for t, j in zip(self.times, self.jerks, strict=True):
            v.append(v[-1] + a[-1] * t + j * t**2 / 2)
            a.append(a[-1] + j * t)
        self.v, self.a = np.array(v), np.array(a)
        t, j = self.times, self.jerks
        self.widths = self.v[:-1] * t + self.a[:-1] * t**2 / 2 + j * t**3 / 6

    def at(self, x: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return length, speed and acceleration at shares x of the durations of the cells."""
        t, v, a, j = x * self.times, self.v[:-1], self.a[:-1], self.jerks
        return v * t + a * t**2 / 2 + j * t**3 / 6, v + a * t + j * t**2 / 2, a + j * t

    def shape(self) -> _SpeedShape:
        return _SpeedShape(self.widths, Iterate(self.v**2, self.a))


@pytest.mark.parametrize("seed", range(3))
def test_a_cell_at_constant_jerk_has_its_time_and_its_middle(seed: int) -> None:
    motion = Motion(seed)
    assert cell_times(motion.widths, motion.v**2, motion.a) == pytest.approx(motion.times)
    shape = motion.shape()
    assert shape.time == pytest.approx(motion.times)
    assert motion.at(shape.middle)[0] == pytest.approx(motion.widths / 2)


@pytest.mark.parametrize("seed", range(3))
def test_the_weights_give_speed_and_acceleration_at_both_ends_and_in_the_middle(seed: int) -> None:
    motion = Motion(seed)
    shape = motion.shape()
    places = (np.zeros(len(motion.widths)), shape.middle, np.ones(len(motion.widths)))
    b0, b1, a0, a1 = motion.v[:-1] ** 2, motion.v[1:] ** 2, motion.a[:-1], motion.a[1:]
    for x, (on_b0, on_b1, on_a0, on_a1, s0, s1, u) in zip(places, shape.parts, strict=True):
        _, speed, acceleration = motion.at(x)
        assert on_b0 * b0 + on_b1 * b1 + on_a0 * a0 + on_a1 * a1 == pytest.approx(speed**2)
        assert s0 * a0 + s1 * a1 == pytest.approx(acceleration)
        assert u * shape.mean == pytest.approx(speed)
    whole = 2.0 * motion.widths * (shape.start_share * a0 + shape.end_share * a1)
    assert whole == pytest.approx(b1 - b0)


def test_accelerations_that_begin_a_profile_are_those_of_its_parabola() -> None:
    """b = 3 + 2 s - s^2 / 4 has the acceleration 1 - s / 4, whatever the cells."""
    grid = np.array([0.0, 0.3, 1.0, 1.1, 2.5, 3.0])
    found = start_from(np.diff(grid), 3.0 + 2.0 * grid - grid**2 / 4)
    assert found.a[1:-1] == pytest.approx(1.0 - grid[1:-1] / 4)
    assert (found.a[0], found.a[-1]) == (0.0, 0.0)


def test_a_blend_keeps_its_share_of_the_first_one() -> None:
    one, other = Iterate(np.array([1.0, 2.0]), np.array([4.0, 8.0])), Iterate(np.zeros(2), np.ones(2))
    mixed = one.blend(other, 0.25)
    assert (mixed.b.tolist(), mixed.a.tolist()) == ([0.25, 0.5], [1.75, 2.75])


@pytest.mark.parametrize("rank", [1, 2, 3])
def test_columns_in_a_basis_of_their_own_keep_lengths_and_angles_and_only_the_rows_that_they_need(
    rank: int,
) -> None:
    rng = np.random.default_rng(rank)
    # At every point the columns lie in the span of so many of the five axes.
    columns = np.zeros((4, 3, 5, 3))
    columns[:, :, :rank] = rng.normal(size=(4, 3, rank, 3))
    found = triangular(columns)
    assert found.shape == (4, 3, rank, 3)
    products = [np.einsum("npik,npil->npkl", c, c) for c in (columns, found)]
    assert products[1] == pytest.approx(products[0], abs=1e-9)
    single = columns[:, :, :1]
    assert (triangular(single) == single).all()


class Rows:
    """The rows of a cone programme, evaluated for its unknowns as they come."""

    def __init__(self, x: np.ndarray) -> None:
        self.x, self.unknowns = x, len(x)
        self.zeros: list[np.ndarray] = []
        self.bounds: list[np.ndarray] = []
        self.norms: list[tuple[np.ndarray, np.ndarray]] = []
        """Bounds, and the norms that are to be below them."""

    def value(self, terms: list[Any]) -> np.ndarray:
        return np.asarray(sum(coefficient * self.x[at] for at, coefficient in terms))

    def zero(self, terms: list[Any]) -> None:
        self.zeros.append(self.value(terms))

    def positive(self, constant: np.ndarray, terms: list[Any]) -> None:
        self.bounds.append(constant + self.value(terms))

    def second_order(self, constant: np.ndarray, parts: list[Any], rest: list[Any] | None = None) -> None:
        others = [0.0] * (len(parts) - 1) if rest is None else rest
        below = [more + self.value(part) for part, more in zip(parts[1:], others, strict=True)]
        bound = constant + self.value(parts[0])
        self.norms.append((bound, np.sqrt(sum(np.broadcast_to(b, bound.shape) ** 2 for b in below))))


def model(motion: Motion) -> tuple[_Model, Rows]:
    """Return the programme about a motion, and what its rows are for that motion."""
    made = _Model(motion.widths, Iterate(motion.v**2, motion.a))
    rows = Rows(made.start())
    made.rows = rows  # type: ignore[assignment]
    return made, rows


def limit(motion: Motion, seed: int) -> NormLimit:
    """Derivatives of a path in space that are others at every place."""
    return NormLimit(*np.random.default_rng(seed).normal(size=(3, len(motion.widths), 3, 3)))


def places(motion: Motion) -> list[tuple[np.ndarray, np.ndarray, np.ndarray]]:
    """Return speed squared, speed and acceleration at the start, middle and end of each cell."""
    at = (np.zeros(len(motion.widths)), motion.shape().middle, np.ones(len(motion.widths)))
    return [(v**2, v, a) for _, v, a in map(motion.at, at)]


@pytest.mark.parametrize("seed", range(3))
def test_the_acceleration_is_bounded_at_nodes_and_in_the_middle(seed: int) -> None:
    motion = Motion(seed)
    given = limit(motion, seed)
    made, rows = model(motion)
    made.acceleration(given)
    start, middle, _ = (
        np.linalg.norm(given.d2[:, k] * b[:, None] + given.d1[:, k] * a[:, None], axis=1)
        for k, (b, _, a) in enumerate(places(motion))
    )
    for (bound, found), expected in zip(rows.norms, (start[1:], middle), strict=True):
        assert bound == pytest.approx(1.0)
        assert found == pytest.approx(expected)


@pytest.mark.parametrize("seed", range(3))
def test_the_jerk_is_bounded_at_both_ends_and_in_the_middle(seed: int) -> None:
    motion = Motion(seed)
    given = limit(motion, seed)
    made, rows = model(motion)
    made.jerk(given)
    for k, ((bound, found), (b, v, a)) in enumerate(zip(rows.norms, places(motion), strict=True)):
        third = given.d3[:, k] * (v * b)[:, None] + 3.0 * given.d2[:, k] * (v * a)[:, None]
        assert bound == pytest.approx(1.0)
        assert found == pytest.approx(np.linalg.norm(third + given.d1[:, k] * motion.jerks[:, None], axis=1))


def test_a_limit_of_one_row_is_two_bounds() -> None:
    motion = Motion(0)
    along = np.zeros((3, len(motion.widths), 3, 2))
    along[0, :, :, 0], along[1, :, :, 0] = 0.3, -0.1
    made, rows = model(motion)
    made.acceleration(NormLimit(*along))
    assert not rows.norms
    (b, _, a), (b_middle, _, a_middle), _ = places(motion)
    for k, (squared, rate) in enumerate(((b[1:], a[1:]), (b_middle, a_middle))):
        used = 0.3 * rate - 0.1 * squared
        both = np.sort(rows.bounds[2 * k : 2 * k + 2], axis=0)
        assert both == pytest.approx(np.sort([1.0 - used, 1.0 + used], axis=0))


def test_a_motion_keeps_its_own_rows_and_caps_are_shares() -> None:
    motion = Motion(1)
    made, rows = model(motion)
    made.motion()
    assert np.abs(rows.zeros[-1]).max() < 1e-12
    (b, _, _), (b_middle, _, _), _ = places(motion)
    nodes, middles = np.linspace(20.0, 40.0, len(motion.v)), np.linspace(30.0, 50.0, len(motion.widths))
    made.caps(nodes, middles)
    inner, between = rows.bounds
    assert inner == pytest.approx(1.0 - b[1:] / nodes[1:-1])
    assert between == pytest.approx(1.0 - b_middle / middles)


def test_the_cones_of_time_are_met_with_equality_by_a_motion_alone() -> None:
    motion = Motion(2)
    made, rows = model(motion)
    made.times()
    for bound, found in rows.norms:
        assert bound == pytest.approx(2.0)
        assert found == pytest.approx(2.0)
    assert made.total_time() @ made.start() == pytest.approx(1.0)
    rows.norms.clear()
    rows.x = rows.x.copy()
    rows.x[2 * made.nodes : 3 * made.nodes] *= 1.01  # speeds above the roots of their squares
    made.times()
    root, inverse = rows.norms
    assert (root[1] > root[0]).all()
    assert (inverse[1] < inverse[0]).all()


def test_rest_at_both_ends_is_asked_of_every_unknown_there() -> None:
    made, rows = model(Motion(3))
    rows.x = np.zeros_like(rows.x)
    for first in (0, made.nodes, 2 * made.nodes):
        rows.x[first], rows.x[first + made.nodes - 1] = 3.0, 5.0
    made.motion()
    assert [found.tolist() for found in rows.zeros[:3]] == [[3.0, 5.0]] * 3


def test_the_middle_of_a_cell_in_which_the_speed_falls_and_rises_is_found() -> None:
    """At the middle the speed is three quarters of its mean: Newton's steps are longer than elsewhere."""
    motion = Motion(0)
    motion.times, motion.jerks = np.array([2.0]), np.array([8.0])
    motion.v, motion.a = np.array([8.0, 8.6]), np.array([-7.7, 8.3])
    motion.widths = motion.v[:-1] * 2.0 + motion.a[:-1] * 2.0 + motion.jerks * 8.0 / 6.0
    length, speed, _ = motion.at(motion.shape().middle)
    assert (speed / (motion.widths / motion.times)).min() < 0.8
    assert length == pytest.approx(motion.widths / 2, rel=1e-7)
