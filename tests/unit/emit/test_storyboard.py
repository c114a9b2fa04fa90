from __future__ import annotations

import struct
from math import inf, pi

import numpy as np
import pytest

from shotc.emit.screen import certified, guide_lines, percent, screen_tracks, summary
from shotc.emit.storyboard import DPI, EMITTER, frame, page
from shotc.emit.storyboard.canvas import Canvas, PageRectangle, Type, house_style
from shotc.emit.storyboard.content import shot_boards
from shotc.emit.storyboard.frame import compass, metres
from shotc.emit.storyboard.furniture import LOWER_FIRST, corner, round_length
from shotc.emit.storyboard.labels import MapLabel, free_room
from shotc.emit.storyboard.page import (
    FOOTNOTE,
    MARGIN_IN,
    SEPARATOR,
    WIDTH_IN,
    _footing_lines,
    headline,
    layout,
    not_promised,
)
from shotc.emit.storyboard.scene import painting_order
from shotc.emit.storyboard.sheet import outline, sheet_of
from shotc.geom.camera import yaw_of
from shotc.geom.shapes import CylinderShape
from shotc.ir.mission import Composition
from shotc.ir.trajectory import Claim, VerifiedIR
from shotc.rounding import as_minutes
from tests.support.film_plans import dense_plan, orbit_plan
from tests.support.records import replace


def size_of(png: bytes) -> tuple[int, int]:
    assert png[:8] == b"\x89PNG\r\n\x1a\n"
    assert png[-8:-4] == b"IEND"
    width, height = struct.unpack(">II", png[16:24])
    return width, height


@pytest.mark.slow
def test_the_storyboard_is_one_png_of_the_page_s_size_and_always_the_same() -> None:
    emission = EMITTER.emit(orbit_plan())
    (artifact,) = emission.artifacts
    assert artifact.name == "storyboard.png"
    width, height = size_of(artifact.data)
    assert width == WIDTH_IN * DPI
    assert 600 < height < 1400
    assert artifact.data == EMITTER.emit(orbit_plan()).artifacts[0].data
    assert b"Software" not in artifact.data
    assert b"tIME" not in artifact.data


@pytest.mark.slow
def test_the_user_s_plot_style_does_not_reach_the_page() -> None:
    import matplotlib as mpl

    plain = EMITTER.emit(orbit_plan()).artifacts[0].data
    with mpl.rc_context({"font.size": 30, "axes.facecolor": "red", "savefig.dpi": 30}):
        assert EMITTER.emit(orbit_plan()).artifacts[0].data == plain
        assert mpl.rcParams["font.size"] == 30


@pytest.mark.long
@pytest.mark.parametrize(
    ("plan", "panels"),
    [(orbit_plan(), 5), (dense_plan(placed=False), 6), (dense_plan(placed=True), 12)],
    ids=["all", "generated", "many"],
)
def test_one_panel_for_each_moment(plan: VerifiedIR, panels: int, monkeypatch: pytest.MonkeyPatch) -> None:
    drawn: list[int] = []
    draw = frame.draw_frame

    def counted(canvas: object, cell: object, moment: object, *rest: object) -> None:
        drawn.append(moment.number)  # type: ignore[attr-defined]
        draw(canvas, cell, moment, *rest)  # type: ignore[arg-type]

    monkeypatch.setattr(page, "draw_frame", counted)
    EMITTER.emit(plan)
    assert len(drawn) == panels
    assert drawn == sorted(set(drawn))


def test_moments_show_what_is_flown() -> None:
    plan = orbit_plan()
    (board,) = shot_boards(plan)
    assert (board.start, board.end, board.total) == (22.0, 52.0, 5)
    assert [m.number for m in board.moments] == [1, 2, 3, 4, 5]
    for moment, keyframe in zip(board.moments, plan.trajectory.keyframes.shots[0].keyframes, strict=True):
        np.testing.assert_allclose(moment.pose[:3], keyframe.at, atol=0.05)
        assert [subject.fault for subject in moment.framed] == [""]


