"""What resolve makes of the tracks of targets, and what it finds wrong with them."""

from __future__ import annotations

from itertools import pairwise
from math import pi, radians
from pathlib import Path

import pytest

from shotc.geom.track import Track
from tests.support.few import few
from tests.support.front_passes import resolved
from tests.support.tracks_of_missions import LINE, SIDE, gpx, only, recorded, stamp, track_of, written


def test_a_table_of_metres_is_as_it_is_written(tmp_path: Path) -> None:
    track = track_of(written(recorded(tmp_path, "x,y,t,z\n0,1,-2,1\n8,9,20,1\n")), tmp_path)
    assert track == Track((-2.0, 20.0), ((0, 1, 1), (8, 9, 1)), since=-2.0, until=20.0)


@pytest.mark.parametrize(("column", "north_east"), [("heading", pi / 4), ("heading_deg", 45.0)])
def test_headings_are_compass_bearings_in_the_unit_of_their_column(
    tmp_path: Path, column: str, north_east: float
) -> None:
    rows = f"t,x,y,z,{column}\n0,0,0,1,0\n9,0,9,1,{north_east}\n"
    assert track_of(written(recorded(tmp_path, rows)), tmp_path).headings == pytest.approx((pi / 2, pi / 4))


def test_headings_turn_the_shorter_way_across_north_and_south(tmp_path: Path) -> None:
    rows = "t,x,y,z,heading_deg\n" + "".join(
        f"{9 * i},{i},0,1,{h}\n" for i, h in enumerate([350, 10, 170, 190, -160])
    )
    headings = track_of(written(recorded(tmp_path, rows), timing="duration: 2"), tmp_path).headings
    turns = [b - a for a, b in pairwise(headings)]
    assert turns == pytest.approx([radians(t) for t in (-20, -160, -20, -10)])


def test_a_table_of_degrees_stands_on_the_ground_of_the_origin(tmp_path: Path) -> None:
    rows = "t,lat,lon,height\n0,47.3769,8.5417,0.9\n10,47.377,8.5417,0.9\n"
    track = track_of(written(recorded(tmp_path, rows), earth=True), tmp_path)
    assert track.points[0] == pytest.approx((0.0, 0.0, 0.9), abs=1e-6)
    assert track.points[1] == pytest.approx((0.0, 11.1, 0.9), abs=0.05)


def test_a_gpx_track_counts_from_its_first_point(tmp_path: Path) -> None:
    text = written(recorded(tmp_path, gpx(stamp(7), stamp(8.5), stamp(17)), "t.gpx"), earth=True)
    track = track_of(text, tmp_path)
    assert track.times == (0.0, 1.5, 10.0)
    assert (track.since, track.until) == (0.0, 10.0)
    assert track.points[0] == pytest.approx((0.0, 0.0, 0.9), abs=1e-6)


def test_times_of_other_zones_and_of_none_are_compared_in_utc(tmp_path: Path) -> None:
    times = ("<time>2024-05-01T12:00:00</time>", "<time> 2024-05-01T14:00:02+02:00 </time>", stamp(9))
    text = written(recorded(tmp_path, gpx(*times), "t.GPX"), earth=True)
    assert track_of(text, tmp_path).times == (0.0, 2.0, 9.0)


def test_the_time_of_an_extension_is_not_the_points(tmp_path: Path) -> None:
    inner = "<extensions><time>oops</time><ele>1</ele></extensions>"
    text = written(recorded(tmp_path, gpx(stamp(1) + inner, stamp(9)), "t.gpx"), earth=True)
    assert track_of(text, tmp_path).times == (0.0, 8.0)


@pytest.mark.parametrize(
    ("points", "ele", "note", "says"),
    [
        (("", ""), "<ele>409</ele>", "t.gpx, line 2", "no times"),
        ((stamp(1), ""), "<ele>409</ele>", "t.gpx, line 3", "a point has no time"),
        ((stamp(1), "<time>noon</time>"), "<ele>409</ele>", "t.gpx, line 3", "`noon` is not a time"),
        ((stamp(1), "<time></time>"), "<ele>409</ele>", "t.gpx, line 3", "`` is not a time"),
        ((stamp(1),), "<ele>409</ele>", "t.gpx, line 2", "one row"),
        ((stamp(1), stamp(5), stamp(4)), "<ele>409</ele>", "t.gpx, line 4", "do not rise"),
    ],
)
def test_a_gpx_that_is_no_track_names_its_line(
    tmp_path: Path, points: tuple[str, ...], ele: str, note: str, says: str
) -> None:
    d = only(written(recorded(tmp_path, gpx(*points, ele=ele), "t.gpx"), earth=True), tmp_path)
    assert (d.code, d.notes) == ("N009", (note,))
    assert says in d.message


