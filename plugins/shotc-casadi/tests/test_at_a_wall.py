"""Keyframes that stand exactly at a clearance: the camera comes there without going below."""

from __future__ import annotations

import numpy as np
import pytest

from shotc.api import PlanOptions, compile_source
from tests.support.refiner_scenes import leg_named, path_of

TEXT = """\
shotc: 1
mission: low
rules: {ground_clearance: 2}
targets: {statue: {at: [0, 0, 3], radius: 1.5, height: 6}}
drones: {cam: {model: alta-x, home: [0, -45, 0], camera: {hfov: 74 deg}}}
shots:
  - {id: dip, kind: keyframes, drone: cam, target: statue, keyframes: [
     {at: [12, 12, 4], look_at: statue},
     {at: [15, 4, 3.3], look_at: statue},
     {at: [15, -4, 6], look_at: statue}]}
"""
LOWEST_M = 3.3  # the ground clearance and the radius of the drone's body


@pytest.mark.slow
def test_a_keyframe_at_the_ground_clearance_is_refined() -> None:
    """The curve through the nodes dipped below its lowest keyframe, and no margin of the nodes helped."""
    done = compile_source(TEXT.encode(), "m.yaml", None, PlanOptions(stop_after="refine-path"))
    assert done.diagnostics == ()
    leg = leg_named(path_of(done), "dip")
    assert leg.curve.ctrl[:, :, 2].min() >= LOWEST_M - 1e-6
    (low,) = (mark.s for mark in leg.marks if mark.index == 1)
    assert leg.curve(np.array([low]))[0, :3] == pytest.approx((15.0, 4.0, LOWEST_M), abs=1e-6)
