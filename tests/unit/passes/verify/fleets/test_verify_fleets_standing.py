"""What is proved of fleets over terrain and beside meshes, held to values known by hand and to samples."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from shotc.geom.bernstein import Array
from shotc.geom.fleet_spline import places
from shotc.ir.fleet import FleetTrajectory
from shotc.ir.keyframes import KeyframeIR
from shotc.ir.mission import MissionIR
from shotc.ir.trajectory import Claim, TrajectoryIR
from tests.support.few import examples
from tests.support.show_plans import RISE, flight, mission
from tests.support.standing_worlds import from_box, height_over, house, over, ridge, terrain
from tests.support.surfaces import Grid
from tests.support.terrain_missions import relief
from tests.support.verdicts import verdict_on

RADIUS = 0.3
FREE = (8.0, 38.0)


def claims(asked: MissionIR, flown: FleetTrajectory) -> dict[str, Claim]:
    ir = TrajectoryIR(KeyframeIR(asked, ()), (), (), (), (flown,))
    return {c.constraint: c for c in verdict_on(ir).certificate}


def free(flown: FleetTrajectory, count: int = 4000) -> Array:
    return places(flown.breaks, flown.coef, np.linspace(*FREE, count))


def test_over_even_ground_all_is_as_much_lower_as_the_ground_is_higher() -> None:
    level = Grid(np.full((61, 61), 6.0), 10.0, *_flat(6.0))
    asked = mission()
    flown = flight(asked.fleets[0])
    plain = claims(asked, flown)["ground clearance"]
    high = claims(asked._replace(terrain=terrain(level)), flown)
    assert high["ground clearance"].worst == pytest.approx(plain.worst - 6.0, abs=1e-6)
    assert high["distance from terrain"].worst == pytest.approx(RISE - 6.0 - RADIUS, abs=1e-6)
    assert high["ground clearance"].time == pytest.approx(plain.time, abs=2.0) or plain.time is None


def _flat(height: float) -> tuple[Array, Array]:
    from tests.support.surfaces import grid

    made = grid(np.full((61, 61), height), 10.0)
    return made.corners, made.faces


def test_a_ridge_that_reaches_up_into_the_flight_is_told_with_the_drone_and_the_depth() -> None:
    shape = ridge(26.0, at=0.0, half=30.0)  # its crest runs along y, below the first drone's way
    asked = mission(terrain=terrain(shape))
    flown = flight(asked.fleets[0])
    found = claims(asked, flown)["ground clearance"]
    least = height_over(shape, free(flown)).min() - RADIUS
    assert found.worst == pytest.approx(least, abs=1e-3)
    assert not found.holds
    assert found.drones == ("swarm-1",)
    assert found.method == "bounded"


def test_a_flight_that_leaves_the_terrain_holds_nothing() -> None:
    asked = mission()
    away = replace(flight(asked.fleets[0]), coef=flight(asked.fleets[0]).coef + np.array([295.0, 0.0, 0.0]))
    found = claims(asked._replace(terrain=terrain(ridge(0.0))), away)["ground clearance"]
    assert found.worst == -np.inf
    assert not found.holds


@pytest.mark.slow
@settings(max_examples=examples(12, 300), deadline=None)
@given(st.integers(0, 2**31), st.floats(2.0, 30.0))
def test_nothing_that_is_sampled_is_beyond_what_is_proved(seed: int, height: float) -> None:
    shape = relief(seed % 1000, height)
    rng = np.random.default_rng(seed)
    centre = tuple((rng.uniform(-10.0, 20.0, 3) + np.array([0.0, 10.0, 20.0])).tolist())
    size = tuple(rng.uniform(2.0, 12.0, 3).tolist())
    base = mission()
    rules = base.rules._replace(max_height=60.0)
    asked = over(base, shape)._replace(meshes=(house(centre, size),), rules=rules)  # type: ignore[arg-type]
    flown = flight(asked.fleets[0])
    found, at = claims(asked, flown), free(flown)
    low = float(height_over(shape, at).min())
    assert found["ground clearance"].worst == pytest.approx(low - RADIUS, abs=0.02)
    assert found["ground clearance"].worst <= low - RADIUS + 1e-9
    assert found["height above ground"].worst >= height_over(shape, at).max() - 1e-9
    near = float(from_box(at, centre, size).min())  # type: ignore[arg-type]
    assert found["distance from buildings"].worst <= near - RADIUS + 1e-9
    if near > 0.05:
        assert found["distance from buildings"].worst == pytest.approx(near - RADIUS, abs=0.02)
    assert found["distance from terrain"].worst <= low - RADIUS + 1e-9


def test_a_drone_whose_pad_is_in_a_house_is_in_it_all_the_way() -> None:
    asked = mission(meshes=(house((0.0, 0.0, 2.0), (3.0, 3.0, 6.0)),))
    found = claims(asked, flight(asked.fleets[0]))["distance from buildings"]
    assert found.worst < 0.0
    assert not found.holds
    assert found.drones == ("swarm-1",)


@pytest.mark.parametrize(("top", "holds"), [(-0.01, True), (3.0, False)])
def test_over_its_pad_a_body_may_be_as_near_as_it_stands_and_no_nearer(top: float, *, holds: bool) -> None:
    """A roof on which a drone stands is as near on its way; one that reaches over its way is not."""
    slab = house((0.0, 0.0, -0.5), (3.0, 3.0, 0.98)) if holds else house((0.0, 1.0, top), (1.8, 1.8, 1.0))
    asked = mission(meshes=(slab,))
    found = claims(asked, flight(asked.fleets[0]))["distance from buildings at home"]
    assert found.holds == holds
    assert found.limit == 0.0