@pytest.mark.parametrize(
    ("rows", "line", "says"),
    [
        ("t,x,y,z\n", None, "no rows"),
        ("t,x,y,z\n0,0,0,1\n", 2, "one row"),
        ("t,x,y,z\n0,0,0,1\n\n# rest\n1,1,0,1\n1,2,0,1\n", 6, "line 6 repeats the 1 s of line 5"),
        ("t,x,y,z\n0,0,0,1\n2,1,0,1\n1.5,2,0,1\n", 4, "line 4 says 1.5 s, line 3 2 s"),
        ("0,0,0,1\n86400.25,1,0,1\n86400.125,2,0,1\n", 3, "line 3 says 86400.125 s, line 2 86400.25 s"),
        ("t,x,y,z\n0,0,0,1\n9,nan,0,1\n", 3, "`nan` is out of bounds for `x`"),
        ("t,x,y,z\n0,0,0,1\n9,1e999,0,1\n", 3, "out of bounds"),
        ("t,x,y,z\n0,0,0,1\n9,5 m,0,1\n", 3, "`5 m` is not a number for `x`"),
        ("t,x,y,z\n1714558800,0,0,1\n", 2, "out of bounds for `t`"),
        ("t,x,y,z\n0,0,0,1\n9,5,0,1,90\n", 3, "5 columns, not 4"),
        ("t,x,y,z,heading\n0,0,0,1,0\n9,5,0,1,90\n", 3, "`90` is out of bounds for `heading`"),
        ("t,x,lat,z\n0,0,0,1\n", 1, "both metres and degrees"),
        ("t,x,x,z\n0,0,0,1\n", 1, "names `x` twice"),
        ("t,x\n0,0\n", 1, "other columns"),
        ("time,x,y,z\n0,0,0,1\n", 1, "other columns"),
    ],
)
def test_a_table_that_is_no_track_names_its_line(
    tmp_path: Path, rows: str, line: int | None, says: str
) -> None:
    d = only(written(recorded(tmp_path, rows)), tmp_path)
    assert (d.code, d.notes) == ("N009", ("t.csv" if line is None else f"t.csv, line {line}",))
    assert says in d.message
    assert d.help
    assert d.labels[0].span.line == LINE


def test_degrees_need_an_origin_and_elevations_its_altitude(tmp_path: Path) -> None:
    table = recorded(tmp_path, "t,lat,lon,height\n0,47.3769,8.5417,1\n9,47.377,8.5417,1\n")
    assert (d := only(written(table), tmp_path)).code == "G015"
    assert d.labels[0].span.line == LINE
    text = written(recorded(tmp_path, gpx(stamp(0), stamp(9)), "t.gpx"), earth=True)
    d = only(text.replace(", alt: 408", ""), tmp_path)
    assert (d.code, "no altitude" in d.message) == ("G015", True)


def test_a_row_far_away_names_its_line(tmp_path: Path) -> None:
    table = recorded(tmp_path, "t,lat,lon,height\n0,47.3769,8.5417,1\n9,8.5417,47.377,1\n")
    d = only(written(table, earth=True), tmp_path)
    assert (d.code, d.notes[0]) == ("G017", "point 2 of 2 in `t.csv`, line 3")
    assert "swapped" in d.help


def runs(*jumps: int, of: int = 60, rate: float = 10.0) -> str:
    """Return a run at 3 m/s; the row of each jump lies 30 m off."""
    rows = ((i / rate, 3 * i / rate, 30.0 * (i in jumps), 0.9) for i in range(of))
    return "t,x,y,z\n" + "".join(",".join(map(str, row)) + "\n" for row in rows)


def test_a_jump_names_both_lines_and_the_row_to_mend(tmp_path: Path) -> None:
    d = only(written(recorded(tmp_path, runs(40))), tmp_path)
    assert (d.code, d.labels[0].span.line) == ("M021", LINE)
    assert "300.0 m/s" in d.message
    assert "70.0 m/s" in d.message
    assert d.notes == ("t.csv, line 42, after line 41: 30.00 m in 0.1 s, at t = 3.9 s", "it does so 2 times")
    assert d.help == (
        "correct or drop line 42: without it the target moves there at 3.0 m/s, "
        "or give it `top_speed: 300.1 m/s` if it is as fast as that"
    )


