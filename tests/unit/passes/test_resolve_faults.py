"""What resolve finds: each fault once, on its line, with its numbers, and all of them in one run."""

from __future__ import annotations

from pathlib import Path

import pytest

from shotc.diag.model import Diagnostic
from tests.front import placed, resolved

HEAD = """\
shotc: 1
mission: faults
world:
  zones:
    tree: {keep: out, cylinder: {center: [-30, 20], radius: 3, height: [0, 12]}}
    field: {keep: in, polygon: {points: [[-80, -80], [80, -80], [80, 80], [-80, 80]], height: [2, 60]}}
    house: {keep: out, box: {center: [30, 30, 4], size: [10, 8, 8]}}
targets:
  tower: {at: [0, 0, 12], radius: 4, height: 24}
drones:
  cam1: {model: x500, home: [0, -60, 0], radius: 0.6,
         limits: {speed: 8, climb: 4, descent: 3, acceleration: 3}}
shots:
"""
FIRST = HEAD.count("\n") + 1


def mission(*shots: str) -> str:
    return HEAD + "".join(f"  - {{drone: cam1, {s}}}\n" for s in shots)


def faults(text: str, folder: Path | None = None) -> list[Diagnostic]:
    return placed(text, folder)[1]


def only(text: str, folder: Path | None = None) -> Diagnostic:
    found = faults(text, folder)
    assert len(found) == 1, found
    return found[0]


def at(x: float, y: float, z: float) -> str:
    """A still camera that looks along the horizon, so that only its place can be at fault."""
    return f"id: a, kind: static, at: [{x}, {y}, {z}], heading: 0 deg, pitch: 0 deg"


def span(d: Diagnostic) -> tuple[int, int, int]:
    s = d.labels[0].span
    return (s.line, s.column, s.end_column)


@pytest.mark.parametrize(
    ("place", "code", "says", "remedy"),
    [
        ((0, -50, -3), "G001", "3.00 m underground", "by 5.60 m, to z = 2.60"),
        ((0, -50, 2.5), "G001", "2.50 m over the ground", "by 0.10 m, to z = 2.60"),
        ((-30, 20, 11), "G002", "inside zone `tree`", "1.61 m up, to [-30.00, 20.00, 12.61]"),
        ((-27.5, 20, 5), "G002", "inside zone `tree`", "1.11 m east, to [-26.39, 20.00, 5.00]"),
        ((-26.6, 20, 5), "G002", "too close to zone `tree`", "0.21 m east, to [-26.39, 20.00, 5.00]"),
        ((30, 34.2, 5), "G002", "too close to zone `house`", "0.41 m north, to [30.00, 34.61, 5.00]"),
        ((35.3, 34.3, 5), "G002", "too close to zone `house`", "north-east"),
        ((81, 0, 20), "G003", "outside keep-in zone `field`", "1.61 m west, to [79.39, 0.00, 20.00]"),
        ((79.5, 0, 20), "G003", "too close to the border of keep-in zone `field`", "0.11 m west"),
        ((0, -50, 70), "G003", "outside keep-in zone `field`", "10.61 m down, to [0.00, -50.00, 59.39]"),
        ((0, -3, 10), "G004", "inside target `tower`", "2.61 m south, to [0.00, -5.61, 10.00]"),
        ((0, -5.5, 10), "G004", "too close to target `tower`", "0.11 m south"),
    ],
)
def test_a_place_that_cannot_be_is_told_with_the_shortest_way_out(
    place: tuple[float, float, float], code: str, says: str, remedy: str
) -> None:
    d = only(mission(at(*place)))
    assert d.code == code
    assert says in d.message
    assert remedy in d.help
    text = mission(at(*place)).splitlines()[FIRST - 1]
    written = f"[{place[0]}, {place[1]}, {place[2]}]"
    assert span(d) == (FIRST, text.index(written) + 1, text.index(written) + 1 + len(written))


