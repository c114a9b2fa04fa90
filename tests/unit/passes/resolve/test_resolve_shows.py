"""What resolve makes of fleets and displays, and what it finds wrong with them: places and numbers."""

from __future__ import annotations

from itertools import combinations
from math import dist, pi, sin
from pathlib import Path

import pytest

from shotc.ir.show import Lettering, Model
from tests.support.resolve_missions import at
from tests.support.show_texts import FLEET, SPHERE, faults, marked, only, resolve, show


def test_a_grid_is_square_and_goes_row_by_row() -> None:
    (fleet,) = resolve(
        show(fleet=FLEET.replace("count: 60", "count: 7").replace("[0, 0, 0]", "[10, 20, 1]"))
    ).fleets
    expected = [(10, 20), (14, 20), (18, 20), (10, 24), (14, 24), (18, 24), (10, 28)]
    assert fleet.pads == tuple((float(x), float(y), 1.0) for x, y in expected)
    assert fleet.path == ("fleets", "swarm")


def test_a_circle_is_even() -> None:
    text = show(fleet="swarm: {count: 12, layout: {circle: {radius: 30, center: [5, 0, 0]}}, separation: 2}")
    pads = resolve(text).fleets[0].pads
    assert pads[0] == pytest.approx((5, 30, 0))
    assert pads[3] == pytest.approx((35, 0, 0))
    assert all(dist(p, (5, 0, 0)) == pytest.approx(30) for p in pads)
    assert min(dist(p, q) for p, q in combinations(pads, 2)) == pytest.approx(60 * sin(pi / 12))


def test_a_layout_file_is_read_in_its_order(tmp_path: Path) -> None:
    text = show(fleet="swarm: {count: 3, layout: {file: pads.csv}, separation: 2}")
    (tmp_path / "pads.csv").write_text("x,y,z\n5,0,0\n0,0,0.5\n0,9,0\n")
    assert resolve(text, tmp_path).fleets[0].pads == ((5, 0, 0), (0, 0, 0.5), (0, 9, 0))
    assert only(text, None).code == "N008"
    (tmp_path / "pads.csv").write_text("x,y,z\n5,0,0\n0,zero,0\n0,9,0\n")
    d = only(text, tmp_path)
    assert (d.code, d.notes) == ("N009", ("pads.csv, line 3",))


def test_a_layout_file_may_count_from_the_earth(tmp_path: Path) -> None:
    head = "world: {origin: {lat: 47.0, lon: 8.0, alt: 400}}\n"
    text = show(fleet="swarm: {count: 2, layout: {file: pads.csv}, separation: 2}", head=head)
    (tmp_path / "pads.csv").write_text("lat,lon,height\n47.0,8.0,0\n47.0001,8.0,0\n")
    pads = resolve(text, tmp_path).fleets[0].pads
    assert pads[0] == pytest.approx((0, 0, 0), abs=1e-3)
    assert pads[1] == pytest.approx((0, 11.12, 0), abs=0.01)
    assert only(text.replace(head, ""), tmp_path).code == "G015"


@pytest.mark.parametrize("rows", [2, 4])
def test_a_layout_file_has_a_row_a_drone(tmp_path: Path, rows: int) -> None:
    text = show(fleet="swarm: {count: 3, layout: {file: pads.csv}, separation: 2}")
    (tmp_path / "pads.csv").write_text("".join(f"{9 * i},0,0\n" for i in range(rows)))
    d = only(text, tmp_path)
    assert (d.code, d.help) == ("D004", f"write `count: {rows}`, or give 3 rows")
    assert (marked(d, text), marked(d, text, 1)) == ("pads.csv", "3")


def test_the_preset_fills_in_and_wind_is_taken_off() -> None:
    fleet = FLEET.replace(
        "separation: 2", "separation: 2, limits: {climb: 3}, radius: 0.3, endurance: 9 min, rise: 12"
    )
    found = resolve(show(fleet=fleet, head="world: {wind: 2 m/s}\n")).fleets[0]
    assert (found.limits.speed, found.limits.climb, found.limits.descent) == (3.0, 3.0, 2.0)
    assert (found.radius, found.endurance, found.rise, found.model) == (0.3, 540.0, 12.0, "show-drone")


def test_wind_that_leaves_no_speed_is_told_once() -> None:
    text = show(head="world: {wind: 5 m/s}\n")
    d = only(text)
    assert (d.code, marked(d, text)) == ("K011", "5 m/s")
    assert "fleet `swarm`" in d.message


