"""The generator, the statistics on scenes with known answers, and the report's forms."""

from __future__ import annotations

import ast
from math import radians
from pathlib import Path

import numpy as np
import pytest

from shotc.checking import check_source
from shotc.diag.registry import has_errors
from shotc.geom.bernstein import Piecewise
from shotc.geom.camera import View, frustum_margins, point_margins
from shotc.geom.shapes import CylinderShape
from shotc.ir.path import Mark, MovingLeg
from shotc.ir.phases import Phase
from shotc.ir.trajectory import DroneTrajectory
from tests.experiments.papers import lenses, page
from tests.experiments.papers import shown as shown_module
from tests.experiments.papers.framing import one, quality, solve_times
from tests.experiments.papers.missions import ASPECT, HFOV, convex_path, keyframes_of, missions
from tests.experiments.papers.report import Section, Table, html, markdown, text
from tests.experiments.papers.shown import Lens, four_points, percentile, shown, wanted

TABLE = Table("Times", ("name", "s"), (("a < b", "1"), ("c", "20")), ("a note",), b"PNG")


@pytest.mark.slow
def test_missions_depend_on_the_seed_and_their_number_only():
    assert missions(5) == missions(12)[:5]
    assert missions(3, seed=8) != missions(3)


@pytest.mark.slow
def test_check_accepts_every_mission_and_composition_puts_each_target_on_its_set():
    for draft in missions(60):
        assert not has_errors(check_source(draft.text.encode(), draft.name, None).diagnostics)
        ir = keyframes_of(draft)
        assert ir is not None
        (shot,) = ir.shots
        assert 4 <= len(shot.keyframes) <= 7
        assert len({k.target for k in shot.keyframes}) == draft.targets
        assert all(k.hfov == pytest.approx(HFOV) for k in shot.keyframes)
        assert ir.mission.drones[0].aspect == pytest.approx(ASPECT)


@pytest.mark.slow
def test_the_noise_of_the_authors_framing_is_as_stated():
    drafts = missions(60)
    off = np.array(
        [
            np.subtract(k.asked, meant)
            for draft in drafts
            for k, meant in zip(keyframes_of(draft).shots[0].keyframes, draft.intended, strict=True)
        ]
    )
    assert abs(off.mean()) < 0.03
    assert off.std() == pytest.approx(0.2, abs=0.02)


def still_leg(curve: Piecewise, target_places: list[tuple[float, float]]) -> tuple:
    draft = next(d for d in missions(20) if d.targets == 1)
    ir = keyframes_of(draft)
    first, second = ir.shots[0].keyframes[:2]
    keyframes = tuple(
        k._replace(reference=place) for k, place in zip((first, second), target_places, strict=True)
    )
    marks = tuple(Mark(float(s), None, i, ()) for i, s in enumerate((curve.start, curve.end)))
    leg = MovingLeg("shot", "film", curve, (), marks, (), 1.0, None, None, ())
    return ir.mission, keyframes, leg


@pytest.mark.slow
def test_a_camera_on_a_line_shows_what_geometry_says():
    # The camera slides sideways past a target straight ahead: u = -x / (d tan(hfov/2)), jerk zero.
    draft = next(d for d in missions(20) if d.targets == 1)
    target = keyframes_of(draft).mission.targets[0]
    distance, reach = 400.0, 40.0
    x, y, z = target.centre
    ends = np.array(
        [[x + side * reach, y - distance, z, radians(90), 0.0, radians(90), HFOV] for side in (-1, 1)]
    )
    share = np.linspace(0, 1, 6)[:, None]
    ctrl = ((1 - share) * ends[0] + share * ends[1])[None]
    curve = Piecewise(np.array([0.0, 2 * reach]), ctrl)
    mission, keyframes, leg = still_leg(curve, [(0.0, 0.0), (0.0, 0.0)])
    flown = DroneTrajectory(
        "cam", Piecewise(np.array([0.0, 20.0]), ctrl), (Phase("shot", "film", 0.0, 20.0),), (), ()
    )
    seen = shown(mission, keyframes, leg, flown)
    edge = reach / (distance * np.tan(HFOV / 2))
    assert seen.error.max() == pytest.approx(edge)
    assert seen.error.mean() == pytest.approx(edge / 2, rel=0.01)
    assert seen.p95 == pytest.approx(0.95 * edge, rel=0.01)
    assert seen.jerk == pytest.approx(0.0, abs=1e-9)
    assert seen.duration == 20.0
    assert seen.whole == seen.four_points == 1.0


@pytest.mark.slow
def test_what_is_wanted_is_the_keyframes_own_at_the_marks_and_half_of_each_half_way():
    curve = Piecewise(np.array([0.0, 10.0]), np.zeros((1, 6, 7)))
    mission, keyframes, leg = still_leg(curve, [(-1 / 3, 0.2), (1 / 3, 0.0)])
    _, radius, _, place = wanted(mission, keyframes, leg, np.array([0.0, 5.0, 10.0]))
    assert place == pytest.approx(np.array([[-1 / 3, 0.2], [0.0, 0.1], [1 / 3, 0.0]]))
    assert radius == pytest.approx(mission.target(keyframes[0].target).radius)


