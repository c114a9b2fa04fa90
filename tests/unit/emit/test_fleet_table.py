"""trajectory.csv of a show: every column computed again from the control points, and who stays silent."""

from __future__ import annotations

import csv
import io
from math import pi
from pathlib import Path

import numpy as np
import pymap3d
import pytest
from scipy.interpolate import BSpline

from shotc import output
from shotc.diag.registry import registry
from shotc.emit import csv_table
from shotc.emit.csv_table import EMITTER
from shotc.emit.mavlink import EMITTER as MAVLINK
from shotc.emit.storyboard import EMITTER as STORYBOARD
from shotc.ir.fleet import Lights
from shotc.ir.light_colors import faded_colors
from shotc.ir.trajectory import VerifiedIR
from tests.support.show_plans import PADS, STEP, display, fleet, mission, plan

PLAN = plan()
CAMERA = ["cam_yaw_rad", "cam_pitch_rad", "cam_yaw_rate_rad_s", "cam_pitch_rate_rad_s", "hfov_rad"]


def rows(made: VerifiedIR) -> list[dict[str, str]]:
    files = {a.name: a.data.decode("utf-8") for a in EMITTER.emit(made).artifacts}
    assert len(files["framing.csv"].splitlines()) == 1
    return list(csv.DictReader(io.StringIO(files["trajectory.csv"])))


ROWS = rows(PLAN)


def column(name: str, of: list[dict[str, str]] = ROWS) -> np.ndarray:
    return np.array([float(row[name]) for row in of])


def test_the_header_is_the_contract() -> None:
    header = list(ROWS[0])
    assert header[:4] == ["t_s", "drone", "phase", "shot"]
    assert header[-7:] == ["hfov_rad", "lat_deg", "lon_deg", "alt_m", "red", "green", "blue"]
    bare = rows(plan(mission(origin=None)))
    assert list(bare[0])[-4:] == ["hfov_rad", "red", "green", "blue"]
    assert all(None not in row and None not in row.values() for row in (*ROWS, *bare))


def test_rows_are_sorted_by_drone_then_time() -> None:
    names = [row["drone"] for row in ROWS]
    assert names == [f"swarm-{k}" for k in range(1, 5) for _ in range(231)]
    np.testing.assert_allclose(column("t_s"), np.tile(np.arange(231) / 5, 4), atol=1e-9)
    phases = {row["t_s"]: (row["phase"], row["shot"]) for row in ROWS}
    assert phases["0"] == ("takeoff", "")
    assert phases["15.8"] == ("transit", "")
    assert phases["16"] == ("shot", "globe")
    assert phases["46"] == ("land", "")


def test_motion_is_the_spline_computed_by_scipy() -> None:
    coef = PLAN.trajectory.fleets[0].coef
    t = np.arange(231) / 5
    # Uniform breaks from 0 in steps of STEP: the knots go on evenly on both sides.
    knots = STEP * np.arange(-3, coef.shape[1] + 1)
    spline = BSpline(knots, np.moveaxis(coef, 1, 0), 3)
    for order, names in enumerate(
        (("x_m", "y_m", "z_m"), ("vx_m_s", "vy_m_s", "vz_m_s"), ("ax_m_s2", "ay_m_s2", "az_m_s2"))
    ):
        wanted = np.moveaxis(spline(t, nu=order), 0, 1).reshape(-1, 3)
        found = np.stack([column(name) for name in names], axis=1)
        np.testing.assert_allclose(found, wanted, atol=1e-7)


def test_a_fleet_faces_north_and_has_no_camera() -> None:
    np.testing.assert_allclose(column("body_yaw_rad"), pi / 2, atol=1e-8)
    assert {row[name] for row in ROWS for name in CAMERA} == {""}


def test_places_on_the_earth() -> None:
    some = ROWS[::50]
    xyz = [column(name, some) for name in ("x_m", "y_m", "z_m")]
    lat, lon, alt = pymap3d.enu2geodetic(*xyz, 47.0, 8.0, 400.0)
    np.testing.assert_allclose(column("lat_deg", some), lat, atol=1e-9)
    np.testing.assert_allclose(column("lon_deg", some), lon, atol=1e-9)
    np.testing.assert_allclose(column("alt_m", some), alt, atol=1e-5)


