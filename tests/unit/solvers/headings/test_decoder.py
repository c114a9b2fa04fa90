from itertools import product

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from shotc.solvers.headings.decoder import decode

SEEDS = st.integers(0, 2**32 - 1)


def random_problem(seed: int, size: int):
    random = np.random.default_rng(seed)
    root = random.normal(size=(size, size))
    return root @ root.T + 0.2 * np.eye(size), random.normal(scale=1.5, size=size)


@settings(max_examples=60, deadline=None)
@given(SEEDS, st.integers(1, 3), st.integers(1, 6))
def test_the_list_is_that_of_enumeration(seed: int, size: int, count: int) -> None:
    gram, centre = random_problem(seed, size)
    found = decode(gram, centre, count)
    # No point nearer than the worst found lies outside this box, since (m - c)' G (m - c) >= least |m - c|^2.
    reach = (
        int(np.ceil(np.sqrt(found.points[-1][0] / np.linalg.eigvalsh(gram)[0]) + np.abs(centre).max())) + 1
    )
    if (2 * reach + 1) ** size > 200_000:
        return
    every = np.array(list(product(range(-reach, reach + 1), repeat=size)))
    away = every - centre
    cost = np.sort(np.einsum("ki,ij,kj->k", away, gram, away))[:count]
    assert not found.capped
    np.testing.assert_allclose([c for c, _ in found.points], cost, rtol=1e-9, atol=1e-12)


@given(SEEDS, st.integers(1, 6))
@settings(max_examples=40, deadline=None)
def test_costs_are_those_of_the_points(seed: int, size: int) -> None:
    gram, centre = random_problem(seed, size)
    for cost, point in decode(gram, centre, 5).points:
        away = np.array(point) - centre
        assert cost == pytest.approx(away @ gram @ away)


def test_a_search_that_is_cut_short_says_so() -> None:
    gram, centre = random_problem(1, 8)
    whole, cut = decode(gram, centre, 4), decode(gram, centre, 4, most_nodes=21)
    assert cut.capped
    assert cut.nodes == 21
    assert not whole.capped
    assert whole.points[0] <= cut.points[0]


def test_a_gram_that_is_not_definite_is_refused() -> None:
    with pytest.raises(np.linalg.LinAlgError):
        decode(np.array([[1.0, 2.0], [2.0, 1.0]]), np.zeros(2), 1)
