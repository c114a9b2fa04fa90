"""What a camera keeps away from: ellipsoids that forbid nothing allowed, their exact price, their field."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from math import inf

import casadi as ca
import numpy as np
import pytest
from shotc_casadi.clock import program, symbols, weights
from shotc_casadi.clock.bodies import NO_BODY_M2, MovingEllipsoid, inscribed, kept_from
from shotc_casadi.clock.problem import ClockProblem, Use, breaks_of, guess, problem
from shotc_casadi.clock.references import ClockReferences, ClockSubject, references_at
from shotc_casadi.clock.refiner import subject_of
from shotc_casadi.clock.rounds import NEARLY_SHARE

from shotc.api import PlanOptions, compile_source
from shotc.geom.solid_arrays.points import distances
from shotc.geom.solids import Cylinder, Prism, Solid, box
from shotc.plugin_api.refiner import NO_HALF_SPACES, Array, restrict
from tests.experiments import crowd
from tests.unit.planning.clock.test_several_drones import HEAD, PASS, SIDE

PARTS = (
    Cylinder((3.0, -2.0), 0.4, 0.0, 1.8),
    Cylinder((0.0, 0.0), 0.0, 0.0, 0.0),
    Cylinder((1.0, 1.0), 2.0, 0.0, inf),
    box((5.0, 1.0, 4.0), (12.0, 1.0, 8.0), 0.6),
    Prism(((0.0, 0.0), (4.0, 0.0), (1.0, 3.0)), 0.0, 5.0),
)


@pytest.mark.parametrize("part", PARTS)
@pytest.mark.parametrize("clearance", [0.3, 2.0])
def test_an_ellipsoid_takes_no_place_that_the_clearance_leaves(part: Solid, clearance: float) -> None:
    axes, half, middle = inscribed(part)
    way = np.random.default_rng(1).normal(size=(4000, 3))
    way /= np.linalg.norm(way, axis=1)[:, None]
    assert distances(part, (way * half) @ axes.T + middle).max() < 1e-6
    away = distances(part, (way * (half + clearance)) @ axes.T + middle)
    assert away.max() <= clearance + 1e-6
    if part.top < inf and isinstance(part, Cylinder):
        assert away.max() == pytest.approx(clearance, rel=1e-2)


def numbers(scale: Array, centre: Array, reach: float) -> Array:
    return np.array([*scale.T.ravel(), *centre, 0.0, reach**2])


@pytest.mark.slow
def test_the_distance_and_the_field_are_the_paper_s() -> None:
    rng = np.random.default_rng(3)
    scale, centre = rng.normal(size=(3, 3)) + 2 * np.eye(3), rng.normal(size=3)
    body, eye = ca.SX.sym("b", symbols.BODY_PARAMETERS), ca.SX.sym("e", 3)
    depth = ca.Function("depth", [body, eye], [symbols.inside(body, eye)])
    for at in centre + rng.normal(size=(20, 3)):
        away = at - centre
        found = float(depth(numbers(scale, centre, 1.3), at))
        assert found == pytest.approx(away @ (scale.T @ scale) @ away)  # Eq. 13
    (made, body_of), (without, _) = in_the_way(0.3, 1e3, 1.0), in_the_way(0.3, 1e3, 0.0)
    larger = 1.0 - (body_of.distance(made.states[:, :3]) / body_of.reach) ** 2  # Eq. 12
    references = (np.maximum(larger, 0.0) ** 2)[:-1] @ np.diff(breaks_of(subject()))
    found = [program.cost(one, one.states, one.inputs) for one in (made, without)]
    assert references > 0.1
    assert found[0] - found[1] == pytest.approx(references, rel=1e-6)


@cache
def subject() -> ClockSubject:
    text = crowd.MISSION.format(walkers="", kind="lateral", shot="side: right, distance: 6, altitude: 4")
    done = compile_source(text.encode(), "crowd.yaml", None, PlanOptions(refiner="none"))
    return subject_of(next(r.output for r in done.reports if r.name == "solve-path-qp"), "s")


def in_the_way(at: float, touch: float, field: float = 0.0) -> tuple[ClockProblem, MovingEllipsoid]:
    """A straight flight without half-spaces, and an ellipsoid just beside its middle: y is off by ``at``."""
    of = subject()
    breaks = breaks_of(of)
    guide = restrict(of.leg.curve.channels(0, 1, 2), breaks)
    course = guide(breaks)
    middle = len(breaks) // 2
    centres = np.tile(course[middle] + np.array([0.0, at, 0.0]), (len(breaks), 1))
    body = MovingEllipsoid(np.eye(3), centres, 1.5, 1.0)
    references = kept_from((body,), references_at(of, breaks), course)
    made = problem(
        of,
        breaks,
        references,
        NO_HALF_SPACES,
        Use(NEARLY_SHARE),
        guess(guide, breaks),
    )
    table, names = made.parameters.copy(), list(symbols.FIELDS)
    for name, value in (("touch", touch), ("field", field)):
        column = sum(symbols.FIELDS[other] for other in names[: names.index(name)])
        each = value if name == "touch" else value * np.append(np.diff(breaks), 0.0)
        table[:, column] = made.unit * each
    return replace(made, parameters=table), body


@pytest.mark.slow
def test_the_hard_solution_is_found_by_any_price_that_is_high_enough() -> None:
    places = []
    for price in (1e2, 1e4):
        made, body = in_the_way(0.3, price)
        found = program.solve(made, "fatrop")
        assert found.status == "solved"
        assert found.inputs[:, -1].max() < 1e-4
        assert body.distance(found.states[:, :3])[:-1].min() > 1 - 1e-4
        places.append(found.states[:, :3])
    assert np.abs(places[0] - places[1]).max() < 2e-3
    made, body = in_the_way(0.3, 1e-3)
    cheap = program.solve(made, "fatrop")
    assert body.distance(cheap.states[:, :3]).min() < 0.9


@pytest.mark.slow
def test_where_there_is_no_way_out_the_slack_is_what_is_lacking() -> None:
    made, body = in_the_way(0.3, 1e3)
    # The place where the motion begins is given, and now lies in it.
    start = made.states[0, :3]
    table = made.parameters.copy()
    first = symbols.size(symbols.Sizes(made.sizes.planes, made.sizes.occluders))
    table[0, first : first + symbols.BODY_PARAMETERS] = numbers(
        body.scale, start + np.array([0.0, 0.5, 0.0]), 1.5
    )
    found = program.solve(replace(made, parameters=table), "fatrop")
    assert found.status == "solved"
    assert found.inputs[0, -1] == pytest.approx(1 - 0.25, abs=1e-2)
    assert found.inputs[1:, -1].max() < 1e-3


@pytest.mark.slow
def test_the_field_pushes_away_only_where_it_reaches() -> None:
    for at, moves in ((1.2, True), (1.6, False)):
        plain, pushed = (in_the_way(at, 1e3, field) for field in (0.0, 1.0))
        a, b = (program.solve(made, "fatrop") for made, _ in (plain, pushed))
        nearest = [float(plain[1].distance(found.states[:, :3]).min()) for found in (a, b)]
        assert (nearest[1] > nearest[0] + 0.01) == moves
        assert nearest[1] == pytest.approx(nearest[0], abs=1e-6) or moves


def test_what_is_far_away_makes_no_part_of_the_problem() -> None:
    of = subject()
    breaks = breaks_of(of)
    references, course = references_at(of, breaks), of.leg.curve(breaks)[:, :3]
    far = MovingEllipsoid(np.eye(3), course + np.array([0.0, 0.0, 5.0]), 1.5, 1.0)
    assert kept_from((far,), references, course).bodies.shape[1] == 0
    near: ClockReferences = kept_from((far,), references, course + np.array([0.0, 0.0, 3.0]))
    assert near.bodies.shape[1] == 1
    assert (near.bodies[:, 0, 12] < NO_BODY_M2).all()
    # What was near once stays in the problem.
    assert kept_from((far,), near, course).bodies.shape[1] == 1


@pytest.mark.slow
@pytest.mark.parametrize("seed", [5, pytest.param(1, marks=pytest.mark.fuzz)])
def test_walkers_who_come_near_are_kept_farther_away_and_the_picture_stays(seed: int) -> None:
    text = crowd.scene(seed)
    with crowd.only(field=False, ellipsoid=False):
        neither = crowd.fly(text)
    with crowd.only(field=False, ellipsoid=True):
        ellipsoid = crowd.fly(text)
    both = crowd.fly(text)
    assert neither is not None
    assert ellipsoid is not None
    assert both is not None
    # The half-spaces hold more than the ellipsoids ask for: these change nothing.
    assert ellipsoid[:5] == pytest.approx(neither[:5], rel=0.05, abs=5e-3)
    assert both.nearest > neither.nearest
    assert both.screen < neither.screen + 1e-3
    assert weights.FIELD_WEIGHT > 0.0


@pytest.mark.long
def test_drones_that_need_no_distance_are_refined_beside_one_another() -> None:
    text = HEAD.replace("rules: {", "rules: {separation: 0, ") + SIDE + PASS
    done = compile_source(text.encode(), "m.yaml", None, PlanOptions())
    assert done.plan is not None, done.diagnostics
    assert not [d for d in done.diagnostics if d.code[0] == "R"]


def test_steps_do_not_grow_with_the_price_of_a_slack() -> None:
    """A slack is in a unit that costs 1. Were it in one of its own, these would take 13 to 17 steps."""
    steps = [program.solve(in_the_way(0.3, price)[0], "fatrop").iterations for price in (1.0, 1e3, 1e6)]
    assert max(steps) <= 12, steps
