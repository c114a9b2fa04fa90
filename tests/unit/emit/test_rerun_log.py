from __future__ import annotations

import subprocess
import sys
from functools import cache
from math import pi, radians
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import rerun as rr
from rerun.chunk import RrdReader

from shotc.emit.rerun_log import EMITTER
from shotc.emit.rerun_log.layout import panels
from shotc.emit.rerun_log.motion import camera_quaternions
from shotc.emit.rerun_log.opening import filmed_span, first_stand
from shotc.emit.rerun_log.recording import recorded
from shotc.emit.rerun_log.series import clearance_plot, motion_plots, sample_times
from shotc.emit.rerun_log.text import certificate_text, phase_texts, quantity
from shotc.emit.triangles import solid_mesh
from shotc.geom.bernstein import Piecewise
from shotc.geom.camera import view
from shotc.geom.solids import Cylinder, Prism, box, signed_area
from shotc.ir.path import HFOV
from shotc.ir.trajectory import VerifiedIR
from tests.support.film_plans import orbit_plan
from tests.support.records import replace


@cache
def recording() -> bytes:
    (artifact,) = EMITTER.emit(orbit_plan()).artifacts
    assert artifact.name == "mission.rrd"
    return artifact.data


@pytest.fixture
def rrd(tmp_path: Path) -> Path:
    path = tmp_path / "mission.rrd"
    path.write_bytes(recording())
    return path


def columns(path: Path) -> dict[str, list[Any]]:
    """Return the values of every component of a recording, by entity:component, in order of time; t in ns."""
    found: dict[str, list[Any]] = {}
    for chunk in RrdReader(path).stream().to_chunks():
        batch = chunk.to_record_batch()
        for name, values in zip(batch.schema.names, batch.columns, strict=True):
            plain = values.cast("int64") if name in ("t", "filmed") else values
            found.setdefault(f"{chunk.entity_path}:{name}", []).extend(plain.to_pylist())
    return found


ENTITIES = {
    "/world": "ViewCoordinates:xyz",
    "/world/ground/grid": "LineStrips3D:strips",
    "/world/ground/plane": "Mesh3D:vertex_positions",
    "/world/zones/tree/edges": "LineStrips3D:strips",
    "/world/zones/tree/volume": "Mesh3D:vertex_positions",
    "/world/zones/tree/name": "Points3D:labels",
    "/world/zones/field/edges": "LineStrips3D:strips",
    "/world/targets/tower/body": "Mesh3D:vertex_colors",
    "/world/targets/tower/name": "Points3D:labels",
    "/world/homes/cam1": "Points3D:labels",
    "/world/path/cam1/00_takeoff": "LineStrips3D:strips",
    "/world/path/cam1/02_shot_half": "LineStrips3D:strips",
    "/world/path/cam1/04_land": "LineStrips3D:strips",
    "/world/keyframes/cam1/half": "Points3D:positions",
    "/world/drones/cam1": "Transform3D:translation",
    "/world/cameras/cam1": "Transform3D:quaternion",
    "/world/cameras/cam1/lens": "Pinhole:image_from_camera",
    "/world/cameras/cam1/screen": "Transform3D:scale",
    "/world/cameras/cam1/screen/composition": "LineStrips3D:strips",
    "/world/cameras/cam1/screen/tower/outline": "LineStrips3D:strips",
    "/world/cameras/cam1/screen/tower/centre": "Points3D:positions",
    "/world/cameras/cam1/screen/tower/wanted": "LineStrips3D:strips",
    "/plots/cam1/speed/speed": "Scalars:scalars",
    "/plots/cam1/speed/limit": "Scalars:scalars",
    "/plots/cam1/climb/limit2": "Scalars:scalars",
    "/plots/cam1/acceleration/acceleration": "Scalars:scalars",
    "/plots/cam1/jerk/jerk": "Scalars:scalars",
    "/plots/cam1/yaw_rate/yaw_rate": "Scalars:scalars",
    "/plots/cam1/gimbal_pitch/pitch": "Scalars:scalars",
    "/plots/cam1/screen_error/screen_error": "Scalars:scalars",
    "/plots/cam1/screen_error/promised": "Scalars:scalars",
    "/plots/cam1/clearance/zones": "Scalars:scalars",
    "/plots/cam1/clearance/subjects": "Scalars:scalars",
    "/plots/cam1/clearance/ground": "Scalars:scalars",
    "/summary": "TextDocument:text",
}


