"""Every way to break a sound plan is found, named by its code, and placed on its line and in time."""

import re
from collections.abc import Callable
from math import inf, nan, pi, radians

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from shotc.diag.model import Diagnostic
from shotc.diag.registry import registry
from shotc.geom.bernstein import Piecewise, concatenate, quintic_hermite
from shotc.geom.solids import Cylinder, Prism, box
from shotc.ir.mission import MissionIR, Promise, Target, Timing, Zone
from shotc.ir.origin import OriginMap
from shotc.ir.path import CAM_PITCH, CAM_YAW, HFOV, Deviation
from shotc.ir.trajectory import Claim, DroneTrajectory, TrajectoryIR
from shotc.passes.base import PassContext
from shotc.passes.verify import Verify, judge
from shotc.passes.verify.numbers import enough, measure
from shotc.passes.verify.report import rule_of
from shotc.source.file import Span
from tests.records import replace
from tests.samples import orbit_plan

PLAN = orbit_plan().trajectory
CONTEXT = PassContext()
MISSION = PLAN.keyframes.mission


def codes(ir: TrajectoryIR) -> list[str]:
    return sorted({d.code for d in judge(ir, CONTEXT).diagnostics})


def claim(ir: TrajectoryIR, constraint: str) -> Claim:
    return next(c for c in judge(ir, CONTEXT).certificate if c.constraint == constraint)


def with_track(ir: TrajectoryIR = PLAN, **changes: object) -> TrajectoryIR:
    return replace(ir, drones=(replace(ir.drones[0], **changes),))


def with_ctrl(edit: Callable[[np.ndarray], None]) -> TrajectoryIR:
    curve = PLAN.drones[0].curve
    ctrl = curve.ctrl.copy()
    edit(ctrl)
    return with_track(curve=Piecewise(curve.breaks, ctrl))


def with_mission(ir: TrajectoryIR = PLAN, **changes: object) -> TrajectoryIR:
    mission: MissionIR = replace(ir.keyframes.mission, **changes)
    shots = tuple(
        replace(p, shot=next(s for s in mission.shots if s.id == p.shot.id)) for p in ir.keyframes.shots
    )
    return replace(ir, keyframes=replace(ir.keyframes, mission=mission, shots=shots))


def with_drone(**changes: object) -> TrajectoryIR:
    return with_mission(drones=(replace(MISSION.drones[0], **changes),))


def with_limits(**changes: float) -> TrajectoryIR:
    return with_drone(limits=replace(MISSION.drones[0].limits, **changes))


def with_gimbal(**changes: object) -> TrajectoryIR:
    return with_drone(gimbal=replace(MISSION.drones[0].gimbal, **changes))


def with_shot(**changes: object) -> TrajectoryIR:
    return with_mission(shots=(replace(MISSION.shots[0], **changes),))


def with_keyframe(index: int, **changes: object) -> TrajectoryIR:
    placed = PLAN.keyframes.shots[0]
    keyframes = list(placed.keyframes)
    keyframes[index] = replace(keyframes[index], **changes)
    return replace(
        PLAN, keyframes=replace(PLAN.keyframes, shots=(replace(placed, keyframes=tuple(keyframes)),))
    )


def with_phase(index: int, **changes: object) -> TrajectoryIR:
    phases = list(PLAN.drones[0].phases)
    phases[index] = replace(phases[index], **changes)
    return with_track(phases=tuple(phases))


def zone(keep: str, solid: object) -> tuple[Zone, ...]:
    return (*MISSION.zones, Zone("extra", keep, solid, ("world", "zones", "extra")))  # type: ignore[arg-type]


def test_a_sound_plan_is_verified_with_every_claim() -> None:
    outcome = Verify().run(PLAN, CONTEXT)
    assert outcome.diagnostics == ()
    assert outcome.value is not None
    names = {c.constraint for c in outcome.value.certificate}
    assert names >= {
        "speed", "climb", "descent", "acceleration", "jerk", "body yaw rate", "body yaw acceleration",
        "gimbal pitch min", "gimbal pitch max", "gimbal yaw min", "gimbal yaw max", "gimbal pitch rate",
        "gimbal yaw acceleration", "zone tree", "zone field", "ground clearance", "target tower",
        "jump of acceleration", "distance from home", "endurance", "tower in frame", "tower screen error",
    }  # fmt: skip
    assert all(c.holds for c in outcome.value.certificate)
    assert {c.method for c in outcome.value.certificate} == {"exact", "bounded", "sampled"}


