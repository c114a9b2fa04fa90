"""The shows of the tree, through the command: what their files say is what the missions ask."""

from __future__ import annotations

import io
import json
from base64 import b64decode
from itertools import pairwise
from typing import Any

import numpy as np
import pytest

from shotc.geom.bernstein import Array
from shotc.geom.solids import Cylinder
from shotc.ir.mission import GeoOrigin
from tests.e2e.conftest import SHOWS
from tests.e2e.test_trajectory import COLUMNS, east_north_up
from tests.support import show_files, skyc_reader, written_missions
from tests.support.command import run
from tests.support.lakeside_show import COLORS, DIGITS, LAKE, POSITION, Show, asked
from tests.support.skyc_reader import color_at, place_at
from tests.support.solid_distances import signed_distance

pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("shows")]

OUTPUTS = {
    "plan.json",
    "trajectory.csv",
    "framing.csv",
    "lakeside-show.skyc",
    "contact-sheet.png",
    "animatic.gif",
    "mission.rrd",
}
VELOCITY = ("vx_m_s", "vy_m_s", "vz_m_s")
ACCELERATION = ("ax_m_s2", "ay_m_s2", "az_m_s2")


def test_every_show_of_the_tree_is_tested_here() -> None:
    elsewhere = {"elbe-lights", "harbour-letters"}  # test_light_effects.py, test_filmed_shows.py
    assert {path.stem for path in SHOWS if path.parent == LAKE.parent} == {LAKE.stem, *elsewhere}


def test_check_says_nothing(show: Show) -> None:
    done = run("check", LAKE.name, "--format", "concise", folder=show.folder)
    assert (done.code, done.out) == (0, "")


def test_all_outputs_are_made(show: Show) -> None:
    assert {path.name for path in show.out.iterdir()} == OUTPUTS
    assert "1 display of 200 drones" in show.said
    assert (
        show.bytes("framing.csv") == b"t_s,drone,shot,target,u,v,u_ref,v_ref,size,in_frame,occluded,covered\n"
    )
    assert show.bytes("mission.rrd").startswith(b"RRF")


def test_the_contact_sheet_is_a_picture(show: Show) -> None:
    from matplotlib.image import imread

    data = show.bytes("contact-sheet.png")
    picture = imread(io.BytesIO(data))
    wide, high = (int.from_bytes(data[k : k + 4]) for k in (16, 20))
    assert picture.shape[:2] == (high, wide)
    assert wide == 16 * 120  # inches, at so many dots each
    assert (picture[..., :3].max(axis=2) < 0.25).mean() > 0.2  # it is night


@pytest.mark.long
def test_the_plan_is_proved_from_its_bytes(show: Show) -> None:
    done = run("verify", "out", "--format", "json", folder=show.folder)
    assert done.code == 0
    report = json.loads(done.out)
    assert report["holds"]
    assert len(report["certificate"]) == len(show.document["certificate"])


@pytest.mark.long
def test_a_second_run_gives_the_same_bytes(show: Show) -> None:
    done = run("plan", LAKE.name, "-o", "again", "--emit", "csv", "--jobs", "1", folder=show.folder)
    assert done.code == 0
    for name in ("plan.json", "trajectory.csv", "framing.csv"):
        assert (show.folder / "again" / name).read_bytes() == show.bytes(name), name


@pytest.mark.long
def test_a_drone_moved_by_hand_is_noticed(show: Show) -> None:
    """Two drones are put near each other in the middle of a picture."""
    document = json.loads(show.bytes("plan.json"))
    (flight,) = document["fleets"]
    middle = len(flight["breaks"]) // 2
    for k in range(middle, middle + 4):
        flight["coef"][1][k] = [flight["coef"][0][k][0] + 0.5, *flight["coef"][0][k][1:]]
    (show.folder / "moved.json").write_text(json.dumps(document))
    done = run("verify", "moved.json", folder=show.folder)
    assert done.code == 1
    assert "V022" in {report.code for report in done.errors}


# What trajectory.csv says.


def test_columns_and_clock(show: Show) -> None:
    assert show.rows.table.header == tuple((COLUMNS + ",lat_deg,lon_deg,alt_m,red,green,blue").split(","))
    assert show.rows.names == [f"swarm-{k:03d}" for k in range(1, 201)]
    t = show.rows["t_s"]
    assert np.ptp(t, axis=0).max() == 0
    assert t[0] == pytest.approx(np.arange(t.shape[1]) / 5)
    assert t[0, -2] < show.fleet.end <= t[0, -1] + 1e-9
    for name in ("cam_yaw_rad", "cam_pitch_rad", "hfov_rad"):
        assert np.isnan(show.rows[name]).all()


