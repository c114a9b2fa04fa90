"""Shots of moving targets: the ideal, the guide that follows it, and the proof of what is flown."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from shotc.geom.bernstein import Piecewise
from shotc.geom.track import Track
from shotc.geom.track_array import places, seen_from
from shotc.ir.ideal import ideal_place
from shotc.ir.path import BODY_YAW, CAM_YAW
from shotc.ir.trajectory import VerifiedIR
from tests.support.compiled import compiled_text
from tests.support.front_passes import clean

pytestmark = pytest.mark.slow

RUN = """\
shotc: 1
mission: run
targets:
  runner:
    track: {{points: [[0, 0, 0.9], [60, 0, 0.9], [90, 30, 0.9]], speed: {speed}}}
    radius: 0.4
    height: 1.8
drones:
  cam1: {{model: x500, home: [45, -20, 0]{drone}}}
{world}shots:
  - {{id: s, drone: cam1, target: runner, timing: {{start: 15, duration: 12}}, {shot}}}
"""


def text(shot: str, *, speed: str = "3 m/s", drone: str = "", world: str = "") -> bytes:
    return RUN.format(shot=shot, speed=speed, drone=drone, world=world).encode()


def planned(mission: bytes) -> VerifiedIR:
    done = compiled_text(mission.decode(), "none", "m.yaml")
    assert done.plan is not None, done.diagnostics
    return done.plan


def said(mission: bytes) -> list[str]:
    return [d.code for d in compiled_text(mission.decode(), "none", "m.yaml").diagnostics]


def claim(plan: VerifiedIR, name: str) -> float:
    return next(c.worst for c in plan.certificate if c.constraint == name)


KINDS = {
    "chase": "kind: chase, distance: 8, altitude: 4",
    "lead": "kind: lead, distance: 10, altitude: 4",
    "lateral": "kind: lateral, side: right, distance: 8, altitude: 4",
    "flyby": "kind: flyby, behind: 10, ahead: 10, offset: 5, altitude: 4",
    "orbit": "kind: orbit, radius: 9, altitude: 5, sweep: 90 deg, start_azimuth: 180 deg",
    "elevator": "kind: elevator, azimuth: 180 deg, distance: 10, altitude: [4, 9]",
    "static": "kind: static, at: [60, -25, 5], look_at: runner",
    "follow-path": "kind: follow-path, points: [[40, -12, 4], [70, -8, 4]], look_at: runner",
}


@pytest.mark.long
@pytest.mark.parametrize("kind", KINDS)
def test_every_kind_films_a_moving_target_and_is_proved(kind: str) -> None:
    plan = planned(text(KINDS[kind]))
    assert claim(plan, "runner in frame") == 1.0
    assert claim(plan, "distance from its place") < 1.5
    assert claim(plan, "runner screen error") < 0.2
    phase = next(p for d in plan.trajectory.drones for p in d.phases if p.shot == "s")
    assert (phase.start, phase.end) == (15.0, 27.0)


def test_the_ideal_of_a_lateral_is_beside_the_motion_and_that_of_a_chase_behind_it() -> None:
    for kind, offset in (("lateral", (0.0, -8.0)), ("chase", (-8.0, 0.0))):
        ir = clean(text(KINDS[kind]).decode())
        shot = ir.mission.shots[0]
        for t, heading in ((10.0, 0.0), (27.0, pi / 4)):
            target = ir.mission.target("runner").at(t)
            place = ideal_place(ir.mission, shot, 5.0, t)
            along = np.array([np.cos(heading), np.sin(heading)])
            across = np.array([-along[1], along[0]])
            wanted = np.array(target[:2]) + offset[0] * along + offset[1] * across
            assert np.allclose(place[:2], wanted)
            assert place[2] == 4.0


def test_along_a_straight_even_motion_the_guide_is_the_ideal() -> None:
    plan = planned(text(KINDS["lateral"], speed="2 m/s"))
    assert claim(plan, "distance from its place") < 0.02
    assert claim(plan, "runner screen error") < 1e-3


def test_a_flyby_ends_ahead_of_its_target() -> None:
    plan = planned(text(KINDS["flyby"]))
    mission = plan.trajectory.keyframes.mission
    for t, ahead in ((15.0, -10.0), (27.0, 10.0)):
        runner = mission.target("runner")
        facing = runner.track.heading(t)
        away = plan.trajectory.drones[0].curve(t)[:2] - np.array(runner.at(t)[:2])
        assert away @ [np.cos(facing), np.sin(facing)] == pytest.approx(ahead, abs=1.0)


def test_a_shot_keeps_clear_of_a_zone_that_its_ideal_runs_through() -> None:
    world = "world: {zones: {shed: {keep: out, box: {center: [55, -8, 3], size: [3, 3, 8]}}}}\n"
    plan = planned(text(KINDS["lateral"], world=world))
    assert claim(plan, "zone shed") >= -1e-6
    assert claim(plan, "distance from its place") > 1.0
    assert "M008" in said(text(KINDS["lateral"], world=world))


@pytest.mark.long
def test_a_pass_over_its_target_keeps_the_clearance_at_every_instant() -> None:
    plan = planned(text("kind: flyby, behind: 8, ahead: 8, altitude: 4"))
    assert claim(plan, "target runner") >= 1.0 - 1e-6
    low = planned(text("kind: flyby, behind: 8, ahead: 8, altitude: 3").replace(b"start: 15", b"start: 19"))
    assert claim(low, "target runner") >= 1.0 - 1e-6
    assert claim(low, "distance from its place") > 0.3


@pytest.mark.long
@pytest.mark.parametrize("body", ["forward", "free", "follow-camera"])
def test_the_gimbal_and_the_body_keep_their_ranges_whatever_the_body_does(body: str) -> None:
    plan = planned(text(KINDS["flyby"], drone=f", body: {body}"))
    curve = plan.trajectory.drones[0].curve
    relative = curve(np.linspace(15.0, 27.0, 200))
    if body == "follow-camera":
        assert np.allclose(relative[:, CAM_YAW], relative[:, BODY_YAW])
    assert claim(plan, "runner in frame") == 1.0


def test_a_shot_without_a_start_begins_when_its_drone_is_there() -> None:
    late = text(KINDS["chase"], speed="1 m/s").replace(b"start: 15, ", b"")
    plan = planned(late)
    phases = plan.trajectory.drones[0].phases
    shot = next(p for p in phases if p.shot == "s")
    assert 5.0 < shot.start < 30.0
    waits = [p for p in phases if p.name == "transit" and p.end - p.start > 15.0]
    assert not waits


def test_a_start_that_comes_too_early_is_told_with_the_earliest() -> None:
    early = text(KINDS["chase"]).replace(b"start: 15", b"start: 6")
    done = compiled_text(early.decode(), "none", "m.yaml")
    assert [d.code for d in done.diagnostics if d.code.startswith("T")] == ["T003"]
    assert "earliest that is found" in done.diagnostics[-1].message
    assert "with a stop before the run-up, which is the last" in done.diagnostics[-1].notes[0]


@pytest.mark.long
def test_a_start_that_only_a_way_without_a_stop_reaches_is_kept_though_the_drone_turns_first() -> None:
    """The turn before the way depends on when it begins: it was 1e-5 s late after three tries (T003)."""
    mission = b"""\
