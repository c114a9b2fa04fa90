"""What a plan keeps, as rows: their values by plain geometry, their slopes by differences."""

from __future__ import annotations

from math import acos, asin, atan2, hypot, pi, tan

import numpy as np
import pytest
from shotc_casadi.replan.rows import Kept, Rows, out_of_frame, rows, standing, within_reach

from shotc.geom.solids import Cylinder
from shotc.plugin_api.replanner import NO_TRAFFIC, Cone, Keeping, Traffic
from tests.support.replans import DT, LIMITS, TREE, zone

N = 6
RNG = np.random.default_rng(11)
STATES = np.hstack([RNG.uniform([5.0, -12.0, 2.0], [12.0, -4.0, 9.0], (N, 3)), RNG.normal(0.0, 3.0, (N, 3))])
TARGET = RNG.uniform([0.0, 0.0, 0.0], [2.0, 2.0, 2.0], (N, 3))
OTHER = RNG.uniform([3.0, -6.0, 3.0], [6.0, -2.0, 5.0], (N + 1, 3))
AXIS = np.array([0.6, -0.8, 0.0])
CONE = Cone(np.tile([0.0, 0.0, 4.0], (N + 1, 1)), np.tile(AXIS, (N + 1, 1)), 0.4)
NONE = Keeping(LIMITS, margin=0.0)


def kept(keeping: Keeping, traffic: Traffic = NO_TRAFFIC) -> Kept:
    return Kept(keeping, DT, standing(keeping), TARGET, traffic)


CASES = {
    "speed alone": kept(NONE),
    "a tree, with a stop at the end": kept(Keeping(LIMITS, zones=(zone(TREE, 0.4),))),
    "a floor": kept(Keeping(LIMITS, floor=3.0)),
    "pitch": kept(Keeping(LIMITS, pitch=(-1.2, -0.2))),
    "another drone": kept(Keeping(LIMITS, separation=3.0), Traffic(OTHER[None])),
    "another drone in the frame": kept(Keeping(LIMITS, half_angle=pi / 6), Traffic(OTHER[None])),
    "the picture of another drone": kept(NONE, Traffic(OTHER[None][:0], (CONE,))),
}


@pytest.mark.parametrize("name", CASES)
def test_slopes_are_those_of_the_values(name):
    given = CASES[name]._replace(step=0.0)  # what a step cuts off is held constant
    found: Rows = rows(given, STATES)
    assert found.slope.shape == (len(found.value), 6)
    assert (found.slope[~found.uses] == 0).all()
    for j in range(6):
        d = np.zeros(6)
        d[j] = 1e-6
        numeric = (rows(given, STATES + d).value - rows(given, STATES - d).value) / 2e-6
        slope = found.slope[:, j].copy()
        if given.near and j < 3:  # the stop turns with the way out of the solid, which is left out
            numeric[-len(given.near) :] = slope[-len(given.near) :]
        assert slope == pytest.approx(numeric, abs=1e-5)


def test_out_of_frame_is_the_distance_from_the_cone_about_the_line_of_sight():
    p = STATES[:, :3]
    value, slope = out_of_frame(p, TARGET, OTHER[1:], pi / 6)
    q, d = p - TARGET, p - OTHER[1:]
    beta = [acos(a @ b / np.linalg.norm(a) / np.linalg.norm(b)) for a, b in zip(q, d, strict=True)]
    assert ((value >= 0) == (np.array(beta) >= pi / 6)).all()
    exact = np.linalg.norm(d, axis=1) * np.sin(np.minimum(np.array(beta) - pi / 6, pi / 2))
    assert value == pytest.approx(exact)
    for j in range(3):
        e = 1e-6 * np.eye(3)[j]
        numeric = out_of_frame(p + e, TARGET, OTHER[1:], pi / 6)[0]
        numeric = (numeric - out_of_frame(p - e, TARGET, OTHER[1:], pi / 6)[0]) / 2e-6
        assert slope[:, j] == pytest.approx(numeric, abs=1e-5)


def test_pitch_is_the_angle_of_the_line_of_sight():
    low, high = -1.2, -0.2
    found = rows(CASES["pitch"], STATES)
    for k, (p, target) in enumerate(zip(STATES[:, :3], TARGET, strict=True)):
        angle = atan2(target[2] - p[2], hypot(*(target - p)[:2]))
        assert (found.value[k] >= 0) == (angle >= low)
        assert (found.value[N + k] >= 0) == (angle <= high)
        length = float(np.linalg.norm(target - p))
        assert asin(found.value[k] / length) == pytest.approx(angle - low)
    assert tan(low) < 0.0


def test_a_stop_ends_where_the_room_that_is_left_says():
    keeping = Keeping(LIMITS, zones=(zone(TREE),), margin=0.0, reaction=0.2)
    towards = np.array([[10.0, -7.5, 3.0, 4.0, 0.0, 0.0]])
    found = rows(Kept(keeping, 0.0, standing(keeping), np.zeros((1, 3)), NO_TRAFFIC), towards)
    way = 0.2 * 4.0 + 4.0**2 / (2 * LIMITS.acceleration)
    assert found.value[-1] == pytest.approx(3.0 - way)
    assert found.value[0] == pytest.approx(3.0)


def test_a_straight_step_cuts_off_what_is_added():
    keeping = Keeping(LIMITS, zones=(zone(TREE),), margin=0.0)
    here = np.array([[15.0, -4.0, 3.0, 9.0, 0.0, 0.0]])
    found = rows(Kept(keeping, DT, standing(keeping), np.zeros((1, 3)), NO_TRAFFIC), here)
    # The chord between two stages on the circle, a step apart, comes as near to its axis as this.
    half = 0.5 * DT * 9.0
    nearest = 2.0 - np.sqrt(2.0**2 - half**2)
    assert 1.5 - found.value[0] == pytest.approx(nearest, rel=0.02)


def test_what_is_out_of_reach_is_left_out():
    far = standing(Keeping(LIMITS, zones=(zone(TREE), zone(Cylinder((100.0, 0.0), 1.0, 0.0, 5.0)))))
    assert len(within_reach(far, np.array([0.0, -8.0, 3.0]), 15.0)) == 1
    assert len(within_reach(far, np.array([0.0, -8.0, 3.0]), 150.0)) == 2


def test_of_the_rows_of_a_stage_the_worst_one_counts():
    found = Rows(
        np.array([0, 1, 0, 1]), np.array([0.5, -0.1, -0.3, -0.2]), np.zeros((4, 6)), np.ones((4, 6), bool)
    )
    assert found.lack(3) == pytest.approx([0.3, 0.2, 0.0])
