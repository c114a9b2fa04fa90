from __future__ import annotations

import numpy as np
import pytest
from shotc_chan.chan import EMITTER

from shotc.emit.csv_table import EMITTER as TABLES
from tests.support.film_plans import orbit_plan
from tests.support.show_plans import plan as show_plan

PLAN = orbit_plan()


def turn(axis: int, degrees: float) -> np.ndarray:
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    i, j = [(1, 2), (2, 0), (0, 1)][axis]
    matrix = np.eye(3)
    matrix[i, i] = matrix[j, j] = c
    matrix[i, j], matrix[j, i] = -s, s
    return matrix


def test_every_frame_is_the_camera_of_the_table() -> None:
    (artifact,) = EMITTER.emit(PLAN).artifacts
    assert artifact.name == "cam1.chan"
    frames = np.loadtxt(artifact.data.decode().splitlines())
    table = TABLES.emit(PLAN).artifacts[0].data.decode().splitlines()
    head = table[0].split(",")
    assert len(frames) == len(table) - 1
    assert frames[0, 0] == 1
    for frame, line in list(zip(frames, table[1:], strict=True))[::97]:
        row = dict(zip(head, line.split(","), strict=True))
        x, y, z, yaw, pitch = (float(row[k]) for k in ("x_m", "y_m", "z_m", "cam_yaw_rad", "cam_pitch_rad"))
        assert frame[1:4] == pytest.approx([x, z, -y], abs=1e-5)
        # Nuke applies Z first, then X, then Y; the camera looks along -z.
        forward = turn(1, frame[5]) @ turn(0, frame[4]) @ turn(2, frame[6]) @ [0, 0, -1]
        wanted = [np.cos(yaw) * np.cos(pitch), np.sin(pitch), -np.sin(yaw) * np.cos(pitch)]
        assert forward == pytest.approx(wanted, abs=1e-7)
        half = np.tan(np.radians(frame[7]) / 2)
        assert half * 16 / 9 == pytest.approx(np.tan(float(row["hfov_rad"]) / 2), abs=1e-7)


def test_a_fleet_gets_no_camera_and_a_note_says_so() -> None:
    emission = EMITTER.emit(show_plan())
    assert emission.artifacts == ()
    assert "fleets" in emission.notes[0]