def test_phases_follow_one_another(show: Show) -> None:
    phases, shots = show.rows["phase"], show.rows["shot"]
    assert (phases == phases[0]).all()
    assert (shots == shots[0]).all()
    order = [(p, s) for p, s in zip(phases[0], shots[0], strict=True)]
    assert list(dict.fromkeys(order)) == [
        ("takeoff", ""),
        ("transit", ""),
        ("shot", "shapes"),
        ("return", ""),
        ("land", ""),
    ]
    changes = sum(a != b for a, b in pairwise(order))
    assert changes == 4


def test_drones_start_and_end_at_rest_on_the_pads(show: Show) -> None:
    pads = grid(show.mission["fleets"]["swarm"])
    places = show.rows[POSITION]
    assert places[:, 0] == pytest.approx(pads, abs=1e-6)
    # Whoever is nearer lands on a pad: each on one, none on two.
    last = places[:, -1]
    at = np.linalg.norm(last[:, None] - pads, axis=2)
    assert at.min(axis=1).max() < 1e-5
    assert sorted(at.argmin(axis=1)) == list(range(len(pads)))
    for row in (0, -1):
        assert np.abs(show.rows[VELOCITY][:, row]).max() < 1e-9
    assert np.abs(show.rows[ACCELERATION][:, -1]).max() < 1e-9


