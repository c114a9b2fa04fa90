"""Shots on their own clock: the ray's derivatives, the programme, and what refining is for."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from math import radians

import casadi as ca
import numpy as np
import pytest
from shotc_casadi import solving
from shotc_casadi.clock import program
from shotc_casadi.clock.angles import turning
from shotc_casadi.clock.problem import USUAL_STAGES, Use, breaks_of, guess, problem
from shotc_casadi.clock.proof import astray, gap_in
from shotc_casadi.clock.references import ClockSubject, motion, references_at, steepest
from shotc_casadi.clock.refiner import KEPT, subject_of
from shotc_casadi.clock.rounds import NEARLY_SHARE, REACH_M, ROOM_SHARE, ClockRefined, refine_clock
from shotc_casadi.solving import Solution
from shotc_casadi.timeout import TimedOut

from shotc.api import Compilation, PlanOptions, compile_source
from shotc.geom.bernstein import Piecewise
from shotc.ir.path import CAM_PITCH, CAM_YAW, ClockLeg
from shotc.plugin_api.refiner import NO_HALF_SPACES, ideal_places, restrict, surroundings
from tests.support.refined_clocks import refine_clocks

pytestmark = pytest.mark.slow

RUN = """\
shotc: 1
mission: run
targets:
  runner:
    track: {{points: [[0, 0, 0.9], [60, 0, 0.9], [90, 30, 0.9]], speed: {speed} m/s}}
    radius: 0.4
    height: 1.8
drones:
  cam1: {{model: x500, home: [45, -20, 0]{drone}}}
{world}shots:
  - {{id: s, drone: cam1, target: runner, timing: {{start: 15, duration: 12}}, {shot}}}
"""
FLYBY = "kind: flyby, behind: 10, ahead: 10, offset: 4, altitude: 4"
OVER = "kind: flyby, behind: 8, ahead: 8, altitude: 6"
PROMISED = f"{OVER}, require: {{in_frame: 100 %}}"
LATERAL = "kind: lateral, side: right, distance: 8, altitude: 4"
SHED = "world: {zones: {shed: {keep: out, box: {center: [55, -8, 3], size: [3, 3, 8]}}}}\n"
PEN = "world: {zones: {pen: {keep: in, cylinder: {center: [50, 0], radius: 45, height: [-1, 20]}}}}\n"


@cache
def compiled(
    shot: str, speed: float = 1.5, drone: str = "", world: str = "", refiner: str = "ours"
) -> Compilation:
    text = RUN.format(shot=shot, speed=speed, drone=drone, world=world)
    return compile_source(text.encode(), "run.yaml", None, PlanOptions(refiner=refiner))


def subject(done: Compilation, step: str = "solve-path-qp") -> ClockSubject:
    path = next(report.output for report in done.reports if report.name == step)
    return subject_of(path, "s")


def peaks(leg: ClockLeg) -> np.ndarray:
    """The most that the camera's yaw and pitch accelerate and jerk in the film; shape (4,)."""
    t = np.linspace(leg.start, leg.end, 4001)
    rows = [np.abs(leg.curve.derivative(k)(t)[:, c]).max() for c in (CAM_YAW, CAM_PITCH) for k in (2, 3)]
    return np.array(rows)


def off(of: ClockSubject) -> float:
    t = np.linspace(of.leg.start, of.leg.end, 401)
    ideal = ideal_places(of.mission, of.placed.shot, of.leg.start, t)
    return float(np.linalg.norm(of.leg.curve(t)[:, :3] - np.array(ideal), axis=1).max())


def claim(done: Compilation, name: str) -> float:
    assert done.plan is not None, done.diagnostics
    return next(c.worst for c in done.plan.certificate if c.constraint == name)


