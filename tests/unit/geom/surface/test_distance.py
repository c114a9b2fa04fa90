"""Distances from surfaces: proven bounds against brute force and known values, searches against all pairs."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh
from hypothesis import example, given, settings
from hypothesis import strategies as st

from shotc.geom.bernstein import Piecewise
from shotc.geom.pieces import Pieces, pieces
from shotc.geom.surface import distance, near
from shotc.geom.surface.distance import inf_distance
from shotc.geom.surface.near import comes_within, nearest, within
from shotc.geom.surface.tree import LEAF_TRIANGLES, TooMany, search, surface_of
from shotc.geom.surface.triangles import closest, halved, segment_distances
from tests.support.few import examples
from tests.support.surfaces import distances, grid, line, orbit, samples, some_curve, some_triangles

GAP = 5e-7
seeds = st.integers(0, 2**32 - 1)


def fine(_best: float) -> float:
    return GAP


def sphere(radius: float, depth: int = 4) -> np.ndarray:
    return np.asarray(trimesh.creation.icosphere(depth, radius=radius).triangles)


@pytest.mark.slow
@settings(max_examples=examples(80, 300))
@given(seeds, st.integers(1, 40))
def test_the_proven_distance_is_never_above_brute_force_and_within_a_millimetre(seed: int, count: int):
    random = np.random.default_rng(seed)
    triangles, curve = some_triangles(random, count), some_curve(random)
    found = inf_distance(pieces(curve), surface_of(triangles), fine)
    seen = distances(triangles, samples(curve, 301)).min()
    assert found.proven <= seen + 1e-12
    assert found.attained - GAP <= found.proven <= found.attained
    there = distances(triangles[[found.triangle]], curve(np.array([found.at])))
    assert there == pytest.approx(found.attained, abs=1e-9)
    assert curve.breaks[found.piece] <= found.at <= curve.breaks[found.piece + 1]
    # Between samples nothing is nearer than the way to the next one allows.
    steps = np.linalg.norm(np.diff(samples(curve, 301), axis=0), axis=1).max()
    assert seen <= found.attained + steps


@pytest.mark.parametrize("seed", range(6))
def test_a_coarse_gap_leaves_the_bound_below_all_that_is_flown(seed: int):
    random = np.random.default_rng(seed)
    triangles, curve = some_triangles(random, 12), some_curve(random)
    found = inf_distance(pieces(curve), surface_of(triangles), lambda best: 0.8 * best)
    seen = distances(triangles, samples(curve, 201)).min()
    assert 0.2 * found.attained - 1e-9 <= found.proven <= seen + 1e-12
    assert found.attained >= seen - 0.1


def test_a_circle_about_a_sphere_is_as_far_as_their_radii_say():
    found = inf_distance(pieces(orbit(12.0, 0.0)), surface_of(sphere(10.0)), fine)
    assert found.proven == pytest.approx(2.0, abs=0.002)
    assert found.attained - found.proven <= GAP


def test_a_straight_way_above_a_corner_is_nearest_where_it_passes_it():
    corner = np.array([[[0, 0, 0], [-1, 0, -5], [1, 0, -5]]], dtype=float)
    found = inf_distance(pieces(line((-3, 4, 0), (3, 4, 0))), surface_of(corner), fine)
    assert found.attained == pytest.approx(4.0, abs=1e-6)
    assert found.at == pytest.approx(0.5, abs=1e-3)


def test_a_way_along_ten_thousand_triangles_at_one_distance_is_proved():
    flat = grid(np.zeros((70, 70)), 2.0)
    found = inf_distance(pieces(line((3, 3, 1.5), (130, 110, 1.5), 20)), surface_of(flat.triangles), fine)
    assert found.proven == pytest.approx(1.5, abs=1e-9)


def test_a_way_through_a_surface_is_no_distance_from_it_and_ends_soon(monkeypatch: pytest.MonkeyPatch):
    rounds = []
    bounds = distance._Distances._bounds
    monkeypatch.setattr(distance._Distances, "_bounds", lambda *given: rounds.append(1) or bounds(*given))
    wall = grid(np.zeros((30, 30))).triangles
    found = inf_distance(pieces(line((10.3, 7.1, -2), (12.9, 20.2, 3))), surface_of(wall), fine)
    assert found.proven == 0.0
    assert found.attained <= GAP
    assert len(rounds) < 30


def test_inside_a_closed_surface_the_distance_has_no_sign():
    found = inf_distance(pieces(orbit(3.0, 0.0)), surface_of(sphere(10.0)), fine)
    assert found.proven == pytest.approx(7.0, abs=0.03)


def test_what_meets_too_many_boxes_at_once_is_bound_as_tight(monkeypatch: pytest.MonkeyPatch):
    centre, around = orbit(1e-3, 0.0, 6), surface_of(sphere(10.0, 3))
    long, rough = (
        line((1, 1, 4.5), (60, 50, 4.5)),
        surface_of(grid(np.random.default_rng(3).normal(size=(64, 64)) * 0.3).triangles),
    )
    free = [inf_distance(pieces(c), s, fine) for c, s in ((centre, around), (long, rough))]
    monkeypatch.setattr(distance, "OPEN_PIECES_LIMIT", 4000)
    tight = [inf_distance(pieces(c), s, fine) for c, s in ((centre, around), (long, rough))]
    for one, other in zip(free, tight, strict=True):
        assert abs(one.attained - other.attained) <= GAP
        assert other.attained - other.proven <= GAP


def test_a_bound_that_is_not_closed_is_still_proved(monkeypatch: pytest.MonkeyPatch):
    random = np.random.default_rng(5)
    triangles, curve = some_triangles(random, 60), some_curve(random)
    monkeypatch.setattr(distance, "MOST_HALVINGS", 1)
    found = inf_distance(pieces(curve), surface_of(triangles), fine)
    assert found.proven <= distances(triangles, samples(curve, 400)).min()
    assert np.isfinite(found.proven)


@pytest.mark.parametrize("reverse", [False, True])
def test_a_segment_comes_as_near_as_its_nearer_end_whichever_way_it_leads(reverse: bool):
    speck = np.array([[[0.0, 0.0, 0.0], [1e-3, 0.0, 0.0], [0.0, 1e-3, 0.0]]])
    ways = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) / np.sqrt(3.0)
    a, b = 0.4 * ways, 3.4 * ways
    ends = (b, a) if reverse else (a, b)
    assert comes_within(surface_of(speck), *ends, 0.402).all()
    assert not comes_within(surface_of(speck), *ends, 0.398).any()


@pytest.mark.parametrize("corner", range(3))
def test_a_long_triangle_is_halved_whichever_of_its_sides_is_long(corner: int):
    flat = grid(np.zeros((20, 20)), 1.0).triangles
    needle = np.roll(np.array([[0.0, 0.0, 5.0], [10.0, 0.1, 5.0], [20.0, 0.0, 5.0]]), corner, axis=0)
    surface = surface_of(np.concatenate([flat, needle[None]]))
    sides = surface.triangles[:, [1, 2, 0]] - surface.triangles
    assert np.linalg.norm(sides, axis=2).max() <= 8.0 * np.sqrt(2.0) + 1e-9
    halves = surface.triangles[surface.source == len(flat)]
    areas = np.linalg.norm(np.cross(halves[:, 1] - halves[:, 0], halves[:, 2] - halves[:, 0]), axis=1) / 2
    assert areas.sum() == pytest.approx(0.5 * 0.1 * 20.0)


def test_nothing_is_infinitely_far():
    none = surface_of(np.zeros((0, 3, 3)))
    curve = line((0, 0, 0), (1, 0, 0))
    bound = inf_distance(pieces(curve), none, fine)
    assert (bound.proven, bound.piece, bound.triangle) == (np.inf, -1, -1)
    bag = pieces(curve)
    nowhere = Pieces(bag.low[:0], bag.high[:0], bag.ctrl[:0])
    assert inf_distance(nowhere, surface_of(sphere(1.0, 1)), fine).proven == np.inf
    assert np.isinf(nearest(none, np.zeros((2, 3))).distance).all()
    assert not comes_within(none, np.zeros((1, 3)), np.ones((1, 3)), 5.0).any()
    assert not len(within(none, np.zeros((1, 3)), np.ones((1, 3)), 5.0))


@pytest.mark.parametrize("bad", [np.full((1, 3, 3), np.nan), np.zeros((4, 3)), np.zeros((2, 3, 2))])
def test_what_is_no_triangles_is_refused(bad: np.ndarray):
    with pytest.raises(ValueError, match="triangles are finite"):
        surface_of(bad)


@pytest.mark.slow
@settings(max_examples=60)
@given(seeds, st.integers(1, 300))
def test_nearest_points_are_those_of_all_triangles(seed: int, count: int):
    random = np.random.default_rng(seed)
    triangles, points = some_triangles(random, count), random.normal(size=(20, 3)) * 12
    surface = surface_of(triangles)
    found, expected = nearest(surface, points), distances(triangles, points)
    assert found.distance == pytest.approx(expected, abs=1e-9)
    assert np.linalg.norm(found.point - points, axis=1) == pytest.approx(expected, abs=1e-9)
    own = [distances(surface.triangles[[t]], p[None])[0] for t, p in zip(found.triangle, points, strict=True)]
    assert own == pytest.approx(expected, abs=1e-9)
    limited = nearest(surface, points, np.median(expected))
    near = expected < np.median(expected) - 1e-9
    assert limited.distance[near] == pytest.approx(expected[near], abs=1e-9)
    assert np.isinf(limited.distance[expected > np.median(expected) + 1e-9]).all()


def test_the_nearest_of_many_triangles_is_found_among_few(monkeypatch: pytest.MonkeyPatch):
    asked = []
    monkeypatch.setattr(near, "closest", lambda t, p: asked.append(len(t)) or closest(t, p))
    random = np.random.default_rng(3)
    balls = (
        sphere(5.0, 3) + np.append(random.uniform(-200, 200, (40, 2)), np.zeros((40, 1)), 1)[:, None, None]
    )
    points = random.uniform([-200, -200, 6], [200, 200, 60], (100, 3))
    nearest(surface_of(balls.reshape(-1, 3, 3)), points)
    assert sum(asked) < 60 * len(points)


@pytest.mark.slow
@settings(max_examples=60)
@given(seeds, st.integers(1, 60))
@example(0, 1)
def test_segments_come_as_near_as_their_points_do(seed: int, count: int):
    random = np.random.default_rng(seed)
    triangles = some_triangles(random, count)
    a, b = random.normal(size=(2, 6, 3)) * 9
    x = np.linspace(0.0, 1.0, 201)[:, None]
    dense = distances(triangles, (a + x[..., None] * (b - a)).reshape(-1, 3)).reshape(201, 6).min(axis=0)
    exact = np.array(
        [
            segment_distances(triangles, np.tile(p, (count, 1)), np.tile(q, (count, 1))).min()
            for p, q in zip(a, b, strict=True)
        ]
    )
    assert (exact <= dense + 1e-9).all()
    assert (dense <= exact + np.linalg.norm(b - a, axis=1) / 200).all()
    surface = surface_of(triangles)
    assert comes_within(surface, a, b, exact + 1e-6).all()
    clear = exact > 1e-6
    assert not comes_within(surface, a[clear], b[clear], exact[clear] - 1e-6).any()


def test_boxes_find_all_triangles_that_are_near():
    random = np.random.default_rng(8)
    surface = surface_of(some_triangles(random, 500))
    low = random.normal(size=(30, 3)) * 5
    high = low + random.uniform(0, 3, size=(30, 3))
    found = within(surface, low, high, 0.7)
    their_low, their_high = surface.triangles.min(axis=1), surface.triangles.max(axis=1)
    apart = np.maximum(np.maximum(their_low - high[:, None], low[:, None] - their_high), 0.0)
    expected = np.argwhere(np.linalg.norm(apart, axis=2) < 0.7)
    assert sorted(zip(found.item, found.triangle, strict=True)) == sorted(map(tuple, expected))


def test_long_triangles_are_halved_and_know_what_they_are_of():
    village = np.concatenate([some_triangles(np.random.default_rng(2), 400) * 0.1, _quad(300.0)])
    surface = surface_of(village)
    assert len(village) < len(surface) < 20_000
    assert set(surface.source) == set(range(len(village)))
    longest = np.linalg.norm(surface.triangles - np.roll(surface.triangles, 1, axis=1), axis=2).max()
    assert longest < 20.0
    points = np.random.default_rng(4).uniform(-140, 140, size=(50, 3))
    assert nearest(surface, points).distance == pytest.approx(distances(village, points), abs=1e-9)


@pytest.mark.parametrize("longest", [0.5, 3.0, 10.0])
def test_halves_have_no_edge_that_is_longer_and_are_no_smaller_than_they_must(longest: float):
    cut = halved(_quad(8.0), longest).triangles
    edges = np.linalg.norm(cut - np.roll(cut, 1, axis=1), axis=2)
    assert edges.max() <= longest
    # A right isosceles triangle is cut into two: its longest edge is divided by the root of two.
    assert edges.max() > longest / np.sqrt(2) * (1 - 1e-9)


def test_halves_cover_their_triangle():
    triangle = _quad(8.0)[:1]
    cut = halved(triangle, 1.0)
    areas = np.linalg.norm(
        np.cross(cut.triangles[:, 1] - cut.triangles[:, 0], cut.triangles[:, 2] - cut.triangles[:, 0]), axis=1
    )
    assert areas.sum() == pytest.approx(64.0)
    assert set(cut.source) == {0}


def test_a_search_that_meets_more_pairs_than_allowed_stops():
    surface = surface_of(sphere(1.0, 3))

    def everything(item: np.ndarray, _low: np.ndarray, _high: np.ndarray) -> np.ndarray:
        return np.ones(len(item), dtype=bool)

    assert len(search(surface, 2, everything)) == 2 * len(surface)
    with pytest.raises(TooMany):
        search(surface, 2, everything, most=LEAF_TRIANGLES * 20)


def test_pieces_of_any_degree_are_bound():
    straight = Piecewise(np.array([0.0, 1.0]), np.array([[[-5.0, 0.0, 3.0], [5.0, 0.0, 3.0]]]))
    found = inf_distance(pieces(straight), surface_of(_quad(8.0)), fine)
    assert found.proven == pytest.approx(3.0, abs=1e-6)


def _quad(size: float) -> np.ndarray:
    s = 0.5 * size
    return np.array([[[-s, -s, 0], [s, -s, 0], [s, s, 0]], [[-s, -s, 0], [s, s, 0], [-s, s, 0]]], dtype=float)


def test_a_surface_cannot_be_changed_by_who_looks_at_it():
    surface = surface_of(sphere(2.0, 2))
    assert len(surface.low) > 1
    for array in (surface.triangles, surface.source, *surface.low, *surface.high):
        assert not array.flags.writeable
