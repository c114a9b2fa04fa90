"""Missions of the MultiDrone project that are broken: any bytes, odd numbers, too much of everything."""

from __future__ import annotations

import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st

from shotc.checking import check_source
from shotc.diag.registry import has_errors
from shotc.importers.mission import import_multidrone
from tests.support.multidrone_files import EARTH, MISSION, POINT, WAY, action, imported, mapped, said, shots


@pytest.mark.parametrize(
    ("data", "code"),
    [
        (b"", "I001"),
        (b"shotc: 1\n", "I001"),
        (b"<!DOCTYPE a [<!ENTITY x 'y'>]><mission>&x;</mission>", "I001"),
        (b"<mission" + b"><a" * 80, "I001"),
        (b"<?xml version='1.0' encoding='klingon'?><mission/>", "I001"),
        (b"<kml/>", "I002"),
        (b"<mission/>", "I003"),
    ],
)
def test_what_is_no_such_mission_is_told(data: bytes, code: str) -> None:
    made = import_multidrone(data, "m.xml", strict=False)
    assert made.text is None
    assert made.diagnostics[-1].code == code


@pytest.mark.parametrize(
    ("kind", "params"),
    [
        ("ELEVATOR", '{"z_s": 5, "z_e": 5}'),
        ("ORBIT", '{"r_0": 0, "azimuth_speed": 9, "azimuth_s": 45}'),
        ("ORBIT", '{"azimuth_speed": 0}'),
        ("FLYBY", '{"x_s": 3, "x_e": 3}'),
        ("STATIC", '{"pan_s": -4000, "pan_e": 4000, "tilt_s": 500, "tilt_e": -90}'),
        ("FLY_THROUGH", '{"pan_s": 0, "tilt_s": 45, "z_0": -4}'),
        ("ESTABLISH", '{"x_s": 0, "x_e": 0, "z_s": 0, "z_e": 0}'),
        ("LEAD", "{}"),
        ("FLYOVER", "{}"),
        ("SELFIE", "{}"),
    ],
)
@pytest.mark.parametrize("way", [WAY, ((0, 0, 0), (0, 0, 0)), ((0, 0, 0),), ()])
def test_odd_parameters_make_missions_that_check_accepts(kind: str, params: str, way) -> None:
    assert len(shots(imported(action(kind, params, way)))) == 1


def test_a_point_far_from_all_others_is_left_out_and_told() -> None:
    made = imported(action("CHASE", '{"x_s": -9, "z_0": 5}', way=(*WAY, (40_000, 0, 60))))
    assert any("a point that is 40 km from most others" in message for message, _ in said(made))
    assert len(yaml.safe_load(made.text or "")["targets"]["target1"]["track"]["points"]) == 3


def test_more_than_a_mission_can_be_is_refused_at_once() -> None:
    many = imported(*[action("CHASE", "{}")] * 101)
    assert [d.code for d in many.diagnostics] == ["I001"]
    assert "101 `shootingAction`" in many.diagnostics[0].message
    long = imported(action("CHASE", "{}", way=tuple((i, "1,5", i) for i in range(2001))))
    assert [d.code for d in long.diagnostics] == ["I001"]
    large = import_multidrone(b"<mission>" + b" " * 4_000_000 + b"</mission>", "m.xml", strict=False)
    assert [d.code for d in large.diagnostics] == ["I001"]


@pytest.mark.slow
@settings(deadline=None, max_examples=150)
@given(st.binary(max_size=200))
def test_any_bytes_are_read_without_a_traceback(data: bytes) -> None:
    made = import_multidrone(data, "m.xml", strict=False)
    assert made.text is None
    assert made.diagnostics


@pytest.mark.slow
@settings(deadline=None, max_examples=150)
@given(st.data())
def test_a_mission_that_lost_or_gained_something_is_read_without_a_traceback(data: st.DataObject) -> None:
    text = mapped(POINT.format(x=100, y=50, t=0) + EARTH.format(47.001, 8.0, 40), "8.0,47.0 8.0,47.001")
    text = MISSION.format(actions=text + action("ORBIT", '{"r_0": 9}') + action("FLY_THROUGH", "{}"))
    for _ in range(data.draw(st.integers(1, 3))):
        lines = text.splitlines(keepends=True)
        i = data.draw(st.integers(1, len(lines) - 1))
        lines[i] = data.draw(
            st.sampled_from(["", lines[i] * 2, "<role>secondary</role>", "<x>1,5</x>", "&#0;"])
        )
        text = "".join(lines)
    made = import_multidrone(text.encode(), "m.xml", strict=False)
    assert made.text is None or yaml.safe_load(made.text)["shots"]


GARBLED = st.sampled_from(
    ["", "nan", "1e999", "-1,5", "x", "{", "[]", '{"x_s": "a"}', "0", "9999999", "<b/>", "é"]
)


@pytest.mark.slow
@settings(deadline=None, max_examples=150)
@given(
    st.lists(GARBLED, min_size=6, max_size=6),
    st.sampled_from(["CHASE", "ORBIT", "STATIC", "FLY_THROUGH", "?"]),
)
def test_garbled_values_are_mended_or_refused(values: list[str], kind: str) -> None:
    x, y, t, params, duration, composition = values
    text = MISSION.format(
        actions=action(kind, params, ((x, y, t), (1, 2, 3)), duration=duration, composition=composition)
    )
    made = import_multidrone(text.encode(), "m.xml", strict=False)
    assert made.text is None or not has_errors(check_source(made.text.encode(), "m.yaml", None).diagnostics)
