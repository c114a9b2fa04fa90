"""Headings through the whole compiler: which way round the camera turns, and how often."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from shotc.api import PlanOptions, compile_source
from shotc.cli.summary import summary
from shotc.geom.vec import wrapped
from shotc.ir.drone import Drone
from shotc.ir.path import CAM_YAW, MovingLeg, leg_of
from shotc.ir.trajectory import VerifiedIR
from shotc.planning.path import unwrapping
from shotc.planning.path.unwrapping import Known, turned, turning
from shotc.solvers.conic import Status
from shotc.solvers.headings import METHODS
from shotc.solvers.headings.task import Headings, HeadingTask
from shotc.solvers.headings.virtual import by_virtual
from tests.support.front_passes import placed

pytestmark = pytest.mark.slow

MISSION = """\
shotc: 1
mission: look
drones:
  cam1: {{model: x500, home: [0, -10, 0], body: {body}}}
targets:
  tower: {{at: [15, 40, 6], radius: 2, height: 12}}
shots:
  - id: look
    kind: {kind}
    drone: cam1
"""
FREE = [[0, 0, 10], [10, 0, 10], [20, 0, 10], [30, 0, 10], [40, 0, 10]]


def mission(*headings: str, at=FREE, body: str = "forward") -> str:
    text = MISSION.format(body=body, kind="keyframes") + "    keyframes:\n"
    for place, aim in zip(at, headings, strict=False):
        where = aim if ":" in aim else f"heading: {aim} deg, pitch: 0 deg"
        text += f"      - {{at: {place}, {where}}}\n"
    return text


def flown(text: str, method: str | None = None):
    """The verified plan's compass headings at the shot's keyframes, whole turns kept, and all of them."""
    options = PlanOptions(refiner="none", headings=method)
    done = compile_source(text.encode(), "mission.yaml", Path(), options)
    assert done.plan is not None, [d.message for d in done.diagnostics]
    path = next(r.output for r in done.reports if r.name == "refine-path")
    (leg,) = [leg for leg in path.drones[0].legs if leg.shot]
    yaw = leg.curve(np.array([m.s for m in leg.marks]))[:, CAM_YAW]
    (phase,) = [p for p in done.plan.trajectory.drones[0].phases if p.shot]
    t = np.linspace(phase.start, phase.end, 2001)
    return 90.0 - np.degrees(yaw), 90.0 - np.degrees(done.plan.trajectory.drones[0].curve(t)[:, CAM_YAW])


def planned_leg(text: str, method: str) -> tuple[MovingLeg, VerifiedIR]:
    """Return the leg of the one shot, and its plan."""
    done = compile_source(text.encode(), "mission.yaml", Path(), PlanOptions(refiner="none", headings=method))
    assert done.plan is not None, [d.message for d in done.diagnostics]
    path = next(r.output for r in done.reports if r.name == "refine-path")
    return leg_of(path, "look"), done.plan


def who(plan: VerifiedIR) -> tuple[Drone, float]:
    """Return the drone of a plan, and the pace of its shot."""
    made = plan.trajectory.keyframes.mission
    return made.drones[0], made.shots[0].pace


def knowns(leg: MovingLeg, headings: tuple[str, ...]) -> list[Known]:
    """Return what the mission says of the camera's yaw, at the places of its keyframes."""
    yaw = [float(wrapped(np.pi / 2 - np.radians(float(h)))) for h in headings]
    last = len(yaw) - 1
    return [
        Known(mark.s, y, i, None, i == last) for i, (mark, y) in enumerate(zip(leg.marks, yaw, strict=True))
    ]


def turns(text: str, method: str | None = None) -> list[float]:
    return [round(float(x), 6) for x in np.diff(flown(text, method)[0])]


class TestMethods:
    def test_no_turn_is_made_the_long_way_for_the_wrap(self) -> None:
        for method in ("nearest", "winding", "virtual"):
            assert turns(mission("350", "10"), method) == [20.0]

    def test_nearest_swings_back_where_winding_turns_on(self) -> None:
        text = mission("350", "10", "200", "300")
        assert turns(text, "nearest") == [20.0, -170.0, 100.0]
        assert turns(text, "winding") == [20.0, 190.0, 100.0]
        assert turns(text) == turns(text, "winding")

    def test_bounded_stays_within_half_a_turn_of_east(self) -> None:
        # Yaws 100, 80, -110, 150 deg from East.
        assert turns(mission("350", "10", "200", "300"), "bounded") == [20.0, 190.0, -260.0]

    @pytest.mark.long
    @pytest.mark.parametrize("headings", [("350", "10", "200", "300"), ("0", "178", "357", "170", "10")])
    def test_the_curve_of_virtual_is_flown_and_that_of_others_is_not(self, headings: tuple[str, ...]) -> None:
        leg, plan = planned_leg(mission(*headings), "virtual")
        found = turned(knowns(leg, headings), turning(*who(plan), "virtual"))
        (turn,) = found.planned
        s = np.linspace(0.0, leg.curve.end, 1501)
        assert np.abs(leg.curve(s)[:, CAM_YAW] - turn.at(s)).max() < 1.5e-3
        # Its turns are those of `nearest`, but on the way it is elsewhere.
        plain, _ = planned_leg(mission(*headings), "nearest")
        assert np.degrees(np.abs(plain.curve(s)[:, CAM_YAW] - turn.at(s)).max()) > 20.0
        told = " ".join(summary(plan, [Path("out/plan.json")], []).split())
        assert "turns `look` as `virtual` plans them" in told

    def test_where_virtual_finds_no_curve_that_is_told(self, monkeypatch: pytest.MonkeyPatch) -> None:
        def none(task: HeadingTask, method: str) -> Headings:
            return Headings(Status.INFEASIBLE, by_virtual(task).angles, None)

        monkeypatch.setattr(unwrapping, "solve_headings", none)
        _, plan = planned_leg(mission("0", "90", "120"), "virtual")
        told = " ".join(summary(plan, [Path("out/plan.json")], []).split())
        assert "`look` turns steadily in 1 stretches: `virtual` finds no curve" in told

    @pytest.mark.parametrize("method", METHODS)
    def test_the_camera_meets_every_heading(self, method: str) -> None:
        asked = [350, 10, 200, 30, 170]
        at, _ = flown(mission(*map(str, asked)), method)
        assert np.abs((at - asked + 180) % 360 - 180).max() < 1e-6

    @pytest.mark.parametrize("body", ["forward", "follow-camera", "free"])
    def test_the_turns_are_steady(self, body: str) -> None:
        _, heading = flown(mission("350", "10", "200", "300", body=body))
        assert (np.diff(heading) > -1e-6).all()

    def test_a_stop_parts_the_turns(self) -> None:
        # From rest to rest the shorter way is the cheaper one.
        text = mission("350", "10", "200").replace(
            "heading: 10 deg, pitch: 0 deg", "heading: 10 deg, pitch: 0 deg, hold: 3"
        )
        assert turns(text) == [20.0, -170.0]


