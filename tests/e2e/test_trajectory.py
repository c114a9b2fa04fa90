"""trajectory.csv against limits, zones and calculus, from its numbers alone.

What holds for every instant holds for the differences of the samples: a mean rate never exceeds the
largest rate. The differences are taken here, so nothing is believed that the file says about itself.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from shotc.geom.bernstein import Array
from shotc.ir.drone import Drone
from shotc.ir.mission import GeoOrigin
from shotc.ir.target import Target
from tests.e2e.conftest import Plan, Planned, each_mission
from tests.support.csv_tables import Table
from tests.support.solid_distances import signed_distance
from tests.support.written_missions import Course

pytestmark = pytest.mark.parametrize("path", each_mission())

COLUMNS = (
    "t_s,drone,phase,shot,x_m,y_m,z_m,vx_m_s,vy_m_s,vz_m_s,ax_m_s2,ay_m_s2,az_m_s2,"
    "body_yaw_rad,cam_yaw_rad,cam_pitch_rad,cam_yaw_rate_rad_s,cam_pitch_rate_rad_s,hfov_rad"
)
EFFORT = ",tilt_rad,thrust_to_weight,airspeed_m_s,power_w"
POSITION = ("x_m", "y_m", "z_m")
VELOCITY = ("vx_m_s", "vy_m_s", "vz_m_s")
ACCELERATION = ("ax_m_s2", "ay_m_s2", "az_m_s2")
# Nine digits of some hundred metres or some radians, differenced once or twice at the output rate.
ROUNDING, ROUNDING_TWICE = 1e-4, 5e-3


def flown(plan: Plan, path: Path) -> Iterator[tuple[Planned, Drone, Table, float]]:
    """Every drone's rows, and the seconds between two of them."""
    planned = plan(path)
    assert set(planned.flights) == set(planned.written["drones"])
    for name, table in planned.flights.items():
        yield planned, planned.mission.drone(name), table, 1 / planned.mission.rate


def rates(table: Table, step: float, *names: str) -> Array:
    """Mean rates between samples, shape (M - 1, names); the last sample is at rest whenever that is."""
    return np.diff(table.numbers(*names), axis=0)[:-1] / step


def largest(values: Array) -> float:
    return float(np.abs(values).max())


def test_columns_and_clock(plan: Plan, path: Path) -> None:
    for planned, drone, table, step in flown(plan, path):
        geodetic = ",lat_deg,lon_deg,alt_m" if planned.mission.origin else ""
        assert table.header == tuple((COLUMNS + geodetic + EFFORT).split(","))
        assert table["t_s"] == pytest.approx(np.arange(len(table)) * step, abs=1e-9)
        end = planned.tracks[drone.name].curve.end
        assert (len(table) - 2) * step < end <= (len(table) - 1) * step + 1e-9
    planned = plan(path)
    assert planned.motion["drone"].tolist() == sorted(planned.motion["drone"])
    assert all(len(cell.lstrip("-0.").replace(".", "").split("e")[0]) <= 9 for cell in cells(planned))


def cells(planned: Planned) -> list[str]:
    """Some numbers as they are written, degrees left out."""
    rows = planned.files["trajectory.csv"].decode().splitlines()[1::97]
    return [cell for row in rows for i, cell in enumerate(row.split(",")[:19]) if i not in (1, 2, 3)]


def test_phases_follow_one_another(plan: Plan, path: Path) -> None:
    for planned, drone, table, _ in flown(plan, path):
        changes = [0, *(np.flatnonzero((table["phase"][1:] != table["phase"][:-1]) | new_shot(table)) + 1)]
        order = [(str(table["phase"][i]), str(table["shot"][i])) for i in changes]
        assert [order[0], *order[-2:]] == [("takeoff", ""), ("return", ""), ("land", "")]
        assert {phase for phase, _ in order[1:-2]} <= {"transit", "shot"}
        own = [shot["id"] for shot in planned.written["shots"] if planned.filmed_by[shot["id"]] == drone.name]
        assert [shot for phase, shot in order if phase == "shot"] == own