def test_a_display_is_a_record_and_no_shot() -> None:
    text = show(
        SPHERE,
        "{text: {text: HI, center: [0, 0, 40], height: 12, font: DejaVu Sans}, fill: outline, transition: 9}",
        display="    pace: calm\n    timing: {start: 30}\n    viewpoint: [0, -80, 2]\n",
    )
    found = resolve(text)
    (display,) = found.displays
    assert (found.shots, found.deferred, found.rate) == ((), (), 5.0)
    assert (display.id, display.fleet, display.pace, display.timing.start) == ("a", "swarm", 0.5, 30.0)
    assert display.viewpoint == (0.0, -80.0, 2.0)
    assert [p.path for p in display.pictures] == [("shots", 0, "frames", 0), ("shots", 0, "frames", 1)]
    assert display.pictures[1].source == Lettering("HI", (0.0, 0.0, 40.0), 12.0, 0.0, "DejaVu Sans")
    assert (display.pictures[1].fill, display.pictures[1].transition, display.pictures[0].hold) == (
        "outline",
        9,
        4,
    )


def test_a_mission_may_film_as_well() -> None:
    camera = "  - {drone: cam1, " + at(0, -50, 10).replace("id: a", "id: b") + "}\n"
    text = show(more=camera).replace("fleets:", "drones: {cam1: {home: [0, -60, 0]}}\nfleets:")
    found = resolve(text)
    assert found.deferred == ()
    assert (len(found.shots), len(found.displays), found.rate) == (1, 1, 50.0)


def test_a_fleet_and_a_name_that_is_unknown() -> None:
    text = show().replace("fleet: swarm", "fleet: swam")
    assert (only(text).code, only(text).help) == ("N003", "did you mean `swarm`?")


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("target", "x"),
        ("composition", "thirds"),
        ("size", "full"),
        ("require", "{in_frame: 1}"),
        ("allow", "[]"),
    ],
)
def test_what_only_cameras_have_is_refused(key: str, value: str) -> None:
    text = show(
        display=f"    {key}: {value}\n", head="targets: {x: {at: [90, 0, 2], radius: 1, height: 4}}\n"
    )
    d = only(text)
    assert (d.code, marked(d, text)) == ("D008", key)


def test_a_weight_needs_a_viewpoint() -> None:
    text = show(display="    viewpoint_weight: 0.2\n")
    assert (only(text).code, marked(only(text), text)) == ("D008", "viewpoint_weight")


def test_animations_are_sorted_as_people_count(tmp_path: Path) -> None:
    (tmp_path / "walk").mkdir()
    for name in ("w10.ply", "w2.ply", "w1.ply", ".w3.ply", "w4.txt", "x[1].ply"):
        (tmp_path / "walk" / name).write_text(name)
    (tmp_path / "walk" / "w5.ply").mkdir()
    text = show("{model: {files: walk/w*.ply, period: 1, center: [0, 0, 30], height: 20, heading: 90 deg}}")
    found = resolve(text, tmp_path)
    names = ("walk/w1.ply", "walk/w2.ply", "walk/w10.ply")
    assert found.displays[0].pictures[0].source == Model(
        names, 1.0, (0.0, 0.0, 30.0), 20.0, pytest.approx(pi / 2)
    )
    assert found.files == tuple((name, name.removeprefix("walk/").encode()) for name in names)
    short = show().split("    frames:")[0] + "    frames: {files: 'walk/w?.ply', period: 2, units: m}\n"
    (picture,) = resolve(short, tmp_path).displays[0].pictures
    assert picture.source == Model(names[:2], 2.0, None, None, 0.0)
    assert picture.path == ("shots", 0, "frames")
    literal = show("{model: {files: 'walk/x[1].ply', units: m}}")
    assert [name for name, _ in resolve(literal, tmp_path).files] == ["walk/x[1].ply"]


def test_several_files_need_a_period(tmp_path: Path) -> None:
    for i in range(3):
        (tmp_path / f"{i}.obj").write_text("v 0 0 0")
    text = show("{model: {files: '*.obj', units: m}}")
    d = only(text, tmp_path)
    assert (d.code, marked(d, text)) == ("D010", "'*.obj'")
    assert d.notes == ("`*.obj` matches 3 files, `0.obj` to `2.obj`",)
    assert len(resolve(show("{model: {files: 0.obj, units: m}}"), tmp_path).files) == 1


