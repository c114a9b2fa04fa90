"""Terrain as a mission names it: what stands on it, zones over it, what its heights count from, bad files."""

from __future__ import annotations

import numpy as np
import pytest

from shotc.ir.terrain import ground_heights
from tests.support.front_passes import resolved
from tests.support.resolve_missions import faults
from tests.support.terrain_missions import MIDDLE, cliff, relief, table, under

TEXT = """\
shotc: 1
mission: hills
world:
  origin: {lat: 46.68, lon: 7.68, alt: 500}
  terrain: {file: relief.csv}
  zones:
    wood: {keep: out, cylinder: {center: [40, 20], radius: 15, height: {above: ground, height: [0, 12]}}}
    field: {keep: in, box: {center: [0, 0, 100], size: [500, 500, 600]}}
targets:
  tower: {at: [120, 60], radius: 2, height: 20}
drones:
  cam: {model: x500, home: [0, 0]}
shots:
  - {id: round, kind: orbit, drone: cam, target: tower, radius: 35, altitude: {above: target, height: 25}}
"""


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "relief.csv").write_text(table(relief()))
    return tmp_path


def mission(folder, text=TEXT):
    found, diagnostics = resolved(text, folder)
    assert found is not None, diagnostics
    return found


def ground(x: float, y: float) -> float:
    return float(under(relief(), np.array([[x, y, 0.0]]))[0])


def test_an_altitude_over_terrain_needs_no_reference(folder):
    """Each shot over a hill got the warning of version 0.1, which had no terrain."""
    found, told = resolved(TEXT.replace("{above: target, height: 25}", "25"), folder)
    assert told == []
    assert found is not None
    assert found.shots[0].keyframes[0].at[2] == pytest.approx(ground(120, 60) + 25.0)


def test_what_stands_stands_on_the_terrain(folder):
    found = mission(folder)
    assert found.drone("cam").home == pytest.approx((0.0, 0.0, ground(0, 0)))
    assert found.target("tower").foot == pytest.approx((120.0, 60.0, ground(120, 60)))
    (shot,) = found.shots
    assert {round(k.at[2] - ground(120, 60), 9) for k in shot.keyframes} == {25.0}


@pytest.mark.slow
def test_the_ground_is_the_triangles_of_the_posts(folder):
    found = mission(folder)
    points = np.random.default_rng(2).uniform(-MIDDLE + 1, MIDDLE - 1, (200, 3))
    heights = [found.ground(float(x), float(y)) for x, y, _ in points]
    assert heights == pytest.approx(under(relief(), points).tolist())
    assert ground_heights(found, points[:, :2]) == pytest.approx(np.array(heights))


@pytest.mark.slow
def test_a_zone_over_the_ground_is_no_smaller_than_what_is_meant_and_a_fence_no_larger(folder):
    wood = mission(folder).zones[0].solid
    turn, share = np.meshgrid(np.linspace(0, 2 * np.pi, 60), np.linspace(0, 1, 20))
    disc = np.stack([40 + 15 * share * np.cos(turn), 20 + 15 * share * np.sin(turn)], axis=-1).reshape(-1, 2)
    heights = under(relief(), np.column_stack([disc, np.zeros(len(disc))]))
    assert wood.bottom <= heights.min() + 1e-9
    assert wood.top >= heights.max() + 12 - 1e-9
    fence = (
        "field: {keep: in, cylinder: {center: [0, 0], radius: 20, height: {above: ground, height: [3, 90]}}}"
    )
    text = "\n".join(f"    {fence}" if line.startswith("    field") else line for line in TEXT.splitlines())
    solid = next(z.solid for z in _lowered(text, folder).zones if z.name == "field")
    near = under(relief(), np.column_stack([(disc - [40, 20]) * 20 / 15, np.zeros(len(disc))]))
    assert solid.bottom >= near.max() + 3 - 1e-9
    assert solid.top <= near.min() + 90 + 1e-9


def _lowered(text, folder):
    from shotc.ir.passes import PassContext
    from shotc.passes.resolve.lower import lowered
    from tests.support.front_passes import EMITTERS, KINDS, loaded

    mission_, _ = loaded(text, folder)
    assert mission_ is not None
    return lowered(mission_, KINDS, EMITTERS, PassContext().progress).mission


def test_home_may_be_the_datum(folder):
    text = TEXT.replace("{file: relief.csv}", "{file: relief.csv, datum: home}").replace(
        "[0, 0]}", "[0, 0, 7]}"
    )
    found = mission(folder, text)
    assert found.ground(0.0, 0.0) == pytest.approx(7.0)
    assert found.target("tower").foot[2] == pytest.approx(7.0 + ground(120, 60) - ground(0, 0))


