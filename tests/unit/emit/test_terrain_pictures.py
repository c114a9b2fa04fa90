"""Terrain in pictures: it hides what is behind it, maps have its contours, side views its profile."""

from __future__ import annotations

from io import BytesIO
from math import pi, radians

import numpy as np
import pytest
from PIL import Image

from shotc.emit.hillshade import before, hillshade, shades
from shotc.emit.storyboard import EMITTER, map, scene
from shotc.emit.storyboard.camera_picture import PictureRectangle, picture
from shotc.emit.storyboard.canvas import Canvas, PageRectangle, house_style
from shotc.emit.storyboard.content import ShotBoard, shot_boards
from shotc.emit.storyboard.contours import contour, contour_heights, profile, relief_of
from shotc.emit.storyboard.fan import Fan, FanPainter, draped, fan_of
from shotc.emit.storyboard.flat_ground import squares
from shotc.emit.storyboard.map import draw_map
from shotc.emit.storyboard.scene import draw_scene, name_places
from shotc.emit.storyboard.sheet import sheet_of
from shotc.geom.shapes import CylinderShape
from shotc.geom.surface.ground import Ground, ground_of, height_at
from shotc.ir.mission import MissionIR
from shotc.ir.target import Target
from shotc.ir.terrain import Terrain, ground_heights
from tests.support.film_plans import orbit_plan
from tests.support.records import replace
from tests.support.surfaces import grid

BOX = PageRectangle(0.0, 0.0, 3.0, 3.0)
STEP, SIDE = 10.0, 61


def ground(heights: np.ndarray, step: float = STEP) -> Ground:
    """Posts with their middle at the origin of W."""
    shape = grid(heights, step)
    middle = 0.5 * step * (len(heights) - 1)
    return ground_of(shape.corners - [middle, middle, 0.0], shape.faces)


