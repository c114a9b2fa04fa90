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
