"""The tables: headers, rows, clock, order, digits, and numbers that agree with each other."""

import csv
import io
from math import hypot, pi

import numpy as np
import pymap3d
import pytest

from shotc.emit.csv_table import EMITTER
from shotc.geom.bernstein import Piecewise
from shotc.geom.solids import box
from shotc.ir.mission import Zone
from shotc.ir.path import CAM_YAW
from shotc.ir.sampling import clock, phase_index
from shotc.ir.trajectory import VerifiedIR
from tests.support.film_plans import orbit_plan
from tests.support.records import replace

HEADER = (
    "t_s,drone,phase,shot,x_m,y_m,z_m,vx_m_s,vy_m_s,vz_m_s,ax_m_s2,ay_m_s2,az_m_s2,body_yaw_rad,cam_yaw_rad,"
    "cam_pitch_rad,cam_yaw_rate_rad_s,cam_pitch_rate_rad_s,hfov_rad"
)
PLAN = orbit_plan()


def tables(plan: VerifiedIR) -> tuple[list[dict[str, str]], list[dict[str, str]]]:
    files = {a.name: a.data.decode("utf-8") for a in EMITTER.emit(plan).artifacts}
    assert list(files) == ["trajectory.csv", "framing.csv"]
    motion, framing = (list(csv.DictReader(io.StringIO(files[name]))) for name in files)
    return motion, framing


MOTION, SEEN = tables(PLAN)


def column(rows: list[dict[str, str]], name: str) -> np.ndarray:
    return np.array([float(row[name]) for row in rows])


def with_mission(plan: VerifiedIR, **changes: object) -> VerifiedIR:
    ir = plan.trajectory
    mission = replace(ir.keyframes.mission, **changes)
    return VerifiedIR(replace(ir, keyframes=replace(ir.keyframes, mission=mission)), plan.certificate)


@pytest.mark.slow
def test_headers_are_the_contract() -> None:
    motion, framing = (a.data.decode() for a in EMITTER.emit(PLAN).artifacts)
    effort = ",tilt_rad,thrust_to_weight,airspeed_m_s,power_w"
    assert motion.splitlines()[0] == HEADER + ",lat_deg,lon_deg,alt_m" + effort
    assert framing.splitlines()[0] == "t_s,drone,shot,target,u,v,u_ref,v_ref,size,in_frame,occluded,covered"
    bare = EMITTER.emit(orbit_plan(origin=False)).artifacts[0].data.decode()
    assert bare.splitlines()[0] == HEADER + effort
    assert "\r" not in motion
    assert motion.endswith("\n")


def test_rows_stand_on_the_common_clock() -> None:
    t = column(MOTION, "t_s")
    np.testing.assert_allclose(t, np.arange(6101) / 50, atol=1e-12)
    assert [row["phase"] for row in MOTION[::800]] == [
        "takeoff", "transit", "shot", "shot", "return", "return", "return", "land",
    ]  # fmt: skip
    assert {row["shot"] for row in MOTION if row["phase"] == "shot"} == {"half"}
    assert {row["shot"] for row in MOTION if row["phase"] != "shot"} == {""}
    # A boundary belongs to the phase that begins there.
    assert [MOTION[k]["phase"] for k in (399, 400, 1099, 1100, 2599, 2600)] == [
        "takeoff", "transit", "transit", "shot", "shot", "return",
    ]  # fmt: skip


def test_the_last_row_is_at_rest_also_off_the_clock() -> None:
    motion, _ = tables(with_mission(PLAN, rate=7.0))
    assert len(motion) == 122 * 7 + 1
    motion, _ = tables(with_mission(PLAN, rate=6.1))
    assert float(motion[-1]["t_s"]) == pytest.approx(745 / 6.1, abs=1e-6)
    assert float(motion[-1]["t_s"]) >= 122
    for name in ("vx_m_s", "vy_m_s", "vz_m_s", "ax_m_s2", "ay_m_s2", "az_m_s2", "cam_yaw_rate_rad_s"):
        assert float(motion[-1][name]) == 0
    assert [float(motion[-1][n]) for n in ("x_m", "y_m", "z_m")] == [0, -60, 0]


def test_derivatives_and_yaw_agree_with_the_positions() -> None:
    for axis in "xyz":
        x, v, a = (column(MOTION, f"{p}{axis}_{u}") for p, u in (("", "m"), ("v", "m_s"), ("a", "m_s2")))
        np.testing.assert_allclose((x[2:] - x[:-2]) * 25, v[1:-1], atol=3e-4)
        np.testing.assert_allclose((v[2:] - v[:-2]) * 25, a[1:-1], atol=3e-3)
    yaw = column(MOTION, "cam_yaw_rad")
    assert np.abs(np.diff(yaw)).max() < 0.1  # continuous through pi
    assert yaw.max() > pi
    np.testing.assert_allclose(
        (yaw[2:] - yaw[:-2]) * 25, column(MOTION, "cam_yaw_rate_rad_s")[1:-1], atol=1e-4
    )


