"""Films whose drones plan anew as they fly."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from shotc import plugins
from shotc.api import PlanOptions, compile_source
from shotc.geom.track import Track
from shotc.plugin_api.replanner import Plan, Traffic
from shotc.simulation.conditions import Conditions, Outage
from shotc.simulation.film import film_of
from shotc.simulation.flight import fly_all
from shotc.simulation.judge import judged
from shotc.simulation.kalman import STATE_COUNT, Estimate
from shotc.simulation.seen import Foreseen
from shotc.simulation.situations import STAGE_S, ReplanInstant, replanned
from shotc.simulation.truth import Truth
from shotc.simulation.wind import WindField
from shotc.simulation.world import World, at_times

pytestmark = pytest.mark.slow

TWO = b"""\
shotc: 1
mission: two
targets:
  walker: {track: {start: [0, 0, 0.9], velocity: [1.2, 0, 0]}, radius: 0.4, height: 1.8}
drones:
  one: {model: x500, home: [-4, -3, 0]}
  two: {model: x500, home: [6, 8, 0], priority: 2}
rules: {separation: 3 m}
shots:
  - {id: behind, kind: chase, drone: one, target: walker, distance: 8, altitude: 3,
     timing: {start: 8, duration: 8}}
  - {id: beside, kind: lateral, drone: two, target: walker, distance: 8, altitude: 4, side: left,
     timing: {start: 8, duration: 8}}
"""


@cache
def plan():
    done = compile_source(TWO, "two.yaml", None, PlanOptions("none"))
    assert done.plan is not None, done.diagnostics
    return done.plan.trajectory


ACROSS = b"""\
shotc: 1
mission: across
targets:
  walker: {track: {start: [0, 0, 0.9], velocity: [1.2, 0, 0]}, radius: 0.4, height: 1.8}
drones:
  one: {model: x500, home: [0, -8, 0]}
  two: {model: x500, home: [0, 14, 0], priority: 2}
rules: {separation: 3 m, mutual_visibility: {half_angle: 25 deg, strength: require}}
shots:
  - {id: right, kind: lateral, drone: one, target: walker, distance: 8, altitude: 3, side: right,
     timing: {start: 12, duration: 10}}
  - {id: left, kind: flyby, drone: two, target: walker, behind: 14, ahead: -9, offset: 10, altitude: 4,
     timing: {start: 12, duration: 10}}