def test_the_ray_s_derivatives_are_those_of_its_angles() -> None:
    rows = np.random.default_rng(4).normal(size=(3, 4))
    rows[0] += 3.0
    rows[1] += 2.0
    path = [np.polynomial.Polynomial(row) for row in rows]
    symbols = [ca.SX.sym("d", 3) for _ in range(4)]
    of = ca.Function("of", symbols, [ca.vertcat(*turning(*symbols))])
    h, t0 = 1e-3, 0.3

    def angles(t: float) -> np.ndarray:
        x, y, z = (p(t) for p in path)
        return np.array([np.arctan2(y, x), np.arctan2(z, np.sqrt(x**2 + y**2 + 1e-2))])

    a, b, c, d, e = (angles(t0 + k * h) for k in range(-2, 3))
    references = [(d - b) / (2 * h), (d - 2 * c + b) / h**2, (e - 2 * d + 2 * b - a) / (2 * h**3)]
    found = np.array(of(*[[p.deriv(k)(t0) if k else p(t0) for p in path] for k in range(4)])).ravel()
    assert found.reshape(3, 2) == pytest.approx(np.array(references), rel=0.02)


def test_an_even_motion_stays_what_it_is_and_a_corner_is_rounded() -> None:
    of = subject(compiled(LATERAL))
    t = np.linspace(16.0, 30.0, 50)
    found = motion(of.mission, "runner", t)
    assert np.allclose(found[:, :3], [of.mission.target("runner").at(float(u)) for u in t], atol=1e-9)
    assert np.allclose(found[:, 3:], [1.5, *[0.0] * 8], atol=1e-6)
    near = np.linspace(39.0, 41.0, 101)
    corner = motion(of.mission, "runner", near)
    for order in (0, 3, 6):
        slope = np.gradient(corner[:, order : order + 3], near, axis=0)[2:-2]
        references = corner[2:-2, order + 3 : order + 6]
        assert np.abs(slope - references).max() < 0.05 * np.abs(references).max()


def test_on_a_flyby_the_camera_turns_more_calmly_within_all_limits() -> None:
    plain, ours = compiled(FLYBY, refiner="none"), compiled(FLYBY)
    before, after = subject(plain), subject(ours, "refine-path")
    assert ours.plan is not None
    assert (peaks(after.leg) < 0.9 * peaks(before.leg)).all()
    assert claim(ours, "runner screen error") < claim(plain, "runner screen error") + 1e-4
    assert claim(ours, "runner in frame") == 1.0
    assert off(after) < 0.6


def test_a_pass_straight_over_its_target_goes_aside_on_the_guide_s_side() -> None:
    plain, ours = compiled(PROMISED, 3.0, refiner="none"), compiled(PROMISED, 3.0)
    assert claim(plain, "runner screen error") > 0.1
    assert claim(ours, "runner screen error") < 0.1
    assert peaks(subject(ours, "refine-path").leg)[0] < 0.5 * peaks(subject(plain).leg)[0]


@pytest.mark.long
def test_where_the_gimbal_does_not_look_down_that_far_the_camera_goes_aside() -> None:
    drone = ", gimbal: {pitch: [-45 deg, 20 deg]}"
    plain, near, far = (
        claim(compiled(*given), "runner in frame")
        for given in ((OVER, 3.0, drone, "", "none"), (OVER, 3.0, drone), (PROMISED, 3.0, drone))
    )
    assert 0.9 > near > plain
    assert far == 1.0


def test_a_lateral_along_a_straight_line_stays_the_ideal() -> None:
    before, after = (subject(compiled(LATERAL), step) for step in ("solve-path-qp", "refine-path"))
    assert off(after) < min(0.05, off(before) + 0.01)
    assert (peaks(after.leg) < peaks(before.leg) + np.array([0.01, radians(4), 0.01, 0.01])).all()


@pytest.mark.parametrize(
    "shot",
    [
        "kind: static, at: [60, -25, 5], look_at: runner",
        "kind: follow-path, points: [[40, -12, 4], [70, -8, 4]], look_at: runner",
    ],
)
def test_places_that_the_author_gave_stay(shot: str) -> None:
    assert off(subject(compiled(shot, 3.0), "refine-path")) < off(subject(compiled(shot, 3.0))) + 0.03


@pytest.mark.long
@pytest.mark.parametrize("body", ["forward", "free", "follow-camera"])
@pytest.mark.parametrize("world", [SHED, PEN])
def test_what_stands_and_what_the_body_does_is_kept(world: str, body: str) -> None:
    ours = compiled(LATERAL, 3.0, f", body: {body}", world)
    after = subject(ours, "refine-path")
    assert claim(ours, "zone shed" if world == SHED else "zone pen") >= -1e-6
    assert not np.array_equal(after.leg.curve.ctrl.shape, subject(ours).leg.curve.ctrl.shape)
    assert astray(after, after.leg) < 0.02


