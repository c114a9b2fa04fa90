"""Curves through waypoints and the pace on them, against closed forms."""

from __future__ import annotations

from math import pi, sqrt

import numpy as np
import pytest

from shotc.emit.waypoints import paths
from shotc.emit.waypoints.models import CURVED, ROUNDED, TURNINGS, AngleRamps, fly, legs_of, times_of
from shotc.emit.waypoints.route import PointAction, Route

CORNER = np.array([[0.0, 0, 10], [10, 0, 10], [10, 10, 10]])
BENT = np.array([[0.0, 0, 5], [8, 1, 6], [10, 9, 9], [25, 12, 7], [26, 13, 7]])


def route(points, *, speed=3.0, stops=(), curve=2.0, actions=None):
    count = len(points)
    stands = np.array([i in (0, count - 1, *stops) for i in range(count)])
    return Route(
        np.asarray(points, dtype=float),
        np.linspace(0.0, 1.0, count),
        np.linspace(0.0, -0.5, count),
        np.broadcast_to(np.asarray(speed, dtype=float), count).copy(),
        stands,
        np.full(count, curve),
        actions or ((),) * count,
    )


@pytest.mark.parametrize("shape", CURVED)
def test_every_curve_goes_through_its_points(shape):
    legs = shape.samples(route(BENT, stops=(2,)), 20)
    assert np.allclose(legs[:, 0], BENT[:-1])
    assert np.allclose(legs[:, -1], BENT[1:])


@pytest.mark.parametrize("alpha", [0.0, 0.5, 1.0])
def test_catmull_rom_is_that_of_barry_and_goldman(alpha):
    """Their pyramid of linear interpolations, which shares nothing with tangents."""
    p = BENT[:4]
    knots = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(p, axis=0), axis=1) ** alpha)])
    t = np.linspace(knots[1], knots[2], 11)[:, None]

    def mix(a, b, i, j):
        return ((knots[j] - t) * a + (t - knots[i]) * b) / (knots[j] - knots[i])

    a = [mix(p[i], p[i + 1], i, i + 1) for i in range(3)]
    b = [mix(a[0], a[1], 0, 2), mix(a[1], a[2], 1, 3)]
    expected = mix(b[0], b[1], 1, 2)
    leg = paths.through(p, np.zeros(4, dtype=bool), paths.catmull_rom(alpha), 10, cut=False)[1]
    assert np.allclose(leg, expected)


def test_the_natural_spline_is_straight_at_its_ends_and_smooth_within():
    legs = paths.through(BENT, np.zeros(5, dtype=bool), paths.natural, 300, cut=False)
    chord = np.linalg.norm(np.diff(BENT, axis=0), axis=1)[:, None]
    bend = np.diff(legs, 2, axis=1) * (300 / chord[:, None]) ** 2
    assert np.allclose(bend[0, 0], 0.0, atol=0.02)
    assert np.allclose(bend[-1, -1], 0.0, atol=0.2)
    assert np.allclose(bend[:-1, -1], bend[1:, 0], atol=0.2)


def test_a_curve_that_begins_anew_at_a_stop_is_that_of_each_run():
    stops = np.array([True, False, True, False, True])
    cut = paths.through(BENT, stops, paths.catmull_rom(0.5), 10, cut=True)
    first = paths.through(BENT[:3], stops[:3], paths.catmull_rom(0.5), 10, cut=True)
    assert np.allclose(cut[:2], first)
    assert not np.allclose(cut, paths.through(BENT, stops, paths.catmull_rom(0.5), 10, cut=False))


def test_a_rounded_corner_misses_its_point_by_a_quarter_of_the_way_between_its_ends():
    legs = paths.rounded(CORNER, np.full(3, 4.0), 33)
    middle = (np.array([6.0, 0, 10]) + 2 * CORNER[1] + np.array([10.0, 4, 10])) / 4
    assert np.allclose(legs[0, -1], middle)
    assert np.allclose(legs[1, 0], middle)
    assert np.allclose(legs[0, 0], CORNER[0])
    assert (legs[..., 1] <= legs[..., 0]).all()  # inside of the corner
    straight = ROUNDED[1].samples(route(CORNER), 30)
    assert np.allclose(straight[0, :, 1], 0.0)


def test_ramps_take_what_constant_acceleration_takes():
    there = route([[0.0, 0, 0], [40, 0, 0]], speed=4.0)
    times = times_of(there, legs_of(there, ROUNDED[1], 400), 2.0)
    assert times[0, -1] == pytest.approx(40 / 4 + 4 / 2, rel=1e-3)
    short = route([[0.0, 0, 0], [2, 0, 0]], speed=9.0)  # never as fast as that
    assert times_of(short, legs_of(short, ROUNDED[1], 400), 2.0)[0, -1] == pytest.approx(
        2 * sqrt(2 * 1 / 2), rel=1e-2
    )


def test_a_change_of_speed_comes_behind_its_point():
    line = route([[0.0, 0, 0], [30, 0, 0], [60, 0, 0]], speed=[3.0, 6.0, 1.0])
    times = times_of(line, legs_of(line, ROUNDED[1], 400), 1.5)
    assert times[0, -1] == pytest.approx(30 / 3 + 3 / (2 * 1.5), rel=1e-3)
    speeding, braking = (36 - 9) / 3, 36 / 3
    assert times[1, -1] == pytest.approx(2 + (30 - speeding - braking) / 6 + 4, rel=1e-3)


def test_angles_go_with_the_way_or_with_time():
    there = route([[0.0, 0, 0], [12, 0, 0]], speed=3.0)
    legs = legs_of(there, ROUNDED[1])
    by_way = fly(there, legs, AngleRamps(3.0, by_time=False))
    assert np.allclose(by_way.cam_yaw, by_way.position[:, 0] / 12)
    by_time = fly(there, legs, AngleRamps(1.5, by_time=True))
    assert np.allclose(by_time.cam_yaw, by_time.elapsed / by_time.elapsed[-1])
    assert by_time.cam_yaw[5] > by_way.cam_yaw[5]  # slow at first: the turn is ahead of the way


def test_recordings_and_stays_are_flown_in_their_order():
    actions = ((PointAction("start"),), (PointAction("stay", 2.0), PointAction("stop")), ())
    flown = fly(
        line := route([[0.0, 0, 5], [10, 0, 5], [20, 0, 5]], stops=(1,), actions=actions),
        legs_of(line, ROUNDED[1]),
        TURNINGS[0],
    )
    film = flown.part == 1
    assert set(flown.part) == {1, 2}
    assert flown.position[film][-1] == pytest.approx([10, 0, 5])
    moving = 10 / 3 + 3 / 3
    assert np.ptp(flown.elapsed[film]) == pytest.approx(moving + 2.0, rel=1e-2)
    assert (np.diff(flown.progress) >= 0).all()
    assert flown.cam_yaw[-1] - flown.cam_yaw[0] == pytest.approx(1.0)
    assert pi > abs(flown.cam_pitch).max()
