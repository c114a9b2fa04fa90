"""Where the cameras of shots on their own clocks would be, all at once and one by one."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from shotc.ir.ideal import ideal_place
from shotc.planning.clock.ideals import ideal_places
from tests.support.front_passes import placed

HEAD = """\
shotc: 1
mission: ideals
targets:
  turns:
    track: {points: [[0, 0, 0.9], [30, 0, 0.9], [30, 40, 4.9], [0, 60, 0.9]], speed: 3 m/s}
    radius: 0.4
    height: 1.8
  rests:
    track: {points: [[0, 0, 1], [9, 0, 1], [9, 0, 1], [9, 30, 1]], times: [0, 3, 20, 30]}
    radius: 0.4
    height: 1.8
  faces: {track: {file: faces.csv}, radius: 0.4, height: 1.8}
  stands: {at: [5, 5, 0.9], radius: 0.4, height: 1.8}
drones: {cam: {model: x500, home: [-40, -40, 0], limits: {speed: 19 m/s, acceleration: 12 m/s^2}}}
shots:
"""
FACES = "t,x,y,z,heading_deg\n0,0,0,0.9,0\n10,20,5,0.9,90\n40,60,5,0.9,270\n"
SHOTS = (
    "kind: chase, distance: 8, altitude: 4",
    "kind: flyby, behind: 10, ahead: 12, offset: 6, altitude: 5",
    "kind: orbit, radius: 12, altitude: 6, sweep: 200 deg",
    "kind: spiral, radius: [12, 20], altitude: [6, 9], sweep: -200 deg",
    "kind: framing, subjects: [{target: TARGET}]",
    "kind: keyframes, keyframes: [{at: {from: TARGET, offset: [9, 2, 5], turn: course}, look_at: TARGET}, "
    "{at: {from: TARGET, offset: [-4, 9, 6]}, look_at: TARGET}]",
)


CASES = [(shot, target) for shot in SHOTS for target in ("turns", "rests", "faces")]
CASES += [(shot, "stands") for shot in SHOTS if shot.startswith("kind: framing")]


@pytest.mark.slow
@pytest.mark.parametrize(("shot", "target"), CASES)
def test_many_places_are_those_of_each_time(shot: str, target: str, tmp_path: Path) -> None:
    (tmp_path / "faces.csv").write_text(FACES)
    named = shot.replace("TARGET", target) if "TARGET" in shot else f"{shot}, target: {target}"
    text = f"{HEAD}  - {{id: s, drone: cam, {named}, timing: {{start: 9, duration: 12}}}}\n"
    found, told = placed(text, tmp_path)
    assert found is not None, told
    mission = found.mission
    times = np.linspace(7.0, 25.0, 181)
    each = [ideal_place(mission, mission.shots[0], 9.0, float(t)) for t in times]
    assert np.abs(ideal_places(mission, mission.shots[0], 9.0, times) - np.array(each)).max() < 1e-9
