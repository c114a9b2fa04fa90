from itertools import pairwise
from math import pi, radians
from pathlib import PurePosixPath, PureWindowsPath
from typing import Annotated, get_args

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import TypeAdapter, ValidationError

from shotc.ir.mission import Composition
from shotc.spec import fields
from shotc.spec.compositions import COMPOSITIONS, FRAMES, NAMED_POINTS
from shotc.spec.drones import CameraSpec
from shotc.spec.fields import SIZES
from shotc.spec.places import Geodetic
from shotc.spec.shot import KeyframeSpec, RequireSpec, TimingSpec
from shotc.spec.translate import findings


def read(annotation, value):
    return TypeAdapter(annotation).validate_python(value)


def slugs(annotation, value):
    with pytest.raises(ValidationError) as caught:
        read(annotation, value)
    return [(found.slug, found.path) for found in findings(caught.value)]


@pytest.mark.parametrize(
    ("annotation", "value", "expected"),
    [
        (fields.Position, [1, "2 m", "300 cm"], (1.0, 2.0, 3.0)),
        (fields.LookAt, "tower", "tower"),
        (fields.LookAt, [0, 0, 1], (0.0, 0.0, 1.0)),
        (fields.LengthRange, [0, "12 m"], (0.0, 12.0)),
        (fields.PitchRange, ["-90 deg", "30 deg"], (-pi / 2, pi / 6)),
        (fields.LengthSpan, 4, (4.0, 4.0)),
        (fields.LengthSpan, [30, "20 m"], (30.0, 20.0)),
        (fields.ScreenPoint, "left-third", (-1 / 3, 0.0)),
        (fields.ScreenPoint, [-0.3, 0.1], (-0.3, 0.1)),
        (fields.Frame, "keep", Composition("keep", keep=True)),
        (fields.Frame, "thirds", COMPOSITIONS["thirds"]),
        (fields.Frame, [0.2, 0], Composition("[0.2, 0]", points=((0.2, 0.0),))),
        (fields.CompositionSet, "phi", COMPOSITIONS["phi"]),
        (fields.CompositionSet, "left-third", Composition("left-third", points=((-1 / 3, 0.0),))),
        (
            fields.CompositionSet,
            [[0, 0], [0.5, 0]],
            Composition("[[0, 0], [0.5, 0]]", points=((0.0, 0.0), (0.5, 0.0))),
        ),
        (fields.Pace, "calm", 0.5),
        (fields.Pace, "60 %", 0.6),
        (fields.Pace, 1, 1.0),
        (fields.ShotSize, "40 %", 0.4),
        (fields.ShotSize, 1, 1.0),
        (fields.ShotSize, "medium-full", 1.4),
        (fields.ShotSize, "extreme-close-up", 10.0),
        (fields.Aspect, "16:9", 16 / 9),
        (fields.Aspect, "2.39:1", 2.39),
        (fields.Aspect, 1.5, 1.5),
        (fields.Priority, 2.0, 2),
        (fields.Velocity, [1.5, "-5.4 km/h", 0], (1.5, -1.5, 0.0)),
        (fields.FieldOfView, "70 deg", radians(70)),
        (fields.Name, "a-1_B.c", "a-1_B.c"),
        (fields.RelativePath, "walk/*.ply", "walk/*.ply"),
        (fields.RelativePath, "a..b/c", "a..b/c"),
    ],
)
def test_fields_read_what_people_write(annotation, value, expected):
    result = read(annotation, value)
    assert result == pytest.approx(expected) if isinstance(expected, float) else result == expected


