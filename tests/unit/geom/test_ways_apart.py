"""How near two curves come whenever each is flown: by arithmetic where it is known, else by dense samples."""

from __future__ import annotations

from math import hypot, sqrt

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import cKDTree

from shotc.geom.bernstein import bernstein_basis
from shotc.geom.pieces import Pieces
from shotc.geom.ways_apart import nearest

GAP = 1e-6


def way(points: list[tuple[float, float, float]]) -> Pieces:
    """Straight lines through points, as cubics."""
    p = np.array(points)
    share = np.linspace(0.0, 1.0, 4)[None, :, None]
    times = np.arange(float(len(p)))
    return Pieces(times[:-1], times[1:], p[:-1, None] + share * (p[1:] - p[:-1])[:, None])


def test_two_lines_at_other_times_are_as_near_as_lines_are() -> None:
    found = nearest(
        way([(-9, 0, 5), (9, 0, 5)]), way([(0, 0, 0), (40, -30, 8), (1, -9, 8), (1, 9, 8)]), lambda _: GAP
    )
    assert found.attained == pytest.approx(3.0, abs=1e-6)
    assert 3.0 - 2 * GAP < found.proven <= 3.0
    assert found.one == pytest.approx(10 / 18, abs=1e-3)
    assert found.other == pytest.approx(2.5, abs=1e-3)


def test_ends_count() -> None:
    found = nearest(way([(0, 0, 0), (1, 0, 0)]), way([(3, 1, 1), (9, 9, 9)]), lambda _: GAP)
    assert found.attained == pytest.approx(sqrt(6.0), abs=1e-5)
    assert found.proven <= sqrt(6.0)


def test_ways_that_cross_meet() -> None:
    found = nearest(way([(-1, 0, 0), (2, 0, 0)]), way([(0, -3, 0), (0, 1, 0)]), lambda _: GAP)
    assert found.attained < hypot(GAP, GAP)
    assert found.proven <= found.attained


@pytest.mark.slow
@settings(max_examples=15, deadline=None)
@given(seed=st.integers(0, 10**6))
def test_no_sample_is_nearer_than_what_is_proved(seed: int) -> None:
    rng = np.random.default_rng(seed)
    bags = []
    for offset in (0.0, rng.uniform(0, 15)):
        points = np.cumsum(rng.normal(size=(13, 3)), axis=0) * 3.0 + [0.0, 0.0, offset]
        ctrl = np.stack([points[3 * i : 3 * i + 4] for i in range(4)])
        bags.append(Pieces(np.arange(4.0), np.arange(1.0, 5.0), ctrl))
    found = nearest(*bags, lambda _: GAP)
    basis = bernstein_basis(3, np.linspace(0.0, 1.0, 500))
    one, other = (np.einsum("tk,mkd->mtd", basis, bag.ctrl).reshape(-1, 3) for bag in bags)
    sampled = float(cKDTree(other).query(one)[0].min())
    assert found.proven <= sampled + 1e-9
    assert sampled - 0.1 <= found.attained <= found.proven + 2 * GAP + 1e-9


def test_ways_that_cross_have_no_distance() -> None:
    found = nearest(way([(-4, 0, 1), (4, 0, 1)]), way([(0, -9, 1), (0, 9, 1)]), lambda _: GAP)
    assert (found.proven, found.attained) == pytest.approx((0.0, 0.0), abs=1e-9)
