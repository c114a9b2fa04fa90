"""Collective returns, by dense samples that know nothing of how they were found."""

from __future__ import annotations

from functools import cache
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.distance import pdist

from shotc.collective import Return, collective_returns
from shotc.collective.braking import FlightSpline
from shotc.collective.homing import Homing
from shotc.collective.missing_returns import no_return
from shotc.geom.apart import stretch
from shotc.geom.fleet_spline import places, rest_of
from shotc.ir.limits import Limits
from shotc.ir.trajectory import TrajectoryIR, VerifiedIR
from tests.support.compiled import compiled_text
from tests.support.records import replace

MISSION = """\
shotc: 1
mission: show
fleets:
  swarm:
    count: 30
    layout: {grid: {spacing: 1.6}}
    separation: {horizontal: 1.5 m, vertical: 2.5 m}
    rise: 8 m
world: {zones: {mast: {keep: out, cylinder: {center: [-14, 4], radius: 2, height: [0, 60]}}}}
shots:
  - id: shapes
    kind: display
    fleet: swarm
    frames:
      - {cube: {center: [4, 4, 26], size: 5}, hold: 3}
      - {sphere: {center: [-2, 20, 30], radius: 4}, transition: {path: arc}, hold: 2}
      - {torus: {center: [4, 4, 26], radius: 7, tube: 2}, hold: 2}
"""
LATE = """\
  late:
    count: 6
    layout: {grid: {spacing: 4, origin: [30, 0, 0]}}
"""
BESIDE = """\
  - {id: by, kind: display, fleet: late, frames: [{cube: {center: [36, 4, 26], size: 6}, hold: 4}]}
"""

pytestmark = pytest.mark.slow


def plan_of(text: str) -> VerifiedIR:
    done = compiled_text(text)
    assert done.plan is not None, done.diagnostics
    return done.plan


@cache
def returns(text: str, every: float) -> list[Return]:
    return collective_returns(plan_of(text), every, lambda _: None)


def nearest(ir: TrajectoryIR, breaks: np.ndarray, coef: np.ndarray) -> float:
    """Return the least stretched distance at dense samples, metres."""
    scale = np.array([1.0, 1.0, stretch(ir.keyframes.mission.fleets[0].apart)])
    at = places(breaks, coef, np.arange(breaks[0], breaks[-1], 0.05)) * scale
    return min(float(pdist(at[:, k]).min()) for k in range(at.shape[1]))


@pytest.mark.long
def test_every_second_has_a_return_that_is_apart_within_limits_and_ends_on_pads() -> None:
    ir = plan_of(MISSION).trajectory
    flight, limits = ir.fleets[0], ir.keyframes.mission.fleets[0].limits
    found = returns(MISSION, 1.0)
    assert [r.time for r in found] == [float(k) for k in range(1, len(found) + 1)]
    assert found[-1].time > flight.breaks[-1] - 1.0
    assert all(r.holds for r in found)
    braked = 0
    for homing, one in ((Homing(ir, flight), r) for r in found):
        way = one.fleets[0]
        breaks, coef = homing.flown(one.time, way)
        # It goes on from where the plan is, as fast, and turning as it does.
        for order in range(3):
            due = places(flight.breaks, flight.coef, breaks[:1], order)
            assert places(breaks, coef, breaks[:1], order) == pytest.approx(due, abs=1e-7)
        assert nearest(ir, breaks, coef) >= 1.5 - 2e-6
        ends = places(breaks, coef, breaks[-1:])[:, 0]
        away = np.linalg.norm(ends[:, None] - np.array(ir.keyframes.mission.fleets[0].pads), axis=2)
        assert (away.min(axis=0) < 1e-6).all()
        assert breaks[-1] == pytest.approx(way.down)
        dense = np.arange(breaks[0], breaks[-1], 0.02)
        speed = places(breaks, coef, dense, 1)
        assert np.hypot(speed[..., 0], speed[..., 1]).max() <= limits.speed * (1 + 1e-5)
        assert speed[..., 2].max() <= limits.climb * (1 + 1e-5)
        assert -speed[..., 2].min() <= limits.descent * (1 + 1e-5)
        push = places(breaks, coef, dense, 2)
        assert np.linalg.norm(push, axis=2).max() <= limits.acceleration * (1 + 1e-5)
        braked += way.track is not None and way.track.breaks[0] < way.rest
    assert braked > 5