def test_what_is_shown_is_measured_by_code_of_its_own() -> None:
    tree = ast.parse(Path(str(shown_module.__file__)).read_text(encoding="utf-8"))
    for_types = [
        node for node in ast.walk(tree) if isinstance(node, ast.If) and "TYPE_CHECKING" in ast.dump(node.test)
    ]
    typed = {id(node) for block in for_types for node in ast.walk(block)}
    imports = [n for n in ast.walk(tree) if isinstance(n, ast.Import | ast.ImportFrom) and id(n) not in typed]
    assert not [n for n in imports if "shotc" in ast.unparse(n) or "tests" in ast.unparse(n)]


def test_it_agrees_with_the_compilers_camera() -> None:
    """Of random cameras and cylinders: the place on screen, the exact outline and the paper's four points."""
    dice = np.random.default_rng(3)
    states = np.zeros((400, 7))
    states[:, :3] = dice.uniform(-30, 30, (400, 3))
    states[:, 3:5] = dice.uniform((-4, -1.2), (4, 1.2), (400, 2))
    states[:, 6] = dice.uniform(0.3, 1.9, 400)
    offset = dice.uniform(-60, 60, (400, 3))
    radius, height = dice.uniform(0.1, 8, 400), dice.uniform(0.1, 20, 400)
    lens = Lens.of(states, ASPECT)
    yaw, pitch, wide = states[:, 3], states[:, 4], np.tan(states[:, 6] / 2)
    ours = View(np.cos(yaw), np.sin(yaw), np.cos(pitch), np.sin(pitch), wide, wide / ASPECT)
    x, y, z = offset.T
    u, v, depth = ours.project((x, y, z))
    screen, ahead = lens.project(offset)
    assert ahead == pytest.approx(depth, abs=1e-9)
    assert screen[depth > 1] == pytest.approx(np.stack([u, v], axis=1)[depth > 1], abs=1e-9)
    exact = np.min(frustum_margins(ours, (x, y, z), CylinderShape(radius, height)), axis=0)
    assert lens.inside(offset, radius, height) == pytest.approx(exact, abs=1e-9)
    four = np.min([lens.inside(point) for point in four_points(offset, radius, height)], axis=0)
    assert four == pytest.approx(
        np.min(point_margins(ours, (x, y, z), CylinderShape(radius, height)), axis=0), abs=1e-9
    )


def test_a_percentile_is_one_of_the_values():
    assert percentile(np.arange(1.0, 101.0), 0.95) == 95.0
    assert percentile(np.array([3.0]), 0.95) == 3.0


@pytest.mark.slow
def test_two_missions_from_text_to_table():
    results = {"none": [one(d.name, "none", convex_path(d)) for d in missions(2)]}
    for result in results["none"]:
        assert result.faults == ()
        assert result.shown.error.mean() < 0.05
        assert 0 < result.shown.jerk < 8.0
    ((name, *cells),) = quality(results).rows
    assert name == "none"
    assert cells[-1] == "100.00 %"
    assert [row[0][:6] for row in solve_times(results).rows] == ["paper:", "paper:"]


def test_a_table_in_every_form():
    assert text(TABLE).splitlines()[:4] == ["Times", "", "name    s", "a < b   1"]
    assert "| a < b | 1 |" in markdown([Section("Part", (TABLE,))])
    whole = html("Page", ["fact"], [Section("Part", (TABLE,))])
    assert "a &lt; b" in whole
    assert "data:image/png;base64,UE5H" in whole


def test_a_table_with_a_short_row_is_refused():
    with pytest.raises(ValueError, match="heading"):
        Table("T", ("a", "b"), (("1",),))


def test_the_page_is_filled_between_its_marks_again_and_again():
    bare = f"top\n\n{page.BEGIN}\n{page.END}\n"
    once = page.filled(bare, "body")
    assert page.filled(once, "body") == once
    assert once.startswith("top")
    assert "body" in once
    with pytest.raises(ValueError, match="marks"):
        page.filled("nothing", "body")


@pytest.mark.long
@pytest.mark.parametrize("lens", [20, 100])
def test_near_a_subject_the_refiner_shows_all_of_it_through_any_lens(lens):
    (draft,) = lenses.drawn(lens, 1)
    result = one(draft.name, "ours", convex_path(draft))
    assert result.faults == ()
    assert result.shown.margin.min() >= -lenses.TOUCH
    assert result.shown.error.mean() < 0.01


@pytest.mark.slow
def test_a_mission_beside_another_drone_is_the_same_mission():
    (draft,) = missions(1)
    alone, beside = (one(d.name, "none", convex_path(d)).shown for d in (draft, lenses.beside(draft)))
    assert beside.duration == pytest.approx(alone.duration, rel=1e-6)
    assert beside.error == pytest.approx(alone.error, abs=1e-6)
