"""How short the pieces of a move may be."""

from __future__ import annotations

import numpy as np
import pytest

from shotc.show.solvers.move import LIMIT_SHARE, PIECES, WORTH_RATIO, fastest, least_piece, least_pieces
from tests.support.fleet_scenes import LIMITS


@pytest.mark.parametrize("pieces", [3, 5, 20])
def test_all_drones_at_once_are_as_slow_as_each_alone(pieces: int) -> None:
    ways = np.random.default_rng(0).normal(scale=10.0, size=(30, 3))
    ways[3] = 0.0
    alone = [least_piece(pieces, way[None], LIMITS) for way in ways]
    assert np.array_equal(least_pieces(pieces, ways, LIMITS), alone)
    assert least_piece(pieces, ways, LIMITS) >= max(alone) * (1 - 1e-12)


@pytest.mark.parametrize("far", [0.5, 4.0, 40.0, 400.0])
def test_a_move_takes_hardly_longer_than_any_shape_of_any_number_of_pieces(far: float) -> None:
    ways = np.array([[far, 0.0, 0.0], [0.0, 0.3 * far, 0.1 * far]])
    move = fastest(ways, LIMITS, 1.0)
    shortest = min(pieces * least_piece(pieces, ways, LIMITS) for pieces in PIECES)
    assert move.duration <= 1.002 * WORTH_RATIO * shortest
    assert move.duration >= far / (LIMIT_SHARE * LIMITS.speed)
