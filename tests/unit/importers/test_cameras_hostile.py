"""Files of cameras that are broken, or made to hurt: each is told with its line, and none is a traceback."""

from __future__ import annotations

import io
import json
import zipfile

import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st

from shotc.checking import check_source
from shotc.diag.registry import has_errors
from tests.support.camera_files import (
    BLENDER,
    GOOD,
    GOOD_PLAN,
    LAT,
    LITCHI_HEAD,
    LON,
    assumed,
    camera,
    fly,
    item,
    kml,
    litchi,
    made,
    plan_file,
    tour,
    waypoint,
)

ON_GROUND = camera(alt=30, mode="relativeToGround", lat=LAT + 1e-4)
NOWHERE = camera(longitude=None)
ENTITY = b"""<?xml version="1.0"?>
<!DOCTYPE kml [<!ENTITY x SYSTEM "file:///etc/passwd">]>
<kml xmlns="http://www.opengis.net/kml/2.2"><Document><name>&x;</name></Document></kml>
"""


def packed(data: bytes, name: str = "doc.kml", how: int = zipfile.ZIP_DEFLATED) -> bytes:
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w", how) as archive:
        archive.writestr(name, data)
    return file.getvalue()


BROKEN = {
    "empty": ("kml", b"", "I001", 1),
    "no XML": ("kml", b"<kml", "I001", 1),
    "100 MB": ("kml", b"<kml>" + b" " * 4_000_001, "I001", 1),
    "entities": ("kml", ENTITY, "I001", 2),
    "another root": ("kml", b"<gpx/>", "I002", 1),
    "nothing": ("kml", kml(), "I003", 2),
    "one camera": ("kml", kml(tour(fly(camera()))), "I003", 2),
    "one placemark": ("kml", kml(f"<Placemark>{camera()}</Placemark>"), "I003", 2),
    "mixed heights": ("kml", kml(tour(fly(camera()), fly(ON_GROUND))), "I007", 17),
    "an empty archive": ("kml", packed(b"x", "a.txt"), "I001", 1),
    "half an archive": ("kml", packed(kml())[:60], "I001", 1),
    "an odd archive": ("kml", packed(kml(), how=zipfile.ZIP_LZMA), "I001", 1),
    "a bomb": ("kml", packed(b"<kml>" + b" " * 9_000_000), "I001", 1),
    "no head": ("blender-camera", b"1,0,0,20,75,0,0\n2,0,1,20,75,0,0\n", "I002", 1),
    "no rotation": ("blender-camera", b"frame,x,y,z\n1,0,0,20\n", "I002", 1),
    "no clock": ("blender-camera", b"x,y,z,rx,ry,rz\n0,0,20,1,0,0\n", "I002", 1),
    "no text": ("blender-camera", b"frame,x\0", "I001", 1),
    "one frame": ("blender-camera", "\n".join(BLENDER.splitlines()[:2]).encode(), "I003", 1),
    "no JSON": ("qgc", b'{"mission": [}', "I001", 1),
    "a list": ("qgc", b"[1]", "I001", 1),
    "no plan": ("qgc", b'{"fileType": "Plan"}', "I002", 1),
    "no waypoint": ("qgc", plan_file(item(22)), "I003", 1),
    "an odd home": ("qgc", plan_file(waypoint(0), waypoint(9), home=[1]), "I002", None),
    "no altitude of home": ("qgc", plan_file(waypoint(0), waypoint(9, frame=0), home=None), "I007", None),
    "no columns": ("litchi", f"{LAT},{LON},20,0\n".encode(), "I002", 1),
    "only a head": ("litchi", LITCHI_HEAD.encode(), "I003", 1),
    "in no sea": ("litchi", litchi("lat,lon,20,0", "99,0,20,0"), "I003", 1),
}


@pytest.mark.parametrize("case", BROKEN)
def test_what_is_no_such_file_is_told_with_its_line(case: str) -> None:
    format, data, code, line = BROKEN[case]
    result = made(format, data)
    assert result.text is None
    assert result.diagnostics[-1].code == code, result.diagnostics
    if line is not None:
        assert result.diagnostics[-1].labels[0].span.line == line


