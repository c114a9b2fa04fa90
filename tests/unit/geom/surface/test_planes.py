"""Half-spaces before triangles and above ground: who keeps them keeps the clearance, and they cost little."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import linprog, nnls

from shotc.geom.pieces import Pieces
from shotc.geom.surface import planes
from shotc.geom.surface.distance import inf_distance
from shotc.geom.surface.ground import Ground, ground_of
from shotc.geom.surface.ground_planes import ground_planes
from shotc.geom.surface.height import inf_height
from shotc.geom.surface.planes import Planes, half_spaces, separate
from shotc.geom.surface.tree import surface_of
from tests.support.surfaces import grid, some_triangles

seeds = st.integers(0, 2**32 - 1)
CLEARANCE, REACH = 0.6, 5.0


def some(slack: np.ndarray) -> np.ndarray:
    """What a planner keeps beyond its clearances."""
    return np.minimum(0.5, 0.5 * np.maximum(slack, 0.0))


def nothing(slack: np.ndarray) -> np.ndarray:
    return np.zeros_like(slack)


def put_inside(ctrl: np.ndarray, normal: np.ndarray, offset: np.ndarray) -> np.ndarray | None:
    """Points (m, 3) moved until they keep half-spaces, by projection; None where that takes long."""
    for _ in range(200):
        lack = offset - ctrl @ normal.T
        if not lack.size or lack.max() <= 0.0:
            return ctrl
        point, row = np.unravel_index(lack.argmax(), lack.shape)
        ctrl = ctrl.copy()
        ctrl[point] += normal[row] * (lack[point, row] + 1e-9)
    return None


def of_piece(found: Planes, piece: int) -> tuple[np.ndarray, np.ndarray]:
    return found.normal[found.piece == piece], found.offset[found.piece == piece]


def alone(ctrl: np.ndarray) -> Pieces:
    return Pieces(np.zeros(1), np.ones(1), ctrl[None])


@pytest.mark.long
@settings(max_examples=60)
@given(seeds, st.sampled_from([2, 6]))
def test_a_piece_whose_points_keep_its_planes_keeps_the_clearance(seed: int, points: int):
    random = np.random.default_rng(seed)
    surface = surface_of(some_triangles(random, 60) * 2.0)
    start = random.normal(size=(4, 1, 3)) * 12
    hulls = start + np.cumsum(random.normal(size=(4, 6, 3)) * 0.4, axis=1)
    found = half_spaces(surface, hulls if points == 6 else hulls[:, [0, -1]], CLEARANCE, REACH, some)
    assert np.linalg.norm(found.normal, axis=1) == pytest.approx(1.0)
    for piece in np.flatnonzero(~found.crowded):
        moved = hulls[piece] + random.normal(size=(6, 3)) * 0.5
        moved = put_inside(moved, *of_piece(found, piece))
        if moved is None or np.abs(moved - hulls[piece]).max() > 2.0:
            continue  # farther than the planes reach
        far = inf_distance(alone(moved), surface, lambda _: 1e-7)
        assert far.proven >= CLEARANCE - 1e-6


@pytest.mark.slow
@settings(max_examples=40)
@given(seeds, st.sampled_from([2, 6]))
def test_a_gap_is_nearly_the_distance_and_never_more(seed: int, points: int):
    random = np.random.default_rng(seed)
    triangles, hulls = some_triangles(random, 40), random.normal(size=(40, points, 3)) * 2
    hulls += random.normal(size=(40, 1, 3)) * 6
    normal, gap = separate(triangles, hulls)
    apart = np.array([_apart(*both) for both in zip(triangles, hulls, strict=True)])
    assert (gap <= apart + 1e-6).all()
    clear = apart > 0.01
    near = gap[clear] > 0.99 * apart[clear]
    assert near.all() if points == 2 else near.mean() > 0.9
    least = np.einsum("kmd,kd->km", hulls, normal).min(axis=1)
    assert least - np.einsum("kvd,kd->kv", triangles, normal).max(axis=1) == pytest.approx(gap)


def _apart(triangle: np.ndarray, hull: np.ndarray) -> float:
    """The distance of a triangle from a hull, as least squares in the shares of their corners."""
    sums = 1e3 * np.array([[1.0] * len(hull) + [0.0] * 3, [0.0] * len(hull) + [1.0] * 3])
    shares, _ = nnls(np.vstack([np.hstack([hull.T, -triangle.T]), sums]), np.array([0, 0, 0, 1e3, 1e3]))
    of_hull, of_triangle = shares[: len(hull)], shares[len(hull) :]
    return float(np.linalg.norm(of_hull @ hull / of_hull.sum() - of_triangle @ triangle / of_triangle.sum()))


def test_a_chord_beside_a_wall_needs_one_plane_however_many_triangles_the_wall_has():
    flat = grid(np.zeros((40, 40)))
    wall = surface_of(flat.triangles[..., [0, 2, 1]])  # upright, in the plane y = 0
    chord = np.array([[[10.0, -3.0, 15.0], [25.0, -2.0, 18.0]]])
    found = half_spaces(wall, chord, 1.0, REACH, nothing)
    assert len(found.piece) == 1
    assert found.normal[0] == pytest.approx([0.0, -1.0, 0.0], abs=1e-9)
    assert found.offset[0] == pytest.approx(1.0)
    with_margin = half_spaces(wall, chord, 1.0, REACH, some)
    assert with_margin.offset[0] == pytest.approx(1.5)


def test_a_chord_through_a_triangle_is_as_deep_as_its_lower_end_is_below_it() -> None:
    turn = np.linalg.qr(np.random.default_rng(5).normal(size=(3, 3)))[0]
    triangle = np.array([[-9.0, -7.0, 0.0], [8.0, -9.0, 0.0], [1.0, 9.0, 0.0]])
    chord = np.array([[0.0, 0.0, 1.0], [0.3, 0.4, -0.2]])
    normal, gap = separate((triangle @ turn)[None], (chord @ turn)[None])
    assert gap == pytest.approx([-0.2])
    assert normal[0] == pytest.approx(turn[2])


@pytest.mark.parametrize(("axis", "most"), [(0, 1.0), (1, 2.0), (2, 3.0)])
def test_a_triangle_reaches_as_far_as_its_farthest_corner(axis: int, most: float):
    triangle = np.diag([1.0, 2.0, 3.0])
    for sign, far in ((1.0, most), (-1.0, 0.0)):
        assert planes.support(triangle[None], sign * np.eye(3)[axis][None]) == pytest.approx([far])


def test_what_is_far_needs_no_plane():
    ball = surface_of(np.asarray(trimesh.creation.icosphere(2, radius=3.0).triangles))
    found = half_spaces(ball, np.array([[[20.0, 0, 0], [20.0, 5, 0]]]), 1.0, REACH, some)
    assert not len(found.piece)
    assert not found.crowded.any()


def test_planes_know_the_triangle_they_are_of():
    two = np.array([[[9, 0, 0], [9, 1, 0], [9, 0, 1]], [[-9, 0, 0], [-9, 1, 0], [-9, 0, 1]]], dtype=float)
    found = half_spaces(surface_of(two), np.array([[[6.0, 0, 0], [6.0, 1, 0]]]), 1.0, REACH, some)
    assert list(found.triangle) == [0]


def test_a_piece_that_is_too_near_gets_a_plane_at_the_full_clearance():
    flat = surface_of(grid(np.zeros((9, 9))).triangles)
    found = half_spaces(flat, np.array([[[3.3, 3.1, 0.2], [5.2, 5.6, 0.3]]]), 1.0, REACH, some)
    assert found.normal[0] == pytest.approx([0, 0, 1.0])
    assert found.offset[0] == pytest.approx(1.0)


def test_a_piece_among_too_many_triangles_is_told(monkeypatch: pytest.MonkeyPatch):
    random = np.random.default_rng(4)
    heap = surface_of(random.uniform(-4, 4, size=(300, 1, 3)) + random.normal(size=(300, 3, 3)) * 0.2)
    monkeypatch.setattr(planes, "MOST_PLANES", 3)
    hulls = np.array([[[0.0, 0, 0], [1, 0, 0]], [[60.0, 0, 0], [61, 0, 0]]])
    found = half_spaces(heap, hulls, 0.5, REACH, some)
    assert list(found.crowded) == [True, False]
    assert (np.bincount(found.piece) <= 3).all()


def land(seed: int, size: int = 14) -> Ground:
    found = grid(np.random.default_rng(seed).normal(size=(size, size)) * 2.0, 3.0)
    return ground_of(found.corners, found.faces)


@pytest.mark.long
@settings(max_examples=60)
@given(seeds, st.floats(0.0, 6.0))
def test_a_piece_that_keeps_its_ground_plane_keeps_its_height(seed: int, width: float):
    random = np.random.default_rng(seed)
    ground = land(seed)
    hulls = random.uniform(8.0, 30.0, size=(3, 1, 3)) + random.normal(size=(3, 6, 3))
    found = ground_planes(ground, hulls, width, 2.0, nothing)
    assert list(found.piece) == [0, 1, 2]
    assert not found.crowded.any()
    for piece, hull in enumerate(hulls):
        normal, offset = of_piece(found, piece)
        low, high = hull[:, :2].min(axis=0) - width, hull[:, :2].max(axis=0) + width
        moved = hull.copy()
        moved[:, :2] = random.uniform(low, high, size=(6, 2))
        moved[:, 2] = (offset[0] - moved[:, :2] @ normal[0, :2]) / normal[0, 2]
        above = inf_height(alone(moved), ground, lambda _: 1e-7)
        assert not hasattr(above, "by")
        assert above.proven >= 2.0 - 1e-6


@pytest.mark.long
@settings(max_examples=40)
@given(seeds)
def test_no_plane_above_the_ground_leaves_a_piece_more_room(seed: int):
    random = np.random.default_rng(seed)
    ground = land(seed)
    hulls = random.uniform(8.0, 30.0, size=(2, 1, 3)) + random.normal(size=(2, 6, 3)) * 2
    found = ground_planes(ground, hulls, 2.0, 0.0, nothing)
    for piece, hull in enumerate(hulls):
        normal, offset = of_piece(found, piece)
        room = ((hull @ normal[0] - offset[0]) / normal[0, 2]).min()
        assert room == pytest.approx(_most_room(ground, hull, 2.0), abs=1e-5)


def _most_room(ground: Ground, hull: np.ndarray, width: float) -> float:
    """By HiGHS, with the ground's points drawn densely over the box: a little more than there is."""
    low, high = hull[:, :2].min(axis=0) - width, hull[:, :2].max(axis=0) + width
    points = []
    for triangle in ground.surface.triangles:
        polygon = triangle
        for axis in (0, 1):
            for sign, border in ((1.0, low[axis]), (-1.0, -high[axis])):
                polygon = _clipped(polygon, axis, sign, border)
        points.append(polygon)
    q = np.concatenate(points)
    above = np.column_stack([q[:, :2], np.ones(len(q)), np.zeros(len(q))])
    below = np.column_stack([hull[:, :2], np.ones(len(hull)), np.ones(len(hull))])
    rows, limits = np.concatenate([-above, below]), np.concatenate([-q[:, 2], hull[:, 2]])
    found = linprog([0, 0, 0, -1], A_ub=rows, b_ub=limits, bounds=[(None, None)] * 4)
    return float(found.x[3])


