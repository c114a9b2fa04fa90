"""Missions refined from text to plan: framing held between the keyframes, and nothing else broken."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from shotc_casadi import rounds
from shotc_casadi.conditions import OURS
from shotc_casadi.refiner import subjects
from shotc_casadi.rounds import MOST_ROUNDS, refine_shot

from shotc.api import emit_plan
from shotc.diag.registry import has_errors
from shotc.ir.owners import owner_of
from shotc.ir.path import MovingLeg
from shotc.planning.free_space import shortfall
from shotc.planning.timing.leg import fastest_moves, plan_of, timed_once
from shotc.planning.timing.limits import ceiling_of
from tests.support.few import few
from tests.support.path_scenes import assert_continuous, least_room
from tests.support.refiner_scenes import ARC, HEAD, compiled, keyed, leg_named, path_of, seen

pytestmark = pytest.mark.slow

NEAR = HEAD.replace("thirds", "center") + keyed(
    "at: [-60, -40, 12], look_at: tower", "at: [60, -26, 12], look_at: tower"
)
"""The straight way passes so near that the tower does not fit into the frame."""

MISSIONS = {
    "arc": keyed(*ARC),
    "zoom": keyed(
        ARC[0], "at: [0, -80, 18], look_at: tower, hfov: 50 deg", "at: [65, -30, 16], look_at: tower"
    ),
    "holds": keyed(ARC[0] + ", hold: 1", ARC[1] + ", hold: 2", ARC[2] + ", hold: 1.5"),
    "two-shots": keyed(*ARC[:2])
    + keyed("at: [20, 80, 10], look_at: mast", "at: [100, 80, 18], look_at: mast", shot="b", target="mast"),
    "two-targets": keyed(*ARC[:2], "at: [80, -40, 18], look_at: mast", "at: [110, 10, 18], look_at: mast"),
    "a-time": keyed(ARC[0], ARC[1] + ", time: 17", ARC[2], more="timing: {duration: 42}"),
    "orbit": "  - {id: s, kind: orbit, drone: cam, target: tower, radius: 45, altitude: 20, sweep: 90 deg}\n",
}


@cache
def planned(name, refiner="ours"):
    return compiled(HEAD + MISSIONS[name], refiner)


def sound(done):
    """Planned and verified, without a word about solvers or framing (V031 is of trees in the way)."""
    assert not has_errors(done.diagnostics), [d.message for d in done.diagnostics]
    assert done.plan is not None
    assert [d.code for d in done.diagnostics if d.code[0] in "RV" and d.code != "V031"] == []
    assert all(claim.holds for claim in done.plan.certificate if claim.hard)
    for drone in path_of(done).drones:
        for leg in drone.legs:
            if isinstance(leg, MovingLeg):
                assert_continuous(leg)


@pytest.mark.long
@pytest.mark.parametrize("name", list(MISSIONS))
def test_a_refined_mission_is_sound_and_framed_between_its_keyframes(name):
    done = planned(name)
    sound(done)
    for shot in [s.id for s in done.plan.trajectory.keyframes.mission.shots]:
        found = seen(done.plan, shot, 300)
        assert found.off.max() < 1e-3
        assert found.inside.min() > 0.0
    stats = dict(path_of(done).stats)
    assert stats["s.refine_solver"] == "fatrop"
    assert stats["s.refine_status"] == "solved"


@pytest.mark.long
@pytest.mark.parametrize("name", list(MISSIONS))
def test_placed_keyframes_are_passed_exactly(name):
    done = planned(name)
    placed = {p.shot.id: p.keyframes for p in path_of(done).keyframes.shots}
    for shot, keys in placed.items():
        leg = leg_named(path_of(done), shot)
        for mark in leg.marks:
            if keys[mark.index].placed:
                assert leg.curve(mark.s)[:3] == pytest.approx(keys[mark.index].at, abs=1e-8)
        assert leg.curve(leg.curve.start)[3:5] == pytest.approx(leg.pose[3:5], abs=1e-9)


@pytest.mark.parametrize("name", ["arc", "orbit"])
def test_clearances_hold_at_dense_samples(name):
    path = path_of(planned(name))
    made = path.keyframes.mission
    curve = leg_named(path).curve
    points = curve(np.linspace(curve.start, curve.end, 150))[:, :3]
    assert min(least_room(made, made.drones[0], tuple(p)) for p in points) >= -1e-6


@pytest.mark.long
def test_the_convex_path_crops_what_ours_shows():
    convex, ours, four = (compiled(NEAR, name) for name in ("none", "ours", "ours-4pt"))
    sound(ours)
    assert seen(convex.plan).inside.min() < -0.005
    assert seen(ours.plan).inside.min() > 0.0
    # The paper's four points lie on the axis of the tower: its near rim is cropped still.
    assert seen(four.plan).inside.min() < -0.005
    assert seen(four.plan).off.max() < 1e-3


WALLED = NEAR.replace(
    "zones: {", "zones: {wall: {keep: out, box: {center: [0, -36, 20], size: [30, 6, 40]}}, "
)
"""The camera cannot step back from the tower: it has to rise."""
LOW = WALLED.replace(
    "zones: {", "zones: {field: {keep: in, box: {center: [0, 0, 11.5], size: [180, 84, 3]}}, "
).replace("home: [0, -90, 0]", "home: [-60, -38, 0]")
"""Nor may it rise."""


def test_a_camera_that_cannot_step_back_backs_off_another_way():
    done = compiled(WALLED)
    sound(done)
    assert seen(done.plan).inside.min() > 0.0
    curve = leg_named(path_of(done)).curve
    assert curve(np.linspace(curve.start, curve.end, 50))[:, 2].max() > 15.0


@pytest.mark.long
def test_where_framing_and_a_wall_conflict_the_wall_wins_and_the_loss_is_told():
    done = compiled(LOW)
    assert done.plan is not None
    assert [d.code for d in done.diagnostics] == ["V030"]
    assert all(claim.holds for claim in done.plan.certificate if claim.hard)
    path = path_of(done)
    curve = leg_named(path).curve
    points = curve(np.linspace(curve.start, curve.end, 150))[:, :3]
    assert min(least_room(path.keyframes.mission, path.keyframes.mission.drones[0], p) for p in points) > 0
    assert dict(path.stats)["s.refine_rounds"] <= MOST_ROUNDS
    found, convex = seen(done.plan), seen(compiled(LOW, "none").plan)
    assert convex.inside.min() < found.inside.min() < 0.0
    assert found.off.max() < 0.01  # its place on screen yields a little to the whole of it


@pytest.mark.long
def test_what_the_nodes_do_not_keep_is_tightened_until_it_is_proved(monkeypatch):
    """A refiner that does not see the wall at its nodes finds it in the proof, and comes back."""
    real = rounds.half_spaces
    (subject,) = subjects(path_of(compiled(WALLED), "solve-path-qp"))
    wall = owner_of(subject.mission, "zone wall")
    monkeypatch.setattr(rounds, "half_spaces", lambda space, *rest: real(space.without(wall), *rest))
    found = refine_shot(subject, OURS)
    assert 1 < found.rounds <= MOST_ROUNDS
    assert found.camera is not None
    assert shortfall(subject.space, found.camera.ctrl[:, :, :3]).max() <= 0.0


def test_a_stated_turn_stays_a_turn():
    pan = (
        "at: [0, -90, 15], heading: 200 deg, pitch: 0 deg",
        "at: [60, -90, 15], heading: 1100 deg, pitch: -5 deg",
    )
    mission = HEAD + keyed(*pan).replace("    target: tower\n", "")
    for name in ("ours", "ang"):
        ctrl = leg_named(path_of(compiled(mission, name))).curve.ctrl[:, :, 3]
        assert ctrl[-1, -1] - ctrl[0, 0] == pytest.approx(-np.radians(900.0), abs=1e-6)


def test_angles_and_look_at_lead_through_the_authors_own_angles():
    convex = leg_named(path_of(planned("arc", "none")))
    for name in ("ang", "look-at"):
        done = planned("arc", name)
        assert done.plan is not None
        assert seen(done.plan).off.max() > 0.1
        path = path_of(done)
        path.check()  # the unfilmed legs lead to the new ends
        leg = leg_named(path)
        keys = path.keyframes.shots[0].keyframes
        for mark in leg.marks:
            key = keys[mark.index]
            q = leg.curve(mark.s)
            assert q[:3] == pytest.approx(key.at, abs=1e-8)
            assert key.asked == (0.0, 0.0)  # `look_at`; composition moves it from there
            d = np.array([0, 0, 12.0]) - q[:3]
            right = np.sin(q[3]) * d[0] - np.cos(q[3]) * d[1]
            assert right == pytest.approx(0.0, abs=0.1)  # of 76 m
            assert np.arctan2(d[2], np.hypot(d[0], d[1])) == pytest.approx(q[4], abs=2e-3)
        assert len(path.drones[0].legs) == len(path_of(planned("arc", "none")).drones[0].legs)
        assert leg.framing[0].reference(leg.curve.end) == pytest.approx(
            convex.framing[0].reference(convex.curve.end)
        )


def earliest():
    """Seconds at which the convex path's fastest flight passes the arc's second and last keyframe."""
    path = path_of(planned("arc", "none"))
    leg = leg_named(path)
    (move,) = fastest_moves(leg, plan_of(leg), ceiling_of(path.keyframes.mission.drones[0]))
    return [float(move.profile.arrival(mark.s)) for mark in leg.marks[1:]]


def test_a_duration_just_above_the_shortest_is_met():
    asked = round(1.03 * earliest()[-1], 2)
    done = compiled(HEAD + keyed(*ARC, more=f"timing: {{duration: {asked}}}"))
    sound(done)
    (phase,) = (p for p in done.plan.trajectory.drones[0].phases if p.shot == "s")
    assert phase.end - phase.start == pytest.approx(asked, abs=1e-6)
    assert seen(done.plan).off.max() < 0.02


def test_a_duration_that_is_too_short_is_told_by_the_time_pass_alone():
    done = compiled(HEAD + keyed(*ARC, more="timing: {duration: 14}"))
    assert done.plan is None
    assert not [d for d in done.diagnostics if d.code.startswith("R")]
    assert any("14" in d.message for d in done.diagnostics)


@pytest.mark.long
@pytest.mark.parametrize("share", few([1.02, 1.1, 1.3, 2.5], [1.1, 2.5]))
@pytest.mark.parametrize("index", [1, 2])
def test_a_keyframe_is_reached_at_its_time(index, share):
    asked = round(share * earliest()[index - 1], 2)
    done = compiled(HEAD + keyed(*(f"{k}, time: {asked}" if i == index else k for i, k in enumerate(ARC))))
    sound(done)
    (drone,) = done.plan.trajectory.drones
    (phase,) = (p for p in drone.phases if p.shot == "s")
    reached = [k.time for k in drone.keyframes if k.index == index]
    assert reached == pytest.approx([phase.start + asked], abs=1e-6)
    assert seen(done.plan).off.max() < 0.02


@pytest.mark.long
@pytest.mark.parametrize(
    "share", [0.9, pytest.param(0.1, marks=pytest.mark.fuzz), pytest.param(0.5, marks=pytest.mark.fuzz)]
)
def test_the_earliest_time_of_a_keyframe_is_what_the_limits_allow(share):
    least = earliest()[-1]
    done = compiled(HEAD + keyed(*ARC[:2], f"{ARC[2]}, time: {share * least:.2f}"))
    (fault,) = (d for d in done.diagnostics if d.code == "T002")
    told = float(fault.help.partition("time: ")[2].partition(" s")[0])
    assert told == pytest.approx(least, rel=0.03)
    sound(compiled(HEAD + keyed(*ARC[:2], f"{ARC[2]}, time: {told}")))


def test_a_turn_on_the_spot_stays_framed():
    text = HEAD + keyed(
        "at: [-60, -45, 10], look_at: tower, frame: left-third",
        "at: [-60, -45, 10], look_at: tower, frame: right-third",
    )
    done = compiled(text)
    sound(done)
    assert seen(done.plan).off.max() < 0.01


def test_a_still_shot_is_left_as_it_is():
    text = HEAD + (
        "  - {id: s, kind: static, drone: cam, target: tower, at: [-60, -45, 10], look_at: tower,"
        " timing: {duration: 4}}\n"
    )
    done = compiled(text)
    sound(done)
    assert path_of(done).drones == path_of(done, "solve-path-qp").drones
    assert not [name for name, _ in path_of(done).stats if "refine" in name]


def test_a_shot_that_frames_nothing_keeps_its_angles():
    head = HEAD.replace("rules: {composition: thirds}\n", "")
    rows = (
        "at: [-60, -45, 10], heading: 40 deg, pitch: -5 deg",
        "at: [0, -70, 18], heading: 100 deg, pitch: -15 deg",
        "at: [65, -30, 16], heading: 200 deg, pitch: 0 deg",
    )
    done = compiled(head + keyed(*rows).replace("    target: tower\n", ""))
    sound(done)
    ours, convex = leg_named(path_of(done)).curve, leg_named(path_of(done, "solve-path-qp")).curve
    s = np.linspace(ours.start, ours.end, 200)
    assert np.abs(ours(s)[:, 3:5] - convex(s)[:, 3:5]).max() < np.radians(1.0)


def test_a_gimbal_that_cannot_pitch_is_planned_with():
    head = HEAD.replace("home: [0, -90, 0]", "home: [0, -90, 0], gimbal: {pitch: [0 deg, 0 deg]}")
    done = compiled(
        head.replace("thirds", "center")
        + "  - {id: s, kind: orbit, drone: cam, target: mast, radius: 30, altitude: 8, sweep: 90 deg}\n"
    )
    sound(done)
    assert np.abs(leg_named(path_of(done)).curve.ctrl[:, :, 4]).max() < 1e-9
    assert seen(done.plan).off.max() < 5e-3


def test_the_same_mission_gives_the_same_bytes():
    timed_once.cache_clear()
    fresh = compiled(HEAD + MISSIONS["arc"])
    one, two = (
        next(a.data for a in emit_plan(done.plan, ["csv"]).artifacts if a.name == "plan.json")
        for done in (planned("arc"), fresh)
    )
    assert one == two