@pytest.mark.parametrize(
    ("annotation", "value", "faults"),
    [
        (fields.Position, [1, 2], [("wrong-length", ())]),
        (fields.Position, "here", [("wrong-type", ())]),
        (fields.Position, [1, "2 s", "x"], [("wrong-dimension", (1,)), ("not-a-quantity", (2,))]),
        (fields.Position, {"lat": 95, "lon": 8}, [("out-of-range", ("lat",))]),
        (fields.Position, {"lat": 47.0}, [("missing-field", ())]),
        (fields.Position, {"lat": "47 deg", "lon": 8}, [("wrong-type", ("lat",))]),
        (fields.LengthRange, [3, 1], [("inverted-range", ())]),
        (fields.LengthRange, [1, 1], [("inverted-range", ())]),
        (fields.AngleRange, ["10 deg", 20], [("bare-angle", (1,))]),
        (fields.PitchRange, ["-100 deg", "0 deg"], [("out-of-range", (0,))]),
        (fields.LengthSpan, [1, 2, 3], [("wrong-length", ())]),
        (fields.ScreenPoint, "left-thrid", [("unknown-value", ())]),
        (fields.ScreenPoint, [0, 1.5], [("out-of-range", (1,))]),
        (fields.ScreenPoint, "keep", [("unknown-value", ())]),
        (fields.CompositionSet, [], [("wrong-type", ())]),
        (fields.CompositionSet, [0.3, 0.1], [("wrong-type", ())]),
        (fields.CompositionSet, [[0, 0], [0]], [("wrong-length", (1,))]),
        (fields.Pace, "fast", [("unknown-value", ())]),
        (fields.Pace, 0, [("out-of-range", ())]),
        (fields.ShotSize, "giant", [("unknown-value", ())]),
        (fields.ShotSize, 1.4, [("out-of-range", ())]),
        (fields.ShotSize, "220 %", [("out-of-range", ())]),
        (fields.ShotSize, 0, [("out-of-range", ())]),
        (fields.Pace, 60, [("out-of-range", ())]),
        (fields.Aspect, "16:0", [("impossible-camera", ())]),
        (fields.Aspect, "16/9", [("impossible-camera", ())]),
        (fields.Aspect, "100:1", [("impossible-camera", ())]),
        (fields.Aspect, "nan:1", [("impossible-camera", ())]),
        (fields.Aspect, 0, [("impossible-camera", ())]),
        (fields.FieldOfView, "180 deg", [("impossible-camera", ())]),
        (fields.FieldOfView, "0.5 deg", [("impossible-camera", ())]),
        (fields.Priority, 1.5, [("wrong-type", ())]),
        (fields.Priority, True, [("wrong-type", ())]),
        (fields.Priority, float("nan"), [("wrong-type", ())]),
        (fields.Count, 0, [("out-of-range", ())]),
        pytest.param(fields.Count, 10**5000, [("out-of-range", ())], id="huge"),
        (fields.Switch, "yes", [("wrong-type", ())]),
        (fields.Duration, 0, [("out-of-range", ())]),
        (fields.Speed, "-3 m/s", [("out-of-range", ())]),
    ],
)
def test_fields_report_each_fault_once(annotation, value, faults):
    assert slugs(annotation, value) == faults


def test_named_points_are_where_the_language_says():
    assert set(COMPOSITIONS["thirds"].points) == {
        (0, 0),
        *((a / 3, b / 3) for a in (-1, 1) for b in (-1, 1)),
    }
    assert max(u for u, _ in COMPOSITIONS["phi"].points) == 0.236
    assert COMPOSITIONS["thirds-lines"].u_lines == (-1 / 3, 1 / 3)
    assert COMPOSITIONS["keep"].keep
    assert NAMED_POINTS["right-third"] == (1 / 3, 0.0)
    for name, point in NAMED_POINTS.items():
        assert FRAMES[name].points == (point,)


def test_the_sizes_rise_from_far_to_near():
    assert list(SIZES) == [
        "establishing", "long", "full", "medium-full", "medium", "close-up", "extreme-close-up",
    ]  # fmt: skip
    assert list(SIZES.values()) == sorted(SIZES.values())
    assert [name for name, size in SIZES.items() if size <= 1] == ["establishing", "long", "full"]


@pytest.mark.parametrize(
    ("written", "meant"),
    [("closeup", "close-up"), ("Medium", "medium"), ("wide", "long"), ("cowboy", "medium-full")],
)
def test_a_size_with_another_name_is_proposed(written, meant):
    with pytest.raises(ValidationError) as caught:
        read(fields.ShotSize, written)
    assert caught.value.errors()[0]["ctx"]["help"] == f"did you mean `{meant}`?"


@pytest.mark.slow
@given(st.text(max_size=70))
def test_an_accepted_name_is_one_safe_file_name(text):
    try:
        name = read(fields.Name, text)
    except ValidationError:
        return
    assert PurePosixPath(name).name == PureWindowsPath(name).name == name
    assert name[0].isalnum()
    assert name.isprintable()


@pytest.mark.slow
@given(st.lists(st.sampled_from(["..", ".", "a", "...", "", "\\", "c:", "~", " "]), max_size=6).map("/".join))
def test_an_accepted_path_stays_in_its_folder(text):
    try:
        path = read(fields.RelativePath, text)
    except ValidationError:
        return
    assert not PurePosixPath(path).is_absolute()
    assert not PureWindowsPath(path).is_absolute()
    assert not PureWindowsPath(path).drive
    assert ".." not in PurePosixPath(path).parts
    assert ".." not in PureWindowsPath(path).parts


