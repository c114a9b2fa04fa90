"""A dolly zoom: the size of the target is held while the camera comes nearer, or goes away."""

from __future__ import annotations

import numpy as np
import pytest

from shotc.api import PlanOptions, compile_source
from shotc.ir.path import HFOV
from shotc.ir.sampling import projected
from tests.support.front_passes import resolved

MISSION = """\
shotc: 1
mission: vertigo
targets: {tower: {at: [0, 0, 6], TARGET}}
drones: {cam: {model: x500, home: [0, -70, 0], camera: {CAMERA}}}
shots:
  - {id: vertigo, kind: dolly-zoom, drone: cam, target: tower, azimuth: 180 deg, distance: [DISTANCE],
     altitude: ALTITUDE, COMPOSITION timing: {duration: 25}}
"""


def text(**changes: str) -> str:
    usual = {
        "TARGET": "radius: 2, height: 12",
        "CAMERA": "zoom: [15 mm, 120 mm], hfov: 25 deg",
        "DISTANCE": "60, 20",
        "ALTITUDE": "6",
        "COMPOSITION": "",
    }
    out = MISSION
    for key, value in (usual | changes).items():
        out = out.replace(key, value)
    return out


@pytest.mark.slow
@pytest.mark.parametrize(
    "changes",
    [
        {},
        {"DISTANCE": "20, 60", "CAMERA": "zoom: [15 mm, 120 mm], hfov: 70 deg"},
        {"ALTITUDE": "14"},
        {"COMPOSITION": "composition: [[-0.333, 0]],"},
        {"TARGET": "size: [4, 3, 12], heading: 30 deg"},
    ],
    ids=["in", "out", "above", "third", "box"],
)
def test_the_size_is_held_over_a_threefold_change(changes: dict[str, str]) -> None:
    done = compile_source(text(**changes).encode(), "v.yaml", None, PlanOptions("none"))
    assert done.plan is not None, done.diagnostics
    mission, (track,) = done.plan.trajectory.keyframes.mission, done.plan.trajectory.drones
    (phase,) = (p for p in track.phases if p.shot == "vertigo")
    t = np.linspace(phase.start, phase.end, 400)
    seen = projected(mission, track, "tower", t)
    assert seen.size.max() / seen.size.min() < 1.01
    zoom = np.tan(track.curve(t)[:, HFOV] / 2)
    assert max(zoom[0] / zoom[-1], zoom[-1] / zoom[0]) > 2.5
    assert (np.diff(zoom) * np.sign(zoom[-1] - zoom[0]) >= -1e-9).all()


def test_a_lens_that_has_not_what_it_takes_is_told_with_one_that_has() -> None:
    _, (told,) = resolved(text(CAMERA="zoom: [24 mm, 70 mm], hfov: 30 deg"))
    assert told.code == "K018"
    assert "this dolly-zoom takes 30 to " in told.message
    lens = told.help.split("`camera: {")[1].split("}`")[0]
    assert resolved(text(CAMERA=f"{lens}, hfov: 30 deg"))[1] == []


def test_what_stands_still_or_moves_is_told() -> None:
    assert [d.code for d in resolved(text(DISTANCE="20, 20"))[1]] == ["K010"]
    moving = text().replace("at: [0, 0, 6]", "track: {start: [0, 0, 6], velocity: [1, 0, 0]}")
    assert [d.code for d in resolved(moving)[1]] == ["K019"]
    near = text(DISTANCE="60, 2.5", CAMERA="zoom: [1 mm, 400 mm], hfov: 12 deg")
    assert {d.code for d in resolved(near)[1]} <= {"K018", "G003", "G010"}
    assert resolved(near)[1] != []
