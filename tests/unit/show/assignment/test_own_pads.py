"""The way home to own pads: levels by dense samples, and whole flights from pictures that mix everybody."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.distance import pdist

from shotc.geom.apart import stretch
from shotc.geom.fleet_spline import places
from shotc.ir.limits import Limits
from shotc.ir.show import Apart, Fleet
from shotc.ir.trajectory import VerifiedIR
from shotc.passes.verify.fleets.flight import FleetFlight
from shotc.passes.verify.fleets.shape import landed
from shotc.show.assignment.own_pads import levels, way_to_own
from tests.support.compiled import compiled_text
from tests.support.records import replace

APART = Apart("ellipsoid", 1.5, 2.5, 0.0)


def fleet(side: int, spacing: float) -> Fleet:
    pads = tuple((spacing * (i % side), spacing * (i // side), 0.0) for i in range(side * side))
    limits = Limits(5.0, 2.5, 2.0, 2.5, 8.0, 1.0, 1.0)
    path = ("fleets", "swarm")
    return Fleet("swarm", "show-drone", pads, 10.0, limits, 0.25, 900.0, APART, path, returns="own")


@pytest.mark.slow
@given(st.integers(0, 1000), st.integers(2, 40), st.floats(0.3, 4.0))
@settings(max_examples=60)
def test_two_of_one_level_are_apart_all_the_way(seed: int, count: int, least: float) -> None:
    rng = np.random.default_rng(seed)
    starts, ends = (rng.uniform(0.0, 12.0, (count, 2)) for _ in range(2))
    level = levels(starts, ends, least)
    near = np.full((count, count), np.inf)
    for share in np.linspace(0.0, 1.0, 401):
        at = (1.0 - share) * starts + share * ends
        near = np.minimum(near, np.linalg.norm(at[:, None] - at[None], axis=2))
    step = np.linalg.norm(ends - starts, axis=1).max() / 200.0
    same = (level[:, None] == level[None]) & ~np.eye(count, dtype=bool)
    assert near[same].min(initial=np.inf) >= least - 1e-6
    assert set(level) == set(range(level.max() + 1))
    # Nobody is on a higher level than he must: on each below is one in his way.
    for i in range(count):
        for below in range(level[i]):
            assert near[i, level == below].min() < least + step


@given(st.integers(0, 100), st.sampled_from([0.6, 1.0, 1.5, 2.0]))
@settings(max_examples=10)
def test_columns_are_apart_and_levels_end_over_own_pads(seed: int, spacing: float) -> None:
    of = fleet(5, spacing)
    mixed = np.random.default_rng(seed).permutation(np.array(of.pads)) * [3.0, 3.0, 0.0] + [0.0, 9.0, 30.0]
    way = way_to_own(of, mixed)
    assert pdist(way.columns[:, :2]).min() >= 1.5 - 2e-6
    np.testing.assert_allclose(way.down.pads, np.array(of.pads), atol=1e-6)
    np.testing.assert_array_equal(way.down.above[:, :2], way.down.pads[:, :2])
    np.testing.assert_array_equal(way.raised[:, :2], way.columns[:, :2])
    scale = [1.0, 1.0, stretch(APART)]
    for share in np.linspace(0.0, 1.0, 101):
        assert pdist(((1.0 - share) * way.raised + share * way.down.above) * scale).min() >= 1.5 - 2e-6


MISSION = """\
shotc: 1
mission: show
fleets:
  swarm:
    count: 16
    layout: {grid: {spacing: SPACING}}
    separation: {horizontal: 1.5 m, vertical: 2.5 m, shape: SHAPE}
    return: own
shots:
  - id: shapes
    kind: display
    fleet: swarm
    frames:
      - {cube: {center: [2, 2, 30], size: 7}, hold: 1}
      - {sphere: {center: [-2, 9, 34], radius: 6}, hold: 1}
"""


@cache
def planned(spacing: float, shape: str) -> VerifiedIR:
    done = compiled_text(MISSION.replace("SPACING", str(spacing)).replace("SHAPE", shape))
    assert done.plan is not None, done.diagnostics
    return done.plan


@pytest.mark.long
@pytest.mark.parametrize(("spacing", "shape"), [(0.6, "ellipsoid"), (1.6, "ellipsoid"), (0.8, "cylinder")])
def test_everybody_lands_where_he_took_off(spacing: float, shape: str) -> None:
    (track,) = planned(spacing, shape).trajectory.fleets
    ends = places(track.breaks, track.coef, track.breaks[[0, -1]])
    np.testing.assert_allclose(ends[:, 0], ends[:, 1], atol=1e-9)
    assert planned(spacing, shape).certificate[0].constraint == "distance from home"


@pytest.mark.slow
def test_two_that_exchange_their_pads_are_not_at_home() -> None:
    plan = planned(1.6, "ellipsoid")
    mission, (track,) = plan.trajectory.keyframes.mission, plan.trajectory.fleets
    coef = track.coef.copy()
    coef[[0, 1], -3:] = coef[[1, 0], -3:]
    swapped = replace(track, coef=coef)
    assert not landed(FleetFlight.of(mission, swapped)).holds
    any_pad = replace(mission, fleets=(mission.fleets[0]._replace(returns="any"),))
    assert landed(FleetFlight.of(any_pad, swapped)).holds
