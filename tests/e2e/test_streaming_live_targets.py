"""A live target moves the camera and nothing else, and the camera comes back when nothing is heard."""

from __future__ import annotations

import numpy as np
import pytest

from shotc.geom.camera import view
from shotc.geom.earth import of_world
from shotc.ir.path import BODY_YAW, CAM_PITCH, CAM_YAW, HFOV
from shotc.stream.aim import LiveAim
from shotc.stream.autopilots import PX4
from shotc.stream.clock import PERIOD_S, RATE_HZ
from shotc.stream.messages import GlobeFix
from shotc.stream.projection import LocalFrame
from shotc.stream.setpoints import course_of
from tests.support.stream.plans import hop_plan
from tests.support.stream.worlds import World, send_json, send_position

STEADY = 11.0
"""Mission time by which a gimbal has long come to where it was sent."""


class Heard:
    """A feed that says the same place at all times."""

    def __init__(self, spot):
        self.target, self.spot = "tower", spot

    def position(self, now):
        return self.spot


def live(plan, spot):
    """Return a drone's camera with a target that is at ``spot``, its course and its track."""
    mission, (track,) = plan.trajectory.keyframes.mission, plan.trajectory.drones
    course = course_of(track, mission.origin, LocalFrame(PX4.layout, GlobeFix(47.3769, 8.5417, 408.0)), 0.0)
    return LiveAim(mission, track, course, (Heard(spot),)), course, track


def run_to(aim, tick):
    return [aim.at(k, k / RATE_HZ) for k in range(tick + 1)][-1]


@pytest.mark.parametrize("spot", [(8.0, 5.0, 12.0), (-6.0, -3.0, 15.0), (2.0, 0.0, None)])
def test_the_target_is_kept_where_the_plan_has_it_on_screen(spot):
    plan = hop_plan(pans=True)
    aim, course, track = live(plan, spot)
    tick = round(STEADY * RATE_HZ)
    sent, planned = run_to(aim, tick), course.aim(tick)
    pose = track.curve(STEADY)
    drone = plan.trajectory.keyframes.mission.drones[0]
    tower = plan.trajectory.keyframes.mission.target("tower").at(STEADY)
    there = (*spot[:2], tower[2] if spot[2] is None else spot[2])
    yaw = np.pi / 2 - sent.yaw
    seen = view(yaw, sent.pitch, pose[HFOV], drone.aspect).project(np.array(there) - pose[:3])
    wanted = view(pose[CAM_YAW], pose[CAM_PITCH], pose[HFOV], drone.aspect).project(
        np.array(tower) - pose[:3]
    )
    assert seen[:2] == pytest.approx(wanted[:2], abs=1e-3)
    assert (sent.pitch, sent.yaw) != (planned.pitch, planned.yaw)


def test_a_target_where_the_plan_has_it_changes_nothing():
    plan = hop_plan(pans=True)
    tower = plan.trajectory.keyframes.mission.target("tower").at(0.0)
    aim, course, _ = live(plan, tower)
    for tick in range(0, course.last, 10):
        assert aim.at(tick, tick / RATE_HZ) == pytest.approx(course.aim(tick), abs=1e-9)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("spot", "axis"),
    [((0.5, -49.0, 80.0), "pitch"), ((3.0, -150.0, 12.0), "yaw")],
    ids=["overhead", "behind"],
)
def test_the_camera_turns_no_faster_than_its_gimbal_and_stays_in_its_range(spot, axis):
    plan = hop_plan(pans=True)
    gimbal = plan.trajectory.keyframes.mission.drones[0].gimbal
    aim, course, track = live(plan, spot)
    off, at_its_end = [], False
    for tick in range(course.last):
        sent, planned = aim.at(tick, tick / RATE_HZ), course.aim(tick)
        off.append((sent.pitch - planned.pitch, (planned.yaw - sent.yaw + np.pi) % (2 * np.pi) - np.pi))
        pan = np.pi / 2 - sent.yaw - track.curve(tick / RATE_HZ)[BODY_YAW]
        assert gimbal.pitch[0] - 1e-9 <= sent.pitch <= gimbal.pitch[1] + 1e-9
        assert gimbal.yaw[0] - 1e-9 <= (pan + np.pi) % (2 * np.pi) - np.pi <= gimbal.yaw[1] + 1e-9
        reached = {"pitch": sent.pitch, "yaw": (pan + np.pi) % (2 * np.pi) - np.pi}[axis]
        at_its_end |= min(abs(reached - end) for end in getattr(gimbal, axis)) < 1e-6
    assert at_its_end
    steps = np.abs(np.diff(off, axis=0)).max()
    assert 0.9 * gimbal.rate * PERIOD_S < steps <= gimbal.rate * PERIOD_S + 1e-9


