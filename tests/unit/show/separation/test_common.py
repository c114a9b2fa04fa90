"""Moves that all drones make alike, proved in closed form: never more than the search of all pairs finds."""

from __future__ import annotations

import numpy as np
import pytest

from shotc.geom.separation import closest
from shotc.ir.limits import Limits
from shotc.show.geom.arcs import Gaps
from shotc.show.separation.common import common
from shotc.show.solvers.arc_move import fastest_arc
from shotc.show.solvers.match import matched
from tests.experiments.dense import APARTS, full

LIMITS = Limits(5.0, 2.5, 2.0, 2.5, 8.0, 1.0, 1.0)
APART = APARTS["ellipsoid"]
SCALE = np.array([1.0, 1.0, 0.6])


def arc(seed: int) -> np.ndarray:
    rng = np.random.default_rng(seed)
    starts, goals = (full(shape, APART, 80, rng) for shape in ("ball", "cube"))
    goals = goals[matched(starts * SCALE, goals * SCALE)] + [30.0, 5.0, 8.0]
    move = fastest_arc((starts, goals), np.array([9.0, 0.0, -4.0]), Gaps(1.0005, 1.0005), LIMITS, 1.0)
    between = [np.round(points, 6) for points in move.between(starts, goals)]
    return np.stack([*[starts] * 3, *between, *[goals] * 3], axis=1)


@pytest.mark.parametrize("seed", range(4))
def test_a_move_on_arcs_is_proved_and_no_more_than_is_true(seed: int) -> None:
    coef = arc(seed)
    proved = common(coef, APART)
    assert APART.across <= proved <= closest(np.arange(coef.shape[1] - 2.0), coef, APART).attained + 1e-9


def test_a_way_straight_up_is_as_near_as_the_pads() -> None:
    pads = np.array([[1.6 * (k % 5), 1.6 * (k // 5), 0.0] for k in range(20)])
    up = np.array([0.0, 0.0, 1.0])
    coef = np.stack([pads + z * up for z in (0, 0, 0, 1, 4, 7, 8, 8, 8)], axis=1)
    assert common(coef, APART) == pytest.approx(1.6)


def test_what_is_not_common_or_not_matched_is_not_proved() -> None:
    coef = arc(0)
    astray = coef.copy()
    astray[7, 9] += [1.0, 0.0, 0.0]
    assert common(astray, APART) < APART.across
    crossed = coef.copy()
    first, last = crossed[:, :1], crossed[:, -1:]
    share = np.linspace(0.0, 1.0, 12)[None, :, None]
    back = last[::-1]
    straight = np.concatenate([first, first, first + share * (back - first), back, back], axis=1)
    assert common(straight, APART) < 0.5 * APART.across
    assert common(coef, APARTS["cylinder"]) == 0.0
