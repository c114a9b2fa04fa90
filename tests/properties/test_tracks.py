"""Tracks hold what they promise between their rows, and no file whatever makes reading one fail."""

from __future__ import annotations

from math import hypot, inf, nextafter, pi

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from shotc.geom.track import Track, unwrapped
from shotc.kinds.files import FileFault, NumberTable, read_table
from shotc.kinds.gpx import read_gpx
from shotc.passes.resolve.lower.recordings import LAYOUTS

pytestmark = pytest.mark.slow

PLACES = st.tuples(*[st.floats(-1e4, 1e4)] * 3)
STEPS = st.floats(1e-3, 100.0)


@st.composite
def tracks(draw: st.DrawFn, *, headings: bool = False) -> Track:
    steps = draw(st.lists(STEPS, min_size=1, max_size=12))
    times = tuple(float(t) for t in np.cumsum([draw(st.floats(-50, 50)), *steps]))
    points = tuple(draw(PLACES) for _ in times)
    facing = unwrapped([draw(st.floats(-pi, pi)) for _ in times]) if headings else ()
    return Track(times, points, facing, since=times[0], until=times[-1])


@given(tracks(), st.lists(st.floats(-100, 2000), max_size=20))
def test_a_track_is_what_numpy_makes_of_its_rows(track: Track, between: list[float]) -> None:
    when = np.array([*between, *track.times])
    rows = np.array(track.points)
    expected = np.column_stack([np.interp(when, track.times, rows[:, k]) for k in range(3)])
    assert np.array([track.at(t) for t in when]) == pytest.approx(expected, abs=1e-6)


@given(tracks())
def test_a_track_is_continuous(track: Track) -> None:
    fastest = max(track.speed(t) for t in track.times)
    for t in track.times:
        before, after = nextafter(t, -inf), nextafter(t, inf)
        for other in (before, after):
            way = hypot(*(a - b for a, b in zip(track.at(t), track.at(other), strict=True)))
            assert way <= fastest * (after - before) + 1e-9


@given(tracks(headings=True))
def test_given_headings_never_jump(track: Track) -> None:
    for a, b in zip(track.headings, track.headings[1:], strict=False):
        assert abs(b - a) <= pi + 1e-9
    for t in track.times:
        for other in (nextafter(t, -inf), nextafter(t, inf)):
            assert track.heading(other) == pytest.approx(track.heading(t), abs=1e-6)


@given(st.lists(st.floats(-50, 50), min_size=1, max_size=30))
def test_unwrapped_headings_are_the_same_directions(angles: list[float]) -> None:
    for before, after in zip(angles, unwrapped(angles), strict=True):
        turns = (after - before) / (2 * pi)
        assert turns == pytest.approx(round(turns), abs=1e-6)


@given(tracks(), st.floats(-100, 2000))
def test_a_course_is_the_last_one_gone_or_the_first(track: Track, t: float) -> None:
    """The rule as it is told, without an index: look back from the row, then ahead."""
    still = Track(track.times, tuple((p[0], p[1], 0.0) for p in track.points))
    legs = [(b[0] - a[0], b[1] - a[1]) for a, b in zip(still.points, still.points[1:], strict=False)]
    i = max(0, int(np.searchsorted(still.times, t, side="right")) - 1)
    ordered = [*legs[i::-1], *legs[i:]] if i < len(legs) else legs[::-1]
    gone = next((leg for leg in ordered if hypot(*leg) > 1e-6), (0.0, 1.0))
    assert still._last_course(t) == pytest.approx(float(np.arctan2(gone[1], gone[0])))


def test_a_long_stand_costs_no_more_than_a_walk() -> None:
    """The place of the last motion is found by an index, not by a walk over every row of the stand."""
    n = 50_000
    points = ((0.0, 0.0, 1.0), *(((0.0, 5.0, 1.0),) * (n - 2)), (0.0, 9.0, 1.0))
    track = Track(tuple(i * 0.1 for i in range(n)), points)
    assert {track.heading(t * 0.1) for t in range(20, n - 20, 7)} == {pi / 2}


NUMBERS = st.floats(-1e8, 1e8).map(repr) | st.sampled_from(
    ["nan", "inf", "1_0", "", " 1 ", "0", "1e999", "٣"]
)
LINES = st.lists(NUMBERS, max_size=6).map(",".join)
HEADERS = st.sampled_from(
    [",".join(layout) for layout in LAYOUTS] + ["", "t,t,t,t", "t,x,lat,z", "\ufefft,x,y,z"]
)


@given(
    st.binary(max_size=200)
    | st.tuples(HEADERS, LINES, LINES, LINES).map(lambda rows: "\n".join(rows).encode())
)
def test_any_bytes_are_a_table_or_a_fault(data: bytes) -> None:
    found = read_table(data, LAYOUTS)
    assert isinstance(found, NumberTable | FileFault)
    if isinstance(found, NumberTable):
        assert all(np.isfinite(row).all() and len(row) == len(found.columns) for row in found.rows)
        assert len(found.lines) == len(found.rows)
    elif found.line is not None:
        assert 1 <= found.line <= len(data.decode("utf-8", "replace").splitlines()) + 1


TEXTS = st.text(max_size=12) | st.sampled_from(
    [
        "2024-05-01T12:00:00Z",
        "0001-01-01T00:00:00+14:00",
        "9999-12-31T23:59:59-14:00",
        "2024-W01",
        "12",
        "nan",
    ]
)
TAGS = st.sampled_from(["gpx", "trk", "trkseg", "trkpt", "rtept", "ele", "time", "extensions", "g:time"])


@st.composite
def elements(draw: st.DrawFn, depth: int = 4) -> str:
    tag = draw(TAGS)
    inner = "".join(draw(st.lists(elements(depth - 1), max_size=3))) if depth else ""
    said = draw(TEXTS).replace("&", "").replace("<", "")
    place = f' lat="{draw(st.floats(-100, 100))}" lon="8"' if tag.endswith("pt") else ""
    return f"<{tag}{place}>{inner}{said}</{tag}>"


@pytest.mark.long
@given(st.binary(max_size=200) | elements().map(str.encode), st.booleans())
@example(b'<?xml version="1.0" encoding="no-such"?><gpx/>', True)
@example(b'<?xml version="1.0" encoding="utf-7"?><gpx/>', True)
@example(b'<?xml version="1.0" encoding="idna"?><gpx/>', True)
@example(b"</gpx>", False)
def test_any_bytes_are_a_gpx_track_or_a_fault(data: bytes, timed: bool) -> None:
    found = read_gpx(data, timed=timed)
    assert isinstance(found, NumberTable | FileFault)
    if isinstance(found, NumberTable):
        assert all(np.isfinite(row).all() and len(row) == len(found.columns) for row in found.rows)
        assert len(found.lines) == len(found.rows)
