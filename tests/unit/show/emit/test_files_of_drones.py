"""Zipped CSV and VVIZ, read back by readers of the tests' own: places, lights, and how they are written."""

from __future__ import annotations

import csv
import io
import itertools
import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from zipfile import ZipFile

import numpy as np
import pytest
from scipy.interpolate import BSpline

from shotc import output
from shotc.ir.trajectory import VerifiedIR
from shotc.show.emit import vviz, zipped_csv
from tests.support.film_plans import orbit_plan
from tests.support.show_plans import PADS, STEP, display, fleet, mission, plan

PLAN = plan()
END_S = 46.0


def flown(made: VerifiedIR, times: np.ndarray, number: int = 0) -> np.ndarray:
    """Places (n, T, 3) of a fleet by SciPy alone: knots go on evenly on both sides."""
    coef = made.trajectory.fleets[number].coef
    knots = STEP * np.arange(-3, coef.shape[1] + 1)
    return np.moveaxis(BSpline(knots, np.moveaxis(coef, 1, 0), 3)(np.minimum(times, END_S)), 0, 1)


def shone(times: np.ndarray) -> np.ndarray:
    """Colours (T, 3) of every drone: white from 16 to 20 s, orange from 26 to 28 s, linear between.

    They are black to 8 s and from 38 s on.
    """
    share = np.clip((times - 20.0) / 6.0, 0.0, 1.0)[:, None]
    lit = np.clip(np.minimum((times - 8.0) / 8.0, (38.0 - times) / 10.0), 0.0, 1.0)[:, None]
    return lit * (np.array([255.0, 255.0, 255.0]) + share * np.array([0.0, -127.0, -255.0]))


def unzipped(data: bytes) -> dict[str, np.ndarray]:
    with ZipFile(io.BytesIO(data)) as archive:
        assert archive.testzip() is None
        found = {}
        for name in archive.namelist():
            rows = list(csv.reader(io.StringIO(archive.read(name).decode("ascii"))))
            assert rows[0] == ["Time [msec]", "x [m]", "y [m]", "z [m]", "Red", "Green", "Blue"]
            found[name] = np.array([[float(cell) for cell in row] for row in rows[1:]])
    return found


@pytest.mark.parametrize("rate", [5.0, 3.3])
def test_each_table_has_the_places_and_lights_of_its_drone(rate: float) -> None:
    made = plan(mission(rate=rate))
    (file,) = zipped_csv.EMITTER.emit(made).artifacts
    assert file.name == "show-csv.zip"
    tables = unzipped(file.data)
    assert list(tables) == [f"swarm-{k}.csv" for k in range(1, len(PADS) + 1)]
    for rows, wanted in zip(
        tables.values(), flown(made, next(iter(tables.values()))[:, 0] / 1e3), strict=True
    ):
        times = rows[:, 0] / 1e3
        assert (rows[:, 0] == np.round(rows[:, 0])).all()
        np.testing.assert_allclose(times, np.arange(len(rows)) / rate, atol=5.01e-4)
        assert times[-1] >= END_S
        np.testing.assert_allclose(rows[:, 1:4], wanted, atol=5.01e-4)
        np.testing.assert_allclose(rows[:, 4:], shone(times), atol=0.51)


class Viewer:
    """What a viewer makes of a drone of a VVIZ file: it adds steps up, and holds colours for frames."""

    def __init__(self, show: dict[str, Any], drone: dict[str, Any]) -> None:
        self.show, self.agent = show, drone["agentDescription"]
        (self.light,) = drone["payloadDescription"]

    def places(self) -> Iterator[tuple[float, np.ndarray]]:
        at, time = np.array([self.agent[key] for key in ("homeX", "homeY", "homeZ")]), 0.0
        for step in self.agent["agentTraversal"]:
            time += step.get("dt", 1.0 / self.show["defaultPositionRate"])
            at = at + [step[key] for key in ("dx", "dy", "dz")]
            yield time, at

    def colors(self) -> list[tuple[int, int, int]]:
        return [
            (action["r"], action["g"], action["b"])
            for action in self.light["payloadActions"]
            for _ in range(action.get("frames", 1))
        ]


def shown(data: bytes) -> tuple[dict[str, Any], list[Viewer]]:
    show = json.loads(data)
    assert (show["version"], show["coordinateFrame"]) == ("1.0", "ogl")
    return show, [Viewer(show, drone) for drone in show["performances"]]


def test_steps_add_up_to_the_places_and_colours_are_held() -> None:
    (file,) = vviz.EMITTER.emit(PLAN).artifacts
    show, viewers = shown(file.data)
    assert file.name == "show.vviz"
    assert [drone["id"] for drone in show["performances"]] == [1, 2, 3, 4]
    assert show["globalReferenceFrame"] == {"lat": 47.0, "lon": 8.0, "alt": 400.0}
    assert [tag["time"] for tag in show["eventTags"]] == [16.0, 26.0]
    for number, viewer in enumerate(viewers):
        steps = list(viewer.places())
        times, seen = np.array([time for time, _ in steps]), np.array([at for _, at in steps])
        # East, Up, North of the file are East, North, Up of the world.
        np.testing.assert_allclose(seen[:, [0, 2, 1]], flown(PLAN, times)[number], atol=1e-3)
        assert times[-1] == pytest.approx(END_S)
        assert all(b > a for a, b in itertools.pairwise(times))
        assert max(np.diff(times)) > 2.0  # what stands is one step
        between = np.linspace(0.0, END_S, 2001)
        linear = np.stack([np.interp(between, times, seen[:, k]) for k in (0, 2, 1)], axis=-1)
        np.testing.assert_allclose(linear, flown(PLAN, between)[number], atol=0.02)
        colors = viewer.colors()
        np.testing.assert_allclose(colors, shone(np.arange(len(colors)) / 24.0), atol=0.51)
        assert len(colors) / 24.0 >= END_S


def test_fleets_follow_each_other_and_a_place_on_earth_may_be_open() -> None:
    other = fleet(tuple((x, y + 60.0, z) for x, y, z in PADS[:2]), "more")
    made = plan(mission(origin=None, fleets=(fleet(), other), displays=(display(), display("b", "more", 1))))
    (file,) = vviz.EMITTER.emit(made).artifacts
    show, viewers = shown(file.data)
    assert "globalReferenceFrame" not in show
    assert [viewer.agent["homeZ"] for viewer in viewers] == [0.0] * 4 + [60.0] * 2
    (archive,) = zipped_csv.EMITTER.emit(made).artifacts
    assert list(unzipped(archive.data))[3:] == ["swarm-4.csv", "more-1.csv", "more-2.csv"]


@pytest.mark.parametrize("module", [zipped_csv, vviz])
def test_a_large_show_is_written_drone_by_drone(
    module: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The same bytes, of which no more than one drone's are held at a time; and twice the same."""
    (whole,) = module.EMITTER.emit(PLAN).artifacts
    monkeypatch.setattr(module, "MANY_DRONES", len(PADS) - 1)
    (large,) = module.EMITTER.emit(PLAN).artifacts
    assert large.data == b""
    assert max(len(part) for part in large.chunks()) < len(whole.data) / 2
    paths, faults = output.write([large], tmp_path)
    assert not faults
    assert paths[0].read_bytes() == whole.data
    assert paths[0].name in output.left_over(tmp_path, ())


@pytest.mark.parametrize("module", [zipped_csv, vviz])
def test_a_film_has_no_such_file(module: Any) -> None:
    done = module.EMITTER.emit(orbit_plan())
    assert done.artifacts == ()
    assert "show of a fleet" in done.notes[0]
