"""One test for one term of the proof: what it protects a flight from, and that it refuses nothing else."""

from __future__ import annotations

import numpy as np
import pytest

from shotc.geom.bernstein import quintic_hermite
from shotc.geom.shapes import CylinderShape
from shotc.geom.solids import Cylinder, Prism
from shotc.geom.track import Track
from shotc.ir.limits import Timing
from shotc.ir.phases import Phase
from shotc.ir.promise import Promise
from shotc.ir.target import Target
from shotc.ir.trajectory import Claim, TrajectoryIR
from tests.support.records import replace
from tests.support.tampered_plans import (
    MISSION,
    PLAN,
    with_ctrl,
    with_keyframe,
    with_mission,
    with_shot,
    with_track,
    zone,
)
from tests.support.verdicts import claim, codes, verdict_on

pytestmark = pytest.mark.slow


def found(ir: TrajectoryIR, constraint: str) -> Claim:
    return next(c for c in verdict_on(ir).certificate if c.constraint == constraint)


@pytest.mark.parametrize("end", [0, -1])
def test_a_drone_does_not_jerk_off_its_pad_nor_onto_it(end: int) -> None:
    # It is at home and at rest, but its acceleration is not: 20 / h^2 of what the third control point is off.
    piece = (0, 2, 2) if end == 0 else (-1, -3, 2)
    breaks = PLAN.drones[0].curve.breaks
    width = breaks[1] - breaks[0] if end == 0 else breaks[-1] - breaks[-2]
    ir = with_ctrl(lambda c: c.__setitem__(piece, c[piece] + 1e-3))
    rest = claim(ir, "rate at start and end")
    assert rest.worst == pytest.approx(20 * 1e-3 / width**2)
    assert "V012" in codes(ir)


def beside(near: float, low: float, high: float) -> TrajectoryIR:
    """A wall beside the pad at (0, -60, 0), ``near`` metres from its middle, between two heights."""
    wall = Prism(((near, -64.0), (near + 4.0, -64.0), (near + 4.0, -56.0), (near, -56.0)), low, high)
    return with_mission(zones=zone("out", wall))


@pytest.mark.parametrize(
    ("ir", "limit", "worst"),
    [
        # Radius 0.6 m. A wall from the ground: the body may stand as near as its pad does, and does.
        (beside(0.4, 0.0, 5.0), -0.2, -0.2),
        # A wall over the head, the pad is free of it: the body has to be, too.
        (beside(0.4, 3.0, 5.0), 0.0, -0.2),
        # Its lower edge is 0.5 m from the pad, and the way up passes at 0.3 m.
        (beside(0.3, 0.4, 5.0), -0.1, -0.3),
        (beside(0.61, 3.0, 5.0), 0.0, 0.01),
    ],
)
def test_a_body_rises_no_nearer_to_a_solid_than_it_stands(
    ir: TrajectoryIR, limit: float, worst: float
) -> None:
    home = claim(ir, "zone extra at home")
    assert (home.limit, home.worst) == (pytest.approx(limit), pytest.approx(worst, abs=1e-5))
    assert home.holds is (worst >= limit - 1e-6)


@pytest.mark.parametrize("index", [0, 4])
def test_a_reference_ends_and_begins_where_its_keyframes_want_it(index: int) -> None:
    # It stays in the middle, which is on the line between the two places, but not at its end.
    ir = with_keyframe(index, reference=(0.1, 0.0))
    off = claim(ir, "reference off its keyframes")
    assert off.worst == pytest.approx(0.1)
    assert off.time == pytest.approx(22.0 if index == 0 else 52.0)


