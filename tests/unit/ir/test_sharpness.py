"""Depth of field and motion blur of plans, recomputed from their tables; bad input of focus and exposure."""

from __future__ import annotations

import csv
import io
from functools import cache
from math import hypot, radians, tan

import numpy as np
import pytest

from shotc import api
from shotc.ir.trajectory import VerifiedIR
from tests.support.compiled import compiled_text
from tests.support.front_passes import resolved

MAST = """\
shotc: 1
mission: portrait
world: {origin: {lat: 47.3769, lon: 8.5417, alt: 408}}
targets:
  mast: {at: [0, 0, 6], radius: 1, height: 2}
  tree: {at: [0, 30, 6], radius: 2, height: 12}
drones: {cam: {model: MODEL, home: [0, -30, 0], camera: {CAMERA}}}
shots:
  - {id: look, drone: cam, target: mast, altitude: {above: origin, height: 6}, timing: {duration: 10}, WAY,
     allow: [fast-pan]EXTRA}
"""
WAY = "kind: dolly, azimuth: 180 deg, distance: [20, 12]"
LENS = "sensor: 36 mm, focal_length: 85 mm"


def text(camera: str, extra: str = "", model: str = "x500", way: str = WAY) -> str:
    return MAST.replace("CAMERA", camera).replace("EXTRA", extra).replace("MODEL", model).replace("WAY", way)


@cache
def plan(camera: str, extra: str = "", model: str = "x500") -> VerifiedIR:
    made = compiled_text(text(camera, extra, model)).plan
    assert made is not None
    return made


def rows(made: VerifiedIR, name: str = "framing.csv") -> list[dict[str, str]]:
    (table,) = (a for a in api.emit_plan(made, ("csv",)).artifacts if a.name == name)
    return list(csv.DictReader(io.StringIO(table.data.decode())))


def camera_rows(made: VerifiedIR) -> dict[str, dict[str, str]]:
    return {r["t_s"]: r for r in rows(made, "trajectory.csv")}


def worst(made: VerifiedIR, ending: str) -> float:
    return max(c.worst for c in made.certificate if c.constraint.endswith(ending))


def soft(camera: str, extra: str = "", model: str = "x500") -> list[str]:
    found = compiled_text(text(camera, extra, model)).diagnostics
    return [d.code for d in found if d.code in ("V061", "V062")]


@pytest.mark.slow
def test_the_columns_of_focus_are_those_of_the_thin_lens() -> None:
    made = plan(f"{LENS}, aperture: f/2")
    poses = camera_rows(made)
    for row in rows(made)[::40]:
        pose = poses[row["t_s"]]
        pitch = float(pose["cam_pitch_rad"])
        eye = np.array([float(pose[k]) for k in ("x_m", "y_m", "z_m")])
        yaw = float(pose["cam_yaw_rad"])
        axis = np.array([np.cos(pitch) * np.cos(yaw), np.cos(pitch) * np.sin(yaw), np.sin(pitch)])
        depth = float((np.array([0, 0, 6]) - eye) @ axis)
        assert float(row["focus_m"]) == pytest.approx(depth, rel=1e-6)
        hyperfocal = 0.085**2 / (2 * 0.03e-3) + 0.085
        near = depth * (hyperfocal - 0.085) / (hyperfocal + depth - 2 * 0.085)
        far = depth * (hyperfocal - 0.085) / (hyperfocal - depth)
        assert float(row["near_m"]) == pytest.approx(near, rel=1e-6)
        assert float(row["far_m"]) == pytest.approx(far, rel=1e-6)
        assert row["motion_blur_px"] == row["background_blur_px"] == ""


