"""What a plan keeps, as rows: their values by plain geometry, their slopes by differences."""

from __future__ import annotations

from math import acos, asin, atan2, hypot, pi
from typing import NamedTuple

import casadi as ca
import numpy as np
import pytest
from shotc_casadi.replan.keeping import StaticObstacles, common, each, ends, pitched, row_counts, rows

from shotc.geom.solids import Cylinder, box
from shotc.plugin_api.replanner import NO_TRAFFIC, NO_WALLS, Cone, Keeping, Traffic, Walls
from tests.support.replans import DT, LIMITS, TREE, zone

N = 6
RNG = np.random.default_rng(11)
STATES = np.hstack([RNG.uniform([5.0, -12.0, 2.0], [12.0, -4.0, 9.0], (N, 3)), RNG.normal(0.0, 3.0, (N, 3))])
TARGET = RNG.uniform([0.0, 0.0, 0.0], [2.0, 2.0, 2.0], (N, 3))
OTHER = RNG.uniform([3.0, -6.0, 3.0], [6.0, -2.0, 5.0], (N + 1, 3))
AXIS = np.array([0.6, -0.8, 0.0])
CONE = Cone(np.tile([0.0, 0.0, 4.0], (N + 1, 1)), np.tile(AXIS, (N + 1, 1)), 0.4)
BESIDE_ONE = Traffic(OTHER[None])


class Found(NamedTuple):
    """Rows (N, R) of all stages and their slopes (N, R, 6); those of the end of each (N, E), (N, E, 6)."""

    value: np.ndarray
    slope: np.ndarray
    ends: np.ndarray
    end_slope: np.ndarray


def found(
    keeping: Keeping,
    traffic: Traffic = NO_TRAFFIC,
    states: np.ndarray = STATES,
    step: float = DT,
    walls: Walls = NO_WALLS,
) -> Found:
    near = StaticObstacles(keeping).near(np.zeros(3), 1e3)
    of = row_counts(keeping, near, traffic, walls)
    shared = common(keeping, near, step, traffic, walls)
    own = each(traffic, walls, keeping.margin) if of.each else np.zeros((len(states), 0))
    x, t, p, g = ca.SX.sym("x", 6), ca.SX.sym("t", 3), ca.SX.sym("p", of.each), ca.SX.sym("g", len(shared))
    q = x[:3] - t
    a = ca.vertcat(pitched(of, q, g), rows(of, (x[:3], x[3:], q / ca.norm_2(q)), p, g))
    b = ends(of, x[:3], x[3:], g)
    dense = [ca.densify(m) for m in (a, ca.jacobian(a, x), b, ca.jacobian(b, x))]
    function = ca.Function("all", [x, t, p, g], dense)
    parts = [[np.array(out) for out in function(s, TARGET[k], own[k], shared)] for k, s in enumerate(states)]
    value, slope, end, end_slope = (np.array([part[i] for part in parts]) for i in range(4))
    return Found(value[..., 0], slope, end[..., 0], end_slope)


CASES = {
    "speed alone": (Keeping(LIMITS), NO_TRAFFIC),
    "a tree": (Keeping(LIMITS, zones=(zone(TREE, 0.4),)), NO_TRAFFIC),
    "a house in a room": (
        Keeping(
            LIMITS,
            zones=(
                zone(box((15.0, -8.0, 1.0), (4.0, 3.0, 5.0), 0.3)),
                zone(Cylinder((5.0, -5.0), 30.0, 0.0, 20.0), 0.3, True),
            ),
        ),
        NO_TRAFFIC,
    ),
    "a floor": (Keeping(LIMITS, floor=3.0), NO_TRAFFIC),
    "a ceiling": (Keeping(LIMITS, ceiling=9.0), NO_TRAFFIC),
    "pitch": (Keeping(LIMITS, pitch=(-1.2, -0.2)), NO_TRAFFIC),
    "another drone": (Keeping(LIMITS, separation=3.0), BESIDE_ONE),
    "another drone in the frame": (Keeping(LIMITS, half_angle=pi / 6), BESIDE_ONE),
    "the picture of another drone": (Keeping(LIMITS), Traffic(OTHER[None][:0], (CONE,))),
}


WALLS = Walls(RNG.normal(size=(N + 1, 3, 3)), RNG.normal(size=(N + 1, 3)))


def test_a_place_keeps_the_half_spaces_of_its_stage_and_stops_before_those_of_the_end():
    """Beside the parameters of traffic and of a camera: each finds its own."""
    traffic = Traffic(OTHER[None], (CONE,))
    keeping = Keeping(LIMITS, margin=0.2, reaction=0.3, separation=3.0)
    here, without = found(keeping, traffic, walls=WALLS), found(keeping, traffic)
    asked = np.einsum("kmd,kd->km", WALLS.normals[:-1], STATES[:, :3]) - WALLS.offsets[:-1] - 0.2
    assert here.value[:, -4:-1] == pytest.approx(asked, abs=1e-9)
    assert np.delete(here.value, [-4, -3, -2], axis=1) == pytest.approx(without.value, abs=1e-9)
    speed = np.sqrt((STATES[:, 3:] ** 2).sum(axis=1) + 1e-6)
    seconds = 0.3 + speed / (2 * LIMITS.usable_acceleration)
    stands = STATES[:, :3] + seconds[:, None] * STATES[:, 3:]
    assert here.ends == pytest.approx(stands @ WALLS.normals[-1].T - WALLS.offsets[-1] - 0.2, abs=1e-9)