@pytest.mark.parametrize(
    "place", [(-30, 20, 11), (-27.5, 20, 5), (30.2, 33, 3), (81, 85, 61), (0, -3, 10), (3, 1, 23)]
)
def test_the_proposed_place_is_free(place: tuple[float, float, float]) -> None:
    moved = only(mission(at(*place))) if place[0] != 81 else faults(mission(at(*place)))[0]
    x, y, z = map(float, moved.help.split("to [")[1].rstrip("]").split(","))
    assert faults(mission(at(x, y, z))) == []


def test_no_way_out_is_proposed_that_another_obstacle_blocks() -> None:
    text = mission(at(-27.5, 20, 5)).replace(
        "    house:", "    wall: {keep: out, box: {center: [-25, 20, 10], size: [2, 20, 20]}}\n    house:"
    )
    (d,) = faults(text)
    assert "east" not in d.help
    assert "up" in d.help


def test_a_generated_path_in_an_obstacle_is_a_warning_unless_all_of_it_is() -> None:
    some = only(
        mission(
            "id: a, kind: orbit, target: tower, radius: 36, altitude: 8, "
            "start_azimuth: 270 deg, sweep: -90 deg"
        )
    )
    assert some.code == "G016"
    assert "tree" in some.message
    dome = mission("id: a, kind: orbit, target: tower, radius: 55, altitude: 8").replace(
        "    house:",
        "    dome: {keep: out, cylinder: {center: [0, 0], radius: 58, height: [0, 30]}}\n    house:",
    )
    assert [d.code for d in faults(dome)] == ["G002"]


def test_the_altitude_of_a_generated_path_binds() -> None:
    text = mission("id: a, kind: elevator, target: tower, azimuth: 180 deg, distance: 50, altitude: [1, 30]")
    d = only(text)
    assert d.code == "G001"
    line = text.splitlines()[FIRST - 1]
    assert span(d)[:2] == (FIRST, line.index("[1, 30]") + 1)


@pytest.mark.parametrize(
    ("home", "code", "says"),
    [
        ("[0, -60, -1]", "G006", "underground"),
        ("[-30, 20, 0]", "G005", "in zone `tree`"),
        ("[-26.5, 20, 0]", "G005", "in zone `tree`"),
        ("[90, 0, 0]", "G005", "outside keep-in zone `field`"),
        ("[79.8, 0, 0]", "G005", "outside keep-in zone `field`"),
        ("[0, 2, 0]", "G005", "in target `tower`"),
    ],
)
def test_a_home_that_cannot_be(home: str, code: str, says: str) -> None:
    d = only(mission(at(0, -50, 10)).replace("[0, -60, 0]", home))
    assert (d.code, says in d.message) == (code, True)
    assert d.labels[0].span.line == 11


def test_a_home_below_a_roof_that_leaves_no_room_to_take_off() -> None:
    roof = "    roof: {keep: out, box: {center: [0, -60, BB], size: [4, 4, 1]}}\n    house:"
    low = mission(at(0, -50, 10)).replace("    house:", roof.replace("BB", "2.5"))
    assert "under zone `roof`" in only(low).message
    high = mission(at(0, -50, 10)).replace("    house:", roof.replace("BB", "8"))
    assert faults(high) == []


def test_a_flight_shorter_than_a_straight_line_allows() -> None:
    shot = (
        "id: a, kind: keyframes, timing: {duration: 10}, keyframes: [{at: [-45, -50, 10], look_at: tower}, "
        "{at: [50, -50, 10], look_at: tower}]"
    )
    d = only(mission(shot))
    # 95 m at 8 m/s take 11.9 s, and 8 / 3 s more for starting and stopping at 3 m/s^2.
    assert d.code == "K004"
    assert "95.0 m" in d.notes[0]
    assert "14.6 s" in d.notes[0]
    assert "14.6 s" in d.help
    line = mission(shot).splitlines()[FIRST - 1]
    assert span(d) == (FIRST, line.index("timing") + 1, line.index("timing") + 7)
    assert faults(mission(shot.replace("duration: 10", "duration: 14.6"))) == []


