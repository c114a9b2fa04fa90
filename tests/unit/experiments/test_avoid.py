"""Avoidance while flying, for drones that take up any velocity at once."""

import numpy as np
import pytest

from shotc.ir.show import Apart
from tests.support.fleet_flights import nearest

pytest.importorskip("rvo23d")
from tests.experiments.papers.avoid import Avoidance


def flown(start, wanted, apart, seconds=10.0):
    avoid, position, period = Avoidance(apart, 3.5, 0.05), np.array(start), 0.05
    velocity, seen = np.array(wanted), [np.array(start)]
    for _ in range(round(seconds / period)):
        velocity = avoid(position, velocity, np.array(wanted))
        position = position + period * velocity
        seen.append(position)
    return period * np.arange(len(seen)), np.stack(seen, axis=1)


def test_two_head_on_keep_their_distance():
    apart = Apart("ellipsoid", 0.7, 2.0, 0.1)
    times, position = flown([[0, 0, 5], [10, 0.01, 5.0]], [[2.0, 0, 0], [-2.0, 0, 0]], apart)
    assert nearest(times, position, apart, 0.8).distance == pytest.approx(0.8, abs=2e-3)
    assert position[0, -1, 0] > 19.0


def test_one_above_the_other_keeps_the_longer_distance():
    apart = Apart("ellipsoid", 0.7, 2.0, 0.1)
    _, position = flown([[0, 0, 5], [0.01, 0, 15.0]], [[0, 0, 1.0], [0, 0, -1.0]], apart)
    away = np.abs(position[0] - position[1])
    over = np.hypot(away[:, 0], away[:, 1]) < 0.3
    assert np.hypot(np.hypot(away[:, 0], away[:, 1]) / 0.8, away[:, 2] / 2.1).min() > 0.99
    assert away[over, 2].min() > 1.9


def test_who_meets_nobody_flies_what_it_prefers():
    apart = Apart("ellipsoid", 0.7, 2.0, 0.1)
    wanted = [[2.0, 0, 0], [2.0, 0, 0]]
    _, position = flown([[0, 0, 5], [0, 3.0, 5]], wanted, apart, 2.0)
    assert position[:, -1] == pytest.approx(np.array([[4.0, 0, 5], [4.0, 3.0, 5]]), abs=1e-3)
