"""How near a curve comes to drones of a fleet: against closed forms, whatever its degree and how many."""

from __future__ import annotations

from math import hypot

import numpy as np
import pytest

from shotc.geom.bernstein import Piecewise
from shotc.passes.verify.fleets import nearness
from shotc.passes.verify.fleets.nearness import nearest

FLOWN_M = 12.0
SPEED = 2.0  # m/s, along x


def flown(degree: int) -> Piecewise:
    """Return an even flight along x from the origin, 10 m up, as a polynomial of a degree."""
    at = np.linspace(0.0, FLOWN_M, degree + 1)
    return Piecewise(np.array([0.0, FLOWN_M / SPEED]), np.stack([at, 0 * at, 0 * at + 10.0], axis=1)[None])


def standing(places: list[tuple[float, float, float]], degree: int) -> np.ndarray:
    """Return the control points of drones that stand over two pieces."""
    return np.tile(np.array(places)[:, None, None], (1, 2, degree + 1, 1))


@pytest.mark.parametrize(("own", "its"), [(5, 3), (3, 5), (1, 3), (4, 4)])
def test_curves_of_other_degrees_come_as_near_as_they_do(own: int, its: int) -> None:
    found = nearest(flown(own), np.array([0.0, 1.0, 6.0]), standing([(5.0, 3.0, 14.0)], its), (0.0, 6.0), 1.0)
    assert found.attained == pytest.approx(hypot(3.0, 4.0), abs=1e-3)
    assert found.proven == pytest.approx(5.0, abs=1e-3)
    assert found.at == pytest.approx(2.5, abs=0.02)


def test_one_that_moves_is_met_where_both_are() -> None:
    # It comes the other way, 4 m aside: they pass at t = 3.
    breaks = np.array([0.0, 6.0])
    at = np.linspace(FLOWN_M, 0.0, 4)
    coming = np.stack([at, 0 * at + 4.0, 0 * at + 10.0], axis=1)[None, None]
    found = nearest(flown(5), breaks, coming, (0.0, 6.0), 1.0)
    assert (found.proven, found.at) == (pytest.approx(4.0, abs=1e-3), pytest.approx(3.0, abs=1e-2))


@pytest.mark.parametrize("block", [1, 2, 3, 100])
@pytest.mark.parametrize("turned", [False, True])
def test_the_nearest_of_all_blocks_counts(block: int, turned: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(nearness, "BLOCK_DRONES", block)
    places = [(x, y, 10.0) for x, y in ((2.0, 9.0), (4.0, 3.5), (6.0, 2.5), (8.0, 6.0), (9.0, 7.0))]
    ctrl = standing(places[::-1] if turned else places, 3)
    found = nearest(flown(5), np.array([0.0, 2.0, 6.0]), ctrl, (0.0, 6.0), 1.0)
    assert (found.proven, found.at) == (pytest.approx(2.5, abs=1e-3), pytest.approx(3.0, abs=1e-2))


def test_only_the_span_counts_and_who_has_landed_stands() -> None:
    ctrl = standing([(5.0, 1.0, 10.0), (FLOWN_M, 2.0, 10.0)], 3)
    breaks = np.array([0.0, 1.0, 9.0])
    before = nearest(flown(5), breaks, ctrl, (0.0, 2.0), 1.0)
    assert (before.proven, before.at) == (
        pytest.approx(hypot(1.0, 1.0), abs=1e-3),
        pytest.approx(2.0, abs=1e-2),
    )
    landed = nearest(flown(5), breaks, ctrl, (7.0, 9.0), 1.0)
    assert landed.proven == pytest.approx(2.0, abs=1e-3)
    assert 7.0 <= landed.at <= 9.0
