"""Posts made ground: where they are in W, which diagonal, holes, boxes, and what keeps them from it."""

from __future__ import annotations

import numpy as np
import pytest

from shotc.geom import geodetic
from shotc.geom.surface.ground import height_at
from shotc.geom.terrain import relief
from shotc.geom.terrain.posts import Posts, TerrainFault, posts_of
from shotc.geom.terrain.relief import PlanRectangle, Relief, relief_of
from shotc.geom.terrain.systems import utm_of_degrees

ORIGIN = (46.68, 7.68, 560.0)
BOX = PlanRectangle((-400.0, -300.0), (500.0, 600.0))


def posts(heights: np.ndarray, x: np.ndarray, y: np.ndarray, system: int | None = None) -> Posts:
    found = posts_of(heights, x, y, system)
    assert isinstance(found, Posts)
    return found


def made(of: Posts, box: PlanRectangle = BOX, offset: float = 0.0) -> Relief:
    found = relief_of(of, box, ORIGIN, offset)
    assert isinstance(found, Relief)
    return found


def fault(of: Posts, box: PlanRectangle = BOX) -> TerrainFault:
    found = relief_of(of, box, ORIGIN)
    assert isinstance(found, TerrainFault)
    return found


def level(system: int | None, x: np.ndarray, y: np.ndarray, height: float = 600.0) -> Posts:
    return posts(np.full((len(y), len(x)), height), x, y, system)


def degrees(height: float = 600.0) -> Posts:
    return level(4326, np.linspace(7.6, 7.76, 81), np.linspace(46.6, 46.76, 81), height)


def test_posts_of_the_world_are_where_they_are():
    found = made(
        posts(np.array([[0.0, 1], [2, 5]]), np.array([0.0, 10]), np.array([0.0, 10])),
        PlanRectangle((0, 0), (9, 9)),
    )
    at = height_at(found.ground, np.array([[0, 0], [10, 0], [0, 10], [10, 10], [7.5, 2.5], [2.5, 7.5]]))
    # From the south-west to the north-east post: 0 and 5; the middle of the cell is on that side.
    assert at == pytest.approx([0, 1, 2, 5, 1.75, 2.25])
    assert height_at(found.ground, np.array([[5.0, 5.0]])) == pytest.approx(2.5)


def test_degrees_are_put_into_the_world_exactly():
    found = made(degrees())
    lat, lon = degrees().y[40], degrees().x[40]
    x, y, z = geodetic.to_world((lat, lon, 600.0), ORIGIN)
    assert height_at(found.ground, np.array([[x, y]])) == pytest.approx(z, abs=1e-6)
    corners = found.ground.surface.triangles[..., :2].reshape(-1, 2)
    assert (corners.min(axis=0) <= BOX.low).all()
    assert (corners.max(axis=0) >= BOX.high).all()
    assert np.abs(corners).max() < 1400.0  # cut to the box, a few posts more


def test_utm_and_degrees_of_one_place_are_one_ground():
    # A slope to the East, posts of 25 m in zone 32.
    x0, y0 = utm_of_degrees(np.array(ORIGIN[0]), np.array(ORIGIN[1]), 32, True)
    x, y = float(x0) + np.arange(-60, 61) * 25.0, float(y0) + np.arange(-60, 61) * 25.0
    slope = made(posts(np.tile(600 + 0.1 * (x - float(x0)), (121, 1)), x, y, 32632))
    at = height_at(slope.ground, np.array([[0.0, 0.0], [300.0, 0.0]]))
    assert at[0] == pytest.approx(40.0, abs=0.01)
    # The zone's grid is turned by about a degree here, and a little larger than W.
    assert at[1] == pytest.approx(40.0 + 30.0, abs=0.1)


def test_the_offset_is_added():
    origin = np.zeros((1, 2))
    low, high = (height_at(made(degrees(), offset=o).ground, origin)[0] for o in (0.0, 47.5))
    assert high - low == pytest.approx(47.5, abs=1e-6)


def test_far_away_level_posts_sink_below_the_plane():
    far = PlanRectangle((9900.0, -100.0), (10_100.0, 100.0))
    wide = level(4326, np.linspace(7.5, 8.0, 1001), np.linspace(46.6, 46.8, 401), 560.0)
    found = height_at(made(wide, far).ground, np.array([[10_000.0, 0.0]]))
    assert found == pytest.approx(-(10_000.0**2) / (2 * 6.39e6), abs=0.05)


def test_a_post_without_a_height_leaves_a_hole():
    heights = np.full((5, 5), 3.0)
    heights[2, 2] = np.nan
    of = posts(heights, np.arange(5.0), np.arange(5.0))
    found = made(of, PlanRectangle((0, 0), (4, 4)))
    assert (found.shape, found.holes) == ((5, 5), 1)
    inside = height_at(found.ground, np.array([[0.5, 0.5], [1.9, 2.2], [2.1, 2.1], [1.2, 2.9]]))
    assert inside[0] == 3.0
    assert np.isnan(inside[1:3]).all()
    assert inside[3] == 3.0  # of the six triangles about the post none lies here


def test_a_file_that_counts_to_360_degrees_is_found():
    east = degrees()
    around = posts(east.heights, east.x + 360.0, east.y, 4326)
    one, other = (height_at(made(p).ground, np.array([[10.0, 20.0]])) for p in (east, around))
    assert one == pytest.approx(other, abs=1e-6)