def test_mixed_heights_are_read_where_the_ground_is_given() -> None:
    text = made("kml", kml(tour(fly(camera()), fly(ON_GROUND))), ground=408.0).text
    keyframes = yaml.safe_load(text)["shots"][0]["keyframes"]
    assert [k["at"][2] for k in keyframes] == pytest.approx([32.0, 30.0], abs=1e-3)


@pytest.mark.slow
def test_too_many_cameras_are_refused_at_once() -> None:
    rows = "\n".join(f"{k},0,{k},20,75,0,0" for k in range(10_001))
    result = made("blender-camera", f"frame,x,y,z,rx_deg,ry_deg,rz_deg\n{rows}\n".encode())
    assert [d.code for d in result.diagnostics] == ["I001"]
    assert "10001 frames" in result.diagnostics[0].message


@pytest.mark.parametrize(
    ("format", "data", "line", "words"),
    [
        ("blender-camera", BLENDER + "x,1,2,3,4,5,6,7\n", 4, "a row that lacks a number"),
        ("blender-camera", BLENDER + "24,10,-40,20,75,0,10,24\n", 4, "no later than the one before"),
        ("litchi", litchi("0,0,20,0", "0.0001,0,20,north"), 3, "`north` is no number"),
        ("litchi", litchi("0,0,20,0", "0.0001,0,,0"), 3, "a waypoint without an altitude"),
        (
            "kml",
            kml(tour(fly(camera()), fly(camera(longitude=None)), fly(ON_GROUND))),
            None,
            "without a latitude",
        ),
        ("qgc", plan_file(waypoint(0), item(183), waypoint(9)), None, "item 2 is command 183"),
        ("qgc", GOOD_PLAN.replace(b'"command": 1000', b'"command": null'), None, "item 1 is no simple item"),
    ],
)
def test_what_is_odd_is_mended_and_told(format: str, data, line: int | None, words: str) -> None:
    result = made(format, data if isinstance(data, bytes) else data.encode(), ground=400.0)
    told = [(at, message) for at, message in assumed(result) if words in message]
    assert told, result.diagnostics
    assert line is None or told[0][0] == line
    assert result.text is not None


def held(format: str, data: bytes) -> None:
    """Hold an importer to its word: a mission that can be read, or an error that says why not."""
    result = made(format, data)
    if result.text is None:
        assert has_errors(result.diagnostics)
    else:
        assert yaml.safe_load(result.text)["shots"]


@pytest.mark.slow
@settings(deadline=None, max_examples=100)
@given(st.sampled_from(sorted(GOOD)), st.binary(max_size=200))
def test_any_bytes_are_read_without_a_traceback(format: str, data: bytes) -> None:
    held(format, data)
    archive = packed(GOOD["kml"])
    held("kml", archive[: len(archive) // 2] + data + archive[len(archive) // 2 + len(data) :])


VALUES = st.floats(-200, 200) | st.none() | st.booleans() | st.text(max_size=3)
ODD = st.sampled_from(
    ["", "nan", "1e999", "-1,5", "x", "{", "[]", "null", "-7", "9999999", "<b/>", chr(0), "é", "0"]
)


@pytest.mark.slow
@settings(deadline=None, max_examples=150)
@given(st.sampled_from(sorted(GOOD)), st.data())
def test_files_that_lost_or_gained_something_are_read_without_a_traceback(
    format: str, data: st.DataObject
) -> None:
    text = GOOD[format].decode()
    for _ in range(data.draw(st.integers(1, 3))):
        begin = data.draw(st.integers(0, len(text)))
        text = text[:begin] + data.draw(ODD) + text[begin + data.draw(st.integers(0, 12)) :]
    held(format, text.encode())


@pytest.mark.long
@settings(deadline=None, max_examples=100)
@given(
    st.lists(st.floats(-200, 200) | st.none() | st.booleans() | st.text(max_size=3), min_size=7, max_size=7)
)
def test_odd_parameters_of_waypoints_make_missions_or_errors(params) -> None:
    document = json.loads(GOOD_PLAN)
    for at, command in ((1, 16), (0, 1000), (0, 195), (0, 205)):
        document["mission"]["items"][at] |= {"command": command, "params": params}
        held("qgc", json.dumps(document).encode())


@pytest.mark.parametrize("format", GOOD)
def test_check_accepts_what_is_written(format: str) -> None:
    text = made(format, GOOD[format]).text
    assert not has_errors(check_source(text.encode(), "m.yaml", None).diagnostics)