"""

WANDERS = Truth(1.0)


@cache
def flown(loop="replan", runs=(0, 1, 2), truth=WANDERS):
    conditions = Conditions(loop=loop, wind=WindField(2.0, None, 0.5), truth=truth)
    world = World.of(plan(), conditions, runs)
    return world, fly_all(world, plan().drones)


@pytest.mark.long
def test_a_drone_that_plans_anew_keeps_its_place_beside_a_walker_who_leaves_the_track():
    off = {}
    veers = Track((0.0, 60.0), ((0.0, 0.0, 0.9), (72.0, 18.0, 0.9)))
    for loop in ("track", "replan"):
        world, tracks = flown(loop, truth=Truth(tracks=(("walker", veers),)))
        times = np.arange(11.0, 16.0, 0.1)
        walker = at_times(world.places["walker"], world.times, times)
        beside = at_times(tracks[1].position, tracks[1].times, times) - walker
        off[loop] = float(np.abs(np.linalg.norm(beside[..., :2], axis=2) - 8.0).mean())
    assert off["replan"] < 0.7
    assert off["track"] > 2.0


@pytest.mark.long
def test_drones_that_plan_anew_keep_the_separation_and_come_back_to_their_plan():
    world, tracks = flown()
    runs = judged(world, plan(), tracks)
    for run in runs:
        apart = [n for c in run.courses for n in c.near if n.to == "drone two"]
        assert [n.distance > 3.0 - 2 * world.mission.drone("one").radius for n in apart] == [True]
        for course in run.courses:
            assert course.replans is not None
            assert course.replans.failed == 0
            assert course.replans.planned == 16
    for each, track in zip(tracks, plan().drones, strict=True):
        end = track.curve.end - 5.0
        off = at_times(each.position, each.times, np.array([end])) - track.curve(end)[:3]
        assert np.abs(off).max() < 1.0


@pytest.mark.long
def test_drones_that_plan_anew_keep_out_of_pictures_where_the_mission_requires_it(monkeypatch):
    """The walker turns aside, and brings the second drone behind the first, where its camera looks."""
    done = compile_source(ACROSS, "across.yaml", None, PlanOptions("none"))
    assert done.plan is not None, done.diagnostics
    ir = done.plan.trajectory
    veers = Track((0.0, 60.0), ((0.0, 0.0, 0.9), (72.0, -24.0, 0.9)))
    world = World.of(ir, Conditions(loop="replan", truth=Truth(tracks=(("walker", veers),))), (0,))
    (kept,) = judged(world, ir, fly_all(world, ir.drones))
    monkeypatch.setattr("shotc.simulation.guidance._cone_of", lambda *_: None)
    (free,) = judged(world, ir, fly_all(world, ir.drones))
    assert free.courses[0].spoiled == kept.courses[0].spoiled == 0.0
    assert kept.courses[1].spoiled < 0.6 * free.courses[1].spoiled
    assert kept.courses[1].replans.failed == 0


@pytest.mark.long
def test_a_run_is_the_same_whichever_ran_beside_it():
    _, several = flown()
    _, alone = flown(runs=(2,))
    assert several[1].position[:, 2] == pytest.approx(alone[1].position[:, 0], abs=1e-5)


def test_a_target_that_is_taken_to_be_in_the_ground_leads_no_drone_there():
    mission = plan().keyframes.mission
    film = film_of(mission, plan().drones[0])
    (shot,) = replanned(mission, film.track)
    at = shot.phase.start + 2.0
    stages = at + STAGE_S * np.arange(shot.stages + 1)
    sunk = np.zeros((1, STATE_COUNT))
    sunk[0, :3] = 24.0, 0.0, -50.0
    there = np.tile(sunk[:, :3], (len(stages), 1, 1))
    known = {"walker": Foreseen(Estimate(at, sunk, np.eye(STATE_COUNT)[None]), there, 0.0 * there)}
    drone = (film.position[film.step(at)], film.velocity[film.step(at)])
    free = Traffic(np.empty((0, len(stages), 3)))
    places, moves = (np.tile(each, (len(stages), 1)) for each in drone)
    last = Plan(stages, places, moves, np.zeros((shot.stages, 3)))
    of = ReplanInstant(known=known, last=last, run=0, turn=0.0, rise=-50.9, traffic=free)
    wanted = shot.situation(mission, film, stages, drone, of).wanted
    assert wanted[2] == mission.rules.over_ground(mission.drone("one").radius)


@pytest.mark.long
@pytest.mark.parametrize(
    ("plugin", "reason"),
    [
        ("RAISES", "ZeroDivisionError: no plan today"),
        ("NAN", "its plan holds numbers that are not finite"),
        ("SAYS_NO", "it does not know"),
        ("HANGS", "it took more than 1 s"),
    ],
)
def test_where_planning_anew_fails_the_drone_brakes_and_holds_and_it_is_told(monkeypatch, plugin, reason):
    plan()  # with the refiner that is installed
    monkeypatch.setattr("shotc.simulation.replanner_process.LIMIT_S", 1.0 if plugin == "HANGS" else 60.0)
    source = plugins.Source(None, "theirs", f"tests.support.failing_replanners:{plugin}")
    monkeypatch.setattr("shotc.plugins.one", lambda _group, _name: source)
    world, tracks = flown.__wrapped__(runs=(0,))
    (run,) = judged(world, plan(), tracks)
    for course in run.courses:
        assert course.replans.failed == 16  # twice a second
        assert course.replans.planned == 0
        assert course.replans.reason == reason
    # The first seconds of the plan are flown, then the drone stands.
    speed = at_times(tracks[0].velocity, tracks[0].times, np.array([10.0, 15.9]))
    assert np.linalg.norm(speed[0]) > 1.0
    assert np.linalg.norm(speed[1]) < 0.8
    assert np.isfinite(tracks[0].position).all()


@pytest.mark.long
def test_a_drone_whose_target_is_lost_stops_and_it_is_told():
    lost = (Outage(0.0, 100.0, "walker"),)
    conditions = Conditions(loop="replan", outages=lost, detector=None)
    world = World.of(plan(), conditions, (0,))
    (run,) = judged(world, plan(), fly_all(world, plan().drones))
    for course in run.courses:
        assert course.replans.failed == 0
        assert course.replans.lost == 16  # every time in the shot; the way back is planned without it
        assert course.replans.blind.startswith("`walker` is known to 4 m at best")


def test_shots_of_what_stands_and_of_several_are_flown_as_planned():
    assert [each.phase.shot for each in replanned(plan().keyframes.mission, plan().drones[0])] == ["behind"]
    mission = plan().keyframes.mission
    still = mission._replace(targets=tuple(t._replace(track=None) for t in mission.targets))
    assert not replanned(still, plan().drones[0])


DUO = b"""\
shotc: 1
mission: duo
targets:
  ann: {track: {start: [0, 0, 0.9], velocity: [1.0, 0, 0]}, radius: 0.4, height: 1.8}
  bob: {track: {start: [0, 2.5, 0.9], velocity: [1.0, 0, 0]}, radius: 0.4, height: 1.8}
drones: {cam: {model: x500, home: [16, 7, 0]}}
shots:
  - {id: both, kind: framing, drone: cam, timing: {start: 8, duration: 8},
     subjects: [{target: ann, frame: left-third}, {target: bob, frame: right-third}]}
"""


@pytest.mark.long
def test_a_framing_is_planned_anew_where_its_subjects_part():
    done = compile_source(DUO, "duo.yaml", None, PlanOptions("none"))
    assert done.plan is not None, done.diagnostics
    ir = done.plan.trajectory
    parts = Track((0.0, 7.0, 37.0), ((0.0, 2.5, 0.9), (7.0, 2.5, 0.9), (37.0, 12.5, 0.9)))
    error = {}
    for loop in ("track", "replan"):
        conditions = Conditions(loop=loop, truth=Truth(tracks=(("bob", parts),)))
        world = World.of(ir, conditions, (0,))
        (run,) = judged(world, ir, fly_all(world, ir.drones))
        error[loop] = run.error
    assert run.courses[0].replans.planned == 16
    assert run.courses[0].replans.failed == 0
    assert error["replan"] < 0.8 * error["track"]