shotc: 1
mission: wave
targets: {surfer: {track: {points: [[0, 60, 0.9], [170, 45, 0.9]], speed: 5.4 m/s}, radius: 0.6, height: 1.8}}
drones: {cam1: {model: air-3, home: [31.8, 0, 0], limits: {speed: 9.2 m/s}}}
shots:
  - {id: along, kind: lateral, drone: cam1, target: surfer, side: right, distance: 10.2, altitude: 4,
     timing: {start: 12, duration: 4}}
"""
    film = next(p for p in planned(mission).trajectory.drones[0].phases if p.shot)
    assert film.start == pytest.approx(12.0)


def test_two_shots_of_moving_targets_follow_one_another_and_one_of_a_standing_target() -> None:
    shots = text(KINDS["chase"]).decode()
    shots += (
        "  - {id: two, kind: lateral, drone: cam1, target: runner, side: left, distance: 8, altitude: 4,\n"
        "     timing: {duration: 4}}\n"
        "  - {id: three, kind: static, drone: cam1, at: [60, 0, 10], heading: 0 deg, pitch: 0 deg}\n"
    )
    plan = planned(shots.encode())
    filmed = [p.shot for p in plan.trajectory.drones[0].phases if p.shot]
    assert filmed == ["s", "two", "three"]


@settings(deadline=None, max_examples=40)
@given(
    steps=st.lists(st.tuples(*[st.floats(-20, 20)] * 3), min_size=2, max_size=8),
    gaps=st.lists(st.floats(0.2, 9.0), min_size=8, max_size=8),
    after=st.tuples(*[st.floats(-3, 3)] * 3),
)
def test_a_curve_seen_from_a_target_is_the_curve_less_its_motion(steps, gaps, after) -> None:
    times = tuple(float(t) for t in np.cumsum(gaps[: len(steps)]))
    track = Track(times, tuple(steps), after=after)
    rng = np.random.default_rng(len(steps))
    curve = Piecewise(np.array([0.0, 7.0, 20.0]), rng.normal(size=(2, 6, 3)))
    t = np.linspace(0.0, 20.0, 171)
    assert np.allclose(seen_from(curve, track)(t), curve(t) - places(track, t), atol=1e-9)
    assert np.allclose(places(track, t), [track.at(float(u)) for u in t], atol=1e-9)


def test_a_camera_that_keeps_its_aim_does_not_turn_to_its_target() -> None:
    plan = planned(text("kind: static, at: [58, -25, 5], heading: 0 deg, pitch: -5 deg"))
    yaw = plan.trajectory.drones[0].curve(np.linspace(15.0, 27.0, 50))[:, CAM_YAW]
    assert np.abs(yaw - pi / 2).max() < 1e-6
    assert claim(plan, "distance from its place") < 0.02
    assert "F004" not in said(text(KINDS["static"]))
