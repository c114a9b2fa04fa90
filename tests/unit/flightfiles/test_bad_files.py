"""Files of flights that are broken, or made to hurt: each is told with its line, and none is a traceback."""

from __future__ import annotations

from zipfile import ZIP_LZMA

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from shotc.diag.registry import has_errors
from shotc.importers.cameras.takes import Refused
from shotc.importers.flights.read import read
from tests.support.flight_files import (
    AROUND,
    globe,
    kmz,
    litchi_file,
    mark,
    plan_file,
    qgc_item,
    verified,
    waypoints_file,
    wpml_text,
    zipped,
)

MARKS = [mark(place) for place in AROUND]
GOOD = {
    "cam1.kmz": kmz(wpml_text(MARKS)),
    "cam1.wpml": wpml_text(MARKS).encode(),
    "cam1.csv": litchi_file(AROUND),
    "cam1.plan": plan_file(AROUND),
    "cam1.waypoints": waypoints_file(AROUND),
}
ENTITY = b"""<?xml version="1.0"?>
<!DOCTYPE kml [<!ENTITY x SYSTEM "file:///etc/passwd">]>
<kml xmlns:wpml="http://www.dji.com/wpmz/1.0.6"><Document>&x;</Document></kml>
"""
SEA = mark((0.0, 0.0, 20.0)).replace("<coordinates>8.54", "<coordinates>-28.54")
LAT, LON, _ = globe((0.0, 0.0, 0.0))
TURNED = mark((0.0, 0.0, 20.0)).replace(f"{LON:.9f},{LAT:.9f}", f"{LAT:.9f},{LON:.9f}")
BROKEN: dict[str, tuple[str, bytes, str, int, str]] = {
    "empty kmz": ("cam1.kmz", b"", "I008", 1, "no XML"),
    "truncated zip": ("cam1.kmz", GOOD["cam1.kmz"][:200], "I008", 1, "a broken archive"),
    "a zip of something else": (
        "cam1.kmz",
        zipped({"a.txt": b"x"}),
        "I008",
        1,
        "without `wpmz/waylines.wpml`",
    ),
    "a bomb": ("cam1.kmz", zipped({"wpmz/waylines.wpml": b" " * 9_000_000}), "I008", 1, "larger than 4 MB"),
    "a bomb of another packing": (
        "cam1.kmz",
        zipped({"wpmz/waylines.wpml": b" " * 1000}, ZIP_LZMA),
        "I008",
        1,
        "packed in a way",
    ),
    "4 MB": ("cam1.kml", b"<kml>" + b" " * 4_000_001, "I008", 1, "larger than 4 MB"),
    "entities": ("cam1.wpml", ENTITY, "I008", 2, "document type declaration"),
    "a tour": ("cam1.kml", b"<kml><Document/></kml>", "I009", 1, "no WPML"),
    "another version": (
        "cam1.kmz",
        kmz(wpml_text(MARKS, version="http://www.dji.com/wpmz/2.0.0")),
        "I009",
        2,
        "another version",
    ),
    "two waylines": (
        "cam1.kmz",
        kmz(wpml_text(MARKS).replace("</Folder>", "</Folder><Folder></Folder>")),
        "I009",
        13,
        "2 waylines",
    ),
    "heights over the ellipsoid": ("cam1.kmz", kmz(wpml_text(MARKS, heights="WGS84")), "I011", 4, "`WGS84`"),
    "no waypoints": ("cam1.kmz", kmz(wpml_text([])), "I010", 2, "no waypoint"),
    "a height that is none": (
        "cam1.kmz",
        kmz(wpml_text([MARKS[0], MARKS[1].replace("20.00", "high")])),
        "I010",
        8,
        "`executeHeight` is `high`",
    ),
    "not a number": ("cam1.kmz", kmz(wpml_text([MARKS[0].replace("20.00", "nan")])), "I010", 6, "no number"),
    "no coordinates": (
        "cam1.kmz",
        kmz(wpml_text([MARKS[0].replace("coordinates", "place")])),
        "I010",
        5,
        "waypoint 1 has no `coordinates`",
    ),
    "in the sea": ("cam1.kmz", kmz(wpml_text([MARKS[0], SEA])), "I012", 7, "waypoint 2 is "),
    "exchanged": ("cam1.kmz", kmz(wpml_text([MARKS[0], TURNED])), "I012", 7, "waypoint 2 is "),
    "at zero": (
        "cam1.csv",
        litchi_file(AROUND).replace(f"{globe(AROUND[1])[0]:.9f},{globe(AROUND[1])[1]:.9f}".encode(), b"0,0"),
        "I010",
        3,
        "no latitude and longitude",
    ),
    "an unknown end": ("cam1.kmz", kmz(wpml_text(MARKS, finish="explode")), "I010", 3, "no `finishAction`"),
    "no head": (
        "cam1.waypoints",
        b"\n".join(waypoints_file(AROUND).splitlines()[1:]),
        "I009",
        1,
        "QGC WPL 110",
    ),
    "a short row": ("cam1.waypoints", waypoints_file(AROUND) + b"6\t0\t3\n", "I010", 8, "12"),
    "a word in a row": (
        "cam1.waypoints",
        waypoints_file(AROUND).replace(b"\t20.", b"\thigh", 1),
        "I010",
        3,
        "is no number",
    ),
    "only a home": ("cam1.waypoints", waypoints_file(()).splitlines()[0] + b"\n", "I010", 1, "no waypoint"),
    "over terrain": ("cam1.waypoints", waypoints_file(AROUND, frame=10), "I011", 3, "frame 10"),
    "turns": ("cam1.waypoints", waypoints_file(AROUND, command=18), "I010", 3, "turns round a place"),
    "mixed heights": (
        "cam1.plan",
        plan_file((), items=[qgc_item(AROUND[0]), qgc_item(AROUND[1], frame=0)]),
        "I011",
        24,
        "item 2 counts its height from sea level",
    ),
    "no JSON": ("cam1.plan", b"{", "I008", 1, "no JSON"),
    "no plan": ("cam1.plan", b'{"a": 1}', "I009", 1, "no plan of QGroundControl"),
    "a plane": ("cam1.plan", plan_file(AROUND, firmware=99), "I009", 4, "`firmwareType` is 99"),
    "a jump": ("cam1.plan", plan_file((), items=[qgc_item(AROUND[0], command=177)]), "I010", 11, "a jump"),
    "a complex item": (
        "cam1.plan",
        plan_file((), items=[{"complexItemType": "CorridorScan"}]),
        "I010",
        11,
        "`CorridorScan`",
    ),
    "a null": ("cam1.plan", plan_file((), items=[None]), "I010", 11, "no simple item"),
    "no columns": ("cam1.csv", b"a,b\n1,2\n", "I009", 1, "no column `t_s`, `x_m`"),
    "an empty cell": ("cam1.csv", litchi_file(AROUND).replace(b"20.00", b"", 1), "I010", 2, "`altitude(m)`"),
    "a word in a cell": (
        "cam1.csv",
        litchi_file(AROUND).replace(b",-10,", b",down,", 1),
        "I010",
        2,
        "`down`",
    ),
    "mixed heights of Litchi": (
        "cam1.csv",
        litchi_file(AROUND[:2]) + litchi_file(AROUND[2:], mode=1).split(b"\n", 1)[1],
        "I011",
        4,
        "from the ground",
    ),
}


