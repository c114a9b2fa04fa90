"""Heights above ground: proven bounds against cells read one by one, cliffs, edges, holes, real mountains."""

from __future__ import annotations

import matplotlib.cbook
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from shotc.geom.bernstein import Piecewise
from shotc.geom.pieces import Pieces, join, pieces
from shotc.geom.surface.distance import SurfaceBound, inf_distance
from shotc.geom.surface.ground import Ground, NoGround, ground_of, height_at, leaves
from shotc.geom.surface.height import inf_height, sup_height
from tests.support.few import examples
from tests.support.surfaces import Grid, grid, line, samples

GAP = 5e-7
seeds = st.integers(0, 2**32 - 1)


def fine(_best: float) -> float:
    return GAP


def ground(of: Grid) -> Ground:
    return ground_of(of.corners, of.faces)


def bounds(curve: Piecewise, land: Ground) -> tuple[SurfaceBound, SurfaceBound]:
    low, high = inf_height(pieces(curve), land, fine), sup_height(pieces(curve), land, fine)
    assert isinstance(low, SurfaceBound)
    assert isinstance(high, SurfaceBound)
    return low, high


def cliff(height: float = 40.0, size: int = 41) -> Grid:
    """A step of one cell at x = 20, rising to the east."""
    heights = np.zeros((size, size))
    heights[21:] = height
    return grid(heights)


@pytest.mark.long
@settings(max_examples=examples(80, 300))
@given(seeds, st.integers(2, 14), st.integers(2, 14), st.sampled_from(["any", "column", "diagonal"]))
def test_heights_enclose_every_sample_and_are_tight(seed: int, rows: int, columns: int, way: str):
    random = np.random.default_rng(seed)
    land = grid(random.normal(size=(rows, columns)) * random.choice([0.1, 1.0, 10.0]))
    ctrl = random.uniform(0.01, 0.99, size=(2, 6, 3)) * np.array([rows - 1, columns - 1, 8])
    if way == "column":
        ctrl[..., 0] = random.integers(1, rows) if rows > 2 else 0.5
    elif way == "diagonal":
        ctrl[..., 0] = ctrl[..., 1] = np.minimum(ctrl[..., 0], min(rows, columns) - 1.01)
    if way == "column" and ctrl[0, 0, 0] == rows - 1:
        ctrl[..., 0] -= 1
    ctrl[1, 0] = ctrl[0, -1]
    curve = Piecewise(np.arange(3.0), ctrl)
    low, high = bounds(curve, ground(land))
    seen = samples(curve, 1500)
    seen = seen[:, 2] - land.height_at(seen[:, 0], seen[:, 1])
    assert low.proven <= seen.min() + 1e-9
    assert high.proven >= seen.max() - 1e-9
    assert low.attained - GAP <= low.proven <= low.attained
    assert high.attained <= high.proven <= high.attained + GAP
    ends = np.array([np.nextafter(low.at, -np.inf), low.at])
    there = curve(ends)
    assert (np.abs(there[:, 2] - land.height_at(there[:, 0], there[:, 1]) - low.attained) < 1e-5).any()


def test_a_level_way_over_a_slope_is_lowest_where_the_slope_is_highest():
    x = np.arange(11.0)
    land = grid(np.tile(0.5 * x[:, None], (1, 11)))
    low, high = bounds(line((1, 2, 9), (9, 8, 9)), ground(land))
    assert low.proven == pytest.approx(9 - 4.5, abs=1e-6)
    assert low.at == pytest.approx(1.0, abs=1e-6)
    assert high.proven == pytest.approx(9 - 0.5, abs=1e-6)