def test_every_constraint_has_a_registered_code() -> None:
    for c in judge(PLAN, CONTEXT).certificate:
        if c.hard:
            assert rule_of(c.constraint, MISSION).code in registry()


def test_known_values() -> None:
    # Half a circle of radius 40 m in 30 s, eased by a quintic: the fastest instant is 15/8 of the mean.
    assert claim(PLAN, "speed").worst == pytest.approx(40 * pi / 30 * 15 / 8, rel=1e-3)
    assert claim(PLAN, "climb").worst == pytest.approx(14 / 14 * 15 / 8, rel=1e-3)
    assert claim(PLAN, "zone field").worst == pytest.approx(6.0 - 2.0 - 0.6, abs=1e-5)
    assert claim(PLAN, "ground clearance").worst == pytest.approx(5.4, abs=1e-5)
    assert claim(PLAN, "endurance").worst == 122.0
    assert claim(PLAN, "tower in frame").method == "bounded"


CURVE = PLAN.drones[0].curve
FRAMING = PLAN.drones[0].framing[0]

TAMPERED: list[tuple[str, TrajectoryIR, set[str]]] = [
    ("speed limit", with_limits(speed=7.8), {"V001"}),
    ("climb limit", with_limits(climb=1.8), {"V001"}),
    ("descent limit", with_limits(descent=1.1), {"V001"}),
    ("acceleration limit", with_limits(acceleration=1.5), {"V002"}),
    ("jerk limit", with_limits(jerk=0.5), {"V003"}),
    ("yaw rate limit", with_limits(yaw_rate=radians(10)), {"V004"}),
    ("yaw acceleration limit", with_limits(yaw_acceleration=radians(1)), {"V004"}),
    ("gimbal pitch range", with_gimbal(pitch=(radians(-11), radians(30))), {"V005"}),
    ("gimbal yaw range", with_gimbal(yaw=(radians(1), radians(20))), {"V005"}),
    ("gimbal rate", with_gimbal(rate=radians(1)), {"V006"}),
    ("gimbal acceleration", with_gimbal(acceleration=radians(0.2)), {"V006"}),
    ("zone in the way", with_mission(zones=zone("out", Cylinder((40.0, 0.0), 2.0, 0.0, 30.0))), {"V007"}),
    ("zone at home", with_mission(zones=zone("out", box((0, -60, 3), (1, 1, 2), 0))), {"V007"}),
    ("zone left", with_mission(zones=zone("in", Prism(((-50, -70), (50, -70), (50, 70), (-50, 70)), 0, 60))),
     {"V008"}),
    ("ground clearance", with_mission(rules=replace(MISSION.rules, ground_clearance=5.5)), {"V009"}),
    ("target clearance", with_mission(rules=replace(MISSION.rules, target_clearance=29.0)), {"V010"}),
    ("second target", with_mission(
        targets=(*MISSION.targets, Target("mast", (40.0, 0.0, 10.0), 1.0, 20.0, ("targets", "mast")))),
     {"V010"}),
    ("control point", with_ctrl(lambda c: c.__setitem__((40, 3, 0), c[40, 3, 0] + 0.05)), {"V003", "V011"}),
    ("home", with_drone(home=(0.0, -60.5, 0.0)), {"V012", "V017"}),
    ("start not at rest", with_ctrl(lambda c: c.__setitem__((0, 1, 2), 0.001)), {"V012"}),
    ("endurance", with_drone(endurance=121.0), {"V013"}),
    ("phase gap", with_phase(1, end=21.0), {"V014"}),
    ("phase backwards", with_phase(3, end=51.0), {"V014"}),
    ("phase without end", with_phase(4, end=nan), {"V014"}),
    ("unknown shot", with_phase(2, shot="other"), {"V014"}),
    ("no phases", with_track(phases=()), {"V014"}),
    ("unknown drone", with_track(drone="cam9"), {"V014"}),
    ("huge control point", with_ctrl(lambda c: c.__setitem__((5, 2, 1), 1e300)), {"V014"}),
    ("nanosecond piece", with_track(curve=Piecewise(
        np.insert(CURVE.breaks, 1, 1e-9), np.insert(CURVE.ctrl, 0, 0.0, axis=0))), {"V014"}),
    ("five channels", with_track(curve=PLAN.drones[0].curve.channels(0, 1, 2, 3, 4)), {"V014"}),
    ("duration", with_shot(timing=Timing(duration=29.0)), {"V015"}),
    ("start", with_shot(timing=Timing(start=21.0)), {"V015"}),
    ("not flown", replace(PLAN, drones=()), {"V015"}),
    ("keyframe moved", with_keyframe(2, at=(40.0, 0.01, 20.0)), {"V016"}),
    ("keyframe time asked", with_keyframe(2, time=15.5), {"V016"}),
    ("hold asked", with_keyframe(2, hold=2.0), {"V016"}),
    ("keyframe not reached", with_track(keyframes=PLAN.drones[0].keyframes[:-1]), {"V016"}),
    ("field of view", with_ctrl(lambda c: c.__setitem__((..., HFOV), radians(175))), {"V018"}),
    ("promised size", with_shot(promise=Promise(size=(0.82, 0.9))), {"V021"}),
    ("promised small size", with_shot(promise=Promise(size=(0.2, 0.8))), {"V021"}),
    ("framing removed", with_track(framing=()), {"V024"}),
    ("framing shortened", with_track(framing=(replace(FRAMING, start=30.0, end=40.0),)), {"V024"}),
    ("reference moved", with_track(framing=(replace(FRAMING, reference=Piecewise(
        FRAMING.reference.breaks, FRAMING.reference.ctrl + 0.02)),)), {"V024"}),
    ("reference removed", with_track(framing=(replace(FRAMING, reference=None),)), {"V024"}),
]  # fmt: skip


