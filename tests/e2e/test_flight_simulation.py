"""The demo's trajectory.csv, flown by a quadrotor with thrust and attitude lag in gusty wind."""

from __future__ import annotations

import csv
import io
from pathlib import Path

import numpy as np
import pytest

from shotc.api import PlanOptions, compile_source
from shotc.geom.camera import View

MISSION = Path(__file__).parents[2] / "specs" / "tower-reveal.yaml"
GRAVITY = np.array([0.0, 0.0, -9.81])
STEP = 0.005
ATTITUDE_LAG, THRUST_LAG, GIMBAL_LAG = 0.08, 0.05, 0.05
DRAG = 0.25
"""Specific drag, 1/s, of a multirotor of about 2 kg."""


@pytest.fixture(scope="module")
def plan():
    return compile_source(
        MISSION.read_bytes(), "tower-reveal.yaml", MISSION.parent, PlanOptions(refiner="none")
    ).plan


@pytest.fixture(scope="module")
def rows(plan):
    from shotc.emit.csv_table import EMITTER

    (table,) = [a for a in EMITTER.emit(plan).artifacts if a.name == "trajectory.csv"]
    return list(csv.DictReader(io.StringIO(table.data.decode())))


def columns(rows, *names):
    return np.array([[float(row[name]) for name in names] for row in rows])


def fly(rows, gust):
    """Follow the table as an offboard controller would; return flown positions and camera angles.

    The specific thrust is a vector that lags behind its command, so the craft can neither turn nor
    push at once; the controller is PD on position with the table's acceleration as feed-forward.
    """
    time = columns(rows, "t_s")[:, 0]
    position = columns(rows, "x_m", "y_m", "z_m")
    velocity = columns(rows, "vx_m_s", "vy_m_s", "vz_m_s")
    acceleration = columns(rows, "ax_m_s2", "ay_m_s2", "az_m_s2")
    angles = columns(rows, "cam_yaw_rad", "cam_pitch_rad")
    p, v, thrust, look = position[0].copy(), velocity[0].copy(), -GRAVITY.copy(), angles[0].copy()
    random, wind = np.random.default_rng(7), np.zeros(3)
    flown, looked = np.empty_like(position), np.empty_like(angles)
    lag = np.array([ATTITUDE_LAG, ATTITUDE_LAG, THRUST_LAG])
    for k in range(len(time)):
        flown[k], looked[k] = p, look
        command = acceleration[k] + 4.0 * (position[k] - p) + 3.0 * (velocity[k] - v) + DRAG * v - GRAVITY
        for _ in range(round(0.02 / STEP)):
            thrust = thrust + (command - thrust) * STEP / lag
            wind += (-wind * STEP / 1.5) + gust * np.sqrt(2 * STEP / 1.5) * random.standard_normal(3)
            v = v + (thrust + GRAVITY - DRAG * (v - wind)) * STEP
            p = p + v * STEP
            look = look + (angles[k] - look) * STEP / GIMBAL_LAG
    return position, flown, looked


@pytest.mark.parametrize(("gust", "allowed"), [(0.0, 0.10), (1.0, 0.40)], ids=["still air", "gusts"])
def test_a_lagging_quadrotor_stays_on_the_trajectory(rows, gust, allowed):
    wanted, flown, _ = fly(rows, gust)
    assert np.linalg.norm(flown - wanted, axis=1).max() < allowed


def test_the_flown_camera_keeps_the_composition(plan, rows):
    """In gusts the target stays within 3 % of half a frame of where the plan shows it."""
    _, flown, looked = fly(rows, 1.0)
    drone = plan.trajectory.keyframes.mission.drones[0]
    centre = np.array(plan.trajectory.keyframes.mission.targets[0].centre)
    filmed = np.array([row["phase"] == "shot" for row in rows])
    half = np.tan(columns(rows, "hfov_rad")[:, 0] / 2)

    def project(position, angles):
        view = View(
            np.cos(angles[:, 0]), np.sin(angles[:, 0]), np.cos(angles[:, 1]), np.sin(angles[:, 1]),
            half, half / drone.aspect,
        )  # fmt: skip
        return np.array(view.project(tuple((centre - position).T))[:2])[:, filmed]

    seen = project(flown, looked)
    planned = project(columns(rows, "x_m", "y_m", "z_m"), columns(rows, "cam_yaw_rad", "cam_pitch_rad"))
    assert np.hypot(*(seen - planned)).max() < 0.03
