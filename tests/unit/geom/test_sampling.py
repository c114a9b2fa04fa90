"""Stretches of a sampled signal: each told once, by its worst sample."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from shotc.geom.sampling import worst_of_runs


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