def grid(fleet: dict[str, Any]) -> Array:
    """The pads of a square grid, eastwards row by row."""
    of = fleet["layout"]["grid"]
    wide = int(np.ceil(np.sqrt(fleet["count"])))
    k = np.arange(fleet["count"])
    return np.asarray(np.stack([k % wide, k // wide, 0 * k], axis=1) * of["spacing"] + of["origin"])


def test_take_off_and_landing_are_vertical(show: Show) -> None:
    rise = written_missions.number(show.mission["fleets"]["swarm"]["rise"])
    places = show.rows[POSITION]
    for phase, sign, end in (("takeoff", 1, 0), ("land", -1, -1)):
        during = places[:, show.rows["phase"][0] == phase]
        assert np.ptp(during[..., :2], axis=1).max() < DIGITS
        assert np.abs(during[..., :2] - places[:, None, end, :2]).max() < DIGITS
        assert (sign * np.diff(during[..., 2], axis=1)).min() > -1e-6
        assert during[..., 2].max() <= rise + DIGITS
        start, stop = show.fleet.phase(phase)
        top = show.fleet.spline(stop if phase == "takeoff" else start)
        assert top[:, 2] == pytest.approx(rise, abs=1e-6)


def test_velocity_and_acceleration_are_the_derivatives_of_position(show: Show) -> None:
    """As of cameras (test_trajectory.py): what remains is bounded by the jerk limit."""
    step, jerk = 0.2, show.fleet.asked["limits"]["jerk"]
    x, v, a = (show.rows[names][:, :-1] for names in (POSITION, VELOCITY, ACCELERATION))
    gained = np.diff(x, axis=1) - step / 2 * (v[:, 1:] + v[:, :-1]) + step**2 / 12 * np.diff(a, axis=1)
    assert np.abs(gained).max() < step**3 / 12 * jerk + 1e-6
    quickened = np.diff(v, axis=1) - step / 2 * (a[:, 1:] + a[:, :-1])
    assert np.abs(quickened).max() < step**2 / 4 * jerk + 1e-6


def test_the_table_is_the_plan(show: Show) -> None:
    t = show.rows["t_s"][0, :-1]
    for order, names in enumerate((POSITION, VELOCITY, ACCELERATION)):
        planned = show.fleet.spline.derivative(order)(t) if order else show.fleet.spline(t)
        assert np.abs(np.swapaxes(planned, 0, 1) - show.rows[names][:, :-1]).max() < DIGITS


def test_limits_are_kept(show: Show) -> None:
    assert max(show_files.beyond_limits(show.fleet).values()) <= 1 + 1e-9
    limits = show.fleet.asked["limits"]
    v, a = show.rows[VELOCITY], show.rows[ACCELERATION]
    assert np.hypot(v[..., 0], v[..., 1]).max() <= limits["speed"] + DIGITS
    assert v[..., 2].max() <= limits["climb"] + DIGITS
    assert -v[..., 2].min() <= limits["descent"] + DIGITS
    assert np.linalg.norm(a, axis=2).max() <= limits["acceleration"] + DIGITS
    assert show.fleet.end <= show.fleet.asked["endurance"]


def test_zones_and_ground_are_kept_clear(show: Show) -> None:
    radius = show.fleet.asked["radius"]
    places = show.rows[POSITION]
    free = places[:, ~np.isin(show.rows["phase"][0], ["takeoff", "land"])].reshape(-1, 3)
    assert free[:, 2].min() >= show.document["mission"]["rules"]["ground_clearance"] + radius - DIGITS
    for name, zone in show.mission["world"]["zones"].items():
        of = zone["cylinder"]
        solid = Cylinder(tuple(of["center"]), of["radius"], *of["height"])
        if zone["keep"] == "out":
            assert signed_distance(solid, places.reshape(-1, 3)).min() >= radius - DIGITS, name
        else:
            assert signed_distance(solid, free).max() <= -radius + DIGITS, name


def test_latitude_longitude_and_altitude(show: Show) -> None:
    of = show.mission["world"]["origin"]
    origin = GeoOrigin(of["lat"], of["lon"], of["alt"])
    earth = show.rows[("lat_deg", "lon_deg", "alt_m")][::9].reshape(-1, 3)
    back = east_north_up(origin, earth)
    assert np.abs(back - show.rows[POSITION][::9].reshape(-1, 3)).max() < 0.002


# What separation is kept.


def test_all_pairs_keep_the_separation_all_the_time(show: Show) -> None:
    """Of all pairs, at fifty instants a second, from the splines of the plan."""
    across, upright = asked(show)
    of = show.fleet.asked["apart"]
    assert (of["shape"], of["horizontal"] + of["margin"]) == ("ellipsoid", pytest.approx(across))
    assert of["vertical"] + of["margin"] == pytest.approx(upright)
    assert show.fleet.apart.min() >= 1
    assert (np.diff(show.fleet.times) <= 0.02).all()


def test_the_certificate_is_what_is_flown(show: Show) -> None:
    across, _ = asked(show)
    claim = show.claim("separation")
    assert claim["holds"]
    assert claim["limit"] == pytest.approx(across)
    # Proved for every instant, so never above what is sampled; and attained, so hardly below.
    sampled = show.fleet.apart.min() * across
    assert sampled - 1e-3 < claim["worst"] <= sampled + 1e-9
    k = int(np.argmin(show.fleet.apart))
    assert show.fleet.times[k] == pytest.approx(claim["time"], abs=0.05)
    first, second = (show.rows.names.index(name) for name in claim["drones"])
    pair = show.fleet.spline(claim["time"])[[first, second]][None]
    assert show_files.nearest(pair, show.fleet.asked["apart"])[0] * across == pytest.approx(
        claim["worst"], abs=1e-5
    )
    limits = show.fleet.asked["limits"]
    for name, share in show_files.beyond_limits(show.fleet).items():
        worst = show.claim(name)["worst"]
        assert share * limits[name] <= worst + 1e-9, name
        assert worst <= share * limits[name] * 1.02 + 1e-3, name


# What is made of it.


def test_the_show_file_flies_the_plan(show: Show) -> None:
    content = skyc_reader.read(show.bytes("lakeside-show.skyc"))
    drones = content["swarm"]["drones"]
    assert [drone["settings"]["name"] for drone in drones] == show.rows.names
    t = show.rows["t_s"][0]
    for k in range(0, len(drones), 23):
        settings = drones[k]["settings"]
        for at in range(3, len(t), 11):
            north, west, up = place_at(settings["trajectory"], t[at])
            assert [-west, north, up] == pytest.approx(show.rows[POSITION][k, at], abs=2e-3)
    code = b64decode(drones[0]["settings"]["lights"]["data"])
    for stands, color in zip(show.fleet.flight["shown"], COLORS, strict=True):
        assert color_at(code, (stands["start"] + stands["end"]) / 2) == color


@pytest.mark.long
def test_drones_that_lag_and_are_blown_about_keep_what_is_asked(show: Show) -> None:
    """Without the margin, which is there to be used up."""
    options = ("--gusts", "0.3", "--seeds", "1", "-o", "flown", "--format", "json")
    done = run("simulate", "out", *options, folder=show.folder)
    assert done.code == 0, done.err
    (course,) = json.loads(done.out)["runs"][0]["fleets"]
    assert course["flown"]["near"]["below"] == 0
    assert course["flown"]["near"]["distance"] >= 1.2
