"""However little a limit is broken by, the value and the limit are told with digits that differ."""

from __future__ import annotations

import re
from itertools import product

import pytest
from hypothesis import given
from hypothesis import strategies as st

from shotc.cli.summary import certificate_text
from shotc.ir.measures import distinct_measures
from shotc.ir.promise import Promise
from shotc.ir.trajectory import Claim
from shotc.passes.verify.claims import slack
from shotc.passes.verify.report import ENDING, RULES, STARTING, report
from tests.support.film_plans import orbit_plan
from tests.support.records import replace

SAMPLE = orbit_plan().trajectory
SHOT = replace(SAMPLE.keyframes.mission.shots[0], promise=Promise(size=(0.1, 0.7), reveal=(0.2, 0.8)))
MISSION = replace(SAMPLE.keyframes.mission, shots=(SHOT,))
PLAN = replace(SAMPLE, keyframes=replace(SAMPLE.keyframes, mission=MISSION))
SPEED = next(c for c in orbit_plan().certificate if c.constraint == "speed")
SIGHT, PASSED = " out of the picture", " on transits"  # are told in words of their own
FIRED = ("pyro ", " outside the flight")  # are told with what the cue of a show would have to be
CONSTRAINTS = [
    *RULES,
    *(f"{start}field" for start in STARTING if start not in FIRED),
    *(f"tower{end}" for end in ENDING if end not in (SIGHT, PASSED, *FIRED)),
]


def unit_of(constraint: str) -> str:
    if constraint.endswith(" in frame"):
        return "of samples"
    if constraint.startswith(("gimbal", "field of view", "body")):
        return "rad"
    return "m"


def broken(constraint: str, limit: float, *, upper: bool = True) -> Claim:
    """A claim that is broken by hardly more than is let pass."""
    off = 2 * slack(limit)
    worst = limit + off if upper else limit - off
    shot = "half" if constraint.endswith(tuple(ENDING)) else None
    return replace(
        SPEED,
        constraint=constraint,
        shot=shot,
        limit=limit,
        worst=worst,
        upper=upper,
        unit=unit_of(constraint),
        holds=False,
        path=("shots", 0),
    )


@pytest.mark.parametrize(
    "constraint",
    [pytest.param(c, marks=[pytest.mark.slow] if " visible" in c else []) for c in CONSTRAINTS],
)
def test_a_limit_broken_by_hardly_anything_shows_by_what(constraint: str) -> None:
    for limit, upper in product((0.0, 0.05, 0.5235987755982988, 8.0, 1200.0), (True, False)):
        (found,) = report(PLAN, (broken(constraint, limit, upper=upper),))
        told = re.findall(r"-?[0-9][0-9.e+-]*", found.message)
        assert len(told) >= 2
        # The last two numbers are the value and its limit; a name may hold others before them.
        assert float(told[-2]) != float(told[-1])
        assert (float(told[-2]) > float(told[-1])) is upper


def test_the_label_on_the_limit_says_the_limit_of_the_message() -> None:
    (found,) = report(PLAN, (broken("gimbal pitch max", 0.52359),))
    assert found.labels[0].text.removeprefix("at most ") in found.message


def test_a_certificate_shows_what_is_broken_and_by_what() -> None:
    rows = certificate_text((broken("gimbal pitch max", 0.5235987755982988),)).splitlines()
    (row,) = (line for line in rows if "BROKEN" in line)
    assert "<= 30 deg" in row
    assert "30.0001" in row


def test_a_duration_that_is_hardly_too_short_is_told_a_longer_one() -> None:
    slow = replace(broken("speed", 8.0), unit="m/s", shot="half", path=("drones", "cam1", "limits", "speed"))
    (found,) = report(PLAN, (slow,))
    assert "give shot `half` 30.1 s or more" in found.help  # it lasts 30.0 s


def test_a_limit_of_nothing_asks_for_no_endless_shot() -> None:
    still = replace(broken("speed", 0.0), unit="m/s", shot="half", path=("drones", "cam1", "limits", "speed"))
    (found,) = report(PLAN, (still,))
    assert found.help.startswith("raise `limits.speed` to ")


@pytest.mark.slow
@given(st.floats(-1e3, 1e3), st.floats(1e-6, 1.0), st.sampled_from(["m", "m/s", "rad", "of samples"]))
def test_values_that_differ_look_different(value: float, by: float, unit: str) -> None:
    one, other = distinct_measures(value, value + by, unit)
    assert one != other


@pytest.mark.parametrize(("worst", "said"), [(-3.67, "3.670 m inside"), (1.25, "1.250 m outside")])
def test_a_certificate_says_on_which_side_of_the_frame_a_drone_is(worst: float, said: str) -> None:
    seen = replace(broken(f"b{SIGHT}", 0.0, upper=False), worst=worst, unit="m", hard=False)
    (row,) = (line for line in certificate_text((seen,)).splitlines() if SIGHT in line)
    assert "outside the frame" in row
    assert said in row