@pytest.mark.slow
@pytest.mark.parametrize("name", CASES)
def test_slopes_are_those_of_the_values(name):
    here = found(*CASES[name])
    for j in range(6):
        d = np.zeros(6)
        d[j] = 1e-6
        after, before = found(*CASES[name], STATES + d), found(*CASES[name], STATES - d)
        assert here.slope[:, :, j] == pytest.approx((after.value - before.value) / 2e-6, abs=1e-5)
        assert here.end_slope[:, :, j] == pytest.approx((after.ends - before.ends) / 2e-6, abs=1e-5)


def test_a_ceiling_is_kept():
    here = found(Keeping(LIMITS, ceiling=9.0)).value[:, 0]
    assert here == pytest.approx(9.0 - STATES[:, 2], abs=1e-9)


def test_another_drone_is_out_of_the_cone_about_the_line_of_sight():
    (here,) = (found(*CASES["another drone in the frame"]).value[:, 1],)
    q, d = STATES[:, :3] - TARGET, STATES[:, :3] - OTHER[1:]
    beta = np.array([acos(a @ b / np.linalg.norm(a) / np.linalg.norm(b)) for a, b in zip(q, d, strict=True)])
    assert ((here >= 0) == (beta >= pi / 6)).all()
    assert here == pytest.approx(
        np.linalg.norm(d, axis=1) * np.sin(np.minimum(beta - pi / 6, pi / 2)), abs=1e-6
    )


def test_it_is_out_of_the_picture_of_another_drone():
    here = found(*CASES["the picture of another drone"]).value[:, 0]
    d = STATES[:, :3] - CONE.apex[1:]
    angle = np.arccos(d @ AXIS / np.linalg.norm(d, axis=1))
    beside = np.linalg.norm(d, axis=1) * np.sin(np.minimum(angle - 0.4, pi / 2))
    assert here == pytest.approx(beside, abs=1e-6)


def test_pitch_is_the_angle_of_the_line_of_sight():
    here = found(*CASES["pitch"]).value
    for k, (p, target) in enumerate(zip(STATES[:, :3], TARGET, strict=True)):
        angle = atan2(target[2] - p[2], hypot(*(target - p)[:2]))
        length = float(np.linalg.norm(target - p))
        assert asin(here[k, 0] / length) == pytest.approx(angle + 1.2, abs=1e-6)
        assert asin(here[k, 1] / length) == pytest.approx(-0.2 - angle, abs=1e-6)


def test_the_separation_counts_the_way_between_stages():
    still = Traffic(np.repeat(OTHER[None, :1], N + 1, axis=1))
    keeping = Keeping(LIMITS, separation=3.0, margin=0.1)
    here = found(keeping, still, step=0.0).value[:, 0]
    assert here == pytest.approx(np.linalg.norm(STATES[:, :3] - OTHER[0], axis=1) - 3.1, abs=1e-6)
    assert (found(keeping, still).value[:, 0] < here).all()


def test_a_stop_ends_where_the_room_that_is_left_says():
    keeping = Keeping(LIMITS, zones=(zone(TREE),), margin=0.0, reaction=0.2)
    here = found(keeping, states=np.array([[10.0, -7.5, 3.0, 4.0, 0.0, 0.0]]), step=0.0)
    way = 0.2 * 4.0 + 4.0**2 / (2 * LIMITS.acceleration)
    assert here.ends[0, 0] == pytest.approx(3.0 - way, abs=1e-5)
    assert here.value[0, 0] == pytest.approx(3.0, abs=1e-6)


def test_a_straight_step_cuts_off_what_is_added():
    keeping = Keeping(LIMITS, zones=(zone(TREE),), margin=0.0)
    here = found(keeping, states=np.array([[15.0, -4.0, 3.0, 9.0, 0.0, 0.0]])).value[0, 0]
    # The chord between two stages on the circle, a step apart, comes as near to its axis as this.
    nearest = 2.0 - np.sqrt(2.0**2 - (0.5 * DT * 9.0) ** 2)
    assert 1.5 - here == pytest.approx(nearest, rel=0.02)


def test_of_much_that_stands_what_is_out_of_reach_is_left_out():
    trees = tuple(zone(Cylinder((20.0 * k, 0.0), 1.0, 0.0, 5.0)) for k in range(6))
    assert len(StaticObstacles(Keeping(LIMITS, zones=trees)).near(np.zeros(3), 50.0)) == 3
    assert len(StaticObstacles(Keeping(LIMITS, zones=trees, floor=1.0)).near(np.zeros(3), 50.0)) == 4
    assert len(StaticObstacles(Keeping(LIMITS, zones=trees[:3])).near(np.zeros(3), 0.0)) == 3
