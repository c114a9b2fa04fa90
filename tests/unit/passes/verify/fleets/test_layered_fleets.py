"""Fleets whose pads are nearer than their separation: what is proved of them, and breaches of it."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from scipy.spatial.distance import pdist, squareform

from shotc.geom.apart import stretch
from shotc.geom.fleet_spline import places
from shotc.geom.on_pads import on_pads
from shotc.ir.fleet import FleetTrajectory
from shotc.ir.trajectory import Claim, TrajectoryIR
from shotc.passes.verify.fleets.apart import separations
from shotc.passes.verify.fleets.flight import FleetFlight
from shotc.planning.take_off import bodies_of, take_off_of
from tests.support.compiled import compiled_text
from tests.support.records import replace

MISSION = """\
shotc: 1
mission: show
fleets:
  swarm:
    count: 16
    layout: {LAYOUT}
    separation: {horizontal: 1.5 m, vertical: 2.5 m, margin: 0.05}
    rise: 6 m
shots:
  - id: shapes
    kind: display
    fleet: swarm
    frames: [{sphere: {center: [3, 9, 34], radius: 5}, hold: 1}]
"""
GRID, CIRCLE = "grid: {spacing: 0.6}", "circle: {radius: 2.2}"

pytestmark = pytest.mark.slow


@cache
def planned(layout: str = GRID) -> TrajectoryIR:
    done = compiled_text(MISSION.replace("LAYOUT", layout))
    assert done.plan is not None, done.diagnostics
    return done.plan.trajectory


def judged(ir: TrajectoryIR, track: FleetTrajectory, **changes: object) -> dict[str, Claim]:
    mission = ir.keyframes.mission
    mission = replace(mission, fleets=(mission.fleets[0]._replace(**changes),))
    return {claim.constraint: claim for claim in separations([FleetFlight.of(mission, track)])}


def kinds(of: dict[str, Claim]) -> list[str]:
    return [name for name, claim in of.items() if not claim.holds]


@pytest.mark.parametrize("layout", [GRID, CIRCLE])
def test_both_rules_hold_by_dense_samples(layout: str) -> None:
    ir = planned(layout)
    (fleet,), (track,) = ir.keyframes.mission.fleets, ir.fleets
    times = np.arange(0.0, track.breaks[-1], 0.02)
    at = np.moveaxis(places(track.breaks, track.coef, times), 1, 0)
    pads = np.array(fleet.pads)
    # Where a drone is exactly over no pad but on one, whatever its spline says.
    lifted = np.array([np.argmax(np.linalg.norm(at[:, k] - pads[k], axis=1) > 1e-6) for k in range(16)])
    landed = np.array(
        [len(at) - np.argmax(np.linalg.norm(at[::-1, k] - at[-1, k], axis=1) > 1e-6) for k in range(16)]
    )
    air, ground = np.inf, np.inf
    scale = np.array([1.0, 1.0, stretch(fleet.apart)])
    for k, points in enumerate(at):
        aloft = (k >= lifted) & (k < landed)
        both = np.logical_and.outer(aloft, aloft) & ~np.eye(16, dtype=bool)
        away = squareform(pdist(points * scale))
        air = min(air, away[both].min(initial=np.inf))
        if not aloft.all():
            ground = min(ground, pdist(points).min())
    found = judged(ir, track)
    assert list(found) == ["separation in the air", "separation on pads"]
    assert not kinds(found)
    assert 1.55 <= found["separation in the air"].worst <= air + 1e-6
    assert air <= found["separation in the air"].worst + 0.01
    assert bodies_of(fleet).across == pytest.approx(0.55)
    assert found["separation on pads"].worst == pytest.approx(ground, abs=1e-5)


def test_the_highest_rises_first_and_lands_last() -> None:
    ir = planned()
    (fleet,), (track,) = ir.keyframes.mission.fleets, ir.fleets
    take_off, stands = take_off_of(fleet), on_pads(track.coef, np.array(fleet.pads))
    layer = np.array(take_off.layer)
    lifts = [set(np.argmin(stands[layer == k], axis=1).tolist()) for k in range(len(take_off.heights))]
    assert all(len(at) == 1 for at in lifts)
    assert [min(at) for at in lifts] == sorted({min(at) for at in lifts})
    top = places(track.breaks, track.coef, np.array([track.phases[0].end]))[:, 0, 2]
    np.testing.assert_allclose(top, np.array(take_off.heights)[layer], atol=1e-6)
    end = stands.shape[1] - np.argmin(stands[:, ::-1], axis=1)
    high = places(track.breaks, track.coef, np.array([track.phases[-1].start]))[:, 0, 2]
    assert (np.diff(end[np.argsort(high)]) >= 0).all()
    assert [p.name for p in track.phases] == ["takeoff", "transit", "shot", "return", "land"]


def test_a_drone_that_rises_through_those_that_hover_is_found() -> None:
    ir = planned()
    (fleet,), (track,) = ir.keyframes.mission.fleets, ir.fleets
    layer = np.array(take_off_of(fleet).layer)
    late, first = int(np.argmax(layer)), int(np.argmin(layer))
    coef = track.coef.copy()
    up = int(np.searchsorted(track.breaks, track.phases[0].end))
    coef[late, : up + 3, 2] = track.coef[first, : up + 3, 2]
    found = judged(ir, replace(track, coef=coef))
    assert kinds(found) == ["separation in the air"]
    worst = found["separation in the air"]
    assert fleet.name + f"-{late + 1:02d}" in worst.drones
    assert worst.worst < 1.0


def test_who_hovers_low_over_its_pad_is_in_the_air() -> None:
    ir = planned()
    (track,) = ir.fleets
    coef = track.coef.copy()
    start = coef[:, 0]
    lifted = (coef == start[:, None]).all(axis=2)
    coef[..., 2] += 0.01 * lifted
    assert kinds(judged(ir, replace(track, coef=coef))) == ["separation in the air"]


def test_bodies_that_are_too_near_on_pads_are_found() -> None:
    ir = planned()
    found = judged(ir, ir.fleets[0], radius=0.28)
    assert kinds(found) == ["separation on pads"]
    assert found["separation on pads"].limit == pytest.approx(0.61)
    assert found["separation on pads"].worst == pytest.approx(0.6, abs=1e-5)


def test_pads_as_far_apart_as_the_separation_have_no_exception() -> None:
    ir = planned()
    found = judged(
        ir, ir.fleets[0], pads=tuple((3.0 * x, 3.0 * y, z) for x, y, z in ir.keyframes.mission.fleets[0].pads)
    )
    assert kinds(found) == ["separation"]
    assert found["separation"].worst == pytest.approx(0.6, abs=1e-5)


def test_uneven_pads_leave_more_between_layers() -> None:
    fleet = planned().keyframes.mission.fleets[0]
    flat = take_off_of(fleet)
    slope = take_off_of(fleet._replace(pads=tuple((x, y, 0.2 * x) for x, y, _ in fleet.pads)))
    assert slope.step - flat.step == pytest.approx(1.001 * 0.24, abs=1e-3)
    assert take_off_of(fleet._replace(pads=fleet.pads[:1])).heights == (6.0,)