def test_a_cropped_and_a_hidden_subject_are_marked() -> None:
    plan = orbit_plan()
    mission = plan.trajectory.keyframes.mission
    tower = mission.targets[0]
    tall = replace(mission, targets=(replace(tower, shape=CylinderShape(4.0, 90.0)),))
    wall = replace(tower, name="wall", centre=(0.0, -20.0, 20.0), shape=CylinderShape(5.0, 40.0))
    fenced = replace(mission, targets=(tower, wall))
    for changed, faults in ((tall, ["cropped"] * 5), (fenced, ["hidden", "", "", "", ""])):
        keyframes = replace(plan.trajectory.keyframes, mission=changed)
        other = VerifiedIR(replace(plan.trajectory, keyframes=keyframes), plan.certificate)
        (board,) = shot_boards(other)
        assert [subject.fault for moment in board.moments for subject in moment.framed] == faults


def test_the_worst_error_is_found_where_it_is() -> None:
    plan = orbit_plan()
    (track,) = screen_tracks(plan)
    error = np.zeros(len(track.t))
    error[700] = 0.25
    told = summary((replace(track, error=error), track))
    assert (told.error, told.time, told.shot) == (0.25, float(track.t[700]), "half")
    assert summary(()).error is None
    assert summary((replace(track, error=np.full(len(track.t), np.nan)),)).error is None


@pytest.mark.parametrize("aspect", [16 / 9, 4 / 3, 1.0, 9 / 16, 2.39])
@pytest.mark.parametrize("shots", [1, 4, 5, 12])
def test_panels_keep_their_aspect_and_fit_the_page(aspect: float, shots: int) -> None:
    place = layout(aspect, shots)
    assert place.picture[0] / place.picture[1] == pytest.approx(aspect)
    assert place.picture[0] <= place.cell + 1e-9
    assert place.columns >= 3
    used = place.map_width + 0.35 + place.columns * (place.cell + page.GAP_IN) - page.GAP_IN
    assert used <= WIDTH_IN - 2 * page.MARGIN_IN + 1e-9


def test_text_is_as_wide_as_measured() -> None:
    with house_style():
        canvas = Canvas(4.0, 1.0, 100.0)
        small, large = canvas.extent("a longer text", Type(8.0)), canvas.extent("a longer text", Type(16.0))
        assert large[0] == pytest.approx(2 * small[0], rel=0.03)
        assert canvas.extent("$x_1$", Type(9.0))[0] > canvas.extent("x1", Type(9.0))[0]
        fitted = canvas.fitted("a longer text", Type(16.0), 1.1)
        assert fitted.text == "a longer text"
        assert fitted.width == canvas.extent("a longer text", fitted.style)[0]
        assert 1.04 < fitted.width <= 1.1
        assert canvas.fitted("short", Type(8.0), 3.0).style.size == 8.0


@pytest.mark.parametrize("room", [1.0, 0.5, 0.3, 0.0])
def test_a_text_without_room_is_shortened_before_it_is_too_small_to_be_read(room: float) -> None:
    with house_style():
        canvas = Canvas(4.0, 1.0, DPI)
        found = canvas.fitted("all that there is to be said", Type(11.0), room)
        assert found.style.size == canvas.least_size
        assert found.text.endswith("…")
        assert found.width <= max(room, canvas.extent("…", found.style)[0])
        assert canvas.fitted("low", Type(5.0), 0.1).style.size == 5.0


def test_boxes() -> None:
    box = PageRectangle(0.0, 0.0, 2.0, 1.0)
    assert box.meets(PageRectangle(1.5, 0.5, 2.0, 2.0))
    assert not box.meets(PageRectangle(2.0, 0.0, 1.0, 1.0))
    assert box.holds(PageRectangle(0.5, 0.5, 1.0, 0.5))
    assert not box.holds(PageRectangle(0.5, 0.5, 1.0, 0.6))


@pytest.mark.parametrize(
    ("points", "us", "vs"),
    [
        (((0.0, 0.0),), (0.0,), (0.0,)),
        (((0.0, 0.0), (1 / 3, 1 / 3), (-1 / 3, -1 / 3)), (-1 / 3, 1 / 3), (-1 / 3, 1 / 3)),
        (tuple((i / 10, i / 20) for i in range(9)), (), ()),
    ],
)
def test_guide_lines_of_points(
    points: tuple[tuple[float, float], ...], us: tuple[float, ...], vs: tuple[float, ...]
) -> None:
    assert guide_lines(Composition("own", points=points)) == (us, vs)


