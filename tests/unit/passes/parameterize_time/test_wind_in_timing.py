from __future__ import annotations

import pytest

from shotc.api import PlanOptions, compile_source

pytestmark = pytest.mark.slow

MISSION = """\
shotc: 1
mission: windy
world: {wind: 4.5 m/s}
targets: {tower: {at: [0, 0, 12], radius: 4, height: 24}}
drones: {cam: {model: x500, home: [0, -60, 0], limits: {speed: 8 m/s}}}
shots:
  - id: past
    kind: keyframes
    drone: cam
    target: tower
    timing: {duration: 18 s}
    keyframes:
      - {at: [-45, -45, 8], look_at: tower}
      - {at: [45, -45, 8], look_at: tower}
"""


def test_a_speed_that_the_wind_takes_from_is_told_with_the_wind_s_line():
    (fault,) = compile_source(MISSION.encode(), "windy.yaml", None, PlanOptions(refiner="none")).diagnostics
    assert fault.code == "T001"
    assert "speed 8.00 m/s less 4.50 m/s of wind" in fault.notes[1]
    said = [(label.span.line, label.text) for label in fault.labels]
    assert (5, "speed binds") in said
    assert said[-1] == (3, "takes a part of the speed")