def test_a_first_or_last_row_that_jumps_is_told_with_its_neighbour(tmp_path: Path) -> None:
    d = only(written(recorded(tmp_path, runs(0))), tmp_path)
    assert d.help.startswith("correct line 2 or 3, or the time between them")
    d = only(written(recorded(tmp_path, runs(59))), tmp_path)
    assert d.help.startswith("correct line 60 or 61, or the time between them")


def test_a_runner_at_200_km_per_hour_is_told_by_his_top_speed(tmp_path: Path) -> None:
    fast = recorded(tmp_path, "t,x,y,z\n0,0,0,0.9\n1,5,0,0.9\n2,60.6,0,0.9\n3,65,0,0.9\n8,90,0,0.9\n")
    d = only(written(fast, ", top_speed: 45 km/h"), tmp_path)
    assert (d.code, len(d.labels)) == ("M021", 2)
    assert "55.6 m/s is more than its top speed, 12.5 m/s" in d.message
    assert d.notes[0].startswith("t.csv, line 4, after line 3: 55.60 m in 1 s")
    assert "raise `top_speed: 55.6 m/s`" in d.help
    assert "M021" not in {d.code for d in resolved(written(fast), tmp_path)[1]}


@pytest.mark.parametrize(
    ("track", "column"),
    [
        ("start: [0, 0, 1], velocity: [200, 0, 0]", "[200, 0, 0]"),
        ("points: [[0, 0, 1], [900, 0, 1]], speed: 200", "200"),
        ("points: [[0, 0, 1], [900, 0, 1]], times: [0, 4.5]", "4.5"),
    ],
)
def test_a_speed_of_the_mission_itself_is_held_to_the_top_speed(track: str, column: str) -> None:
    text = written(track)
    d = only(text)
    span = d.labels[0].span
    assert (d.code, "200.0 m/s" in d.message) == ("M021", True)
    assert text.splitlines()[span.line - 1][span.column - 1 :].startswith(column)
    assert "M021" not in {d.code for d in resolved(written(track, ", top_speed: 200"))[1]}


def test_a_gap_is_a_warning_with_its_lines(tmp_path: Path) -> None:
    rows = [i / 10 for i in range(50)] + [9 + i / 10 for i in range(50)] + [20.0]
    text = "t,x,y,z\n" + "".join(f"{t},{t},0,0.9\n" for t in rows)
    d = only(written(recorded(tmp_path, text)), tmp_path)
    assert (d.code, d.labels[0].span.line) == ("M022", LINE)
    assert d.message == "the track of `runner` has a gap of 6.1 s"
    assert d.notes == (
        "t.csv, line 102, after line 101: nothing from t = 13.9 s to 20 s, where rows are 0.1 s apart "
        "as a rule; it is the longest of 2 gaps",
        "a straight line of 6.1 m is assumed across it",
    )


def test_a_gap_in_which_nothing_moves_is_none(tmp_path: Path) -> None:
    rows = [(0.0, 0.0)] + [(15 + i / 2, 3.0 * i) for i in range(30)]
    text = "t,x,y,z\n" + "".join(f"{t},{x},0,0.9\n" for t, x in rows)
    timing = "start: 15, duration: 5"
    assert resolved(written(recorded(tmp_path, text), timing=timing), tmp_path)[1] == []


@pytest.mark.parametrize("first", [0.0, 7.0, 40000.0])
def test_a_recording_begins_when_the_mission_says(tmp_path: Path, first: float) -> None:
    file = recorded(tmp_path, "".join(f"{first + t},{2 * t},0,0.9\n" for t in range(20)))
    text = written(f"{file}, begins: 15 s", timing="start: 15, duration: 5")
    track = track_of(text, tmp_path)
    assert (track.times[:3], track.since, track.until) == ((15.0, 16.0, 17.0), 15.0, 34.0)
    assert (track.at(3.0), track.at(17.0)) == ((0.0, 0.0, 0.9), (4.0, 0.0, 0.9))
    early = only(text.replace("start: 15,", "start: 12,"), tmp_path)
    assert (early.code, "15.00 s" in early.help) == ("M004", True)


@pytest.mark.parametrize(
    ("track", "code"),
    [
        ("file: t.csv, begins: -3 s", "S014"),
        ("file: t.csv, begins: 15 m", "U002"),
        ("file: t.csv, begins: 1e9", "U006"),
        ("begins: 15 s", "S"),
        ("points: [[0, 0, 1], [9, 0, 1]], speed: 2, begins: 15 s", "S"),
    ],
)
def test_when_a_recording_begins_is_no_negative_time_and_needs_a_file(
    tmp_path: Path, track: str, code: str
) -> None:
    recorded(tmp_path, "".join(f"{t},{2 * t},0,0.9\n" for t in range(20)))
    found = resolved(written(track), tmp_path)[1]
    assert [d.code[: len(code)] for d in found] == [code]