def test_beside_a_cliff_the_height_is_that_above_its_foot_and_the_distance_that_from_its_wall():
    land = ground(cliff())
    beside = pieces(line((18, 5, 20), (18, 35, 20), 4))
    low = inf_height(beside, land, fine)
    near = inf_distance(beside, land.surface, fine)
    assert isinstance(low, SurfaceBound)
    assert low.proven == pytest.approx(20.0, abs=1e-6)
    assert near.proven == pytest.approx(100 / np.hypot(40, 1), abs=1e-6)
    over = inf_height(pieces(line((10, 5, 50), (30, 9, 50))), land, fine)
    assert isinstance(over, SurfaceBound)
    assert over.proven == pytest.approx(10.0, abs=1e-6)


def test_a_way_through_the_ground_is_as_deep_below_it_as_it_is():
    land = ground(cliff())
    low = inf_height(pieces(line((10, 20, 30), (30, 20, 30))), land, fine)
    assert isinstance(low, SurfaceBound)
    assert low.proven == pytest.approx(-10.0, abs=1e-6)


def test_where_there_is_no_ground_there_is_no_height():
    land = ground(grid(np.zeros((5, 5))))
    found = height_at(land, np.array([[2.0, 2.0], [4.0, 4.0], [4.1, 2.0], [-1.0, 0.0]]))
    assert found[:2] == pytest.approx(0.0)
    assert np.isnan(found[2:]).all()


def test_a_way_that_leaves_the_ground_is_told_where_and_by_how_much():
    land = ground(grid(np.zeros((11, 11))))
    found = leaves(land, pieces(line((5, 5, 3), (14, 5, 3))))
    assert found == NoGround(1.0, (14.0, 5.0), pytest.approx(4.0))
    assert inf_height(pieces(line((5, 5, 3), (14, 5, 3))), land, fine) == found
    assert sup_height(pieces(line((5, 5, 3), (14, 5, 3))), land, fine) == found
    begins = leaves(land, pieces(line((-3, 5, 3), (5, 5, 3))))
    assert begins == NoGround(0.0, (-3.0, 5.0), pytest.approx(3.0))


def test_each_curve_that_begins_elsewhere_is_to_begin_above_ground():
    land = ground(grid(np.zeros((11, 11))))
    inside, outside = (pieces(line((2, y, 3), (8, y, 3))) for y in (5, 25))
    for both in (join([inside, outside]), join([outside, inside])):
        found = leaves(land, both)
        assert found is not None
        assert found.by == pytest.approx(15.0)
    assert leaves(land, join([inside, inside])) is None


def test_a_way_over_a_hole_is_refused_however_small_the_hole_is():
    whole = grid(np.zeros((21, 21)))
    middle = (whole.triangles[..., :2].mean(axis=1) - 10.5).round(1)
    holed = ground_of(whole.corners, whole.faces[np.abs(middle).max(axis=1) > 0.5])
    across = leaves(holed, pieces(line((2, 10.5, 3), (19, 10.5, 3))))
    assert across is not None
    assert across.place == (pytest.approx(10.5), pytest.approx(10.5))
    assert across.by == pytest.approx(0.5)
    clipped = leaves(holed, pieces(line((2, 10.999, 3), (18, 10.999, 3))))
    assert clipped is not None
    assert clipped.by < 0.01
    assert leaves(holed, pieces(line((2, 11.1, 3), (18, 11.1, 3)))) is None


def test_a_way_along_the_edge_is_refused_and_one_beside_it_is_not():
    land = ground(grid(np.zeros((11, 11))))
    along = leaves(land, pieces(line((2, 0, 3), (8, 0, 3))))
    assert along is not None
    assert along.by == 0.0
    assert leaves(land, pieces(line((2, 1e-4, 3), (8, 1e-4, 3)))) is None


def test_each_of_the_pieces_has_to_be_above_ground():
    land = ground(grid(np.zeros((11, 11))))
    bag = join([pieces(line((2, 2, 3), (8, 2, 3))), pieces(line((30, 2, 3), (38, 2, 3)))])
    found = leaves(land, bag)
    assert found is not None
    assert found.by == pytest.approx(28.0)


