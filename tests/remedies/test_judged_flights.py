"""Helps about flights of other tools: each number is flown, and the flight keeps the limit."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import NamedTuple

import pytest

from tests.support.flight_files import AROUND, MISSION, TWO, codes, litchi_file, verified

pytestmark = pytest.mark.slow


class Case(NamedTuple):
    """A file of a flight that breaks a limit, by a number that its help gives.

    file    : the file for a number, 0 for that which breaks the limit
    pattern : the help with its number
    """

    code: str
    pattern: str
    file: Callable[[float], bytes]
    text: str = MISSION


HOME = (0.0, -60.0, 8.0)


def beside(more: float) -> bytes:
    """Return a flight that passes the hut at 5.2 m from its middle there and back, and so much more."""
    past = -5.2 - more
    return litchi_file([HOME, (past, -40.0, 8.0), (past, 40.0, 8.0), (past, -40.0, 8.0), HOME])


def above(metres: float) -> bytes:
    return litchi_file([(x, y, metres) for x, y, _ in AROUND])


def faster(speed: float) -> bytes:
    return litchi_file(AROUND, speed=speed)


YARD = "  yard: {keep: in, box: {center: [0, 0, 25], size: [70, 200, 60]}}"
MAST = "targets: {mast: {at: [-40, 0, 15], radius: 1, height: 30}}\ndrones:"


def west(metres: float) -> bytes:
    """Return a flight so far west of the hut there and back."""
    return litchi_file([HOME, (-metres, -40.0, 20.0), (-metres, 40.0, 20.0), (-metres, -40.0, 20.0), HOME])


CASES = [
    Case("V008", r"keep ([\d.]+) m farther inside there", lambda less: west(40.0 - less),
        MISSION.replace("drones:", f"  {YARD}\ndrones:", 1)),
    Case("V010", r"keep ([\d.]+) m farther away there", lambda more: west(41.5 + more),
        MISSION.replace("drones:", MAST, 1)),
    Case("V001", r"fly slower there, by ([\d.]+) m/s at least", lambda less: faster(12.0 - less)),
    Case("V007", r"keep ([\d.]+) m farther away there", beside),
    Case("V009", r"fly ([\d.]+) m higher there", lambda more: above(0.9 + more)),
    Case("V047", r"fly ([\d.]+) m lower there", lambda less: above(20.0 - less),
        MISSION.replace("drones:", "rules: {max_height: 15}\ndrones:", 1)),
]  # fmt: skip


@pytest.mark.long
@pytest.mark.parametrize("case", CASES, ids=[case.code for case in CASES])
def test_a_flight_changed_by_the_number_of_its_help_keeps_the_limit(case: Case) -> None:
    refused = verified(("cam1.csv", case.file(0.0)), text=case.text)
    (fault,) = (d for d in refused.diagnostics if d.code == case.code)
    number = re.search(case.pattern, fault.help or "")
    assert number is not None, fault.help
    mended = verified(("cam1.csv", case.file(float(number[1]))), text=case.text)
    assert case.code not in codes(mended)
    assert set(codes(mended)) <= set(codes(refused))


def test_a_file_named_after_its_drone_or_given_to_it_is_judged() -> None:
    data = litchi_file(AROUND)
    assert codes(verified(("flight.csv", data), text=TWO)) == ["I013"]
    assert "I013" not in codes(verified(("cam1.csv", data), text=TWO))
    assert "I013" not in codes(verified(("flight.csv", data), text=TWO, drones=["cam1"]))


def test_a_mission_with_a_place_on_earth_judges_a_flight() -> None:
    nowhere = MISSION.replace("  origin: {lat: 47.3769, lon: 8.5417, alt: 408}\n", "")
    (fault,) = verified(("cam1.csv", litchi_file(AROUND)), text=nowhere).diagnostics
    assert fault.code == "I014"
    assert fault.help == "write `world: {origin: {lat: ..., lon: ..., alt: ...}}`"
    assert codes(verified(("cam1.csv", litchi_file(AROUND)))) == []