@pytest.mark.parametrize(("datum", "shift"), [("sea", -500.0), ("origin", 0.0)])
def test_heights_of_posts_on_earth_count_from_their_datum(tmp_path, datum, shift):
    rows = [
        f"{46.68 + i * 1e-4:.4f},{7.68 + j * 1e-4:.4f},{520 + i}"
        for i in range(-9, 10)
        for j in range(-9, 10)
    ]
    (tmp_path / "relief.csv").write_text("lat,lon,alt\n" + "\n".join(rows) + "\n")
    text = TEXT.replace("{file: relief.csv}", f"{{file: relief.csv, datum: {datum}}}")
    found = _lowered(text, tmp_path)
    assert found.ground(0.0, 0.0) == pytest.approx(520.0 + shift, abs=1e-3)


@pytest.mark.parametrize(
    ("change", "code"),
    [
        (("home: [0, 0]", "home: [0, 0, -60]"), "G006"),
        (("at: [120, 60]", "at: [120, 60, {above: ground, height: 0}]"), "G018"),
        (("home: [0, 0]", "home: [0, 400]"), "G025"),
        (("file: relief.csv", "file: other.csv"), "N008"),
        (("datum", "datum"), ""),
    ],
)
def test_faults_are_told_on_their_line(folder, change, code):
    text = TEXT.replace(*change)
    codes = [d.code for d in faults(text, folder)]
    assert (codes[:1] == [code]) if code else (codes == [])


@pytest.mark.parametrize("ending", ["csv", "asc", "hgt", "tif"])
@pytest.mark.parametrize("seed", [1, 2])
def test_any_bytes_are_a_fault_of_the_file(tmp_path, ending, seed):
    (tmp_path / f"relief.{ending}").write_bytes(np.random.default_rng(seed).bytes(2000))
    (told,) = faults(TEXT.replace("relief.csv", f"relief.{ending}"), tmp_path)
    assert told.code == "N009"
    assert told.labels[0].span.line == 5
    assert "0x" not in told.message


def test_holes_are_beyond_the_ground(tmp_path):
    shape = cliff()
    lines = table(shape).splitlines()
    kept = [line for line in lines if not line.startswith(("0,0,", "10,0,", "0,10,", "-10,0,", "0,-10,"))]
    (tmp_path / "relief.csv").write_text("\n".join(kept) + "\n")
    told = faults(TEXT.replace("home: [0, 0]", "home: [0, 0, 1]"), tmp_path)
    assert [d.code for d in told] == ["G025"]
    assert "the home of `cam` leaves the terrain" in told[0].message


def test_terrain_is_read_as_far_as_a_track_of_a_velocity_may_lead(tmp_path):
    rows = [f"{x},{y},{x / 100:g}" for x in range(-300, 3001, 100) for y in (-300, 0, 300)]
    (tmp_path / "relief.csv").write_text("x,y,z\n" + "\n".join(rows) + "\n")
    near = _lowered(TEXT, tmp_path)
    assert near.terrain.height(2900.0, 0.0) is None
    rider = "  rider: {track: {start: [0, 0, 1], velocity: [9, 0, 0]}, radius: 1, height: 2}\n"
    far = _lowered(TEXT.replace("drones:\n", rider + "drones:\n"), tmp_path)
    assert far.terrain.height(2900.0, 0.0) == pytest.approx(29.0)


TRACKED = (
    TEXT.replace("shots:\n", "  second: {model: x500, home: [0, 40]}\nshots:\n")
    .replace(
        "tower: {at: [120, 60], radius: 2, height: 20}", "rider: {track: TRACK, radius: 0.5, height: 1.8}"
    )
    .replace("target: tower", "target: rider, timing: {start: 20, duration: 5}")
)


def deepest(start: tuple[float, float, float], end: tuple[float, float, float]) -> float:
    way = np.linspace(start, end, 20_001)
    return float((way[:, 2] - 0.9 - under(relief(), way)).min())