def test_no_pieces_have_no_height():
    bag = pieces(line((2, 2, 3), (8, 2, 3)))
    none = Pieces(bag.low[:0], bag.high[:0], bag.ctrl[:0])
    land = ground(grid(np.zeros((3, 3))))
    low, high = inf_height(none, land, fine), sup_height(none, land, fine)
    assert isinstance(low, SurfaceBound)
    assert isinstance(high, SurfaceBound)
    assert (low.proven, high.proven) == (np.inf, -np.inf)


def test_ground_of_nothing_is_nowhere():
    nothing = ground_of(np.zeros((0, 3)), np.zeros((0, 3), dtype=np.intp))
    found = inf_height(pieces(line((2, 2, 3), (8, 2, 3))), nothing, fine)
    assert isinstance(found, NoGround)
    assert found.by == np.inf


@pytest.mark.slow
def test_what_meets_too_many_boxes_at_once_is_bound_as_tight(monkeypatch: pytest.MonkeyPatch):
    land = ground(grid(np.random.default_rng(3).normal(size=(64, 64)) * 0.3))
    free = bounds(line((1, 1, 4.5), (60, 50, 4.5)), land)
    monkeypatch.setattr("shotc.geom.surface.distance.OPEN_PIECES_LIMIT", 400)
    tight = bounds(line((1, 1, 4.5), (60, 50, 4.5)), land)
    for one, other in zip(free, tight, strict=True):
        assert abs(one.attained - other.attained) <= GAP
        assert abs(one.proven - other.proven) <= 2 * GAP


def test_upright_triangles_are_walls_and_no_ground():
    # Two terraces and the wall between them, which is upright.
    corners = np.array(
        [[0, 0, 0], [5, 0, 0], [5, 9, 0], [0, 9, 0], [5, 0, 8], [9, 0, 8], [9, 9, 8], [5, 9, 8]], dtype=float
    )
    quads = ([0, 1, 2, 3], [4, 5, 6, 7], [1, 4, 7, 2])
    faces = np.array([f for a, b, c, d in quads for f in ([a, b, c], [a, c, d])])
    low, high = bounds(line((1, 4, 12), (8, 5, 12)), ground_of(corners, faces))
    assert low.proven == pytest.approx(4.0, abs=1e-6)
    assert high.proven == pytest.approx(12.0, abs=1e-6)


def test_a_flight_over_real_mountains_is_proved_to_a_millimetre():
    with matplotlib.cbook.get_sample_data("jacksboro_fault_dem.npz") as file:
        heights = file["elevation"].astype(float)[100:160, 100:160]
    land = grid(heights, 80.0)
    x = np.linspace(300.0, 3900.0, 151)
    y = 2000.0 + 900.0 * np.sin(x / 400.0)
    points = np.column_stack([x, y, land.height_at(x, y) + 40.0])
    curve = Piecewise(np.arange(31.0), np.stack([points[5 * k : 5 * k + 6] for k in range(30)]))
    low, high = bounds(curve, ground(land))
    seen = samples(curve, 20_001)
    seen = seen[:, 2] - land.height_at(seen[:, 0], seen[:, 1])
    assert low.proven <= seen.min()
    assert seen.max() <= high.proven
    for found in (low, high):
        x, y, z = curve(found.at)
        assert z - land.height_at(x, y) == pytest.approx(found.attained, abs=1e-6)
    assert max(low.attained - low.proven, high.proven - high.attained) <= GAP


@pytest.mark.parametrize("level", [0.0, -100.0, 100.0])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_one_cell_of_other_height_is_found_whatever_the_level_of_the_ground(
    level: float, sign: float
) -> None:
    # It is not under the middle of the curve, which is looked at first.
    heights = np.full((41, 41), level)
    heights[31, 20] += 5.0 * sign
    low, high = bounds(line((2.0, 20.0, level + 10.0), (38.0, 20.0, level + 10.0)), ground(grid(heights)))
    assert low.proven == pytest.approx(5.0 if sign > 0.0 else 10.0, abs=1e-4)
    assert high.proven == pytest.approx(10.0 if sign > 0.0 else 15.0, abs=1e-4)
