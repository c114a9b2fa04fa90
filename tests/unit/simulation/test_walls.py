"""Drones that plan anew keep clear of buildings and zones, in shots and on their way back from them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from shotc.api import PlanOptions, compile_source
from shotc.geom.track import Track
from shotc.ir.trajectory import TrajectoryIR
from shotc.plugin_api.replanner import NO_WALLS, Keeping, Plan
from shotc.simulation.conditions import Conditions
from shotc.simulation.film import film_of
from shotc.simulation.flight import fly_all
from shotc.simulation.judge import TrackingError, judged
from shotc.simulation.sent import Fading
from shotc.simulation.truth import Truth
from shotc.simulation.walls import MOST_HALF_SPACES, Standing
from shotc.simulation.way_back import WayBack
from shotc.simulation.wind import WindField
from shotc.simulation.world import World
from tests.support.scene_missions import feature, geojson, square

pytestmark = pytest.mark.slow

MISSION = """\
shotc: 1
mission: past
world: WORLD
targets:
  walker: {track: {start: [-20, 0, 0.9], velocity: [1.4, 0, 0]}, radius: 0.4, height: 1.8}
drones: {cam: {model: x500, home: HOME}}
rules: {obstacle_clearance: 2}
shots:
  - {id: side, drone: cam, target: walker, kind: lateral, side: right, distance: 8, altitude: 4,
     timing: {start: 12, duration: 26}}
