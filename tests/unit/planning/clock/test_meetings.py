"""Two drones that film too near to each other, or in each other's pictures: who, how near, what helps."""

from __future__ import annotations

import re

import pytest

from tests.support.compiled import compiled_text

pytestmark = pytest.mark.slow

PAIR = """\
shotc: 1
mission: pair
drones:
  one: {model: x500, home: [0, -60, 0]}
  two: {model: x500, home: [12, -60, 0]}
rules: {mutual_visibility: {strength: STRENGTH}}
shots:
  - {id: look, kind: static, drone: one, at: [0, -30, 9], heading: 0 deg, pitch: 10 deg,
     timing: {start: 40, duration: 5}}
  - {id: see, kind: static, drone: two, at: [PLACE, 9], heading: 0 deg, pitch: 10 deg,
     timing: {start: START, duration: 5}}
"""


def planned(place: str, strength: str = "off", start: str = "40"):
    text = PAIR.replace("STRENGTH", strength).replace("PLACE", place).replace("START", start)
    return compiled_text(text, "none", "m.yaml")


def only(place: str, strength: str = "off"):
    (fault,) = planned(place, strength).diagnostics
    return fault


def test_two_shots_too_near_to_each_other_are_both_labelled_with_numbers():
    fault = only("1, -30")
    assert fault.code == "V022"
    assert [label.span.line for label in fault.labels] == [8, 10]
    assert "come within 1.000 m of each other" in fault.message
    assert "the separation is 3.000 m" in fault.message
    assert "bring them 2.00 m farther apart" in fault.help
    assert "nearer than that from t = " in fault.notes[0]


@pytest.mark.parametrize(("place", "lowers"), [("1, -30", False), ("2, -30", True)])
def test_no_separation_is_proposed_at_which_bodies_touch(place, lowers):
    assert ("lower `rules.separation`" in only(place).help) == lowers


@pytest.mark.parametrize(("place", "strength"), [("1, -30", "off"), ("0, -10", "require")])
def test_the_start_that_is_told_keeps_them_apart(place, strength):
    told = re.search(
        r"start shot `see` after `look`, by `timing: {start: ([\d.]+) s}`", only(place, strength).help
    )
    assert told is not None
    assert planned(place, strength, told[1]).plan is not None


def test_a_drone_whose_pad_is_in_the_picture_is_not_told_another_time():
    text = PAIR.replace("STRENGTH", "require").replace("PLACE", "0, -10").replace("START", "40")
    text = text.replace("home: [12, -60, 0]", "home: [0, 40, 0]").replace("pitch: 10 deg", "pitch: 0 deg")
    found = compiled_text(text, "none", "m.yaml").diagnostics
    (fault,) = (d for d in found if d.message.startswith("two is in the picture"))
    assert "film from where `two` is" in fault.help
    assert "start shot" not in fault.help
