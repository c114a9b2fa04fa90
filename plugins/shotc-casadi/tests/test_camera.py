"""The spline through the nodes: smooth, and exact where it has to be."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest
from shotc_casadi.camera import Given, NoFit, camera
from shotc_casadi.symbols import PITCH, YAW

from shotc.ir.path import CAM_PITCH, CAM_YAW
from tests.support.records import replace as changed
from tests.support.refiner_scenes import arc, nodes_of, walled


def moved(of, nodes, *, by=0.3, pitch=0.0):
    """The convex path, lifted between its ends and with another pitch."""
    x = (nodes.s - nodes.s[0]) / (nodes.s[-1] - nodes.s[0])
    q = of.leg.curve(nodes.s)
    states = np.zeros((len(nodes.s), 16))
    states[:, :3], states[:, YAW], states[:, PITCH] = q[:, :3], q[:, CAM_YAW], q[:, CAM_PITCH]
    bump = np.sin(pi * x) ** 2
    states[:, 2] += by * bump
    states[:, PITCH] += pitch * bump
    states[:, YAW] += 0.05 * bump
    return states


def at_ends(nodes, states):
    return Given(nodes.s[[0, -1]], states[[0, -1]][:, [YAW, PITCH]])


@pytest.mark.parametrize("make", [arc, walled])
def test_the_camera_is_smooth_and_exact_where_it_binds(make):
    of, nodes = make(), nodes_of(make(), 100)
    states = moved(of, nodes)
    ends = states[[0, -1]][:, [YAW, PITCH]]
    found = camera(of.drone, of.leg, nodes, states, at_ends(nodes, states))
    bound = nodes.s[nodes.pins]
    assert found(bound)[:, :3] == pytest.approx(of.leg.curve(bound)[:, :3], abs=1e-9)
    assert found(np.array([found.start, found.end]))[:, 3:] == pytest.approx(ends, abs=1e-9)
    free_nodes = np.setdiff1d(np.arange(101), nodes.pins)
    off = found(nodes.s)[free_nodes] - states[free_nodes][:, [0, 1, 2, YAW, PITCH]]
    inner = np.abs(nodes.s[free_nodes][:, None] - bound).min(axis=1) > 4.0
    assert np.abs(off[inner, 3:]).max() < 1e-4
    assert np.abs(off[inner, :2]).max() < 1e-3
    for order in (0, 1, 2):
        d = found.derivative(order) if order else found
        jump = np.abs(d.ctrl[1:, 0] - d.ctrl[:-1, -1]).max()
        assert jump <= 1e-7 * (1 + np.abs(d.ctrl).max())
    assert set(of.leg.curve.breaks) <= set(found.breaks)


def test_the_camera_keeps_the_gimbals_pitch():
    of, nodes = arc(), nodes_of(arc(), 100)
    states = moved(of, nodes, pitch=0.4)
    low = float(of.leg.curve.ctrl[:, :, CAM_PITCH].min())
    top = float(of.leg.curve.ctrl[:, :, CAM_PITCH].max()) + 0.1
    drone = changed(of.drone, gimbal=changed(of.drone.gimbal, pitch=(low, top)))
    found = camera(drone, of.leg, nodes, states, at_ends(nodes, states))
    assert found.ctrl[:, :, 4].max() <= top + 1e-6
    assert found.ctrl[:, :, 4].min() >= low - 1e-6
    assert found.ctrl[:, :, 4].max() == pytest.approx(top, abs=1e-3)


def test_ends_that_the_gimbal_does_not_reach_are_no_camera():
    of, nodes = arc(), nodes_of(arc(), 100)
    states = moved(of, nodes)
    drone = changed(of.drone, gimbal=changed(of.drone.gimbal, pitch=(-0.05, 0.0)))
    with pytest.raises(NoFit):
        camera(drone, of.leg, nodes, states, at_ends(nodes, states))
