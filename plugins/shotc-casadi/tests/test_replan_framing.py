"""Shots that compose subjects, planned anew: closed forms, a second solver, and flights."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from math import nan, pi

import casadi as ca
import numpy as np
import pytest
from shotc_casadi.replan import framing
from shotc_casadi.replan.evaluation import Evaluation, StageExpressions
from shotc_casadi.replan.framing import Framing
from shotc_casadi.replan.pictures import Symbols, clear, in_field, uncovered
from shotc_casadi.replan.steps import StopRule

from shotc.geom.camera import view
from shotc.plugin_api.replanner import Appearance, DrawnPose, FilmedSubject, FramingWeights
from tests.support.framings import (
    AIM,
    BODY,
    HALF,
    HEADS,
    SIZE,
    SLOW,
    STAND,
    Film,
    Swaying,
    appears,
    film,
    problem,
    seen_from,
    situation,
    subject,
)
from tests.support.replans import DT, beside

N = 25
STILL = np.zeros(3)
CONVERGED = StopRule(60, 1e-7)


def alone(wanted: Appearance, **given):
    return situation(N, (subject(HEADS[0], STILL, N, wanted),), **given)


@cache
def flown(count: int, stages: int = N, seed: int = 1) -> Film:
    return film(Framing(problem(stages)), stages, Swaying(count, seed, 12.0), 120)


def test_one_subject_stands_where_it_is_asked_and_as_large():
    asked = Appearance((0.3, -0.2), 0.2, seen_from(0.3, 60))
    known = situation(60, (subject(HEADS[0], STILL, 60, asked),))
    plan = Framing(problem(60), CONVERGED).replan(known, None).plan
    assert plan is not None
    assert plan.aim is not None
    cost, off = appears(plan.places[-1], tuple(plan.aim[-1]), HEADS[0], asked)
    assert off < 1.0
    assert cost < 1e-3
    # By the camera of the language: right and up are positive, as on screen.
    seen = view(*plan.aim[-1], 2 * np.arctan(HALF[0]), HALF[0] / HALF[1])
    u, v, *_ = seen.project(tuple(HEADS[0] - plan.places[-1]))
    assert (u, v) == pytest.approx((0.3, -0.2), abs=0.01)
    far = np.linalg.norm(HEADS[0] - plan.places[-1])
    assert SIZE / (2 * HALF[1] * far) == pytest.approx(0.2, rel=0.02)


def test_who_is_asked_nothing_of_stays():
    known = alone(Appearance(), velocity=STILL)
    done = Framing(problem(N), CONVERGED).replan(known, None)
    assert done.plan is not None
    assert np.abs(done.plan.places - STAND).max() < 1e-3
    assert np.abs(done.plan.aim - np.array(AIM)).max() < 1e-3


@pytest.mark.slow
def test_the_motion_is_that_of_its_inputs_within_all_limits():
    planner = Framing(problem(N))
    for known, last in flown(2).asked[::10]:
        plan = planner.replan(known, last).plan
        assert plan is not None
        x, v, a = plan.places, plan.velocities, plan.accelerations
        assert x[1:] == pytest.approx(x[:-1] + DT * (v[:-1] + 0.5 * DT * a), abs=1e-9)
        assert v[1:] == pytest.approx(v[:-1] + DT * a, abs=1e-9)
        assert np.linalg.norm(a, axis=1).max() <= SLOW.acceleration + 1e-9
        assert np.abs(np.diff(plan.aim, axis=0)).max() <= 2.0 * DT + 1e-9
        assert plan.aim[:, 1].min() > -1.2 - 0.01
        assert np.linalg.norm(v[1:, :2], axis=1).max() < SLOW.speed + 0.1


@pytest.mark.slow
@pytest.mark.parametrize("count", [1, 2, 3])
def test_a_flight_frames_its_subjects_and_comes_near_none(count):
    one = flown(count)
    assert {r.status for r in one.replans} <= {"planned", "stalled"}
    assert one.nearest.min() > 1.0
    assert one.off.mean() < (20.0 if count == 1 else 80.0)


@pytest.mark.slow
@pytest.mark.parametrize("count", [1, 2])
def test_one_step_a_replan_costs_hardly_more_than_converged_ones(count):
    people = Swaying(count, 1, 12.0)
    fine = film(Framing(problem(N), StopRule(30, 1e-3)), N, people, 120)
    assert flown(count).cost.mean() < 1.2 * fine.cost.mean()
    assert flown(count).off.mean() < 1.1 * fine.off.mean()


@pytest.mark.slow
@pytest.mark.parametrize(("count", "moment"), [(1, 20), (2, 30), (2, 70), (3, 55)])
def test_converged_it_costs_what_a_second_solver_finds(count, moment):
    known, last = flown(count).asked[moment]
    planner = Framing(problem(N), CONVERGED)
    done = planner.replan(known, last)
    assert done.plan is not None
    ((of, solver),) = planner._flights[(True,) * count]._solvers.items()
    inputs = np.hstack([done.plan.accelerations, np.diff(done.plan.aim, axis=0) / DT])
    mine = solver.evaluation.motion(inputs).merit
    theirs = by_ipopt(solver.evaluation, framing.stage(of, (True,) * count), inputs)
    assert mine == pytest.approx(theirs, rel=4e-3, abs=3e-3)


def by_ipopt(of: Evaluation, s: StageExpressions, inputs: np.ndarray) -> float:
    """Solve the same stages by IPOPT, from the same inputs, and return the merit of its inputs."""
    n, prices = of.of.stages, of.of.prices
    u, slack = ca.MX.sym("u", s.u.numel(), n), ca.MX.sym("slack", len(prices.lacking), n)
    x = ca.MX.sym("x", s.x.numel(), n)
    out = [s.following, ca.sumsqr(s.residuals), *s.rows, s.firm, *s.states]
    one = ca.Function("one", [s.x, s.u, s.y, s.p, s.g], out)
    last = ca.Function("last", [s.y, s.g], [s.ends])
    cost, still, positive, before = 0.0, [], [], ca.DM(of.start)
    for k in range(n):
        after, squares, hard, soft, firm, least, most = one(before, u[:, k], x[:, k], of.given[k], of.common)
        cost += squares + ca.dot(ca.DM(prices.lacking), slack[:, k])
        bounds = [x[3:6, k] - least[3:6], most[3:6] - x[3:6, k], x[7, k] - least[7], most[7] - x[7, k]]
        still.append(after - x[:, k])
        positive += [hard + slack[0, k], soft + slack[1, k], firm, *bounds]
        before = x[:, k]
    positive += [last(before, of.common) + slack[0, n - 1], ca.vec(slack)]
    unknown, rows = ca.vertcat(ca.vec(u), ca.vec(slack), ca.vec(x)), ca.vertcat(*still, *positive)
    options = {"print_time": False, "ipopt": {"print_level": 0, "sb": "yes", "tol": 1e-6}}
    solver = ca.nlpsol("all", "ipopt", {"x": unknown, "f": cost, "g": rows}, options)
    x0 = np.concatenate([inputs.ravel(), np.full(slack.numel(), 0.1), of.motion(inputs).states.ravel()])
    free = np.zeros(rows.numel())
    free[x.numel() :] = np.inf
    found = solver(x0=x0, lbg=0.0, ubg=free)
    assert solver.stats()["success"]
    return of.motion(np.array(found["x"])[: u.numel(), 0].reshape(n, -1)).merit


def test_a_subject_behind_another_is_seen_again():
    # The second one stands in the line of sight to the first, a little off it.
    behind = subject(np.array([0.0, 2.0, 1.6]), STILL, 40, Appearance((0.0, 0.0), 0.1))
    front = subject(np.array([0.1, 0.0, 1.6]), STILL, 40, None)
    done = Framing(problem(40), CONVERGED).replan(situation(40, (behind, front)), None)
    assert done.plan is not None
    assert hidden(done.plan.places[-1], behind, front) < 0.1
    free = Framing(problem(40, weights=FramingWeights(cover=0.0)), CONVERGED)
    stays = free.replan(situation(40, (behind, front)), None).plan
    assert stays is not None
    assert hidden(stays.places[-1], behind, front) > 0.3


def hidden(place: np.ndarray, of: FilmedSubject, by: FilmedSubject) -> float:
    """How far inside the inflated body the line of sight passes, as a share of its size."""
    axes = 1.3 * np.array(BODY)
    a, b = (place - by.centre[0]) / axes, (of.point[0] - by.centre[0]) / axes
    share = np.clip(-(a @ (b - a)) / ((b - a) @ (b - a)), 0.0, 1.0)
    return 1.0 - float(np.linalg.norm(a + share * (b - a)))


def test_bodies_are_kept_clear_of_though_the_setpoint_is_inside():
    close = alone(Appearance((0.0, 0.0), 3.0))
    done = Framing(problem(N), CONVERGED).replan(close, None)
    assert done.plan is not None
    off = np.linalg.norm((done.plan.places - close.subjects[0].centre[0]) / np.array(BODY), axis=1)
    assert off.min() > 0.97
    assert off.min() < 1.5


def test_another_drone_is_kept_apart_and_out_of_the_picture():
    n = 40
    other = np.array([-0.6, -2.0, 1.7])
    traffic = beside(np.tile(other, (n + 1, 1)))
    known = situation(n, (subject(HEADS[0], STILL, n, Appearance((0.0, 0.0), 0.1)),), traffic=traffic)
    done = Framing(problem(n, separation=1.0, half_angle=pi / 8), CONVERGED).replan(known, None)
    assert done.plan is not None
    d = other - done.plan.places[-1]
    yaw, pitch = done.plan.aim[-1]
    ahead = np.array([np.cos(pitch) * np.cos(yaw), np.cos(pitch) * np.sin(yaw), np.sin(pitch)])
    assert np.degrees(np.arccos(d @ ahead / np.linalg.norm(d))) > 22.0
    assert np.linalg.norm(done.plan.places - other, axis=1).min() > 1.0


def symbols(centre, axes=BODY, point=None) -> Symbols:
    numbers = [*(centre if point is None else point), *centre, 0.0, 0.0, 0.0]
    return Symbols.of(ca.DM(numbers), ca.DM([0.0, 0.0, 1.0, SIZE, *axes, 1.0, 1.0, 1.0]))


def test_covered_is_what_a_ray_through_the_inflated_body_says():
    rng = np.random.default_rng(5)
    body = symbols((0.0, 0.0, 1.0))
    axes = 1.3 * np.array(BODY)
    for _ in range(200):
        eye, point = rng.uniform(-4.0, 4.0, 3), rng.uniform(-4.0, 4.0, 3)
        a, b = ((p - np.array([0.0, 0.0, 1.0])) / axes for p in (eye, point))
        if min(np.linalg.norm(a), np.linalg.norm(b)) < 1.0:
            continue
        share = np.clip(-(a @ (b - a)) / ((b - a) @ (b - a)), 0.0, 1.0)
        near = float(np.linalg.norm(a + share * (b - a)))
        if abs(near - 1.0) < 1e-3:
            continue
        value = float(uncovered(ca.DM(eye), symbols(tuple(point)), body))
        assert (value < 0) == (near < 1.0)


def test_the_ellipsoid_and_its_field_are_in_metres_along_the_axes():
    body = symbols((0.0, 0.0, 1.0), (0.5, 0.5, 0.5))
    assert float(clear(ca.DM([2.0, 0.0, 1.0]), body)) == pytest.approx(1.5)
    assert float(in_field(ca.DM([0.8, 0.0, 1.0]), body)) == pytest.approx(0.5)
    assert float(in_field(ca.DM([1.4, 0.0, 1.0]), body)) == 0.0


@pytest.mark.parametrize("name", ["place", "velocity", "aim", "time", "point", "view"])
def test_what_is_no_number_fails_at_once_and_leaves_the_next_call_sound(name):
    planner, (known, last) = Framing(problem(N)), flown(1).asked[5]
    before = planner.replan(known, last)
    (one,) = known.subjects
    broken = {
        "place": {"place": known.place * nan},
        "velocity": {"velocity": known.velocity * nan},
        "aim": {"aim": (nan, 0.0)},
        "time": {"time": nan},
        "point": {"subjects": (replace(one, point=one.point * nan),)},
        "view": {"subjects": (replace(one, wanted=replace(one.wanted, view=one.wanted.view * nan)),)},
    }[name]
    done = planner.replan(replace(known, **broken), last)
    assert (done.status, done.plan) == ("failed", None)
    assert "not finite" in done.reason
    again = planner.replan(known, last)
    assert (again.plan.accelerations == before.plan.accelerations).all()
    assert (again.plan.aim == before.plan.aim).all()


def test_the_same_calls_have_the_same_answers():
    asked = flown(2).asked[::15]
    planner, other = Framing(problem(N)), Framing(problem(N))
    first = [planner.replan(*each) for each in asked]
    for again in (
        [other.replan(*each) for each in asked[::-1]][::-1],
        [planner.replan(*each) for each in asked],
    ):
        for a, b in zip(first, again, strict=True):
            assert (a.status, a.lack, a.steps) == (b.status, b.lack, b.steps)
            assert (a.plan.accelerations == b.plan.accelerations).all()
            assert (a.plan.aim == b.plan.aim).all()


def test_who_is_to_stay_near_a_pose_goes_there_and_turns_as_far_as_the_picture_lets_him():
    at, aside = np.array([1.0, -3.2, 1.9]), 0.5
    free = Appearance((0.0, 0.0), None, None)
    placed, turned = (
        DrawnPose(np.tile(at, (61, 1)), *angles) for angles in ((None, None), (pi / 2 - aside, 0.1))
    )
    ends = []
    for near in (placed, turned):
        subjects = (subject(HEADS[0], STILL, 60, free),)
        done = Framing(problem(60), CONVERGED).replan(situation(60, subjects, near=near), None)
        assert done.plan is not None
        assert done.plan.aim is not None
        ends.append((done.plan.places[-1], done.plan.aim[-1]))
    (place, aim), (_, other) = ends
    # Nothing else says where it is; and its head stays in the middle.
    assert place == pytest.approx(at, abs=0.05)
    to = HEADS[0] - place
    assert aim[0] == pytest.approx(np.arctan2(to[1], to[0]), abs=0.02)
    # It goes round its head, so that it may turn to the angles it is to stay near, but not all the way.
    assert pi / 2 - aside < other[0] < aim[0] - 0.2
    assert abs(other[1] - 0.1) < abs(aim[1] - 0.1)


def test_a_pose_that_is_no_number_fails():
    near = DrawnPose(np.full((N + 1, 3), nan))
    subjects = (subject(HEADS[0], STILL, N, Appearance((0.0, 0.0))),)
    done = Framing(problem(N)).replan(situation(N, subjects, near=near), None)
    assert (done.status, done.reason) == ("failed", "the pose to stay near is not finite")
