"""What resolve makes of tracks that are lifted, that lie on the ground, or that are smoothed."""

from __future__ import annotations

from math import cos, sin
from pathlib import Path
from random import Random

import pytest

from shotc.diag.model import Diagnostic
from tests.support.front_passes import resolved
from tests.support.tracks_of_missions import gpx, only, recorded, stamp, track_of, written


def above(track: str, *, earth: bool = False) -> str:
    """Return the mission with a shot whose height counts from the foot, wherever that is."""
    text = written(track, timing="duration: 2", earth=earth)
    return text.replace("altitude: 4", "altitude: {above: target, height: 4}")


def test_a_lift_puts_the_centre_over_what_is_recorded(tmp_path: Path) -> None:
    lifted = track_of(above(recorded(tmp_path, "t,x,y,z\n0,0,0,2\n9,9,0,4\n") + ", lift: 0.9 m"), tmp_path)
    assert [p[2] for p in lifted.points] == [2.9, 4.9]
    road = above(recorded(tmp_path, gpx(stamp(7), stamp(17)), "t.gpx") + ", lift: 0.9", earth=True)
    assert track_of(road, tmp_path).points[0] == pytest.approx((0.0, 0.0, 1.8), abs=1e-6)
    points = track_of(above("points: [[0, 0, 2], [9, 0, 4]], speed: 1, lift: 0.5"))
    assert [p[2] for p in points.points] == [2.5, 4.5]


def test_a_lift_above_ground_leaves_heights_out(tmp_path: Path) -> None:
    lift = ", lift: {above: ground, height: 1.1 m}"
    for recording in ("t,x,y,z\n0,0,0,2\n9,9,0,4\n", "t,x,y,z\n0,0,0,-7\n9,9,0,40\n"):
        track = track_of(above(recorded(tmp_path, recording) + lift), tmp_path)
        assert [p[2] for p in track.points] == [1.1, 1.1]
    track = track_of(above("points: [[0, 0, 2], [9, 0, 4]], speed: 1" + lift))
    assert [p[2] for p in track.points] == [1.1, 1.1]


def test_a_lift_counts_from_the_track_or_the_ground_alone() -> None:
    told = only(above("points: [[0, 0, 2], [9, 0, 4]], speed: 1, lift: {above: origin, height: 1}"))
    assert told.code == "S007"
    assert "`above: ground`" in (told.help or "")


@pytest.mark.parametrize(("lift", "z"), [("", 0.9), (", lift: 1.2", 1.2)])
@pytest.mark.parametrize(
    "track",
    [
        "points: [[0, 0], [9, 0]], speed: 1",
        "points: [[0, 0], {lat: 47.377, lon: 8.5417}], speed: 1",
        "start: [0, 0], velocity: [1, 0, 0]",
        "file: xy.csv",
        "file: degrees.csv",
        "file: level.gpx",
    ],
)
def test_a_track_without_heights_stands_on_the_ground(
    tmp_path: Path, track: str, lift: str, z: float
) -> None:
    (tmp_path / "xy.csv").write_text("t,x,y\n0,0,0\n9,9,0\n")
    (tmp_path / "degrees.csv").write_text("t,lat,lon\n0,47.3769,8.5417\n10,47.377,8.5417\n")
    (tmp_path / "level.gpx").write_text(gpx(stamp(0), stamp(9), ele=""))
    found = track_of(above(track + lift, earth=True), tmp_path)
    assert {round(p[2], 9) for p in found.points} == {z}


def test_a_point_of_many_without_its_elevation_is_told(tmp_path: Path) -> None:
    rows = gpx(stamp(0), stamp(9)).replace("<ele>408.9</ele>", "", 1)
    told = only(written(recorded(tmp_path, rows, "t.gpx"), earth=True), tmp_path)
    assert (told.code, told.notes) == ("N009", ("t.gpx, line 2",))
    assert "no elevation" in told.message


def test_smoothing_moves_rows_and_says_how_far(tmp_path: Path) -> None:
    rows = "t,x,y,z\n" + "".join(f"{t},{t},{0.2 * (t % 2)},0.9\n" for t in range(30))
    raw = track_of(written(recorded(tmp_path, rows)), tmp_path)
    calm = track_of(written(recorded(tmp_path, rows) + ", smooth: 2 s"), tmp_path)
    assert (raw.smoothed, calm.times) == (0.0, raw.times)
    assert calm.smoothed == pytest.approx(0.1, abs=0.03)
    assert max(abs(y - 0.1) for _, y, _ in calm.points[4:-4]) < 0.02
    assert max(abs(a[1] - b[1]) for a, b in zip(raw.points, calm.points, strict=True)) == calm.smoothed


def test_smoothing_is_for_recordings() -> None:
    told = only(written("points: [[0, 0], [9, 0]], speed: 1, smooth: 2 s"))
    assert told.code == "S005"


def noisy_gpx(deviation: float) -> str:
    """A ride as receivers record it: a row a second, metres of noise that lasts, elevations to a tenth."""
    random, drift, rows = Random(5), [0.0, 0.0, 0.0], []
    for t in range(60):
        drift = [
            0.7 * d + random.gauss(0, s * deviation) for d, s in zip(drift, (0.4, 0.4, 0.8), strict=True)
        ]
        north, east = 60 * sin(0.1 * t) + drift[0], 60 * (1 - cos(0.1 * t)) + drift[1]
        place = f'lat="{47.3769 + north / 111_200:.7f}" lon="{8.5417 + east / 75_400:.7f}"'
        time = f"<time>2024-05-01T12:00:{t:02d}Z</time>"
        rows.append(f"<trkpt {place}><ele>{412 + 0.15 * t + drift[2]:.1f}</ele>{time}</trkpt>")
    return f"<gpx><trk><trkseg>{''.join(rows)}</trkseg></trk></gpx>"


def shaken(folder: Path, data: str, more: str = "") -> list[Diagnostic]:
    track = f"{recorded(folder, data, 't.gpx')}, lift: 0.9{more}"
    text = written(track, timing="start: 15, duration: 20", earth=True)
    found = resolved(text.replace("altitude: 4", "altitude: {above: target, height: 4}"), folder)[1]
    return found


def test_a_noisy_recording_is_told_with_a_number_and_smoothing_mends_it(tmp_path: Path) -> None:
    (told,) = shaken(tmp_path, noisy_gpx(1.0))
    assert (told.code, told.help) == ("G047", "write `smooth: 2 s` in the track")
    assert 0.02 < float(told.message.split("by ")[1].split(" of half")[0]) < 0.2
    assert "m (rms) from their course" in told.notes[0]
    assert shaken(tmp_path, noisy_gpx(1.0), ", smooth: 2 s") == []
    (still,) = shaken(tmp_path, noisy_gpx(1.0), ", smooth: 0.3 s")
    assert still.code == "G047"


def test_a_calm_recording_is_not_told(tmp_path: Path) -> None:
    assert shaken(tmp_path, noisy_gpx(0.0)) == []
    assert shaken(tmp_path, noisy_gpx(0.05)) == []
