"""When a shot can begin: its start, or the end of all that it comes after."""

from __future__ import annotations

import pytest

from shotc.ir.begins import known_start
from shotc.ir.limits import Timing
from shotc.ir.mission import MissionIR, Shot
from tests.support.film_plans import orbit_mission
from tests.support.records import replace


def of(*timings: tuple[str, Timing]) -> MissionIR:
    """Shots a, b, c... of the drones that are given."""
    base = orbit_mission()
    names = "abcdefg"
    shots: list[Shot] = [
        replace(base.shots[0], id=name, drone=drone, timing=timing)
        for name, (drone, timing) in zip(names, timings, strict=False)
    ]
    return replace(base, shots=tuple(shots))


FIRST = ("one", Timing(15.0, None, 20.0))


@pytest.mark.parametrize(
    ("mission", "begins"),
    [
        (of(FIRST), [15.0]),
        (of(("one", Timing(None, None, 20.0))), [None]),
        (of(FIRST, ("one", Timing(None, None, 10.0)), ("one", Timing(None, None, None))), [15.0, 35.0, 45.0]),
        (of(FIRST, ("two", Timing(None, "a", 5.0)), ("two", Timing(None, None, None))), [15.0, 35.0, 40.0]),
        (of(FIRST, ("two", Timing(50.0, None, 5.0)), ("two", Timing(None, "a", None))), [15.0, 50.0, 55.0]),
        (of(FIRST, ("two", Timing(None, None, 5.0)), ("two", Timing(None, "a", None))), [15.0, None, None]),
        (of(("one", Timing(15.0, None, None)), ("two", Timing(None, "a", 5.0))), [15.0, None]),
        (of(("two", Timing(None, "b", 5.0)), FIRST), [35.0, 15.0]),
        (of(("one", Timing(None, "b", 5.0)), ("one", Timing(None, "a", 5.0))), [None, None]),
        (of(FIRST, ("two", Timing(None, "nobody", 5.0))), [15.0, None]),
        # Written second, flown first.
        (of(("one", Timing(50.0, None, 5.0)), FIRST, ("one", Timing(None, None, 1.0))), [50.0, 15.0, 55.0]),
    ],
)
def test_known_starts(mission: MissionIR, begins: list[float | None]) -> None:
    assert [known_start(mission, shot) for shot in mission.shots] == begins