def test_no_pattern_leaves_the_folder(tmp_path: Path) -> None:
    inside, outside = tmp_path / "mission", tmp_path / "secret"
    inside.mkdir()
    outside.mkdir()
    (outside / "a.ply").write_text("ply")
    (inside / "link.ply").symlink_to(outside / "a.ply")
    (inside / "up").symlink_to(outside)

    def codes(pattern: str) -> list[str]:
        return [
            d.code for d in faults(show(f"{{model: {{files: '{pattern}', period: 1, units: m}}}}"), inside)
        ]

    assert codes("*.ply") == ["N010"]
    assert codes("up/*.ply") == ["N008"]
    assert codes("*/a.ply") == ["N008"]
    assert codes("none/*.ply") == ["N008"]
    assert codes("*.stl") == ["N008"]
    assert codes("link.ply") == ["N010"]
    assert codes("a.ply") == ["N008"]


@pytest.mark.long
def test_too_much_to_read_is_not_read(tmp_path: Path) -> None:
    with (tmp_path / "huge.ply").open("wb") as stream:
        stream.truncate(1_000_000_000)
    (tmp_path / "empty.ply").write_text("")
    d = only(show("{model: {files: huge.ply, units: m}}"), tmp_path)
    assert (d.code, "1000.0 MB" in d.message) == ("N009", True)
    assert "empty" in only(show("{model: {files: empty.ply, units: m}}"), tmp_path).message
    for i in range(5):
        with (tmp_path / f"part{i}.stl").open("wb") as stream:
            stream.truncate(60_000_000)
    d = only(show("{model: {files: 'part*.stl', period: 1, units: m}}"), tmp_path)
    assert (d.code, "more than 256 MB" in d.message) == ("N009", True)


@pytest.mark.parametrize(
    ("picture", "slip"),
    [
        ("{model: {files: a.fbx}}", "a.fbx"),
        ("{svg: {file: a.pdf, center: [0, 0, 40], height: 9}}", "a.pdf"),
        ("{text: {text: A, center: [0, 0, 40], height: 9, font: a.woff2}}", "a.woff2"),
    ],
)
def test_the_ending_tells_the_format(picture: str, slip: str) -> None:
    text = show(picture)
    assert (only(text).code, marked(only(text), text)) == ("D011", slip)


def test_drawings_are_looked_into(tmp_path: Path) -> None:
    text = show("{svg: {file: a.svg, center: [0, 0, 40], height: 9}}")
    (tmp_path / "a.svg").write_text("<svg>\n<script/></svg>")
    d = only(text, tmp_path)
    assert (d.code, d.notes, marked(d, text)) == ("D022", ("a.svg, line 2",), "a.svg")
    (tmp_path / "a.svg").write_text("<svg>")
    assert only(text, tmp_path).code == "N009"
    (tmp_path / "a.svg").write_text("<svg><path d='M0 0'/></svg>")
    assert len(resolve(text, tmp_path).files) == 1


def test_crowded_pads_are_named_with_what_would_do() -> None:
    fleet = FLEET.replace("separation: 2", "separation: {horizontal: 4, margin: 0.15}")
    text = show(fleet=fleet.replace("spacing: 4", "spacing: 0.6"))
    d = only(text)
    assert (d.code, marked(d, text)) == ("D001", "0.6")
    assert "are 0.60 m apart" in d.notes[0]
    assert "0.65 m side by side, its margin of 0.15 m included" in d.notes[0]
    assert d.help == "give the grid a spacing of 0.65 m or more"
    assert faults(text.replace("spacing: 0.6,", "spacing: 0.65,")) == []


def test_pads_that_take_too_many_layers() -> None:
    text = show(fleet="swarm: {count: 400, layout: {grid: {spacing: 0.6}}, separation: 9}")
    d = only(text)
    assert (d.code, marked(d, text)) == ("D001", "0.6")
    assert d.notes[0].endswith("as many layers or more, and 64 is the most")
    assert "spacing of 9.01 m or more" in d.help
    assert faults(text.replace("separation: 9", "separation: 4")) == []


def test_layers_above_what_the_mission_allows() -> None:
    fleet = FLEET.replace("separation: 2", "separation: {horizontal: 2, vertical: 4}")
    text = show(fleet=fleet.replace("spacing: 4", "spacing: 1"), head="rules: {max_height: 58}\n")
    d = only(text.replace("58", "21"))  # four layers: 10 m, and three times 4.004 m
    assert (d.code, marked(d, text)) == ("D027", "1")
    assert "highest is 22.01 m above the ground" in d.notes[0]
    assert "max_height: 23" in d.help
    assert faults(text) == []