@pytest.mark.parametrize(("tampered", "expected"), [t[1:] for t in TAMPERED], ids=[t[0] for t in TAMPERED])
def test_tampering_is_found(tampered: TrajectoryIR, expected: set[str]) -> None:
    verdict = judge(tampered, CONTEXT)
    assert expected <= {d.code for d in verdict.diagnostics}
    assert Verify().run(tampered, CONTEXT).value is None
    for d in verdict.diagnostics:
        assert d.code in registry()
        assert d.message[0].islower()
        assert not d.message.endswith(".")
        assert "nan" not in d.message + " ".join(d.notes) + d.help
        assert d.help


@pytest.mark.parametrize(
    ("tampered", "expected"), [t[1:] for t in TAMPERED if t[0].endswith(("limit", "range"))]
)
def test_one_limit_breaks_one_code(tampered: TrajectoryIR, expected: set[str]) -> None:
    assert set(codes(tampered)) == expected


def shifted(channel: int, by: float) -> TrajectoryIR:
    return with_ctrl(lambda c: c.__setitem__((..., channel), c[..., channel] + by))


def test_framing_promises() -> None:
    aside = shifted(CAM_YAW, radians(32))
    assert {"V019", "V020"} <= set(codes(aside))
    away = shifted(CAM_YAW, pi * 0.9)
    found = {d.code: d for d in judge(away, CONTEXT).diagnostics}
    assert "behind the camera" in found["V020"].message


def swaying(size: float) -> TrajectoryIR:
    """The camera sways once a second while it films: by nothing at whole seconds."""
    track = PLAN.drones[0]
    t = np.concatenate([[0.0, 8.0], np.linspace(22, 52, 241), [82.0, 112.0, 122.0]])
    value, rate, bend = (track.curve.derivative(n)(t) if n else track.curve(t) for n in range(3))
    rest = ~((t >= 22) & (t <= 52))
    rate[rest], bend[rest] = 0.0, 0.0
    filmed = (t > 22) & (t < 52)
    phase = 2 * pi * t[filmed]
    value[filmed, CAM_YAW] += size * np.sin(phase) ** 2
    rate[filmed, CAM_YAW] += size * 2 * pi * np.sin(2 * phase)
    bend[filmed, CAM_YAW] += size * 8 * pi**2 * np.cos(2 * phase)
    return with_track(curve=quintic_hermite(t, value, rate, bend))


@pytest.mark.parametrize(("size", "method"), [(0.01, "bounded"), (0.1, "sampled")])
def test_between_samples_a_promise_is_proved_or_only_sampled(size: float, method: str) -> None:
    shot = replace(MISSION.shots[0], promise=Promise(screen_error=0.05))
    ir = with_mission(swaying(size), rate=1.0, shots=(shot,))
    error = claim(ir, "tower screen error")
    assert error.worst < 0.003  # samples see nothing of it
    assert error.method == method
    seen = claim(with_mission(ir, rate=7.0), "tower screen error").worst
    assert (seen > 0.05) is (method == "sampled")