def test_guide_lines_of_lines_and_of_keep() -> None:
    assert guide_lines(Composition("l", u_lines=(0.3, -0.3), v_lines=(0.0,))) == ((-0.3, 0.3), (0.0,))
    assert guide_lines(Composition("keep", keep=True)) == ((), ())


def test_what_stands_on_a_roof_is_painted_after_it_from_above_and_before_it_from_below() -> None:
    tower = orbit_plan().trajectory.keyframes.mission.targets[0]
    roof = replace(tower, name="roof", centre=(0.0, 0.0, 5.0), shape=CylinderShape(12.0, 10.0))
    mast = replace(tower, name="mast", centre=(0.0, 0.0, 13.0), shape=CylinderShape(0.5, 6.0))
    near = replace(tower, name="near", centre=(25.0, 0.0, 8.0), shape=CylinderShape(1.0, 16.0))

    def names(height: float) -> list[str]:
        order = painting_order((40.0, 0.0, height), [mast, near, roof])
        return [thing.name for thing in order]

    assert names(20.0) == ["roof", "mast", "near"]
    assert names(2.0) == ["mast", "roof", "near"]


@pytest.mark.parametrize("eye", [(0.0, 0.0, 60.0), (10.0, 0.0, 60.0), (40.0, 0.0, 22.0), (30.0, 30.0, 2.0)])
def test_what_is_inside_of_a_target_is_painted_after_it_from_everywhere(
    eye: tuple[float, float, float],
) -> None:
    tower = orbit_plan().trajectory.keyframes.mission.targets[0]
    light = replace(tower, name="light", centre=(0.0, 0.0, 12.0), shape=CylinderShape(4.0, 24.0))
    lantern = replace(tower, name="lantern", centre=(0.0, 0.0, 22.0), shape=CylinderShape(1.5, 3.0))
    for things in ([light, lantern], [lantern, light]):
        assert [thing.name for thing in painting_order(eye, list(things))] == ["light", "lantern"]


@pytest.mark.parametrize(("eye", "last"), [((10.0, 0.0, 60.0), "lantern"), ((40.0, 0.0, 22.0), "light")])
def test_of_targets_that_overlap_the_nearer_one_is_painted_last(
    eye: tuple[float, float, float], last: str
) -> None:
    tower = orbit_plan().trajectory.keyframes.mission.targets[0]
    light = replace(tower, name="light", centre=(0.0, 0.0, 12.0), shape=CylinderShape(4.0, 24.0))
    lantern = replace(tower, name="lantern", centre=(0.0, 0.0, 24.0), shape=CylinderShape(1.5, 4.0))
    for things in ([light, lantern], [lantern, light]):
        assert painting_order(eye, list(things))[-1].name == last


def test_words() -> None:
    assert [as_minutes(t) for t in (0.0, 59.96, 61.25, 3600.0)] == ["0:00.0", "1:00.0", "1:01.2", "60:00.0"]
    assert [compass(yaw_of(h * pi / 180)) for h in (0, 44.6, 180, 337.6, 359.7)] == [
        "000° N",
        "045° NE",
        "180° S",
        "338° N",
        "000° N",
    ]
    assert [percent(x) for x in (1.0, 0.9999, 0.5)] == ["100 %", "99.99 %", "50 %"]
    assert [percent(x) for x in (0.99999, 0.7279829, 0.998)] == ["99.99 %", "72.79 %", "99.8 %"]
    assert [metres(x) for x in (0.0, 9.94, 9.96, 120.4)] == ["0.0 m", "9.9 m", "10 m", "120 m"]
    assert [round_length(x) for x in (0.7, 1.0, 4.9, 5.0, 19.0, 200.0)] == [0.5, 1.0, 2.0, 5.0, 10.0, 200.0]


def test_the_headline_counts_hard_requirements() -> None:
    (claim,) = orbit_plan().certificate
    soft = replace(claim, hard=False, holds=False)
    assert headline((claim, soft)) == "All 1 requirements proved, 1 of them for every instant"
    assert headline((claim, replace(claim, holds=False))) == "1 of 2 requirements do not hold"


