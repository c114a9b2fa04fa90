"""Framings whose camera stays near a place: what that is worth against the picture (viewpoint Eq. 10)."""

from __future__ import annotations

from math import hypot, log, pi, radians, sin, tan

import numpy as np
import pytest
from scipy.optimize import minimize_scalar

from shotc.geom.shapes import CylinderShape
from shotc.geom.viewpoint import (
    NEAR_WEIGHT,
    Lens,
    PlaceBounds,
    PreferredPose,
    RequiredView,
    distance_for,
    first_pose,
    viewpoint,
)
from shotc.ir.path import CAM_YAW
from shotc.ir.sampling import seen
from tests.support.compiled import compiled_text
from tests.support.front_passes import placed

MISSION = """\
shotc: 1
mission: near
targets:
  runner: {track: {points: [[0, 0, 0.9], [60, 0, 0.9]], times: [0, 60]}, radius: 0.4, height: 1.8}
  car: {track: {points: [[8, -14, 1], [76, -14, 1]], times: [0, 60]}, radius: 1, height: 2}
  rider: {track: {points: [[0, 3, 1], [60, 3, 1]], times: [0, 60]}, radius: 0.6, height: 2}
drones: {cam1: {model: x500, home: [0, -30, 0]}}
shots:
  - {id: s, kind: framing, drone: cam1, timing: {start: 15, duration: 8}, NEAR subjects: [SUBJECTS]}
"""
PAIR = "{target: runner, frame: left-third}, {target: rider, frame: right-third}"
PLACE = (30.0, -12.0, 5.0)


def text(subjects: str, near: str = f"near: {list(PLACE)},") -> str:
    return MISSION.replace("NEAR", near).replace("SUBJECTS", subjects)


def test_a_size_and_a_place_meet_where_the_sum_of_their_squares_is_least() -> None:
    lens = Lens(radians(70), 16 / 9, (-pi / 2, radians(30)))
    man = RequiredView((0.0, 0.0, 20.0), CylinderShape(0.01, 1.8), (0.0, 0.0), 0.3)
    asked, away = distance_for(man, lens, (0.0, -1.0, 0.0), 0.3), 12.0
    room = PlaceBounds(2.0, 0.5, PreferredPose((0.0, -away, 20.0)))
    pose, _ = viewpoint((man,), lens, room, first_pose((man,), lens, room, pi))

    def cost(distance: float) -> float:  # a thin target is as large as it is near
        return log(asked / distance) ** 2 + (NEAR_WEIGHT * (distance - away) / away) ** 2

    best = minimize_scalar(cost, bounds=(2.0, 14.0), method="bounded").x
    assert asked < best < away
    assert -pose[1] == pytest.approx(best, rel=5e-3)
    assert hypot(pose[0], pose[2] - 20.0) < 1e-2


def test_angles_and_a_place_on_screen_meet_where_the_sum_of_their_squares_is_least() -> None:
    """What a camera turns aside moves its subject on screen; it may go aside a little besides."""
    lens = Lens(radians(70), 16 / 9, (-pi / 2, radians(30)))
    man = RequiredView((0.0, 0.0, 20.0), CylinderShape(0.01, 1.8), (0.0, 0.0), 0.05)
    away, aside = distance_for(man, lens, (0.0, -1.0, 0.0), 0.05), radians(25)
    near = PreferredPose((0.0, -away, 20.0), pi / 2 + aside)
    room = PlaceBounds(2.0, 0.5, near)
    pose, cost = viewpoint((man,), lens, room, first_pose((man,), lens, room, pi))
    turned = pose[3] - pi / 2
    assert 0.0 < turned < aside
    by_turning = min(
        (tan(a) / tan(radians(35))) ** 2 + (2 * NEAR_WEIGHT * sin((aside - a) / 2)) ** 2
        for a in np.linspace(0.0, aside, 2001)
    )
    assert 0.25 * by_turning < cost <= by_turning * (1 + 1e-6)


@pytest.mark.slow
def test_a_camera_goes_along_beside_the_target_that_its_place_counts_from() -> None:
    near = "near: {from: car, offset: [0, 0, 6]},"
    done = compiled_text(text("{target: runner, frame: center}", near), "none", "m.yaml")
    assert done.plan is not None, done.diagnostics
    made, (track,) = done.plan.trajectory.keyframes.mission, done.plan.trajectory.drones
    t = np.linspace(15.0, 23.0, 60)
    car = np.array([made.target("car").at(float(u)) for u in t])
    off = track.curve(t)[:, :3] - car + [0.0, 0.0, 1.0] - [0.0, 0.0, 6.0]
    assert np.linalg.norm(off, axis=1).max() < 0.1
    assert np.ptp(track.curve(t)[:, 0]) > 8.0


@pytest.mark.long
@pytest.mark.parametrize("refiner", ["none", "ours"])
def test_angles_that_a_camera_stays_near_turn_it_towards_them(refiner: str) -> None:
    mean = []
    for heading in (-90, -30):
        near = f"near: {{at: {list(PLACE)}, heading: {heading} deg}},"
        done = compiled_text(text(PAIR, near), refiner, "m.yaml")
        assert done.plan is not None, done.diagnostics
        (track,) = done.plan.trajectory.drones
        yaw = track.curve(np.linspace(15.0, 23.0, 60))[:, CAM_YAW]
        mean.append(float(np.degrees(pi / 2 - yaw).mean()))
    assert mean[1] > mean[0] + 15.0


def test_a_place_that_counts_from_nobody_is_told_where_it_stands() -> None:
    (found,) = placed(text("{target: runner, frame: center}", "near: {from: bus, offset: [0, 0, 6]},"))[1]
    assert (found.code, found.labels[0].span.line) == ("N001", 9)


@pytest.mark.slow
@pytest.mark.parametrize("refiner", ["none", "ours"])
def test_a_camera_that_nothing_else_places_stays_there_and_turns(refiner: str) -> None:
    done = compiled_text(text("{target: runner, frame: center}"), refiner, "m.yaml")
    assert done.plan is not None, done.diagnostics
    mission, (track,) = done.plan.trajectory.keyframes.mission, done.plan.trajectory.drones
    t = np.linspace(15.0, 23.0, 60)
    assert np.linalg.norm(track.curve(t)[:, :3] - PLACE, axis=1).max() < 0.1
    frames = seen(mission, track, "runner", t)
    assert np.hypot(frames.u, frames.v).max() < 0.01


@pytest.mark.long
@pytest.mark.parametrize("refiner", ["none", "ours"])
def test_several_subjects_are_filmed_from_nearer_to_the_place(refiner: str) -> None:
    far = []
    for near in ("", f"near: {list(PLACE)},"):
        done = compiled_text(text(PAIR, near), refiner, "m.yaml")
        assert done.plan is not None, done.diagnostics
        (track,) = done.plan.trajectory.drones
        t = np.linspace(15.0, 23.0, 60)
        far.append(np.linalg.norm(track.curve(t)[:, :3] - PLACE, axis=1).mean())
        errors = [c.worst for c in done.plan.certificate if c.constraint.endswith("screen error")]
        assert max(errors) < 0.25
    assert far[1] < far[0] - 0.5


@pytest.mark.slow
def test_what_is_not_had_of_picture_and_place_is_told() -> None:
    (found,) = placed(text("{target: runner, frame: center, size: 0.7}"))[1]
    assert found.code == "M034"
    assert "m from the place that it stays near" in found.notes[-1]
    assert placed(text("{target: runner, frame: center}"))[1] == []
