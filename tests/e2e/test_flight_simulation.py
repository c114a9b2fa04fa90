"""Rows of trajectory.csv, every drone's, flown by a quadrotor with thrust and attitude lag in gusty wind."""

from __future__ import annotations

import csv
import io
from dataclasses import dataclass

import numpy as np
import pytest

from shotc.geom.camera import View
from tests.e2e.conftest import ROOT
from tests.support import written_missions

pytestmark = pytest.mark.slow

GRAVITY = np.array([0.0, 0.0, -9.81])
STEP = 0.005
ATTITUDE_LAG, THRUST_LAG, GIMBAL_LAG = 0.08, 0.05, 0.05
DRAG = 0.25
"""Specific drag, 1/s, of a multirotor of about 2 kg."""


@dataclass(frozen=True)
class Allowed:
    """How far a drone may be off in still air, metres, and its target on screen in gusts, half frames."""

    still: float
    screen: float


ALLOWED = {
    "tower-reveal": Allowed(0.10, 0.03),
    # Higher jerk; and the runner is near: 0.2 m at 7 m are 0.07 of half a frame's height.
    "rotsee-sculler": Allowed(0.16, 0.03),
    "runner-three-cameras": Allowed(0.12, 0.08),
}
FLOWN = [
    pytest.param((name, drone), id=f"{name}-{drone}", marks=pytest.mark.xdist_group(name))
    for name in ALLOWED
    for drone in written_missions.read(ROOT / "specs" / f"{name}.yaml")["drones"]
]


@pytest.fixture(params=FLOWN)
def flight(request, plan):
    """The mission, planned; the name of one of its drones, and its rows of trajectory.csv."""
    name, drone = request.param
    planned = plan(ROOT / "specs" / f"{name}.yaml")
    rows = list(csv.DictReader(io.StringIO(planned.files["trajectory.csv"].decode())))
    return planned, drone, [row for row in rows if row["drone"] == drone]


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


@pytest.mark.long
@pytest.mark.parametrize("gust", [0.0, 1.0], ids=["still air", "gusts"])
def test_a_lagging_quadrotor_stays_on_the_trajectory(flight, gust):
    planned, _, rows = flight
    wanted, flown, _ = fly(rows, gust)
    allowed = 0.40 if gust else ALLOWED[planned.path.stem].still
    assert np.linalg.norm(flown - wanted, axis=1).max() < allowed


def test_the_flown_camera_keeps_the_composition(flight):
    """In gusts the target stays within a few hundredths of half a frame of where the plan shows it."""
    planned, name, rows = flight
    _, flown, looked = fly(rows, 1.0)
    drone = planned.mission.drone(name)
    (course,) = planned.courses.values()
    centre = course.at(columns(rows, "t_s")[:, 0])
    filmed = np.array([row["phase"] == "shot" for row in rows])
    half = np.tan(columns(rows, "hfov_rad")[:, 0] / 2)

    def project(position, angles):
        view = View(
            np.cos(angles[:, 0]), np.sin(angles[:, 0]), np.cos(angles[:, 1]), np.sin(angles[:, 1]),
            half, half / drone.aspect,
        )  # fmt: skip
        return np.array(view.project(tuple((centre - position).T))[:2])[:, filmed]

    seen = project(flown, looked)
    wanted = project(columns(rows, "x_m", "y_m", "z_m"), columns(rows, "cam_yaw_rad", "cam_pitch_rad"))
    assert np.hypot(*(seen - wanted)).max() < ALLOWED[planned.path.stem].screen