@pytest.mark.parametrize("east", [-120.0, 150.0, 179.95])
def test_ground_is_found_at_every_longitude_in_files_of_both_ways_to_count(east: float):
    lat, lon = np.linspace(46.6, 46.76, 81), east + np.linspace(-0.08, 0.08, 81)
    for x in (lon, lon + (360.0 if east < 0.0 else -360.0)):
        found = relief_of(level(4326, x, lat), BOX, (46.68, east, 560.0))
        assert isinstance(found, Relief)
        assert np.isfinite(height_at(found.ground, np.array([[10.0, 20.0]]))).all()


def test_a_file_that_is_elsewhere_is_told_both_places():
    found = fault(level(4326, np.linspace(8.6, 8.7, 50), np.linspace(46.6, 46.7, 50)))
    assert found.kind == "outside"
    assert "8.6 to 8.7" in found.message
    assert "7.67" in found.message


def test_posts_on_the_earth_need_an_origin():
    found = relief_of(degrees(), BOX, None)
    assert isinstance(found, TerrainFault)
    assert found.kind == "origin"


def test_too_many_posts_about_the_mission_are_told(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(relief, "MOST_CELLS", 50)
    assert fault(degrees()).kind == "size"


def test_no_height_about_the_mission_is_told():
    heights = np.full((81, 81), np.nan)
    heights[0, 0] = 5.0
    assert fault(posts(heights, degrees().x, degrees().y, 4326)).kind == "empty"


def test_an_unknown_system_is_told():
    pytest.importorskip("pyproj")
    assert fault(level(1, np.arange(3.0), np.arange(3.0))).kind == "system"


def test_rows_and_columns_may_run_either_way():
    heights = np.arange(6.0).reshape(2, 3)
    found = posts(heights[::-1, ::-1], np.array([2.0, 1, 0]), np.array([1.0, 0]))
    assert (found.heights == heights).all()
    assert (found.x == [0, 1, 2]).all()


@pytest.mark.parametrize(
    ("heights", "x", "kind"),
    [
        (np.zeros((1, 3)), np.arange(3.0), "grid"),
        (np.zeros((2, 3)), np.array([0.0, 2.0, 1.0]), "grid"),
        (np.zeros((2, 3)), np.array([0.0, 1.0, 1.0]), "grid"),
        (np.zeros((2, 3)), np.array([0.0, np.inf, 1.0]), "number"),
        (np.full((2, 3), np.nan), np.arange(3.0), "empty"),
        (np.full((2, 3), -32768.0), np.arange(3.0), "number"),
        (np.full((2, 3), np.inf), np.arange(3.0), "number"),
    ],
)
def test_what_is_no_grid_of_heights_is_told(heights: np.ndarray, x: np.ndarray, kind: str):
    found = posts_of(heights, x, np.arange(float(len(heights))), None)
    assert isinstance(found, TerrainFault)
    assert found.kind == kind


@pytest.mark.parametrize("y", [[0.0, np.nan, 2.0], [np.inf, np.inf, np.inf], [0.0, 1.0, np.inf]])
def test_rows_without_a_place_are_told(y: list[float]) -> None:
    found = posts_of(np.zeros((3, 3)), np.arange(3.0), np.array(y), None)
    assert isinstance(found, TerrainFault)
    assert found.kind == "number"


@pytest.mark.parametrize(("low", "high"), [(7.2, 9.7), (8.0, 9.0), (8.4, 8.6)])
def test_as_many_posts_are_taken_beyond_a_box_on_one_side_as_on_the_other(low: float, high: float) -> None:
    values = np.arange(20.0)
    found = relief._about(values, np.array([low, high, 0.5 * (low + high)]))
    assert found is not None
    taken = values[found]
    assert (taken <= low).sum() == (taken >= high).sum() == 1 + relief._MARGIN_POSTS
    at_ends = relief._about(values, np.array([-3.0, 30.0]))
    assert values[at_ends].tolist() == values.tolist()
    assert relief._about(values, np.array([-3.0, -1.0])) is None
    assert relief._about(values, np.array([20.0, 21.0])) is None


def test_the_sides_of_a_wide_box_bulge_in_degrees_and_all_of_it_has_ground():
    """At latitude 60 a parallel is d^2 tan(60) / 2 R off a straight line: 49 m after 19 km, 22 posts."""
    origin, box = (60.0, 10.0, 0.0), PlanRectangle((-19_000.0, -10.0), (19_000.0, 10.0))
    lat, lon = 60.0 + np.linspace(-0.002, 0.002, 201), np.linspace(9.6, 10.4, 81)
    found = relief_of(level(4326, lon, lat, 100.0), box, origin)
    assert isinstance(found, Relief)
    x = np.linspace(box.low[0], box.high[0], 301)
    sides = np.concatenate([np.column_stack([x, np.full(301, y)]) for y in (box.low[1], box.high[1])])
    assert np.isfinite(height_at(found.ground, sides)).all()
    assert found.shape[0] < 45
    assert found.shape[1] < 81


def test_the_sides_of_a_tall_box_lean_in_degrees_and_all_of_it_has_ground():
    """19 km east of the origin a meridian is x y tan(60) / R aside: 52 m after 10 km, 5 posts."""
    origin, box = (60.0, 10.0, 0.0), PlanRectangle((18_500.0, -10_000.0), (19_000.0, 10_000.0))
    lat, lon = 60.0 + np.linspace(-0.1, 0.1, 41), 10.0 + np.linspace(0.325, 0.345, 101)
    found = relief_of(level(4326, lon, lat, 100.0), box, origin)
    assert isinstance(found, Relief)
    y = np.linspace(box.low[1], box.high[1], 301)
    sides = np.concatenate([np.column_stack([np.full(301, x), y]) for x in (box.low[0], box.high[0])])
    assert np.isfinite(height_at(found.ground, sides)).all()
    assert found.shape[1] < 70
