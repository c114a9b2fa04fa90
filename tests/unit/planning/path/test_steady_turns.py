"""Turns of a camera that follows nothing: C2, through every angle asked for, never beyond its neighbours'."""

from __future__ import annotations

from math import degrees

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from shotc.ir.path import CAM_PITCH, CAM_YAW
from shotc.planning.path.monotone import steady
from tests.support.path_scenes import framed, free, legs, mission, planned, shot


@pytest.mark.slow
@settings(max_examples=80, deadline=None, derandomize=True)
@given(
    steps=st.lists(st.floats(0.01, 50.0), min_size=1, max_size=12),
    values=st.lists(st.sampled_from([-2.0, -1.0, 0.0, 0.3, 3.0]), min_size=13, max_size=13),
)
def test_between_neighbours_the_angle_only_goes_from_one_to_the_other(steps, values):
    at = np.concatenate([[0.0], np.cumsum(steps)])
    value = np.array(values[: len(at)])
    curve = steady(at, value)
    assert curve(at)[:, 0] == pytest.approx(value, abs=1e-12)
    rises = np.diff(curve.ctrl[:, :, 0], axis=1) * np.sign(np.diff(value))[:, None]
    assert rises.min() >= -1e-12
    for order in (1, 2):
        derivative = curve.derivative(order).ctrl[:, :, 0]
        jump = np.abs(derivative[1:, 0] - derivative[:-1, -1]).max(initial=0.0)
        assert jump <= 1e-9 * (1 + np.abs(derivative).max())


def test_an_even_turn_stays_even():
    at = np.array([0.0, 3.0, 4.0, 11.0])
    curve = steady(at, 0.1 * at + 2.0)
    assert curve.derivative(1).ctrl == pytest.approx(0.1)


def test_headings_far_apart_at_places_near_together_are_flown_without_a_swing():
    # A centimetre, forty metres, five centimetres: a spline without more room would swing far over.
    spots = [(0, 0, 10), (0.01, 0, 10), (40, 0, 10), (40, 0.05, 10), (40, 30, 12)]
    yaws = [0.0, 1.0, 1.0, -0.5, -0.5]
    pitches = [0.0, 0.5, -1.5, -1.5, 0.0]
    keyframes = [free(i, (x, y - 50, z), yaw=yaws[i], pitch=pitches[i]) for i, (x, y, z) in enumerate(spots)]
    (leg,) = legs(planned(mission(), shot(keyframes)), "shot")
    q = leg.curve(np.linspace(leg.curve.start, leg.curve.end, 5000))
    for channel, wanted in ((CAM_YAW, yaws), (CAM_PITCH, pitches)):
        swing = np.abs(np.diff(q[:, channel])).sum()
        assert degrees(swing) == pytest.approx(degrees(np.abs(np.diff(wanted)).sum()), abs=0.01)


def test_where_only_some_keyframes_frame_a_target_the_others_do_not_swing():
    made = mission()
    target = made.targets[0]
    keyframes = [
        framed(0, (-40, -20, 12), target),
        framed(1, (-20, -40, 12), target),
        free(2, (20, -50, 12), yaw=1.0, pitch=-0.2),
        free(3, (60, -50, 12), yaw=1.0, pitch=-0.2),
    ]
    (leg,) = legs(planned(made, shot(keyframes)), "shot")
    q = leg.curve(np.linspace(leg.marks[2].s, leg.marks[3].s, 1000))
    assert degrees(np.abs(q[:, CAM_YAW] - q[0, CAM_YAW]).max()) < 1.0
    assert degrees(np.abs(q[:, CAM_PITCH] - q[0, CAM_PITCH]).max()) < 1.0