@pytest.mark.slow
def test_a_subject_is_soft_where_it_reaches_out_of_the_limits_and_the_fix_mends_it() -> None:
    made = compiled_text(text(f"{LENS}, aperture: f/1.4"))
    (told,) = (d for d in made.diagnostics if d.code == "V061")
    assert "mast is soft in shot `look`" in told.message
    assert told.help.startswith("write `camera: {aperture: f/2}` of `cam`")
    assert soft(f"{LENS}, aperture: f/2") == []
    may = text(f"{LENS}, aperture: f/1.4").replace("fast-pan", "fast-pan, soft-subject")
    assert [d.code for d in compiled_text(may).diagnostics] == []
    # A cylinder seen level reaches a radius to either side of its centre.
    last = rows(made.plan)[-1]  # type: ignore[arg-type]
    focus = float(last["focus_m"])
    disc = 0.085**2 / 1.4 / (focus - 0.085) * 1.0 / (focus - 1.0)
    assert worst(made.plan, " blur disc") == pytest.approx(1e3 * disc, rel=0.02)  # type: ignore[arg-type]


@pytest.mark.slow
def test_focus_on_another_target_softens_the_one_that_is_framed() -> None:
    made = plan(f"{LENS}, aperture: f/2.8", ", focus: tree")
    assert float(rows(made)[-1]["focus_m"]) == pytest.approx(42.0, abs=0.1)
    assert soft(f"{LENS}, aperture: f/2.8", ", focus: tree") == ["V061"]


@pytest.mark.slow
def test_a_sensor_that_is_not_written_is_the_models_or_a_full_frame() -> None:
    # The same picture and f-number on a smaller sensor: more is sharp.
    assert plan("hfov: 30 deg, aperture: f/1.4").trajectory.keyframes.mission.drones[0].optics.sensor is None
    full = worst(plan("hfov: 30 deg, aperture: f/1.4"), " blur disc") / 0.03
    camera = "hfov: 71.6 deg, aperture: f/1.4"
    for model, width in (("mavic-3-pro", 17.3), ("mini-4-pro", 9.8)):
        drone = resolved(text(camera, "", model))[0].drones[0]
        assert drone.optics.sensor == pytest.approx(width / 1e3)
        assert drone.optics.circle == pytest.approx(width / 1e3 / 1200)
    # 30 deg on a sensor of 12 mm.
    small = worst(plan("sensor: 12 mm, focal_length: 22.392 mm, aperture: f/1.4"), " blur disc") / 0.01
    assert small == pytest.approx(full / 3, rel=0.02)


@pytest.mark.slow
def test_motion_blur_is_how_far_the_picture_goes_in_one_exposure() -> None:
    moving = """\
shotc: 1
mission: passing
targets: {runner: {track: {start: [-30, 0, 0.9], velocity: [3, 0, 0]}, radius: 0.4, height: 1.8}}
drones: {cam: {model: x500, home: [0, -30, 0], camera: {hfov: 60 deg, shutter: 1/25 s, pixels: 1920}}}
shots:
  - {id: pass, kind: static, drone: cam, target: runner, at: [0, -20, 0.9], heading: 0 deg, pitch: 0 deg,
     timing: {start: 9, duration: 2}}
rules: {ground_clearance: 0.1}
"""
    done = compiled_text(moving)
    assert done.plan is not None
    expected = 960 * (3 / 25) / (20 * tan(radians(30)))
    for row in rows(done.plan)[5:-5:20]:
        assert float(row["motion_blur_px"]) == pytest.approx(expected, rel=1e-3)
        assert float(row["background_blur_px"]) < 1e-3
    (told,) = (d for d in done.diagnostics if d.code == "V062")
    assert "`camera: {shutter: 1/50 s}`" in told.help
    assert [c.limit for c in done.plan.certificate if c.constraint == "runner motion blur"] == [5.0]


@pytest.mark.slow
def test_the_background_of_a_turning_camera_goes_as_fast_as_it_turns() -> None:
    made = plan(f"{LENS}, shutter: 1/50 s")
    poses = camera_rows(made)
    found = rows(made)
    # The dolly goes straight ahead: its background, the ground behind the mast or what is far, hardly moves.
    assert max(float(r["motion_blur_px"]) for r in found) < 2.0
    orbit = text(f"{LENS}, shutter: 1/50 s", way="kind: orbit, radius: 15, sweep: 60 deg")
    turning = compiled_text(orbit).plan
    assert turning is not None
    poses = camera_rows(turning)
    for row in rows(turning)[100:400:60]:
        pose = poses[row["t_s"]]
        rate = hypot(
            float(pose["cam_yaw_rate_rad_s"]) * np.cos(float(pose["cam_pitch_rad"])),
            float(pose["cam_pitch_rate_rad_s"]),
        )
        far = rate / 50 * 1920 / tan(float(pose["hfov_rad"]) / 2)
        # Level with the mast, nothing but the sky is behind it.
        assert float(row["background_blur_px"]) == pytest.approx(far, rel=0.02)


