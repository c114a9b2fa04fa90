"""A shot whose target comes into a fence later begins then, and nobody calls that a delay."""

from __future__ import annotations

from pathlib import Path

import pytest

from shotc.api import PlanOptions, compile_source

MISSION = """\
shotc: 1
mission: entering
world: {zones: {site: {keep: in, box: {center: [200, 0], size: [440, 120, 120]}}}}
targets: {bus: {track: {file: bus.csv}, radius: 2, height: 3}}
drones: {cam1: {model: x500, home: [20, -20, 0]}}
shots:
  - {id: side, kind: lateral, drone: cam1, target: bus, side: right, distance: 15,
     altitude: {above: target, height: 6}, timing: {duration: 12}}
"""


@pytest.mark.slow
@pytest.mark.parametrize("entry", [0.0, 30.0, 200.0])
def test_a_film_begins_when_its_target_comes_in(entry: float, tmp_path: Path) -> None:
    """The bus waits 100 m off the fence until ``entry``, then it drives in at 5 m/s: 20 s later."""
    rows = [(0.0, 520.0), *([(entry, 519.0)] if entry else []), (entry + 104.0, 0.0)]
    text = "t,x,y,z\n" + "".join(f"{t},{x},0,1\n" for t, x in rows)
    (tmp_path / "bus.csv").write_text(text, encoding="utf-8")
    done = compile_source(MISSION.encode(), "m.yaml", tmp_path, PlanOptions(refiner="none"))
    assert done.plan is not None, [str(d) for d in done.diagnostics]
    (start,) = (p.start for p in done.plan.trajectory.drones[0].phases if p.shot == "side")
    assert entry + 20.0 <= start + 0.5
    assert start <= max(entry + 30.0, 45.0)
