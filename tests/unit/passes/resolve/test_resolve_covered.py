"""Targets within keep-out zones, as ``check`` tells of them: both lines, where and when."""

from __future__ import annotations

import pytest

from shotc.checking import check_source
from shotc.diag.model import Diagnostic

MISSION = """\
shotc: 1
mission: covered
world: {zones: {hall: {keep: out, box: {center: [20, 0, 5], size: [10, 10, 10]}}}}
targets:
  walker: {track: WAY, radius: 0.4, height: 1.8}
drones: {cam1: {model: x500, home: [0, -30, 0]}}
shots:
  - {id: film, kind: static, drone: cam1, at: [0, -12, 4], look_at: walker, timing: {start: 15, duration: 5}}
"""
EAST = "{start: [0, 0, 0.9], velocity: [1, 0, 0]}"


def covered(text: str) -> list[Diagnostic]:
    found = check_source(text.encode(), "m.yaml", None).diagnostics
    return [d for d in found if d.code == "G023"]


def test_a_target_that_walks_into_a_zone_is_told_with_both_lines_where_and_when() -> None:
    (told,) = covered(MISSION.replace("WAY", EAST))
    assert [label.span.line for label in told.labels] == [5, 3]
    assert told.message == "target `walker` comes into keep-out zone `hall`"
    assert "t = 15.00 s" in told.notes[0]
    assert "(15.00, 0.00, 0.90) m" in told.notes[0]


def test_a_target_that_stands_or_begins_in_a_zone_is_told() -> None:
    (stands,) = covered(MISSION.replace("track: WAY", "at: [22, 0, 0.9]"))
    assert stands.message == "target `walker` stands in keep-out zone `hall`"
    assert "(22.00, 0.00, 0.90) m" in stands.notes[0]
    (begins,) = covered(MISSION.replace("WAY", EAST.replace("[0, 0, 0.9]", "[18, 0, 0.9]")))
    assert "begins in" in begins.message


def test_the_way_out_of_a_zone_does_not_lead_into_the_ground() -> None:
    """The floor of the hall is 0.9 m below the walker, its nearest wall 3 m to the east."""
    text = MISSION.replace("track: WAY", "at: [22, 0, 0.9]")
    assert "move the target or the zone by 3.01 m to the side" in str(covered(text)[0].help)
    assert covered(text.replace("[22, 0, 0.9]", "[25.01, 0, 0.9]")) == []
    assert covered(text.replace("[20, 0, 5]", "[16.99, 0, 5]")) == []


@pytest.mark.parametrize(
    "way",
    [
        EAST.replace("[1, 0, 0]", "[0.7, 0, 0]"),  # it is at 14 m when the shot ends
        EAST.replace("[0, 0, 0.9]", "[0, 6, 0.9]"),  # beside the hall
        "{points: [[0, 0, 0.9], [10, 0, 10.9], [40, 0, 10.9]], speed: 1 m/s}",  # over its roof
    ],
)
def test_a_target_that_does_not_come_into_a_zone_is_not(way: str) -> None:
    assert covered(MISSION.replace("WAY", way)) == []


def test_a_shot_that_says_so_is_not_told() -> None:
    text = MISSION.replace("WAY", EAST)
    assert covered(text.replace("kind: static,", "kind: static, allow: [hidden-subject],")) == []
    assert covered(text.replace("shots:", "rules: {allow: [hidden-subject]}\nshots:")) == []


def test_a_shot_without_a_known_end_is_judged_as_long_as_a_drone_can_fly() -> None:
    text = MISSION.replace("WAY", EAST.replace("[1, 0, 0]", "[0.1, 0, 0]"))
    assert covered(text) == []
    assert covered(text.replace("start: 15, ", ""))


def test_a_keep_in_zone_holds_its_targets() -> None:
    assert covered(MISSION.replace("WAY", EAST).replace("keep: out", "keep: in")) == []