@pytest.mark.long
def test_two_fleets_are_proved_against_each_other() -> None:
    text = MISSION.replace("world:", LATE + "world:") + BESIDE
    found = returns(text, 7.0)
    assert found
    assert all(r.holds and [c.constraint for c in r.between] == ["separation from late"] for r in found)
    assert min(r.between[0].worst for r in found) > 10.0


@pytest.mark.long
def test_a_return_that_outlasts_the_endurance_is_told_with_the_seconds_that_would_do() -> None:
    whole = plan_of(MISSION)
    held = returns(MISSION, 1.0)
    longest = max(r.down for r in held)
    mission = whole.trajectory.keyframes.mission
    short = replace(mission, fleets=(mission.fleets[0]._replace(endurance=longest - 4.0),))
    keyframes = replace(whole.trajectory.keyframes, mission=short)
    plan = replace(whole, trajectory=replace(whole.trajectory, keyframes=keyframes))
    found = collective_returns(plan, 1.0, lambda _: None)
    told = list(no_return(short, found))
    late = {r.time for r in held if r.fleets[0].track is not None and r.down > longest - 4.0 + 1e-5}
    assert late
    assert {r.time for r in found if not r.holds} == late
    assert [d.code for d in told] == ["V063"]
    assert "endurance" in told[0].notes[0]
    worst = max(r.down for r in found if not r.holds) - longest + 4.0
    sooner = float(told[0].help.split(" until then ")[1].split(" s")[0])
    assert worst <= sooner <= worst + 0.02


@given(st.integers(0, 10_000), st.floats(0.0, 1.0))
@settings(max_examples=25, deadline=None)
def test_braking_keeps_to_the_way_and_to_all_limits(seed: int, share: float) -> None:
    rng = np.random.default_rng(seed)
    breaks = np.arange(25) * 1.0
    coef = np.repeat(np.cumsum(rng.normal(size=(1, 27, 3)) * 0.3, axis=1), 5, axis=0)
    coef = np.concatenate([coef[:, :1]] * 2 + [coef[:, :-4]] + [coef[:, -5:-4]] * 2, axis=1)
    coef = coef + 3.0 * rng.normal(size=(5, 1, 3))
    limits = Limits(4.0, 3.0, 3.0, 3.0, 12.0, 1.0, 1.0)
    time = share * 20.0
    rest = FlightSpline(breaks, coef).braked(time, 24.0, limits)
    assert rest is not None
    assert rest.breaks[0] == time
    for order in (1, 2):
        assert np.abs(places(rest.breaks, rest.coef, rest.breaks[-1:], order)).max() < 1e-9
        start = places(rest.breaks, rest.coef, rest.breaks[:1], order)
        assert start == pytest.approx(places(breaks, coef, np.array([time]), order), abs=1e-9)
    # All have gone alike, so all are still where they were from each other; and on the planned line.
    at = places(rest.breaks, rest.coef, np.linspace(rest.breaks[0], rest.breaks[-1], 60))
    assert np.abs(at - at[:1] - (at[:, :1] - at[:1, :1])).max() < 1e-9
    line = places(breaks, coef, np.linspace(time, min(time + 20.0, 24.0), 8000))[0]
    off = np.linalg.norm(at[0][:, None] - line[None], axis=2).min(axis=1)
    assert off.max() < 0.01
    jerk = np.diff(places(rest.breaks, rest.coef, np.linspace(*rest.breaks[[0, -1]], 4000), 2)[0], axis=0)
    step = (rest.breaks[-1] - rest.breaks[0]) / 3999
    assert np.linalg.norm(jerk, axis=1).max() <= limits.jerk * step * (1 + 1e-6) + 1e-9


@given(st.integers(0, 10_000), st.floats(0.0, 0.995))
@settings(max_examples=40, deadline=None)
def test_the_rest_of_a_flight_is_the_flight(seed: int, share: float) -> None:
    rng = np.random.default_rng(seed)
    breaks = np.cumsum(np.concatenate([[0.0], rng.uniform(0.1, 2.0, size=12)]))
    coef = rng.normal(size=(2, 15, 3))
    left, ctrl = rest_of(breaks, coef, share * breaks[-1])
    assert all(b > a for a, b in pairwise(left))
    at = np.linspace(left[0], breaks[-1], 200)
    for order in range(3):
        assert places(left, ctrl, at, order) == pytest.approx(places(breaks, coef, at, order), abs=1e-5)
