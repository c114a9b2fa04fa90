"""Shots of one target, planned anew: against closed forms, a second solver, and in flight."""

from __future__ import annotations

from dataclasses import fields, replace
from functools import cache
from math import inf, nan, pi

import numpy as np
import pytest
from shotc_casadi.replan.chase import ShotChase
from shotc_casadi.replan.steps import StopRule

from shotc.geom.solids import Cylinder, box
from shotc.plugin_api.replanner import ChaseWeights, Cone, Plan, Traffic
from tests.experiments.papers import chase as oracle
from tests.support.replans import (
    BESIDE,
    DT,
    LIMITS,
    TREE,
    WALK,
    Flown,
    beside,
    fly,
    lateral,
    problem,
    situation,
    zone,
)

HORIZONS = (5, 20, 40, 80)


def converged(*args, **given) -> ShotChase:
    return ShotChase(problem(*args, **given), StopRule(60, 1e-7))


def test_without_camera_and_zones_it_is_the_least_squares_optimum():
    n = 20
    weights = ChaseWeights(effort=0.7, pitch=0.0, yaw=0.0, height=3.0, end=5.0)
    given = situation(n, place=BESIDE - np.array([-0.5, 1.0, -0.7]), velocity=np.array([0.3, 0.2, -0.1]))
    done = ShotChase(problem(n, weights=weights)).replan(given, None)
    # Places and velocities of all stages are linear in the accelerations.
    steps = np.arange(1, n + 1)[:, None] - np.arange(n)[None] - 0.5
    to_place, to_velocity = DT**2 * np.where(steps > 0, steps, 0.0), DT * (steps > 0)
    t = DT * np.arange(1, n + 1)
    free = given.place + t[:, None] * given.velocity
    solved = []
    for axis in range(3):
        a = [np.sqrt(0.7) * np.eye(n), np.sqrt(5.0) * to_place[-1:], np.sqrt(5.0) * to_velocity[-1:]]
        b = [
            np.zeros(n),
            np.sqrt(5.0) * np.atleast_1d(given.wanted[axis] - free[-1, axis]),
            np.sqrt(5.0) * np.atleast_1d(given.wanted_velocity[axis] - given.velocity[axis]),
        ]
        if axis == 2:
            a.append(np.sqrt(3.0) * to_place)
            b.append(np.sqrt(3.0) * (3.0 - free[:, 2]))
        solved.append(np.linalg.lstsq(np.vstack(a), np.concatenate(b), rcond=None)[0])
    assert done.plan is not None
    assert done.plan.accelerations == pytest.approx(np.array(solved).T, abs=2e-3)
    assert done.status == "planned"
    assert done.lack == 0.0


def test_places_and_velocities_are_those_of_the_accelerations():
    done = ShotChase(problem(40, zone(TREE))).replan(situation(40), None)
    plan = done.plan
    assert plan is not None
    x, v, a = plan.places, plan.velocities, plan.accelerations
    assert x[1:] == pytest.approx(x[:-1] + DT * (v[:-1] + 0.5 * DT * a), abs=1e-9)
    assert v[1:] == pytest.approx(v[:-1] + DT * a, abs=1e-9)
    assert plan.times == pytest.approx(DT * np.arange(41))
    assert (x[0] == BESIDE).all()
    assert (v[0] == WALK).all()


COLD = {
    "free": ({}, ChaseWeights(end=10.0)),
    "from afar": ({"place": BESIDE - [3.0, 4.0, 0.0]}, ChaseWeights(end=10.0)),
    "calm in pitch": ({"place": BESIDE - [4.0, 1.0, 0.0]}, ChaseWeights(pitch=1e4, end=10.0)),
    "calm in yaw": ({"place": BESIDE - [4.0, 1.0, 0.0]}, ChaseWeights(yaw=20.0, end=10.0)),
    "past the tree": ({"time": 8.0}, ChaseWeights(end=10.0)),
    "beside the tree": ({"time": 6.0, "place": np.array([10.0, -9.0, 3.0])}, ChaseWeights(yaw=1.0, end=10.0)),
}


