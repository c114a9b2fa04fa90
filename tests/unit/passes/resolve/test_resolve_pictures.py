"""What resolve finds wrong with pictures and with their times."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from shotc.passes.resolve.checks.show.clock import least_display
from tests.support.front_passes import resolved
from tests.support.show_texts import SPHERE, faults, marked, only, resolve, show


def test_a_picture_in_the_ground_is_told_once() -> None:
    text = show(
        SPHERE.replace("40]", "10]"),
        head="world: {zones: {sky: {box: {center: [0, 0, 45], size: [200, 200, 90]}, keep: in}}}\n",
    )
    d = only(text)
    assert (d.code, marked(d, text), d.help) == (
        "D014",
        "[0, 0, 10]",
        "raise its centre by 7.25 m, to z = 17.25",
    )
    assert faults(text.replace("[0, 0, 10]", "[0, 0, 17.25]")) == []


@pytest.mark.parametrize(
    ("shape", "sizes", "z"),
    [
        ("sphere", "radius: 0.3", 40),
        ("sphere", "radius: 0.3", 4),
        ("cube", "size: 0.4", 40),
        ("torus", "radius: 0.3, tube: 0.1", 40),
    ],
)
def test_what_is_said_of_a_size_is_enough_and_over_the_ground(shape: str, sizes: str, z: int) -> None:
    written = "{%s: {center: [0, 0, %s], %s}, hold: 3}"
    d = only(show(written % (shape, z, sizes)))
    words = re.search(r"\(`([^`]*)`; `plan` may ask for more\)", d.help)
    assert (d.code, words is not None) == ("D018", True), d.help
    assert words is not None
    larger, _, centre = words[1].partition(", center: [0, 0, ")
    assert bool(centre) == (z == 4)
    assert faults(show(written % (shape, centre.rstrip("]") or z, larger))) == []


@pytest.mark.parametrize(("top", "help_"), [(54, "lower it by 1.25 m"), (30, "make it 2.50 m lower")])
def test_the_altitude_band_is_kept(top: float, help_: str) -> None:
    sky = f"{{keep: in, cylinder: {{center: [0, 0], radius: 99, height: [2, {top}]}}}}"
    band = f"world: {{zones: {{sky: {sky}}}}}\n"
    text = show(SPHERE, head=band)
    d = only(text)
    assert (d.code, marked(d, text), marked(d, text, 1)) == ("D015", "[0, 0, 40]", "sky")
    assert d.help.startswith(help_)


def test_walls_warn_where_a_picture_is_partly_outside_and_refuse_it_outside() -> None:
    field = "world: {zones: {sky: {cylinder: {center: [0, 0], radius: 60, height: [0, 90]}, keep: in}}}\n"
    assert only(show(SPHERE.replace("[0, 0, 40]", "[50, 0, 40]"), head=field)).code == "D017"
    assert only(show(SPHERE.replace("[0, 0, 40]", "[90, 0, 40]"), head=field)).code == "D015"
    assert faults(show(SPHERE.replace("[0, 0, 40]", "[44, 0, 40]"), head=field)) == []


def test_targets_stand_in_the_way_as_well() -> None:
    target = "targets: {tower: {at: [40, 40, 20], radius: 3, height: 40}}\n"
    assert only(show("{cube: {center: [40, 40, 40], size: 20}}", head=target)).code == "D017"
    assert faults(show("{cube: {center: [40, 40, 55], size: 20}}", head=target)) == []


@pytest.mark.parametrize(
    ("picture", "inside", "outside"),
    [
        (SPHERE, "[0, -14, 40]", "[0, -15.1, 40]"),
        ("{cube: {center: [0, 0, 40], size: 24, heading: 45 deg}}", "[0, -16, 40]", "[0, -17.1, 40]"),
        ("{torus: {center: [0, 0, 40], radius: 14, tube: 5}}", "[0, -14, 44]", "[0, 0, 40]"),
        ("{text: {text: SHOTC, center: [0, 0, 40], height: 12}}", "[3, 0, 42]", "[3, -3, 42]"),
    ],
)
def test_the_audience_is_outside_of_the_picture(picture: str, inside: str, outside: str) -> None:
    text = show(picture, display=f"    viewpoint: {inside}\n")
    d = only(text)
    assert (d.code, marked(d, text)) == ("D013", inside)
    assert faults(text.replace(inside, outside)) == []


def test_transitions_between_pictures_apart_take_time() -> None:
    far = "{sphere: {center: [90, 0, 40], radius: 15}, transition: 5}"
    text = show(SPHERE, far)
    d = only(text)  # 60 m at 5 m/s and 2.5 m/s^2: 60 / 5 + 5 / 2.5
    assert (d.code, marked(d, text)) == ("D019", "5")
    assert "60.0 m" in d.notes[0]
    assert "more than 14.0 s" in d.help
    assert faults(text.replace("transition: 5", "transition: 14.1")) == []
    assert faults(text.replace("[90", "[30")) == []


def test_a_start_leaves_time_for_what_comes_before() -> None:
    text = show(display="    timing: {start: 4}\n")
    # 10 m at 2.5 m/s and 2.5 m/s^2: 10 / 2.5 + 1, and 15 m more at 3 / 4 of that: 15 / 1.875 + 1
    d = only(text)
    assert (d.code, marked(d, text)) == ("D020", "4")
    assert "later than 14.0 s" in d.help
    second = "  - {id: b, kind: display, fleet: swarm, timing: {start: 32}, frames: [" + SPHERE + "]}\n"
    text = show(SPHERE.replace("hold: 4", "hold: 13"), display="    timing: {start: 20}\n", more=second)
    assert "later than 33.0 s" in only(text).help
    assert faults(text.replace("start: 32", "start: 33")) == []


@pytest.mark.parametrize(
    ("pace", "transition", "earliest"),
    [
        # 60 m between the spheres: 60 / 3.75 + 3.75 / 1.875, after 14 s to the first and 4 s of it
        ("", "", 14.0 + 4.0 + 18.0),
        # at full limits 15 / 2.5 + 1 and 60 / 5 + 2
        ("    pace: brisk\n", "", 12.0 + 4.0 + 14.0),
        # a written duration may need all of the limits
        ("", "transition: 14, ", 14.0 + 4.0 + 14.0),
        ("", "transition: 25, ", 14.0 + 4.0 + 25.0),
    ],
)
def test_a_picture_at_a_time_comes_after_the_way_at_its_pace(
    pace: str, transition: str, earliest: float
) -> None:
    far = "{sphere: {center: [90, 0, 40], radius: 15}, %sat: %s, hold: 4}"
    text = show(SPHERE, far % (transition, earliest - 0.1), display=pace)
    d = only(text)
    assert (d.code, marked(d, text)) == ("D123", f"{earliest - 0.1}")
    assert f"take until {earliest:.1f} s at least" in d.notes[0]
    assert faults(show(SPHERE, far % (transition, earliest), display=pace)) == []


def test_a_recorded_flight_may_bring_its_take_off(tmp_path: Path) -> None:
    flight = "    timing: {start: 2}\n    frames: {flight: a.zip}\n"
    (tmp_path / "a.zip").write_bytes(b"tables")
    text = re.sub(r"    frames:\n(      .*\n)+", flight, show())
    assert flight in text
    assert [d.code for d in faults(text, tmp_path)] == ["N009"]  # the file is no show; its start is well


def test_displays_of_one_fleet_come_as_they_are_written() -> None:
    second = "  - {id: b, kind: display, fleet: swarm, frames: [" + SPHERE + "]}\n"
    text = show(display="    timing: {after: b}\n", more=second)
    d = only(text)
    assert (d.code, marked(d, text)) == ("D024", "b")
    assert only(text.replace("after: b", "after: a")).code == "N007"
    assert only(text.replace("after: b", "after: c")).code == "N004"


def test_holds_beyond_the_endurance() -> None:
    text = show(SPHERE.replace("hold: 4", "hold: 800"))
    d = only(text)  # and 14 s to the picture, 5.8 s down
    assert (d.code, marked(d, text)) == ("D021", "swarm")
    assert "at least 819.8 s, its endurance is 720.0 s" in d.notes[0]
    assert faults(text.replace("separation: 2", "separation: 2, endurance: 820 s")) == []


def test_animations_count_their_periods(tmp_path: Path) -> None:
    for i in range(4):
        (tmp_path / f"{i}.ply").write_text("ply")
    found = resolve(show("{model: {files: '*.ply', period: 2, units: m}, hold: 1}", SPHERE), tmp_path)
    assert least_display(found.displays[0], found.fleets[0].limits) == 3 * 2 + 1 + 4


def test_an_idle_fleet_is_a_warning() -> None:
    text = show().replace(
        "shots:\n", "  spare: {count: 2, layout: {grid: {spacing: 4, origin: [90, 0, 0]}}}\nshots:\n"
    )
    value, found = resolved(text)
    assert value is not None
    assert [(d.code, marked(d, text)) for d in found] == [("D023", "spare")]
