"""Legs of drones on the mission's clock that a refiner hands back: put back, judged, and accounted for."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from shotc.geom.bernstein import Piecewise, quintic_hermite
from shotc.ir.passes import Outcome, PassContext
from shotc.ir.path import CAM_PITCH, CAM_YAW, MovingLeg, PathIR, TimedPath, X, Y, Z, filmed
from shotc.passes.refine_path import RefinePath, Seat
from shotc.passes.refine_path.account import Account, account
from shotc.passes.refine_path.settle import same
from shotc.planning.clock.flights import flown_shot
from shotc.planning.path.rejoin import rejoined
from shotc.planning.path.with_camera import NoTransit
from shotc.planning.timing.timed_leg import leg_time
from tests.support.bad_refiners import Odd, accepting, convex_path

MISSION = """\
shotc: 1
mission: yard
targets: {mast: {at: [0, 0, 6], radius: 1, height: 12}}
drones:
  cam1: {model: x500, home: [0, -60, 0], priority: 1}
  cam2: {model: x500, home: [60, -60, 0], priority: 2}
rules: {composition: center, allow: [jump-cut]}
shots:
  - id: pass
    kind: keyframes
    drone: cam1
    target: mast
    keyframes: [{at: [-40, -30, 10], look_at: mast}, {at: [30, -25, 14], look_at: mast}]
  - {id: still, kind: static, drone: cam1, at: [30, 20, 10], look_at: mast, timing: {duration: 2}}
  - {id: round, kind: orbit, drone: cam2, target: mast, radius: 25, altitude: 12, start_azimuth: 90 deg,
     sweep: 60 deg, timing: {after: pass}}
"""
SEAT = Seat(Odd(Outcome), "odd-maker")
CAMERA = (X, Y, Z, CAM_YAW, CAM_PITCH)


def path(*optional: str) -> PathIR:
    return convex_path(accepting(MISSION, *optional))


def refine(act, *optional: str):
    return RefinePath(SEAT._replace(refiner=Odd(act))).run(path(*optional), PassContext())


def leg(ir: PathIR, shot: str) -> MovingLeg:
    found = filmed(ir, shot)
    assert isinstance(found, MovingLeg)
    return found


def camera(shot: str, ends: float = 0.0) -> Piecewise:
    """A shot's camera with another pitch throughout, rad."""
    curve = leg(path(), shot).curve
    ctrl = curve.ctrl[:, :, list(CAMERA)].copy()
    ctrl[:, :, 4] += ends
    return Piecewise(curve.breaks, ctrl)


def bumped(shot: str) -> Piecewise:
    """A shot's camera, some centimetres higher in the middle of its flight."""
    made = camera(shot)
    x = (made.breaks - made.start) / (made.end - made.start)
    swell = x**3 * (1 - x) ** 3
    slope = 3 * x**2 * (1 - x) ** 2 * (1 - 2 * x) / (made.end - made.start)
    orders = [made.derivative(k)(made.breaks) if k else made(made.breaks) for k in range(3)]
    orders[0][:, 2] += 4 * swell
    orders[1][:, 2] += 4 * slope
    return quintic_hermite(made.breaks, *orders)


def legs_of(ir: PathIR, drone: str):
    return next(flown.legs for flown in ir.timed if flown.drone == drone)


def with_legs(ir: PathIR, drone: str, act) -> PathIR:
    timed = (TimedPath(f.drone, tuple(map(act, f.legs))) if f.drone == drone else f for f in ir.timed)
    return replace(ir, timed=tuple(timed))


@pytest.mark.slow
def test_a_shot_put_back_keeps_its_time_and_its_neighbours():
    made = rejoined(path(), {"pass": bumped("pass")})
    drone = made.keyframes.mission.drone("cam1")
    old, new = leg(path(), "pass"), leg(made, "pass")
    assert not same(old, new)
    assert leg_time(drone, new) == pytest.approx(leg_time(drone, old), abs=1e-9)
    around = [a is b for a, b in zip(legs_of(path(), "cam1"), legs_of(made, "cam1"), strict=True)]
    assert around.count(False) == 1
    assert legs_of(made, "cam2") == legs_of(path(), "cam2")
    assert flown_shot(made, "round").start == pytest.approx(flown_shot(path(), "round").start, abs=1e-9)


