"""The numbers of a shot's problem."""

from __future__ import annotations

from math import atan2, sin

import numpy as np
import pytest
from shotc_casadi.conditions import LOOK_AT
from shotc_casadi.margins import Margins
from shotc_casadi.references import references_at
from shotc_casadi.symbols import FIELDS, PITCH, TIME, YAW

from tests.support.path_scenes import TOWER, circle, mission, shot
from tests.support.refiner_scenes import arc, nodes_of, subject, task, walled


def test_the_first_guess_is_at_rest_at_its_ends_and_on_the_path():
    made = task(arc())
    assert np.abs(made.states[[0, -1]][:, 3:9]).max() < 1e-9
    nodes = nodes_of(arc())
    assert made.states[:, :3] == pytest.approx(arc().leg.curve(nodes.s)[:, :3])
    assert made.states[:, TIME] == pytest.approx(nodes.t)
    assert np.isfinite(made.parameters).all()


def test_margins_narrow_the_limits_and_the_room():
    plain, tight = task(walled()), task(walled(), margins=Margins(clearance=0.2, limits=0.8, hold=5.0))
    assert tight.held[1][:2] == pytest.approx(plain.held[1][:2] * 0.8**2)
    assert tight.driven[1] == pytest.approx(plain.driven[1] * 0.8**2)
    assert tight.state_bounds[1][:, 5] == pytest.approx(plain.state_bounds[1][:, 5] * 0.8)
    assert (tight.state_bounds[1][:, PITCH] == plain.state_bounds[1][:, PITCH]).all()
    first = sum(FIELDS.values())
    moved_by = tight.parameters[:, first:].reshape(25, -1, 4) - plain.parameters[:, first:].reshape(25, -1, 4)
    real = np.linalg.norm(plain.parameters[:, first:].reshape(25, -1, 4)[:, :, :3], axis=2) > 0
    assert moved_by[real][:, 3] == pytest.approx(0.2)
    assert (moved_by[~real] == 0).all()


def test_a_camera_fixed_to_the_body_turns_no_faster_than_the_body():
    fixed, loose = (
        subject(mission(targets=(TOWER,), body=body), shot(circle(TOWER, 4, 45.0, 20.0, sweep=1.5)))
        for body in ("follow-camera", "free")
    )
    limits, gimbal = fixed.drone.limits, fixed.drone.gimbal
    assert task(fixed).state_bounds[1][0, YAW + 1] == pytest.approx(fixed.leg.pace * limits.yaw_rate)
    assert task(loose).state_bounds[1][0, YAW + 1] == pytest.approx(
        loose.leg.pace * (limits.yaw_rate + gimbal.rate)
    )


def test_the_aim_of_look_at_points_from_the_path_to_what_is_looked_at():
    s = nodes_of(arc()).s
    references = references_at(arc(), LOOK_AT, s)
    d = references.centre - arc().leg.curve(s)[:, :3]
    for k in range(len(s)):
        assert sin(references.aim[k, 0] - atan2(d[k, 1], d[k, 0])) == pytest.approx(0.0, abs=1e-9)
