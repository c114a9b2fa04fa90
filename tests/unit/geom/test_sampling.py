"""Stretches of a sampled signal: each told once, by its worst sample."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from shotc.geom.sampling import directions, worst_of_runs


def test_each_run_is_told_once_and_small_ones_are_not() -> None:
    values = np.array([0.0, 0.3, 0.9, 0.3, 0.0, 0.4, 0.0, 0.6])
    assert worst_of_runs(values, 0.2, 0.5) == [2, 7]


def test_the_first_of_equals_is_told() -> None:
    assert worst_of_runs(np.array([0.6, 0.9, 0.9]), 0.2, 0.5) == [1]


def test_nothing_is_told_of_nothing() -> None:
    assert worst_of_runs(np.array([]), 0.2, 0.5) == []
    assert worst_of_runs(np.zeros(3), 0.2, 0.5) == []


@pytest.mark.slow
@given(st.lists(st.sampled_from([0.0, 0.3, 0.7, 1.0]), max_size=20))
def test_it_is_what_walking_along_finds(signal: list[float]) -> None:
    found, best = [], None
    for i, value in enumerate([*signal, 0.0]):
        if value > 0.2:
            best = i if best is None or value > signal[best] else best
        elif best is not None:
            found += [best] if signal[best] > 0.5 else []
            best = None
    assert worst_of_runs(np.array(signal), 0.2, 0.5) == found


def test_directions_go_evenly_to_all_sides_at_each_rise_and_straight_up() -> None:
    found = directions(8, (-0.4, 0.9))
    assert np.linalg.norm(found, axis=1) == pytest.approx(1.0)
    assert np.arcsin(found[:, 2]) == pytest.approx([-0.4] * 8 + [0.9] * 8 + [np.pi / 2])
    turn = np.unwrap(np.arctan2(found[:16, 1], found[:16, 0]).reshape(2, 8), axis=1)
    assert turn == pytest.approx(np.tile(np.arange(8) * np.pi / 4, (2, 1)))
