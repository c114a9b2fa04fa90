"""Terrain in a free space: planes and proofs held against the height of the ground, computed anew."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from shotc.geom.surface.ground import ground_of
from shotc.ir.owners import CEILING, GROUND
from shotc.planning.free_space import FreeSpace, bounds_slack, breaches, corridor, shortfall
from shotc.planning.over_ground import heights_over
from shotc.planning.path.over import over_ground
from tests.support.surfaces import grid

RANDOM = np.random.default_rng(3)
SHAPE = grid(RANDOM.uniform(0, 12, (24, 24)), 5.0)
LOW, HIGH = heights_over(ground_of(SHAPE.corners, SHAPE.faces), 3.0, 25.0)
SPACE = FreeSpace((), (), (), terrain=(LOW, HIGH))


def some_points(count: int) -> np.ndarray:
    return RANDOM.uniform([8, 8, -5], [105, 105, 45], (count, 3))


def height(points: np.ndarray) -> np.ndarray:
    return points[..., 2] - SHAPE.height_at(points[..., 0], points[..., 1])


def some_hulls(count: int) -> np.ndarray:
    start = RANDOM.uniform([15, 15, 0], [100, 100, 40], (count, 1, 3))
    return start + RANDOM.normal(size=(count, 6, 3)) * [3, 3, 2]


def test_slack_is_the_nearer_of_both_heights():
    p = some_points(300)
    expected = np.minimum(height(p) - 3.0, 25.0 - height(p))
    assert bounds_slack(SPACE, p) == pytest.approx(expected)
    assert LOW.slack(p) == pytest.approx(height(p) - 3.0)
    assert HIGH.slack(p) == pytest.approx(25.0 - height(p))


def test_beyond_the_ground_nothing_is_free():
    outside = np.array([[-4.0, 50.0, 20.0], [50.0, 120.0, 20.0]])
    assert (bounds_slack(SPACE, outside) < -900).all()
    assert (shortfall(SPACE, np.repeat(outside[:, None], 6, axis=1)) > 900).all()


def test_what_a_point_breaks_is_named():
    (low,) = breaches(SPACE, np.array([50.0, 50.0, float(SHAPE.height_at(50.0, 50.0)) + 1.0]))
    assert (low.owner, low.lack, low.clearance) == (GROUND, pytest.approx(2.0), 3.0)
    (high,) = breaches(SPACE, np.array([50.0, 50.0, float(SHAPE.height_at(50.0, 50.0)) + 29.0]))
    assert (high.owner, high.lack) == (CEILING, pytest.approx(4.0))
    assert SPACE.without(GROUND).terrain == (HIGH,)


@pytest.mark.slow
def test_what_is_proved_of_pieces_is_true_and_no_more_than_a_hair_too_careful():
    hulls = some_hulls(60)
    lack = shortfall(SPACE, hulls)
    x = np.linspace(0, 1, 400)[:, None]
    basis = np.hstack([[1, 5, 10, 10, 5, 1][k] * x**k * (1 - x) ** (5 - k) for k in range(6)])
    points = np.einsum("xk,pkd->pxd", basis, hulls)
    true = np.maximum(3.0 - height(points), height(points) - 25.0).max(axis=1)
    assert (lack >= true - 1e-6).all()
    broken = true > 0
    assert broken.any()
    # A piece that is proved by its plane says less than it has; one that is not is bounded to the end.
    assert (lack[broken] <= true[broken] + 0.05).all()
    assert (lack[true < -4.0] <= 0.0).mean() > 0.9


@pytest.mark.parametrize("reach", [2.0, 20.0])
def test_pieces_between_their_half_spaces_keep_both_heights(reach):
    hulls = some_hulls(60)
    planes = corridor(SPACE, hulls, reach)
    assert set(planes.owner) == {0, 1}  # no obstacles stand before them
    for k in range(60):
        mine = planes.piece == k
        inside = hulls[k].mean(axis=0) + RANDOM.normal(size=(400, 3)) * [2, 2, 8]
        box = hulls[k][:, :2].min(axis=0), hulls[k][:, :2].max(axis=0)
        inside = inside[((inside[:, :2] > box[0]) & (inside[:, :2] < box[1])).all(axis=1)]
        along = np.einsum("nd,rd->nr", inside, planes.normal[mine]) - planes.offset[mine].min(axis=1)
        kept = (along >= 0).all(axis=1)
        if set(planes.owner[mine]) == {0, 1}:
            assert (height(inside[kept]) >= 3.0 - 1e-9).all()
            assert (height(inside[kept]) <= 25.0 + 1e-9).all()


def test_a_piece_between_slopes_that_rise_beside_it_keeps_its_place():
    """In a gully a plane above what lies a metre beside a piece would be above the piece."""
    gully = grid(np.abs(np.arange(24) * 1.0 - 12.0)[:, None] * np.ones(24) * 2.0, 1.0)
    (low,) = heights_over(ground_of(gully.corners, gully.faces), 3.0, None)
    hulls = np.linspace([12.0, 6.0, 3.05], [12.0, 8.0, 3.05], 6)[None]
    planes = low.planes(hulls, 2.0, lambda slack: 0.5 * slack)
    room = np.einsum("rmd,rd->rm", hulls[planes.piece], planes.normal) - planes.offset[:, None]
    assert len(room) == 1
    assert room.min() >= 0.0


def led_over(shape, heights, a, b):
    terrain = heights_over(ground_of(shape.corners, shape.faces), *heights)
    way = over_ground(FreeSpace((), (), (), terrain=terrain), np.array([a, b]))
    along = np.concatenate([p + np.linspace(0, 1, 50)[:, None] * (q - p) for p, q in pairwise(way)])
    assert (way[0] == a).all()
    assert (way[-1] == b).all()
    return way, along[:, 2] - shape.height_at(along[:, 0], along[:, 1])


def hill(height: float):
    return grid(height * np.exp(-(((np.arange(24) * 5.0 - 60) / 14) ** 2))[:, None] * np.ones(24), 5.0)


def test_a_way_is_led_over_what_rises_and_no_higher():
    way, room = led_over(hill(14.0), (3.0, None), [10.0, 60.0, 4.0], [105.0, 58.0, 4.0])
    assert room.min() >= 3.0
    assert room[np.argmax(way[:, 2])] < 8.0
    assert way[:, 2].max() < 14.0 + 3.0 + 2.0
    assert np.linalg.norm(np.diff(way[:, :2], axis=0), axis=1).max() <= 16.0
    high, _ = led_over(hill(14.0), (3.0, None), [10.0, 60.0, 44.0], [105.0, 58.0, 44.0])
    assert len(high) == 2


def test_a_way_is_led_down_into_a_valley_that_is_deeper_than_the_greatest_height():
    _, room = led_over(hill(-60.0), (3.0, 30.0), [10.0, 60.0, 8.0], [105.0, 58.0, 8.0])
    assert room.min() >= 3.0
    assert room.max() <= 30.0


def test_nothing_is_proved_over_a_hole():
    middle = np.abs(SHAPE.corners[SHAPE.faces].mean(axis=1)[:, :2] - 57.0).max(axis=1) > 6.0
    (low,) = heights_over(ground_of(SHAPE.corners, SHAPE.faces[middle]), 3.0, None)
    over = np.linspace([20.0, 57.0, 40.0], [90.0, 57.0, 40.0], 6)
    beside = over + np.array([0.0, 20.0, 0.0])
    lack = low.lack(np.stack([over, beside]))
    assert lack[0] > 900
    assert lack[1] <= 0.0
