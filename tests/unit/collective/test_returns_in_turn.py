"""Collective returns of groups whose ways home cross: one waits for the other, and dense samples agree."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest

from shotc import collective
from shotc.collective import collective_returns
from shotc.collective.homing import Homing
from shotc.geom.fleet_spline import places
from tests.support.compiled import compiled_text
from tests.support.grouped_shows import ACROSS, CROSSING, least_between

pytestmark = pytest.mark.slow
AT_S = 92.0
FLARE = """\
shotc: 1
mission: flare
fleets:
  solo: {count: 1, layout: {grid: {spacing: 3, origin: [40, 30, 0]}}, separation: 2}
  swarm: {count: 4, layout: {grid: {spacing: 4, origin: [0, 0, 0]}}, separation: 2}
shots:
  - id: star
    kind: display
    fleet: solo
    frames: [{sphere: {center: [2, 30, 20], radius: 1}, at: 40 s, hold: 30}]
    pyro: [{at: 45 s, drones: [1], product: flare, duration: 12 s, clear: 12 m}]
  - id: ball
    kind: display
    fleet: swarm
    frames: [{sphere: {center: [2, 56, 20], radius: 4}, at: 40 s, hold: 30}]
"""
"""The way home of the swarm leads below the other fleet's drone, whose flare burns until 57 s."""


@pytest.mark.long
def test_groups_whose_ways_home_cross_give_way_to_each_other(monkeypatch: pytest.MonkeyPatch) -> None:
    plan = compiled_text(CROSSING).plan
    assert plan is not None
    found = next(r for r in collective_returns(plan, AT_S, lambda _: None) if r.time == AT_S)
    assert found.holds
    (waiting,) = [fleet for fleet in found.fleets if fleet.waits > 0.0]
    assert waiting.track is not None
    assert waiting.over >= waiting.rest + waiting.waits
    planned = {flight.fleet: flight for flight in plan.trajectory.fleets}
    flown = [fleet.track or planned[fleet.fleet] for fleet in found.fleets]
    times = np.linspace(AT_S, found.down, 3000)
    for one, other in combinations(flown, 2):
        assert least_between(one, other, times) >= ACROSS - 1e-6
    monkeypatch.setattr(collective, "_in_turn", lambda *_: None)
    alone = next(r for r in collective_returns(plan, AT_S, lambda _: None) if r.time == AT_S)
    assert not alone.holds
    assert {claim.constraint for claim in alone.broken} == {"separation from swarm/ring"}


def test_a_fleet_that_has_not_taken_off_stays_on_its_pads() -> None:
    plan = compiled_text(FLARE).plan
    assert plan is not None
    for flight in plan.trajectory.fleets:
        homing = Homing(plan.trajectory, flight)
        moved = int(np.argmax((flight.coef != flight.coef[:, :1]).any(axis=(0, 2))))
        time = 0.5 * float(flight.breaks[moved - 3])
        assert time > 0.0
        breaks, coef = homing.flown(time, homing.at(time))
        at = places(breaks, coef, np.linspace(breaks[0], breaks[-1], 20))
        np.testing.assert_allclose(at, np.repeat(flight.coef[:, :1], 20, axis=1), atol=1e-12)


def test_a_fleet_on_its_way_home_keeps_clear_of_what_burns_on_another(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    plan, time = compiled_text(FLARE).plan, 46.0
    assert plan is not None

    def nearest() -> float:
        found = next(r for r in collective_returns(plan, time, lambda _: None) if r.time == time)
        assert found.holds
        times = np.linspace(time, 57.0, 600)
        solo, swarm = (places(way.track.breaks, way.track.coef, times) for way in found.fleets if way.track)
        least = float(np.linalg.norm(solo - swarm, axis=-1).min())
        for claim in found.between:
            assert claim.worst <= least + 1e-3
        return least

    assert nearest() >= 12.0
    monkeypatch.setattr(collective, "burning_beside", lambda *_: iter(()))
    assert nearest() < 8.0
