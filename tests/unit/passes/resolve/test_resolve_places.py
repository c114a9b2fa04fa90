"""What resolve finds of places: each fault on its line, with the shortest way out."""

from __future__ import annotations

import re

import pytest

from tests.support.front_passes import resolved
from tests.support.resolve_missions import FIRST, at, faults, mission, only, span


@pytest.mark.parametrize(
    ("place", "code", "says", "remedy"),
    [
        ((0, -50, -3), "G001", "3.00 m underground", "by 5.61 m, to z = 2.61"),
        ((0, -50, 2.5), "G001", "2.50 m over the ground", "by 0.11 m, to z = 2.61"),
        ((-30, 20, 11), "G002", "inside zone `tree`", "1.61 m up, to [-30.00, 20.00, 12.61]"),
        ((-27.5, 20, 5), "G002", "inside zone `tree`", "1.11 m east, to [-26.39, 20.00, 5.00]"),
        ((-26.6, 20, 5), "G002", "too close to zone `tree`", "0.21 m east, to [-26.39, 20.00, 5.00]"),
        ((30, 34.2, 5), "G002", "too close to zone `house`", "0.41 m north, to [30.00, 34.61, 5.00]"),
        ((35.3, 34.3, 5), "G002", "too close to zone `house`", "north-east"),
        ((81, 0, 20), "G003", "outside keep-in zone `field`", "1.61 m west, to [79.39, 0.00, 20.00]"),
        ((79.5, 0, 20), "G003", "too close to the border of keep-in zone `field`", "0.11 m west"),
        ((0, -50, 70), "G003", "outside keep-in zone `field`", "10.61 m down, to [0.00, -50.00, 59.39]"),
        ((0, -3, 10), "G004", "inside target `tower`", "2.61 m south, to [0.00, -5.61, 10.00]"),
        ((0, -5.5, 10), "G004", "too close to target `tower`", "0.11 m south"),
    ],
)
def test_a_place_that_cannot_be_is_told_with_the_shortest_way_out(
    place: tuple[float, float, float], code: str, says: str, remedy: str
) -> None:
    d = only(mission(at(*place)))
    assert d.code == code
    assert says in d.message
    assert remedy in d.help
    text = mission(at(*place)).splitlines()[FIRST - 1]
    written = f"[{place[0]}, {place[1]}, {place[2]}]"
    assert span(d) == (FIRST, text.index(written) + 1, text.index(written) + 1 + len(written))


@pytest.mark.parametrize(
    "place", [(-30, 20, 11), (-27.5, 20, 5), (30.2, 33, 3), (81, 85, 61), (0, -3, 10), (3, 1, 23)]
)
def test_the_proposed_place_is_free(place: tuple[float, float, float]) -> None:
    moved = only(mission(at(*place))) if place[0] != 81 else faults(mission(at(*place)))[0]
    x, y, z = map(float, moved.help.split("to [")[1].rstrip("]").split(","))
    assert faults(mission(at(x, y, z))) == []


def test_no_way_out_is_proposed_that_another_obstacle_blocks() -> None:
    text = mission(at(-27.5, 20, 5)).replace(
        "    house:", "    wall: {keep: out, box: {center: [-25, 20, 10], size: [2, 20, 20]}}\n    house:"
    )
    (d,) = faults(text)
    assert "east" not in d.help
    assert "up" in d.help


def test_a_generated_path_in_an_obstacle_is_a_warning_unless_all_of_it_is() -> None:
    some = only(
        mission(
            "id: a, kind: orbit, target: tower, radius: 36, altitude: 8, "
            "start_azimuth: 270 deg, sweep: -90 deg"
        )
    )
    assert some.code == "G016"
    assert "tree" in some.message
    dome = mission("id: a, kind: orbit, target: tower, radius: 55, altitude: 8").replace(
        "    house:",
        "    dome: {keep: out, cylinder: {center: [0, 0], radius: 58, height: [0, 30]}}\n    house:",
    )
    assert [d.code for d in faults(dome)] == ["G002"]


HALF = "target: tower, start_azimuth: 270 deg, sweep: -180 deg"


@pytest.mark.parametrize(
    "shot",
    [
        f"kind: orbit, radius: 36, altitude: 8, {HALF}",
        f"kind: orbit, radius: 40, altitude: 5, {HALF}",
        f"kind: orbit, radius: 90, altitude: 40, {HALF}",
        f"kind: spiral, radius: [36, 40], altitude: [5, 10], {HALF}",
        "kind: elevator, target: tower, azimuth: 45 deg, distance: 42, altitude: [4, 20]",
        "kind: dolly, target: tower, azimuth: 45 deg, distance: [42, 60], altitude: 6",
        "kind: crane, target: tower, azimuth: 45 deg, distance: [42, 60], altitude: [6, 20]",
    ],
)
def test_each_parameter_that_is_proposed_frees_a_generated_path(shot: str) -> None:
    text = mission(f"id: a, {shot}")
    blocked = [d for d in faults(text) if d.code == "G016"]
    remedies = re.findall(r"`(\w+): (.+?)`", blocked[0].help)
    assert remedies
    column = text.splitlines()[FIRST - 1].index(f" {remedies[0][0]}: ") + len(remedies[0][0]) + 4
    assert span(blocked[0])[:2] == (FIRST, column)
    for key, value in remedies:
        freed = re.sub(rf" {key}: (\[.*?\]|\d+)", f" {key}: {value}", f"id: a, {shot}")
        assert freed != f"id: a, {shot}"
        assert faults(mission(freed)) == []