def test_a_keyframe_past_the_end_needs_the_time_of_what_follows_it() -> None:
    shot = (
        "id: a, kind: keyframes, timing: {duration: 10}, keyframes: ["
        "{at: [0, -50, 10], heading: 0 deg, pitch: 0 deg}, "
        "{at: [0, -40, 10], heading: 0 deg, pitch: 0 deg, time: 12, hold: 2}, LAST]"
    )
    last = "{at: [0, -24, 10], heading: 0 deg, pitch: 0 deg}"
    d = only(mission(shot.replace("LAST", last)))
    assert (d.code, "more than 16.0 s" in d.help) == ("K002", True)
    d = only(mission(shot.replace(", LAST", "")))
    assert (d.code, d.help) == ("K002", "give the shot a duration of 14.0 s or more")
    assert faults(mission(shot.replace(", LAST", "").replace("duration: 10", "duration: 14"))) == []


def test_vertical_limits_bound_the_time_too() -> None:
    shot = "id: a, kind: elevator, target: tower, azimuth: 180 deg, distance: 60, altitude: [45, 5], "
    shot += "timing: {duration: 14}"
    d = only(mission(shot))
    # 40 m down at 3 m/s, and 1 s for starting and stopping at 3 m/s^2.
    assert (d.code, "14.4 s" in d.notes[0]) == ("K004", True)


def test_a_start_that_cannot_be_met_names_the_earliest() -> None:
    d = only(mission(at(0, 50, 10) + ", timing: {start: 5}"))
    # 110 m at 8 m/s from rest to rest.
    assert (d.code, "16.5 s" in d.help) == ("K008", True)
    assert faults(mission(at(0, 50, 10) + ", timing: {start: 16.5}")) == []


def test_endurance_counts_the_whole_flight() -> None:
    text = mission(at(0, -50, 10) + ", timing: {duration: 50}").replace(
        "radius: 0.6,", "radius: 0.6, endurance: 55,"
    )
    d = only(text)
    assert (d.code, "take longer" in d.message) == ("K005", True)
    one = text.replace("duration: 50", "duration: 60")
    assert "is longer than drone" in only(one).message


def test_every_fault_of_the_mission_is_told_in_one_run() -> None:
    text = (
        mission(
            "id: a, kind: keyframes, target: towr, keyframes: [{at: [0, -50, -2], look_at: tower}, "
            "{at: [-30, 20, 5], look_at: tower, time: 3}, {at: [0, 50, 9], look_at: towr, time: 2}]",
            "id: a, kind: static, at: [0, -50, 15], look_at: tower, timing: {after: z}",
            "id: c, kind: orbit, target: tower, radius: 2, altitude: 10",
        )
        .replace("[[-80, -80], [80, -80]", "[[80, 80], [80, -80]")
        .replace("[0, -60, 0]", "[0, -60, -4]")
    )
    found = faults(text)
    # Keyframes of the first shot are not judged: one of them looks at a target that does not exist.
    assert sorted(d.code for d in found) == ["G004", "G006", "G007", "N001", "N004", "N006"]
    (unknown,) = [d for d in found if d.code == "N001"]
    assert len(unknown.labels) == 2


def test_an_unknown_drone_silences_only_what_depends_on_it() -> None:
    text = mission(at(0, -50, 10)).replace("drone: cam1, id: a", "drone: cam2, id: a") + (
        "  - {drone: cam1, id: b, kind: static, at: [0, -50, 1], heading: 0 deg, pitch: 0 deg}\n"
    )
    assert [d.code for d in faults(text)] == ["N002", "G001"]
    assert "`cam1`" in faults(text)[0].help


