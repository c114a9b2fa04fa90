"""Helps of rehearsals that name a number: with it the conditions can be flown."""

from __future__ import annotations

import re
from types import SimpleNamespace
from typing import Any

from shotc.diag.model import Diagnostic
from shotc.geom.track import Track
from shotc.ir.mission import MissionIR
from shotc.simulation.conditions import Conditions
from shotc.simulation.rehearsal_faults import unflyable
from shotc.simulation.truth import Truth
from shotc.simulation.wind import WindField
from tests.support.film_plans import orbit_mission
from tests.support.plain_flights import plain_flight
from tests.support.records import replace


def faults(mission: MissionIR, conditions: Conditions) -> list[Diagnostic]:
    """Return the faults of conditions for a flight of 28 s."""
    flight: Any = SimpleNamespace(
        keyframes=SimpleNamespace(mission=mission), drones=(plain_flight(mission).track,)
    )
    return list(unflyable(flight, conditions))


def told(pattern: str, fault: Diagnostic) -> float:
    found = re.search(pattern, fault.help or "")
    assert found is not None
    return float(found[1])


def test_less_wind_and_a_faster_drone_end_w003() -> None:
    mission = orbit_mission()
    (fault,) = faults(mission, Conditions(wind=WindField(speed=30.0)))
    assert fault.code == "W003"
    less = told(r"less than ([\d.]+) m/s of wind", fault)
    assert faults(mission, Conditions(wind=WindField(speed=less - 0.01))) == []
    fast = told(r"`limits.speed` over ([\d.]+) m/s", fault)
    drones = tuple(d._replace(limits=d.limits._replace(speed=fast + 0.01)) for d in mission.drones)
    assert faults(replace(mission, drones=drones), Conditions(wind=WindField(speed=30.0))) == []


def test_rows_until_the_time_that_is_told_end_w004() -> None:
    mission, points = orbit_mission(), ((0.0, 0.0, 10.0), (5.0, 0.0, 10.0))

    def truth(end: float) -> Conditions:
        return Conditions(truth=Truth(tracks=((mission.targets[0].name, Track((0.0, end), points)),)))

    (fault,) = faults(mission, truth(20.0))
    assert fault.code == "W004"
    assert faults(mission, truth(told(r"rows until ([\d.]+) s", fault))) == []


def test_rows_as_slow_as_is_told_end_the_jump_of_w004() -> None:
    mission, times = orbit_mission(), (0.0, 1.0, 30.0)

    def truth(metres: float) -> Conditions:
        points = ((0.0, 0.0, 10.0), (metres, 0.0, 10.0), (metres, 0.0, 10.0))
        return Conditions(truth=Truth(tracks=((mission.targets[0].name, Track(times, points)),)))

    (fault,) = faults(mission, truth(500.0))
    assert fault.code == "W004"
    assert faults(mission, truth(told(r"faster than ([\d.]+) m/s", fault))) == []