def new_shot(table: Table) -> Array:
    return np.asarray(table["shot"][1:] != table["shot"][:-1])


def test_it_starts_and_ends_at_rest_at_home(plan: Plan, path: Path) -> None:
    for _, drone, table, _ in flown(plan, path):
        home = drone.home
        for row in (0, -1):
            assert table.numbers(*POSITION)[row] == pytest.approx(home, abs=1e-6)
            assert table.numbers(*VELOCITY)[row] == pytest.approx([0, 0, 0], abs=1e-9)
            assert table.numbers("cam_yaw_rate_rad_s", "cam_pitch_rate_rad_s")[row] == pytest.approx(
                0, abs=1e-9
            )
        assert table.numbers(*ACCELERATION)[-1] == pytest.approx([0, 0, 0], abs=1e-9)


def test_take_off_and_landing_are_vertical_at_home(plan: Plan, path: Path) -> None:
    for _, drone, table, _ in flown(plan, path):
        home = drone.home
        for phase in ("takeoff", "land"):
            x, y, z = table.where(phase=phase).numbers(*POSITION).T
            assert np.hypot(x - home[0], y - home[1]).max() < 1e-5
            assert z.min() > home[2] - 1e-5
            assert (np.diff(z) * (1 if phase == "takeoff" else -1) > -1e-6).all()


def test_tilt_and_thrust_are_those_of_the_acceleration_and_weight(plan: Plan, path: Path) -> None:
    for _, drone, table, _ in flown(plan, path):
        a, b, c = table.numbers(*ACCELERATION).T
        assert table["tilt_rad"] == pytest.approx(np.arctan2(np.hypot(a, b), c + 9.80665), abs=1e-7)
        pushed = np.sqrt(a * a + b * b + (c + 9.80665) ** 2) / 9.80665
        assert table["thrust_to_weight"] == pytest.approx(pushed, abs=1e-7)
        if not any(drone.limits.wind) and not np.isnan(table["airspeed_m_s"]).any():
            across = np.hypot(*table.numbers(*VELOCITY[:2]).T)
            assert table["airspeed_m_s"] == pytest.approx(across, abs=1e-7)
        assert np.isnan(table["power_w"]).all() == (drone.power is None)


def test_velocity_and_acceleration_are_the_derivatives_of_position(plan: Plan, path: Path) -> None:
    """The corrected trapezoid of a smooth function errs by h^5; a jump of one derivative shows at once."""
    for _, drone, table, step in flown(plan, path):
        jerk = drone.limits.jerk
        x, v, a = (table.numbers(*names)[:-1] for names in (POSITION, VELOCITY, ACCELERATION))
        gained = np.diff(x, axis=0) - step / 2 * (v[1:] + v[:-1]) + step**2 / 12 * np.diff(a, axis=0)
        # What remains is the third derivative's variation over one step, which the jerk limit bounds.
        assert largest(gained) < step**3 / 12 * jerk + 1e-6
        quickened = np.diff(v, axis=0) - step / 2 * (a[1:] + a[:-1])
        assert largest(quickened) < step**2 / 4 * jerk + 1e-6
        for name in ("cam_yaw", "cam_pitch"):
            angle, rate = table[f"{name}_rad"][:-1], table[f"{name}_rate_rad_s"][:-1]
            assert largest(np.diff(angle) - step / 2 * (rate[1:] + rate[:-1])) < 1e-3 * step


def test_speeds_and_accelerations_keep_their_limits(plan: Plan, path: Path) -> None:
    for _, drone, table, step in flown(plan, path):
        limits = drone.limits
        for vx, vy, vz in (table.numbers(*VELOCITY).T, rates(table, step, *POSITION).T):
            assert np.hypot(vx, vy).max() <= limits.speed + ROUNDING
            assert vz.max() <= limits.climb + ROUNDING
            assert -vz.min() <= limits.descent + ROUNDING
        for a in (table.numbers(*ACCELERATION), rates(table, step, *VELOCITY)):
            assert np.linalg.norm(a, axis=1).max() <= limits.acceleration + ROUNDING
        assert np.linalg.norm(rates(table, step, *ACCELERATION), axis=1).max() <= limits.jerk + ROUNDING