def test_geodetic_columns_invert() -> None:
    lat, lon, alt = (column(MOTION, name) for name in ("lat_deg", "lon_deg", "alt_m"))
    enu = pymap3d.geodetic2enu(lat, lon, alt, 47.3769, 8.5417, 408.0)
    for axis, found in zip("xyz", enu, strict=True):
        np.testing.assert_allclose(found, column(MOTION, f"{axis}_m"), atol=1e-3)


def test_nine_significant_digits() -> None:
    row = MOTION[1737]
    exact = PLAN.trajectory.drones[0].curve(1737 / 50)
    for name, value in zip(("x_m", "y_m", "z_m", "cam_yaw_rad", "cam_pitch_rad"), exact, strict=False):
        assert row[name] == f"{value:.9g}"
    assert not any(cell == "-0" for row in MOTION for cell in row.values())


def test_framing_rows_are_the_samples_of_the_shot() -> None:
    assert len(SEEN) == 1500  # 22.00 s to 51.98 s: the tick at the end belongs to the way home
    assert {(r["drone"], r["shot"], r["target"]) for r in SEEN} == {("cam1", "half", "tower")}
    u, v = column(SEEN, "u"), column(SEEN, "v")
    assert max(map(hypot, u, v)) < 1e-9
    assert {(r["u_ref"], r["v_ref"], r["in_frame"], r["occluded"]) for r in SEEN} == {("0", "0", "1", "0")}
    # 24 m of tower, from 40 m and 8 m above its middle.
    assert column(SEEN, "size") == pytest.approx(0.8101, abs=1e-4)


@pytest.mark.slow
def test_behind_the_camera_cells_are_empty_and_flags_are_not() -> None:
    track = PLAN.trajectory.drones[0]
    ctrl = track.curve.ctrl.copy()
    ctrl[..., CAM_YAW] += pi
    away = replace(track, curve=Piecewise(track.curve.breaks, ctrl), framing=())
    _, seen = tables(VerifiedIR(replace(PLAN.trajectory, drones=(away,)), ()))
    assert len(seen) == 1500  # the shot still names its target
    assert {tuple(r[c] for c in ("u", "v", "u_ref", "v_ref", "size")) for r in seen} == {("",) * 5}
    assert {r["in_frame"] for r in seen} == {"0"}


@pytest.mark.slow
def test_flags_follow_the_scene() -> None:
    mission = PLAN.trajectory.keyframes.mission
    screen = Zone("screen", "out", box((30.0, 0.0, 10), (1, 4, 20), 0), ("world", "zones", "screen"))
    _, seen = tables(with_mission(PLAN, zones=(*mission.zones, screen)))
    hidden = column(seen, "occluded")
    assert 0 < hidden.sum() < 300
    assert hidden[700:800].any()  # at the middle, east of the tower
    narrow = with_mission(PLAN, drones=(replace(mission.drones[0], aspect=16 / 4),))
    assert not column(tables(narrow)[1], "in_frame").any()


@pytest.mark.slow
def test_drones_are_sorted_and_every_one_has_its_own_end() -> None:
    track = PLAN.trajectory.drones[0]
    short = Piecewise(track.curve.breaks[:3], track.curve.ctrl[:2])
    other = replace(track, drone="a", curve=short, phases=track.phases[:2], framing=(), keyframes=())
    mission = PLAN.trajectory.keyframes.mission
    drones = (mission.drones[0], replace(mission.drones[0], name="a"))
    both = with_mission(VerifiedIR(replace(PLAN.trajectory, drones=(track, other)), ()), drones=drones)
    motion, _ = tables(both)
    names = [row["drone"] for row in motion]
    assert names == sorted(names)
    assert float(motion[names.count("a") - 1]["t_s"]) == 22.0
    assert float(motion[names.count("a")]["t_s"]) == 0.0


@pytest.mark.slow
def test_the_same_bytes_twice() -> None:
    assert EMITTER.emit(orbit_plan()) == EMITTER.emit(orbit_plan())


def test_clock_and_phases_at_boundaries() -> None:
    assert list(clock(50, 0.1)) == [0.0, 0.02, 0.04, 0.06, 0.08, 0.1]
    assert clock(50, 0.1 + 1e-12)[-1] == 0.1
    assert clock(50, 0.1001)[-1] == 0.12
    assert clock(3, 1.0)[-1] == 1.0
    phases = PLAN.trajectory.drones[0].phases
    assert list(phase_index(phases, np.array([0.0, 8.0 - 1e-12, 8.0, 7.99, 122.0, 130.0]))) == [
        0,
        1,
        1,
        0,
        4,
        4,
    ]