@pytest.mark.parametrize("name", BROKEN)
def test_each_is_told_with_its_line(name: str) -> None:
    file, data, code, line, said = BROKEN[name]
    report = verified((file, data))
    assert not report.holds
    assert [(d.code, d.labels[0].span.line) for d in report.diagnostics] == [(code, line)]
    assert said in report.diagnostics[0].message
    assert file in report.diagnostics[0].message
    assert report.certificate == ()


@pytest.mark.slow
def test_the_good_ones_are_good() -> None:
    assert [name for name, data in GOOD.items() if not verified((name, data)).holds] == []


def test_latitude_and_longitude_that_are_exchanged_are_named() -> None:
    file, data, *_ = BROKEN["exchanged"]
    assert "exchanged" in verified((file, data)).diagnostics[0].help
    file, data, *_ = BROKEN["in the sea"]
    assert "world.origin" in verified((file, data)).diagnostics[0].help


@pytest.mark.slow
@pytest.mark.parametrize("name", GOOD)
@settings(max_examples=25, deadline=None)
@given(data=st.data())
def test_no_bytes_make_a_traceback(name: str, data: st.DataObject) -> None:
    """Whatever is changed in a good file, it is read or refused, and then judged or told."""
    spoilt = bytearray(GOOD["cam1.wpml"] if name == "cam1.wpml" else GOOD[name])
    for _ in range(data.draw(st.integers(1, 4))):
        at = data.draw(st.integers(0, len(spoilt) - 1))
        spoilt[at : at + data.draw(st.integers(0, 3))] = data.draw(st.binary(max_size=3))
    cut = data.draw(st.integers(0, 9))
    whole = bytes(spoilt)[: len(spoilt) * 2 // 3] if cut == 0 else bytes(spoilt)
    found = read(whole, name).content
    report = verified((name, whole))
    assert report.holds != has_errors(report.diagnostics)
    if isinstance(found, Refused):
        assert [d.code for d in report.diagnostics] == [found.code]
    assert all(d.labels and d.message for d in report.diagnostics)


@pytest.mark.slow
@settings(max_examples=60, deadline=None)
@given(data=st.binary(max_size=300), name=st.sampled_from(sorted(GOOD)))
def test_any_bytes_are_refused(data: bytes, name: str) -> None:
    assert isinstance(read(data, name).content, Refused)
