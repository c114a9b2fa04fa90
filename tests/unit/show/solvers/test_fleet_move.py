"""How short the pieces of a move may be."""

from __future__ import annotations

import numpy as np
import pytest

from shotc.show.solvers.move import least_piece, least_pieces
from tests.support.fleet_scenes import LIMITS


@pytest.mark.parametrize("pieces", [3, 5, 20])
def test_all_drones_at_once_are_as_slow_as_each_alone(pieces: int) -> None:
    ways = np.random.default_rng(0).normal(scale=10.0, size=(30, 3))
    ways[3] = 0.0
    alone = [least_piece(pieces, way[None], LIMITS) for way in ways]
    assert np.array_equal(least_pieces(pieces, ways, LIMITS), alone)
    assert least_piece(pieces, ways, LIMITS) >= max(alone) * (1 - 1e-12)
