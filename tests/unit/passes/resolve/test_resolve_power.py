"""Battery, mass and rotors as missions write them, and how long they hold."""

from __future__ import annotations

import pytest

from shotc.ir.drone import Drone
from tests.support.front_passes import resolved
from tests.support.resolve_missions import faults, only

MISSION = """\
shotc: 1
mission: long
world: {ORIGIN}
drones: {cam: {model: MODEL, home: [0, -30, 0], WRITTEN}}
shots:
  - {id: wait, kind: static, drone: cam, at: [0, 0, 10], heading: 0 deg, pitch: 0 deg,
     timing: {duration: 14.5 min}}
"""
WRITTEN = (
    "power: {mass: 4.4 lb, battery: 77 Wh, rotors: {count: 4, radius: 127 mm}, hover: 18 min, reserve: 10 %}"
)


def text(written: str = "", model: str = "x500", origin: str = "") -> str:
    return MISSION.replace("WRITTEN", written).replace("MODEL", model).replace("ORIGIN", origin)


def drone(*written: str) -> Drone:
    mission, found = resolved(text(*written).replace("14.5 min", "1 min"))
    assert mission is not None
    assert found == []
    return mission.drones[0]


def test_a_model_whose_battery_is_known_lasts_by_its_energy() -> None:
    found = drone()
    assert found.power is not None
    assert found.endurance == found.power.endurance == pytest.approx(864.0)
    told = only(text())
    assert told.code == "K005"
    assert "864.0 s, 61.6 Wh at 257 W hovering, 20 % kept" in told.notes[0]


def test_a_model_of_which_nobody_knows_it_lasts_by_its_time() -> None:
    assert drone("", "mini").power is None
    assert drone("", "mini").endurance == 24 * 60


def test_an_endurance_that_is_written_is_taken_at_its_word() -> None:
    assert drone("endurance: 20 min").power is None
    assert faults(text("endurance: 20 min")) == []


def test_power_that_is_written_counts_whatever_the_model() -> None:
    found = drone(WRITTEN, "mini")
    assert found.power is not None
    assert found.power.mass == pytest.approx(1.99581, abs=1e-5)
    assert found.endurance == pytest.approx(0.9 * 18 * 60)
    both = drone(WRITTEN + ", endurance: 10 min", "mini")
    assert (both.endurance, both.power) == (600.0, found.power)


def test_thin_air_takes_more() -> None:
    high = drone("", "x500", "origin: {lat: 46, lon: 8, alt: 3000}")
    assert high.power is not None
    assert high.endurance == pytest.approx(864.0 * (0.9091 / 1.225) ** 0.5, rel=1e-3)


@pytest.mark.parametrize(
    ("slip", "code", "said"),
    [
        ("battery: 77,", "S014", "write `77 Wh`"),
        ("battery: 77 mAh,", "U001", "unknown unit `mAh`"),
        ("battery: 5 kg,", "U002", "expected an energy, got a mass"),
    ],
)
def test_slips_are_told(slip: str, code: str, said: str) -> None:
    told = only(text(WRITTEN.replace("battery: 77 Wh,", slip)))
    assert told.code == code
    assert said in f"{told.message} {told.help}"


def test_how_much_it_hovers_is_said_once() -> None:
    assert [d.code for d in faults(text(WRITTEN.replace("hover: 18 min", "efficiency: 48 %, hover: 18 min")))]
    assert [d.code for d in faults(text(WRITTEN.replace(", hover: 18 min", "")))]
