"""Several subjects in one picture: the terms, places that are known, and what is flown against its guide."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from math import pi, tan

import casadi as ca
import numpy as np
import pytest
from shotc_casadi.clock import picture, program
from shotc_casadi.clock.problem import ClockProblem, Use, breaks_of, guess, problem
from shotc_casadi.clock.references import ClockSubject, references_at
from shotc_casadi.clock.refiner import KEPT, subject_of
from shotc_casadi.clock.rounds import NEARLY_SHARE, REACH_M, ROOM_SHARE, flown_cost
from shotc_casadi.clock.several import pictured
from shotc_casadi.clock.shown import no_less, visibility_of

from shotc.api import Compilation, PlanOptions, compile_source
from shotc.geom import viewpoint
from shotc.geom.shapes import CylinderShape
from shotc.ir.framed_scene import lens_of
from shotc.ir.path import CAM_PITCH, CAM_YAW, ClockLeg, PathIR
from shotc.plugin_api.refiner import restrict, surroundings
from tests.experiments.faces import MISSION, drawn
from tests.support.refined_clocks import refine_clocks

pytestmark = pytest.mark.slow

FRAMES = "{target: a, frame: [-0.3, 0]}, {target: b, frame: [0.3, 0]}"
STILL = MISSION.format(
    world="", a="at: [-2, 0, 4]", b="at: [2, 0, 4]", start="", lasts=8,
    subjects="{target: a, frame: [-0.3, 0], size: SIZE, view: {elevation: 0 deg}}, "
    "{target: b, frame: [0.3, 0], size: SIZE, view: {elevation: 0 deg}}",
)  # fmt: skip
CORNER = MISSION.format(
    world="",
    a="track: {points: [[0, 0, 0.9], [45, 0, 0.9], [60, 15, 0.9], [80, 15, 0.9]], speed: 2 m/s}",
    b="track: {points: [[4, 0, 0.9], [40, 3, 0.9], [62, 22, 0.9], [90, 22, 0.9]], speed: 2 m/s}",
    start="start: 14, ",
    lasts=12,
    subjects=FRAMES.replace("{target: a, ", "{target: a, size: 0.3, "),
)
# One goes before the other, as seen from where they are asked to be seen from.
BEHIND = MISSION.format(
    world="",
    a="track: {points: [[0, 0, 0.9], [60, 0, 0.9]], speed: 2 m/s}",
    b="track: {points: [[0, 4, 0.9], [60, 4, 0.9]], speed: 2 m/s}",
    start="start: 13, ",
    lasts=8,
    subjects="{target: a, frame: [-0.1, 0], size: 0.35, view: {azimuth: 180 deg}}, "
    "{target: b, frame: [0.1, 0]}",
)


@cache
def compiled(text: str, refiner: str = "ours") -> Compilation:
    return compile_source(text.encode(), "faces.yaml", None, PlanOptions(refiner=refiner))


def path_of(done: Compilation, step: str) -> PathIR:
    return next(report.output for report in done.reports if report.name == step)


def subject(text: str) -> ClockSubject:
    return subject_of(path_of(compiled(text, "none"), "solve-path-qp"), "s")


def claim(done: Compilation, name: str) -> float:
    assert done.plan is not None, done.diagnostics
    return next(c.worst for c in done.plan.certificate if (c.shot, c.constraint) == ("s", name))


def task(of: ClockSubject) -> ClockProblem:
    breaks = breaks_of(of)
    around, references = surroundings(of.path, of.drone, breaks), references_at(of, breaks)
    guide = restrict(of.leg.curve.channels(0, 1, 2), breaks)
    planes = around.half_spaces(guide.ctrl, REACH_M, ROOM_SHARE)
    return problem(of, breaks, references, planes, Use(NEARLY_SHARE), guess(guide, breaks, of.leg.curve))


def turning(leg: ClockLeg) -> float:
    """The mean square of the camera's angular acceleration in the film, rad^2/s^4."""
    rates = leg.curve.derivative(2)(np.linspace(leg.start, leg.end, 2000))
    return float((rates[:, [CAM_YAW, CAM_PITCH]] ** 2).sum(axis=1).mean())


ASKED = (
    {"view": (3.5, 0.2)},
    {"size": 1.4, "view": (3.5, None)},
    {"size": None, "reference": (0.2, 0.0), "view": (None, 0.3)},
    {"size": None, "reference": (0.9, 0.8)},
    {"reference": None},
)


