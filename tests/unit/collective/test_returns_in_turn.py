"""Collective returns of groups whose ways home cross: one waits for the other, and dense samples agree."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest

from shotc import collective
from shotc.collective import collective_returns
from tests.support.compiled import compiled_text
from tests.support.grouped_shows import ACROSS, CROSSING, least_between

pytestmark = pytest.mark.slow
AT_S = 92.0


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
