from __future__ import annotations

from math import degrees

import pytest

from shotc.api import Compilation, PlanOptions, compile_source

pytestmark = pytest.mark.slow

MISSION = """\
shotc: 1
mission: leaning
targets: {tower: {at: [0, 0, 12], radius: 4, height: 24}}
drones: {cam: {model: x500, home: [0, -60, 0], limits: {tilt: 9 deg, thrust_to_weight: 1.25}}}
shots:
  - {id: near, kind: dolly, drone: cam, target: tower, azimuth: 180 deg, distance: [60, 45], altitude: 10}
"""


def compiled(text: str) -> Compilation:
    return compile_source(text.encode(), "leaning.yaml", None, PlanOptions(refiner="none"))


def test_a_plan_leans_no_further_than_it_may_and_uses_that() -> None:
    plan = compiled(MISSION).plan
    assert plan is not None
    found = {claim.constraint: claim for claim in plan.certificate}
    assert 8.5 < degrees(found["tilt"].worst) <= 9.0 + 1e-4
    assert found["thrust to weight"].worst <= 1.25
    assert found["acceleration"].worst <= 1.535  # g sin 9 deg


def test_a_time_that_the_tilt_makes_too_short_is_told_with_the_tilt_s_line() -> None:
    hasty = MISSION.replace("altitude: 10}", "altitude: 10, timing: {duration: 6}}")
    (fault,) = compiled(hasty).diagnostics
    assert fault.code == "T001"
    assert "tilt 9.00 deg" in " ".join(fault.notes)
    assert (4, "tilt binds") in [(label.span.line, label.text) for label in fault.labels]
    raised = (fault.help or "").split("raise `limits.tilt` to ")[1].split()[0]
    assert compiled(hasty.replace("tilt: 9 deg", f"tilt: {raised} deg")).diagnostics == ()
