"""Poses for evo (TUM) and setpoints for offboard scripts (NED), against the plan."""

from __future__ import annotations

import csv
import io

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from shotc.emit import ned, tum
from shotc.emit.attitude import graphics, optical, upright
from shotc.ir.path import BODY_YAW, CAM_PITCH, CAM_YAW
from shotc.ir.sampling import cameras, clock
from shotc.ir.trajectory import VerifiedIR
from tests.support.film_plans import orbit_plan
from tests.support.records import replace
from tests.support.show_plans import plan as show_plan

PLAN = orbit_plan()
DRONE = PLAN.trajectory.drones[0]
TICKS = clock(50.0, DRONE.curve.end)


def axes(yaw: float, pitch: float) -> np.ndarray:
    """Right, down and forward of a camera as columns, by the definition of the output page."""
    forward = [np.cos(yaw) * np.cos(pitch), np.sin(yaw) * np.cos(pitch), np.sin(pitch)]
    right = [np.sin(yaw), -np.cos(yaw), 0.0]
    return np.column_stack([right, np.cross(forward, right), forward])


def rows_of(plan: VerifiedIR) -> np.ndarray:
    """Rows by the format that evo documents: eight numbers between single spaces, w last."""
    (artifact,) = tum.EMITTER.emit(plan).artifacts
    lines = [line for line in artifact.data.decode().split("\n")[:-1] if not line.startswith("#")]
    cells = [line.split(" ") for line in lines]
    assert {len(row) for row in cells} == {8}
    return np.array(cells, dtype=float)


def test_the_three_ways_to_write_a_rotation_are_one() -> None:
    rng = np.random.default_rng(7)
    yaw, pitch = np.cumsum(rng.uniform(-0.5, 0.9, 200)), rng.uniform(-np.pi / 2, 0.5, 200)
    wanted = np.array([axes(*angles) for angles in zip(yaw, pitch, strict=True)])
    flip = np.diag([1.0, -1.0, -1.0])
    y_up = np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]])
    assert Rotation.from_quat(optical(yaw, pitch)).as_matrix() == pytest.approx(wanted, abs=1e-12)
    assert Rotation.from_quat(graphics(yaw, pitch)).as_matrix() == pytest.approx(wanted @ flip, abs=1e-12)
    assert Rotation.from_quat(upright(yaw, pitch)).as_matrix() == pytest.approx(
        y_up @ wanted @ flip, abs=1e-12
    )
    steps = np.einsum("mi,mi->m", optical(yaw, pitch)[1:], optical(yaw, pitch)[:-1])
    assert steps.min() > 0.0


@pytest.mark.slow
def test_tum_has_the_camera_at_every_tick() -> None:
    rows, state = rows_of(PLAN), DRONE.curve(TICKS)
    assert rows[:, 0] == pytest.approx(TICKS, abs=1e-6)
    assert np.linalg.norm(rows[:, 1:4] - state[:, :3], axis=1).max() < 1e-5
    wanted = np.array([axes(*angles) for angles in state[:, [CAM_YAW, CAM_PITCH]]])
    found = Rotation.from_quat(rows[:, 4:])
    assert np.degrees((found * Rotation.from_matrix(wanted).inv()).magnitude()).max() < 1e-5
    assert np.linalg.norm(rows[:, 4:], axis=1) == pytest.approx(1.0, abs=2e-9)


def test_evo_reads_the_poses_and_finds_nothing_wrong(tmp_path) -> None:
    interface = pytest.importorskip("evo.tools.file_interface", reason="evo reads TUM files")
    (artifact,) = tum.EMITTER.emit(PLAN).artifacts
    (tmp_path / artifact.name).write_bytes(artifact.data)
    read = interface.read_tum_trajectory_file(tmp_path / artifact.name)
    good, details = read.check()
    assert good, details
    assert read.num_poses == len(TICKS)
    assert np.abs(read.positions_xyz - DRONE.curve(TICKS)[:, :3]).max() < 1e-5
    eyes = cameras(PLAN.trajectory.keyframes.mission, DRONE, TICKS)
    aim = np.array([pose[:3, 2] for pose in read.poses_se3])
    assert np.arctan2(aim[:, 1], aim[:, 0]) == pytest.approx(np.angle(np.exp(1j * eyes.yaw)), abs=1e-7)


@pytest.mark.slow
def test_setpoints_count_from_the_pad_with_north_first_and_down_positive() -> None:
    (artifact,) = ned.EMITTER.emit(PLAN).artifacts
    assert artifact.name == "cam1-ned.csv"
    table = list(csv.DictReader(io.StringIO(artifact.data.decode())))
    assert ",".join(table[0]) == ned.SETPOINTS
    state, rate, push = (DRONE.curve.derivative(k)(TICKS) for k in range(3))
    rate[-1] = push[-1] = 0.0
    column = {k: np.array([float(row[k]) for row in table]) for k in list(table[0])[:-2]}
    home = np.array([0.0, -60.0, 0.0])
    for names, wanted in (
        (("east_m", "north_m", "down_m"), state[:, :3] - home),
        (("ve_m_s", "vn_m_s", "vd_m_s"), rate[:, :3]),
        (("ae_m_s2", "an_m_s2", "ad_m_s2"), push[:, :3]),
    ):
        found = np.column_stack([column[name] for name in names]) * [1, 1, -1]
        assert np.abs(found - wanted).max() < 1e-6
    ahead = np.column_stack([np.sin(column["yaw_ned_rad"]), np.cos(column["yaw_ned_rad"])])
    assert ahead == pytest.approx(
        np.column_stack([np.cos(state[:, BODY_YAW]), np.sin(state[:, BODY_YAW])]), abs=1e-8
    )
    assert np.abs(column["yaw_ned_rad"]).max() <= np.pi + 1e-9
    assert column["yaw_rate_ned_rad_s"] == pytest.approx(-rate[:, BODY_YAW], abs=1e-8)
    assert column["gimbal_pitch_rad"] == pytest.approx(state[:, CAM_PITCH], abs=1e-8)
    assert {row["phase"]: row["shot"] for row in table}["shot"] == "half"
    assert [column[k][0] for k in ("north_m", "east_m", "down_m")] == [0.0, 0.0, 0.0]


def test_a_clock_too_slow_for_offboard_is_told() -> None:
    ir = PLAN.trajectory
    mission = replace(ir.keyframes.mission, rate=2.0)
    slow = VerifiedIR(replace(ir, keyframes=replace(ir.keyframes, mission=mission)), ())
    assert "more than 2" in ned.EMITTER.emit(slow).notes[-1]
    assert len(ned.EMITTER.emit(PLAN).notes) == 1


@pytest.mark.parametrize("emitter", [tum.EMITTER, ned.EMITTER])
def test_fleets_are_left_out_with_a_note(emitter) -> None:
    emission = emitter.emit(show_plan())
    assert emission.artifacts == ()
    assert "fleets" in emission.notes[0]