@pytest.mark.parametrize("name", COLD)
def test_converged_it_costs_what_a_second_solver_finds(name):
    n = 40
    given, weights = COLD[name][0], COLD[name][1]._replace(height=oracle.ALTITUDE)
    known = situation(n, **given)
    kept = {"margin": 0.0, "reaction": 0.0, "weights": weights}
    done = converged(n, zone(TREE), **kept).replan(known, None)
    assert done.plan is not None
    states = np.hstack([done.plan.places, done.plan.velocities])
    start = np.concatenate([known.place, known.velocity])
    wanted = np.concatenate([known.wanted, known.wanted_velocity])
    asked = oracle.Weights(weights.effort, weights.pitch, weights.yaw, weights.end)
    target = (known.target[0], WALK)
    task = oracle.Chase(start, wanted, target, (15.0, -7.5, 2.0), 3.0, asked, done.plan.places)
    theirs = oracle.solve(task)
    assert theirs.solved
    mine, best = (
        paid(x, u, task) for x, u in ((states, done.plan.accelerations), (theirs.states, theirs.inputs))
    )
    # What a step cuts off the circle is kept by one of the two alone.
    assert mine == pytest.approx(best, rel=4e-3, abs=3e-3)
    assert done.lack < 1e-3


def paid(states: np.ndarray, inputs: np.ndarray, task: oracle.Chase) -> float:
    """Return the cost of Eq. 12 as it is written, by the angles of Eq. 9 instead of their rates."""
    w, (at, moves) = task.weights, task.target

    def angles(shift: float) -> np.ndarray:
        t = DT * np.arange(len(states))[:, None]
        ray = at + t * moves + shift * moves - states[:, :3] - shift * states[:, 3:]
        return np.column_stack(
            [np.arctan2(ray[:, 1], ray[:, 0]), np.arctan2(ray[:, 2], np.hypot(ray[:, 0], ray[:, 1]))]
        )

    turned = angles(1e-5) - angles(-1e-5)
    rates = ((turned + pi) % (2 * pi) - pi)[:-1] / 2e-5
    cost = w.effort * (inputs**2).sum() + w.end * ((states[-1] - task.wanted) ** 2).sum()
    cost += 1e4 * ((states[:, 2] - task.height) ** 2).sum()
    return float(cost + w.yaw * (rates[:, 0] ** 2).sum() + w.pitch * (rates[:, 1] ** 2).sum())


@cache
def flown(stages: int, seed: int | None) -> Flown:
    return fly(ShotChase(problem(stages, zone(TREE))), lateral(stages, seed), 20.0)


@pytest.mark.slow
@pytest.mark.parametrize("seed", [None, 1, 2])
@pytest.mark.parametrize("stages", HORIZONS)
def test_a_vehicle_that_lags_never_enters_the_zone(stages, seed):
    one = flown(stages, seed)
    assert one.nearest(TREE) > 0.05
    assert {r.status for r in one.replans} <= {"planned", "stalled"}
    assert max(r.lack for r in one.replans) < 0.1  # of the margin of 0.15
    assert np.linalg.norm(one.velocities[:, :2], axis=1).max() < LIMITS.speed
    assert len(one.replans) == 40


def test_it_goes_on_to_its_place_beside_the_target():
    for stages in HORIZONS[1:]:
        assert np.linalg.norm(flown(stages, None).places[-1] - (20.0 * WALK + BESIDE)) < 1.0


@pytest.mark.parametrize("stages", HORIZONS)
def test_from_the_end_of_every_plan_it_can_stop_outside(stages):
    for done in flown(stages, 1).replans:
        plan = done.plan
        assert plan is not None
        p, v = plan.places[-1], plan.velocities[-1]
        speed = float(np.linalg.norm(v))
        way = 0.3 * speed + 0.5 * speed**2 / LIMITS.acceleration
        stopping = p + np.linspace(0.0, way, 50)[:, None] * v / speed
        assert np.hypot(*(stopping[:, :2] - TREE.centre).T).min() > TREE.radius + 0.1


def test_without_a_stop_half_a_second_ahead_is_too_short():
    plain = fly(ShotChase(problem(5, zone(TREE), margin=0.0, reaction=-0.5)), lateral(5), 12.0)
    assert plain.nearest(TREE) < 0.0  # what the two figures are for


@pytest.mark.parametrize("stages", [5, 40])
def test_boxes_roofs_and_notches_are_kept_clear_of(stages):
    house = box((15.0, -8.0, 1.0), (4.0, 3.0, 5.0), 0.3)
    one = fly(ShotChase(problem(stages, zone(house, 0.2))), lateral(stages, 4), 12.0)
    assert one.nearest(house) > 0.25