def framing_claims() -> tuple[Claim, ...]:
    (claim,) = orbit_plan().certificate
    soft = replace(claim, shot="half", upper=False, hard=False, holds=False, limit=1.0, unit="of samples")
    return (
        claim,
        replace(soft, constraint="tower in frame", worst=0.728, time=30.0),
        replace(soft, constraint="tower visible", worst=0.998, time=31.0),
        replace(soft, constraint="tower screen error", worst=0.2, time=32.0, holds=True),
        replace(soft, constraint="tower in frame", shot="other", worst=1.0, holds=True),
        replace(soft, constraint="tower screen error", shot="other", worst=inf, holds=True),
    )


def test_framing_is_what_the_certificate_says() -> None:
    whole, half, other = (certified(framing_claims(), shot) for shot in (None, "half", "other"))
    assert (half.error, half.time, half.shot, half.in_frame, half.visible) == (
        0.2,
        32.0,
        "half",
        0.728,
        0.998,
    )
    assert whole == half
    assert (other.error, other.in_frame, other.visible) == (None, 1.0, None)


def test_what_is_not_promised_is_named() -> None:
    assert not_promised(framing_claims()) == [
        "whole tower in frame 72.8 % (half)",
        "tower visible 99.8 % (half)",
    ]
    assert not_promised(framing_claims(), most=1) == ["whole tower in frame 72.8 % (half)", "1 more"]
    assert not_promised(orbit_plan().certificate) == []
    way = replace(framing_claims()[0], constraint="target tower on transits", unit="m", worst=1.84, shot=None)
    assert not_promised((replace(way, subject="cam1", hard=False, holds=False),)) == [
        "target tower on transits 1.84 m (cam1)"
    ]


def test_generated_shots_are_shown_evenly_in_time() -> None:
    (board,) = shot_boards(dense_plan(placed=False))
    assert [m.time for m in board.moments] == pytest.approx([22, 28, 34, 40, 46, 52])
    assert board.total is None
    assert {(s.target, s.reference, s.requested) for m in board.moments for s in m.framed} == {
        ("tower", (0.0, 0.0), None)
    }
    (board,) = shot_boards(dense_plan(placed=True))
    assert board.total == 31


@pytest.mark.parametrize("aim", [None, (0.0, 0.0, 12.0), (1.5, 0.1)])
def test_only_the_user_s_own_angles_are_shown_as_his_framing(aim: tuple[float, ...] | None) -> None:
    plan = orbit_plan()
    (shot,) = plan.trajectory.keyframes.shots
    written = replace(shot.shot.keyframes[0], aim=aim)  # type: ignore[arg-type]
    changed = replace(
        shot,
        shot=replace(shot.shot, keyframes=(written, *shot.shot.keyframes[1:])),
        keyframes=(replace(shot.keyframes[0], asked=(0.3, 0.0)), *shot.keyframes[1:]),
    )
    keyframes = replace(plan.trajectory.keyframes, shots=(changed,))
    (board,) = shot_boards(VerifiedIR(replace(plan.trajectory, keyframes=keyframes), plan.certificate))
    own = aim is not None and len(aim) == 2
    (subject,) = board.moments[0].framed
    assert subject.requested == ((0.3, 0.0) if own else None)
    assert subject.is_moved == own


SHEET = PageRectangle(1.0, 1.0, 4.0, 3.0)


def test_a_shot_that_travels_is_drawn_from_above_with_what_stands_about_it() -> None:
    plan = orbit_plan()
    mission = plan.trajectory.keyframes.mission
    (board,) = shot_boards(plan)
    sheet = sheet_of(SHEET, board, mission)
    assert sheet.is_plan
    for shape in (sheet.place(board.path), sheet.outline(mission.zones[0].solid)):
        assert SHEET.holds(PageRectangle(*shape.min(axis=0), *np.ptp(shape, axis=0)))
    np.testing.assert_allclose(
        sheet.place(np.array([[1.0, 0, 5], [0, 1, 5]])) - sheet.place(np.zeros(3)), np.eye(2) * sheet.inches
    )


