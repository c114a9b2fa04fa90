"""What is told of a run, beside what is known of the plan that it flew in still air."""

from __future__ import annotations

import numpy as np
import pytest

from shotc.geom.solids import Cylinder
from shotc.ir.coverage import coverage
from shotc.ir.hidden import HALF_SHARE
from shotc.ir.mission import Zone
from shotc.ir.phases import UPRIGHT
from shotc.ir.rehearsal import RehearsalPromise
from shotc.simulation.conditions import Conditions
from shotc.simulation.flight import fly_all
from shotc.simulation.judge import Run, judged
from shotc.simulation.sensors import Gps
from shotc.simulation.verdict import enough, held, verdicts
from shotc.simulation.world import World
from tests.support.film_plans import orbit_plan
from tests.support.records import replace

EXACT = Conditions(gps=Gps(noise=0.0))


pytestmark = pytest.mark.slow  # the flight that they share takes a second


@pytest.fixture(scope="module")
def behind_a_tree():
    """Return the half orbit round a tower, with a tree half-way between the two in the middle of the shot."""
    ir = orbit_plan().trajectory
    (track,) = ir.drones
    shot = next(p for p in track.phases if p.shot)
    mission = ir.keyframes.mission
    x, y = (float(c) / 2 for c in track.curve((shot.start + shot.end) / 2)[:2])
    tree = Zone("oak", "out", Cylinder((x, y), 3.0, 0.0, 40.0), ("world", "zones", "oak"))
    keyframes = ir.keyframes._replace(mission=mission._replace(zones=(*mission.zones, tree)))
    return replace(ir, keyframes=keyframes), shot


@pytest.fixture(scope="module")
def run(behind_a_tree) -> Run:
    ir, _ = behind_a_tree
    world = World.of(ir, EXACT, (0,))
    (only,) = judged(world, ir, fly_all(world, ir.drones))
    return only


@pytest.mark.long
def test_what_hides_a_target_is_told_as_it_is_of_the_plan(behind_a_tree, run) -> None:
    ir, shot = behind_a_tree
    (track,) = ir.drones
    t = np.arange(shot.start, shot.end, 0.2)
    planned = coverage(ir.keyframes.mission, (), "tower", track.curve(t)[:, :3], t).share
    (picture,) = run.pictures
    assert picture.in_sight == pytest.approx(float(np.mean(planned <= HALF_SHARE)), abs=0.02)
    assert 0.3 < picture.in_sight < 0.97


def test_distances_are_those_of_the_plan_up_to_the_strays(behind_a_tree, run) -> None:
    ir, _ = behind_a_tree
    (track,), mission = ir.drones, ir.keyframes.mission
    times = np.concatenate([np.arange(p.start, p.end, 0.02) for p in track.phases if p.name not in UPRIGHT])
    places = track.curve(times)[:, :3]
    drone, (course,) = mission.drone("cam1"), run.courses
    near = {each.to: each.distance for each in course.near}
    oak = mission.zones[-1].solid
    level = np.hypot(places[:, 0] - oak.centre[0], places[:, 1] - oak.centre[1]) - oak.radius
    above = np.maximum(places[:, 2] - oak.top, 0.0)
    assert near["zone oak"] == pytest.approx(
        float(np.hypot(level, above).min()) - drone.radius, abs=course.farthest
    )
    assert near["ground"] == pytest.approx(float(places[:, 2].min()) - drone.radius, abs=course.farthest)
    assert course.nearest is not None
    assert course.nearest.distance == min(near.values())


def test_runs_are_counted_by_what_is_asked_of_them(run) -> None:
    worse = replace(run, number=1, pictures=(replace(run.pictures[0], in_frame=0.5),))
    best = replace(run, number=2, pictures=(replace(run.pictures[0], in_frame=0.9),))
    runs, promise = (worse, best, best), RehearsalPromise(in_frame=0.6, of=0.6)
    found = {each.key: each for each in verdicts(runs, promise)}
    assert found["in_frame"].held == 2
    assert found["in_frame"].run == 1
    assert found["in_frame"].worst == 0.5
    assert found["in_frame"].kept == 0.9
    assert not found["clearance"].written
    assert held(runs, tuple(found.values())) == 2
    assert enough(runs, promise) == 2
    assert enough(runs, RehearsalPromise(of=0.99)) == 3