def test_it_stays_in_its_room():
    room = Cylinder((0.0, 0.0), 12.0, 0.0, 4.0)
    one = fly(ShotChase(problem(20, zone(room, 0.3, inside=True), floor=1.0)), lateral(20, 5), 12.0)
    assert np.hypot(*one.places[:, :2].T).max() < 11.8
    assert one.places[:, 2].max() < 3.8


def test_a_lower_priority_keeps_the_separation_and_the_picture_free():
    n = 40

    def known(t: float, p: np.ndarray, v: np.ndarray):
        # The other one stands in the way of the line of sight, and comes nearer.
        way = DT * np.arange(n + 1)[:, None] * WALK
        other = WALK * t + way + [3.0 - 0.2 * t, -5.0, 3.0]
        return situation(n, t, place=p, velocity=v, traffic=beside(other))

    planner = ShotChase(problem(n, separation=3.0, half_angle=pi / 6))
    one = fly(planner, known, 12.0, state=(BESIDE - [6.0, 0.0, 0.0], WALK))
    late = one.times > 2.0  # it begins with the other one in its picture
    other = one.times[:, None] * WALK + [3.0, -5.0, 3.0] - 0.2 * one.times[:, None] * [1.0, 0.0, 0.0]
    d, q = one.places - other, one.places - one.times[:, None] * WALK
    assert np.linalg.norm(d, axis=1).min() > 3.0
    beta = np.einsum("md,md->m", d, q) / np.linalg.norm(d, axis=1) / np.linalg.norm(q, axis=1)
    assert np.degrees(np.arccos(beta[late])).min() > 28.0  # its way towards the camera is not predicted


def test_it_stays_out_of_the_picture_of_another_drone():
    n = 20
    apex, axis = np.array([10.0, -20.0, 3.0]), np.array([0.0, 1.0, 0.0])
    cone = Cone(np.tile(apex, (n + 1, 1)), np.tile(axis, (n + 1, 1)), 0.2)

    def known(t: float, p: np.ndarray, v: np.ndarray):
        return situation(n, t, place=p, velocity=v, traffic=Traffic(np.zeros((0, n + 1, 3)), (cone,)))

    one = fly(ShotChase(problem(n)), known, 10.0)
    d = one.places - apex
    angle = np.arccos(d @ axis / np.linalg.norm(d, axis=1))
    assert angle.min() > 0.18
    seen = fly(ShotChase(problem(n)), lateral(n), 10.0).places - apex
    assert np.arccos(seen @ axis / np.linalg.norm(seen, axis=1)).min() < 0.1


def test_pitch_stays_in_its_range():
    n, low = 20, -0.6
    given = situation(n, height=None, wanted=np.array([3.0, -3.0, 5.0]))
    done = converged(n, pitch=(low, 0.0), weights=ChaseWeights(end=1e3)).replan(given, None)
    assert done.plan is not None
    q = (done.plan.places - given.target)[1:]
    pitch = np.arctan2(-q[:, 2], np.hypot(q[:, 0], q[:, 1]))
    assert pitch.min() == pytest.approx(low, abs=0.01)
    assert done.lack < 0.02


def test_limits_hold_in_every_plan():
    slow = LIMITS._replace(speed=2.0, climb=0.5, descent=0.4, acceleration=1.5)
    given = situation(30, wanted=np.array([40.0, 20.0, 9.0]), height=None)
    done = ShotChase(problem(30, limits=slow)).replan(given, None)
    plan = done.plan
    assert plan is not None
    assert np.linalg.norm(plan.velocities[:, :2], axis=1).max() < 2.0 + 0.02
    assert plan.velocities[:, 2].max() < 0.5 + 1e-3
    assert np.linalg.norm(plan.accelerations, axis=1).max() <= 1.5 + 1e-9


def test_who_is_too_fast_is_told_and_brakes():
    slow = LIMITS._replace(speed=2.0, acceleration=1.5)
    done = ShotChase(problem(30, limits=slow)).replan(situation(30, velocity=np.array([4.0, 0.0, 0.0])), None)
    assert done.status == "opened"
    assert done.plan is not None
    speeds = done.plan.velocities[:, 0]
    assert speeds[0] == 4.0
    assert speeds[25:].max() < 2.05
    assert (np.diff(speeds[:10]) < 0).all()


