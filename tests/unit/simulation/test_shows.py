"""Fleets and cameras flown on one clock: how near two of them come."""

import numpy as np
import pytest

from shotc.geom.bernstein import Array
from shotc.simulation.conditions import Conditions
from shotc.simulation.flight import DroneRuns
from shotc.simulation.shows import fly_fleets
from tests.support.film_plans import orbit_mission
from tests.support.show_plans import PADS, display, fleet, mission, show

ASIDE = tuple((x, -3.0, 0.0) for x, _, _ in PADS)


def camera(position: Array) -> DroneRuns:
    """Return a camera that stands at a place in the one run."""
    times = np.array([0.0, 100.0])
    still, angle = np.zeros((2, 1, 3)), np.zeros((2, 1))
    return DroneRuns("cam1", times, np.tile(position, (2, 1, 1)), still, angle, angle, angle, still, ())


@pytest.mark.long
def test_two_fleets_that_fly_alike_stay_as_far_apart_as_their_pads():
    flown = mission(
        fleets=(fleet(), fleet(ASIDE, "other")), displays=(display(), display("ring", "other", 1))
    )
    (run,) = fly_fleets(show(flown), Conditions(), [0])
    (pair,) = run.pairs
    assert (pair.one, pair.other, pair.required) == ("swarm", "other", 1.0)
    assert pair.near.distance == pytest.approx(3.0, abs=1e-6)
    assert pair.near.first == pair.near.second
    assert pair.near.below == 0
    assert pair.clearance == pytest.approx(3.0 - 2 * 0.3, abs=1e-6)


@pytest.mark.long
def test_a_camera_in_the_way_of_a_fleet_is_told_with_the_drone_that_meets_it():
    # It stands over the third pad, where that drone comes through on its way up and down.
    filmed = mission(drones=orbit_mission().drones)
    (run,) = fly_fleets(show(filmed), Conditions(), [0], [camera(np.array([8.0, 0.2, 5.0]))])
    (pair,) = run.pairs
    assert (pair.one, pair.other) == ("swarm", "cam1")
    assert pair.required == 3.0
    assert pair.near.distance == pytest.approx(0.2, abs=1e-3)
    assert (pair.near.first, pair.near.second, pair.near.below) == (2, 0, 1)
    assert pair.clearance < 0.0