def test_the_recording_holds_every_entity(rrd: Path) -> None:
    schema = RrdReader(rrd).store().schema()
    known = {(c.entity_path, c.component) for c in schema.component_columns()}
    assert set(ENTITIES.items()) <= known
    assert {c.name for c in schema.index_columns()} == {"t", "filmed"}
    # Keep-in zones have no volume: one would hide everything in them.
    assert "/world/zones/field/volume" not in {entity for entity, _ in known}


LAYOUT = ("EyeControls3D:", "TimePanelBlueprint:")


def test_the_timeline_that_opens_begins_at_the_first_filmed_frame(rrd: Path) -> None:
    rows = 0
    for chunk in RrdReader(rrd).stream().to_chunks():
        batch = chunk.to_record_batch()
        if "t" in batch.schema.names:
            t, filmed = (np.array(batch.column(n).cast("int64").to_pylist()) for n in ("t", "filmed"))
            np.testing.assert_array_equal(filmed, np.maximum(t, 22_000_000_000))
            rows += len(t)
    assert rows > 1000
    assert panels((22.0, 52.0))[0].timeline == "filmed"


def test_a_recording_opens_with_the_camera_and_its_subject_in_view() -> None:
    plan = orbit_plan()
    assert filmed_span(plan) == (22.0, 52.0)
    stand = first_stand(plan)
    assert stand is not None
    ahead = np.subtract(stand.look, stand.eye)
    ahead /= np.linalg.norm(ahead)
    (flight,) = plan.trajectory.drones
    for point in (flight.curve(22.0)[:3], (0.0, 0.0, 0.0), (0.0, 0.0, 24.0)):
        to = np.subtract(point, stand.eye)
        assert np.degrees(np.arccos(to @ ahead / np.linalg.norm(to))) < 27.5, "the viewer's lens sees 55 deg"


def test_the_recorded_layout_has_that_view_and_plays_from_the_first_filmed_frame(rrd: Path) -> None:
    reader, found = RrdReader(rrd), dict[str, Any]()
    (layout,) = reader.blueprints()
    for chunk in reader.stream(store=layout).to_chunks():
        batch = chunk.to_record_batch()
        for name, values in zip(batch.schema.names, batch.columns, strict=True):
            rows = [row for row in values.to_pylist() if row]
            if name.startswith(LAYOUT) and rows:
                found[name] = rows[-1][0]
    stand = first_stand(orbit_plan())
    assert stand is not None
    assert found["EyeControls3D:position"] == pytest.approx(stand.eye, abs=1e-4)
    assert found["EyeControls3D:look_target"] == pytest.approx(stand.look, abs=1e-4)
    assert found["TimePanelBlueprint:timeline"] == "filmed"
    assert found["TimePanelBlueprint:time_selection"] == {"min": 22_000_000_000, "max": 52_000_000_000}


NAMES = ("Möwe, Take 2", "v1.2 (final)", "塔", "橋")


@pytest.mark.slow
def test_each_name_of_a_mission_gives_a_layout_of_its_own_without_a_warning(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    """The viewer keeps one layout for each application id, and warns of letters that it replaces."""
    plan, path = orbit_plan(), tmp_path / "named.rrd"
    ids = set()
    for name in NAMES:
        mission = replace(plan.trajectory.keyframes.mission, name=name)
        path.write_bytes(recorded(mission, "", lambda stream: stream.log("/note", rr.TextDocument("x"))))
        ids |= {found.application_id for found in RrdReader(path).recordings()}
    assert len(ids) == len(NAMES)
    assert "WARN" not in capfd.readouterr().err


def test_the_recording_has_one_active_layout(rrd: Path) -> None:
    reader = RrdReader(rrd)
    assert len(reader.recordings()) == 1
    assert len(reader.blueprints()) == 1


@pytest.mark.long
def test_the_viewer_s_own_check_accepts_the_file(rrd: Path) -> None:
    command = [sys.executable, "-m", "rerun", "rrd", "verify", str(rrd)]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=60)
    assert done.returncode == 0, done.stderr
    assert "1 file" in done.stdout + done.stderr


