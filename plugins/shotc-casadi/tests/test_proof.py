"""What is open between the nodes, and how margins make up for it."""

from __future__ import annotations

from dataclasses import replace
from math import atan, hypot, sin, tan

import numpy as np
import pytest
from shotc_casadi.conditions import OURS, OURS_4PT
from shotc_casadi.margins import FAR_M, Check, Margins, tighter
from shotc_casadi.proof import checked, hopeless

from shotc.geom.bernstein import Piecewise
from shotc.geom.camera import frustum_margins, view
from shotc.ir.path import CAM_PITCH, CAM_YAW
from tests.support.path_scenes import ASPECT, HFOV, TOWER
from tests.support.refiner_scenes import arc, walled

# Angles of the frustum's planes to the view: half a frame is their sine from the plane, a metre away.
HALVES = [atan(tan(HFOV / 2) / by) for by in (1.0, 1.0, ASPECT, ASPECT)]


def convex(of):
    return of.leg.curve.channels(0, 1, 2, CAM_YAW, CAM_PITCH)


def test_the_convex_path_is_clear_and_in_time():
    check = checked(walled(), OURS, convex(walled()))
    assert (check.lack, check.late) == (0.0, 0.0)


def test_a_camera_through_a_wall_lacks_what_it_is_inside():
    of = walled()
    ctrl = convex(of).ctrl.copy()
    ctrl[:, :, :3] = [31.0, -44.0, 20.0]
    check = checked(of, OURS, Piecewise(of.leg.curve.breaks, ctrl))
    # Three metres deep, and the body's radius.
    assert check.lack == pytest.approx(3.0 + of.space.obstacles[0].clearance, abs=1e-6)


def test_a_target_that_sticks_out_between_nodes_is_found():
    of = arc()
    turned = convex(of).ctrl.copy()
    turned[:, :, 3] += 0.55
    found = Piecewise(of.leg.curve.breaks, turned)
    check = checked(of, OURS, found)
    s = np.linspace(found.start, found.end, 3000)
    worst = 0.0
    for x, y, z, yaw, pitch in found(s):
        d = (-x, -y, 12.0 - z)
        inside = frustum_margins(view(yaw, pitch, HFOV, ASPECT), d, TOWER.shape)
        worst = max(worst, *(-m / (sin(a) * hypot(*d)) for m, a in zip(inside, HALVES, strict=True)))
    assert worst > 0.01
    assert check.cropped == pytest.approx(worst, rel=0.02)
    assert checked(of, OURS_4PT, found).cropped == 0.0  # the paper's four points are no promise


@pytest.mark.slow
def test_a_duration_that_the_fastest_flight_misses_is_late():
    of = arc()
    quick = of._replace(leg=replace(of.leg, duration=9.0))
    check = checked(quick, OURS, convex(of))
    ample = of._replace(leg=replace(of.leg, duration=60.0))
    assert check.late > 0.05
    assert checked(ample, OURS, convex(of)).late == 0.0
    needed = 9.0 * (1 + check.late)
    just = of._replace(leg=replace(of.leg, duration=needed * 1.001))
    assert checked(just, OURS, convex(of)).late == 0.0
    assert not hopeless(ample)
    assert hopeless(of._replace(leg=replace(of.leg, duration=0.5)))
    assert not hopeless(of)


def test_margins_make_up_for_what_was_open():
    margins = tighter(Margins(), Check(0.1, 0.05, 0.0, 0.01), hold=True)
    assert margins.clearance > 0.1
    assert margins.limits < 1 / 1.05
    assert margins.hold > 1.0
    # What lacks a metre has met an obstacle that the nodes did not know: it counts before more room is kept.
    unseen = tighter(Margins(), Check(1.0, 0.0, 0.0, 0.0), hold=False)
    assert (unseen.reach, unseen.clearance) == (FAR_M, 0.0)
    assert tighter(unseen, Check(1.0, 0.0, 0.0, 0.0), hold=False).clearance > 1.0
    assert tighter(Margins(), Check(0.0, 0.0, 0.0, 0.0), hold=True) == Margins()
    assert Check(0, 0, 0, 0).holds
    assert not Check(0, 1e-9, 0, 0).holds
    assert Check(0.5, 0, 0, 0).helped(Check(1.0, 0, 0, 0))
    assert not Check(0.95, 0, 0, 0).helped(Check(1.0, 0, 0, 0))
