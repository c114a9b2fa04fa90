"""What resolve finds of places in latitude and longitude."""

from __future__ import annotations

from pathlib import Path

import pytest

from shotc.diag.model import Diagnostic
from tests.support.resolve_missions import FIRST, faults, mission, only


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
        ("lat: 51.5, lon: -0.12", "correct the place"),
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


@pytest.mark.parametrize("height", ["", ", height: 0", ", height: 0 m"])
@pytest.mark.parametrize("lat", ["47.3768", "47.3750", "47.4200"])
def test_a_home_on_the_ground_is_not_under_it_wherever_it_is(lat: str, height: str) -> None:
    home = f"home: {{lat: {lat}, lon: 8.5417{height}}}"
    text = on_earth("id: a, kind: static, at: [0, -50, 15], look_at: tower")
    found = faults(text.replace("home: [0, -60, 0]", home))
    assert not [d for d in found if d.code == "G006"]


def test_the_height_that_a_low_camera_is_told_is_enough() -> None:
    def seen(height: str) -> list[Diagnostic]:
        place = f"{{lat: 47.3763, lon: 8.5417, height: {height}}}"
        return faults(on_earth(f"id: a, kind: static, at: {place}, heading: 0 deg, pitch: 0 deg"))

    (low,) = seen("1")
    assert low.code == "G001"
    assert not seen(low.help.rpartition("z = ")[2])


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


VALLEY = """\
shotc: 1
mission: valley
world:
  origin: {lat: 46.6812, lon: 7.6791, alt: 558}
  zones:
    tree: {keep: out, cylinder: {center: [60, 60], radius: 3, height: [0, 12]}}
    wood: {keep: out, polygon: {points: [[90, 60], [99, 60], [99, 70]], height: [0, 12]}}
    hut: {keep: out, box: {center: [60, -90, 2], size: [4, 4, 4]}}
targets:
  tower: {at: [0, 0, 12], radius: 4, height: 24}
  rider: {track: {points: [[-90, 90, 0.9], [-80, 90, 0.9]], speed: 2}, radius: 0.4, height: 1.8}
drones:
  cam1: {model: x500, home: [0, -60]}
shots:
  - {id: a, kind: static, drone: cam1, at: [0, -50, 15], look_at: [1, 0, 12]}
  - id: b
    kind: keyframes
    drone: cam1
    keyframes: [{at: [0, -50, 15], look_at: tower}, {at: [8, -50, 15], look_at: tower}]
  - {id: c, kind: follow-path, drone: cam1, look_at: tower, points: [[0, -55, 15], [9, -50, 15]]}
"""
PASTED = [
    ("home: ", "[0, -60]", "[46.68, 7.68]", "{lat: 46.68, lon: 7.68}"),
    ("at: ", "[0, 0, 12]", "[46.68, 7.68, 12]", "{lat: 46.68, lon: 7.68, height: 12}"),
    ("at: ", "[0, 0, 12]", "[7.68, 46.68, 12]", "{lat: 46.68, lon: 7.68, height: 12}"),
    ("", "[-90, 90, 0.9]", "[46.68, 7.68, 0.9]", "{lat: 46.68, lon: 7.68, height: 0.9}"),
    ("at: ", "[8, -50, 15]", "[46.68, 7.68, {above: ground, height: 9}]",
     "{lat: 46.68, lon: 7.68, height: {above: ground, height: 9}}"),
    ("look_at: ", "[1, 0, 12]", "[46.68, 7.68]", "{lat: 46.68, lon: 7.68}"),
    ("", "[9, -50, 15]", "[46.68, 7.68, 15]", "{lat: 46.68, lon: 7.68, height: 15}"),
    ("center: ", "[60, 60]", "[46.68, 7.68]", "{lat: 46.68, lon: 7.68}"),
    ("", "[90, 60]", "[46.68, 7.68]", "{lat: 46.68, lon: 7.68}"),
    ("center: ", "[60, -90, 2]", "[46.68, 7.68, 2]", "{lat: 46.68, lon: 7.68, height: 2}"),
]  # fmt: skip