@pytest.mark.slow
def test_a_track_that_leads_through_a_rise_between_its_points_is_told_and_a_lift_mends_it(folder):
    ends = [(x, y, ground(x, y) + 0.9) for x, y in ((-100.0, -60.0), (150.0, 90.0))]
    depth = -deepest(*ends)
    assert depth > 1.0
    track = "{points: [[-100, -60], [150, 90]], speed: 5}"
    text = TRACKED.replace("TRACK", track)
    (told,) = [d for d in faults(text, folder) if d.code == "G018"]
    assert told.message == f"target `rider` reaches {depth:.2f} m into the ground on its way"
    assert text.splitlines()[told.labels[0].span.line - 1].lstrip().startswith("rider:")
    time = float(told.notes[0].split("t = ")[1].split(" s")[0])
    assert 0.0 < time < 80.0
    lift = float(told.help.split("lift: ")[1].split(" m")[0])
    assert lift == pytest.approx(depth + 0.9, abs=0.011)
    corrected = TRACKED.replace("TRACK", f"{track[:-1]}, lift: {lift}}}")
    assert "G018" not in {d.code for d in faults(corrected, folder)}


@pytest.mark.slow
def test_a_recording_is_looked_at_along_all_its_rows(folder):
    rows = [(t, -100 + t, -60 + 0.6 * t) for t in range(0, 250, 5)]
    for bury, codes in ((0.0, set()), (4.0, {"G018"})):
        text = "t,x,y,z\n" + "".join(
            f"{t},{x},{y},{ground(x, y) + 1.9 - bury * (t == 200)}\n" for t, x, y in rows
        )
        (folder / "ride.csv").write_text(text)
        found = faults(TRACKED.replace("TRACK", "{file: ride.csv}"), folder)
        assert {d.code for d in found} & {"G018"} == codes
        over = "lift: {above: ground, height: 0.90 m}"
        assert all(over in (d.help or "") for d in found if d.code == "G018")
        corrected = faults(TRACKED.replace("TRACK", f"{{file: ride.csv, {over}}}"), folder)
        assert "G018" not in {d.code for d in corrected}


BEYOND = [
    ("tower: {at: [120, 60]", "tower: {at: [450, 0]", "target `tower`", 150.0),
    ("tower: {at: [120, 60]", "tower: {at: [0, 0, {above: ground, height: 9}]", "", 0.0),
    ("tower: {at: [120, 60]", "tower: {at: [450, 0, 12]", "", 0.0),
    ("center: [40, 20], radius: 15", "center: [40, 290], radius: 15", "zone `wood`", 5.0),
    ("at: [120, 60]", "track: {points: [[0, 0], [0, 400]], speed: 3}", "target `tower`", 100.0),
    ("at: [120, 60]", "track: {start: [0, 320], velocity: [0, -3, 0]}", "target `tower`", 20.0),
    ("at: [120, 60]", "track: {file: gone.csv}", "target `tower`", 10.0),
]


@pytest.mark.slow
@pytest.mark.parametrize(("right", "wrong", "what", "by"), BEYOND)
def test_what_counts_from_ground_that_there_is_not_is_told(folder, right, wrong, what, by):
    (folder / "gone.csv").write_text("t,x,y\n0,0,0\n90,310,0\n")
    text = TEXT.replace(right, wrong).replace("radius: 35,", "radius: 35, timing: {start: 15, duration: 5},")
    told = [d for d in faults(text, folder) if d.code == "G046"]
    assert [what in d.message for d in told] == [True] * bool(what)
    if told:
        place = wrong.split(":")[0]
        assert place in text.splitlines()[told[0].labels[0].span.line - 1]
        assert f"it is {by:.1f} m beyond the ground of `relief.csv`" in told[0].notes[0]


def test_terrain_is_read_about_zones_that_stand_on_it(tmp_path):
    x, y = np.meshgrid(np.arange(-400, 4000, 40.0), np.arange(-400, 401, 40.0), indexing="ij")
    rows = np.column_stack([x.ravel(), y.ravel(), 0.01 * x.ravel()])
    (tmp_path / "relief.csv").write_text("x,y,z\n" + "".join(f"{a:g},{b:g},{c:g}\n" for a, b, c in rows))
    far = TEXT.replace("center: [40, 20]", "center: [3000, 20]")
    assert mission(tmp_path, far).zones[0].solid.bottom == pytest.approx(30.0, abs=1.0)


def test_a_box_without_a_height_stands_on_the_ground(folder):
    zone = "cylinder: {center: [40, 20], radius: 15, height: {above: ground, height: [0, 12]}}"
    assert zone in TEXT
    solid = mission(folder, TEXT.replace(zone, "box: {center: [40, 20], size: [8, 6, 5]}")).zones[0].solid
    x, y = np.meshgrid(np.linspace(36, 44, 50), np.linspace(17, 23, 50))
    heights = under(relief(), np.column_stack([x.ravel(), y.ravel(), 0 * x.ravel()]))
    assert solid.bottom <= heights.min()
    assert solid.top >= heights.max() + 5 - 1e-9