@pytest.mark.parametrize(
    "name", ["", ".", "..", "-o", ".hidden", "a/b", "a\n", "a b", "x" * 65, "a.", "é", "C:"]
)
def test_unsafe_names_are_refused(name):
    assert slugs(fields.Name, name) == [("unsafe-name", ())]


@pytest.mark.parametrize(
    "path",
    ["/etc/passwd", "../x", "a/../../x", "..", "a/..", "c:\\x", "a\\..\\x", "a\0b", "a\n", "", "x" * 300],
)
def test_unsafe_paths_are_refused(path):
    assert slugs(fields.RelativePath, path) == [("unsafe-path", ())]


def test_every_exported_field_is_annotated_or_a_model():
    for first, second in pairwise(fields.__all__):
        assert first != second
    for name in set(fields.__all__) - {"PACES", "Geodetic", "OnMap", "Relative"}:
        assert get_args(getattr(fields, name)), name
        assert getattr(fields, name).__class__ is Annotated[int, 1].__class__


def test_timing_is_auto_or_any_of_three():
    assert TimingSpec.model_validate("auto") == TimingSpec()
    assert TimingSpec.model_validate({"after": "side", "duration": 10}).after == "side"
    assert slugs(TimingSpec, "manual") == [("wrong-type", ())]
    for seconds, said in ((5, "{duration: 5}"), (float("inf"), "a mapping"), (-1, "a mapping")):
        with pytest.raises(ValidationError) as error:
            TimingSpec.model_validate(seconds)
        assert said in error.value.errors()[0]["ctx"]["help"]
    assert slugs(TimingSpec, {"start": -1}) == [("out-of-range", ("start",))]


def test_promises_are_shares_and_ranges():
    promise = RequireSpec.model_validate({"in_frame": "95 %", "screen_error": 0.05, "size": [0.2, 0.8]})
    assert (promise.in_frame, promise.screen_error, promise.size) == (0.95, 0.05, (0.2, 0.8))
    assert slugs(RequireSpec, {"in_frame": 100}) == [("out-of-range", ("in_frame",))]


@pytest.mark.parametrize(
    ("aim", "faults"),
    [
        ({"look_at": "tower"}, []),
        ({"heading": "0 deg", "pitch": "0 deg"}, []),
        ({}, [("missing-field", ())]),
        ({"heading": "0 deg"}, [("missing-field", ())]),
        ({"pitch": "0 deg"}, [("missing-field", ())]),
        ({"look_at": "tower", "pitch": "0 deg"}, [("conflicting-fields", ("pitch",))]),
        ({"heading": "0 deg", "pitch": "0 deg", "look_at": "t"}, [("conflicting-fields", ("look_at",))]),
    ],
)
def test_a_keyframe_is_aimed_in_exactly_one_way(aim, faults):
    value = {"at": [0, 0, 5], **aim}
    if faults:
        assert slugs(KeyframeSpec, value) == faults
    else:
        assert read(KeyframeSpec, value).at == (0.0, 0.0, 5.0)


def test_a_camera_is_a_field_of_view_or_a_sensor_and_a_lens():
    camera = CameraSpec.model_validate({"sensor": "36 mm", "focal_length": "18 mm"})
    assert camera.field_of_view == pytest.approx(pi / 2)
    assert camera.aspect_ratio is None
    both = CameraSpec.model_validate({"sensor": [0.036, 0.024], "focal_length": 0.018, "aspect": "3:2"})
    assert both.aspect_ratio == pytest.approx(1.5)
    wide = {"sensor": [0.036, 0.024], "focal_length": 0.018, "aspect": "16:9"}
    assert slugs(CameraSpec, wide) == [("conflicting-fields", ("aspect",))]
    assert CameraSpec.model_validate({**wide, "sensor": 0.036}).aspect_ratio == pytest.approx(16 / 9)
    assert CameraSpec.model_validate({}).field_of_view is None
    assert slugs(CameraSpec, {"sensor": "36 mm"}) == [("missing-field", ())]
    assert slugs(CameraSpec, {"hfov": "70 deg", "focal_length": "9 mm"}) == [
        ("conflicting-fields", ("focal_length",))
    ]
    assert slugs(CameraSpec, {"sensor": [1, 0.01], "focal_length": 1}) == [("impossible-camera", ("sensor",))]


def test_geodetic_positions_keep_degrees():
    assert read(fields.Position, {"lat": 47.5, "lon": 8, "height": "12 m"}) == Geodetic(
        lat=47.5, lon=8, height=12
    )
