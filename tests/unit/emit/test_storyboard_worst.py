"""The worst moment of every shot stands in its storyboard."""

from __future__ import annotations

import pytest

from shotc.emit.storyboard.canvas import Canvas
from shotc.emit.storyboard.content import shot_boards
from shotc.emit.storyboard.page import draw_page
from shotc.geom.shapes import CylinderShape
from shotc.ir.trajectory import VerifiedIR
from tests.support.film_plans import SPEED, TOWER, dense_plan, orbit_plan
from tests.support.records import replace


def framed(plan: VerifiedIR, *, share: float, at: float, error: float, off: float) -> VerifiedIR:
    """Return a plan whose certificate tells how its one shot is framed at worst."""
    told = replace(SPEED, shot="half", hard=False)
    claims = (
        replace(told, constraint="tower in frame", worst=share, time=at, upper=False, unit="of samples"),
        replace(told, constraint="tower screen error", worst=error, time=off, unit="of half a frame"),
    )
    return VerifiedIR(plan.trajectory, (*plan.certificate, *claims))


def test_the_largest_screen_error_is_shown_between_the_keyframes() -> None:
    (board,) = shot_boards(framed(orbit_plan(), share=1.0, at=40.0, error=0.0123, off=31.0))
    assert [m.mark for m in board.moments] == ["1", "W", "2", "3", "4", "5"]
    assert [m.worst for m in board.moments if m.worst] == ["screen error 0.013"]
    assert board.moments[1].time == 31.0
    assert (board.numbered, board.total) == (5, 5)


def test_of_even_moments_the_nearest_inner_one_makes_way() -> None:
    plan = framed(dense_plan(placed=False), share=1.0, at=40.0, error=0.02, off=22.5)
    (board,) = shot_boards(plan)
    assert [m.time for m in board.moments] == pytest.approx([22, 22.5, 34, 40, 46, 52])
    assert [m.mark for m in board.moments] == ["1", "2", "3", "4", "5", "6"]
    assert [m.number for m in board.moments if m.worst] == [2]


def test_a_keyframe_that_shows_the_worst_is_marked() -> None:
    (board,) = shot_boards(orbit_plan())
    third = board.moments[2].time
    (board,) = shot_boards(framed(orbit_plan(), share=1.0, at=40.0, error=0.5, off=third + 0.02))
    assert [m.mark for m in board.moments] == ["1", "2", "3", "4", "5"]
    assert [m.worst for m in board.moments] == ["", "", "screen error 0.500", "", ""]


def test_a_hold_shows_what_is_so_until_it_ends() -> None:
    (board,) = shot_boards(orbit_plan())
    held = replace(board.moments[0], time=10.0, hold=3.0)
    assert [held.is_at(t) for t in (9.9, 10.0, 12.9, 13.2)] == [False, True, True, False]


def test_where_a_target_is_cropped_that_is_the_worst() -> None:
    plan = orbit_plan()
    mission = plan.trajectory.keyframes.mission
    tall = replace(mission, targets=(replace(TOWER, shape=CylinderShape(4.0, 90.0)),))
    keyframes = replace(plan.trajectory.keyframes, mission=tall)
    cropped = VerifiedIR(replace(plan.trajectory, keyframes=keyframes), plan.certificate)
    (board,) = shot_boards(framed(cropped, share=0.7, at=40.0, error=0.1, off=31.0))
    (worst,) = (m for m in board.moments if m.worst)
    assert worst.time == 40.0
    assert worst.worst.endswith(" m out of the frame")
    assert worst.framed[0].fault == "cropped"


def test_without_a_place_on_screen_it_is_where_the_edge_is_nearest() -> None:
    plan = framed(orbit_plan(), share=1.0, at=40.0, error=0.1, off=31.0)
    (board,) = shot_boards(VerifiedIR(plan.trajectory, plan.certificate[:-1]))
    (worst,) = (m for m in board.moments if m.worst)
    assert worst.time == 40.0
    assert worst.worst.endswith(" m from the frame's edge")


@pytest.mark.slow
def test_the_worst_is_written_with_its_number(monkeypatch: pytest.MonkeyPatch) -> None:
    texts: list[str] = []
    text = Canvas.text

    def written(self, x, y, words, *rest, **more):
        texts.append(words)
        text(self, x, y, words, *rest, **more)

    monkeypatch.setattr(Canvas, "text", written)
    draw_page(framed(orbit_plan(), share=1.0, at=40.0, error=0.0123, off=31.0), 60.0)
    assert [t for t in texts if t.startswith("worst")] == ["worst: screen error 0.013"]
    assert texts.count("W") == 2, "in its picture and on the map"
