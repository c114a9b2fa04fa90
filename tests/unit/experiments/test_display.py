"""The display paper's tables: what they stand on, and that the goals set for them are met."""

from __future__ import annotations

import numpy as np
import pytest

from shotc.geom.apart import stretch
from shotc.geom.fleet_spline import differences, places
from shotc.geom.separation import closest
from shotc.ir.limits import Limits
from shotc.show.geom.push_apart import nearest_pair
from shotc.show.solvers.qcqp import DerivativeBounds, bounded, deviation
from shotc.simulation.fleets.rehearse import FleetConditions
from shotc.simulation.fleets.vehicle import FleetVehicle
from tests.experiments.papers import bodies, coverage, crossing, following, limited
from tests.support.fleet_flights import fly


@pytest.mark.slow
@pytest.mark.parametrize(("name", "draw", "n", "axis", "paper"), coverage.OBJECTS)
def test_with_less_weight_the_view_gains_and_the_volume_loses_less(name, draw, n, axis, paper):
    volume, view = coverage.costs(draw, n, axis, seed=0)
    assert volume[0] < volume[1] < volume[2]
    assert view[0] > view[1] > view[2]
    assert 1 - view[1] / view[0] > volume[1] / volume[0] - 1


def test_points_lie_evenly_in_a_body():
    points = bodies.sphere(20_000, 1)
    assert np.linalg.norm(points, axis=1).max() <= 1.0
    assert (np.linalg.norm(points, axis=1) ** 3).mean() == pytest.approx(0.5, abs=0.01)
    tall = bodies.human(20_000, 1)
    assert 1.7 < np.ptp(tall[:, 2]) < 1.9


def test_a_calm_spline_is_left_as_it_is_and_a_hasty_one_brought_within_the_limits():
    breaks, calm = limited.control_points(following.square(5.0))
    assert limited.Limited(breaks).solver()(calm) == pytest.approx(calm, abs=1e-4)
    breaks, hasty = limited.control_points(following.square(30.0))
    found = limited.Limited(breaks).solver()(hasty)
    assert np.linalg.norm(differences(breaks, 1) @ found, axis=1).max() <= limited.SPEED + 1e-5
    assert np.abs(differences(breaks, 2) @ found).max() <= limited.ACCELERATION + 1e-5
    assert found[[0, -1]] == pytest.approx(hasty[[0, -1]], abs=1e-5)


def test_samples_do_not_bound_what_lies_between():
    walk = np.cumsum(np.random.default_rng(1).normal(0.0, 2.0, (20, 3)), axis=0)
    breaks, asked = limited.control_points(walk)
    sampled, proved = (limited.Limited(breaks, 1.0, samples=k).solver()(asked)[None] for k in (1, None))
    assert limited.fastest(breaks, sampled) > 1.05
    assert limited.fastest(breaks, proved) <= 1.0 + 1e-5


@pytest.mark.slow
def test_the_square_at_three_metres_a_second_is_followed_within_six_centimetres():
    breaks, coef = following.limited_square(15.0)
    assert fly(breaks, coef[None], FleetConditions()).rmse <= 0.06


def test_the_solver_of_plan_finds_what_the_papers_programme_finds():
    # In a plane, for plan bounds horizontal and vertical speed apart.
    walk = np.cumsum(np.random.default_rng(2).normal(0.0, 2.0, (20, 3)) * [1.0, 1.0, 0.0], axis=0)
    breaks, asked = limited.control_points(walk)
    limits = Limits(limited.SPEED, 9.0, 9.0, limited.ACCELERATION, 1e3, 9.0, 9.0)
    plan = bounded(breaks, asked[None], DerivativeBounds(limits, per_axis=True)).coef[0]
    paper = limited.Limited(breaks).solver()(asked)
    cost = [np.einsum("cd,ck,kd->", c - asked, deviation(breaks), c - asked) for c in (plan, paper)]
    assert cost[0] == pytest.approx(cost[1], rel=5e-3)
    assert np.abs(plan - paper).max() < 0.02


@pytest.mark.slow
def test_what_is_preferred_dips_before_the_path_does():
    breaks, coef = following.moving_sphere(10.0)
    flown = fly(breaks, coef, FleetConditions())
    path = following.dip(flown, places(breaks, coef[:1], flown.times, 1)[0])
    preferred = following.dip(flown, flown.preferred[0])
    assert path[1] == pytest.approx(2.0 / np.sqrt(2.0), abs=0.01)
    assert 0.1 < path[0] - preferred[0] < 0.5


@pytest.mark.parametrize("assignment", ["random", "least squares"])
def test_only_a_matched_plan_is_apart(assignment):
    case = crossing.Case(assignment, 0.15, FleetVehicle(), avoids=False)
    breaks, coef = crossing.move(60, case)
    height = [1.0, 1.0, stretch(crossing.NEEDED)]
    for at in (0, -len(coef[0]) // 2):
        assert nearest_pair(coef[:, at] * height) >= np.sqrt(2.0) * 0.85 - 1e-9
    proven = closest(breaks, coef, crossing.NEEDED).proven
    assert (proven >= 0.85) == (assignment == "least squares")
    rate = np.linalg.norm(differences(breaks, 1) @ coef, axis=2).max()
    bend = np.linalg.norm(differences(breaks, 2) @ coef, axis=2).max()
    assert rate <= limited.SPEED + 1e-9
    assert bend <= limited.ACCELERATION + 1e-9