@pytest.mark.long
def test_two_runs_record_the_same(rrd: Path, tmp_path: Path) -> None:
    again = tmp_path / "again.rrd"
    again.write_bytes(EMITTER.emit(orbit_plan()).artifacts[0].data)
    first, second = columns(rrd), columns(again)
    assert first.keys() == second.keys()
    for name in first:
        if not name.endswith(("RowId", "row_id")):
            np.testing.assert_array_equal(repr(first[name]), repr(second[name]), err_msg=name)


@pytest.mark.slow
def test_the_camera_flies_and_looks_as_planned(rrd: Path) -> None:
    plan, seen = orbit_plan(), columns(rrd)
    (flight,) = plan.trajectory.drones
    t = sample_times(flight)
    places = np.array(seen["/world/cameras/cam1:Transform3D:translation"])[:, 0]
    np.testing.assert_allclose(places, flight.curve(t)[:, :3], atol=1e-4)
    lens = seen["/world/cameras/cam1/lens:Pinhole:image_from_camera"]
    assert len(lens) == 1, "a lens that does not zoom is logged once"
    assert lens[0][0][0] == pytest.approx(640 / np.tan(radians(35)), rel=1e-6)
    assert lens[0][0][6:8] == [640.0, 360.0]


@pytest.mark.slow
def test_a_zoom_is_logged_over_time(tmp_path: Path) -> None:
    plan = orbit_plan()
    (flight,) = plan.trajectory.drones
    ctrl = flight.curve.ctrl.copy()
    ctrl[2:100, :, HFOV] *= 0.8
    bumpy = replace(flight, curve=Piecewise(flight.curve.breaks, ctrl))
    zooming = VerifiedIR(replace(plan.trajectory, drones=(bumpy,)), plan.certificate)
    path = tmp_path / "zoom.rrd"
    path.write_bytes(EMITTER.emit(zooming).artifacts[0].data)
    found = columns(path)
    matrices = found["/world/cameras/cam1/lens:Pinhole:image_from_camera"]
    assert (
        len(matrices)
        == len(found["/world/cameras/cam1/lens:Pinhole:resolution"])
        == len(sample_times(flight))
    )
    assert len({round(m[0][0], 3) for m in matrices}) == 2
    scales = np.array(found["/world/cameras/cam1/screen:Transform3D:scale"])[:, 0]
    np.testing.assert_allclose(scales[:, 0] / scales[:, 2] * [m[0][0] for m in matrices], 640.0, rtol=1e-5)


