"""Effects of lights over an animation lie where its drones fly, not at goals that they pass at a distance."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from shotc.api import PlanOptions, compile_source
from shotc.geom.fleet_spline import places
from shotc.ir.light_layers import Axis, Band
from tests.support.meshes import box_mesh, ply

pytestmark = [pytest.mark.slow, pytest.mark.long]

MISSION = """\
shotc: 1
mission: leap
fleets:
  swarm: {count: 8, layout: {grid: {spacing: 4, origin: [-8, -8, 0]}}, separation: 1.5}
shots:
  - id: leap
    kind: display
    fleet: swarm
    frames:
      - model: {files: walk/*.ply, period: 1.5 s, units: m}
        hold: 2
        effects: [{chase: {along: east, period: 3 s}}]
"""


def test_an_effect_over_an_animation_lies_where_its_drones_fly(tmp_path: Path) -> None:
    (tmp_path / "walk").mkdir()
    for k in range(5):
        mesh = box_mesh((6.0 * (k % 2), 20.0, 34.0), (12.0, 12.0, 12.0))
        (tmp_path / "walk" / f"w{k}.ply").write_bytes(ply(mesh))
    done = compile_source(MISSION.encode(), "m.yaml", tmp_path, PlanOptions())
    assert done.plan is not None, done.diagnostics
    flight = done.plan.trajectory.fleets[0]
    ((layer,),) = {look.layers for look in flight.lights.looks}
    assert isinstance(layer.paint, Band)
    assert isinstance(layer.paint.along, Axis)
    east = places(flight.breaks, flight.coef, np.array([s.start for s in flight.shown]))[..., 0]
    assert (layer.paint.along.low, layer.paint.along.high) == pytest.approx(
        (east.min(), east.max()), abs=1e-9
    )
    # The limits of the drones keep them more than a metre off their goals.
    assert [d.code for d in done.diagnostics] == ["D088"]
