"""Limits met to the millimetre, and odd plans that are sound: holds, roofs, whole turns."""

from math import pi, radians

import numpy as np
import pytest

from shotc.geom.bernstein import Piecewise, concatenate, quintic_hermite
from shotc.geom.solids import Cylinder
from shotc.ir.limits import Timing
from shotc.ir.mission import Zone
from shotc.ir.path import CAM_PITCH, CAM_YAW
from shotc.ir.trajectory import DroneTrajectory, TrajectoryIR
from tests.support.records import replace
from tests.support.tampered_plans import (
    MISSION,
    PLAN,
    shifted,
    with_gimbal,
    with_keyframe,
    with_mission,
    with_track,
    zone,
)
from tests.support.verdicts import claim, codes, verdict_on


def test_a_spike_between_samples_is_caught() -> None:
    # Two milliseconds of acceleration at 3.5 m/s^2, between two samples at 50 Hz.
    track = PLAN.drones[0]
    curve = track.curve
    k = int(np.searchsorted(curve.breaks, 100.0)) - 1  # inside the return
    low, high = curve.breaks[k], curve.breaks[k + 1]
    breaks = np.array([low, 100.007, 100.008, 100.009, high])
    value, rate, bend = (curve.derivative(n)(breaks) if n else curve(breaks) for n in range(3))
    bend[2, 0] += 3.5
    piece = quintic_hermite(breaks, value, rate, bend)
    parts = [Piecewise(curve.breaks[: k + 1], curve.ctrl[:k]), piece]
    if k + 2 < len(curve.breaks):
        parts.append(Piecewise(curve.breaks[k + 1 :], curve.ctrl[k + 1 :]))
    spiked = with_track(curve=concatenate(parts))
    ticks = np.arange(0, 122 * 50) / 50
    assert np.linalg.norm(spiked.drones[0].curve.derivative(2)(ticks)[:, :3], axis=1).max() < 2.0
    assert "V002" in codes(spiked)
    assert claim(spiked, "acceleration").time == pytest.approx(100.008, abs=5e-4)


@pytest.mark.parametrize(("gap", "broken"), [(0.6 + 1e-3, False), (0.6 - 1e-3, True), (0.6 + 1e-9, False)])
def test_a_zone_is_grazed_to_the_millimetre(gap: float, broken: bool) -> None:
    # The orbit passes (40, 0); a cylinder outside of it stands `gap` away at the nearest.
    ir = with_mission(zones=zone("out", Cylinder((44.0 + gap, 0.0), 4.0, 10.0, 30.0)))
    found = claim(ir, "zone extra")
    assert found.holds is not broken
    assert found.worst == pytest.approx(gap - 0.6, abs=2e-6)
    assert found.position == pytest.approx((40.0, 0.0, 20.0), abs=0.1)


@pytest.mark.slow
def test_a_hold_that_stands_still_is_met() -> None:
    curve = PLAN.drones[0].curve
    still = curve(52.0)
    pause = Piecewise(np.array([52.0, 54.0]), np.repeat(still[None, None], 6, axis=1))
    late = Piecewise(curve.breaks[122:] + 2.0, curve.ctrl[122:])
    assert curve.breaks[122] == 52.0
    joined = concatenate([Piecewise(curve.breaks[:123], curve.ctrl[:122]), pause, late])
    phases = [
        replace(p, start=p.start + 2 * (p.start >= 52), end=p.end + 2 * (p.end >= 52))
        for p in PLAN.drones[0].phases
    ]
    held = with_keyframe(4, hold=2.0)
    (framing,) = PLAN.drones[0].framing
    stands = replace(framing, start=52.0, end=54.0, reference=None)
    held = with_track(held, curve=joined, phases=tuple(phases), framing=(framing, stands))
    timing = replace(MISSION.shots[0], timing=Timing(duration=32.0))
    held = with_mission(held, shots=(timing,))
    assert codes(held) == []
    assert claim(held, "drift at keyframe 5").holds
    assert "V016" in codes(with_mission(with_track(held, curve=joined, keyframes=tuple(
        replace(k, time=k.time - 0.5 * (k.index == 4)) for k in PLAN.drones[0].keyframes
    )), shots=(timing,)))  # fmt: skip


def other_drone(ir: TrajectoryIR, offset: tuple[float, float, float]) -> TrajectoryIR:
    """A second drone that flies the same, `offset` away, and films nothing."""
    mission = ir.keyframes.mission
    track = ir.drones[0]
    shift = np.zeros(7)
    shift[:3] = offset
    home = tuple(float(a + b) for a, b in zip(mission.drones[0].home, offset, strict=True))
    drone = replace(mission.drones[0], name="cam2", home=home, path=("drones", "cam2"))
    phases = tuple(replace(p, name="transit" if p.shot else p.name, shot=None) for p in track.phases)
    second = DroneTrajectory("cam2", Piecewise(track.curve.breaks, track.curve.ctrl + shift), phases, (), ())
    both = replace(ir, drones=(*ir.drones, second))
    return with_mission(both, drones=(*mission.drones, drone))


@pytest.mark.slow
@pytest.mark.parametrize(("apart", "broken"), [(3.01, False), (2.99, True)])
def test_separation_of_two_drones(apart: float, broken: bool) -> None:
    verdict = verdict_on(other_drone(PLAN, (0.0, 0.0, 0.0 + apart)))
    found = next(c for c in verdict.certificate if c.constraint == "separation from cam2")
    assert found.worst == pytest.approx(apart, abs=1e-4)
    assert ("V022" in {d.code for d in verdict.diagnostics}) is broken


def test_a_roof_is_a_home() -> None:
    roof = Zone("roof", "out", Cylinder((0.0, -60.0), 5.0, -4.0, 0.0), ("world", "zones", "roof"))
    ir = with_mission(zones=(*MISSION.zones, roof))
    assert codes(ir) == []
    # The pad touches it; flying there stays as near as that, and no nearer.
    assert claim(ir, "zone roof at home").worst == pytest.approx(-0.6)


def test_a_gimbal_that_begins_whole_turns_away_is_in_range() -> None:
    ir = shifted(CAM_YAW, 4 * pi)
    assert claim(ir, "gimbal yaw max").holds
    assert codes(ir) == []


def test_a_still_shot_stands_still() -> None:
    one = replace(PLAN.keyframes.shots[0], keyframes=PLAN.keyframes.shots[0].keyframes[:1])
    ir = replace(PLAN, keyframes=replace(PLAN.keyframes, shots=(one,)))
    assert "V016" in codes(ir)
    assert claim(ir, "drift at keyframe 1").worst > 10


def test_the_gap_of_a_pitch_limit_is_closed_to_a_microradian() -> None:
    lowest = float(PLAN.drones[0].curve.ctrl[..., CAM_PITCH].min())
    margins = {1e-5: True, -1e-5: False}
    for margin, holds in margins.items():
        ir = with_gimbal(pitch=(lowest - margin, radians(30)))
        assert claim(ir, "gimbal pitch min").holds is holds
