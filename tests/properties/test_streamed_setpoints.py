"""In whatever local frame, every setpoint is on the proved trajectory, and every angle is the plan's."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from shotc.ir.path import BODY_YAW, CAM_PITCH, CAM_YAW
from shotc.stream.autopilots import ARDUPILOT, PX4
from shotc.stream.clock import RATE_HZ
from shotc.stream.messages import GlobeFix
from shotc.stream.projection import LocalFrame
from shotc.stream.setpoints import course_of
from tests.support.film_plans import orbit_plan
from tests.support.stream.globe import ardupilot_place, in_world, px4_place
from tests.support.stream.plans import hop_plan

PLANS = [orbit_plan(), hop_plan(waits=0.0, pans=True)]
ORIGINS = st.builds(GlobeFix, st.floats(47.372, 47.382), st.floats(8.534, 8.549), st.floats(350.0, 470.0))


def apart(a, b):
    return abs((a - b + pi) % (2 * pi) - pi)


@pytest.mark.long
@pytest.mark.parametrize("pilot", [PX4, ARDUPILOT], ids=["px4", "ardupilot"])
@given(origin=ORIGINS, raised=st.floats(-1, 1), which=st.sampled_from(PLANS), share=st.floats(-0.1, 1.1))
def test_a_setpoint_is_where_the_plan_is_at_its_tick(pilot, origin, raised, which, share):
    (track,) = which.trajectory.drones
    world = which.trajectory.keyframes.mission.origin
    course = course_of(track, world, LocalFrame(pilot.layout, origin, raised), pilot.lift)
    tick = round(share * course.last)
    sent = course.setpoint(tick)
    at = min(max(tick, course.first), course.last)
    t = min(at / RATE_HZ, track.curve.end)
    back = px4_place if pilot is PX4 else ardupilot_place
    there = in_world(sent.position, origin, world, back, raised)
    pose = track.curve(t)
    assert there == pytest.approx(pose[:3].tolist(), abs=1e-4)
    east, north, up = track.curve.derivative()(t)[:3].tolist()
    moves = at == tick
    assert sent.velocity == ((north, east, -up) if moves else (0.0, 0.0, 0.0))
    east, north, up = track.curve.derivative(2)(t)[:3].tolist()
    assert sent.acceleration == ((north, east, -up) if moves else (0.0, 0.0, 0.0))
    assert apart(sent.yaw, pi / 2 - pose[BODY_YAW]) < 1e-12
    aim = course.aim(tick)
    turns = track.curve.derivative()(t) if moves else np.zeros(7)
    assert (aim.pitch_rate, aim.yaw_rate) == (turns[CAM_PITCH], -turns[CAM_YAW])
    assert aim.pitch == pose[CAM_PITCH]
    assert apart(aim.yaw, pi / 2 - pose[CAM_YAW]) < 1e-12


def test_all_of_a_flight_is_sent_and_nothing_after_it():
    (track,) = PLANS[0].trajectory.drones
    world = PLANS[0].trajectory.keyframes.mission.origin
    course = course_of(track, world, LocalFrame(PX4.layout, GlobeFix(47.3769, 8.5417, 408.0)), 0.0)
    assert (course.last - 1) / RATE_HZ < track.curve.end <= course.last / RATE_HZ
    assert course.setpoint(course.last + 99).position == course.setpoint(course.last).position
    assert course.setpoint(-99).position == course.setpoint(0).position
