"""What the cone programme of a profile assumes in its cells, against motions at constant jerks."""

from __future__ import annotations

import numpy as np
import pytest

from shotc.solvers.retiming_socp import Iterate, _Shape, cell_times, start_from, triangular


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

    def shape(self) -> _Shape:
        return _Shape(self.widths, Iterate(self.v**2, self.a))


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