def test_whole_in_frame_between_samples() -> None:
    for size, method in ((0.1, "bounded"), (0.6, "sampled")):
        found = claim(with_mission(swaying(size), rate=1.0), "tower in frame")
        assert found.worst == 1.0
        assert found.method == method


def test_without_promises_losses_are_warnings() -> None:
    ir = with_mission(shifted(CAM_YAW, radians(32)), shots=(replace(MISSION.shots[0], promise=Promise()),))
    outcome = Verify().run(ir, CONTEXT)
    assert [d.code for d in outcome.diagnostics] == ["V030"]
    assert outcome.value is not None
    soft = [c for c in outcome.value.certificate if not c.hard]
    assert {c.constraint for c in soft if not c.holds} == {"tower in frame"}
    assert "worst at t = " in outcome.diagnostics[0].notes[0]


def test_a_hidden_target_is_a_warning() -> None:
    screen = Zone("screen", "out", box((30.0, 0.0, 10), (1, 4, 20), 0), ("world", "zones", "screen"))
    ir = with_mission(zones=(*MISSION.zones, screen))
    assert codes(ir) == ["V031"]
    share = claim(ir, "tower visible")
    assert 0.9 < share.worst < 1.0
    assert share.time is not None
    assert PLAN.drones[0].curve(share.time)[0] > 39  # it hides it from the east only


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


def test_a_diagnostic_points_at_the_limit_and_the_shot() -> None:
    limit, shot = Span(12, 20, 12, 25), Span(30, 5, 30, 20)
    origins = OriginMap(
        "half-orbit.yaml",
        {("shots", 0): shot},
        {("drones", "cam1", "limits", "speed"): limit},
    )
    ir = with_mission(with_limits(speed=7.0), origins=origins)
    (found,) = judge(ir, CONTEXT).diagnostics
    assert [label.span for label in found.labels] == [limit, shot]
    assert "7.854 m/s" in found.message
    assert "7 m/s" in found.message
    assert "t = 37.000 s" in found.notes[0]
    assert "15.000 s into shot `half`" in found.notes[0]
    # 30 s x 7.854 / 7: and at that duration the limit holds.
    assert "33.7 s" in found.help


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
    held = with_track(held, curve=joined, phases=tuple(phases))
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


@pytest.mark.parametrize(("apart", "broken"), [(3.01, False), (2.99, True)])
def test_separation_of_two_drones(apart: float, broken: bool) -> None:
    verdict = judge(other_drone(PLAN, (0.0, 0.0, 0.0 + apart)), CONTEXT)
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


def test_the_verdict_is_the_same_twice() -> None:
    assert judge(PLAN, CONTEXT) == judge(orbit_plan().trajectory, CONTEXT)


def test_a_still_shot_stands_still() -> None:
    one = replace(PLAN.keyframes.shots[0], keyframes=PLAN.keyframes.shots[0].keyframes[:1])
    ir = replace(PLAN, keyframes=replace(PLAN.keyframes, shots=(one,)))
    assert "V016" in codes(ir)
    assert claim(ir, "drift at keyframe 1").worst > 10


def test_missing_values_are_told_without_numbers() -> None:
    ir = with_track(keyframes=())
    (found,) = (d for d in judge(ir, CONTEXT).diagnostics if d.code == "V016")
    assert isinstance(found, Diagnostic)
    assert "inf" not in found.message
    assert claim(ir, "distance from keyframes").worst == inf


def test_the_gap_of_a_pitch_limit_is_closed_to_a_microradian() -> None:
    lowest = float(PLAN.drones[0].curve.ctrl[..., CAM_PITCH].min())
    margins = {1e-5: True, -1e-5: False}
    for margin, holds in margins.items():
        ir = with_gimbal(pitch=(lowest - margin, radians(30)))
        assert claim(ir, "gimbal pitch min").holds is holds


@given(st.floats(1e-9, 1e6), st.booleans(), st.sampled_from(["m/s", "rad", "of samples", "m"]))
def test_a_proposed_limit_is_one_that_holds(worst: float, upper: bool, unit: str) -> None:
    some = claim(PLAN, "speed")
    proposed = float(enough(replace(some, worst=worst, upper=upper, unit=unit)).split()[0])
    read = worst * {"rad": 180 / pi, "of samples": 100.0}.get(unit, 1.0)
    assert proposed >= read * (1 - 1e-9) if upper else proposed <= read * (1 + 1e-9)
    assert proposed == pytest.approx(read, rel=2e-3)


