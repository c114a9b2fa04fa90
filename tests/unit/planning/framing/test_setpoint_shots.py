"""Framings whose place, size or view changes while they film: what is flown, what is told, what is proved."""

from __future__ import annotations

import re
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

import shotc
from shotc.geom.bernstein import Piecewise
from shotc.ir.passes import PassContext
from shotc.ir.sampling import seen
from shotc.ir.trajectory import VerifiedIR
from shotc.passes.verify import judge
from shotc.simulation.film import film_of
from tests.support.compiled import compiled_text
from tests.support.front_passes import placed

pytestmark = pytest.mark.slow

MISSION = """\
shotc: 1
mission: setpoints
targets:
  runner: {track: {points: [[0, 0, 0.9], [60, 0, 0.9]], times: [0, 40]}, radius: 0.4, height: 1.8}
  rider: {track: {points: [[0, 3, 1], [60, 3, 1]], times: [0, 40]}, radius: 0.6, height: 2}
  mast: {at: [0, 0, 6], radius: 1, height: 12}
drones:
  cam1: {model: x500, home: [0, -30, 0]}
shots:
  - {id: s, kind: framing, drone: cam1, timing: {start: 15, duration: 12}, subjects: [SUBJECTS]}
"""
SETPOINTS = (
    "{time: 5, frame: right-third}",
    "{time: 9, size: 0.4, view: {azimuth: 130 deg}}",
    "{time: 12, frame: center}",
)
FIRST = "target: runner, frame: left-third, size: 0.2, view: {azimuth: 180 deg}"
ONE = f"{{{FIRST}, setpoints: [{', '.join(SETPOINTS)}]}}"
START = 15.0


def text(*subjects: str) -> str:
    return MISSION.replace("SUBJECTS", ", ".join(subjects))


def planned(mission: str) -> VerifiedIR:
    done = compiled_text(mission, "none", "m.yaml")
    assert done.plan is not None, done.diagnostics
    return done.plan


def eased(t, known):
    """The value at times, by ``known`` pairs (time, value): fifth degree, at rest at both ends."""
    out = np.full(len(t), known[0][1])
    for (a, low), (b, high) in pairwise(known):
        x = np.clip((t - a) / (b - a), 0.0, 1.0)
        out = np.where(t > a, low + (6 * x**5 - 15 * x**4 + 10 * x**3) * (high - low), out)
    return out


@pytest.mark.long
def test_a_moving_subject_appears_as_its_setpoints_say_at_every_frame() -> None:
    plan = planned(text(ONE))
    mission, track = plan.trajectory.keyframes.mission, plan.trajectory.drones[0]
    t = np.linspace(0.0, 12.0, 120)
    frames = seen(mission, track, "runner", START + t)
    third = 1 / 3
    assert np.abs(frames.u - eased(t, [(0, -third), (5, third), (12, 0)])).max() < 0.005
    assert np.abs(frames.v).max() < 0.005
    assert np.abs(frames.size / np.exp(eased(t, [(0, np.log(0.2)), (9, np.log(0.4))])) - 1).max() < 0.03
    x, y, _ = (track.curve(START + t)[:, :3] - [mission.target("runner").at(u) for u in START + t]).T
    bearing = np.degrees(np.arctan2(x, y)) % 360
    assert np.abs(bearing - eased(t, [(0, 180), (9, 130)])).max() < 1.5


@pytest.mark.long
def test_a_plan_that_wants_something_else_than_the_setpoints_is_refused() -> None:
    plan = planned(text(ONE))
    (flight,) = plan.trajectory.drones
    (span,) = flight.framing
    still = Piecewise(np.array([span.start, span.end]), np.tile(span.reference(span.start), (1, 6, 1)))
    edited = replace(flight, framing=(replace(span, reference=still),))
    before, after = (
        next(
            claim
            for claim in judge(ir, PassContext()).certificate
            if claim.constraint == "reference off its composition"
        )
        for ir in (plan.trajectory, replace(plan.trajectory, drones=(edited,)))
    )
    assert (before.holds, after.holds) == (True, False)
    assert after.worst == pytest.approx(2 / 3, abs=0.01)


def test_the_example_of_the_guide_checks_clean() -> None:
    guide = Path(shotc.__file__).parent / "docs" / "language.md"
    blocks = re.findall(r"^```yaml\n(.*?)^```", guide.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)
    (example,) = (block for block in blocks if "setpoints:" in block)
    world = MISSION.replace("mast: {at: [0, 0, 6]", "tower: {at: [0, 0, 12]")
    assert placed(re.sub(r"  - .*\n", example, world))[1] == []


@pytest.mark.long
@pytest.mark.parametrize(
    ("setpoints", "code", "marked"),
    [
        ("[{time: 4, size: 0.3}, {time: 4, size: 0.4}]", "M037", "4"),
        ("[{time: 14, size: 0.3}]", "M037", "14"),
        ("[{time: 4}]", "M036", "{time: 4}"),
        ("[{time: 4, view: {elevation: 20 deg}}]", "M036", "20 deg"),
        ("[{time: 4, frame: thirds}]", "S009", "thirds"),
        ("[{time: 9, size: extreme-close-up}]", "M031", "extreme-close-up"),
    ],
)
def test_a_setpoint_that_makes_no_sense_is_told_where_it_stands(setpoints, code, marked) -> None:
    mission = text(f"{{target: runner, size: 0.2, frame: left-third, setpoints: {setpoints}}}")
    (found,) = placed(mission)[1]
    span = found.labels[0].span
    assert found.code == code
    assert mission.splitlines()[span.line - 1][span.column - 1 : span.end_column - 1] == marked


@pytest.mark.long
def test_a_change_that_is_too_fast_for_the_drone_is_told_with_the_time_it_takes() -> None:
    mission = text("{target: mast, size: 0.2, setpoints: [{time: 4, size: 0.6}]}")
    (found,) = placed(mission)[1]
    assert found.code == "M005"
    assert "its setpoints" in found.help
    duration, time = re.search(r"`duration: (\S+) s`.*\((\S+) s\)", found.help).groups()
    longer = mission.replace("duration: 12", f"duration: {duration}").replace("time: 4", f"time: {time}")
    assert placed(longer)[1] == []


def test_several_subjects_are_led_apart_on_screen() -> None:
    pair = (
        "{target: runner, frame: [-0.15, 0], setpoints: [{time: 10, frame: [-0.3, 0]}]}",
        "{target: rider, frame: [0.15, 0], setpoints: [{time: 10, frame: [0.3, 0]}]}",
    )
    plan = planned(text(*pair))
    mission, track = plan.trajectory.keyframes.mission, plan.trajectory.drones[0]
    t = np.linspace(0.0, 12.0, 60)
    for name, known in (("runner", [(0, -0.15), (10, -0.3)]), ("rider", [(0, 0.15), (10, 0.3)])):
        frames = seen(mission, track, name, START + t)
        assert np.abs(frames.u - eased(t, known)).max() < 0.05, name


@pytest.mark.long
def test_who_plans_anew_is_told_what_is_asked_at_that_time() -> None:
    plan = planned(text(ONE))
    film = film_of(plan.trajectory.keyframes.mission, plan.trajectory.drones[0])
    uv = film.framed[0].reference[film.step(START + 5.0)]
    assert tuple(uv) == pytest.approx((1 / 3, 0.0), abs=1e-6)
