"""The shortest way through a section, against one that is found by brute force."""

from __future__ import annotations

import numpy as np
import pytest

from shotc.planning.vertical_section import Section, cut, fewer, taut


def length(corners):
    return float(np.hypot(*np.diff(corners, axis=0).T).sum())


def shortest(section):
    """Over heights in steps at each place, from one place to the next."""
    share = np.linspace(0.0, 1.0, 200)[:, None]
    heights = section.low + share * (section.high - section.low)
    cost = np.zeros(200)
    for k in range(1, len(section.along)):
        rise = heights[:, k] - heights[:, k - 1, None]
        cost = (cost[:, None] + np.hypot(section.along[k] - section.along[k - 1], rise)).min(axis=0)
    return float(cost.min())


@pytest.mark.parametrize("seed", range(8))
def test_no_way_through_a_section_is_shorter(seed):
    random = np.random.default_rng(seed)
    along = np.cumsum(random.uniform(0.5, 2.0, 12))
    low = random.uniform(0.0, 6.0, 12)
    high = low + random.uniform(0.3, 4.0, 12)
    low[[0, -1]] = high[[0, -1]] = random.uniform(0.0, 8.0, 2)
    section = Section(along, low, high)
    way = taut(section)
    height = np.interp(along, *way.T)
    assert ((height >= low - 1e-9) & (height <= high + 1e-9)).all()
    assert length(way) <= shortest(section) + 1e-9


def test_corners_on_a_crest_become_few_that_are_no_lower():
    along = np.arange(61.0)
    low = 20.0 - 0.02 * (along - 30.0) ** 2
    low[[0, -1]] = 0.0
    section = Section(along, low, np.full(61, np.inf))
    section.high[[0, -1]] = 0.0
    way = taut(section)
    few = fewer(section, way, 8.0)
    assert len(few) < 0.3 * len(way)
    assert (np.interp(along, *few.T) >= low - 1e-9).all()
    assert np.diff(cut(few, 5.0)[:, 0]).max() <= 5.0
    assert np.interp(along, *cut(few, 5.0).T) == pytest.approx(np.interp(along, *few.T))


def test_where_the_greatest_height_is_below_the_least_one_the_way_has_the_least():
    way = taut(Section(np.arange(4.0), np.array([0.0, 5.0, 5.0, 0.0]), np.array([0.0, 2.0, 2.0, 0.0])))
    assert way.tolist() == [[0, 0], [1, 5], [2, 5], [3, 0]]