def test_camera_turns_take_camera_axes_to_the_world() -> None:
    rng = np.random.default_rng(0)
    yaw, pitch = rng.uniform(-8, 8, 40), rng.uniform(-pi / 2, pi / 2, 40)
    for q, psi, theta in zip(camera_quaternions(yaw, pitch), yaw, pitch, strict=True):
        assert np.linalg.norm(q) == pytest.approx(1.0)
        x, y, z, w = q
        turn = np.array(
            [
                [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
            ]
        )
        for direction in np.eye(3):
            expected = view(psi, theta, 1.0, 1.0).to_camera(tuple(direction))
            np.testing.assert_allclose(turn.T @ direction, expected, atol=1e-12)


@pytest.mark.slow
def test_the_overlay_is_there_while_it_is_filmed_and_gone_after(rrd: Path) -> None:
    found = columns(rrd)
    for name in ("tower/outline", "tower/wanted", "composition"):
        entity = f"/world/cameras/cam1/screen/{name}"
        times = [t * 1e-9 for t in found[f"{entity}:t"]]
        strips = found[f"{entity}:LineStrips3D:strips"]
        rows = [s for s in strips if s is not None]
        assert times[0] == pytest.approx(22.0, abs=0.05)
        assert times[-1] == pytest.approx(52.0, abs=0.05)
        assert rows[-1] == []
        assert all(rows[:-1])
    outline = np.array(found["/world/cameras/cam1/screen/tower/outline:LineStrips3D:strips"][0][0])
    assert np.abs(outline[:, :2]).max() < 1.0
    np.testing.assert_array_equal(outline[0], outline[-1])


def test_plots_agree_with_the_curve() -> None:
    plan = orbit_plan()
    mission, (flight,) = plan.trajectory.keyframes.mission, plan.trajectory.drones
    t = sample_times(flight)
    plots = {plot.name: plot for plot in motion_plots(flight, mission.drones[0], t)}
    middle = int(np.searchsorted(t, 37.0))
    assert plots["speed"].lines[0].values[middle] == pytest.approx(40 * pi * 1.875 / 30, rel=1e-3)
    assert plots["speed"].limits == (8.0,)
    assert plots["climb"].limits == (4.0, -3.0)
    assert plots["yaw_rate"].lines[0].values[middle] == pytest.approx(180 * 1.875 / 30, rel=1e-3)
    room = {line.name: line.values for line in clearance_plot(flight, mission.drones[0], mission, t).lines}
    assert room["subjects"][middle] == pytest.approx(40 - 4 - 0.6 - 1.0, abs=0.01)
    assert room["ground"][middle] == pytest.approx(20 - 0.6 - 2.0, abs=0.01)
    assert room["zones"][middle] == pytest.approx(20 - 2 - 0.6, abs=0.01)
    # On the pad only keep-out zones bind.
    assert np.isnan(room["ground"][0])
    assert room["zones"][0] == pytest.approx(np.hypot(20, 70) - 3 - 0.6)


@pytest.mark.parametrize(
    "solid",
    [
        Cylinder((3.0, -2.0), 2.0, 1.0, 7.0),
        box((0, 0, 3), (4, 2, 6), 0.7),
        Prism(((0, 0), (10, 0), (10, 4), (4, 4), (4, 10), (0, 10)), 0.0, 5.0),
    ],
)
def test_meshes_are_closed_and_face_outwards(solid: Cylinder | Prism) -> None:
    points, faces, light = solid_mesh(solid)
    assert len(light) == len(points) == 3 * len(faces)
    a, b, c = (points[faces[:, i]] for i in range(3))
    volume = float(np.einsum("nd,nd->n", a, np.cross(b, c)).sum() / 6)
    area = signed_area(solid.points) if isinstance(solid, Prism) else 48 / 2 * np.sin(2 * pi / 48) * 4
    assert volume == pytest.approx(area * (solid.top - solid.bottom))
    assert (light > 0).all()


def test_words_say_what_happens_and_what_is_proved() -> None:
    plan = orbit_plan()
    (claim,) = plan.certificate
    texts = phase_texts(plan, plan.trajectory.drones[0])
    assert [time for time, _ in texts] == [0.0, 8.0, 22.0, 52.0, 112.0]
    assert texts[0][1].startswith("## Taking off")
    assert texts[2][1].startswith("## Filming `half`\nkeyframes of tower")
    assert "| ok | speed | ≤ 8 m/s | 7.9 m/s | 37.0 s | every instant |" in texts[2][1]
    broken = replace(claim, constraint="climb", holds=False)
    open_ended = replace(claim, constraint="size", limit=float("inf"))
    rows = certificate_text((open_ended, claim, broken)).splitlines()[2:]
    assert [row.split("|")[2].strip() for row in rows] == ["climb", "speed", "size"]
    assert "**broken**" in rows[0]
    assert "| – |" in rows[2]
    assert quantity(radians(60), "rad/s") == "60 deg/s"