@pytest.mark.parametrize("asked", ASKED)
def test_the_terms_are_those_by_which_the_ideal_is_found(asked: dict[str, object]) -> None:
    of = subject(CORNER)
    framed = (of.framed[0]._replace(**asked), of.framed[1])
    centres = np.array([[[1.0, 2.0, 0.9], [4.0, 3.0, 0.9]]])
    rows = pictured(of.mission, framed, centres, np.zeros(1), 0.0)[0]
    eye, aim, one, lens = (ca.SX.sym("q", n) for n in (3, 2, picture.SUBJECT, 2))
    term = ca.Function("term", [one, eye, aim, lens], [picture.residuals(one, eye, (aim[0], aim[1]), lens)])
    half = tan(of.drone.hfov / 2)
    references = [
        viewpoint.RequiredView(
            tuple(centre), CylinderShape(0.4, 1.8), s.reference, s.size, *(s.view or (None, None))
        )
        for centre, s in zip(centres[0], framed, strict=True)
    ]
    rng, room = np.random.default_rng(5), viewpoint.PlaceBounds(0.0, 0.0)
    for _ in range(20):
        at = np.array([2.0, -7.0, 2.0]) + rng.uniform(-2, 2, 3)
        look = np.array([0.5 * pi, -0.1]) + rng.uniform(-0.2, 0.2, 2)
        theirs = viewpoint._residuals((*at, *look), references, lens_of(of.drone), room, (None, 1.0))
        assert theirs is not None
        ours = sum(float(ca.sumsqr(term(row, at, look, [half, half / of.drone.aspect]))) for row in rows)
        assert ours == pytest.approx(float(np.dot(theirs, theirs)), rel=2e-3, abs=1e-6)


def test_a_subject_behind_the_camera_has_a_finite_cost_that_falls_as_the_camera_turns_to_it() -> None:
    of = subject(CORNER)
    centres = np.array([[[0.0, 10.0, 0.9], [1.0, 10.0, 0.9]]])
    row = pictured(of.mission, of.framed, centres, np.zeros(1), 0.0)[0, 0]
    aim = ca.SX.sym("aim", 2)
    value = picture.picture(ca.DM(row), ca.DM([0.0, 0.0, 2.0]), (aim[0], aim[1]), ca.DM([0.7, 0.4]))
    cost = ca.Function("cost", [aim], [value, ca.gradient(value, aim), ca.hessian(value, aim)[0]])
    found = [cost([0.5 * pi + turn, 0.0]) for turn in (3.0, 2.0, 1.0, 0.3)]
    assert all(np.isfinite(np.array(part)).all() for parts in found for part in parts)
    assert float(found[-2][0]) > float(found[-1][0])