def test_the_help_makes_the_plan_hold() -> None:
    (found,) = judge(with_limits(speed=7.0), CONTEXT).diagnostics
    assert "raise `limits.speed` to 7.855 m/s" in found.help
    assert codes(with_limits(speed=7.855)) == []
    assert measure(0.0, "m") == "0 m"
    assert measure(radians(90), "rad/s") == "90 deg/s"
    assert measure(inf, "m") == "unlimited"


def test_help_against_wind_speaks_of_the_written_limit() -> None:
    ir = with_mission(with_limits(speed=7.0), wind=2.25)
    (found,) = judge(ir, CONTEXT).diagnostics
    assert "raise `limits.speed` to 10.11 m/s (2.25 m/s of wind are taken off)" in found.help
    assert "the limit is the drone's 9.25 m/s less 2.25 m/s of wind" in found.notes
    assert codes(with_mission(with_limits(speed=10.11 - 2.25), wind=2.25)) == []


def test_a_gimbal_range_is_widened_at_its_end() -> None:
    lowest = float(PLAN.drones[0].curve.ctrl[..., CAM_PITCH].min())
    (found,) = judge(with_gimbal(pitch=(lowest + 0.01, radians(30))), CONTEXT).diagnostics
    assert found.help.startswith("lower the first value of `gimbal.pitch` to -")


def promising(promise: Promise, ir: TrajectoryIR = PLAN) -> list[Diagnostic]:
    shot = replace(MISSION.shots[0], promise=promise)
    return list(judge(with_mission(ir, shots=(shot,)), CONTEXT).diagnostics)


def test_a_broken_size_is_told_by_what_is_seen_and_a_range_to_paste() -> None:
    (found,) = promising(Promise(size=(0.01, 0.7)))
    assert found.message == "tower fills 0.8101 of the frame's height in shot `half`, 0.7 is promised at most"
    assert found.help.startswith("promise `size: [0.01, 0.811]`, or change the distance")
    assert promising(Promise(size=(0.01, 0.811))) == []
    (found,) = promising(Promise(size=(0.9, 0.95)))
    assert "0.9 is promised at least" in found.message
    assert found.help.startswith("promise `size: [0.81, 0.95]`")


def test_a_range_to_paste_holds_for_both_ends() -> None:
    nearer = with_ctrl(lambda c: c.__setitem__((..., HFOV), c[..., HFOV] * np.linspace(1, 1.1, 6)))
    both = [d for d in promising(Promise(size=(0.78, 0.79)), nearer) if d.code == "V021"]
    assert len(both) == 2
    assert both[0].help == both[1].help
    low, high = re.findall(r"0\.\d+", both[0].help)
    kept = promising(Promise(size=(float(low), float(high))), nearer)
    assert not [d for d in kept if d.code == "V021"]


def test_a_broken_screen_error_is_told_with_a_promise_to_paste() -> None:
    aside = shifted(CAM_YAW, radians(3))
    (found,) = promising(Promise(screen_error=0.05), aside)
    assert found.message == (
        "tower is 0.07339 of half a frame off its place on screen in shot `half`, 0.05 is promised at most"
    )
    assert found.help == "promise `screen_error: 0.0734`, or turn the camera slower there"
    assert promising(Promise(screen_error=0.0734), aside) == []


def test_a_cropped_target_is_told_with_a_promise_to_paste() -> None:
    aside = shifted(CAM_YAW, radians(32))
    (found,) = promising(Promise(in_frame=1.0), aside)
    assert found.message == "tower is whole in 0 % of the frames of shot `half`, 100 % is promised"
    assert found.help.startswith("promise `in_frame: 0 %`, or move or widen the shot")


def test_a_broken_promise_names_what_bent_the_path() -> None:
    bent = (Deviation("half", 1.5, 3.0, "zone tree"), Deviation("other", 9.0, 0.0, "the ground"))
    (found,) = promising(Promise(size=(0.1, 0.7)), replace(PLAN, deviations=bent))
    assert "the shot leaves its ideal path by up to 1.50 m, round zone `tree`" in found.notes
    assert not any("ground" in note for note in found.notes)