def test_the_legs_around_stay_and_the_ends_are_the_same_numbers() -> None:
    ours = compiled(FLYBY)
    old, new = (subject(ours, step) for step in ("solve-path-qp", "refine-path"))
    for a, b in zip(old.path.timed[0].legs, new.path.timed[0].legs, strict=True):
        assert (a is b) == (a.shot is None)
    for k in (0, -1):
        assert np.array_equal(old.leg.curve.ctrl[k, k], new.leg.curve.ctrl[k, k])
    assert {old.leg.start, old.leg.end} <= set(new.leg.curve.breaks)
    stats = dict(new.path.stats)
    assert stats["s.refine_status"] == "solved"
    assert stats["s.refine_stages"] >= USUAL_STAGES
    assert stats["s.refine_rounds"] >= 1


def task(of: ClockSubject) -> program.ClockProblem:
    breaks = breaks_of(of)
    around, references = surroundings(of.path, of.drone, breaks), references_at(of, breaks)
    guide = restrict(of.leg.curve.channels(0, 1, 2), breaks)
    planes = around.half_spaces(guide.ctrl, REACH_M, ROOM_SHARE)
    return problem(of, breaks, references, planes, Use(NEARLY_SHARE), guess(guide, breaks))


def test_two_solvers_find_the_same_motion() -> None:
    made = task(subject(compiled(FLYBY)))
    a, b = program.solve(made, "fatrop"), program.solve(made, "ipopt")
    assert (a.status, b.status) == ("solved", "solved")
    assert a.objective == pytest.approx(b.objective, rel=1e-3)
    assert np.abs(a.states[:, :3] - b.states[:, :3]).max() < 0.02
    assert max(a.residual, b.residual) < program.FEASIBLE_RESIDUAL


@pytest.mark.parametrize("width", [5.0, 0.0])
def test_a_problem_is_solved_alike_whatever_was_solved_before_it(width: float) -> None:
    made = task(subject(compiled(FLYBY)))
    lower, upper = (bound.copy() for bound in made.state_bounds)
    node = len(lower) // 2
    lower[node], upper[node] = made.states[node] - width, made.states[node] + width
    solving.built.cache_clear()
    first = program.solve(made, "fatrop")
    program.solve(replace(made, state_bounds=(lower, upper)), "fatrop")
    again = program.solve(made, "fatrop")
    assert again.iterations == first.iterations
    assert np.array_equal(again.states, first.states)


def test_the_solver_takes_no_small_curvature_for_none() -> None:
    # With a cost that next to nothing hangs on it adds to the diagonal, and creeps: 30 steps and more.
    assert program.solve(task(subject(compiled(FLYBY))), "fatrop").iterations < 15


@pytest.mark.long
def test_the_control_points_of_every_stage_keep_what_is_asked() -> None:
    of = subject(compiled(LATERAL, 3.0, "", SHED))
    refined = refine_clock(of)
    assert refined.leg is not None
    around = surroundings(of.path, of.drone, refined.leg.curve.breaks)
    position = refined.leg.curve.channels(0, 1, 2)
    assert gap_in(of.drone, around, position, NO_HALF_SPACES) is None
    limits = of.drone._replace(limits=of.drone.limits._replace(jerk=0.5))
    gap = gap_in(limits, around, position, NO_HALF_SPACES)
    assert gap is not None
    assert (gap.what, gap.unit) == ("the limit of jerk", "m/s^3")
    t = np.linspace(position.start, position.end, 20001)
    most = np.linalg.norm(position.derivative(3)(t), axis=1).max()
    assert gap.lack == pytest.approx(most - 0.5, rel=0.02)
    aside = (np.array([0.0, y, 0.0]) for y in (-0.5, 0.5))
    moved = (Piecewise(position.breaks, position.ctrl + by) for by in aside)
    found = [gap_in(of.drone, around, other, NO_HALF_SPACES) for other in moved]
    assert "the clearances" in {gap.what for gap in found if gap is not None}


