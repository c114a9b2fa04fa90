"""The files as other programs read them."""

from __future__ import annotations

import copy
import json
from pathlib import Path

import pytest
from pymavlink import mavwp

from shotc.emit.mavlink import EMITTER
from shotc.emit.mavlink.items import MissionItem
from shotc.emit.mavlink.plan_file import read_plan
from shotc.emit.mavlink.wpl import read_waypoints
from shotc.ir.trajectory import VerifiedIR
from tests.support.film_plans import orbit_plan
from tests.support.mavlink_flights import plan, retold, straight
from tests.support.qgc_rules import check_plan

pytestmark = pytest.mark.slow

PLANS = {
    "orbit": orbit_plan,
    "straight": lambda: plan(straight()),
    "framed": lambda: plan(straight(), target="tower"),
}


def sample(name: str, autopilot: str) -> VerifiedIR:
    return retold(PLANS[name](), autopilot=autopilot)


@pytest.mark.parametrize("autopilot", ["px4", "ardupilot"])
@pytest.mark.parametrize("name", PLANS)
def test_qgroundcontrol_and_the_autopilot_would_take_the_plan(name: str, autopilot: str) -> None:
    check_plan(EMITTER.emit(sample(name, autopilot)).artifacts[0].data)


@pytest.mark.parametrize("name", PLANS)
def test_pymavlink_loads_the_waypoints(name: str, tmp_path: Path) -> None:
    data = EMITTER.emit(sample(name, "ardupilot")).artifacts[1].data
    path = tmp_path / "cam1.waypoints"
    path.write_bytes(data)
    loader = mavwp.MAVWPLoader()
    assert loader.load(str(path)) == data.count(b"\n") - 1
    home, *rows = [loader.wp(i) for i in range(loader.count())]
    items, place = read_waypoints(data)
    assert (home.command, home.frame, home.current) == (16, 0, 1)
    assert (home.x, home.y, home.z) == pytest.approx(place)
    assert rows[0].command == 22
    assert rows[-1].command == 21
    for row, item in zip(rows, items, strict=True):
        assert (row.command, row.frame, row.current, row.autocontinue) == (item.command, item.frame, 0, 1)
        told = [row.param1, row.param2, row.param3, row.param4, row.x, row.y, row.z]
        assert told == pytest.approx(item.params, abs=1e-9)


def test_both_formats_hold_the_same_items() -> None:
    emission = EMITTER.emit(sample("orbit", "ardupilot"))

    def rounded(items: list[MissionItem]) -> list[tuple[int, int, list[float]]]:
        return [(i.command, i.frame, [round(float(p or 0.0), 8) for p in i.params]) for i in items]

    one, home = read_plan(emission.artifacts[0].data)
    other, same_home = read_waypoints(emission.artifacts[1].data)
    assert rounded(one) == rounded(other)
    assert home == pytest.approx(same_home)


def test_coordinates_keep_eight_decimals() -> None:
    data = EMITTER.emit(sample("orbit", "ardupilot")).artifacts[1].data.decode()
    for row in data.splitlines()[1:]:
        columns = row.split("\t")
        assert len(columns) == 12
        if columns[3] in ("16", "21", "22", "195"):
            assert len(columns[8].split(".")[1]) >= 8


BREAKAGE = {
    "frame 2 for a place": lambda m: m["mission"]["items"][0].update(frame=2),
    "no fence": lambda m: m.pop("geoFence"),
    "old fence": lambda m: m["geoFence"].update(version=1),
    "six parameters": lambda m: m["mission"]["items"][3]["params"].pop(),
    "landing first": lambda m: m["mission"]["items"].insert(0, m["mission"]["items"].pop()),
    "no speed": lambda m: next(i for i in m["mission"]["items"] if i["command"] == 178)["params"].__setitem__(
        1, 0
    ),
    "a null yaw rule on an action": lambda m: m["mission"]["items"][1]["params"].__setitem__(0, None),
    "counter-clockwise": lambda m: m["geoFence"]["polygons"][0]["polygon"].reverse(),
}


@pytest.mark.parametrize("fault", BREAKAGE)
def test_the_rules_notice_a_broken_plan(fault: str) -> None:
    document = json.loads(EMITTER.emit(sample("orbit", "px4")).artifacts[0].data)
    broken = copy.deepcopy(document)
    BREAKAGE[fault](broken)
    check_plan(json.dumps(document).encode())
    with pytest.raises((AssertionError, KeyError)):
        check_plan(json.dumps(broken).encode())
