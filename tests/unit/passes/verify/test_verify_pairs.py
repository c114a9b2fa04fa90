"""Two flights on one clock, taken from each other piece by piece."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from shotc.geom.bernstein import Piecewise
from shotc.passes.verify import pair
from shotc.passes.verify.claims import JudgedFlight
from shotc.passes.verify.pair import _difference
from tests.support.tampered_plans import MISSION, PLAN


@pytest.mark.parametrize("seed", range(6))
def test_the_difference_of_two_flights_holds_at_every_instant(seed: int) -> None:
    """Breaks that differ, that are shared but for rounding, and one drone that stands after it has landed."""
    draw = np.random.default_rng(seed)

    def flight(breaks: np.ndarray) -> Piecewise:
        return Piecewise(breaks, draw.normal(scale=20.0, size=(len(breaks) - 1, 6, 3)))

    breaks = np.concatenate([[0.0], np.cumsum(draw.uniform(0.01, 5.0, 7))])
    other = breaks[:5] * (1 + 1e-15) if seed % 2 else np.concatenate([[0.0], np.sort(draw.uniform(0, 30, 9))])
    one, two = flight(breaks), flight(other)
    apart = _difference(one, two)
    assert apart.low[0] == 0.0
    assert apart.high[-1] == max(one.end, two.end)
    assert (apart.low[1:] == apart.high[:-1]).all()
    wide = apart.high - apart.low > 1e-9
    middle = 0.5 * (apart.low + apart.high)[wide]
    found = Piecewise(np.append(apart.low, apart.high[-1]), apart.ctrl)(middle)
    assert np.abs(found - (one(middle) - two(middle))).max() < 1e-9


def test_a_camera_keeps_its_separation_from_drones_that_stand_on_their_pads(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    track, mission = PLAN.drones[0], MISSION
    t = np.linspace(track.curve.start, track.curve.end, 4001)
    flown = track.curve(t)[:, :3]
    pads = ((0.0, -41.0, 18.5), (90.0, 90.0, 0.0))
    monkeypatch.setattr(pair, "parked_fleets", lambda _: [SimpleNamespace(name="spare", pads=pads)])
    (found,) = pair.from_fleets(PLAN, [JudgedFlight(mission, mission.drones[0], track)])
    least = float(np.linalg.norm(flown - np.array(pads[0]), axis=1).min())
    assert (found.constraint, found.limit) == ("separation from spare", mission.rules.separation)
    assert found.worst == pytest.approx(least, abs=2e-3)
    assert found.holds is (least >= mission.rules.separation)