@pytest.mark.slow
def test_missions_without_exposure_have_no_columns_of_it() -> None:
    made = plan(LENS)
    assert "focus_m" not in rows(made)[0]
    assert made.trajectory.keyframes.mission.drones[0].optics is None


@pytest.mark.parametrize(
    ("camera", "extra", "code", "words"),
    [
        (f"{LENS}, aperture: f/2.8", ", focus: mst", "N001", "unknown target `mst`"),
        (LENS, ", focus: tree", "K021", "but the camera of `cam` has no aperture"),
        (f"{LENS}, aperture: f/0.2", "", "S014", "no lens has an aperture of `f/0.2`"),
        (f"{LENS}, aperture: wide", "", "S007", "expected an aperture"),
        (f"{LENS}, shutter: 0 s", "", "S014", "no time of exposure"),
        (f"{LENS}, shutter: 1/0 s", "", "S014", "no time of exposure"),
        (f"{LENS}, shutter: 5 s", "", "S014", "no time of exposure"),
        (f"{LENS}, shutter: 5 kg", "", "U002", "expected a duration"),
        (f"{LENS}, shutter: 1/50 s, circle_of_confusion: 0.02 mm", "", "S", "without `aperture`"),
        (f"{LENS}, aperture: f/4, pixels: 1920", "", "S", "without `shutter`"),
        (f"{LENS}, aperture: f/4, circle_of_confusion: 2 m", "", "S014", "circle of confusion"),
    ],
)
def test_nonsense_is_told_at_its_line(camera: str, extra: str, code: str, words: str) -> None:
    _, found = resolved(text(camera, extra))
    (told,) = found
    assert told.code.startswith(code)
    assert words in told.message
    assert told.labels[0].span.line == (10 if extra else 7)


@pytest.mark.parametrize(
    ("written", "seconds"), [("1/50 s", 0.02), ("1/48", 1 / 48), ("20 ms", 0.02), ("0.02", 0.02)]
)
def test_shutters_are_written_as_photographers_do(written: str, seconds: float) -> None:
    mission, found = resolved(text(f"{LENS}, shutter: {written}, aperture: 5.6"))
    assert found == []
    assert mission.drones[0].optics.shutter == pytest.approx(seconds)
    assert mission.drones[0].optics.aperture == 5.6


@pytest.mark.slow
def test_a_lens_may_be_focused_on_a_distance():
    at = plan(f"{LENS}, aperture: f/2.8", ", focus: 60 m")
    assert {float(r["focus_m"]) for r in rows(at)} == {60.0}
    disc = (0.085 / 2.8) * 0.085 * (60.0 - 11.0) / (60.0 - 0.085) / 11.0  # of the nearest point, at the end
    assert worst(at, "blur disc") == pytest.approx(1e3 * disc, rel=0.02)
    assert soft(f"{LENS}, aperture: f/2.8", ", focus: 60 m") == ["V061"]
    assert soft(f"{LENS}, aperture: f/2.8") == []


@pytest.mark.parametrize(
    ("focus", "code", "told"),
    [
        ("60 s", "S007", "the name of a target, or a distance such as `60 m`"),
        ("0 m", "S014", "give"),
        ("nobody", "N001", ""),
    ],
)
def test_a_focus_is_a_target_or_a_distance(focus, code, told):
    (fault,) = compiled_text(text(f"{LENS}, aperture: f/2.8", f", focus: {focus}")).diagnostics
    assert fault.code == code
    assert told in (fault.help or "")
