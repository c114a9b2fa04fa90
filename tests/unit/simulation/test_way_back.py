"""Ways back to the plan, after shots and after outages, beside what stands in the way."""

from __future__ import annotations

import re
from functools import cache

import numpy as np
import pytest

from shotc.api import PlanOptions, compile_source
from shotc.ir.trajectory import TrajectoryIR
from shotc.plugin_api.replanner import Plan, Replan
from shotc.simulation import guidance
from shotc.simulation.conditions import Conditions
from shotc.simulation.deviation_faults import deviations
from shotc.simulation.film import film_of
from shotc.simulation.flight import fly
from shotc.simulation.judge import TrackingError, judged
from shotc.simulation.outages import Outage
from shotc.simulation.rehearsal import Rehearsed, rehearse
from shotc.simulation.runs import simulated
from shotc.simulation.way_back import CLEAR, WayBack
from shotc.simulation.world import World

pytestmark = pytest.mark.slow

ROUND = """\
shotc: 1
mission: round
world: {zones: {block: {keep: out, box: {center: [0, 0, 20], size: [12, 12, 40]}}}}
targets: {statue: {at: [60, 60, 5], radius: 0.5, height: 2}}
drones: {cam: {model: x500, home: [-14, -14, 0]}}
shots:
  - id: round
    kind: keyframes
    drone: cam
    target: statue
    keyframes:
      - {at: [-12, -12, 8], look_at: statue}
      - {at: [-12, 12, 8], look_at: statue}
      - {at: [12, 12, 8], look_at: statue}
      - {at: [12, -12, 8], look_at: statue}
"""
BESIDE = """\
shotc: 1
mission: beside
world: {zones: {wall: {keep: out, box: {center: [-4, -4, 22], size: [22, 1.5, 39]}}}}
targets:
  walker: {track: {start: [-24.2, 0, 0.9], velocity: [1.4, 0, 0]}, radius: 0.4, height: 1.8}
drones: {cam: {model: x500, home: [-10, 10, 0]}}
shots:
  - {id: side, drone: cam, target: walker, kind: lateral, side: right, distance: 8, altitude: 4,
     timing: {start: 15, duration: 10}, allow: [hidden-subject]}
"""


@cache
def planned(text: str) -> TrajectoryIR:
    done = compile_source(text.encode(), "m.yaml", None, PlanOptions("none"))
    assert done.plan is not None, done.diagnostics
    return done.plan.trajectory


def rehearsed(loop: str, lost: tuple[float, float]) -> Rehearsed:
    """Fly round the block; the drone has no positions while it is in the north-west."""
    ir, conditions = planned(ROUND), Conditions(loop=loop, outages=(Outage(*lost),))
    return rehearse(ir, conditions, simulated(ir, conditions, 1, 1), lambda _: None)


def near(course: TrackingError) -> float:
    return next(each.distance for each in course.near if each.to.startswith("zone"))


class Stays:
    """A replanner whose drones stay where they are."""

    def chase(self, problem):
        self.stages = problem.horizon
        return self

    def replan(self, situation, _last):
        n, step = self.stages
        still = np.zeros((n + 1, 3))
        times = situation.time + step * np.arange(n + 1)
        return Replan(Plan(times, situation.place + still, still, still[1:]), "planned")


def stayed() -> TrackingError:
    """Fly beside the wall with a replanner that leaves the drone on the wrong side of it."""
    ir = planned(BESIDE)
    world = World.of(ir, Conditions(loop="replan"), (0,))
    flown = fly(world, film_of(world.mission, ir.drones[0]), Stays())
    (run,) = judged(world, ir, (flown,))
    return run.courses[0]


@pytest.mark.long
def test_a_way_back_that_is_never_clear_is_never_flown_and_it_is_told(monkeypatch) -> None:
    course = stayed()
    assert near(course) > 0.0
    lands = next(p.start for p in planned(BESIDE).drones[0].phases if p.name == "land")
    assert course.replans.late == f"its landing at {lands:.1f} s"
    monkeypatch.setattr(guidance, "return_lack", lambda *_: CLEAR)
    course = stayed()
    assert near(course) < -0.5
    assert course.replans.late == ""


@pytest.mark.long
def test_after_an_outage_a_drone_that_replans_flies_round_what_others_fly_into() -> None:
    found = {}
    for loop in ("replay", "replan"):
        done = rehearsed(loop, (8.0, 14.0))
        found[loop] = near(done.runs[0].courses[0]), [d for d in deviations(done) if d.code == "W011"]
    clearance, (told,) = found["replay"]
    assert clearance < -4.0
    lack = re.search(
        r"1 of 1 runs the way lacks up to ([\d.]+) m of its clearance from zone block", told.notes[1]
    )
    assert float(lack[1]) == pytest.approx(-clearance, abs=0.5)
    clearance, (told,) = found["replan"]
    assert clearance > 0.0
    assert "it plans its way back" in told.notes[1]


def test_a_way_is_flyable_if_the_drone_is_fast_enough() -> None:
    ir = planned(ROUND)
    film = film_of(ir.keyframes.mission, ir.drones[0])
    times = 0.1 * np.arange(20)
    for speed, flyable in ((0.99 * film.fastest, True), (1.01 * film.fastest, False)):
        way = WayBack(times, times[:, None] * [speed, 0.0, 0.0], np.zeros((20, 3)))
        assert way.flyable(film) is flyable