def ridge(height: float = 40.0) -> Ground:
    """A wall of hill along x = 0, on a plain."""
    heights = np.zeros((SIDE, SIDE))
    heights[SIDE // 2] = height
    return ground(heights)


def waves() -> Ground:
    x, y = np.meshgrid(np.arange(SIDE), np.arange(SIDE), indexing="ij")
    return ground(15.0 * np.sin(x / 5.0) + 10.0 * np.cos(y / 7.0 + x / 11.0) - 20.0)


def mission(shape: Ground, *targets: Target) -> MissionIR:
    flat = orbit_plan().trajectory.keyframes.mission
    return replace(flat, terrain=Terrain(shape, "relief.csv"), targets=targets, zones=())


def mast(x: float, height: float = 10.0) -> Target:
    return Target("mast", (x, 0.0, height / 2), CylinderShape(2.0, height), ("targets", "mast"))


def look(pitch: float = 0.0, z: float = 8.0, x: float = -100.0) -> PictureRectangle:
    """Towards the East."""
    return picture(np.array([x, 0.0, z, 0.0, pitch, 0.0, radians(60)]), 1.0, BOX)


def blue(shown: PictureRectangle, told: MissionIR) -> int:
    """How many pixels of a picture are a target."""
    with house_style():
        canvas = Canvas(3.0, 3.0, 60.0)
        draw_scene(canvas, shown, told, ("mast",), 10.0)
        pixels = np.asarray(Image.open(BytesIO(canvas.png()))).astype(int)
    return int((pixels[..., 2] - pixels[..., 0] > 60).sum())


@pytest.mark.slow
def test_a_hill_hides_the_target_behind_it() -> None:
    assert blue(look(), mission(ridge(), mast(-50.0))) > 100, "before the hill"
    assert blue(look(), mission(ridge(), mast(50.0))) == 0, "behind it"
    assert blue(look(), mission(ridge(0.0), mast(50.0))) > 50, "no hill"
    tall, level = blue(look(), mission(ridge(), mast(50.0, 90.0))), mission(ridge(0.0), mast(50.0, 90.0))
    assert 0 < tall < blue(look(), level), "its top is seen over the hill"


def test_a_target_that_ground_hides_is_not_named_in_the_picture() -> None:
    assert [thing.name for thing in name_places(look(), mission(ridge(), mast(-50.0)))] == ["mast"]
    assert name_places(look(), mission(ridge(), mast(50.0))) == []
    assert [thing.name for thing in name_places(look(), mission(ridge(), mast(50.0, 90.0)))] == ["mast"]


def test_ground_is_drawn_once_from_the_farthest_ring_to_the_nearest(monkeypatch: pytest.MonkeyPatch) -> None:
    shown, nets = look(), []
    monkeypatch.setattr(Canvas, "mesh", lambda self, corners, faces, clip: nets.append((corners, faces)))
    monkeypatch.setattr(Canvas, "pieces", lambda *rest: None)
    fan = fan_of(shown, waves(), [50.0, 120.0])
    assert {50.0, 120.0} <= set(fan.radius)
    painter = FanPainter(Canvas(3.0, 3.0, 40.0), shown, fan, 10.0)
    for distance in (120.0, 150.0, 50.0, 0.0, 0.0):
        painter.draw_beyond(distance)
    beyond = [int((fan.radius >= d).sum()) - 1 for d in (120.0, 50.0, 0.0)]
    assert [len(faces) for _, faces in nets] == list(np.diff([0, *beyond]))
    rows = np.concatenate([corners[:-1] for corners, _ in nets])
    whole = shown.place(np.stack([c / h for c, h in zip(_seen(shown, fan), _half(shown), strict=True)], -1))
    np.testing.assert_allclose(rows[:60], whole[::-1][:60], atol=1e-9)


def _half(shown: PictureRectangle) -> tuple[float, float]:
    return float(shown.camera.half_width), float(shown.camera.half_height)


def _seen(shown: PictureRectangle, fan: Fan) -> tuple[np.ndarray, np.ndarray]:
    p = fan.points
    right, down, forward = shown.camera.to_camera((p[..., 0], p[..., 1], p[..., 2]))
    return right / forward, -down / forward


@pytest.mark.slow
@pytest.mark.parametrize("pitch", [0.0, -0.7, -pi / 2])
def test_a_fan_is_the_ground_and_covers_the_picture(pitch: float) -> None:
    shown = look(pitch, z=60.0, x=0.0)
    fan = fan_of(shown, waves())
    xy = fan.points[..., :2].reshape(-1, 2) + shown.eye[:2]
    np.testing.assert_allclose(fan.z.ravel() + 60.0, height_at(waves(), xy))
    side = np.linspace(-1, 1, 21)
    for u, v in [(a, b) for a in side for b in side]:
        along = np.cos(pitch) - np.sin(pitch) * v * _half(shown)[1]
        turn = np.arctan2(-u * _half(shown)[0], along)
        yaw = 0.5 * (fan.angle[0] + fan.angle[-1])
        assert fan.angle[0] - 1e-9 <= (turn - yaw + pi) % (2 * pi) - pi + yaw <= fan.angle[-1] + 1e-9
    if pitch == -pi / 2:
        assert fan.radius[0] < 0.01, "straight down there is no hole"


def test_lines_lie_on_the_ground_and_end_behind_hills() -> None:
    shown = look(z=8.0)
    fan = fan_of(shown, ridge(0.0))
    lines = squares(shown.eye, 10.0, 160)
    level = draped(fan, lines)
    np.testing.assert_allclose(level[..., 2], -8.0, atol=1e-9)
    hidden = draped(fan_of(shown, ridge()), lines)
    assert level[..., 0].max() > 200.0
    assert hidden[..., 0].max() < 105.0, "nothing beyond the crest, 100 m away"


def test_sight_lines_end_at_hills() -> None:
    eye = np.array([-100.0, 0.0, 8.0])
    points = np.array([[-20.0, 0.0, 5.0], [50.0, 0.0, 5.0], [50.0, 0.0, 90.0]])
    assert before(ridge(), eye, points).tolist() == [False, True, False]


def test_light_comes_from_the_north_west() -> None:
    level, towards, away = hillshade(np.array([[0, 0, 2.0], [-0.3, 0.3, 1.0], [0.3, -0.3, 1.0]]))
    assert level == pytest.approx(1.0)
    assert towards > 1.1
    assert away < 0.9
    np.testing.assert_allclose(
        shades(np.array([0.4, 0.6, 0.8]), np.array([1.0, 0.5])), [[0.4, 0.6, 0.8], [0.2, 0.3, 0.4]]
    )


def test_contours_are_at_their_heights() -> None:
    shape = waves()
    triangles = shape.surface.triangles
    for level in (-30.0, -17.3, 0.0):
        ends = contour(triangles, level)
        assert len(ends) > 50
        np.testing.assert_allclose(height_at(shape, ends.reshape(-1, 2)), level, atol=1e-6)
    assert len(contour(triangles, 99.0)) == 0


def test_contours_run_all_round_a_hill() -> None:
    x, y = np.meshgrid(np.arange(41) - 20, np.arange(41) - 20, indexing="ij")
    cone = ground(30.0 - np.hypot(x, y), 1.0)
    ends = contour(cone.surface.triangles, 20.0)
    np.testing.assert_allclose(np.hypot(*ends.reshape(-1, 2).T), 10.0, atol=0.1)
    assert np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1).sum() == pytest.approx(20 * pi, rel=0.01)


