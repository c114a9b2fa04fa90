"""Points of clouds as what hides: against all rays and points, and beside the faces that they are of."""

from __future__ import annotations

import numpy as np
import pytest

from shotc.geom.bernstein import Array
from shotc.geom.surface.boards import Billboards, billboards, cells_of, upright
from shotc.geom.surface.cloud import cloud_of
from shotc.geom.surface.occlusion import hidden, in_the_way, lines_hidden, stopped
from shotc.geom.surface.tree import Surface
from tests.support.records import replace

N = 8


def cloud(points: Array, disc: float) -> Surface:
    return replace(cloud_of(points).surface, disc=disc)


def brute(points: Array, boards: Billboards, disc: float) -> Array:
    """Which rays to all cells pass a point by less than the disc, before they are that near to their end."""
    eyes = np.repeat(boards.eye, N * N, axis=0)
    way = cells_of(boards, N) - eyes
    long = np.linalg.norm(way, axis=1)
    way /= long[:, None]
    out = np.zeros(len(eyes), dtype=bool)
    for point in points:
        to = point - eyes
        along = np.einsum("rd,rd->r", to, way)
        off = np.linalg.norm(to - along[:, None] * way, axis=1)
        out |= (along > 0.0) & (off <= disc) & (along + disc < (1.0 - 1e-6) * long)
    return out.reshape(-1, N, N)


@pytest.mark.slow
@pytest.mark.parametrize("disc", [0.02, 0.3, 3.0])
@pytest.mark.parametrize("facing", [True, False])
def test_rays_are_stopped_by_the_points_that_they_pass(disc: float, facing: bool) -> None:
    random = np.random.default_rng(5)
    points = random.uniform(-12.0, 12.0, (400, 3))
    eyes = random.uniform(-20.0, 20.0, (60, 3))
    at = random.uniform(-2.0, 2.0, (60, 3))
    boards = billboards(eyes, at, 4.0, 6.0) if facing else upright(eyes, at, 2.0, 6.0)
    wanted = brute(points, boards, disc)
    surface = cloud(points, disc)
    assert 0.0 < wanted.mean() < 1.0
    assert (hidden(surface, boards, N) == wanted).all()
    pairs = in_the_way(surface, boards, N)
    assert (stopped(surface, boards, pairs, np.ones(wanted.shape)) == wanted).all()


def test_lines_of_sight_are_stopped_by_points() -> None:
    surface = cloud(np.array([[0.0, 0.0, 5.0]]), 0.5)
    eyes = np.array([[-10.0, 0.0, 5.0], [-10.0, 0.0, 5.6], [0.0, 0.0, 20.0], [-10.0, 0.0, 5.0]])
    ends = np.array([[10.0, 0.0, 5.0], [10.0, 0.0, 5.6], [0.0, 0.0, 0.0], [-0.4, 0.0, 5.0]])
    assert lines_hidden(surface, eyes, ends).tolist() == [True, False, True, False]
    assert not lines_hidden(replace(surface, disc=0.0), eyes, ends).any()


def test_a_scanned_wall_hides_what_the_wall_does() -> None:
    side = np.arange(-4.0, 4.001, 0.1)
    y, z = (axis.ravel() for axis in np.meshgrid(side, side + 4.0))
    surface = cloud(np.column_stack([np.zeros(len(y)), y, z]), 0.2)
    eyes = np.column_stack([np.full(50, -30.0), np.linspace(-30.0, 30.0, 50), np.linspace(1.0, 20.0, 50)])
    boards = billboards(eyes, np.tile([20.0, 0.0, 4.0], (50, 1)), 3.0, 3.0)
    rays, starts = cells_of(boards, N), np.repeat(eyes, N * N, axis=0)
    share = -starts[:, 0] / (rays - starts)[:, 0]
    met = starts + share[:, None] * (rays - starts)
    behind = ((np.abs(met[:, 1]) <= 4.0) & (np.abs(met[:, 2] - 4.0) <= 4.0)).reshape(-1, N, N)
    found = hidden(surface, boards, N)
    assert behind.any()
    assert found[behind].all()
    assert (found != behind).mean() < 0.05
