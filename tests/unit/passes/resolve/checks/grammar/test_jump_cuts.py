"""Cuts between two pictures that are too much alike, on both sides of every threshold."""

from __future__ import annotations

import re
from math import cos, radians, sin

import pytest

from shotc.diag.model import Diagnostic
from tests.support.grammar_missions import codes, grammar, mission


def still(name: str, azimuth: float, distance: float, more: str = "", extra: str = "") -> str:
    """A camera level with the statue's middle, that azimuth East of its South."""
    x, y = distance * sin(radians(azimuth)), 40 - distance * cos(radians(azimuth))
    return (
        f"id: {name}, kind: static, at: [{x:.6f}, {y:.6f}, 2], look_at: statue, "
        f"timing: {{duration: 4{more}}}{extra}"
    )


def found(*shots: str, **how: object) -> list[str]:
    text = mission(*shots, **how).replace("rules: {", "rules: {ground_clearance: 0, ")  # type: ignore[arg-type]
    return [d.code for d in grammar(text)]


@pytest.mark.parametrize(
    ("azimuth", "distance", "told"),
    [
        (29.0, 20, ["F002"]),
        (31.0, 20, []),
        (10.0, 20 / 1.45, ["F002"]),
        (10.0, 20 / 1.55, []),
        (10.0, 20 * 1.45, ["F002"]),
        (10.0, 20 * 1.55, []),
    ],
)
def test_thirty_degrees_or_half_as_large_again(azimuth: float, distance: float, told: list[str]) -> None:
    assert found(still("a", 0, 20), still("b", azimuth, distance)) == told


def test_the_numbers_are_told() -> None:
    text = mission(still("a", 0, 20), still("b", 20, 16)).replace("rules: {", "rules: {ground_clearance: 0, ")
    (said,) = grammar(text)
    assert "19 deg round it, which is then 1.25 times as large" in said.notes[0]
    assert said.help.startswith("begin `b` at [8.")


def test_a_size_that_almost_changes_enough_is_told_as_less_than_the_factor() -> None:
    text = mission(still("a", 0, 20), still("b", 1, 29.9)).replace(
        "rules: {", "rules: {ground_clearance: 0, "
    )
    (said,) = grammar(text)
    assert (
        "1.49 times smaller; a cut needs 30 deg or more, or a size that changes by a factor of 1.5"
        in (said.notes[0])
    )


ROUNDS = (
    "kind: orbit, radius: 30, altitude: HIGH, start_azimuth: AZIMUTH",
    "kind: elevator, distance: 30, azimuth: AZIMUTH, altitude: [HIGH, 30]",
    "kind: dolly, distance: [30, 50], altitude: HIGH, azimuth: AZIMUTH",
)


@pytest.mark.parametrize("kind", ROUNDS)
@pytest.mark.parametrize(("azimuth", "high"), [(170, 5), (181, 14), (190, 20), (-175, 6), (520, 9)])
def test_the_azimuth_that_the_help_gives_clears_the_cut(kind: str, azimuth: int, high: int) -> None:
    """It counts the elevations, for which the angle between the views is less than that of their azimuths."""

    def cut(written: str) -> list[Diagnostic]:
        shot = kind.replace("HIGH", str(high)).replace("AZIMUTH", written)
        first = "id: a, kind: static, at: [0, 12, 16], look_at: statue, timing: {duration: 4}"
        return grammar(mission(first, f"id: b, target: statue, {shot}"))

    (said,) = cut(f"{azimuth} deg")
    assert said.code == "F002"
    remedy = re.match(r"write `(?:start_)?azimuth: (\d+ deg)`", said.help)
    assert remedy is not None
    assert cut(remedy[1]) == []
    given = int(remedy[1].split()[0])
    back = given + 2 if given < 180 else given - 2
    assert [d.code for d in cut(f"{back} deg")] == ["F002"]


@pytest.mark.parametrize(("azimuth", "distance"), [(-20, 3), (5, 20), (28, 24)])
def test_the_place_that_the_help_gives_clears_the_cut(azimuth: float, distance: float) -> None:
    def cut(second: str) -> list[Diagnostic]:
        low = mission(still("a", 0, 20 if distance > 9 else 4), second)
        return grammar(low.replace("rules: {", "rules: {ground_clearance: 0, "))

    b = still("b", azimuth, distance)
    (said,) = cut(b)
    place = re.match(r"begin `b` at (\[.*?\])", said.help)
    assert place is not None
    assert cut(re.sub(r"at: \[.*?\]", f"at: {place[1]}", b)) == []


def test_from_high_above_no_side_is_proposed() -> None:
    above = "kind: static, look_at: statue, timing: {duration: 4}"
    (said,) = grammar(mission(f"id: a, at: [0, 36, 30], {above}", f"id: b, at: [0, 45, 33], {above}"))
    assert said.help.startswith("begin `b` much nearer or much farther away, or write")


def test_a_lens_changes_the_size_too() -> None:
    a, b = (
        f"id: {name}, kind: keyframes, target: statue, keyframes: [{{at: [{x}, 20, 4], look_at: statue, "
        f"hfov: {lens} deg, hold: 3}}, {{at: [{x + 2}, 20, 4], look_at: statue, hfov: {lens} deg}}]"
        for name, x, lens in (("a", 0, 70), ("b", 5, 40))
    )
    assert codes(a, b) == []
    assert codes(a, b.replace("40 deg", "60 deg")) == ["F002"]


def test_a_shot_that_carries_on_is_no_cut() -> None:
    assert found(still("a", 0, 20), still("b", 0.5, 20)) == []
    assert found(still("a", 0, 20), still("b", 3, 20)) == ["F002"]


def test_a_shot_of_something_that_moves_carries_on_only_at_once() -> None:
    one, same = (
        f"id: {n}, kind: static, at: [45, -30, 4], look_at: runner, timing: {{start: {start}, duration: 5}}"
        for n, start in (("a", 24), ("b", 29.5))
    )
    assert codes(one, same) == []
    assert codes(one, same.replace("29.5", "31.5")) == ["F002"]


def test_another_subject_is_another_picture() -> None:
    a = "id: a, kind: static, at: [20, 20, 4], look_at: statue, timing: {start: 15, duration: 3}"
    b = "id: b, kind: static, at: [22, 20, 4], look_at: runner, timing: {start: 28, duration: 3}"
    assert codes(a, b) == []


def test_it_is_allowed_by_name() -> None:
    a, b = still("a", 0, 20), still("b", 10, 20)
    assert found(a, b, allow="jump-cut") == []
    assert found(a, still("b", 10, 20, extra=", allow: [jump-cut]")) == []
    assert found(a, b, allow="short-shot, fast-pan") == ["F002"]