def test_a_crowded_circle_is_told_its_radius() -> None:
    text = show(fleet="swarm: {count: 40, layout: {circle: {radius: 3}}, separation: 2}")
    d = only(text)
    radius = float(d.help.split("radius of ")[1].split(" ")[0])
    assert radius == pytest.approx(0.25 / sin(pi / 40), abs=0.01)
    assert faults(text.replace("radius: 3", f"radius: {radius}")) == []


def test_pads_above_each_other_are_measured_as_the_fleet_says(tmp_path: Path) -> None:
    """Where a fleet rises all at once, one may rise above another; past it none can."""
    (tmp_path / "pads.csv").write_text("0,0,0\n0,0,3\n20,0,0\n")
    fleet = "swarm: {count: 3, layout: {file: pads.csv}, separation: {horizontal: 2, vertical: 4}}"
    d = only(show(fleet=fleet), tmp_path)
    assert (d.code, d.notes[0].startswith("pads 1 and 2 are 0.00 m apart, as seen")) == ("D001", True)
    assert faults(show(fleet=fleet.replace("vertical: 4", "vertical: 3")), tmp_path) == []


def test_pads_of_two_fleets() -> None:
    other = "  other: {count: 4, layout: {grid: {spacing: 5, origin: [31, 0, 0]}}, separation: 4}\n"
    more = "  - {id: b, kind: display, fleet: other, frames: [" + SPHERE + "]}\n"
    text = show(more=more).replace("shots:\n", other + "shots:\n")
    d = only(text)
    assert (d.code, marked(d, text), marked(d, text, 1)) == ("D005", "[31, 0, 0]", "[0, 0, 0]")
    assert "are 3.00 m apart; 4.00 m side by side is asked for" in d.notes[0]
    assert faults(text.replace("[31, 0, 0]", "[32, 0, 0]")) == []


def test_pads_underground_and_pads_under_a_roof() -> None:
    text = show(fleet=FLEET.replace("[0, 0, 0]", "[0, 0, -1.5]"))
    d = only(text)
    assert (d.code, marked(d, text)) == ("D006", "[0, 0, -1.5]")
    assert d.help == "raise the layout by 1.50 m, to `origin: [0.00, 0.00, 0.00]`"
    roof = "world: {zones: {roof: {box: {center: [12, 12, 8], size: [3, 3, 1]}}}}\n"
    d = only(show(head=roof))
    assert d.code == "D006"
    assert d.message.startswith("1 of 60 drones")
    low = roof.replace("8]", "14]")
    assert faults(show(head=low)) == []


def test_a_rise_ends_where_one_may_fly() -> None:
    band = "world: {zones: {sky: {box: {center: [0, 0, 50], size: [200, 200, 80]}, keep: in}}}\n"
    text = show(head=band)
    d = only(text)
    assert (d.code, d.help) == ("D007", "write `rise: 10.25 m` or more")
    assert marked(d, text, 1) == "sky"
    assert faults(text.replace("separation: 2", "separation: 2, rise: 10.25")) == []


@pytest.mark.parametrize("ending", ["ply", "obj", "stl"])
def test_a_model_whose_size_nobody_says_is_told_with_what_says_it(tmp_path: Path, ending: str) -> None:
    (tmp_path / f"a.{ending}").write_bytes(b"solid")
    fault = only(show(f"{{model: {{files: a.{ending}, center: [0, 0, 40]}}}}"), tmp_path)
    assert fault.code == "D025"
    for word in ("units: m", "height: 10"):
        assert "D025" not in [
            d.code for d in faults(show(f"{{model: {{files: a.{ending}, {word}}}}}"), tmp_path)
        ]


def test_a_glb_needs_no_units(tmp_path: Path) -> None:
    (tmp_path / "a.glb").write_bytes(b"glTF")
    assert [d.code for d in faults(show("{model: {files: a.glb, center: [0, 0, 40]}}"), tmp_path)] == []


@pytest.mark.slow
def test_tables_and_recordings_of_large_shows_are_made_where_they_are_asked_for() -> None:
    small, large = (FLEET.replace("count: 60", f"count: {n}") for n in (60, 2001))
    assert resolve(show(fleet=small)).emit == ("csv", "skyc", "contact-sheet", "animatic", "rerun")
    assert resolve(show(SPHERE.replace("radius: 15", "radius: 35"), fleet=large)).emit == (
        "skyc",
        "contact-sheet",
        "animatic",
    )
    asked = show(fleet=large) + "output: {emit: [csv]}\n"
    assert resolve(asked).emit == ("csv",)
