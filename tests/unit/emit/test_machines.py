"""What a machine takes is what is written for it, unless the mission says otherwise."""

from __future__ import annotations

import pytest

from shotc.ir.source import TAKES, flown_by
from shotc.lowering import with_autopilot
from shotc.spec.presets import PRESETS
from shotc.stream.autopilots import AUTOPILOTS
from shotc.stream.session import unheard
from tests.support.film_plans import orbit_plan
from tests.support.front_passes import placed

TEXT = """\
shotc: 1
mission: two
world: {origin: {lat: 46.94, lon: 7.45, alt: 500}}
targets: {mast: {at: [0, 0, 6], radius: 1, height: 12}}
drones:
  one: {model: ONE, home: [0, -40, 0]}
  two: {model: TWO, home: [0, -60, 0]}
shots:
  - {id: a, kind: static, drone: one, at: [0, -25, 10], look_at: mast, timing: {duration: 5}}
"""


def emitters(one: str, two: str, text: str = TEXT) -> tuple[str, ...]:
    keyframes, found = placed(text.replace("ONE", one).replace("TWO", two))
    assert keyframes is not None, found
    return keyframes.mission.emit


@pytest.mark.parametrize(
    ("one", "two", "files"),
    [
        ("x500", "solo", ("mavlink",)),
        ("mini", "mavic-3-pro", ("dji",)),
        ("mini-3-pro", "mini-3", ("litchi",)),
        ("x500", "pro", ("mavlink", "dji")),
    ],
)
def test_a_mission_that_asks_for_nothing_gets_what_its_machines_fly(one, two, files):
    assert emitters(one, two) == ("csv", *files, "storyboard", "rerun")


def test_a_mission_that_asks_for_nothing_and_has_no_place_on_earth_gets_no_machine_files():
    nowhere = TEXT.replace("world: {origin: {lat: 46.94, lon: 7.45, alt: 500}}\n", "")
    assert emitters("x500", "pro", nowhere) == ("csv", "storyboard", "rerun")


def test_another_autopilot_puts_its_files_in_place_of_others():
    assert flown_by("dji-fly", ("csv", "mavlink", "rerun")) == ("csv", "dji", "rerun")
    assert flown_by("ardupilot", ("csv", "mavlink")) == ("csv", "mavlink")
    assert flown_by("px4", ("dji", "litchi", "csv")) == ("mavlink", "csv")
    keyframes = with_autopilot(orbit_plan().trajectory.keyframes, "pilot-2")
    assert keyframes.mission.emit == ("csv", "dji", "rerun")
    assert keyframes.mission.source.chosen.autopilot == "pilot-2"


def test_what_takes_setpoints_takes_mavlink_missions_and_nothing_else_is_streamed_to():
    assert {name for name, files in TAKES.items() if "mavlink" in files} == set(AUTOPILOTS)
    mission = with_autopilot(orbit_plan().trajectory.keyframes, "dji-fly").mission
    (told,) = unheard(mission, ["cam1"])
    assert told.code == "A032"
    assert "dji-fly" in told.message
    assert list(unheard(orbit_plan().trajectory.keyframes.mission, ["cam1"])) == []


def test_machines_of_dji_fly_no_faster_than_their_waypoints():
    dji = [p for p in PRESETS.values() if p.autopilot in ("dji-fly", "pilot-2", "litchi")]
    assert len(dji) == 12
    assert all(p.limits.speed <= 15.0 and p.fixed_lens for p in dji)
