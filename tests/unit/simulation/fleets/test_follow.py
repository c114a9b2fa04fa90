"""Drones led along paths whose errors are known."""

from itertools import pairwise
from math import inf

import numpy as np
import pytest

from shotc.geom.fleet_spline import places
from shotc.simulation.fleets.follow import FleetReference, Gains, preferred
from shotc.simulation.fleets.rehearse import FleetConditions
from shotc.simulation.fleets.vehicle import Gusts
from tests.support.fleet_flights import fly


def spline(points, repeats=1):
    """A drone's (or several drones' same) spline, a second between the points, at rest at both ends."""
    points = np.asarray(points, dtype=float)
    coef = np.concatenate([points[:1]] * 2 + [points] + [points[-1:]] * 2)
    return np.arange(len(coef) - 2.0), np.repeat(coef[None], repeats, axis=0)


def there_and_off(degrees, hold):
    """Twelve metres out, a hold, and off in another direction."""
    turn = np.radians(degrees)
    way = np.array([np.cos(turn), np.sin(turn), 0.0])
    out = [[2.0 * k, 0.0, 5.0] for k in range(7)]
    return [*out, *[out[-1]] * hold, *(np.array(out[-1]) + 2.0 * k * way for k in range(1, 7))]


def square(side):
    """Round a square in 20 s."""
    corners = side * np.array([[0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1], [0, 0, 1]])
    return [a + (b - a) * k / 5 for a, b in pairwise(corners) for k in range(5)] + [corners[-1]]


def test_a_reference_is_the_spline():
    breaks, coef = spline(square(7.0), 3)
    coef = coef + np.arange(3)[:, None, None]
    reference = FleetReference.of(breaks, coef)
    times = np.array([0.3, 7.77, 21.9])
    for order, found in enumerate(reference.each(times)):
        wanted = places(breaks, coef, times, order)
        assert found == pytest.approx(wanted[np.arange(3), np.arange(3)], abs=1e-9)


def test_on_its_path_and_in_time_a_drone_is_told_the_paths_velocity():
    reference = FleetReference.of(*spline([[3.0 * k, 0, 5] for k in range(12)]))
    place, rate, bend = reference.each(np.array([6.0]))
    assert bend == pytest.approx(np.zeros((1, 3)), abs=1e-9)
    asked = preferred(reference, Gains(), 6.0, place, rate)
    assert asked == pytest.approx(np.array([[3.0, 0.0, 0.0]]), abs=1e-6)


def test_the_four_errors_of_a_drone_beside_its_path():
    # A metre behind and half a metre to the left, moving at (2.5, 0.2, 0); the path goes east at 3 m/s.
    gains = Gains(along=(2.0, 0.4), across=(1.5, 0.3), forward=0.3)
    reference = FleetReference.of(*spline([[3.0 * k, 0, 5] for k in range(12)]))
    place, _, _ = reference.each(np.array([6.0]))
    asked = preferred(reference, gains, 6.0, place + np.array([-1.0, 0.5, 0.0]), np.array([[2.5, 0.2, 0.0]]))
    along = 3.0 + 2.0 * 1.0 + 0.4 * (3.0 - 2.5)
    across = -1.5 * 0.5 - 0.3 * 0.2
    assert asked == pytest.approx(np.array([[along, across, 0.0]]), abs=1e-6)


def test_a_hover_draws_back_from_any_side():
    reference = FleetReference.of(*spline([[1.0, 2.0, 5.0]] * 3))
    away = np.array([[0.3, -0.4, 0.0]])
    asked = preferred(reference, Gains(along=(2.0, 0.4)), 1.0, np.array([[1.0, 2.0, 5.0]]) + away, 0 * away)
    assert asked == pytest.approx(-2.0 * away, abs=1e-9)
    still = preferred(reference, Gains(), 1.0, np.array([[1.0, 2.0, 5.0]]), 0 * away)
    assert still == pytest.approx(0 * away, abs=1e-12)


@pytest.mark.slow
def test_no_lag_is_left_on_a_straight_line():
    flown = fly(*spline([[2.0 * k, 0, 5] for k in range(15)]), FleetConditions())
    steady = (flown.times > 8.0) & (flown.times < 14.0)
    assert flown.error[:, steady].max() < 0.01
    assert flown.error[0, -1] < 0.06


@pytest.mark.slow
def test_feed_forward_turns_a_corner_closer():
    path = spline(square(10.0))
    with_it, without = fly(*path, FleetConditions()), fly(*path, FleetConditions(gains=Gains(forward=0.0)))
    assert with_it.rmse < 0.6 * without.rmse
    assert with_it.error.max() < without.error.max()


@pytest.mark.long
@pytest.mark.parametrize("hold", [2, 4])
@pytest.mark.parametrize("degrees", [90, 150, 180])
def test_nobody_is_left_behind_a_turn_after_a_hold(degrees, hold):
    path = spline(there_and_off(degrees, hold))
    printed = fly(*path, FleetConditions(gains=Gains(reach=inf)))
    cured = fly(*path, FleetConditions())
    assert printed.error.max() > 2.0
    assert cured.error.max() < 0.4


@pytest.mark.slow
def test_gusts_leave_nobody_behind_either():
    path = spline(there_and_off(180, 2), repeats=30)
    cured = fly(*path, FleetConditions(gusts=Gusts(0.3), seed=3))
    printed = fly(*path, FleetConditions(gains=Gains(reach=inf), gusts=Gusts(0.3), seed=3))
    assert cured.error.max() < 0.8
    assert printed.error.max() > 2.0


@pytest.mark.slow
def test_a_look_ahead_leads_by_its_time():
    path = spline([[2.0 * k, 0, 5] for k in range(15)])
    flown = fly(*path, FleetConditions(gains=Gains(ahead=0.1)))
    middle = np.argmin(np.abs(flown.times - 10.0))
    lead = (flown.position - flown.planned)[0, middle, 0]
    assert lead == pytest.approx(2.0 * 0.1, abs=0.01)


@pytest.mark.slow
def test_flights_depend_on_their_seed_alone():
    path = spline(square(5.0), 4)
    one, same, other = (fly(*path, FleetConditions(gusts=Gusts(0.3), seed=s)) for s in (1, 1, 2))
    assert np.array_equal(one.position, same.position)
    assert not np.array_equal(one.position, other.position)
