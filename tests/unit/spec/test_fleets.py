"""How fleets and displays are written: what is read, and what is refused where."""

from __future__ import annotations

from math import inf

import pytest
from matplotlib.colors import CSS4_COLORS

from shotc.diag.registry import registry
from shotc.spec.colors import COLORS
from tests.support.show_texts import FLEET, SPHERE, only, resolve, show


@pytest.mark.parametrize("count", ["0", "-3", "20001", "1e9", "2.5", "many"])
def test_the_count_is_from_1_to_20_000(count: str) -> None:
    d = only(show(fleet=FLEET.replace("count: 60", f"count: {count}")))
    assert registry()[d.code].slug in ("out-of-range", "wrong-type")
    assert (d.labels[0].span.line, d.labels[0].span.column) == (4, 18)


@pytest.mark.parametrize(
    ("written", "apart"),
    [
        ("1 m", ("ellipsoid", 1.0, 1.0, 0.0)),
        ("2.5", ("ellipsoid", 2.5, 2.5, 0.0)),
        ("{horizontal: 1 m}", ("ellipsoid", 1.0, 1.0, 0.0)),
        ("{horizontal: 1 m, vertical: 2 m, margin: 15 cm}", ("ellipsoid", 1.0, 2.0, 0.15)),
        ("{horizontal: 1, vertical: 2, shape: cylinder}", ("cylinder", 1.0, 2.0, 0.0)),
    ],
)
def test_a_separation_is_one_length_or_several(written: str, apart: tuple[object, ...]) -> None:
    text = show(fleet=FLEET.replace("separation: 2", f"separation: {written}"))
    assert tuple(resolve(text).fleets[0].apart) == apart


def test_without_one_the_rules_separation_holds() -> None:
    text = show(fleet=FLEET.replace(", separation: 2", ""), head="rules: {separation: 2.2}\n")
    assert resolve(text).fleets[0].apart[:3] == ("ellipsoid", 2.2, 2.2)


@pytest.mark.parametrize(
    ("written", "slug"),
    [("0", "out-of-range"), ("2 kg", "wrong-dimension"), ("[1, 2]", "wrong-type"), ("yes", "not-a-quantity")],
)
def test_a_wrong_separation_is_one_fault(written: str, slug: str) -> None:
    text = show(fleet=FLEET.replace("separation: 2", f"separation: {written}"))
    d = only(text)
    assert registry()[d.code].slug == slug
    assert d.labels[0].span.column == text.splitlines()[3].rindex(written) + 1


@pytest.mark.parametrize(
    ("color", "rgb"),
    [("orange", (255, 165, 0)), ('"#f80"', (255, 136, 0)), ('"#3366FF"', (51, 102, 255))],
)
def test_colours_are_names_or_digits(color: str, rgb: tuple[int, int, int]) -> None:
    (display,) = resolve(show(SPHERE.replace("hold", f"color: {color}, hold"))).displays
    assert display.pictures[0].color == rgb


@pytest.mark.parametrize("color", ["orang", '"#ff"', '"#12345g"', "333", "[1, 2, 3]", "Orange"])
def test_what_is_no_colour_is_refused_with_a_proposal(color: str) -> None:
    d = only(show(SPHERE.replace("hold", f"color: {color}, hold")))
    assert registry()[d.code].slug in ("unknown-value", "wrong-type")
    assert ("did you mean `orange`" in d.help) == (color.lower().startswith("orang"))


def test_every_named_colour_has_three_bytes() -> None:
    assert all(len(rgb) == 3 and all(0 <= c <= 255 for c in rgb) for rgb in COLORS.values())


def test_the_names_of_colours_are_those_of_css() -> None:
    assert {name: "#{:02X}{:02X}{:02X}".format(*rgb) for name, rgb in COLORS.items()} == CSS4_COLORS


@pytest.mark.parametrize(("written", "weight"), [("0", 0.0), ("0.5", 0.5), ("7", 7.0), (".inf", inf)])
def test_a_viewpoint_weight_is_any_number_from_0(written: str, weight: float) -> None:
    text = show(display=f"    viewpoint: [0, -80, 2]\n    viewpoint_weight: {written}\n")
    assert resolve(text).displays[0].weight == weight


@pytest.mark.parametrize("written", ["-1", ".nan", "-.inf", "high", "50 %", "true"])
def test_other_weights_are_refused(written: str) -> None:
    text = show(display=f"    viewpoint: [0, -80, 2]\n    viewpoint_weight: {written}\n")
    assert (only(text).labels[0].span.line, only(text).code[0]) == (10, "S")


def test_the_weight_is_balanced_with_a_viewpoint_and_all_volume_without() -> None:
    assert resolve(show(display="    viewpoint: [0, -80, 2]\n")).displays[0].weight == 0.5
    assert resolve(show()).displays[0].weight == inf


@pytest.mark.parametrize(
    ("picture", "slug"),
    [
        ("{hold: 3}", "missing-field"),
        (
            "{sphere: {center: [0, 0, 40], radius: 15}, cube: {center: [0, 0, 40], size: 3}}",
            "conflicting-fields",
        ),
        ("{sphere: {center: [0, 0, 40], radius: 0}}", "out-of-range"),
        ("{ball: {center: [0, 0, 40], radius: 3}}", "unknown-field"),
        ("{model: {files: walk.ply, period: 0}}", "out-of-range"),
        ("{model: {files: ../walk.ply}}", "unsafe-path"),
        ('{text: {text: "", center: [0, 0, 40], height: 3}}', "wrong-length"),
        ('{text: {text: "a\\nb", center: [0, 0, 40], height: 3}}', "wrong-length"),
        ("{text: {text: 2026, center: [0, 0, 40], height: 3}}", "wrong-type"),
        ("{cube: {center: [0, 0, 40], size: 3, heading: 30}}", "bare-angle"),
        ("{sphere: {center: [0, 0, 40], radius: 15}, hold: -1}", "out-of-range"),
        ("{sphere: {center: [0, 0, 40], radius: 15}, transition: 0}", "out-of-range"),
        ("{sphere: {center: [0, 0, 40], radius: 15}, fill: solid}", "unknown-value"),
    ],
)
def test_a_wrong_picture_is_one_fault_on_its_line(picture: str, slug: str) -> None:
    text = show(SPHERE, picture)
    d = only(text)
    assert registry()[d.code].slug == slug
    assert d.labels[0].span.line == text.count("\n")


def test_frames_are_a_list_or_the_files_of_one_animation() -> None:
    for written, slug in (
        ("[]", "empty-display"),
        ("walk/*.ply", "wrong-type"),
        ("{period: 2}", "missing-field"),
    ):
        text = show().split("    frames:")[0] + f"    frames: {written}\n"
        assert registry()[only(text).code].slug == slug