"""
HOUSE = "{origin: {lat: 46.68, lon: 7.68, alt: 500}, buildings: {file: houses.geojson}}"
MAST = "{zones: {mast: {keep: out, cylinder: {center: [34, -15], radius: 4, height: [0, 30]}}}}"


def planned(folder: Path, world: str, home: str) -> TrajectoryIR:
    (folder / "houses.geojson").write_bytes(
        geojson(feature(square(18, -22, 12), name="House", building="yes", height=9))
    )
    text = MISSION.replace("WORLD", world).replace("HOME", home)
    done = compile_source(text.encode(), "m.yaml", folder, PlanOptions("none"))
    assert done.plan is not None, done.diagnostics
    return done.plan.trajectory


def flown(ir: TrajectoryIR, *points: tuple[float, float]) -> TrackingError:
    """Fly beside a walker who leaves his track at 20 s for places at 32 and 80 s."""
    ways = ((-20.0, 0.0, 0.9), (8.0, 0.0, 0.9), *((x, y, 0.9) for x, y in points))
    truth = Truth(tracks=(("walker", Track((0.0, 20.0, 32.0, 80.0), ways)),))
    world = World.of(ir, Conditions(loop="replan", wind=WindField(2.0, None, 0.5), truth=truth), (0,))
    (run,) = judged(world, ir, fly_all(world, ir.drones))
    return run.courses[0]


def nearest(course: TrackingError, to: str) -> float:
    return next(n.distance for n in course.near if n.to == to)


def standing(ir: TrajectoryIR) -> Standing:
    mission = ir.keyframes.mission
    return Standing.of(mission, mission.drones[0], Keeping(mission.drones[0].limits))


def test_no_place_that_keeps_its_half_spaces_is_too_near_to_a_building(tmp_path: Path) -> None:
    under_test = standing(planned(tmp_path, HOUSE, "[-10, -20]"))
    times = np.arange(31) * 0.1
    places = np.array([8.0, -10.0, 4.0]) + times[:, None] * [3.0, -1.0, 0.2]
    last = Plan(times, places, np.tile([3.0, -1.0, 0.2], (31, 1)), np.zeros((30, 3)))
    stages = 0.5 + times
    found = under_test.beside(last, stages)
    assert found.normals.shape == (31, MOST_HALF_SPACES, 3)
    rng = np.random.default_rng(3)
    tried = 0
    for k in range(30):
        here = np.array([np.interp(stages[k + 1], times, column) for column in places.T])
        assert (found.normals[k] @ here >= found.offsets[k] - 1e-9).all()
        near = here + rng.uniform(-6.0, 6.0, (400, 3))
        kept = (near @ found.normals[k].T >= found.offsets[k]).all(axis=1)
        assert (under_test.lacks(near[kept]) <= 1e-6).all()
        tried += int((under_test.lacks(near) > 0.0).any(axis=0).sum())
    assert tried > 1000


def test_a_mission_without_buildings_has_no_half_spaces(tmp_path: Path) -> None:
    ir = planned(tmp_path, MAST, "[-10, 10, 0]")
    plan = Plan(np.arange(31) * 0.1, np.zeros((31, 3)), np.zeros((31, 3)), np.zeros((30, 3)))
    assert standing(ir).beside(plan, plan.times) is NO_WALLS


@pytest.mark.long
def test_a_walker_who_leads_a_drone_into_a_house_does_not_get_it_there(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    ir = planned(tmp_path, HOUSE, "[-10, -20]")
    past = flown(ir, (20.0, -10.0), (85.0, -10.0))
    assert nearest(past, "buildings") > 1.7 - ir.keyframes.mission.drones[0].radius
    assert past.replans is not None
    assert past.replans.failed == 0
    monkeypatch.setattr(Standing, "beside", lambda *_: NO_WALLS)
    assert nearest(flown(ir, (20.0, -10.0), (85.0, -10.0)), "buildings") < 0.0


@pytest.mark.long
def test_the_way_back_after_a_shot_leads_past_a_zone(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    ir = planned(tmp_path, MAST, "[-10, 10, 0]")
    assert nearest(flown(ir, (26.0, -14.0), (100.0, -14.0)), "zone mast") > 0.0
    monkeypatch.setattr(Standing, "lacks", lambda _, places: np.full((1, len(places)), -1.0))
    monkeypatch.setattr(Standing, "name", lambda *_: "")
    monkeypatch.setattr(WayBack, "flyable", lambda *_: True)
    assert nearest(flown(ir, (26.0, -14.0), (100.0, -14.0)), "zone mast") < -1.0


def test_who_comes_back_begins_where_it_is_and_ends_on_its_plan(tmp_path: Path) -> None:
    ir = planned(tmp_path, MAST, "[-10, 10, 0]")
    film = film_of(ir.keyframes.mission, ir.drones[0])
    off, rate = np.array([2.0, -1.0, 0.5]), np.array([0.3, 0.2, -0.1])
    back = Fading.none(film, 3).begun(1, 20.0, 5.0, (off, rate))
    at = film.step(20.0)
    now = back.setpoint(20.0)
    assert now.position[1] == pytest.approx(film.position[at] + off)
    assert now.velocity[1] == pytest.approx(film.velocity[at] + rate)
    assert now.position[[0, 2]] == pytest.approx(np.tile(film.position[at], (2, 1)))
    times = np.array([20.0, 22.0, 24.0])
    one_by_one = np.array([back.setpoint(t).position[1] for t in times.tolist()])
    assert back.places(1, times) == pytest.approx(one_by_one)
    h = 0.01
    a, b, c = (back.setpoint(22.0 + d) for d in (-h, 0.0, h))
    assert (c.position - a.position)[1] / (2 * h) == pytest.approx(b.velocity[1], abs=1e-3)
    assert (c.velocity - a.velocity)[1] / (2 * h) == pytest.approx(b.acceleration[1], abs=1e-3)
    assert back.setpoint(25.0).position == pytest.approx(film.position[film.step(25.0)][None])


def test_who_is_far_off_and_fast_does_not_fly_on_for_long(tmp_path: Path) -> None:
    ir = planned(tmp_path, MAST, "[-10, 10, 0]")
    film = film_of(ir.keyframes.mission, ir.drones[0])
    off, rate = np.array([200.0, 0.0, 0.0]), np.array([11.0, 0.0, 0.0])
    times = np.arange(10.0, 40.0, 0.5)
    away = Fading.none(film, 1).begun(0, 10.0, 400.0, (off, rate)).places(0, times) - film.places(times)
    assert away[:, 0].max() < 250.0