def test_ipopt_is_the_fallback_and_it_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    of = subject(compiled(FLYBY))

    def given_up(made: program.ClockProblem, solver: str) -> Solution:
        found = true(made, solver)
        return replace(found, status="stopped") if solver == "fatrop" else found

    true = program.solve
    monkeypatch.setattr("shotc_casadi.clock.rounds.solve", given_up)
    path, told = refine_clocks(of.path, "ours")
    assert [d.code for d in told] == ["R013"]
    assert subject_of(path, "s").leg is not of.leg
    assert dict(path.stats)["s.refine_solver"] == "ipopt"


def test_a_shot_that_may_be_flown_as_refined_is_refined_once(monkeypatch: pytest.MonkeyPatch) -> None:
    of, asked = subject(compiled(FLYBY)), []

    def counted(what: ClockSubject, **given: bool) -> ClockRefined:
        asked.append(given["unseen"])
        return refine_clock(what, **given)

    monkeypatch.setattr("shotc_casadi.clock.refiner.refine_clock", counted)
    path, _ = refine_clocks(of.path, "ours")
    assert subject_of(path, "s").leg is not of.leg
    assert asked == [True]


def test_a_solver_that_never_ends_is_left_behind_and_its_shot_named(monkeypatch: pytest.MonkeyPatch) -> None:
    of = subject(compiled(FLYBY))

    def late(_seconds: float, _call: object) -> None:
        raise TimedOut

    monkeypatch.setattr(solving, "within", late)
    path, told = refine_clocks(of.path, "ours")
    assert [d.code for d in told] == ["R011"]
    assert "30 s of processor time without an end" in told[0].message
    assert "in shot `s`" in told[0].message
    assert "left no numbers" in told[0].notes[0]  # so there is no stage to name
    assert subject_of(path, "s").leg is of.leg


def test_where_the_shot_allows_it_the_guide_is_flown_instead(monkeypatch: pytest.MonkeyPatch) -> None:
    def late(_seconds: float, _call: object) -> None:
        raise TimedOut

    monkeypatch.setattr(solving, "within", late)
    compiled.cache_clear()
    refused, allowed = compiled(FLYBY), compiled(FLYBY + ", refine: {optional: true}")
    compiled.cache_clear()
    assert refused.plan is None
    (told,) = refused.diagnostics
    assert told.code == "R011"
    assert "left no numbers" in told.notes[0]
    assert "the convex path of shot `s` keeps every limit and promise" in told.notes
    assert "more time" not in told.help
    assert "let shot `s` fly the convex path by `refine: {optional: true}`" in told.help
    assert allowed.plan is not None
    assert [d.code for d in allowed.diagnostics] == ["R003"]


def test_numbers_that_are_none_are_told() -> None:
    made = task(subject(compiled(FLYBY)))
    broken = replace(made, parameters=made.parameters * np.nan)
    assert program.solve(broken, "fatrop").status == "nan"


def test_a_camera_that_follows_less_well_is_not_taken(monkeypatch: pytest.MonkeyPatch) -> None:
    of = subject(compiled(FLYBY))
    monkeypatch.setattr("shotc_casadi.clock.rounds.astray", lambda _, leg: 0.0 if leg is of.leg else 0.1)
    path, (told,) = refine_clocks(of.path, "ours")
    assert told.code == "R014"
    assert "its guide films" in told.message
    assert subject_of(path, "s").leg is of.leg
    assert dict(path.stats)["s.refine_status"] == KEPT


def test_what_is_framed_high_in_the_picture_is_looked_at_less_steeply() -> None:
    of, at = subject(compiled(FLYBY)), np.array([12.0])

    def framed_at(v: float) -> ClockSubject:
        references = Piecewise(np.array([of.leg.start, of.leg.end]), np.full((1, 1, 2), [0.0, v]))
        (span,) = of.leg.framing
        return replace(of, leg=replace(of.leg, framing=(replace(span, reference=references),)))

    ((low, high),) = steepest(framed_at(0.0), at)
    (up,) = steepest(framed_at(0.5), at)
    assert up[0] > low
    assert up[1] >= high
