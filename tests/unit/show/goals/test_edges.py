"""Lights along edges: on corners, evenly between them, and where there are fewer than corners."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from shotc.show.goals.edges import along_edges
from shotc.show.goals.flat import chain, closed

SQUARE = np.array([[0.0, 0.0], [8.0, 0.0], [8.0, 8.0], [0.0, 8.0]])
ONES = np.ones(2)


def rows(places: np.ndarray) -> set[tuple[float, float]]:
    return {(round(float(x), 6), round(float(y), 6)) for x, y in places}


def test_corners_first_then_the_middle_of_the_sides() -> None:
    corners = rows(SQUARE)
    assert rows(along_edges([closed(SQUARE)], 4, 1.0, ONES)) == corners
    eight = rows(along_edges([closed(SQUARE)], 8, 1.0, ONES))
    assert eight == corners | {(4.0, 0.0), (8.0, 4.0), (4.0, 8.0), (0.0, 4.0)}


def test_of_corners_too_near_to_each_other_one_is_kept() -> None:
    thin = SQUARE * (0.1, 1.0)
    found = along_edges([closed(thin)], 6, 1.0, ONES)
    assert sum(tuple(row) in {tuple(c) for c in thin} for row in found) == 2
    # In a metric that has them farther apart both are.
    assert len(rows(along_edges([closed(thin)], 4, 1.0, np.array([2.0, 1.0]))) & rows(thin)) == 4


def test_a_circle_is_even_and_an_open_line_has_both_ends() -> None:
    turn = 2 * np.pi * np.arange(200) / 200
    circle = along_edges([closed(np.column_stack([np.cos(turn), np.sin(turn)]))], 10, 0.1, ONES)
    gaps = np.linalg.norm(circle - np.roll(circle, -1, axis=0), axis=1)
    assert gaps == pytest.approx(gaps.mean(), rel=1e-3)
    bent = along_edges([chain(np.array([[0.0, 0.0], [6.0, 0.0], [6.0, 3.0]]))], 4, 1.0, ONES)
    assert rows(bent) == {(0.0, 0.0), (3.0, 0.0), (6.0, 0.0), (6.0, 3.0)}


@pytest.mark.slow
@given(st.integers(1, 40), st.integers(1, 12))
def test_there_are_as_many_as_asked_for(count: int, shapes: int) -> None:
    edges = [closed(SQUARE + 10.0 * k) for k in range(shapes)]
    found = along_edges(edges, count, 1.0, ONES)
    assert found.shape == (count, 2)
    assert len(rows(found)) == count