class TestStatedTurns:
    @pytest.mark.parametrize("method", METHODS)
    def test_a_heading_beyond_a_turn_says_how_far_to_turn(self, method: str) -> None:
        assert turns(mission("0", "450"), method) == [450.0]

    def test_turns_are_counted_from_the_number_before(self) -> None:
        assert turns(mission("0", "450", "720", "-360")) == [450.0, 270.0, -1080.0]

    def test_headings_within_a_turn_are_free_again(self) -> None:
        assert turns(mission("0", "450", "90")) == [450.0, 0.0]

    def test_exactly_one_turn_is_one(self) -> None:
        assert turns(mission("0", "360", "0")) == [360.0, 0.0]
        assert turns(mission("10", "-350", "-710")) == [0.0, -360.0]

    @pytest.mark.parametrize("body", ["forward", "follow-camera", "free"])
    def test_more_than_one_turn_is_flown(self, body: str) -> None:
        _, heading = flown(mission("0", "900", "1000", body=body))
        assert heading[-1] - heading[0] == pytest.approx(1000.0, abs=1e-3)

    def test_a_whole_turn_on_the_spot_takes_its_time(self) -> None:
        text = mission("0", "360", "10", at=[[0, 0, 10], [0, 0, 10], [20, 0, 10]])
        assert turns(text) == [360.0, 10.0]

    def test_what_is_looked_at_counts_from_north(self) -> None:
        text = mission("look_at: [0, 30, 10]", "540", at=[[0, 0, 10], [0, -10, 10]])
        assert turns(text) == [540.0]

    def test_turns_go_on_after_a_target(self) -> None:
        # Both keyframes at the tower follow it; then the camera goes round once.
        text = mission("look_at: tower", "look_at: tower", "720", at=[[0, 0, 10], [30, 0, 10], [40, 0, 10]])
        found = turns(text)
        assert abs(found[0]) < 90
        assert found[1] == pytest.approx(720.0 - np.degrees(np.arctan2(-15, 40)) % 360, abs=8.0)

    def test_an_orbit_turns_as_often_as_it_sweeps(self) -> None:
        text = MISSION.format(body="forward", kind="orbit")
        text += "    target: tower\n    radius: 20\n    altitude: 20\n    sweep: -720 deg\n"
        _, heading = flown(text)
        assert heading[-1] - heading[0] == pytest.approx(720.0, abs=0.1)


class TestTurnsThatLoseTheTarget:
    def test_a_turn_past_what_following_takes_is_an_error_at_its_heading(self) -> None:
        aim = "pitch: -5 deg, frame: keep"
        text = mission("look_at: tower", f"heading: 702 deg, {aim}", at=[[0, 0, 10], [30, 0, 10]])
        text = text.replace("    drone: cam1\n", "    drone: cam1\n    target: tower\n")
        _, found = placed(text)
        (fault,) = [d for d in found if d.code == "K013"]
        line = text.splitlines()[fault.labels[0].span.line - 1]
        assert "702 deg" in line
        assert "heading: 342 deg" in fault.help

    def test_going_round_with_the_target_may_be_counted(self) -> None:
        aim = "pitch: -5 deg, frame: keep"
        ring = [[15, 20, 10], [-5, 40, 10], [15, 60, 10], [35, 40, 10], [15, 20, 10]]
        text = mission(*(f"heading: {h} deg, {aim}" for h in (0, 90, 180, 270, 360)), at=ring)
        text = text.replace("    drone: cam1\n", "    drone: cam1\n    target: tower\n")
        _, found = placed(text)
        assert not [d for d in found if d.code == "K013"]
        assert turns(text) == [90.0] * 4

    def test_a_heading_past_ten_turns_is_a_slip(self) -> None:
        _, found = placed(mission("0", "3601"))
        assert found