NUMBERS = ("place", "velocity", "target", "target_velocity", "wanted", "wanted_velocity")


@pytest.mark.parametrize("bad", [nan, inf, 1e200])
@pytest.mark.parametrize("name", NUMBERS)
def test_what_is_no_number_fails_at_once_and_leaves_the_next_call_sound(name, bad):
    planner = ShotChase(problem(20, zone(TREE)))
    sound = situation(20)
    before = planner.replan(sound, None)
    broken = np.array(getattr(sound, name), dtype=np.float64)
    broken[..., 1] = bad
    done = planner.replan(replace(sound, **{name: broken}), before.plan)
    if np.isfinite(bad):
        assert done.status in ("failed", "stalled", "opened", "planned")
    else:
        assert (done.status, done.plan) == ("failed", None)
        assert "not finite" in done.reason
    if done.plan is not None:
        assert all(
            np.isfinite(getattr(done.plan, f.name)).all() for f in fields(done.plan) if f.name != "aim"
        )
    assert same(planner.replan(sound, None), before)


def test_a_plan_or_a_message_that_is_no_number_fails_too():
    planner, sound = ShotChase(problem(20)), situation(20)
    plan = planner.replan(sound, None).plan
    assert plan is not None
    broken = replace(plan, accelerations=plan.accelerations * nan)
    assert "last plan" in planner.replan(sound, broken).reason
    assert "was sent" in planner.replan(situation(20, traffic=beside(np.full((21, 3), nan))), plan).reason
    assert "time" in planner.replan(replace(sound, time=nan), plan).reason
    assert "height" in planner.replan(replace(sound, height=nan), plan).reason


def test_inside_a_zone_it_leads_out():
    inside = situation(20, place=np.array([14.0, -7.0, 3.0]), velocity=np.zeros(3))
    done = ShotChase(problem(20, zone(TREE))).replan(inside, None)
    assert done.plan is not None
    assert done.lack > 0.5
    assert np.hypot(*(done.plan.places[-1, :2] - TREE.centre)) > TREE.radius


def test_the_same_calls_have_the_same_answers():
    known = lateral(20, 7)
    states = [(0.5 * k, BESIDE + k * np.array([0.75, -0.02, 0.0]), WALK) for k in range(6)]
    situations = [known(t, p, v) for t, p, v in states]

    def answers(planner: ShotChase):
        found, plan = [], None
        for one in situations:
            found.append(planner.replan(one, plan))
            plan = found[-1].plan
        return found

    planner = ShotChase(problem(20, zone(TREE)))
    first = answers(planner)
    for again in (answers(planner), answers(ShotChase(problem(20, zone(TREE))))):
        assert all(same(a, b) for a, b in zip(first, again, strict=True))
    alone = planner.replan(situations[3], first[2].plan)
    assert same(alone, first[3])  # it keeps nothing between calls


def same(a, b) -> bool:
    ends = (a.status, a.reason, a.lack, a.steps) == (b.status, b.reason, b.lack, b.steps)
    return ends and (a.plan.accelerations == b.plan.accelerations).all()


def test_a_replan_takes_one_step_and_the_first_one_a_few():
    one = flown(40, None)
    assert {r.steps for r in one.replans[1:]} == {1}
    assert one.replans[0].steps <= 30


def test_a_plan_of_other_steps_is_continued_too():
    planner, coarse = ShotChase(problem(20)), situation(20)
    times = np.array([0.0, 0.05, 0.3, 1.0])
    braking = np.array([[-0.5, 0.0, 0.0], [-1.0, 0.0, 0.0], [-0.2, 0.0, 0.0]])
    last = Plan(times, np.zeros((4, 3)), np.zeros((4, 3)), braking)
    index = planner._flight.index(0.1, last)
    assert index[:3].tolist() == [1, 1, 2]
    assert index[8:].tolist() == [2] + [3] * 11
    assert planner.replan(coarse, last).plan is not None


def test_a_plan_that_has_ended_is_continued_without_acceleration():
    planner = ShotChase(problem(5))
    plan = planner.replan(situation(5), None).plan
    later = planner.replan(situation(5, 60.0), plan)
    assert later.plan is not None
    assert np.abs(later.plan.accelerations).max() < 1e-3  # it is where it is to be