def test_a_reference_goes_no_farther_than_to_the_next_keyframe_s() -> None:
    # Along the line from (0, 0) to (0.1, 0), but on to (0.3, 0) and back.
    t = np.array([22.0, 44.5, 48.0, 52.0])
    u = np.array([[0.0, 0.0], [0.0, 0.0], [0.3, 0.0], [0.1, 0.0]])
    wanted = quintic_hermite(t, u, np.zeros((4, 2)), np.zeros((4, 2)))
    framing = replace(PLAN.drones[0].framing[0], reference=wanted)
    ir = with_track(with_keyframe(4, reference=(0.1, 0.0)), framing=(framing,))
    off = claim(ir, "reference off its keyframes")
    assert off.worst == pytest.approx(0.2, abs=1e-4)
    assert off.time == pytest.approx(48.0)


def test_a_target_is_framed_between_all_its_keyframes() -> None:
    # Between the last two it is not, in 375 frames at 50 Hz.
    framing = replace(PLAN.drones[0].framing[0], end=44.5)
    missing = claim(with_track(framing=(framing,)), "frames without their target")
    assert missing.worst == pytest.approx(375, abs=1)
    assert not missing.holds


def test_a_shot_that_promises_nothing_has_to_frame_its_target_too() -> None:
    """Else it could point its framing elsewhere, and nobody would know that its own target is hidden."""
    elsewhere = replace(PLAN.drones[0].framing[0], target="elsewhere")
    ir = with_shot(promise=Promise())
    flight = replace(ir.drones[0], framing=(elsewhere,))
    other = replace(MISSION.targets[0], name="elsewhere", path=("targets", "elsewhere"))
    keyframes = replace(
        ir.keyframes, mission=replace(ir.keyframes.mission, targets=(*MISSION.targets, other))
    )
    ir = replace(ir, drones=(flight,), keyframes=keyframes)
    assert claim(with_shot(promise=Promise()), "frames without their target").holds
    assert not claim(ir, "frames without their target").holds
    assert "V024" in codes(ir)


def waiting(end: float) -> TrajectoryIR:
    """The shot of the plan waits for one of another drone, which ends at a time."""
    first = replace(MISSION.drones[0], name="cam2", home=(20.0, -60.0, 0.0), path=("drones", "cam2"))
    shift = np.array([20.0, 0, 0, 0, 0, 0, 0])
    track = PLAN.drones[0]
    phases = (Phase("takeoff", None, 0.0, 8.0), Phase("shot", "first", 8.0, end))
    phases = (*phases, Phase("return", None, end, 112.0), track.phases[-1])
    curve = replace(track.curve, ctrl=track.curve.ctrl + shift)
    other = replace(track, drone="cam2", curve=curve, phases=phases, keyframes=(), framing=())
    shots = (
        replace(MISSION.shots[0], timing=Timing(after="first")),
        replace(MISSION.shots[0], id="first", drone="cam2", path=("shots", 1)),
    )
    both = with_mission(drones=(*MISSION.drones, first), shots=shots)
    return replace(both, drones=(*both.drones, other))


@pytest.mark.parametrize(("end", "early"), [(15.0, -7.0), (22.0005, 0.0005), (22.01, 0.01), (60.0, 38.0)])
def test_a_shot_waits_for_the_one_it_comes_after(end: float, early: float) -> None:
    start = found(waiting(end), "start too early")
    assert start.worst == pytest.approx(early)
    assert start.holds is (early <= 1e-3)
    assert start.path == ("shots", 0, "timing", "after")


@pytest.mark.parametrize(
    ("start", "velocity", "broken"),
    [
        (
            (40.0, -74.0, 20.0),
            (0.0, 2.0, 0.0),
            True,
        ),  # it walks into the orbit, at t = 37 s
        ((40.0, 0.0, 20.0), (0.0, 5.0, 0.0), False),  # it stood there, and has left long since
    ],
)
def test_a_target_that_walks_on_for_ever_is_where_it_has_come_to(
    start: tuple[float, float, float], velocity: tuple[float, float, float], broken: bool
) -> None:
    ghost = Target(
        "ghost", start, CylinderShape(0.5, 1.0), ("targets", "ghost"), Track((0.0,), (start,), after=velocity)
    )
    ir = with_mission(targets=(*MISSION.targets, ghost))
    assert claim(ir, "target ghost").holds is not broken
    assert ("V010" in codes(ir)) is broken