def _clipped(polygon: np.ndarray, axis: int, sign: float, border: float) -> np.ndarray:
    """What of a polygon is beyond a border (Sutherland and Hodgman 1974)."""
    kept = []
    for a, b in zip(polygon, np.roll(polygon, -1, axis=0), strict=True):
        one, other = sign * a[axis] - border, sign * b[axis] - border
        if one >= 0:
            kept.append(a)
        if one * other < 0:
            kept.append(a + one / (one - other) * (b - a))
    return np.array(kept).reshape(-1, 3)


def test_the_ground_plane_of_a_slope_is_the_slope():
    x = np.arange(30.0)
    slope = grid(np.tile(0.5 * x[:, None], (1, 30)))
    hull = np.array([[[10.0, 10, 12], [14.0, 12, 13]]])
    found = ground_planes(ground_of(slope.corners, slope.faces), hull, 2.0, 1.5, nothing)
    assert found.normal[0] == pytest.approx(np.array([-0.5, 0, 1]) / np.hypot(0.5, 1), abs=1e-9)
    assert found.offset[0] == pytest.approx(1.5 / np.hypot(0.5, 1), abs=1e-9)
    with_margin = ground_planes(ground_of(slope.corners, slope.faces), hull, 2.0, 1.5, some)
    assert with_margin.offset[0] == pytest.approx(2.0 / np.hypot(0.5, 1), abs=1e-9)


