"""Every way to break a sound plan is found, named by its code, and placed on its line and in time."""

from math import nan, pi, radians

import numpy as np
import pytest

from shotc.diag.registry import registry
from shotc.geom.bernstein import Piecewise
from shotc.geom.shapes import CylinderShape
from shotc.geom.solids import Cylinder, Prism, box
from shotc.ir.limits import Timing
from shotc.ir.path import HFOV
from shotc.ir.power import Power
from shotc.ir.promise import Promise
from shotc.ir.target import Target
from shotc.ir.thrust import drawn
from shotc.ir.trajectory import TrajectoryIR
from shotc.passes.verify import Verify, judge
from shotc.passes.verify.report import rule_of
from tests.support.film_plans import orbit_plan
from tests.support.records import replace
from tests.support.tampered_plans import (
    MISSION,
    PLAN,
    with_ctrl,
    with_drone,
    with_gimbal,
    with_keyframe,
    with_limits,
    with_mission,
    with_phase,
    with_shot,
    with_track,
    zone,
)
from tests.support.verdicts import CONTEXT, claim, codes, verdict_on


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
    for c in verdict_on(PLAN).certificate:
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


@pytest.mark.slow
def test_energy_is_that_of_the_samples_and_of_no_shot_more_than_of_the_flight() -> None:
    power = Power(2.0, 3e5, 4, 0.127, 0.5, 0.2)
    found = [c for c in verdict_on(with_drone(power=power)).certificate if c.constraint == "energy"]
    (whole,), (shot,) = ([c for c in found if c.shot == name] for name in (None, "half"))
    t = np.linspace(0.0, 122.0, 122001)
    watts = drawn(power, *(CURVE.derivative(n)(t)[:, :3] for n in (1, 2)))
    filmed = (t >= 22.0) & (t <= 52.0)
    assert whole.worst == pytest.approx(np.trapezoid(watts, t) / 3600, rel=1e-4)
    assert shot.worst == pytest.approx(np.trapezoid(watts[filmed], t[filmed]) / 3600, rel=1e-4)
    assert (whole.limit, shot.limit, shot.hard) == (pytest.approx(0.8 * 3e5 / 3600), np.inf, False)


CURVE = PLAN.drones[0].curve
MAST = Target("mast", (40.0, 0.0, 10.0), CylinderShape(1.0, 20.0), ("targets", "mast"))
FRAMING = PLAN.drones[0].framing[0]
TAMPERED: list[tuple[str, TrajectoryIR, set[str]]] = [
    ("speed limit", with_limits(speed=7.8), {"V001"}),
    ("airspeed", with_limits(wind=(0.0, -0.5)), {"V001"}),
    ("climb limit", with_limits(climb=1.8), {"V001"}),
    ("descent limit", with_limits(descent=1.1), {"V001"}),
    ("acceleration limit", with_limits(acceleration=1.5), {"V002"}),
    ("jerk limit", with_limits(jerk=0.5), {"V003"}),
    ("tilt limit", with_limits(tilt=radians(8)), {"V053"}),
    ("thrust limit", with_limits(thrust_to_weight=1.01), {"V054"}),
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
    ("heading", with_mission(rules=replace(MISSION.rules, look_ahead=radians(20.0))), {"V056"}),
    ("ground clearance", with_mission(rules=replace(MISSION.rules, ground_clearance=5.5)), {"V009"}),
    ("target clearance", with_mission(rules=replace(MISSION.rules, target_clearance=29.0)), {"V010"}),
    ("second target", with_mission(
        targets=(*MISSION.targets, MAST)),
     {"V010"}),
    ("control point", with_ctrl(lambda c: c.__setitem__((40, 3, 0), c[40, 3, 0] + 0.05)), {"V003", "V011"}),
    ("home", with_drone(home=(0.0, -60.5, 0.0)), {"V012", "V017"}),
    ("start not at rest", with_ctrl(lambda c: c.__setitem__((0, 1, 2), 0.001)), {"V012"}),
    ("endurance", with_drone(endurance=121.0), {"V013"}),
    ("battery", with_drone(power=Power(2.0, 3.5e4, 4, 0.127, 0.5, 0.2)), {"V055"}),
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


@pytest.mark.long
@pytest.mark.parametrize(("tampered", "expected"), [t[1:] for t in TAMPERED], ids=[t[0] for t in TAMPERED])
def test_tampering_is_found(tampered: TrajectoryIR, expected: set[str]) -> None:
    verdict = verdict_on(tampered)
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


def test_the_verdict_is_the_same_twice() -> None:
    assert judge(PLAN, CONTEXT) == judge(orbit_plan().trajectory, CONTEXT)