@pytest.mark.parametrize(("by", "holds"), [(-0.5, False), (0.5, False), (0.0, True)])
def test_a_start_and_a_duration_are_met_from_both_sides(by: float, holds: bool) -> None:
    assert claim(with_shot(timing=Timing(start=22.0 + by)), "error of start").holds is holds
    assert claim(with_shot(timing=Timing(duration=30.0 + by)), "error of duration").holds is holds


@pytest.mark.parametrize(("by", "holds"), [(-0.5, False), (0.5, False), (0.0, True)])
def test_a_keyframe_s_time_counts_from_its_shot_and_is_met_from_both_sides(by: float, holds: bool) -> None:
    asked = PLAN.drones[0].keyframes[2].time - 22.0 + by
    assert claim(with_keyframe(2, time=asked), "delay of keyframes").holds is holds


def test_a_keyframe_met_outside_its_shot_is_not_met() -> None:
    # The drone comes by the first keyframe's place at the end of its transit, before its film begins.
    times = tuple(replace(k, time=21.9) if k.index == 0 else k for k in PLAN.drones[0].keyframes)
    assert claim(with_track(keyframes=times), "distance from keyframes").worst == float("inf")


@pytest.mark.parametrize(("time", "hold"), [(21.9, 0.05), (51.95, 0.1)])
def test_a_hold_lies_within_its_shot(time: float, hold: float) -> None:
    times = tuple(replace(k, time=time) if k.index == 0 else k for k in PLAN.drones[0].keyframes)
    held = with_track(with_keyframe(0, hold=hold), keyframes=times)
    assert claim(held, "drift at keyframe 1").worst == float("inf")


@pytest.mark.parametrize("axis", [0, 1])
def test_take_off_does_not_drift_in_any_direction(axis: int) -> None:
    ir = with_ctrl(lambda c: c.__setitem__((0, 3, axis), c[0, 3, axis] + 2e-5))
    assert not claim(ir, "drift from the vertical").holds
    assert "V017" in codes(ir)


def test_take_off_does_not_sink_below_the_pad() -> None:
    sunk = with_ctrl(lambda c: c.__setitem__((0, slice(2, 4), 2), -1.0))
    below = claim(sunk, "depth below home")
    assert 0.05 < below.worst < 1.0
    assert not below.holds


def test_a_keep_in_zone_has_a_ceiling_and_walls_for_take_off_too() -> None:
    around = Cylinder((0.0, 0.0), 62.0, -100.0, 19.0)
    assert not claim(with_mission(zones=zone("in", around)), "zone extra").holds
    near = Cylinder((0.0, 0.0), 60.1, -100.0, 60.0)  # the pad is 0.1 m from its wall, the body reaches 0.6 m
    assert claim(with_mission(zones=zone("in", near)), "zone extra").worst == pytest.approx(-0.5, abs=1e-4)


def test_speed_is_the_horizontal_one() -> None:
    # Where it climbs and flies at once both are below their limits, and so is the plan.
    curve = PLAN.drones[0].curve
    rate = curve.derivative()(np.linspace(8.0, 22.0, 1001))
    assert claim(PLAN, "speed").worst == pytest.approx(
        np.linalg.norm(curve.derivative()(np.linspace(0.0, 122.0, 20_001))[:, :2], axis=1).max(), rel=1e-3
    )
    assert np.linalg.norm(rate[:, :3], axis=1).max() > np.linalg.norm(rate[:, :2], axis=1).max()


@pytest.mark.parametrize("by", [2e-3, 0.05])
def test_a_flight_begins_on_its_pad_to_the_millimetre(by: float) -> None:
    x, y, z = MISSION.drones[0].home
    moved = with_mission(drones=(replace(MISSION.drones[0], home=(x, y, z - by)),))
    assert not claim(moved, "distance from home").holds
