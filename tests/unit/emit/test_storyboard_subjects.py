"""The storyboard of shots with several subjects: each is drawn, named and judged as one."""

from __future__ import annotations

import numpy as np
import pytest

from shotc.emit.palette import CAMERA, WHITE
from shotc.emit.storyboard import EMITTER
from shotc.emit.storyboard.canvas import Canvas, PageRectangle, house_style
from shotc.emit.storyboard.composition import composition_text
from shotc.emit.storyboard.content import shot_boards
from shotc.emit.storyboard.frame import Cell, draw_frame
from shotc.emit.storyboard.subjects import at_time
from shotc.ir.keyframes import PlacedShot
from shotc.ir.limits import Vec2
from shotc.ir.mission import Composition
from shotc.ir.phases import Reference
from shotc.ir.trajectory import VerifiedIR
from shotc.spec.compositions import COMPOSITIONS, FRAMES
from tests.support.film_plans import TOWER, orbit_plan
from tests.support.records import replace
from tests.support.two_target_plans import MAST, PLACES, held, pair_plan


def marks(monkeypatch: pytest.MonkeyPatch, plan: VerifiedIR) -> tuple[list[Vec2], list[Vec2], list[str]]:
    """Draw the first panel 4 in wide; return where its crosses and dots are, (u, v), and what is written."""
    (board,) = shot_boards(plan)
    crosses: list[Vec2] = []
    dots: list[Vec2] = []
    texts: list[str] = []
    real = Canvas.lines, Canvas.disc, Canvas.text
    size = np.array([4.0, 2.25])

    def lines(self, strips, color, *rest, **more):
        if color == CAMERA:
            crosses.append(tuple(2 * strips[-1][:-1].mean(axis=0) / size - 1))
        if color == WHITE:  # the ring about one that a dot would cover
            dots.append(tuple(2 * strips[-1][:-1].mean(axis=0) / size - 1))
        real[0](self, strips, color, *rest, **more)

    def disc(self, at, radius, face, edge, width):
        if face == WHITE:
            dots.append(tuple(2 * np.array(at) / size - 1))
        real[1](self, at, radius, face, edge, width)

    def text(self, x, y, words, *rest, **more):
        texts.append(words)
        real[2](self, x, y, words, *rest, **more)

    for name, spy in (("lines", lines), ("disc", disc), ("text", text)):
        monkeypatch.setattr(Canvas, name, spy)
    with house_style():
        cell = Cell(PageRectangle(0.0, 0.0, *(float(c) for c in size)), 4.0)
        draw_frame(Canvas(4.0, 3.0, 50.0), cell, board.moments[0], plan.trajectory.keyframes.mission, 10.0)
    return crosses, dots, texts


def test_every_subject_has_its_cross_and_its_dot(monkeypatch: pytest.MonkeyPatch) -> None:
    crosses, dots, texts = marks(monkeypatch, pair_plan())
    np.testing.assert_allclose(crosses, list(PLACES.values()), atol=1e-9)
    # The camera looks at the tower; the mast is 13 m above that, both 40 m away.
    away, down = 40.0, 8.0
    slope = np.hypot(away, down)
    high = (13.0 * away / slope) / (slope - 13.0 * down / slope) / (np.tan(np.radians(35)) / (16 / 9))
    np.testing.assert_allclose(dots, [(0.0, 0.0), (0.0, high)], atol=1e-6)
    assert {"tower", "mast"} <= set(texts)
    assert any("41 m away" in t for t in texts)


@pytest.mark.slow
def test_both_subjects_are_drawn_in_full_colour(monkeypatch: pytest.MonkeyPatch) -> None:
    from shotc.emit.storyboard import frame

    shown: list[tuple[str, ...]] = []
    monkeypatch.setattr(frame, "draw_scene", lambda canvas, view, mission, names, grid: shown.append(names))
    EMITTER.emit(pair_plan())
    assert shown == [("tower", "mast")] * 6


def test_the_fault_of_any_subject_is_written_with_its_name(monkeypatch: pytest.MonkeyPatch) -> None:
    plan = pair_plan()
    keyframes = plan.trajectory.keyframes
    tall = replace(keyframes.mission, targets=(TOWER, replace(MAST, shape=MAST.shape._replace(height=60.0))))
    changed = replace(plan.trajectory, keyframes=replace(keyframes, mission=tall))
    cropped = VerifiedIR(changed, plan.certificate)
    (board,) = shot_boards(cropped)
    assert [[s.fault for s in m.framed] for m in board.moments] == [["", "cropped"]] * 6
    _, _, texts = marks(monkeypatch, cropped)
    assert "mast CROPPED" in texts


def test_the_heading_tells_every_subject_s_place_and_share() -> None:
    (board,) = shot_boards(pair_plan())
    assert board.composition == "tower lower-third; mast upper-third"
    assert [(name, said.in_frame) for name, said in board.framing] == [("tower", 1.0), ("mast", 0.75)]


def test_where_one_subject_follows_another_only_the_later_is_framed() -> None:
    plan = pair_plan()
    (flight,), (placed,) = plan.trajectory.drones, plan.trajectory.keyframes.shots
    spans = (
        Reference("half", "tower", 22.0, 40.0, held(PLACES["tower"], 22.0, 40.0)),
        Reference("half", "mast", 40.0, 50.0, held(PLACES["mast"], 40.0, 50.0)),
    )
    pair = (placed, replace(flight, framing=spans))
    found = [[s.target for s in at_time(plan, pair, t)] for t in (22.0, 39.9, 40.0, 50.0, 51.0)]
    assert found == [["tower"], ["tower"], ["mast"], ["mast"], []]


def composed(composition: Composition, *references: Vec2 | None) -> str:
    """What is said of a shot with one keyframe for each reference."""
    (placed,) = orbit_plan().trajectory.keyframes.shots
    keyframes = tuple(replace(placed.keyframes[0], reference=r) for r in references)
    written = (replace(placed.shot.keyframes[0], composition=composition),) * len(references)
    return composition_text(PlacedShot(replace(placed.shot, keyframes=written), keyframes))


def test_of_a_set_the_places_that_are_flown_are_named() -> None:
    thirds, third = COMPOSITIONS["thirds"], 1 / 3
    assert composed(thirds, (0.0, 0.0), (0.0, 0.0)) == "thirds (center)"
    assert composed(thirds, (-third, third), (0.0, 0.0), (-third, third)) == "thirds (upper-left, center)"
    assert composed(thirds, (0.0, 0.0), (0.1, 0.0)) == "thirds (center, elsewhere)"
    assert composed(COMPOSITIONS["phi"], (-0.236, 0.236)) == "phi ([-0.236, 0.236])"
    assert composed(thirds, None) == "thirds"
    for name, point in (("center", (0.0, 0.0)), ("thirds-lines", (third, 0.2)), ("keep", (0.2, 0.1))):
        assert composed(COMPOSITIONS[name], point) == name
    assert composed(FRAMES["left-third"], (-third, 0.0)) == "left-third"


def test_a_shot_that_frames_nothing_has_no_composition() -> None:
    (placed,) = orbit_plan().trajectory.keyframes.shots
    keyframes = tuple(replace(k, target=None) for k in placed.keyframes)
    assert composition_text(PlacedShot(placed.shot, keyframes)) == ""