def _board(rise: bool) -> ShotBoard:
    (board,) = shot_boards(orbit_plan())
    up = np.stack([np.zeros(50), np.full(50, -40.0), np.linspace(10, 60, 50)], axis=-1)
    return replace(board, path=up) if rise else board


def test_a_map_over_terrain_has_contours_with_their_heights() -> None:
    told = mission(waves(), orbit_plan().trajectory.keyframes.mission.targets[0])
    sheet = sheet_of(BOX, _board(rise=False), told)
    relief = relief_of(sheet, told.terrain.ground)
    x, y, z = relief.nodes.reshape(-1, 3).T
    np.testing.assert_allclose(z, height_at(told.terrain.ground, np.column_stack([x, y])))
    np.testing.assert_allclose(sheet.at(relief.nodes[[0, -1], [0, -1], :2]), [[0, 0], [3, 3]], atol=1e-9)
    assert set(relief.labelled) < set(relief.levels)
    assert z.min() <= relief.levels[0] < relief.levels[0] + relief.step <= z.max()
    with house_style():
        canvas = Canvas(3.0, 3.0, 40.0)
        rooms = contour_heights(canvas, sheet, relief, [])
        assert 2 <= len(rooms) <= 6
        assert not any(a.meets(b) for a in rooms for b in rooms if a is not b)
        assert contour_heights(canvas, sheet, relief, [BOX]) == []


def test_level_terrain_has_no_contours() -> None:
    told = mission(ridge(0.0), orbit_plan().trajectory.keyframes.mission.targets[0])
    relief = relief_of(sheet_of(BOX, _board(rise=False), told), told.terrain.ground)
    assert (relief.step, len(relief.levels), len(relief.labelled)) == (0.0, 0, 0)


def test_a_side_view_has_the_ground_below_the_flight_as_profile(monkeypatch: pytest.MonkeyPatch) -> None:
    told = mission(waves(), orbit_plan().trajectory.keyframes.mission.targets[0])
    board = _board(rise=True)
    sheet = sheet_of(BOX, board, told)
    assert not sheet.is_plan
    line = profile(sheet, told.terrain.ground, board.path[:, :2].mean(axis=0))
    # The camera climbs at (0, -40), and its subject is north of it.
    xy = np.column_stack([np.zeros(len(line)), line[:, 0]])
    np.testing.assert_allclose(line[:, 1], height_at(told.terrain.ground, xy))
    drawn: list[np.ndarray] = []
    monkeypatch.setattr(map, "draw_profile", lambda canvas, sheet, line: drawn.append(line))
    with house_style():
        draw_map(Canvas(4.0, 4.0, 40.0), BOX, board, told, 10.0)
    np.testing.assert_allclose(drawn[0], line)


def test_a_profile_ends_where_the_ground_does() -> None:
    told = mission(ground(np.zeros((5, 5)), 20.0), orbit_plan().trajectory.keyframes.mission.targets[0])
    board = _board(rise=True)
    line = profile(sheet_of(BOX, board, told), told.terrain.ground, np.array([0.0, -39.0]))
    known = np.isfinite(line[:, 1])
    assert known.any()
    np.testing.assert_array_equal(known, np.abs(line[:, 0]) <= 40.0)


def test_missions_without_terrain_touch_none_of_it(monkeypatch: pytest.MonkeyPatch) -> None:
    def never(*rest: object, **more: object) -> None:
        raise AssertionError("terrain in a flat mission")

    for module, name in ((scene, "fan_of"), (scene, "before"), (map, "relief_of"), (map, "profile")):
        monkeypatch.setattr(module, name, never)
    flat = orbit_plan().trajectory.keyframes.mission
    assert not ground_heights(flat, np.ones((3, 2))).any()
    with house_style():
        draw_scene(Canvas(3.0, 3.0, 40.0), look(), flat, (), 10.0)
        for rise in (False, True):
            draw_map(Canvas(4.0, 4.0, 40.0), BOX, _board(rise), flat, 10.0)


@pytest.mark.long
def test_a_storyboard_over_terrain_is_always_the_same() -> None:
    plan = orbit_plan()
    told = replace(plan.trajectory.keyframes.mission, terrain=Terrain(waves(), "relief.csv"))
    keyframes = replace(plan.trajectory.keyframes, mission=told)
    over = replace(plan, trajectory=replace(plan.trajectory, keyframes=keyframes))
    png = EMITTER.emit(over).artifacts[0].data
    assert png == EMITTER.emit(over).artifacts[0].data
    assert png != EMITTER.emit(plan).artifacts[0].data
