from __future__ import annotations

import struct
from dataclasses import replace
from math import pi

import numpy as np
import pytest

from shotc.emit.screen import guide_lines, percent, screen_tracks, summary
from shotc.emit.storyboard import DPI, EMITTER, frame, page
from shotc.emit.storyboard.canvas import Box, Canvas, Type, house_style
from shotc.emit.storyboard.content import shot_boards
from shotc.emit.storyboard.frame import clock, compass, metres
from shotc.emit.storyboard.map import round_length
from shotc.emit.storyboard.page import WIDTH, headline, layout
from shotc.emit.storyboard.scene import painting_order
from shotc.geom.camera import yaw_of
from shotc.ir.mission import Composition
from shotc.ir.trajectory import KeyframeTime, VerifiedIR
from tests.samples import orbit_plan


def dense_plan(*, placed: bool, count: int = 31) -> VerifiedIR:
    """The sample plan with many keyframes along its shot."""
    plan = orbit_plan()
    trajectory = plan.trajectory
    (shot,), (flight,) = trajectory.keyframes.shots, trajectory.drones
    keyframe = replace(shot.keyframes[0], placed=placed)
    written = replace(shot.shot, keyframes=shot.shot.keyframes[:1] * count)
    shots = (replace(shot, shot=written, keyframes=(keyframe,) * count),)
    times = tuple(KeyframeTime("half", i, float(t)) for i, t in enumerate(np.linspace(22, 52, count)))
    keyframes = replace(trajectory.keyframes, shots=shots)
    drones = (replace(flight, keyframes=times),)
    return VerifiedIR(replace(trajectory, keyframes=keyframes, drones=drones), plan.certificate)


def size_of(png: bytes) -> tuple[int, int]:
    assert png[:8] == b"\x89PNG\r\n\x1a\n"
    assert png[-8:-4] == b"IEND"
    width, height = struct.unpack(">II", png[16:24])
    return width, height


def test_the_storyboard_is_one_png_of_the_page_s_size_and_always_the_same() -> None:
    emission = EMITTER.emit(orbit_plan())
    (artifact,) = emission.artifacts
    assert artifact.name == "storyboard.png"
    width, height = size_of(artifact.data)
    assert width == WIDTH * DPI
    assert 600 < height < 1400
    assert artifact.data == EMITTER.emit(orbit_plan()).artifacts[0].data
    assert b"Software" not in artifact.data
    assert b"tIME" not in artifact.data


def test_the_user_s_plot_style_does_not_reach_the_page() -> None:
    import matplotlib as mpl

    plain = EMITTER.emit(orbit_plan()).artifacts[0].data
    with mpl.rc_context({"font.size": 30, "axes.facecolor": "red", "savefig.dpi": 30}):
        assert EMITTER.emit(orbit_plan()).artifacts[0].data == plain
        assert mpl.rcParams["font.size"] == 30


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
    (board,) = shot_boards(plan, screen_tracks(plan))
    assert (board.start, board.end, board.total) == (22.0, 52.0, 5)
    assert [m.number for m in board.moments] == [1, 2, 3, 4, 5]
    for moment, keyframe in zip(board.moments, plan.trajectory.keyframes.shots[0].keyframes, strict=True):
        np.testing.assert_allclose(moment.pose[:3], keyframe.at, atol=0.05)
        assert moment.fault == ""
    assert board.framing.in_frame == 1.0
    assert board.framing.error is not None
    assert board.framing.error < 1e-3


def test_a_cropped_and_a_hidden_subject_are_marked() -> None:
    plan = orbit_plan()
    mission = plan.trajectory.keyframes.mission
    tower = mission.targets[0]
    tall = replace(mission, targets=(replace(tower, height=90.0),))
    wall = replace(tower, name="wall", centre=(0.0, -20.0, 20.0), radius=5.0, height=40.0)
    fenced = replace(mission, targets=(tower, wall))
    for changed, faults in ((tall, ["cropped"] * 5), (fenced, ["hidden", "", "", "", ""])):
        keyframes = replace(plan.trajectory.keyframes, mission=changed)
        other = VerifiedIR(replace(plan.trajectory, keyframes=keyframes), plan.certificate)
        (board,) = shot_boards(other, screen_tracks(other))
        assert [moment.fault for moment in board.moments] == faults


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
    used = place.map_width + 0.35 + place.columns * (place.cell + page.GAP) - page.GAP
    assert used <= WIDTH - 2 * page.MARGIN + 1e-9


def test_text_is_as_wide_as_measured() -> None:
    with house_style():
        canvas = Canvas(4.0, 1.0, 100.0)
        small, large = canvas.extent("a longer text", Type(8.0)), canvas.extent("a longer text", Type(16.0))
        assert large[0] == pytest.approx(2 * small[0], rel=0.03)
        assert canvas.extent("$x_1$", Type(9.0))[0] > canvas.extent("x1", Type(9.0))[0]
        fitted = canvas.fitted("a longer text", Type(16.0), 0.7)
        assert canvas.extent("a longer text", fitted)[0] == pytest.approx(0.7, rel=0.05)
        assert canvas.extent("a longer text", fitted)[0] <= 0.7
        assert canvas.fitted("short", Type(8.0), 3.0).size == 8.0


def test_boxes() -> None:
    box = Box(0.0, 0.0, 2.0, 1.0)
    assert box.meets(Box(1.5, 0.5, 2.0, 2.0))
    assert not box.meets(Box(2.0, 0.0, 1.0, 1.0))
    assert box.holds(Box(0.5, 0.5, 1.0, 0.5))
    assert not box.holds(Box(0.5, 0.5, 1.0, 0.6))


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
    roof = replace(tower, name="roof", centre=(0.0, 0.0, 5.0), radius=12.0, height=10.0)
    mast = replace(tower, name="mast", centre=(0.0, 0.0, 13.0), radius=0.5, height=6.0)
    near = replace(tower, name="near", centre=(25.0, 0.0, 8.0), radius=1.0, height=16.0)

    def names(height: float) -> list[str]:
        order = painting_order((40.0, 0.0, height), [mast, near, roof])
        return [thing.name for thing in order]

    assert names(20.0) == ["roof", "mast", "near"]
    assert names(2.0) == ["mast", "roof", "near"]


def test_words() -> None:
    assert [clock(t) for t in (0.0, 59.96, 61.25, 3600.0)] == ["0:00.0", "1:00.0", "1:01.2", "60:00.0"]
    assert [compass(yaw_of(h * pi / 180)) for h in (0, 44.6, 180, 337.6, 359.7)] == [
        "000° N",
        "045° NE",
        "180° S",
        "338° N",
        "000° N",
    ]
    assert [percent(x) for x in (1.0, 0.9999, 0.5)] == ["100 %", "99.9 %", "50.0 %"]
    assert [metres(x) for x in (0.0, 9.94, 9.96, 120.4)] == ["0.0 m", "9.9 m", "10 m", "120 m"]
    assert [round_length(x) for x in (0.7, 1.0, 4.9, 5.0, 19.0, 200.0)] == [0.5, 1.0, 2.0, 5.0, 10.0, 200.0]


def test_the_headline_counts_hard_requirements() -> None:
    (claim,) = orbit_plan().certificate
    soft = replace(claim, hard=False, holds=False)
    assert headline((claim, soft)) == "All 1 requirements hold, 1 of them proved for every instant"
    assert headline((claim, replace(claim, holds=False))) == "1 of 2 requirements do not hold"
