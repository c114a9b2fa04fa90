"""Columns through closed shapes: volumes by formula, points spread evenly."""

from __future__ import annotations

import numpy as np
import pytest

from shotc.geom.bernstein import Array
from shotc.show.geom.columns import (
    ColumnPieces,
    column_at,
    columns_below,
    drawn,
    spans,
    through_edges,
    through_triangles,
    united,
    volume,
)
from tests.support.meshes import box_mesh, sphere_mesh


def inside_of(corners: Array, count: int = 4000, parity: bool = False):
    low, high = corners[:, :, :2].min(axis=(0, 1)), corners[:, :, :2].max(axis=(0, 1))
    columns = columns_below(low, high, count, np.random.default_rng(0))
    return columns, spans(through_triangles(columns, corners), parity)


@pytest.mark.parametrize("parity", [False, True])
def test_the_volume_of_a_box(parity: bool) -> None:
    columns, inside = inside_of(box_mesh((0, 0, 5), (2, 3, 4)), parity=parity)
    assert volume(columns, inside) == pytest.approx(24.0)


def test_a_ball_is_filled_evenly() -> None:
    columns, inside = inside_of(sphere_mesh(10.0))
    assert volume(columns, inside) == pytest.approx(4 / 3 * np.pi * 1000, rel=0.02)
    points = drawn(columns, inside, 20_000, np.random.default_rng(1))
    share = (np.linalg.norm(points, axis=1)[:, None] < np.array([2.5, 5, 7.5])).mean(axis=0)
    assert share == pytest.approx(np.array([2.5, 5, 7.5]) ** 3 / 1000, abs=0.012)
    assert np.abs(points.mean(axis=0)).max() < 0.1


def test_bodies_that_overlap_are_one() -> None:
    both = np.concatenate([box_mesh((0, 0, 0), (2, 2, 2)), box_mesh((1, 0, 0), (2, 2, 2))])
    columns, inside = inside_of(both)
    assert volume(columns, inside) == pytest.approx(12.0, rel=0.02)


def test_a_box_in_a_box_turned_inside_out_is_hollow() -> None:
    shell = np.concatenate([box_mesh((0, 0, 0), (4, 4, 4)), box_mesh((0, 0, 0), (2, 2, 2))[:, ::-1]])
    columns, inside = inside_of(shell)
    assert volume(columns, inside) == pytest.approx(64 - 8, rel=0.02)
    assert not len(spans(through_triangles(column_at(np.array([9.0, 0.0])), shell), False).low)


def test_where_a_single_column_enters_and_leaves() -> None:
    inside = spans(through_triangles(column_at(np.array([0.3, 0.1])), box_mesh((0, 0, 5), (2, 3, 4))), False)
    assert (inside.low[0], inside.high[0]) == pytest.approx((3.0, 7.0))


def test_a_ring_of_edges_by_winding_and_by_parity() -> None:
    outer = np.array([[0.0, 0], [4, 0], [4, 4], [0, 4]])
    edges = np.concatenate([np.stack([s, np.roll(s, -1, axis=0)], axis=1) for s in (outer, outer / 2 + 1)])
    columns = columns_below(np.array([0.0]), np.array([4.0]), 2000, np.random.default_rng(0))
    met = through_edges(columns, edges)
    assert volume(columns, spans(met, False)) == pytest.approx(16.0)
    assert volume(columns, spans(met, True)) == pytest.approx(12.0, rel=1e-3)


def test_spans_that_overlap_unite() -> None:
    a = ColumnPieces(np.array([0, 1]), np.array([0.0, 0]), np.array([2.0, 1]))
    b = ColumnPieces(np.array([0, 1]), np.array([1.0, 3]), np.array([4.0, 5]))
    both = united([a, b])
    assert np.bincount(both.column, both.high - both.low).tolist() == [4.0, 3.0]


def test_many_faces_in_parts_are_the_same_as_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    whole = inside_of(sphere_mesh(3.0))[1]
    monkeypatch.setattr("shotc.show.geom.columns.CHUNK_FACES", 500)
    assert np.array_equal(inside_of(sphere_mesh(3.0))[1].high, whole.high)


@pytest.mark.parametrize(
    ("size", "count", "counts"),
    [((10.0, 10.0), 100, (10, 10)), ((10.0, 0.001), 10, (10, 1)), ((4.0,), 7, (7,)), ((0.0, 3.0), 5, (1, 5))],
)
def test_cells_are_about_square_and_a_thin_side_has_one(size, count: int, counts: tuple[int, ...]) -> None:
    found = columns_below(np.zeros(len(size)), np.array(size), count, np.random.default_rng(0))
    assert found.counts == counts
    assert found.cell * found.counts == pytest.approx(np.maximum(size, 1e-9 * max(1.0, *size, 1.0)))
    assert len(found.places) == np.prod(counts)
