"""Colours of places, held against all pairs and against what is known of square grids."""

from __future__ import annotations

from itertools import combinations
from math import cos, dist, sin

import pytest
from hypothesis import given
from hypothesis import strategies as st

from shotc.geom.colouring import coloured, conflicts, fewest_colours

places = st.lists(st.tuples(st.floats(-6, 6), st.floats(-6, 6)), min_size=1, max_size=60)


@pytest.mark.slow
@given(places, st.floats(0.1, 5.0))
def test_two_of_one_colour_are_apart(points: list[tuple[float, float]], least: float) -> None:
    colours = coloured(points, least)
    assert set(colours) == set(range(max(colours) + 1))
    for i, j in combinations(range(len(points)), 2):
        apart = dist(points[i], points[j])
        assert colours[i] != colours[j] or apart >= least - 2e-6
        assert (j in conflicts(points, least)[i]) == (apart < least - 1e-6) if i == 0 else True
    assert len(set(colours)) >= fewest_colours(points, least)


@pytest.mark.parametrize(
    ("spacing", "count"),
    # The least index of a sublattice of the integers whose shortest vector is 1.5 / spacing or longer.
    [(1.5, 1), (1.1, 2), (0.8, 4), (0.75, 4), (0.7, 5), (0.6, 8), (0.5, 9), (0.4, 15)],
)
@pytest.mark.parametrize("turn", [0.0, 0.3])
def test_square_grids_take_the_best_sublattice(spacing: float, count: int, turn: float) -> None:
    square = [(spacing * (i % 12), spacing * (i // 12)) for i in range(144)]
    points = [(5 + x * cos(turn) - y * sin(turn), 7 + x * sin(turn) + y * cos(turn)) for x, y in square]
    assert max(coloured(points, 1.5)) + 1 == count


def test_a_row_takes_as_many_as_stand_within_the_distance() -> None:
    assert coloured([(0.6 * k, 0.0) for k in range(9)], 1.5) in {
        tuple(order[k % 3] for k in range(9)) for order in ((0, 1, 2), (0, 2, 1), (1, 0, 2))
    }
    assert coloured([(0.0, 0.0)], 1.5) == (0,)


@pytest.mark.parametrize(("apart", "count"), [(1.5 - 1e-4, 2), (1.5 - 1e-7, 1)])
def test_a_pair_shares_a_colour_only_if_no_more_than_rounding_lacks(apart: float, count: int) -> None:
    assert len(set(coloured([(0.0, 0.0), (apart, 0.0)], 1.5))) == count