def test_two_who_stand_beside_the_axis_are_filmed_from_the_place_on_it() -> None:
    drone = subject(CORNER).drone
    away = 2.0 / (0.3 * tan(drone.hfov / 2))
    known = viewpoint.RequiredView((2.0, 0.0, 4.0), CylinderShape(0.4, 1.8))
    seen = viewpoint.judged((0.0, -away, 4.0, 0.5 * pi, 0.0), lens_of(drone), known)
    assert seen is not None
    text = STILL.replace("SIZE", f"{seen.size:.6f}")
    of = subject(text)
    made = task(of)
    table = made.parameters.copy()
    table[:, 4] = 0.0  # nothing draws it to the ideal place, which is there
    made = replace(made, parameters=table)
    filmed = (breaks_of(of) > of.leg.start) & (breaks_of(of) < of.leg.end)
    # From a place that is off by metres, and a camera that looks past them, the same is found.
    start = made.states.copy()
    start[1:-1, :3] += np.array([2.0, -1.5, 0.8])
    start[1:-1, CAM_YAW_STATE] += 0.1
    for states in (made.states, start):
        found = program.solve(replace(made, states=states), "fatrop")
        assert found.status == "solved"
        middle = found.states[filmed][len(found.states[filmed]) // 2]
        assert abs(middle[0]) < 0.02
        assert np.hypot(middle[0], middle[1]) == pytest.approx(away, rel=2e-3)
        assert middle[2] == pytest.approx(4.0, abs=0.02)
        assert np.cos(middle[CAM_YAW_STATE] - np.arctan2(-middle[1], -middle[0])) > 1 - 1e-6
    assert claim(compiled(text), "a screen error") < 5e-3
    assert claim(compiled(text), "b screen error") < 5e-3


CAM_YAW_STATE = 9


def test_both_solvers_find_the_same_picture_and_the_slopes_vanish_there() -> None:
    made = task(subject(CORNER))
    a, b = program.solve(made, "fatrop"), program.solve(made, "ipopt")
    assert (a.status, b.status) == ("solved", "solved")
    assert a.objective == pytest.approx(b.objective, rel=1e-3)
    filmed = slice(20, -20)
    assert np.abs(a.states[filmed, :3] - b.states[filmed, :3]).max() < 0.05
    assert program.cost(made, a.states, a.inputs) == pytest.approx(a.objective, rel=1e-9)
    # No small step over ground, and no small turn, costs less: the slopes are none, the curvatures are not.
    span = breaks_of(subject(CORNER))
    t = (span - span[0]) / (span[-1] - span[0])
    bump = np.polynomial.Polynomial([0.0, 1.0, -1.0]) ** 4 * 256
    orders = [(bump.deriv(k) if k else bump)(t) / (span[-1] - span[0]) ** k for k in range(4)]
    jerk = np.diff(orders[2]) / np.diff(span)
    for columns, moves in (([0, 3, 6], 0), ([1, 4, 7], 1), ([9, 10, 11], 3), ([12, 13, 14], 4)):
        costs = []
        for step in (-0.01, 0.0, 0.01):
            states, inputs = a.states.copy(), a.inputs.copy()
            states[:, columns] += step * np.column_stack(orders[:3])
            inputs[:, moves] += step * jerk
            costs.append(program.cost(made, states, inputs))
        bent = costs[0] + costs[2] - 2 * costs[1]
        assert bent > 0.0
        assert abs(costs[2] - costs[0]) < 0.1 * bent, columns


def test_round_a_corner_both_appear_better_than_by_the_guide_and_the_camera_is_calmer() -> None:
    guide, ours = compiled(CORNER, "none"), compiled(CORNER)
    assert ours.plan is not None, ours.diagnostics
    assert dict(path_of(ours, "refine-path").stats)["s.refine_status"] == "solved"
    for name in ("a screen error", "b screen error"):
        assert claim(ours, name) < 0.96 * claim(guide, name)
    off = [abs(np.log(claim(done, "a size smallest") / 0.3)) for done in (guide, ours)]
    assert off[1] < 0.9 * off[0]
    assert claim(ours, "a in frame") == claim(ours, "b in frame") == 1.0
    before, after = (subject_of(path_of(ours, step), "s").leg for step in ("solve-path-qp", "refine-path"))
    assert turning(after) < turning(before)


@pytest.mark.long
def test_who_walks_behind_another_is_looked_at_past_him() -> None:
    behind = BEHIND.replace("allow: [fast-pan]", "allow: [fast-pan, hidden-subject]")
    assert claim(compiled(behind, "none"), "b in sight") < 0.9
    ours = compiled(behind)
    assert claim(ours, "a in sight") > 0.99
    assert claim(ours, "b in sight") > 0.99
    assert not [d for d in ours.diagnostics if d.code[0] == "R"]


@pytest.mark.parametrize(
    "seed", [13, pytest.param(6, marks=pytest.mark.fuzz), pytest.param(1, marks=pytest.mark.fuzz)]
)
def test_what_is_flown_never_costs_more_than_its_guide(seed: int) -> None:
    ours = compiled(drawn(seed))
    assert ours.plan is not None, ours.diagnostics
    assert not [d for d in ours.diagnostics if d.code[0] == "R"]
    of, after = (subject_of(path_of(ours, step), "s") for step in ("solve-path-qp", "refine-path"))
    guide, flown, stats = of.leg, after.leg, dict(after.path.stats)
    if stats["s.refine_status"] == KEPT:
        assert flown is guide
        return
    assert float(stats["s.refine_cost"]) <= float(stats["s.guide_cost"])
    # By the cost of the problem as it was first put, and by what is seen: more, or as much and better.
    made = task(of)
    assert no_less(of, guide, flown)
    if shown_hidden(of, flown) == shown_hidden(of, guide):
        assert flown_cost(made, flown.curve.breaks, flown) < flown_cost(made, flown.curve.breaks, guide)


def shown_hidden(of: ClockSubject, leg: ClockLeg) -> float:
    return sum(1.0 - visibility_of(of, leg, which).free.mean for which in range(len(of.framed)))


def test_where_the_guide_is_better_by_its_own_cost_it_is_flown(monkeypatch: pytest.MonkeyPatch) -> None:
    of = subject(CORNER)
    monkeypatch.setattr(
        "shotc_casadi.clock.rounds.flown_cost", lambda _, __, leg: 0.0 if leg is of.leg else 1.0
    )
    path, (told,) = refine_clocks(of.path, "ours")
    assert told.code == "R014"
    assert subject_of(path, "s").leg is of.leg
    assert dict(path.stats)["s.refine_status"] == KEPT


def test_a_motion_that_crops_a_subject_is_not_taken(monkeypatch: pytest.MonkeyPatch) -> None:
    of = subject(CORNER)
    true = visibility_of

    def cropped(one: ClockSubject, leg: ClockLeg, which: int = 0) -> object:
        found = true(one, leg, which)
        return found if leg is of.leg or which == 0 else found._replace(cropped=0.1)

    monkeypatch.setattr("shotc_casadi.clock.shown.visibility_of", cropped)
    path, _ = refine_clocks(of.path, "ours")
    assert subject_of(path, "s").leg is of.leg


def test_a_wall_in_the_way_is_gone_round_with_both_in_the_frame() -> None:
    wall = "world: {zones: {wall: {keep: out, box: {center: [34, -10.5, 5], size: [3, 3, 10]}}}}\n"
    text = CORNER.replace("targets:", wall + "targets:", 1).replace(
        "frame: [-0.3, 0]", "frame: [-0.3, 0], view: {azimuth: 180 deg, elevation: 8 deg}"
    )
    ours = compiled(text)
    assert ours.plan is not None, ours.diagnostics
    assert dict(path_of(ours, "refine-path").stats)["s.refine_status"] == "solved"
    assert claim(ours, "a in frame") == claim(ours, "b in frame") == 1.0
    wide = next(c.worst for c in ours.plan.certificate if c.constraint == "zone wall")
    assert wide >= -1e-6
