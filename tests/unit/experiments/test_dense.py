"""A small sample of moves between pictures at the separation itself: all keep apart, and are hardly slower.

Small fleets take longer than large ones: the figures of the experiment are those of 300 drones and more.
"""

from __future__ import annotations

import pytest

from tests.experiments.dense import APARTS, moves


@pytest.mark.parametrize(("shape", "slower"), [("ellipsoid", 1.4), ("cylinder", 1.9)])
def test_dense_pictures_follow_each_other_and_keep_apart(shape: str, slower: float) -> None:
    apart = APARTS[shape]
    for move in moves(60, 0, apart):
        assert move.proven >= apart.across
        assert move.seconds <= slower * move.straight
