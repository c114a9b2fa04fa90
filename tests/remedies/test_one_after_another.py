"""Help that leads to another error: that one tells a number, too, and with it the mission is planned."""

from __future__ import annotations

import pytest

from shotc.diag.registry import has_errors, registry
from tests.remedies.test_planned import planned
from tests.support.front_passes import placed
from tests.support.remedies.apply import remedies

pytestmark = pytest.mark.slow

CAR = """\
shotc: 1
mission: run
targets:
  car: {track: {start: [0, 0, 0.9], velocity: [10, 0, 0]}, radius: 1, height: 1.8}
drones:
  cam1: {model: x500, home: [0, -30, 0], limits: {speed: 8 m/s}}
shots:
  - {id: side, kind: lateral, drone: cam1, target: car, side: left, distance: 8, altitude: 4,
     timing: {start: 11, duration: 6}}
"""
"""A car that never stops, on its way before the drone is."""


def ends_well(text: str, codes: tuple[str, ...]) -> bool:
    """Tell whether a mission plans once the first remedy of each of these errors is written into it."""
    for code in codes:
        found = planned(text)
        if not has_errors(found):
            return True
        (fault,) = found
        assert fault.code == code
        remedy = next(remedies(text, fault))
        text = next(mission for mission in remedy.missions if not placed(mission.encode())[1])
    return not has_errors(planned(text))


@pytest.mark.long
@pytest.mark.parametrize("text", [registry()["M005"].failing, CAR], ids=["example", "car"])
def test_a_drone_with_the_speed_that_is_told_is_there_at_the_start_that_is_told(text):
    assert [d.code for d in placed(text.encode())[1]] == ["M005"]
    assert ends_well(text, ("M005", "T003"))


@pytest.mark.long
@pytest.mark.parametrize("timing", ["{start: 11, duration: 6}", "{duration: 6}"])
def test_a_drone_that_does_not_catch_up_is_told_the_speed_at_which_it_does(timing):
    text = CAR.replace("speed: 8", "speed: 10").replace("{start: 11, duration: 6}", timing)
    (fault,) = planned(text)
    assert "does not catch up" in fault.message
    assert ends_well(text, ("T003", "T003"))
