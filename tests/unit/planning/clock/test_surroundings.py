"""What a motion is kept clear of, as a refiner gets it: half-spaces, the proof, and the others' flights."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from shotc.api import PlanOptions, compile_source
from shotc.geom.bernstein import Piecewise
from shotc.geom.bspline import restrict, subdivide
from shotc.ir.passes import PassContext
from shotc.ir.path import ClockLeg, PathIR
from shotc.passes.parameterize_time import ParameterizeTime
from shotc.planning.clock.aims import CameraTask
from shotc.planning.clock.flights import flights
from shotc.planning.clock.surroundings import surroundings

pytestmark = pytest.mark.slow

HEAD = """\
shotc: 1
mission: two
world:
  zones:
    shed: {keep: out, box: {center: [45, -14, 3], size: [3, 3, 8]}}
    pen: {keep: in, cylinder: {center: [40, 0], radius: 60, height: [-1, 30]}}
targets:
  runner: {track: {points: [[0, 0, 0.9], [90, 0, 0.9]], speed: 3 m/s}, radius: 0.4, height: 1.8}
  tower: {at: [40, 40, 6], radius: 2, height: 12}
drones:
  cam1: {model: x500, home: [20, -20, 0], priority: 1}
  cam2: {model: x500, home: [26, -20, 0], priority: 2}
rules: {allow: [fast-pan]}
shots:
"""
SHOTS = """\
  - {id: side, kind: lateral, drone: cam1, target: runner, side: right, distance: 8, altitude: 4,
     timing: {start: 12, duration: 8}}
  - {id: after, kind: orbit, drone: cam1, target: tower, radius: 20, altitude: 12, sweep: 60 deg,
     start_azimuth: 180 deg}
  - {id: tail, kind: chase, drone: cam2, target: runner, distance: 7, altitude: 4,
     timing: {after: after, duration: 4}}
"""


@cache
def path() -> PathIR:
    options = PlanOptions(refiner="none", stop_after="solve-path-qp")
    done = compile_source((HEAD + SHOTS).encode(), "two.yaml", None, options)
    assert done.reports[-1].output is not None, done.diagnostics
    return done.reports[-1].output


def leg(shot: str) -> ClockLeg:
    (found,) = (one for flown in path().timed for one in flown.legs if one.shot == shot)
    assert isinstance(found, ClockLeg)
    return found


def fine(shot: str) -> Piecewise:
    curve = leg(shot).curve
    return restrict(curve.channels(0, 1, 2), subdivide(curve.breaks, 4))


def test_flights_are_as_the_time_pass_flies_them() -> None:
    timed = ParameterizeTime().run(path(), PassContext()).value
    assert timed is not None
    found = flights(path())
    for flown in timed.drones:
        mine = found[flown.drone]
        assert mine.phases == flown.phases
        t = np.linspace(0.0, flown.curve.end, 500)
        assert np.allclose(mine.curve(t), flown.curve(t), atol=1e-9)


@pytest.mark.parametrize(("shot", "name"), [("side", "cam1"), ("tail", "cam2")])
def test_the_guide_is_proved_and_keeps_every_half_space(shot: str, name: str) -> None:
    guide = fine(shot)
    around = surroundings(path(), path().keyframes.mission.drone(name), guide.breaks)
    assert around.lacking(guide.ctrl).max() <= 1e-6
    planes = around.half_spaces(guide.ctrl, 8.0, 0.5)
    assert np.allclose(np.linalg.norm(planes.normal, axis=1), 1.0)
    share = np.linspace(0.0, 1.0, 6)
    border = planes.offset[:, :1] + share * (planes.offset[:, -1:] - planes.offset[:, :1])
    reach = np.einsum("pmd,pd->pm", guide.ctrl[planes.piece], planes.normal)
    assert (reach - border).min() > -1e-6


def test_points_that_keep_all_half_spaces_are_proved_clear() -> None:
    guide = fine("side")
    around = surroundings(path(), path().keyframes.mission.drone("cam1"), guide.breaks)
    planes = around.half_spaces(guide.ctrl, 50.0, 0.5)
    rng = np.random.default_rng(3)
    share = np.linspace(0.0, 1.0, 6)
    proved = 0
    for _ in range(30):
        hulls = guide.ctrl + rng.uniform(-2.0, 2.0, (len(guide.ctrl), 1, 3))
        reach = np.einsum("pmd,pd->pm", hulls[planes.piece], planes.normal)
        border = planes.offset[:, :1] + share * (planes.offset[:, -1:] - planes.offset[:, :1])
        broken = np.zeros(len(hulls), dtype=bool)
        broken[planes.piece[(reach < border).any(axis=1)]] = True
        lack = around.lacking(hulls)
        # What is farther than moves lead has no plane; what is nearer has one.
        assert lack[~broken].max(initial=-1.0) <= 1e-6
        proved += int((~broken).sum())
    assert proved > 100


def test_what_runs_into_the_shed_or_the_target_lacks_that_much() -> None:
    guide = fine("side")
    around = surroundings(path(), path().keyframes.mission.drone("cam1"), guide.breaks)
    into = guide.ctrl.copy()
    into[:, :, 1] += 8.0
    into[:, :, 2] -= 3.0
    assert around.lacking(into).max() > 1.0


def test_a_course_keeps_its_own_half_spaces_beside_pictures() -> None:
    mission, guide = path().keyframes.mission, fine("side")
    around = surroundings(path(), mission.drone("cam1"), guide.breaks)
    (placed,) = (p for p in path().keyframes.shots if p.shot.id == "side")
    camera_task = CameraTask(mission, mission.drone("cam1"), placed.subjects)
    planes = around.free(camera_task, (leg("side").start, leg("side").end), guide)
    reach = np.einsum("pmd,pd->pm", guide.ctrl[planes.piece], planes.normal).min(axis=1)
    assert (reach - planes.offset[:, 0]).min(initial=0.0) > -1e-9
    assert len(set(planes.piece)) == len(planes.piece)
