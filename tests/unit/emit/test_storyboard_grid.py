"""What a page says of its grids is what is drawn: on maps, in side views and in pictures."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace as altered
from math import pi

import numpy as np
import pytest

from shotc.emit.storyboard import EMITTER, map, page
from shotc.emit.storyboard.camera_picture import picture
from shotc.emit.storyboard.canvas import Canvas, PageRectangle, house_style
from shotc.emit.storyboard.content import ShotBoard, shot_boards
from shotc.emit.storyboard.map import MOST_SQUARES, draw_map
from shotc.emit.storyboard.scene import draw_scene
from shotc.emit.storyboard.sheet import Sheet, sheet_of
from shotc.show.emit.contact_sheet import EMITTER as CONTACT_SHEET
from tests.support.film_plans import HFOV, orbit_plan
from tests.support.show_flights import plan as show_plan

Spied = tuple[list[float], list[str]]


def drawn(monkeypatch: pytest.MonkeyPatch, draw: Callable[[], object]) -> Spied:
    """Draw; return the distances between neighbouring grid lines of each sheet, metres, and all texts."""
    steps: list[float] = []
    texts: list[str] = []
    lines, text = Canvas.lines, Canvas.text
    squares = map.squares

    def measured(canvas: Canvas, sheet: Sheet, step: float) -> None:
        strips: list[np.ndarray] = []

        def kept(self, shapes, color, *rest, **more):
            strips.extend(shapes)
            lines(self, shapes, color, *rest, **more)

        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(Canvas, "lines", kept)
            squares(canvas, sheet, step)
        upright = sorted(s[0, 0] for s in strips if s[0, 0] == s[1, 0])
        level = sorted(s[0, 1] for s in strips if s[0, 1] == s[1, 1])
        gaps = np.concatenate([np.diff(upright), np.diff(level)]) / sheet.inches
        assert np.ptp(gaps) < 1e-6
        steps.append(float(gaps[0]))

    def written(self, x, y, words, *rest, **more):
        texts.append(words)
        text(self, x, y, words, *rest, **more)

    monkeypatch.setattr(map, "squares", measured)
    monkeypatch.setattr(Canvas, "text", written)
    draw()
    return steps, texts


def told(texts: list[str]) -> list[float]:
    return [float(found[1]) for t in texts if (found := re.fullmatch(r"[\d.]+ m · grid ([\d.]+) m", t))]


def boards() -> dict[str, ShotBoard]:
    """The sample's orbit, one twenty times as large, and one that rises."""
    (board,) = shot_boards(orbit_plan())
    rise = np.stack([np.zeros(50), np.full(50, -40.0), np.linspace(10, 400, 50)], axis=-1)
    return {"map": board, "far": altered(board, path=board.path * 20), "side": altered(board, path=rise)}


@pytest.mark.parametrize("name", ["map", "far", "side"])
@pytest.mark.parametrize("grid", [1.0, 2.0, 20.0])
def test_a_map_s_grid_is_as_wide_as_it_says(monkeypatch: pytest.MonkeyPatch, name: str, grid: float) -> None:
    board, mission = boards()[name], orbit_plan().trajectory.keyframes.mission
    box = PageRectangle(0.1, 0.1, 3.9, 3.0)
    with house_style():
        canvas = Canvas(5.0, 4.0, 40.0)
        steps, texts = drawn(monkeypatch, lambda: draw_map(canvas, box, board, mission, grid))
    assert told(texts) == pytest.approx(steps, rel=1e-6)
    sheet = sheet_of(box, board, mission)
    assert sheet.is_plan == (name != "side")
    assert steps[0] >= grid * (1 - 1e-9)
    assert max(box.width, box.height) / 2 / sheet.inches / steps[0] <= MOST_SQUARES


@pytest.mark.slow
def test_every_grid_of_a_page_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    grids: list[float] = []
    draw = page.draw_frame

    def watched(canvas, cell, moment, mission, grid):
        grids.append(grid)
        draw(canvas, cell, moment, mission, grid)

    monkeypatch.setattr(page, "draw_frame", watched)
    steps, texts = drawn(monkeypatch, lambda: EMITTER.emit(orbit_plan()))
    assert told(texts) == pytest.approx(steps, rel=1e-6)
    assert [t for t in texts if t.startswith("grid")] == [f"grid in pictures {g:g} m" for g in set(grids)]


@pytest.mark.slow
def test_the_map_of_a_show_says_its_grid(monkeypatch: pytest.MonkeyPatch) -> None:
    steps, texts = drawn(monkeypatch, lambda: CONTACT_SHEET.emit(show_plan()))
    assert len(steps) == 1
    assert told(texts) == pytest.approx(steps, rel=1e-6)


def test_the_ground_s_lines_in_a_picture_are_a_square_apart(monkeypatch: pytest.MonkeyPatch) -> None:
    ends: list[np.ndarray] = []
    monkeypatch.setattr(Canvas, "pieces", lambda self, pieces, *rest: ends.append(pieces))
    height, grid = 20.0, 5.0
    pose = np.array([3.0, -4.0, height, pi / 2, -pi / 2, pi / 2, HFOV])
    mission = orbit_plan().trajectory.keyframes.mission
    box = PageRectangle(0.0, 0.0, 2.0, 2.0)
    with house_style():
        draw_scene(Canvas(2.0, 2.0, 40.0), picture(pose, 1.0, box), mission, (), grid)
    # Looking straight down, North up: the picture is a plan of the ground.
    ground_at = (np.concatenate(ends) - 1.0) * height * np.tan(HFOV / 2) + pose[:2]
    fixed = np.ptp(ground_at, axis=1) < 1e-6
    assert fixed.any(axis=1).all()
    for axis in (0, 1):
        lines = np.unique(np.round(ground_at[fixed[:, axis], 0, axis], 6))
        np.testing.assert_allclose(lines / grid, np.round(lines / grid), atol=1e-6)
        assert len(lines) > 2
        np.testing.assert_allclose(np.diff(lines), grid)