@pytest.mark.parametrize(
    ("aim", "code", "says"),
    [
        ("heading: 180 deg, pitch: 0 deg", "G008", "180 deg away"),
        ("heading: 270 deg, pitch: 0 deg", "G008", "90 deg away"),
        ("heading: 60 deg, pitch: 0 deg", "G009", "60 deg away"),
        ("heading: 0 deg, pitch: -60 deg", "G009", "60 deg away"),
        ("heading: 0 deg, pitch: 45 deg", "G013", "-90.0 to 30.0 deg"),
        ("look_at: [0, -50, 12]", "G014", ""),
        ("look_at: [0, -60, 12]", "G008", "180 deg away"),
    ],
)
def test_a_framing_that_shows_nothing(aim: str, code: str, says: str) -> None:
    d = only(mission(f"id: a, kind: static, target: tower, at: [0, -50, 12], {aim}"))
    assert (d.code, says in "".join(d.notes)) == (code, True)
    assert d.labels[0].span.line == FIRST


def test_the_proposed_heading_looks_at_the_target() -> None:
    d = only(mission("id: a, kind: static, target: tower, at: [40, -40, 12], heading: 90 deg, pitch: 0 deg"))
    assert "heading: 315 deg, pitch: 0 deg" in d.help
    assert (
        faults(
            mission("id: a, kind: static, target: tower, at: [40, -40, 12], heading: 315 deg, pitch: 0 deg")
        )
        == []
    )


def test_files_stay_in_the_missions_folder(tmp_path: Path) -> None:
    inside, outside = tmp_path / "mission", tmp_path / "secret.csv"
    (inside / "deep").mkdir(parents=True)
    outside.write_text("x,y,z\n0,-50,10\n40,-50,10\n")
    (inside / "link.csv").symlink_to(outside)
    (inside / "up").symlink_to(tmp_path)
    (inside / "loop.csv").symlink_to("loop.csv")
    (inside / "deep" / "own.csv").write_text(outside.read_text())
    (inside / "inner.csv").symlink_to("deep/own.csv")

    def by(name: str) -> list[str]:
        shot = f"id: a, kind: follow-path, file: {name}, heading: along"
        return [d.code for d in resolved(mission(shot), inside)[1]]

    assert by("link.csv") == ["N010"]
    assert by("up/secret.csv") == ["N010"]
    assert by("loop.csv") == ["N008"]
    assert by("deep") == ["N008"]
    assert by("none.csv") == ["N008"]
    assert by("deep/own.csv") == by("inner.csv") == []
    assert [d.code for d in resolved(mission("id: a, kind: follow-path, file: deep/own.csv"), None)[1]] == [
        "N008"
    ]


def test_a_missing_file_proposes_its_neighbours(tmp_path: Path) -> None:
    (tmp_path / "rout.csv").write_text("")
    d = only(mission("id: a, kind: follow-path, file: route.csv"), tmp_path)
    assert "`rout.csv`" in d.help


def test_a_bad_line_of_a_file_is_named(tmp_path: Path) -> None:
    (tmp_path / "r.csv").write_text("x,y,z\n0,-50,10\n0,oops,10\n")
    text = mission("id: a, kind: follow-path, file: r.csv")
    d = only(text, tmp_path)
    assert (d.code, d.notes) == ("N009", ("r.csv, line 3",))
    assert "`oops` is not a number for `y`" in d.message
    line = text.splitlines()[FIRST - 1]
    assert span(d)[:2] == (FIRST, line.index("r.csv") + 1)


@pytest.mark.parametrize(
    ("rows", "says"),
    [
        ("t,x,y,z\n0,0,0,1\n", "two rows"),
        ("t,x,y,z\n0,0,0,1\n1,1,0,1\n1,2,0,1\n", "do not rise"),
        ("t,x,y\n0,0,0\n", "other columns"),
        ("t,x,y,z,heading\n0,0,0,1,0\n1,0,0,nan,0\n", "out of bounds"),
    ],
)
def test_tracks_are_checked_though_they_cannot_be_planned(tmp_path: Path, rows: str, says: str) -> None:
    (tmp_path / "t.csv").write_text(rows)
    text = mission(at(0, -50, 10)).replace(
        "drones:", "  runner: {track: {file: t.csv}, radius: 0.4, height: 1.8}\ndrones:"
    )
    d = only(text, tmp_path)
    assert (d.code, says in d.message) == ("N009", True)
    (tmp_path / "t.csv").write_text("t,x,y,z\n0,0,0,1\n9,5,0,1\n")
    assert faults(text, tmp_path) == []