@pytest.mark.parametrize("times", [(0, 5, 20, 30), (0, 0.1, 0.2, 3, 9, 11, 20), tuple(range(0, 30, 7))])
def test_rows_that_are_seldom_are_no_gap(tmp_path: Path, times: tuple[float, ...]) -> None:
    text = "t,x,y,z\n" + "".join(f"{t},{t},0,0.9\n" for t in times)
    assert resolved(written(recorded(tmp_path, text)), tmp_path)[1] == []


@pytest.mark.parametrize(
    ("rows", "timing", "note", "help_"),
    [
        (
            "0,0,0,1\n30,60,0,1\n",
            "duration: 40",
            "from 0.00 s to 30.00 s; the shot lasts 40.00 s",
            "to 30.00 s or",
        ),
        (
            "0,0,0,1\n30,60,0,1\n",
            "start: 25, duration: 10",
            "lasts 10.00 s, from 25.00 s to 35.00 s",
            "20.00 s",
        ),
        (
            "9,0,0,1\n60,99,0,1\n",
            "start: 8.5, duration: 9",
            "known from 9.00 s to",
            "between 9.00 s and 51.00 s",
        ),
        ("-50,0,0,1\n4,60,0,1\n", "duration: 5", "from -50.00 s to 4.00 s", "shorten it to 4.00 s"),
        ("-50,0,0,1\n-4,60,0,1\n", "duration: 5", "to -4.00 s", "which is time 0"),
    ],
)
def test_a_shot_beyond_a_recorded_track_is_told_with_numbers(
    tmp_path: Path, rows: str, timing: str, note: str, help_: str
) -> None:
    d = only(written(recorded(tmp_path, rows), timing=timing), tmp_path)
    assert d.code == "M004"
    assert note in d.notes[0]
    assert help_ in d.help


def test_a_warning_of_a_track_leaves_the_order_of_the_shots_to_be_judged(tmp_path: Path) -> None:
    file = recorded(tmp_path, "t,x,y,z\n" + "".join(f"{t},{t},0,0.9\n" for t in (*range(9), 60)))
    text = written(file, timing="start: 20, duration: 5")
    text += (
        f"  - {{drone: cam1, {SIDE.replace('id: side', 'id: again')}, timing: {{start: 22, duration: 5}}}}\n"
    )
    assert sorted(d.code for d in resolved(text, tmp_path)[1]) == ["K006", "M022"]


def test_a_shot_without_a_start_may_begin_whenever_the_track_does(tmp_path: Path) -> None:
    file = recorded(tmp_path, "100,0,0,1\n130,60,0,1\n")
    assert resolved(written(file, timing="duration: 30"), tmp_path)[1] == []


def test_a_shot_that_comes_after_another_does_not_begin_before_that_ends(tmp_path: Path) -> None:
    file = recorded(tmp_path, "0,0,0,1\n40,60,0,1\n")
    text = written(file, timing="start: 10, duration: 20")
    side = SIDE.replace("id: side", "id: again")
    later = f"  - {{drone: cam1, {side}, timing: {{after: side, duration: 9}}}}\n"
    assert not [d for d in resolved(text + later, tmp_path)[1] if d.code == "M004"]
    d = only(text + later.replace("duration: 9", "duration: 11"), tmp_path)
    assert d.code == "M004"
    assert "the shot lasts 11.00 s and begins at 30.00 s at the earliest" in d.notes[0]


@pytest.mark.slow
def test_a_million_rows_are_refused_at_once(tmp_path: Path) -> None:
    for rows in ("".join(f"{i},1,2,3\n" for i in range(1_000_000)), "\n".join("1" * 1_000_000)):
        file = recorded(tmp_path, rows)
        d = only(written(file), tmp_path)
        assert d.code == "N009"


@pytest.mark.long
@pytest.mark.parametrize("place", few(["x,y,z", "lat,lon,height"], ["lat,lon,height"]))
def test_as_many_rows_as_are_read_are_checked(tmp_path: Path, place: str) -> None:
    values = "{0},0,1" if place == "x,y,z" else "{1},8.5417,1"
    row = f"{{2}},{values},0.5\n"
    rows = (
        row.format(f"{i * 0.002:.4f}", f"{47.3769 + i * 1e-8:.9f}", f"{i * 0.02:.2f}") for i in range(50_000)
    )
    text = written(recorded(tmp_path, f"t,{place},heading\n" + "".join(rows)), earth=True)
    assert resolved(text, tmp_path)[1] == []
