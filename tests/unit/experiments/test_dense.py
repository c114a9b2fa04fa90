"""A small sample of the moves between pictures at the separation itself: all apart, and hardly slower."""

from __future__ import annotations

import pytest

from tests.experiments.dense import APARTS, moves


@pytest.mark.parametrize(("shape", "slower"), [("ellipsoid", 1.3), ("cylinder", 3.0)])
def test_dense_pictures_follow_each_other_and_keep_apart(shape: str, slower: float) -> None:
    apart = APARTS[shape]
    for move in moves(60, 0, apart):
        assert move.proven >= apart.across
        assert move.seconds <= slower * move.straight