def test_features_of_later_versions_check_clean_and_are_recorded() -> None:
    text = mission(
        at(0, -50, 10),
        "id: b, kind: chase, target: runner, distance: 8, altitude: 3",
        "id: c, kind: static, at: [0, -40, 10], look_at: runner",
        "id: d, kind: orbit, target: tower, radius: 50, altitude: 20, size: 0.5",
    ).replace(
        "drones:",
        "  runner: {track: {start: [0, 0, 1], velocity: [1, 0, 0]}, radius: 0.4, height: 1.8}\ndrones:",
    )
    value, found = resolved(text)
    assert found == []
    assert value is not None
    assert [d.feature for d in value.deferred] == [
        "a moving target",
        "a shot of kind `chase`",
        "aiming for a size on screen (`size`)",
    ]
    assert [s.id for s in value.shots] == ["a", "d"]


@pytest.mark.parametrize(
    ("points", "says"),
    [
        ("[[0, 0], [1, 0], [0, 0]]", "different corners"),
        ("[[0, 0], [1, 1], [1, 0], [0, 1]]", "crosses"),
        ("[[0, 0], [5, 0], [9, 0]]", "no area"),
    ],
)
def test_polygons_that_enclose_nothing(points: str, says: str) -> None:
    text = mission(at(0, -50, 10)).replace("[[-80, -80], [80, -80], [80, 80], [-80, 80]]", points)
    d = only(text)
    assert (d.code, says in d.message, d.labels[0].span.line) == ("G007", True, 6)


@pytest.mark.parametrize(
    "order",
    [
        "[[-80, -80], [-80, 80], [80, 80], [80, -80]]",
        "[[-80, -80], [80, -80], [80, 80], [-80, 80], [-80, -80]]",
    ],
)
def test_polygons_may_run_either_way_and_close_themselves(order: str) -> None:
    text = mission(at(0, -50, 10)).replace("[[-80, -80], [80, -80], [80, 80], [-80, 80]]", order)
    value, found = resolved(text)
    assert found == []
    assert value is not None
    solid = next(z.solid for z in value.zones if z.name == "field")
    assert sorted(solid.points) == [(-80, -80), (-80, 80), (80, -80), (80, 80)]  # type: ignore[union-attr]


def test_geodetic_positions_need_an_origin_and_say_so_once() -> None:
    text = mission(
        "id: a, kind: static, at: {lat: 47.1, lon: 8.1, height: 10}, heading: 0 deg, pitch: 0 deg",
        "id: b, kind: static, at: {lat: 47.1, lon: 8.2, height: 10}, heading: 0 deg, pitch: 0 deg",
    )
    d = only(text)
    assert (d.code, d.labels[0].span.line) == ("G015", FIRST)
    assert "2 positions" in d.notes[1]


EARTH = "world:\n  origin: {lat: 47.3769, lon: 8.5417, alt: 408}\n"


def on_earth(*shots: str) -> str:
    return mission(*shots).replace("world:\n", EARTH)


@pytest.mark.parametrize(
    ("place", "remedy"),
    [
        ("lat: 8.5417, lon: 47.3765", "look swapped; write `lat: 47.3765, lon: 8.5417`"),
        ("lat: 47.3765, lon: -8.5417", "the longitude looks as if it had the wrong sign"),
        ("lat: -47.3765, lon: 8.5417", "the latitude looks as if it had the wrong sign"),
        ("lat: 51.5, lon: -0.12", "mend the place"),
    ],
)
def test_a_place_far_from_the_origin_is_told_once_with_the_likely_slip(place: str, remedy: str) -> None:
    view = f"kind: static, at: {{{place}, height: 10}}, heading: 0 deg, pitch: 0 deg"
    d = only(on_earth(f"id: a, {view}", f"id: b, {view}"))
    assert (d.code, d.labels[0].span.line) == ("G017", FIRST + 1)
    assert remedy in d.help
    assert "2 positions" in d.notes[1]