def test_lights_fade_between_their_times() -> None:
    at = {float(row["t_s"]): [int(row[c]) for c in ("red", "green", "blue")] for row in ROWS[:231]}
    assert at[0.0] == at[8.0] == at[38.0] == at[46.0] == [0, 0, 0]
    assert at[16.0] == at[20.0] == [255, 255, 255]
    assert at[23.0] == [255, 192, 128]
    assert at[26.0] == at[28.0] == [255, 128, 0]


def test_lights_of_one_time_or_of_a_step_stand() -> None:
    one = Lights(np.array([3.0]), np.array([[[1, 2, 3]]], dtype=np.uint8))
    np.testing.assert_array_equal(faded_colors(one, np.array([0.0, 9.0])), [[[1, 2, 3]] * 2])
    step = Lights(
        np.array([1.0, 2.0, 2.0, 3.0]), np.array([[[9, 0, 0]] * 2 + [[0, 0, 9]] * 2], dtype=np.uint8)
    )
    found = faded_colors(step, np.array([1.0, 1.9, 2.1, 3.0]))
    np.testing.assert_array_equal(found, [[[9, 0, 0]] * 2 + [[0, 0, 9]] * 2])


def test_the_last_row_is_at_rest_also_off_the_clock() -> None:
    found = rows(plan(mission(rate=3.3)))
    last = found[-1]
    assert float(last["t_s"]) >= 46.0
    assert [float(last[n]) for n in ("x_m", "y_m", "z_m", "vx_m_s", "vz_m_s", "az_m_s2")] == [
        12.0,
        0,
        0,
        0,
        0,
        0,
    ]


def test_numbers_have_nine_digits_and_no_negative_zeros() -> None:
    for row in ROWS[::17]:
        for name, cell in row.items():
            if name not in ("drone", "phase", "shot", "lat_deg", "lon_deg"):
                digits = cell.lower().split("e")[0].lstrip("-").replace(".", "").lstrip("0")
                assert len(digits) <= 9
                assert cell != "-0"


def test_fleets_and_names_of_any_text_are_kept_apart() -> None:
    other = fleet(tuple((x, y + 60.0, z) for x, y, z in PADS[:2]), "a%dim")
    both = mission(fleets=(fleet(), other), displays=(display(), display("50%", "a%dim", 1)))
    found = rows(plan(both))
    assert list(dict.fromkeys(row["drone"] for row in found)) == [
        "a%dim-1", "a%dim-2", "swarm-1", "swarm-2", "swarm-3", "swarm-4",
    ]  # fmt: skip
    assert {row["shot"] for row in found} == {"", "globe", "50%"}


@pytest.mark.parametrize("origin", [True, False])
def test_no_mission_file_is_written_for_a_fleet_and_that_is_said_once(origin: bool) -> None:
    asked = mission() if origin else mission(origin=None)
    done = MAVLINK.emit(plan(asked))
    assert done.artifacts == ()
    (told,) = done.diagnostics
    assert told.code == "E110"
    assert told.code in registry()
    assert "`swarm` (4 drones)" in told.message
    assert told.help is not None
    assert "skyc" in told.help


def test_no_storyboard_without_a_camera() -> None:
    done = STORYBOARD.emit(PLAN)
    assert done.artifacts == ()
    assert done.diagnostics == ()
    assert "storyboard.png" in done.notes[0]


def test_a_large_show_is_written_drone_by_drone(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The same bytes, of which no more than one drone's are held at a time; and how far it is, is told."""
    (whole,) = (a for a in EMITTER.emit(PLAN).artifacts if a.name == "trajectory.csv")
    monkeypatch.setattr(csv_table, "MANY_DRONES", len(PADS) - 1)
    (large,) = (a for a in EMITTER.emit(PLAN).artifacts if a.name == "trajectory.csv")
    assert large.data == b""
    parts = [len(part) for part in large.chunks()]
    assert len(parts) == 1 + len(PADS)
    assert max(parts) < len(whole.data) / 2
    monkeypatch.setattr(output, "TELL_BYTES", max(parts))
    told: list[str] = []
    paths, faults = output.write([large], tmp_path, told.append)
    assert not faults
    assert paths[0].read_bytes() == whole.data
    assert told
    assert all(text.startswith("writing trajectory.csv") for text in told)
