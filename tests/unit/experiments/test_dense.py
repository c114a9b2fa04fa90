"""A small sample of moves between pictures at the separation itself: all keep apart, and are hardly slower.

300 drones are the smallest fleet of the experiment; smaller ones take relatively longer.
"""

from __future__ import annotations

import pytest

from tests.experiments.dense import APARTS, moves


@pytest.mark.slow
@pytest.mark.parametrize(
    ("shape", "seed"), [("ellipsoid", 0), pytest.param("cylinder", 8, marks=pytest.mark.long)]
)
def test_dense_pictures_follow_each_other_and_keep_apart(shape: str, seed: int) -> None:
    apart = APARTS[shape]
    for move in moves(300, seed, apart):
        assert move.proven >= apart.across
        assert move.seconds <= 1.3 * move.straight
