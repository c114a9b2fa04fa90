"""The vehicle of the second opinion flies items as the page on outputs says, on files of a few items."""

from __future__ import annotations

from math import nan
from typing import Any

import numpy as np
import pymap3d
import pytest

from tests.support.second_opinion.mission_files import Item, MissionFile
from tests.support.second_opinion.vehicle import Flown, fly

ORIGIN = {"lat": 47.0, "lon": 8.0, "alt": 400.0}
HOME = (47.0, 8.0, 400.0)
DRONE: dict[str, Any] = {
    "limits": {"speed": 5.0, "climb": 2.0, "descent": 2.0},
    "gimbal": {"yaw": [-3.0, 3.0]},
    "autopilot": "px4",
}
TAKE_OFF, LANDING = Item(22, 3, (0.0, 0.0, 0.0, 0.0, 47.0, 8.0, 10.0)), Item(21, 3, (0.0,) * 7)


def to(east: float, *, stay: float = 0.0, heading: float = 90.0) -> Item:
    lat, lon, _ = pymap3d.enu2geodetic(east, 0.0, 10.0, *HOME)
    return Item(16, 3, (stay, 0.5, 0.0, heading, lat, lon, 10.0))


def flown(*items: Item, autopilot: str = "px4") -> Flown:
    file = MissionFile((TAKE_OFF, *items, LANDING), HOME, ORIGIN)
    return fly(file, {**DRONE, "autopilot": autopilot}, 0.0)


@pytest.mark.parametrize("stay", [0.0, 4.0])
def test_a_turn_goes_on_while_the_vehicle_moves_and_not_later_because_it_stays(stay: float) -> None:
    """From East to North in 4 s, over 20 m at 5 m/s: at 10 m half of it, however long the stay is."""
    turned = flown(
        Item(115, 2, (0.0, 22.5, 0.0, 0.0, 0.0, 0.0, 0.0)), to(20.0, stay=stay), autopilot="ardupilot"
    )
    at = int(np.abs(turned.place[:, 0] - 10.0).argmin())
    assert turned.body[at] == pytest.approx(np.pi / 4, abs=2e-3)
    assert turned.body[-1] == pytest.approx(np.pi / 2)


def test_a_turn_goes_on_at_the_waypoint_at_which_the_vehicle_stays() -> None:
    turned = flown(
        Item(115, 2, (0.0, 11.25, 0.0, 0.0, 0.0, 0.0, 0.0)), to(20.0, stay=4.0), autopilot="ardupilot"
    )
    arrived = int((turned.place[:, 0] < 20.0 - 1e-3).sum())
    assert turned.body[arrived] == pytest.approx(np.pi / 4, abs=1e-2)
    assert turned.body[-1] == pytest.approx(np.pi / 2)


def test_a_px4_turns_to_the_heading_of_a_waypoint_from_the_beginning_of_the_leg_to_it() -> None:
    """From East to North at 45 deg/s, over 20 m at 5 m/s: turned after 2 s, which is 10 m."""
    turned = flown(to(20.0, heading=0.0))
    for east, yaw in ((0.0, 0.0), (5.0, np.pi / 4), (10.0, np.pi / 2), (20.0, np.pi / 2)):
        assert turned.body[int(np.abs(turned.place[:, 0] - east).argmin())] == pytest.approx(yaw, abs=4e-3)


def test_a_recording_lasts_as_long_as_its_legs_and_its_stays() -> None:
    assert flown(Item(2500, 2, (0.0,) * 7), to(20.0, stay=3.0)).filmed == pytest.approx(7.0)


@pytest.mark.parametrize(("flags", "yaw"), [(12.0, np.radians(-30.0)), (28.0, np.radians(60.0))])
def test_the_yaw_of_a_gimbal_counts_from_the_body_or_where_it_is_locked_from_north(
    flags: float, yaw: float
) -> None:
    """30 degrees clockwise, of a body that faces East."""
    aimed = flown(Item(1000, 2, (-10.0, 30.0, nan, nan, flags, 0.0, 0.0)), to(20.0))
    assert aimed.aim[-1] == pytest.approx((yaw, np.radians(-10.0)))


def test_a_focus_holds_from_its_item_on() -> None:
    focused = flown(to(10.0), Item(532, 2, (3.0, 12.5, 0.0, 0.0, 0.0, 0.0, 0.0)), to(20.0)).focus
    assert np.isnan(focused[0])
    assert focused[-1] == 12.5
