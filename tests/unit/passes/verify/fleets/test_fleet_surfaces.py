"""Distances of whole fleets from surfaces: the likeliest pieces first, then all that may be nearer."""

from __future__ import annotations

import numpy as np
import pytest

from shotc.geom.pieces import Pieces
from shotc.geom.surface.tree import surface_of
from shotc.passes.verify.fleets import surfaces
from shotc.passes.verify.fleets.surfaces import near_surface, once
from tests.support.surfaces import grid

GAP_M = 1e-6


def fine(_best: float) -> float:
    return GAP_M


def level_or_not(heights: list[list[float]]) -> Pieces:
    """Pieces to the East, 5 m each, with control points of these heights."""
    ctrl = np.zeros((len(heights), 4, 3))
    ctrl[:, :, 0] = 5.0 * np.arange(len(heights))[:, None] + np.linspace(0.0, 5.0, 4)
    ctrl[:, :, 1], ctrl[:, :, 2] = 10.0, heights
    return Pieces(np.arange(len(heights)) * 1.0, np.arange(len(heights)) + 1.0, ctrl)


@pytest.mark.parametrize("first", range(4))
def test_a_piece_may_come_nearest_though_its_middle_does_not(
    first: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(surfaces, "SEED_PIECES", 1)
    heights = [[1.0, 1.0, 1.0, 1.0], [10.0, 14.0, 14.0, 0.2], [50.0, 50.0, 50.0, 50.0], [2.0, 9.0, 9.0, 2.0]]
    flown = level_or_not(heights[first:] + heights[:first])
    found = near_surface(flown, surface_of(grid(np.zeros((24, 24)), 1.0).triangles), fine)
    assert found.attained == pytest.approx(0.2, abs=GAP_M)
    assert found.attained - GAP_M <= found.proven <= found.attained
    assert found.at == pytest.approx((1 - first) % 4 + 1.0, abs=1e-3)


def test_where_the_likeliest_piece_comes_nearest_it_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(surfaces, "SEED_PIECES", 1)
    flown = level_or_not([[3.0, 9.0, 9.0, 3.0], [1.0, 0.6, 0.6, 1.0], [2.0, 9.0, 9.0, 0.9]])
    found = near_surface(flown, surface_of(grid(np.zeros((24, 24)), 1.0).triangles), fine)
    assert (found.attained, found.at) == (pytest.approx(0.7, abs=GAP_M), pytest.approx(1.5, abs=1e-2))


def test_a_drone_that_stands_for_many_pieces_is_there_once() -> None:
    places = np.array([1.0, 1.0, 1.0, 2.0, 1.0, 3.0])
    ctrl = np.repeat(places, 4 * 3).reshape(6, 4, 3)
    ctrl[5, 3] = 9.0
    ctrl = np.concatenate([ctrl, ctrl[5:]])
    kept = once(Pieces(np.arange(7.0), np.arange(7.0) + 1.0, ctrl))
    assert kept.low.tolist() == [0.0, 3.0, 4.0, 5.0, 6.0]


@pytest.mark.parametrize("seeds", [1, 2, 3])
def test_it_makes_no_difference_how_many_pieces_are_tried_first(
    seeds: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(surfaces, "SEED_PIECES", seeds)
    flown = level_or_not([[3.0, 9.0, 9.0, 3.0], [2.0, 9.0, 9.0, 0.9]])
    found = near_surface(flown, surface_of(grid(np.zeros((24, 24)), 1.0).triangles), fine)
    assert found.attained == pytest.approx(0.9, abs=GAP_M)
