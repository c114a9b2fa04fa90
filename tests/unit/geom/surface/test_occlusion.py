"""What hides billboards: walls of known size, all rays against all triangles, seams, how near shares are."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st

from shotc.geom.surface import occlusion
from shotc.geom.surface.boards import Billboards, billboards, cells_of, upright
from shotc.geom.surface.occlusion import candidates, hidden
from shotc.geom.surface.tree import Surface, surface_of
from tests.support.surfaces import grid, some_triangles


def rectangle(y: float, x: tuple[float, float], z: tuple[float, float]) -> np.ndarray:
    """An upright wall across the line of sight North."""
    a, b, c, d = ([x[0], y, z[0]], [x[1], y, z[0]], [x[1], y, z[1]], [x[0], y, z[1]])
    return np.array([[a, b, c], [a, c, d]], dtype=float)


def north(distance: float = 20.0, size: float = 2.0) -> Billboards:
    """A square to the North of the origin, at the height of the eye."""
    return billboards(np.zeros((1, 3)), np.array([[0.0, distance, 0.0]]), size, size)


def facing_cylinders(eye: np.ndarray, centre: np.ndarray, radius: float, height: float) -> Billboards:
    """Return the least rectangles around the outlines of upright cylinders at centres (F, 3) from afar."""
    away = centre - eye
    far = np.maximum(np.linalg.norm(away, axis=1), 1e-300)
    upright = np.hypot(away[:, 0], away[:, 1]) / far
    shown = height * upright + 2.0 * radius * np.abs(away[:, 2]) / far
    return billboards(eye, centre, 2.0 * radius, shown)


def rays(boards: Billboards, n: int) -> np.ndarray:
    middle = (np.arange(n) + 0.5) / n
    points = boards.corner[:, None, None] + middle[:, None, None] * boards.right[:, None, None]
    return points + middle[:, None] * boards.up[:, None, None]


def by_all_pairs(triangles: np.ndarray, boards: Billboards, n: int) -> np.ndarray:
    """Every ray against every triangle (Möller and Trumbore 1997)."""
    eye, points = boards.eye[:, None, None, None], rays(boards, n)[:, :, :, None]
    way, a = points - eye, triangles[:, 0]
    one, other = triangles[:, 1] - a, triangles[:, 2] - a
    p = np.cross(way, other)
    with np.errstate(all="ignore"):
        scale = 1.0 / (p * one).sum(-1)
        from_a = eye - a
        u = (from_a * p).sum(-1) * scale
        q = np.cross(from_a, one)
        v, t = (way * q).sum(-1) * scale, (other * q).sum(-1) * scale
        return ((u >= 0) & (v >= 0) & (u + v <= 1) & (t > 0) & (t < 1 - 1e-6)).any(axis=-1)


@pytest.mark.slow
@settings(max_examples=80)
@given(st.integers(0, 2**32 - 1), st.integers(1, 80))
def test_the_same_rays_are_stopped_as_by_all_pairs(seed: int, count: int):
    random = np.random.default_rng(seed)
    triangles = some_triangles(random, count)
    eye, centre = random.normal(size=(2, 12, 3)) * 15
    boards = billboards(eye, centre, random.uniform(0.1, 8.0, 12), random.uniform(0.1, 8.0, 12))
    found, expected = hidden(surface_of(triangles), boards, 5), by_all_pairs(triangles, boards, 5)
    assert (found != expected).mean() < 0.002  # rays that graze an edge may differ


@pytest.mark.parametrize(
    ("wall", "share"), [((-5, 5), 1.0), ((0, 5), 0.5), ((-5, -0.5), 0.0), ((0.25, 5), 0.25)]
)
def test_a_wall_half_way_hides_what_it_covers(wall: tuple[float, float], share: float):
    found = hidden(surface_of(rectangle(10.0, wall, (-5, 5))), north(), 8)
    assert found.mean() == share
    if share == 0.5:  # the eastern half: cells count along right, then up
        assert found[0, 4:].all()
        assert not found[0, :4].any()


def test_a_wall_covers_the_upper_half():
    found = hidden(surface_of(rectangle(10.0, (-5, 5), (0, 5))), north(), 8)
    assert found[0, :, 4:].all()
    assert not found[0, :, :4].any()


@pytest.mark.parametrize("y", [-10.0, 20.0, 25.0])
def test_what_is_behind_the_eye_or_not_before_the_target_hides_nothing(y: float):
    assert not hidden(surface_of(rectangle(y, (-9, 9), (-9, 9))), north()).any()


def test_a_target_that_stands_on_the_ground_is_not_hidden_by_it():
    ground = surface_of(grid(np.zeros((80, 80))).triangles)
    eye, centre = np.array([[10.0, 10.0, 4.0]]), np.array([[60.0, 70.0, 0.95]])
    assert not hidden(ground, facing_cylinders(eye, centre, 0.4, 1.9 * 0.95)).any()
    assert hidden(ground, facing_cylinders(eye - [0, 0, 8], centre, 0.4, 1.9)).all()


def test_no_ray_slips_through_the_seams_of_a_closed_surface():
    ball = surface_of(np.asarray(trimesh.creation.icosphere(3, radius=5.0).triangles))
    eye = np.random.default_rng(1).normal(size=(200, 3))
    eye *= 30.0 / np.linalg.norm(eye, axis=1)[:, None]
    # Rays through the corners and the middles of sides, where three and more triangles meet.
    corners = np.unique(ball.triangles.reshape(-1, 3), axis=0)[:200]
    none = np.zeros((len(corners), 3))
    through = Billboards(eye[: len(corners)], eye[: len(corners)] + 3.0 * (corners * 0.5 - eye), none, none)
    assert hidden(ball, through, 1).all()


def test_a_target_seen_from_straight_above_has_its_width():
    boards = facing_cylinders(np.array([[3.0, 4.0, 50.0]]), np.array([[3.0, 4.0, 1.0]]), 0.4, 2.0)
    assert np.linalg.norm(boards.right) == pytest.approx(0.8)
    assert np.linalg.norm(boards.up) == pytest.approx(0.8)
    assert boards.corner + 0.5 * (boards.right + boards.up) == pytest.approx(np.array([[3.0, 4.0, 1.0]]))


def test_an_upright_rectangle_touches_the_side_of_its_cylinder_that_faces_the_eye():
    eye, centre = np.array([[13.0, 24.0, 50.0]]), np.array([[10.0, 20.0, 4.0]])
    board = upright(eye, centre, 2.5, 3.0)
    assert board.corner + 0.5 * (board.right + board.up) == pytest.approx(np.array([[11.5, 22.0, 4.0]]))
    assert np.abs(board.right) == pytest.approx(np.array([[4.0, 3.0, 0.0]]))
    assert board.up.tolist() == [[0.0, 0.0, 3.0]]


def test_a_target_seen_from_its_own_height_is_upright():
    boards = facing_cylinders(np.array([[0.0, -9.0, 1.0]]), np.array([[0.0, 0.0, 1.0]]), 0.4, 2.0)
    assert boards.right == pytest.approx(np.array([[0.8, 0.0, 0.0]]))
    assert boards.up == pytest.approx(np.array([[0.0, 0.0, 2.0]]))


@pytest.mark.long
def test_shares_of_sixty_four_rays_are_near_those_of_ten_thousand(monkeypatch: pytest.MonkeyPatch):
    random = np.random.default_rng(7)
    surface = _trunks(random)
    eye = np.column_stack([random.uniform(-60, 60, (150, 2)), random.uniform(1, 12, 150)])
    centre = np.column_stack([random.uniform(-60, 60, (150, 2)), np.full(150, 0.95)])
    boards = facing_cylinders(eye, centre, 0.4, 1.9)
    share = hidden(surface, boards).mean(axis=(1, 2))
    exact = hidden(surface, boards, 100).mean(axis=(1, 2))
    assert 0.05 < exact.mean() < 0.95
    assert np.abs(share - exact).mean() < 0.01
    monkeypatch.setattr(occlusion, "FRAMES_AT_ONCE", 7)
    monkeypatch.setattr(occlusion, "PAIRS_AT_ONCE", 5)
    assert (hidden(surface, boards).mean(axis=(1, 2)) == share).all()


def _trunks(random: np.random.Generator) -> Surface:
    trunk = np.asarray(trimesh.creation.cylinder(radius=0.5, height=12, sections=12).triangles)
    places = np.column_stack([random.uniform(-60, 60, (120, 2)), np.full(120, 6.0)])
    return surface_of((trunk + places[:, None, None]).reshape(-1, 3, 3))


def test_nothing_hides_nothing():
    assert not hidden(surface_of(np.zeros((0, 3, 3))), north()).any()
    nobody = Billboards(*np.zeros((4, 0, 3)))
    assert hidden(surface_of(rectangle(1, (0, 1), (0, 1))), nobody).shape == (0, 8, 8)


@pytest.mark.parametrize(
    ("half_width", "gap", "met"), [(0.01, 1e-4, False), (50.0, 2e-7, True), (1.0, -1e-3, True)]
)
def test_a_slope_behind_the_ends_of_all_rays_is_left_out_whatever_its_size(
    half_width: float, gap: float, met: bool
):
    """The plane z = y - c is as far behind the lowest middle of a cell, 0.75 m under the axis, as is told."""
    c = 20.0 + 0.75 + gap * np.sqrt(2.0)
    slope = [[-half_width, 19.9, 19.9 - c], [half_width, 19.9, 19.9 - c], [0.0, 21.0, 21.0 - c]]
    found = occlusion.in_the_way(surface_of(np.array([slope])), north(20.0, 2.0), 4)
    assert bool(len(found)) is met


@pytest.mark.parametrize("count", [8, 10, 12])
def test_frames_that_share_a_search_have_the_triangles_of_a_search_each(
    count: int, monkeypatch: pytest.MonkeyPatch
):
    """A camera that flies past one target: its frames are nearly alike."""
    surface = surface_of(some_triangles(np.random.default_rng(6), 90))
    eye = np.column_stack([np.linspace(30.0, 30.5, count), np.full(count, 1.0), np.full(count, 2.0)])
    boards = billboards(eye, np.tile([-9.0, 0.0, 0.0], (count, 1)), 4.0, 3.0)
    monkeypatch.setattr(occlusion, "GROUPED_FRAMES", 4)
    together = occlusion.candidates(surface, boards)
    monkeypatch.setattr(occlusion, "GROUPED_FRAMES", count)
    alone = occlusion.candidates(surface, boards)
    assert len(alone)
    found = [sorted(zip(p.item.tolist(), p.triangle.tolist(), strict=True)) for p in (together, alone)]
    assert found[0] == found[1]


@pytest.mark.parametrize("n", [1, 2, 7])
def test_a_pyramid_goes_through_the_outermost_middles_of_cells(n: int):
    random = np.random.default_rng(4)
    boards = Billboards(*random.normal(size=(4, 3, 3)))
    middles = cells_of(boards, n).reshape(3, n * n, 3) - boards.eye[:, None]
    found = occlusion._pyramids(boards, n)
    for frame in range(3):
        corners = middles[frame].reshape(n, n, 3)[[0, 0, -1, -1], [0, -1, 0, -1]]
        key = np.lexsort(corners.round(9).T), np.lexsort(found.ends[frame].round(9).T)
        assert found.ends[frame][key[1]] == pytest.approx(corners[key[0]])
    inside = np.einsum("fsd,fkd->fsk", found.sides, middles)
    assert inside.min() >= -1e-9


def speck(place: tuple[float, float, float]) -> np.ndarray:
    return np.array(place) + 1e-6 * np.array([[0.0, 0, 0], [1, 0, 0], [0, 0, 1]])


@pytest.mark.parametrize("inside", [True, False])
@pytest.mark.parametrize(
    ("place", "outwards", "far", "about"),
    [
        ((1.0, 10.0, 0.0), (1, 0, 0), 1.0, 0.0),  # half-way the box is half as wide and as high
        ((-1.0, 10.0, 0.0), (-1, 0, 0), 1.0, 0.0),
        ((0.0, 10.0, 0.5), (0, 0, 1), 1.0, 0.0),
        ((0.0, 10.0, -0.5), (0, 0, -1), 1.0, 0.0),
        ((0.0, 20.0, 0.0), (0, 1, 0), 1.0, 0.0),  # it ends at the board
        ((0.0, 0.0, 0.0), (0, -1, 0), 1.0, 0.0),  # it begins at the eye
        ((0.0, 10.0, 0.0), (0, 1, 0), 0.5, 0.0),
        ((1.33, 10.0, 0.0), (1, 0, 0), 1.0, 0.3),  # at share 10.3 / 20 it is 1.03 wide, and 0.3 are added
        ((0.0, -0.3, 0.0), (0, -1, 0), 1.0, 0.3),
    ],
)
def test_triangles_count_in_the_box_that_grows_from_the_eye_to_the_board(
    place: tuple[float, float, float], outwards: tuple[int, int, int], far: float, about: float, inside: bool
) -> None:
    board = billboards(np.zeros((1, 3)), np.array([[0.0, 20.0, 0.0]]), 4.0, 2.0)
    at = np.array(place) + (-0.01 if inside else 0.01) * np.array(outwards)
    found = candidates(surface_of(speck(tuple(at))[None]), board, far, about)
    assert len(found) == int(inside)


def test_frames_in_groups_have_the_candidates_that_each_has_alone() -> None:
    random = np.random.default_rng(5)
    surface = surface_of(some_triangles(random, 200))
    count = 3 * occlusion.GROUPED_FRAMES + 5
    eyes = np.array([-20.0, 0.0, 0.0]) + 0.05 * np.arange(count)[:, None] * np.array([0.0, 1.0, 0.5])
    boards = billboards(eyes, np.broadcast_to([20.0, 1.0, 0.0], (count, 3)), 3.0, 2.0)
    found = candidates(surface, boards)
    alone = [candidates(surface, boards.pick(slice(k, k + 1))).triangle for k in range(count)]
    assert any(len(one) for one in alone)
    assert [set(found.triangle[found.item == k]) for k in range(count)] == [set(one) for one in alone]