def test_body_and_gimbal_keep_their_limits(plan: Plan, path: Path) -> None:
    for _, drone, table, step in flown(plan, path):
        body, pitch = table["body_yaw_rad"], table["cam_pitch_rad"]
        gimbal = table["cam_yaw_rad"] - body
        for angle, allowed in ((gimbal, drone.gimbal.yaw), (pitch, drone.gimbal.pitch)):
            assert allowed[0] - 1e-6 <= angle.min() <= angle.max() <= allowed[1] + 1e-6
        axes = (
            (body, drone.limits.yaw_rate, drone.limits.yaw_acceleration),
            (gimbal, drone.gimbal.rate, drone.gimbal.acceleration),
            (pitch, drone.gimbal.rate, drone.gimbal.acceleration),
        )
        for angle, rate, acceleration in axes:
            assert largest(np.diff(angle)) / step <= rate + ROUNDING
            assert largest(np.diff(angle, 2)[:-1]) / step**2 <= acceleration + ROUNDING_TWICE


def test_zones_ground_and_targets_are_kept_clear(plan: Plan, path: Path) -> None:
    for planned, drone, table, _ in flown(plan, path):
        mission, radius = planned.mission, drone.radius
        upright = np.isin(table["phase"], ["takeoff", "land"])
        free = table.numbers(*POSITION)[~upright]
        assert free[:, 2].min() >= mission.rules.ground_clearance + radius - 1e-5
        for zone in mission.zones:
            away = signed_distance(zone.solid, free)
            if zone.keep == "out":
                everywhere = signed_distance(zone.solid, table.numbers(*POSITION))
                assert min(away.min(), everywhere.min()) >= radius - 1e-5, zone.name
            else:
                assert away.max() <= -radius + 1e-5, zone.name
        for target in mission.targets:
            away = from_target(target, planned.courses[target.name], table)
            assert away[~upright].min() >= radius + mission.rules.target_clearance - 1e-5, target.name
            assert away.min() >= radius - 1e-5, target.name


def from_target(target: Target, course: Course, table: Table) -> Array:
    """The distance to a target's cylinder, where that is at the time of each row."""
    x, y, z = (table.numbers(*POSITION) - course.at(table["t_s"])).T
    sideways, upwards = np.hypot(x, y) - target.radius, np.abs(z) - target.height / 2
    return np.hypot(np.maximum(sideways, 0), np.maximum(upwards, 0))


def test_latitude_longitude_and_altitude(plan: Plan, path: Path) -> None:
    for planned, _, table, _ in flown(plan, path):
        origin = planned.mission.origin
        if origin is None:
            continue
        back = east_north_up(origin, table.numbers("lat_deg", "lon_deg", "alt_m"))
        assert back == pytest.approx(table.numbers(*POSITION), abs=0.002)


def east_north_up(origin: GeoOrigin, places: Array) -> Array:
    """Through the Earth's centre and back, with WGS84's axes; the places' last columns are degrees and m."""
    start = earth_fixed(np.array([[origin.lat_deg, origin.lon_deg, origin.alt]]))
    lat, lon = np.radians([origin.lat_deg, origin.lon_deg])
    east = np.array([-np.sin(lon), np.cos(lon), 0])
    up = np.array([np.cos(lat) * np.cos(lon), np.cos(lat) * np.sin(lon), np.sin(lat)])
    return np.asarray((earth_fixed(places) - start) @ np.stack([east, np.cross(up, east), up], axis=1))


def earth_fixed(places: Array) -> Array:
    lat, lon, height = np.radians(places[:, 0]), np.radians(places[:, 1]), places[:, 2]
    a, f = 6378137.0, 1 / 298.257223563
    e2 = f * (2 - f)
    across = a / np.sqrt(1 - e2 * np.sin(lat) ** 2)
    return np.stack(
        [
            (across + height) * np.cos(lat) * np.cos(lon),
            (across + height) * np.cos(lat) * np.sin(lon),
            (across * (1 - e2) + height) * np.sin(lat),
        ],
        axis=1,
    )
