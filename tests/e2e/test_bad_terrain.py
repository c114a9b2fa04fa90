"""Elevation models that cannot be used: told on the line that names them, with a help that names keys."""

from __future__ import annotations

import pytest

from shotc import api
from tests.support.terrain_missions import relief, table

MISSION = """\
shotc: 1
mission: hills
world:
  origin: {lat: 46.5, lon: 8.5, alt: 400}
  terrain: {file: NAME}
targets: {t: {at: [60, 0, 5], radius: 1, height: 10}}
drones: {cam: {home: [0, 0, 0]}}
shots: [{id: s, kind: orbit, drone: cam, target: t, radius: 25, altitude: 12}]
"""
SHOW = """\
shotc: 1
mission: show
world: {terrain: {file: relief.csv}}
fleets: {swarm: {count: 4, layout: {grid: {spacing: 4, origin: [0, 0, 0]}}}}
shots: [{id: d, kind: display, fleet: swarm, frames: [{sphere: {center: [0, 0, 40], radius: 15}, hold: 4}]}]
"""
GRID = b"ncols 2\nnrows 2\nxllcorner 465000\nyllcorner 5149000\ncellsize 10\n1 2\n3 4\n"


def faults(folder, text: str):
    options = api.PlanOptions(refiner="none")
    return api.compile_source(text.encode(), "mission.yaml", folder, options).diagnostics


@pytest.mark.parametrize(
    ("name", "data", "message", "help_"),
    [
        ("noise.tif", bytes(range(256)) * 9, "it is no TIFF that can be read", "float32"),
        ("metres.asc", GRID, "does not say in which system", "`epsg: 32632`"),
        ("vast.asc", GRID.replace(b"ncols 2", b"ncols 1e300"), "1e+300 x 2 posts", "thin"),
    ],
)
def test_a_file_that_cannot_be_used_is_told_where_it_is_named(tmp_path, name, data, message, help_):
    (tmp_path / name).write_bytes(data)
    (told,) = faults(tmp_path, MISSION.replace("NAME", name))
    assert told.code == "N009"
    assert told.labels[0].span.line == 5
    assert message in told.message
    assert " at 0x" not in told.message
    assert help_ in told.help


def test_posts_on_earth_of_a_mission_that_is_nowhere_ask_for_its_origin(tmp_path):
    (tmp_path / "metres.asc").write_bytes(GRID)
    text = MISSION.replace("NAME", "metres.asc, epsg: 32632").replace(
        "  origin: {lat: 46.5, lon: 8.5, alt: 400}\n", ""
    )
    (told,) = faults(tmp_path, text)
    assert "`world: {origin:" in told.help


def test_a_show_over_terrain_is_no_failure_of_the_compiler(tmp_path):
    (tmp_path / "relief.csv").write_text(table(relief()))
    assert all(not told.code.startswith("X") for told in faults(tmp_path, SHOW))


@pytest.mark.slow
def test_a_way_over_a_hole_of_the_terrain_is_told_at_the_shot_that_it_leads_to(tmp_path):
    rows = table(relief()).splitlines(keepends=True)
    xy = [tuple(map(float, row.split(",")[:2])) for row in rows[1:]]
    hole = [row for row, (x, y) in zip(rows[1:], xy, strict=True) if abs(x - 60) > 15 or abs(y) > 15]
    (tmp_path / "relief.csv").write_text("".join([rows[0], *hole]))
    text = MISSION.replace("NAME", "relief.csv").replace("[60, 0, 5]", "[160, 0, {above: ground, height: 5}]")
    text = text.replace("[0, 0, 0]", "[0, 0, {above: ground, height: 0}]")
    text = text.replace("altitude: 12", "altitude: {above: ground, height: 12}")
    told = [d for d in faults(tmp_path, text) if d.code == "G025"]
    assert told
    assert told[0].labels[0].span.line == 8
    assert "beyond the ground of `relief.csv`" in told[0].notes[0]
