from __future__ import annotations

from math import pi, radians

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from shotc.emit.mavlink.dialect import ArduPilot, Px4
from shotc.emit.mavlink.items import FRAME_MISSION, FRAME_RELATIVE, action, at, compass_deg, signed_deg
from shotc.emit.mavlink.style import Command, Style
from shotc.emit.waypoints.geo import GeoPosition, tie
from shotc.ir.mission import GeoOrigin

ORIGIN = GeoOrigin(47.3769, 8.5417, 408.0)
PANS = Style("px4", pans=True, followed={}, aimed=frozenset())
FIXED = Style("px4", pans=False, followed={}, aimed=frozenset())


@pytest.mark.parametrize(
    ("yaw", "heading"), [(0.0, 90.0), (pi / 2, 0.0), (pi, 270.0), (-pi / 2, 180.0), (5 * pi / 2, 0.0)]
)
def test_headings_run_clockwise_from_north(yaw: float, heading: float) -> None:
    assert compass_deg(yaw) == heading


@pytest.mark.slow
@given(st.floats(-50.0, 50.0))
def test_headings_never_reach_360_and_signed_angles_stay_in_range(yaw: float) -> None:
    assert 0.0 <= compass_deg(yaw) < 360.0
    assert -180.0 <= signed_deg(yaw) <= 180.0
    assert np.isclose(np.cos(radians(signed_deg(yaw))), np.cos(yaw), atol=1e-5)


def test_actions_use_the_mission_frame_and_places_the_relative_one() -> None:
    assert action(2500).frame == FRAME_MISSION
    assert len(action(2500).params) == 7
    assert at(16, GeoPosition(1.0, 2.0, 3.0), 0.0, 0.0, 0.0, None).frame == FRAME_RELATIVE
    assert at(16, GeoPosition(1.0, 2.0, 3.0), 0.0, 0.0, 0.0, None).params[4:] == (1.0, 2.0, 3.0)


def test_a_camera_left_of_the_body_has_a_negative_gimbal_yaw_on_ardupilot() -> None:
    # Body looks East, camera 30 degrees further to the North, which is to the left.
    command = Command(
        body_yaw=0.0, pan=radians(30), cam_yaw=radians(30), cam_pitch=radians(-10), hfov=radians(70)
    )
    item = ArduPilot().gimbal(command, PANS)
    assert item.command == 205
    assert item.params == (-10.0, 0.0, -30.0, 0.0, 0.0, 0.0, 2.0)


def test_px4_tells_a_panning_gimbal_the_direction_on_earth() -> None:
    command = Command(
        body_yaw=0.0, pan=radians(30), cam_yaw=radians(30), cam_pitch=radians(-10), hfov=radians(70)
    )
    item = Px4().gimbal(command, PANS)
    assert item.command == 1000
    assert item.params == (-10.0, 60.0, None, None, 28.0, 0.0, 0.0)
    assert Px4().gimbal(command, FIXED).params == (-10.0, 0.0, None, None, 12.0, 0.0, 0.0)


def test_the_tie_puts_the_pad_at_height_zero_and_goes_there_and_back() -> None:
    geo = tie(ORIGIN, (0.0, -60.0, 3.0))
    assert geo.place((0.0, -60.0, 3.0)).alt == 0.0
    assert geo.home_alt == pytest.approx(411.0, abs=1e-3)
    for point in ((10.0, 20.0, 30.0), (-400.0, 300.0, 12.0)):
        assert geo.point(geo.place(point)) == pytest.approx(point, abs=3e-4)


def test_north_raises_latitude_and_east_longitude() -> None:
    geo = tie(ORIGIN, (0.0, 0.0, 0.0))
    north, east = geo.place((0.0, 111.2, 0.0)), geo.place((100.0, 0.0, 0.0))
    assert north.lat - ORIGIN.lat_deg == pytest.approx(1e-3, rel=2e-3)
    assert north.lon == pytest.approx(ORIGIN.lon_deg, abs=1e-9)
    assert east.lon > ORIGIN.lon_deg
    assert geo.place((0.0, 0.0, 17.5)).alt == 17.5