@pytest.mark.slow
def test_where_a_shot_looks_elsewhere_at_its_ends_the_ways_beside_it_turn_in_their_time():
    made = rejoined(path(), {"pass": camera("pass", ends=-0.05)})
    drone = made.keyframes.mission.drone("cam1")
    made.check()
    changed = [
        (a, b) for a, b in zip(legs_of(path(), "cam1"), legs_of(made, "cam1"), strict=True) if a is not b
    ]
    assert [b.phase for _, b in changed] == ["transit", "shot", "transit"]
    for a, b in changed:
        assert leg_time(drone, b) == pytest.approx(leg_time(drone, a), abs=1e-9)
    outcome = refine(lambda ir: Outcome(made))
    assert outcome.value is not None, outcome.diagnostics


@pytest.mark.slow
def test_a_shot_that_takes_longer_than_its_convex_path_is_not_put_back():
    straight = camera("pass")
    winding = straight.ctrl.copy()
    turns = np.linspace(0.0, 60.0, winding[:, :, 3].size).reshape(winding[:, :, 3].shape)
    winding[:, :, 3] += turns - turns[0, 0]
    with pytest.raises(NoTransit, match=r"takes .* s at 0.9375 of the limits"):
        rejoined(path(), {"pass": Piecewise(straight.breaks, winding)})


@pytest.mark.slow
def test_a_refined_leg_that_takes_another_time_is_a_fault():
    def slower(one):
        return replace(one, duration=100.0) if one.shot == "pass" else one

    (told,) = refine(lambda ir: Outcome(with_legs(ir, "cam1", slower))).diagnostics
    assert told.code == "R005"
    assert "100.000000 s instead of" in " ".join(told.notes)


@pytest.mark.slow
def test_a_way_that_is_flown_elsewhere_is_a_fault():
    def higher(one):
        if one.phase != "transit":
            return one
        ctrl = one.curve.ctrl.copy()
        ctrl[len(ctrl) // 2, 2:4, 2] += 0.5
        return replace(one, curve=Piecewise(one.curve.breaks, ctrl))

    told = refine(lambda ir: Outcome(with_legs(ir, "cam1", higher))).diagnostics
    assert {d.code for d in told} == {"R005"}
    assert "changed the transit" in told[0].message


@pytest.mark.slow
def test_a_refined_leg_that_misses_its_keyframe_is_a_fault():
    curve = leg(path(), "pass").curve
    up = curve.ctrl.copy()
    up[:, :, 2] += 1.0

    def raised(one):
        return replace(one, curve=Piecewise(curve.breaks, up)) if one.shot == "pass" else one

    codes = {d.code for d in refine(lambda ir: Outcome(with_legs(ir, "cam1", raised))).diagnostics}
    assert {"R002", "R007"} <= codes


@pytest.mark.slow
def test_a_spoilt_shot_that_may_is_flown_convex_and_the_others_stay_refined():
    made = rejoined(path(), {"pass": bumped("pass"), "round": bumped("round")})

    def slower(one):
        return replace(one, duration=100.0) if one.shot == "pass" else one

    outcome = refine(
        lambda ir: Outcome(replace(with_legs(made, "cam1", slower), keyframes=ir.keyframes)), "pass"
    )
    assert [d.code for d in outcome.diagnostics] == ["R003"]
    before = path("pass")
    assert same(filmed(before, "pass"), filmed(outcome.value, "pass"))
    assert not same(filmed(before, "round"), filmed(outcome.value, "round"))
    told = dict(account(SEAT, (before, outcome.value), outcome.diagnostics).entries)
    assert told["round.refined"] == "yes"
    assert "none that can be flown" in str(told["pass.refined"])


def test_a_refiner_that_knows_nothing_of_the_clock_is_told_of_once_a_shot():
    told = account(SEAT, (path(), replace(path())), ())
    assert [d.code for d in told.warnings] == ["R014", "R014"]
    assert [d.message.split("`")[1] for d in told.warnings] == ["pass", "round"]
    assert all("refiner `odd` of package odd-maker left it" in d.message for d in told.warnings)
    assert dict(told.entries)["still.refined"] == "its camera stands still"
    again = account(SEAT, (path(), replace(path())), told.warnings)
    assert again.warnings == ()
    assert again.entries == told.entries


def test_where_nobody_was_to_refine_nothing_is_told():
    assert account(Seat(), (path(), path()), ()) == Account()