def test_an_origin_with_swapped_numbers_is_told() -> None:
    text = on_earth("id: a, kind: static, at: {lat: 47.3765, lon: 8.5417, height: 10}, look_at: tower")
    d = only(text.replace("lat: 47.3769, lon: 8.5417", "lat: 8.5417, lon: 47.3769"))
    assert d.code == "G017"
    assert "swapped" in d.help


def gpx(lat: float, ele: float) -> str:
    points = "".join(f'<trkpt lat="{lat + d}" lon="8.5417"><ele>{ele}</ele></trkpt>' for d in (0, 1e-4))
    return f"<gpx><trk><trkseg>{points}</trkseg></trk></gpx>"


def test_a_track_from_elsewhere_is_one_fault_of_its_file(tmp_path: Path) -> None:
    path = "id: a, kind: follow-path, file: t.gpx"
    (tmp_path / "t.gpx").write_text(gpx(48.1, 428))
    d = only(on_earth(path), tmp_path)
    assert (d.code, "80.4 km" in d.message) == ("G017", True)
    (tmp_path / "t.gpx").write_text(gpx(47.3764, 20))
    d = only(on_earth(path), tmp_path)
    assert d.code == "G001"
    assert "20.0 m looks like a height over the ground" in d.notes[1]
    (tmp_path / "t.gpx").write_text(gpx(47.3764, 428))
    assert faults(on_earth(path), tmp_path) == []
    d = only(on_earth(path).replace(", alt: 408", ""), tmp_path)
    assert (d.code, "no altitude" in d.message) == ("G015", True)


def test_a_height_above_sea_level_is_recognised() -> None:
    d = only(on_earth("id: a, kind: orbit, target: tower, radius: 50, altitude: 428"))
    assert d.code == "G003"
    assert "428.0 m above sea level would be z = 20.0" in d.notes[-1]
    assert "z = 2.60 to 59.40" in d.help
    assert faults(on_earth("id: a, kind: orbit, target: tower, radius: 50, altitude: 59.4")) == []


def test_a_generated_path_is_told_where_it_would_be_free() -> None:
    d = only(mission("id: a, kind: orbit, target: tower, radius: 3, altitude: 20"))
    assert d.code == "G004"
    assert d.help == "stay 5.60 m or more from its axis, or fly at z = 25.60 or higher"


def test_one_slip_in_a_place_is_one_report() -> None:
    shots = "id: a, kind: keyframes, target: tower, timing: {start: 30, duration: 30}, keyframes: ["
    right = "{at: [0, -50, 18], heading: 0 deg, pitch: 0 deg}, {at: [20, -50, 18], look_at: tower}]"
    assert faults(mission(shots + right)) == []
    for slip in ("[500, -50, 18]", "[0, -50, -180]", "[0, 0, 12]"):
        only(mission(shots + right.replace("[0, -50, 18]", slip)))


def test_a_home_is_given_the_way_out() -> None:
    d = only(mission(at(0, -50, 10)).replace("home: [0, -60, 0]", "home: [0, -80, 0]"))
    assert d.help == "move it 0.61 m north, to [0.00, -79.39, 0.00]"
    assert faults(mission(at(0, -50, 10)).replace("home: [0, -60, 0]", "home: [0.00, -79.39, 0.00]")) == []


def test_a_target_beside_the_camera_is_out_of_the_frame_though_it_has_no_outline() -> None:
    aim = "id: a, kind: static, target: tower, at: [-40, -30, 10], pitch: 2 deg, heading: "
    assert only(mission(aim + "142 deg")).code == "G009"
    assert faults(mission(aim + "53 deg")) == []


def test_a_target_given_by_its_foot_is_a_warning() -> None:
    text = mission("id: a, kind: static, at: [0, -60, 10], heading: 0 deg, pitch: 0 deg")
    d = only(text.replace("at: [0, 0, 12]", "at: [0, 0, 0]"))
    assert d.code == "G018"
    assert "z = 12" in d.help
    assert faults(text.replace("at: [0, 0, 12]", "at: [0, 0, 11]")) == []