def test_a_gimbal_that_does_not_pan_follows_up_and_down_only():
    aim, course, _ = live(hop_plan(pans=False), (8.0, 5.0, 18.0))
    tick = round(STEADY * RATE_HZ)
    sent, planned = run_to(aim, tick), course.aim(tick)
    assert sent.yaw == planned.yaw
    assert sent.pitch > planned.pitch + 0.01


def test_beside_its_shots_the_camera_looks_where_the_plan_does():
    aim, course, _ = live(hop_plan(pans=True), (8.0, 5.0, 18.0))
    assert aim.at(10, 0.2) == course.aim(10)
    run_to(aim, course.last)
    assert aim.at(course.last + 1, 99.0) == course.aim(course.last + 1)


def feeding(world, send, until):
    """Send positions ten times a second of simulated time, up to a time."""

    def again():
        send()
        if world.clock.time < until:
            world.clock.events.append((world.clock.time + 0.1, again))

    again()


@pytest.mark.long
def test_setpoints_are_the_same_to_the_bit_whatever_the_target_does():
    plan = hop_plan(pans=True)
    with World(plan) as calm, World(plan, targets=["tower"]) as chased:
        calm.fly()
        place = of_world(np.array([[15.0, -8.0, 20.0]]), chased.mission.origin)[0]
        feeding(chased, lambda: send_position(chased.targets["tower"], place), chased.clock.time + 60)
        flown, _ = chased.fly()
        assert flown.landed
        plain, live_one = (np.array(w.autopilots["cam1"].setpoints)[:, 1:] for w in (calm, chased))
        aims = [np.array(w.autopilots["cam1"].aims)[:, 1:3] for w in (calm, chased)]
    assert np.array_equal(plain, live_one)
    # They end at the same tick, 1200 ticks after the shot begins.
    flown_by_plan, flown_live = (rows[-1250:] for rows in aims)
    assert np.array_equal(flown_by_plan[:49], flown_live[:49])
    assert np.abs(flown_by_plan - flown_live).max() > 0.1


@pytest.mark.slow
def test_a_feed_that_ends_is_told_and_the_camera_comes_back():
    plan = hop_plan(pans=True)
    with World(plan, targets=["tower"]) as world:
        text = '{"x": 15, "y": -8, "z": 20}'
        feeding(world, lambda: send_json(world.targets["tower"], text), world.clock.time + 20.0)
        flown, _ = world.fly()
        aims = np.array(world.autopilots["cam1"].aims)
        begins = world.autopilots["cam1"].setpoints[0][0]
    assert flown.landed
    assert [d.code for d in flown.diagnostics] == ["A026"]
    (track,) = plan.trajectory.drones
    t = aims[:, 0] - begins - PX4.lead
    off = np.abs(aims[:, 1] - track.curve(np.clip(t, 0, track.curve.end))[:, CAM_PITCH])
    assert off[(t > 10.0) & (t < 11.0)].max() > 0.1
    assert off[t > 14.0].max() < 0.01


@pytest.mark.parametrize(
    "text",
    [
        "nonsense",
        "{",
        '{"x": "far", "y": 1}',
        '{"x": NaN, "y": 1}',
        '{"lat": 99, "lon": 8}',
        '{"x": 1e9, "y": 0}',
    ],
)
def test_a_target_that_is_not_heard_keeps_all_on_the_ground(text):
    with World(hop_plan(), targets=["tower"]) as world:
        feeding(world, lambda: send_json(world.targets["tower"], text), world.clock.time + 20.0)
        aboard, found = world.check()
    assert [d.code for d in found] == ["A013"]
    assert len(aboard) == 1
