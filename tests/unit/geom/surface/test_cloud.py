"""Clouds as surfaces: every point is within what stands for it, and their spacing is the true one."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial import cKDTree

from shotc.geom.surface import cloud
from shotc.geom.surface.cloud import cloud_of, median_spacing, splats
from shotc.geom.surface.tree import surface_of


@pytest.mark.parametrize("seed", range(4))
def test_the_spacing_is_that_of_nearest_neighbours(seed, monkeypatch):
    monkeypatch.setattr(cloud, "_SAMPLED_POINTS", 10_000)
    random = np.random.default_rng(seed)
    points = np.concatenate([random.normal(size=(900, 3)), random.uniform(-9, 9, (600, 3))])
    true = cKDTree(points).query(points, k=2)[0][:, 1]
    assert median_spacing(cloud_of(points).surface) == pytest.approx(np.median(true), abs=1e-12)


def test_points_at_one_place_do_not_count_as_neighbours():
    points = np.repeat(np.array([[0.0, 0, 0], [3, 0, 0], [6, 0, 0], [9, 0, 0]]), 3, axis=0)
    assert median_spacing(cloud_of(points).surface) == pytest.approx(3.0)
    assert median_spacing(surface_of(np.zeros((5, 3, 3)))) == 0.0


@pytest.mark.parametrize("most", [20, 300])
def test_a_thinned_cloud_stands_for_every_point(most, monkeypatch):
    monkeypatch.setattr(cloud, "MOST_POINTS", most)
    random = np.random.default_rng(3)
    points = random.uniform(-20, 20, (4_000, 3)) * [1, 1, 0.1]
    thin = cloud_of(points)
    assert len(thin.surface) <= most
    away = cKDTree(thin.surface.triangles[:, 0]).query(points)[0].max()
    assert 0.0 < away <= thin.moved


def test_a_cell_is_represented_by_the_middle_of_its_points() -> None:
    points = np.array([[1.5, 2.0, 3.0], [2.5, 2.5, 4.0], [9.0, 9.0, 9.0]])
    found = splats(points, 2.0, 10)
    assert found.middle.tolist() == [[2.0, 2.25, 3.5], [9.0, 9.0, 9.0]]
    assert (found.first.tolist(), found.size) == ([0, 2], 2.0)


def test_cells_differ_in_each_coordinate() -> None:
    corners = np.stack(np.meshgrid([0.0, 2.5], [0.0, 3.0], [0.0, 2.25]), axis=-1).reshape(-1, 3)
    found = splats(np.concatenate([corners, corners + 0.5]), 2.0, 10)
    assert sorted(found.middle.tolist()) == sorted((corners + 0.25).tolist())
