"""Refined cameras put back into a path: bodies follow, unfilmed legs lead to the new ends."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest

from shotc.geom.bernstein import Piecewise, bernstein_basis
from shotc.geom.bspline import restrict, subdivide
from shotc.ir.path import BODY_YAW, CAM_YAW, HFOV, HoldLeg, MovingLeg
from shotc.planning.path.rejoin import rejoined
from shotc.planning.path.with_camera import NoTransit, with_camera
from tests.support.bad_refiners import PASS, ROUND, leg, path
from tests.support.path_scenes import assert_continuous, assert_sound

CAMERA = (0, 1, 2, 3, 4)


def camera_of(shot, ir=None):
    return leg(ir or path(), shot).curve.channels(*CAMERA)


def added(curve, channel, change):
    """The curve plus a polynomial of degree five at most, of its progress from 0 to 1, in one channel."""
    fine = restrict(curve, subdivide(curve.breaks, 3))
    x = ((fine.breaks - fine.start) / (fine.end - fine.start))[:, None]
    value = change(x[:-1] + (x[1:] - x[:-1]) * np.arange(6) / 5)
    basis = bernstein_basis(5, np.arange(6) / 5)
    ctrl = fine.ctrl.copy()
    ctrl[:, :, channel] += np.linalg.solve(basis, value.T).T
    return Piecewise(fine.breaks, ctrl)


def bumped(curve, channel, by):
    """The curve with a bump in one channel that leaves both ends as they are."""
    return added(curve, channel, lambda x: by * 16 * x**2 * (1 - x) ** 2)


def turned(curve, start=0.0, end=0.0):
    """The curve with other yaws at its ends."""
    return added(curve, 3, lambda x: start + (end - start) * x**3 * (10 - 15 * x + 6 * x**2))


def sound(ir):
    ir.check()
    made = ir.keyframes.mission
    for drone in ir.drones:
        for one in drone.legs:
            if isinstance(one, MovingLeg):
                assert_sound(made, made.drone(drone.drone), one)


def test_without_cameras_the_path_stays_as_it_is():
    assert rejoined(path(), {}).drones == path().drones


def test_a_camera_with_the_same_ends_leaves_the_other_legs_alone():
    ours = bumped(camera_of(ROUND), 2, 1.0)
    again = rejoined(path(), {ROUND: ours})
    for old, new in zip(path().drones[0].legs, again.drones[0].legs, strict=True):
        assert (new is old) == (old.shot != ROUND)
    old, new = leg(path(), ROUND), leg(again, ROUND)
    s = np.linspace(new.curve.start, new.curve.end, 200)
    assert new.curve(s)[:, :5] == pytest.approx(ours(s), abs=1e-12)
    assert new.curve(s)[:, HFOV] == pytest.approx(old.curve(s)[:, HFOV])
    # Joints are equal to the last bit.
    assert (new.curve.ctrl[0, 0] == old.curve.ctrl[0, 0]).all()
    assert (new.curve.ctrl[-1, -1] == old.curve.ctrl[-1, -1]).all()
    assert (new.marks, new.stops, new.framing) == (old.marks, old.stops, old.framing)
    assert (new.pace, new.duration, new.start, new.path) == (old.pace, old.duration, old.start, old.path)
    sound(again)


def test_the_body_turns_with_the_new_camera():
    wide = bumped(camera_of(PASS), 3, 0.8)
    again = rejoined(path(), {PASS: wide})
    sound(again)
    made = again.keyframes.mission
    drone = made.drones[0]
    new = leg(again, PASS)
    relative = new.curve.ctrl[:, :, CAM_YAW] - new.curve.ctrl[:, :, BODY_YAW]
    assert relative.min() >= drone.gimbal.yaw[0] - 1e-6
    assert relative.max() <= drone.gimbal.yaw[1] + 1e-6


@pytest.mark.parametrize("which", [{"start": 0.4}, {"end": -0.5}, {"start": 0.3, "end": 0.3}])
def test_other_ends_are_led_to(which):
    ours = turned(camera_of(PASS), **which)
    again = rejoined(path(), {PASS: ours})
    sound(again)
    new = leg(again, PASS)
    shift = new.curve(new.curve.start)[CAM_YAW] - ours(ours.start)[3]
    assert shift == pytest.approx(2 * pi * round(shift / (2 * pi)), abs=1e-9)
    assert new.curve(new.curve.end)[CAM_YAW] - shift == pytest.approx(ours(ours.end)[3])
    assert new.pose == pytest.approx(tuple(new.curve(new.curve.start)))
    phases = [one.phase for one in again.drones[0].legs]
    assert phases == [one.phase for one in path().drones[0].legs]
    assert again.drones[0].legs[0].pose[:3] == path().drones[0].legs[0].pose[:3]
    assert leg(again, ROUND).curve(leg(again, ROUND).curve.end)[:3] == pytest.approx(
        leg(path(), ROUND).curve(leg(path(), ROUND).curve.end)[:3]
    )


def test_what_a_refined_leg_keeps_when_all_is_led_anew():
    again = rejoined(path(), {PASS: turned(camera_of(PASS), end=0.3)})
    for shot in (PASS, ROUND):
        old, new = leg(path(), shot), leg(again, shot)
        assert (new.marks, new.stops, new.framing) == (old.marks, old.stops, old.framing)
        assert (new.pace, new.duration, new.start, new.path) == (old.pace, old.duration, old.start, old.path)


def test_an_end_inside_a_zone_cannot_be_led_to():
    curve = camera_of(ROUND)
    ctrl = curve.ctrl.copy()
    ctrl[:, :, :2] += np.array([-20.0, -38.0]) - ctrl[0, 0, :2]  # into the tree
    with pytest.raises(NoTransit, match=ROUND):
        rejoined(path(), {ROUND: Piecewise(curve.breaks, ctrl)})


@pytest.mark.parametrize("part", [(0.0, 0.5), (0.5, 1.0)])
def test_a_camera_has_to_cover_its_leg(part):
    curve = camera_of(PASS)
    n = len(curve.ctrl)
    low, high = int(part[0] * n), int(part[1] * n)
    short = Piecewise(curve.breaks[low : high + 1], curve.ctrl[low:high])
    with pytest.raises(ValueError, match=PASS):
        rejoined(path(), {PASS: short})


def test_a_hold_has_no_camera_to_replace():
    made = path().keyframes.mission
    up = path().drones[0].legs[0]
    still = HoldLeg("still", up.pose, 0.0, (), (), None, None, up.path)
    with pytest.raises(ValueError, match="still"):
        with_camera(made.drones[0], still, camera_of(PASS))


@pytest.mark.parametrize("shot", [PASS, ROUND])
def test_a_rejoined_leg_is_smooth(shot):
    again = rejoined(path(), {shot: bumped(camera_of(shot), 4, -0.05)})
    assert_continuous(leg(again, shot))