def test_a_shot_that_rises_is_drawn_from_the_side() -> None:
    plan = orbit_plan()
    mission = plan.trajectory.keyframes.mission
    (board,) = shot_boards(plan)
    rise = np.stack([np.zeros(50), np.full(50, -40.0), np.linspace(10, 60, 50)], axis=-1)
    sheet = sheet_of(SHEET, replace(board, path=rise), mission)
    assert not sheet.is_plan
    np.testing.assert_allclose(sheet.axes, [[0, 1, 0], [0, 0, 1]], atol=1e-12)
    # The camera is 40 m left of the tower's axis, and heights are heights above the ground.
    foot, lens = sheet.place(np.array([0.0, 0.0, 0.0])), sheet.place(rise[-1])
    np.testing.assert_allclose((lens - foot) / sheet.inches, [-40, 60])
    tower = mission.targets[0]
    solid = replace(mission.zones[0].solid, centre=(0.0, 0.0), radius=tower.radius, top=24.0)  # type: ignore[call-arg]
    np.testing.assert_allclose(outline(sheet.axes, solid).min(axis=0), [-4, 0], atol=0.01)
    np.testing.assert_allclose(outline(sheet.axes, solid).max(axis=0), [4, 24], atol=0.01)
    assert SHEET.y < foot[1] < lens[1] < SHEET.top


def test_names_go_where_there_is_room_or_nowhere() -> None:
    label = MapLabel("house", (0.0, 0.0, 0.0), PageRectangle(2.0, 2.0, 0.4, 0.4), ("under", "over", "right"))
    size, under = (0.5, 0.1), PageRectangle(1.5, 1.8, 1.5, 0.2)
    room = free_room(size, SHEET, label, ([], []))
    assert room is not None
    assert room.top < 2.0
    over = free_room(size, SHEET, label, ([under], []))
    assert over is not None
    assert over.y > 2.4
    walls = [under, PageRectangle(1.0, 2.45, 4.0, 0.5)]
    right = free_room(size, SHEET, label, (walls, [under]))
    assert right is not None
    assert right.x > 2.4
    assert free_room(size, SHEET, label, ([*walls, PageRectangle(2.5, 1.0, 1.0, 3.0)], [])) is None
    # What is only to be avoided gives way.
    assert free_room(size, SHEET, label, ([], [SHEET])) == room


def test_furniture_stands_in_a_free_corner() -> None:
    lower_left, lower_right = PageRectangle(1.0, 1.0, 0.5, 0.5), PageRectangle(4.0, 1.0, 1.0, 0.5)
    size = (0.8, 0.3)
    assert corner(SHEET, size, LOWER_FIRST, []).x < 1.2
    assert corner(SHEET, size, LOWER_FIRST, [lower_left]).right > 4.8
    assert corner(SHEET, size, LOWER_FIRST, [lower_left, lower_right]).top > 3.8


def test_a_drone_in_the_picture_is_said_in_words() -> None:
    seen = replace(
        framing_claims()[1], constraint="cam2 out of the picture", unit="m", worst=-31.695, limit=0.0
    )
    words = not_promised((seen, replace(seen, unit="rad", worst=-0.1), replace(seen, constraint="x to y")))
    assert words == [
        "cam2 31.7 m inside the picture (half)",
        "cam2 5.7 deg inside the picture (half)",
        "x to y missed by 31.7 m (half)",
    ]


def test_the_footer_is_broken_into_lines_that_fit_the_page() -> None:
    seen = replace(framing_claims()[1], constraint="camera-two out of the picture", unit="m", worst=-31.695)
    claims = (*framing_claims(), *(replace(seen, shot=f"the-orbit-of-the-barn-{i}") for i in range(3)))
    lines = _footing_lines(claims, 100.0)
    assert len(lines) == 2
    parts = [part for line in lines for part in line.split(SEPARATOR)]
    assert parts[0].startswith("Worst screen error")
    assert parts[-1] == "2 more"
    canvas = Canvas(1.0, 1.0, 100.0)
    assert max(canvas.extent(line, FOOTNOTE)[0] for line in lines) <= WIDTH_IN - 2 * MARGIN_IN
    assert _footing_lines(framing_claims()[:1], 100.0) == [""]