@pytest.mark.parametrize(("key", "right", "slip", "place"), PASTED)
def test_degrees_written_as_metres_are_told_with_what_to_write(
    key: str, right: str, slip: str, place: str
) -> None:
    assert key + right in VALLEY
    assert "G045" not in {d.code for d in faults(VALLEY)}
    text = VALLEY.replace(key + right, key + slip)
    (told,) = [d for d in faults(text) if d.code == "G045"]
    assert told.help == f"write `{key}{place}`"
    assert "47.3 m from the origin in metres" in told.notes[0]
    marked = told.labels[0].span
    assert text.splitlines()[marked.line - 1][marked.column - 1 : marked.end_column - 1] == slip
    assert not {"G045", "S007"} & {d.code for d in faults(text.replace(slip, place))}


@pytest.mark.parametrize(
    ("text", "place"),
    [
        ("46.68, 7.68", "{lat: 46.68, lon: 7.68}"),
        ("46.68012 7.68034", "{lat: 46.68012, lon: 7.68034}"),
        ("(46.68, -7.68, 560 m)", "{lat: 46.68, lon: -7.68, height: 560}"),
        ("46.68° S, 7.68° W", "{lat: -46.68, lon: -7.68}"),
        ("46°40'48.0\\\"N 7°40'48.0\\\"E", "{lat: 46.68, lon: 7.68}"),
    ],
)
@pytest.mark.parametrize(
    "right", ["home: [0, -60]", "at: [0, 0, 12]", "at: [8, -50, 15]", "look_at: [1, 0, 12]"]
)
def test_a_pasted_text_is_told_with_what_to_write(right: str, text: str, place: str) -> None:
    pasted = VALLEY.replace(right, f'{right.partition(":")[0]}: "{text}"')
    (told,) = faults(pasted)
    assert (told.code, told.help) == ("S007", f"write `{place}`")


def test_a_pasted_text_of_a_zone_has_no_height() -> None:
    (told,) = faults(VALLEY.replace("[60, 60]", '"46.68, 7.68, 560"'))
    assert told.help == "write `{lat: 46.68, lon: 7.68}`"


def test_metres_that_are_no_degrees_of_this_place_are_not_told() -> None:
    for place in ("[46.7, 7.7, 12]", "[46.2, 7.68, 12]", "[-46.68, 7.68, 12]", "[47, 8, 12]"):
        assert "G045" not in {
            d.code for d in faults(VALLEY.replace("[0, 0, 12], radius", f"{place}, radius"))
        }
    at_zero = VALLEY.replace("lat: 46.6812, lon: 7.6791", "lat: 0.01, lon: 0.02")
    assert "G045" not in {d.code for d in faults(at_zero.replace("at: [0, 0, 12]", "at: [0.01, 0.02, 12]"))}


def test_places_on_earth_of_zones_are_where_they_are_in_metres() -> None:
    east = faults(VALLEY.replace("center: [60, 60]", "center: {lat: 51, lon: 7.68}"))
    assert [d.code for d in east] == ["G017"]
    assert (
        faults(
            VALLEY.replace("world:\n  origin: {lat: 46.6812, lon: 7.6791, alt: 558}", "world:").replace(
                "center: [60, 60]", "center: {lat: 51, lon: 7.68}"
            )
        )[0].code
        == "G015"
    )


def test_many_slips_are_told_one_by_one_up_to_ten() -> None:
    points = ", ".join(f"[46.68{i}, 7.68{i}, 15]" for i in range(10, 30))
    found = [d for d in faults(VALLEY.replace("[0, -55, 15], [9, -50, 15]", points)) if d.code == "G045"]
    assert len(found) == 10
    assert found[-1].notes[-1] == "10 more places of this mission look like this"
