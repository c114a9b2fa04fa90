"""First hits of rays against every triangle in turn, and rays that find no seam to slip through."""

from __future__ import annotations

import numpy as np
import pytest

from shotc.geom.surface import hits
from shotc.geom.surface.boards import Billboards
from shotc.geom.surface.hits import NOTHING, first_hits
from shotc.geom.surface.tree import surface_of
from tests.support.meshes import sphere_mesh
from tests.support.surfaces import some_triangles


def some_boards(random: np.random.Generator, count: int) -> Billboards:
    eye = random.uniform(-8, 8, (count, 3))
    corner = eye + random.normal(size=(count, 3))
    return Billboards(eye, corner, random.normal(size=(count, 3)), random.normal(size=(count, 3)))


def ways(boards: Billboards, n: int) -> np.ndarray:
    """Return the way to every cell's middle, (F, n, n, 3)."""
    middle = (np.arange(n) + 0.5) / n
    a, b = np.meshgrid(middle, middle, indexing="ij")
    at = boards.corner - boards.eye
    right, up = boards.right[:, None, None], boards.up[:, None, None]
    return at[:, None, None] + a[..., None] * right + b[..., None] * up


def broad(triangles: np.ndarray) -> np.ndarray:
    """Return the triangles that are no needles: by how little those are missed, nobody can tell."""
    sides = triangles[:, [1, 2, 0]] - triangles
    area = np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1)
    return triangles[area > 1e-3 * (sides**2).sum(axis=(1, 2))]


def solved(triangle: np.ndarray, eye: np.ndarray, way: np.ndarray) -> float:
    """Return at which share a way meets a triangle, by three equations."""
    a, b, c = triangle
    matrix = np.column_stack([b - a, c - a, -way])
    if abs(np.linalg.det(matrix)) < 1e-12:
        return np.inf
    s, t, share = np.linalg.solve(matrix, eye - a)
    return share if s >= 0 and t >= 0 and s + t <= 1 and share > 0 else np.inf


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(4))
def test_a_ray_meets_the_triangle_that_brute_force_finds(seed):
    random = np.random.default_rng(seed)
    triangles = broad(some_triangles(random, 80))
    surface, boards = surface_of(triangles), some_boards(random, 5)
    found = first_hits(surface, boards, 4)
    for f, i, j in np.ndindex(found.share.shape):
        shares = [solved(t, boards.eye[f], ways(boards, 4)[f, i, j]) for t in surface.triangles]
        assert found.share[f, i, j] == pytest.approx(min(shares), rel=1e-6)
        if np.isfinite(min(shares)):
            assert shares[found.triangle[f, i, j]] == pytest.approx(min(shares), rel=1e-6)
        else:
            assert found.triangle[f, i, j] == NOTHING


@pytest.mark.slow
def test_no_ray_leaves_a_closed_ball():
    surface = surface_of(sphere_mesh(10.0))
    boards = some_boards(np.random.default_rng(5), 30)
    inside = Billboards(boards.eye * 0.3, boards.corner - 0.7 * boards.eye, boards.right, boards.up)
    found = first_hits(surface, inside, 16)
    assert np.isfinite(found.share).all()
    met = inside.eye[:, None, None] + found.share[..., None] * ways(inside, 16)
    assert np.linalg.norm(met, axis=-1) == pytest.approx(10.0, rel=0.01)


@pytest.mark.parametrize("seed", range(3))
def test_points_are_discs(seed):
    random = np.random.default_rng(seed)
    points = random.uniform(-10, 10, (200, 3))
    surface, boards = surface_of(np.repeat(points[:, None], 3, axis=1)), some_boards(random, 4)
    assert not np.isfinite(first_hits(surface, boards, 4).share).any()
    found = first_hits(surface, boards, 4, disc=0.8)
    lines = ways(boards, 4)
    for f, i, j in np.ndindex(found.share.shape):
        way, away = lines[f, i, j], surface.triangles[:, 0] - boards.eye[f]
        share = away @ way / (way @ way)
        off = np.linalg.norm(away - share[:, None] * way, axis=1)
        best = np.where((off <= 0.8) & (share > 0), share, np.inf)
        assert found.share[f, i, j] == pytest.approx(best.min(), rel=1e-9)
    assert np.isfinite(found.share).any()


def test_a_triangle_without_area_is_no_point():
    ends = np.array([[5.0, -9.0, 0.0], [5.0, 9.0, 0.0]])
    towards = Billboards(
        np.zeros((1, 3)), np.array([[5.0, -9.0, -1.0]]), np.array([[0.0, 18.0, 0.0]]), np.array([[0, 0, 2.0]])
    )
    for which in ([0, 0, 1], [0, 1, 0], [1, 0, 0]):
        assert not np.isfinite(first_hits(surface_of(ends[which][None]), towards, 6, disc=3.0).share).any(), (
            which
        )


def test_frames_that_are_looked_at_one_after_another_are_those_of_all_at_once(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    random = np.random.default_rng(9)
    surface, boards = surface_of(some_triangles(random, 80)), some_boards(random, 7)
    whole = first_hits(surface, boards, 4)
    monkeypatch.setattr(hits, "FRAMES_AT_ONCE", 3)
    monkeypatch.setattr(hits, "PAIRS_AT_ONCE", 5)
    parts = first_hits(surface, boards, 4)
    assert np.array_equal(parts.share, whole.share)
    assert np.array_equal(parts.triangle, whole.triangle)
    assert np.isfinite(whole.share[3:]).any()
