"""The lowest ground under polygons: never above dense samples, and reached by them nearly."""

from __future__ import annotations

import numpy as np
import pytest

from shotc.geom.surface.ground import ground_of, height_at
from shotc.geom.surface.under_rings import in_ring, lowest_under
from tests.support.surfaces import grid


def star(random: np.random.Generator, centre: np.ndarray, size: float) -> np.ndarray:
    """A polygon that does not cross itself, counter-clockwise."""
    turn = np.sort(random.uniform(0, 2 * np.pi, random.integers(5, 12)))
    reach = size * random.uniform(0.3, 1.0, len(turn))
    return centre + np.column_stack([reach * np.cos(turn), reach * np.sin(turn)])


@pytest.mark.parametrize("seed", range(3))
def test_what_is_in_a_ring_is_what_the_ring_winds_around(seed):
    random = np.random.default_rng(seed)
    ring, points = star(random, np.array([3.0, -2.0]), 6.0), random.uniform(-8.0, 8.0, (200, 2))
    x, y = (ring[None] - points[:, None]).transpose(2, 0, 1)
    turns = np.angle((np.roll(x, -1, axis=1) + 1j * np.roll(y, -1, axis=1)) / (x + 1j * y))
    wound = np.abs(turns.sum(axis=1)) > np.pi
    assert 0 < wound.sum() < len(points)
    assert (in_ring(ring, points) == wound).all()


def test_on_a_slope_a_corner_is_the_lowest_and_over_a_valley_a_side():
    x, y = np.meshgrid(np.arange(9.0), np.arange(9.0), indexing="ij")
    ring = np.array([[2.3, 1.7], [6.1, 2.2], [5.2, 6.4], [1.4, 5.3]])

    def lowest(heights: np.ndarray) -> float:
        shape = grid(heights, 1.0)
        return float(lowest_under(ground_of(shape.corners, shape.faces), [ring])[0])

    assert lowest(0.5 * x - 0.25 * y) == pytest.approx((0.5 * ring[:, 0] - 0.25 * ring[:, 1]).min())
    # Only one corner is beyond the floor of each valley, and two sides cross it.
    assert lowest(np.abs(x - 6.0) + 3.0) == pytest.approx(3.0)
    assert lowest(np.abs(y - 6.0) + 3.0) == pytest.approx(3.0)


@pytest.mark.parametrize("first", [0, 1, 2])
@pytest.mark.parametrize("middle", [(20.0, 0.0), (0.0, 20.0)])
def test_where_a_side_of_the_ground_crosses_a_ring_it_may_be_the_lowest(first, middle):
    """Heights rise from 0 to 4 along both sides; the ring reaches 2 m beyond the middle of one."""
    corners = np.roll(np.array([[0.0, 0.0, 0.0], [40.0, 0.0, 4.0], [0.0, 40.0, 4.0]]), first, axis=0)
    ring = np.array(middle) + np.array([[-2.0, -2.0], [2.0, -2.0], [2.0, 2.0], [-2.0, 2.0]])
    found = lowest_under(ground_of(corners, np.array([[0, 1, 2]])), [ring])
    assert found[0] == pytest.approx(1.8)


@pytest.mark.long
@pytest.mark.parametrize("seed", range(6))
def test_it_is_the_least_of_all_places_in_the_ring(seed):
    random = np.random.default_rng(seed)
    shape = grid(random.uniform(0, 10, (30, 30)), 3.0)
    ground = ground_of(shape.corners, shape.faces)
    rings = [star(random, random.uniform(25, 60, 2), size) for size in (1.0, 6.0, 20.0)]
    found = lowest_under(ground, rings)
    for ring, least in zip(rings, found, strict=True):
        places = random.uniform(ring.min(axis=0), ring.max(axis=0), (60_000, 2))
        dense = height_at(ground, places[in_ring(ring, places)]).min()
        assert least <= dense + 1e-9
        assert least > dense - 0.5


def test_beyond_the_ground_there_is_none():
    shape = grid(np.full((4, 4), 2.0), 10.0)
    ground = ground_of(shape.corners, shape.faces)
    square = np.array([[0.0, 0], [5, 0], [5, 5], [0, 5]])
    inside, across, outside = lowest_under(ground, [square + 5, square + 27, square + 100])
    assert (inside, across) == (2.0, 2.0)
    assert np.isnan(outside)
    assert len(lowest_under(ground, [])) == 0


def test_a_house_around_a_pit_reaches_into_it():
    heights = np.zeros((9, 9))
    heights[4, 4] = -7.0
    shape = grid(heights, 1.0)
    ring = np.array([[2.5, 2.5], [5.5, 2.5], [5.5, 5.5], [2.5, 5.5]])
    assert lowest_under(ground_of(shape.corners, shape.faces), [ring]).tolist() == [-7.0]
