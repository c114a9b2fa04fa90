"""A broken limit in the author's terms: its line, its shot, when, and a number that would hold."""

from math import inf, pi, radians

import pytest
from hypothesis import given
from hypothesis import strategies as st

from shotc.ir.measures import enough, measure
from shotc.ir.origin import OriginMap
from shotc.ir.path import CAM_PITCH
from shotc.source.file import Span
from tests.support.records import replace
from tests.support.tampered_plans import PLAN, with_gimbal, with_limits, with_mission, with_track
from tests.support.verdicts import claim, codes, verdict_on

SPEED = claim(PLAN, "speed")


def test_a_diagnostic_points_at_the_limit_and_the_shot() -> None:
    limit, shot = Span(12, 20, 12, 25), Span(30, 5, 30, 20)
    origins = OriginMap(
        "half-orbit.yaml",
        {("shots", 0): shot},
        {("drones", "cam1", "limits", "speed"): limit},
    )
    ir = with_mission(with_limits(speed=7.0), origins=origins)
    (found,) = verdict_on(ir).diagnostics
    assert [label.span for label in found.labels] == [limit, shot]
    assert "7.854 m/s" in found.message
    assert "7 m/s" in found.message
    assert "t = 37.000 s" in found.notes[0]
    assert "15.000 s into shot `half`" in found.notes[0]
    # 30 s x 7.854 / 7: and at that duration the limit holds.
    assert "33.7 s" in found.help


def test_missing_values_are_told_without_numbers() -> None:
    ir = with_track(keyframes=())
    found = [d for d in verdict_on(ir).diagnostics if d.code == "V016"]
    assert found
    assert all("inf" not in d.message for d in found)
    assert claim(ir, "distance from keyframes").worst == inf


@pytest.mark.slow
@given(st.floats(1e-9, 1e6), st.booleans(), st.sampled_from(["m/s", "rad", "of samples", "m"]))
def test_a_proposed_limit_is_one_that_holds(worst: float, upper: bool, unit: str) -> None:
    proposed = float(enough(replace(SPEED, worst=worst, upper=upper, unit=unit)).split()[0])
    read = worst * {"rad": 180 / pi, "of samples": 100.0}.get(unit, 1.0)
    assert proposed >= read * (1 - 1e-9) if upper else proposed <= read * (1 + 1e-9)
    assert proposed == pytest.approx(read, rel=2e-3)


@pytest.mark.slow
def test_the_help_makes_the_plan_hold() -> None:
    (found,) = verdict_on(with_limits(speed=7.0)).diagnostics
    assert "raise `limits.speed` to 7.855 m/s" in found.help
    assert codes(with_limits(speed=7.855)) == []
    assert measure(0.0, "m") == "0 m"
    assert measure(radians(90), "rad/s") == "90 deg/s"
    assert measure(inf, "m") == "unlimited"


@pytest.mark.slow
def test_help_against_wind_speaks_of_the_written_limit() -> None:
    ir = with_mission(with_limits(speed=7.0), wind=2.25)
    (found,) = verdict_on(ir).diagnostics
    assert "raise `limits.speed` to 10.11 m/s (2.25 m/s of wind are taken off)" in found.help
    assert "the limit is the drone's 9.25 m/s less 2.25 m/s of wind" in found.notes
    assert codes(with_mission(with_limits(speed=10.11 - 2.25), wind=2.25)) == []


def test_a_gimbal_range_is_widened_at_its_end() -> None:
    lowest = float(PLAN.drones[0].curve.ctrl[..., CAM_PITCH].min())
    (found,) = verdict_on(with_gimbal(pitch=(lowest + 0.01, radians(30)))).diagnostics
    assert found.help.startswith("lower the first value of `gimbal.pitch` to -")
