"""Where moving targets may be; drones that plan anew keep clear of it, in chases and on their way back."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from shotc.geom.solid_arrays.points import signed_distance
from shotc.geom.solids import Cylinder
from shotc.geom.track import Track
from shotc.plugin_api.replanner import NO_WALLS, Walls
from shotc.simulation.conditions import Conditions, Outage
from shotc.simulation.flight import fly_all
from shotc.simulation.judge import Run, judged
from shotc.simulation.kalman import PositionFix
from shotc.simulation.seen import WALKS
from shotc.simulation.target_reach import TargetReach, with_targets
from shotc.simulation.tracker import Tracker
from shotc.simulation.truth import Truth
from shotc.simulation.world import World
from tests.support.compiled import compiled_text

MISSION = """\
shotc: 1
mission: cart
targets:
  cart: {track: {start: [-10, 0, 1.5], velocity: [1.4, 0, 0]}, radius: 1, height: 3}
drones: {cam: {model: x500, home: HOME}}
shots:
  - {id: side, drone: cam, target: cart, SHOT, altitude: 2.6, timing: {start: 12, duration: 8}}
"""
BESIDE = MISSION.replace("HOME", "[30, 12, 0]").replace("SHOT", "kind: lateral, side: right, distance: 5")
BEHIND = MISSION.replace("HOME", "[-12, -9, 0]").replace("SHOT", "kind: chase, distance: 6")


def reach(centre=(2.0, -1.0), radius=1.5, low=0.0, high=3.0, clearance=1.6, times=500) -> TargetReach:
    count = (times, 1)
    sizes = (np.full(count, size) for size in (radius, low, high))
    return TargetReach("cart", np.tile(np.array(centre), (*count, 1)), *sizes, clearance)


def test_half_spaces_hold_nothing_nearer_than_the_clearance() -> None:
    under_test, rng = reach(), np.random.default_rng(1)
    solid = Cylinder((2.0, -1.0), 1.5, 0.0, 3.0)
    places = rng.uniform([-3.0, -6.0, 0.3], [7.0, 4.0, 7.0], (500, 3))
    normal, least = under_test.half_spaces(0, places)
    assert np.linalg.norm(normal, axis=1) == pytest.approx(1.0)
    assert (normal[:, 2] >= 0.0).all()  # never below a target
    near = rng.uniform([-3.0, -6.0, 0.3], [7.0, 4.0, 7.0], (2000, 3))
    away = signed_distance(solid, near)
    for n, d in zip(normal[:50], least[:50], strict=True):
        assert (away[near @ n >= d] >= 1.6 - 1e-9).all()
    outside = signed_distance(solid, places)
    beyond = outside > 0.0
    assert under_test.lack(0, places)[beyond] == pytest.approx(1.6 - outside[beyond])
    assert beyond.any()
    assert not beyond.all()


def test_from_inside_the_nearer_of_side_and_top_leads_out() -> None:
    under_test = reach(times=3)
    normal, least = under_test.half_spaces(
        0, np.array([[2.0, -1.0, 2.9], [3.4, -1.0, 1.0], [2.0, -1.0, 1.0]])
    )
    assert normal == pytest.approx(np.array([[0, 0, 1], [1, 0, 0], [1, 0, 0]]))
    assert least == pytest.approx([4.6, 2.0 + 1.5 + 1.6, 2.0 + 1.5 + 1.6])


def test_half_spaces_of_targets_come_after_those_of_other_obstacles() -> None:
    places = np.array([[10.0, -1.0, 1.0], [9.0, -1.0, 1.0]])
    alone = with_targets(NO_WALLS, (reach(times=2),), 0, places)
    assert alone.offsets == pytest.approx(np.full((2, 1), 2.0 + 1.5 + 1.6))
    others = Walls(np.tile([0.0, 0.0, 1.0], (2, 3, 1)), np.zeros((2, 3)))
    both = with_targets(others, (reach(times=2),), 0, places)
    assert both.offsets == pytest.approx(np.hstack([others.offsets, alone.offsets]))
    assert with_targets(others, (), 0, places) is others


def test_the_spread_of_a_prediction_grows_from_that_of_the_estimate() -> None:
    tracker = Tracker.beginning(0.0, np.zeros((1, 3)), np.zeros((1, 3)), *WALKS)
    for k in range(1, 50):
        tracker.take(PositionFix(0.2 * k, np.zeros((1, 3)), 0.02, np.array([True])))
    spread = tracker.spread(np.array([9.8, 10.8, 12.8, 19.8]))[:, 0]
    now = tracker.now(9.8).covariance[0]
    assert spread[0] == pytest.approx(np.sqrt(now[0, 0]), rel=1e-6)
    assert spread[0] < 0.02
    assert (np.diff(spread) > 0.0).all()
    assert spread[3] > 5.0


def run_of(text: str, track: Track, lost: tuple[Outage, ...] = ()) -> Run:
    done = compiled_text(text, "none")
    assert done.plan is not None, done.diagnostics
    ir = done.plan.trajectory
    conditions = Conditions(loop="replan", outages=lost, truth=Truth(tracks=(("cart", track),)))
    if lost:
        conditions = replace(conditions, detector=None)
    world = World.of(ir, conditions, (0,))
    (run,) = judged(world, ir, fly_all(world, ir.drones))
    return run


def away(run: Run) -> float:
    return next(n.distance for n in run.courses[0].near if n.to == "target cart")


@pytest.mark.slow
@pytest.mark.long
@pytest.mark.parametrize("lost", [(), (Outage(17.0, 60.0, "cart"),)], ids=["seen", "lost"])
def test_the_way_back_keeps_clear_of_where_its_subject_may_be(monkeypatch, lost) -> None:
    """The cart turns to the drone's side, so it is between the drone and its plan when the shot ends."""
    turns = Track((0.0, 14.0, 34.0, 60.0), ((-10.0, 0.0, 1.5), (9.6, 0.0, 1.5), *((24.0, -20.0, 1.5),) * 2))
    assert away(run_of(BESIDE, turns, lost)) > 1.0
    monkeypatch.setattr("shotc.simulation.guidance.reaches", lambda *_: ())
    assert away(run_of(BESIDE, turns, lost)) < 0.0


@pytest.mark.slow
@pytest.mark.long
def test_a_chase_gives_way_to_a_subject_that_turns_back(monkeypatch) -> None:
    back = Track((0.0, 16.0, 60.0), ((-10.0, 0.0, 1.5), (12.4, 0.0, 1.5), (-49.2, 0.0, 1.5)))
    assert away(run_of(BEHIND, back)) > 0.3
    monkeypatch.setattr("shotc.simulation.guidance.reaches", lambda *_: ())
    assert away(run_of(BEHIND, back)) < 0.0