@pytest.mark.parametrize(("far", "level"), [(80.0, 3.0), (-80.0, 0.0)])
def test_ground_beside_the_box_of_a_piece_lifts_its_plane_only_by_what_is_inside(far: float, level: float):
    """Two faces rise or fall beyond a box of 6 m: of a valley its edges count, of a roof its top."""
    edge = np.array([[0.0, -200.0, 0.0], [0.0, 200.0, 0.0]])
    corners = np.array([*edge, [80.0, 0.0, far], [-80.0, 0.0, far]])
    ground = ground_of(corners, np.array([[0, 2, 1], [0, 1, 3]]))
    hull = np.array([[[-2.0, -1.0, 9.0], [2.0, -1.0, 9.0], [0.0, 1.0, 9.0]]])
    found = ground_planes(ground, hull, 1.0, 0.5, nothing)
    assert found.normal[0] == pytest.approx([0.0, 0.0, 1.0], abs=1e-6)
    assert found.offset[0] == pytest.approx(level + 0.5)


def test_where_there_is_no_ground_there_is_no_ground_plane():
    hulls = np.array([[[90.0, 0, 5], [95.0, 0, 5]], [[10.0, 10, 5], [12.0, 10, 5]]])
    found = ground_planes(land(1), hulls, 1.0, 0.0, nothing)
    assert list(found.piece) == [1]
    assert not len(ground_planes(land(1), hulls[:1], 1.0, 0.0, nothing).piece)