def test_a_path_that_is_all_blocked_is_told_its_parameter_too() -> None:
    text = mission("id: a, kind: dolly, target: tower, azimuth: 45 deg, distance: [41, 43], altitude: 6")
    d = only(text)
    assert (d.code, d.labels[0].span.column) == ("G002", text.splitlines()[FIRST - 1].index("[41, 43]") + 1)
    assert d.help.startswith("write `distance: [")


def test_the_altitude_of_a_generated_path_binds() -> None:
    text = mission("id: a, kind: elevator, target: tower, azimuth: 180 deg, distance: 50, altitude: [1, 30]")
    d = only(text)
    assert d.code == "G001"
    line = text.splitlines()[FIRST - 1]
    assert span(d)[:2] == (FIRST, line.index("[1, 30]") + 1)


@pytest.mark.parametrize(
    ("home", "code", "says"),
    [
        ("[0, -60, -1]", "G006", "underground"),
        ("[-30, 20, 0]", "G005", "in zone `tree`"),
        ("[-26.5, 20, 0]", "G005", "in zone `tree`"),
        ("[90, 0, 0]", "G005", "outside keep-in zone `field`"),
        ("[79.8, 0, 0]", "G005", "outside keep-in zone `field`"),
        ("[0, 2, 0]", "G005", "in target `tower`"),
    ],
)
def test_a_home_that_cannot_be(home: str, code: str, says: str) -> None:
    d = only(mission(at(0, -50, 10)).replace("[0, -60, 0]", home))
    assert (d.code, says in d.message) == (code, True)
    assert d.labels[0].span.line == 11


def test_a_home_below_a_roof_that_leaves_no_room_to_take_off() -> None:
    roof = "    roof: {keep: out, box: {center: [0, -60, BB], size: [4, 4, 1]}}\n    house:"
    low = mission(at(0, -50, 10)).replace("    house:", roof.replace("BB", "2.5"))
    assert "under zone `roof`" in only(low).message
    high = mission(at(0, -50, 10)).replace("    house:", roof.replace("BB", "8"))
    assert faults(high) == []


@pytest.mark.parametrize(
    ("points", "says"),
    [
        ("[[0, 0], [1, 0], [0, 0]]", "different corners"),
        ("[[0, 0], [1, 1], [1, 0], [0, 1]]", "crosses"),
        ("[[0, 0], [5, 0], [9, 0]]", "no area"),
    ],
)
def test_polygons_that_enclose_nothing(points: str, says: str) -> None:
    text = mission(at(0, -50, 10)).replace("[[-80, -80], [80, -80], [80, 80], [-80, 80]]", points)
    d = only(text)
    assert (d.code, says in d.message, d.labels[0].span.line) == ("G007", True, 6)


@pytest.mark.parametrize(
    "order",
    [
        "[[-80, -80], [-80, 80], [80, 80], [80, -80]]",
        "[[-80, -80], [80, -80], [80, 80], [-80, 80], [-80, -80]]",
    ],
)
def test_polygons_may_run_either_way_and_close_themselves(order: str) -> None:
    text = mission(at(0, -50, 10)).replace("[[-80, -80], [80, -80], [80, 80], [-80, 80]]", order)
    value, found = resolved(text)
    assert found == []
    assert value is not None
    solid = next(z.solid for z in value.zones if z.name == "field")
    assert sorted(solid.points) == [(-80, -80), (-80, 80), (80, -80), (80, 80)]  # type: ignore[union-attr]


@pytest.mark.slow
def test_a_generated_path_is_told_where_it_would_be_free() -> None:
    d = only(mission("id: a, kind: orbit, target: tower, radius: 3, altitude: 20"))
    assert d.code == "G004"
    assert d.help == "stay 5.60 m or more from its axis, or fly at z = 25.60 or higher"


def test_one_slip_in_a_place_is_one_report() -> None:
    shots = "id: a, kind: keyframes, target: tower, timing: {start: 30, duration: 30}, keyframes: ["
    right = "{at: [0, -50, 18], heading: 0 deg, pitch: 0 deg}, {at: [20, -50, 18], look_at: tower}]"
    assert faults(mission(shots + right)) == []
    for slip in ("[500, -50, 18]", "[0, -50, -180]", "[0, 0, 12]"):
        only(mission(shots + right.replace("[0, -50, 18]", slip)))


def test_a_home_is_given_the_way_out() -> None:
    d = only(mission(at(0, -50, 10)).replace("home: [0, -60, 0]", "home: [0, -80, 0]"))
    assert d.help == "move it 0.61 m north, to [0.00, -79.39, 0.00]"
    assert faults(mission(at(0, -50, 10)).replace("home: [0, -60, 0]", "home: [0.00, -79.39, 0.00]")) == []


def test_a_target_given_by_its_foot_is_a_warning() -> None:
    text = mission("id: a, kind: static, at: [0, -60, 10], heading: 0 deg, pitch: 0 deg")
    d = only(text.replace("at: [0, 0, 12]", "at: [0, 0, 0]"))
    assert d.code == "G018"
    assert "z = 12" in d.help
    assert faults(text.replace("at: [0, 0, 12]", "at: [0, 0, 11]")) == []
