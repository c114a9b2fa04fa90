"""Terrain, scenes and buildings that are not what is meant: an error on its line, and no plan."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest

from shotc.api import PlanOptions, compile_source
from shotc.checking import check_source
from shotc.diag.model import Diagnostic, Severity
from shotc.diag.registry import registry
from tests.support.elevation_files import ascii_grid
from tests.support.meshes import box_mesh, ply
from tests.support.scene_missions import BEFORE_SHOT, LAT, LON, feature, geojson, house, square

pytestmark = pytest.mark.slow

MISSION = (
    BEFORE_SHOT
    + """\
  - {id: look, kind: orbit, drone: cam, target: statue, radius: 20, altitude: {above: target, height: 10},
     sweep: 90 deg}
"""
)
STATUE = "at: [60, 0], radius: 1, height: 4"
DEM, SCENE, BUILDINGS = (
    "terrain: {file: a.asc, epsg: 4326}",
    "scene: {file: a.ply, units: m}",
    "buildings: {file: a.geojson}",
)
POSTS, STEP_DEG = 81, 1e-4
HALL = feature(square(60, 0, 9), name="Town hall", id="way/1", building="yes", height=9)


def dem(heights: np.ndarray, **header: float) -> bytes:
    """Return a grid whose middle is the origin, 7.6 by 11 m a cell."""
    corner = {"xllcorner": LON - POSTS / 2 * STEP_DEG, "yllcorner": LAT - POSTS / 2 * STEP_DEG}
    return ascii_grid(heights, {**corner, "cellsize": STEP_DEG, **header})


def level(height: float = 500.0) -> np.ndarray:
    return np.full((POSTS, POSTS), height)


def with_hole(value: float) -> np.ndarray:
    heights = level()
    heights[38:48, 35:45] = value
    return heights


def without_columns(*lacking: int) -> bytes:
    """Return a table of level ground, 20 m from post to post, without some columns."""
    side = range(-400, 401, 20)
    rows = (f"{x},{y},0\n" for x in side if x not in lacking for y in side)
    return ("x,y,z\n" + "".join(rows)).encode()


class Bad(NamedTuple):
    """A world, the bytes of its file (or how many there are), the error and its line, and another target."""

    world: str
    data: bytes | int
    code: str
    line: int
    target: str = STATUE


BAD = {
    "terrain elsewhere": Bad(DEM, dem(level(), xllcorner=9.0), "N009", 5),
    "terrain too small": Bad(DEM, dem(level(), cellsize=1e-5), "G046", 7),
    "hole under home": Bad(DEM, dem(with_hole(-9999), NODATA_value=-9999), "G025", 9),
    "no-data that is not declared": Bad(DEM, dem(with_hole(-9999)), "G025", 9),
    "void of SRTM": Bad(DEM, dem(with_hole(-32768)), "N009", 5),
    "terrain in feet": Bad(DEM, dem(level(500 / 0.3048)), "G052", 5),
    "origin in feet": Bad(DEM, dem(level(500 * 0.3048)), "G052", 5),
    "another height": Bad(DEM, dem(level(1500.0)), "G052", 5),
    "projected without a system": Bad(
        "terrain: {file: a.asc}", dem(level(), xllcorner=398e3, yllcorner=517e4, cellsize=10), "N009", 5
    ),
    "columns that lack": Bad("terrain: {file: a.csv}", without_columns(20, 40), "G025", 11),
    "a house in millimetres": Bad(SCENE, ply(1000 * (house() + np.array([60, 40, 0]))), "G033", 5),
    "statue in millimetres": Bad(SCENE, ply(1000 * box_mesh((0, 0, 1), (1, 1, 2))), "G027", 9),
    "upside down": Bad(SCENE, ply(house() * [1, 1, -1] + np.array([60, 40, 0])), "G051", 5),
    "a gigabyte": Bad(SCENE, 1 << 30, "N009", 5),
    "a gigabyte of footprints": Bad(BUILDINGS, 1 << 30, "N009", 5),
    "a building that is not there": Bad(BUILDINGS, geojson(HALL), "G048", 7, "building: Town hal"),
    "two of one name": Bad(
        BUILDINGS, geojson(HALL, {**HALL, "id": "way/2"}), "G049", 7, "building: Town hall"
    ),
    "home in a house": Bad(
        BUILDINGS, geojson(feature(square(0, -40, 9), building="yes", height=9)), "G027", 9
    ),
    "no file of buildings": Bad("wind: 1", b"", "G050", 7, "building: Town hall"),
}


def written(bad: Bad, folder: Path) -> bytes:
    name = next((n for n in ("a.asc", "a.csv", "a.ply", "a.geojson") if n in bad.world), "a.txt")
    with (folder / name).open("wb") as stream:
        if isinstance(bad.data, int):
            stream.truncate(bad.data)
        else:
            stream.write(bad.data)
    return MISSION.replace("WORLD", bad.world).replace(STATUE, bad.target).encode()


def errors(found: tuple[Diagnostic, ...]) -> list[tuple[str, int]]:
    return [(d.code, d.labels[0].span.line) for d in found if registry()[d.code].severity is Severity.ERROR]


@pytest.mark.long
@pytest.mark.parametrize("bad", BAD.values(), ids=BAD)
def test_it_is_an_error_on_its_line_and_there_is_no_plan(tmp_path: Path, bad: Bad) -> None:
    text = written(bad, tmp_path)
    assert (bad.code, bad.line) in errors(check_source(text, "m.yaml", tmp_path).diagnostics)
    done = compile_source(text, "m.yaml", tmp_path, PlanOptions(refiner="none"))
    assert done.plan is None
    assert (bad.code, bad.line) in errors(done.diagnostics)


@pytest.mark.parametrize(
    ("world", "old", "new"),
    [
        (level(500 * 0.3048), "alt: 500}", "alt: 152}"),
        (level(1500.0), "alt: 500}", "alt: 1500}"),
        (level(1500.0), "epsg: 4326", "epsg: 4326, datum: home"),
    ],
)
def test_the_fix_of_heights_that_disagree_works(
    tmp_path: Path, world: np.ndarray, old: str, new: str
) -> None:
    text = written(Bad(DEM, dem(world), "G052", 5), tmp_path)
    (told,) = check_source(text, "m.yaml", tmp_path).diagnostics
    assert new.rpartition(", ")[2].rstrip("}") in (told.help or "")
    assert check_source(text.replace(old.encode(), new.encode()), "m.yaml", tmp_path).diagnostics == ()


@pytest.mark.long
def test_a_scene_in_millimetres_is_told_with_its_size_and_its_fix_works(tmp_path: Path) -> None:
    text = written(BAD["statue in millimetres"], tmp_path)
    told = check_source(text, "m.yaml", tmp_path).diagnostics
    assert any(
        "the scene measures 2000 m" in note and "`units: mm`" in note for d in told for note in d.notes
    )
    assert check_source(text.replace(b"units: m}", b"units: mm}"), "m.yaml", tmp_path).diagnostics == ()


def test_a_scene_half_under_the_ground_is_a_warning_that_says_what_it_may_be(tmp_path: Path) -> None:
    half = ply(house() * [1, 1, -1] + np.array([60, 40, 3]))
    text = written(Bad(SCENE, half, "G032", 5), tmp_path)
    (told,) = check_source(text, "m.yaml", tmp_path).diagnostics
    assert (told.code, told.labels[0].span.line) == ("G032", 5)
    assert "write `at: [0.0, 0.0, 3.0]`" in told.help
    assert compile_source(text, "m.yaml", tmp_path, PlanOptions(refiner="none")).plan is not None


def test_a_house_in_millimetres_is_told_of_its_unit(tmp_path: Path) -> None:
    text = written(BAD["a house in millimetres"], tmp_path)
    (told,) = check_source(text, "m.yaml", tmp_path).diagnostics
    assert "`units: mm`, which makes it 10 m" in (told.help or "")
