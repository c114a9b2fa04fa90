"""Lenses: what they show and how fast they zoom, planned within and proved at every instant."""

from __future__ import annotations

from math import atan, degrees, inf, pi, radians

import numpy as np
import pytest

from shotc.api import PlanOptions, compile_source
from shotc.diag.model import Diagnostic
from shotc.ir.drone import LensRange
from shotc.ir.path import HFOV
from tests.support.front_passes import resolved
from tests.support.records import replace
from tests.support.verdicts import verdict_on

ZOOM = """\
shotc: 1
mission: zoom
targets: {tower: {at: [0, 0, 12], radius: 2, height: 12}}
drones: {cam: {model: x500, home: [0, -60, 0], camera: {zoom: [24 mm, 70 mm], zoom_rate: RATE}}}
shots:
  - id: in
    kind: keyframes
    drone: cam
    target: tower
    keyframes:
      - {at: [-10, -70, 12], look_at: tower}
      - {at: [0, -75, 12], look_at: tower, hfov: 30 deg}
      - {at: [0, -75, 12], look_at: tower, hfov: 60 deg}
"""
WIDEST = 2 * atan(18 / 24)


def told(text: str) -> list[Diagnostic]:
    return resolved(text)[1]


@pytest.mark.slow
@pytest.mark.parametrize("rate", [3.0, 20.0])
def test_a_zoom_is_planned_within_its_rate_and_proved(rate: float) -> None:
    done = compile_source(ZOOM.replace("RATE", f"{rate} deg/s").encode(), "z.yaml", None, PlanOptions("none"))
    assert done.plan is not None, done.diagnostics
    track = done.plan.trajectory.drones[0]
    t = np.linspace(track.curve.start, track.curve.end, 20_001)
    flown = np.abs(track.curve.derivative()(t)[:, HFOV]).max()
    claim = next(c for c in done.plan.certificate if c.constraint == "zoom rate")
    assert claim.method == "bounded"
    assert flown <= claim.worst + 1e-9 <= radians(rate) + 2e-9
    assert flown >= 0.999 * claim.worst
    # The slower one is what the time of the zoom on the spot comes from.
    (phase,) = (p for p in track.phases if p.shot == "in")
    assert track.curve(phase.start)[HFOV] == pytest.approx(WIDEST)
    if rate < 10.0:
        assert claim.worst > 0.5 * radians(rate)
        assert phase.end - phase.start > (degrees(WIDEST) - 30 + 30) / rate


@pytest.mark.slow
def test_a_plan_that_zooms_too_fast_or_beyond_its_lens_is_refused() -> None:
    done = compile_source(ZOOM.replace("RATE", "20 deg/s").encode(), "z.yaml", None, PlanOptions("none"))
    assert done.plan is not None
    ir = done.plan.trajectory
    mission = ir.keyframes.mission
    for lens, code in (
        (LensRange(radians(28), WIDEST, radians(1)), "V060"),
        (LensRange(radians(40), WIDEST, inf), "V018"),
        (LensRange(radians(28), radians(70), inf), "V018"),
    ):
        drones = (mission.drones[0]._replace(lens=lens),)
        other = replace(ir, keyframes=replace(ir.keyframes, mission=replace(mission, drones=drones)))
        assert code in {d.code for d in verdict_on(other).diagnostics}


def test_focal_lengths_count_on_the_sensor_or_on_a_frame_of_36_mm() -> None:
    sensor = "sensor: 13.2 mm, focal_length: 8.8 mm, zoom: [8.8 mm, 26.4 mm]"
    for camera, widest, longest, frame in (
        ("zoom: [24 mm, 70 mm]", WIDEST, 2 * atan(18 / 70), 0.036),
        (sensor, 2 * atan(0.75), 2 * atan(0.25), 0.0132),
    ):
        text = ZOOM.replace("zoom: [24 mm, 70 mm], zoom_rate: RATE", camera).replace("hfov: 30", "hfov: 32")
        mission, found = resolved(text)
        assert found == []
        assert mission is not None
        drone = mission.drone("cam")
        assert drone.lens == pytest.approx(LensRange(longest, widest, pi / 18, frame))
        assert drone.hfov == pytest.approx(widest)


def test_a_wish_beyond_the_lens_is_told_at_its_key_with_what_the_lens_has() -> None:
    (beyond,) = told(ZOOM.replace("RATE", "5 deg/s").replace("30 deg", "20 deg"))
    assert (beyond.code, beyond.labels[0].span.line) == ("K018", 12)
    assert "28.84 to 73.74 deg" in beyond.message
    assert told(ZOOM.replace("RATE", "5 deg/s").replace("30 deg", "29 deg")) == []
    fixed = ZOOM.replace("model: x500", "model: mini").replace(
        ", camera: {zoom: [24 mm, 70 mm], zoom_rate: RATE}", ""
    )
    assert [d.code for d in told(fixed)] == ["K018", "K018"]
    assert told(fixed.replace("30 deg", "72 deg").replace("60 deg", "72 deg")) == []
