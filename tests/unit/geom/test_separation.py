"""How near drones come: by arithmetic where it is known, by dense sampling where it is not."""

from __future__ import annotations

from itertools import pairwise
from math import hypot, sqrt

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from shotc.geom.bernstein import Array
from shotc.geom.fleet_spline import centres, places
from shotc.geom.nearest_pair import GAP_M, joined
from shotc.geom.separation import closest, closest_between, first_nearer
from shotc.ir.show import Apart

BALL = Apart("ellipsoid", 0.9, 1.9, 0.1)
CAN = Apart("cylinder", 0.9, 1.9, 0.1)


def straight(breaks: Array, start: list[float], velocity: list[float]) -> Array:
    """Return the control points of a drone that flies evenly."""
    return np.asarray(np.array(start) + centres(breaks)[:, None] * np.array(velocity))


def dense(breaks: Array, coef: Array, apart: Apart, per_piece: int = 100) -> float:
    times = np.concatenate([np.linspace(a, b, per_piece) for a, b in pairwise(breaks)])
    at = places(breaks, coef, times) * [1.0, 1.0, apart.across / apart.upright]
    least = np.inf
    for i in range(len(at)):
        r = at[i + 1 :] - at[i]
        across, up = np.hypot(r[..., 0], r[..., 1]), abs(r[..., 2])
        sizes = np.hypot(across, up) if apart.shape == "ellipsoid" else np.maximum(across, up)
        least = min(least, float(sizes.min(initial=np.inf)))
    return least


def test_two_that_cross_are_nearest_where_arithmetic_says() -> None:
    breaks = np.array([0.0, 1.0, 2.5, 4.0, 7.0])
    coef = np.stack([straight(breaks, [0, 0, 10], [1, 0, 0]), straight(breaks, [0, -3, 10.8], [0, 1, 0])])
    found = closest(breaks, coef, BALL)
    expected = hypot(1.5 * sqrt(2), 0.8 * 0.5)
    assert found.attained == pytest.approx(expected, abs=1e-6)
    assert expected - 2 * GAP_M * expected < found.proven <= expected
    assert found.time == pytest.approx(1.5, abs=1e-3)
    assert (found.first, found.second) == (0, 1)
    assert found.position == pytest.approx((0.75, -0.75, 10.4), abs=1e-3)


def test_a_cylinder_counts_the_farther_of_the_two_ways() -> None:
    breaks = np.linspace(0.0, 6.0, 7)
    coef = np.stack([straight(breaks, [0, 0, 10], [1, 0, 0]), straight(breaks, [0, -3, 15], [0, 1, 0])])
    found = closest(breaks, coef, CAN)
    assert found.attained == pytest.approx(2.5)
    coef[1, :, 2] = 13.0
    assert closest(breaks, coef, CAN).attained == pytest.approx(1.5 * sqrt(2), abs=1e-6)


def test_a_collision_between_samples_is_found() -> None:
    breaks = np.linspace(0.0, 10.0, 3)
    one = straight(breaks, [0.0, 0.0, 5.0], [4.0, 0.0, 0.0])
    other = straight(breaks, [40.0, 0.0, 5.0], [-4.0, 0.0, 0.0])
    found = closest(breaks, np.stack([one, other]), BALL)
    assert found.attained < 1e-6
    assert found.time == pytest.approx(5.0, abs=1e-5)


@pytest.mark.slow
@settings(max_examples=25, deadline=None)
@given(st.integers(0, 2**31), st.sampled_from([BALL, CAN]), st.integers(2, 25))
def test_the_bound_is_below_every_sample_and_close_to_one(seed: int, apart: Apart, count: int) -> None:
    rng = np.random.default_rng(seed)
    breaks = np.concatenate([[0.0], np.cumsum(rng.uniform(0.2, 2.0, 6))])
    coef = rng.uniform(-6.0, 6.0, (count, 9, 3))
    found = closest(breaks, coef, apart)
    sampled = dense(breaks, coef, apart)
    assert found.proven <= sampled
    assert found.attained <= sampled + 2 * GAP_M * max(1.0, sampled)
    assert found.proven > found.attained - 2 * GAP_M * max(1.0, found.attained)
    pair = places(breaks, coef[[found.first, found.second]], np.array([found.time]))[:, 0]
    r = (pair[0] - pair[1]) * [1.0, 1.0, apart.across / apart.upright]
    size = np.linalg.norm(r) if apart.shape == "ellipsoid" else max(hypot(r[0], r[1]), abs(r[2]))
    assert size == pytest.approx(found.attained, abs=1e-9)
    assert found.position == pytest.approx(pair.mean(axis=0), abs=1e-9)


def test_two_fleets_on_clocks_of_their_own() -> None:
    early = np.array([0.0, 1.0, 2.0])
    late = np.array([0.0, 1.5, 4.0, 6.0])
    # The one comes to rest at the origin by t = 2; the other passes there at t = 5.
    one = np.stack([np.tile([0.0, 0.0, 5.0], (5, 1)), np.tile([0.0, 50.0, 5.0], (5, 1))])
    one[:, :2, 0] += 30.0
    other = straight(late, [-10.0, 2.0, 5.0], [2.0, 0.0, 0.0])[None]
    found = closest_between(early, one, late, other, BALL)
    assert found.attained == pytest.approx(2.0, abs=1e-6)
    assert (found.first, found.second) == (0, 0)
    assert found.time == pytest.approx(5.0, abs=1e-3)
    turned = closest_between(late, other, early, one, BALL)
    assert turned.attained == pytest.approx(2.0, abs=1e-6)


def test_a_fleet_stands_where_the_last_of_its_pieces_ends() -> None:
    early, late = np.array([0.0, 1.0, 2.0, 3.0]), np.array([0.0, 4.0, 9.0])
    one = straight(early, [0.0, 0.0, 5.0], [4.0, 0.0, 0.0])[None]
    other = straight(late, [12.0, 40.0, 5.0], [0.0, -4.0, 0.0])[None]
    found = closest_between(early, one, late, other, BALL)
    assert (found.attained, found.time) == pytest.approx((4.0, 9.0), abs=1e-5)


def test_one_drone_alone_is_near_nobody() -> None:
    breaks = np.array([0.0, 1.0])
    assert closest(breaks, np.zeros((1, 4, 3)), BALL).proven == np.inf


def test_the_fleets_of_a_crowd_are_told_apart() -> None:
    rng = np.random.default_rng(3)
    breaks, others = np.linspace(0.0, 5.0, 6), np.linspace(1.0, 4.0, 4)
    one, other = rng.uniform(-5.0, 5.0, (20, 8, 3)), rng.uniform(-5.0, 5.0, (15, 6, 3))
    found = closest_between(breaks, one, others, other, CAN)
    times = np.linspace(0.0, 5.0, 4001)
    near = places(breaks, one, times)[:, None] - places(others, other, times)[None]
    across, up = np.hypot(near[..., 0], near[..., 1]), abs(near[..., 2]) / 2.0
    sampled = float(np.maximum(across, up).min())
    assert found.proven <= found.attained <= sampled + 1e-9
    assert sampled - found.proven < 1e-2


def test_two_on_the_rim_of_their_cylinder_are_nearer_than_two_abreast() -> None:
    # 1 m apart both ways, which is 1.41 m as the crow flies: farther than the other two, 1.2 m abreast.
    breaks = np.array([0.0, 1.0, 2.0])
    places_ = [(0.0, 0.0, 10.0), (1.2, 0.0, 10.0), (50.0, 0.0, 10.0), (51.0, 0.0, 12.0)]
    coef = np.stack([straight(breaks, list(place), [0.0, 0.0, 0.0]) for place in places_])
    found = closest(breaks, coef, CAN)
    assert found.attained == pytest.approx(1.0)
    assert (found.first, found.second) == (2, 3)
    for a, b in (((0, 1), (2, 3)), ((2, 3), (0, 1)), ((0, 2), (1, 3))):
        both = closest_between(breaks, coef[list(a)], breaks, coef[list(b)], CAN)
        if (a, b) == ((0, 2), (1, 3)):
            assert both.attained == pytest.approx(1.0)
        else:
            assert both.attained > 40.0


@pytest.mark.parametrize("swapped", [False, True])
def test_of_pairs_that_move_the_one_that_comes_nearest_counts(swapped: bool) -> None:
    # At the middle of every slab the first two are the nearer ones; the others rush by between.
    breaks = np.linspace(0.0, 8.0, 3)
    still = [straight(breaks, [0.0, y, 10.0], [0.0, 0.0, 0.0]) for y in (0.0, 2.0)]
    rush = [
        straight(breaks, [40.0 - x, y, 10.0], [v, 0.0, 0.0]) for x, y, v in ((9.0, 0, 6.0), (-9.0, 0.5, -6.0))
    ]
    coef = np.stack([*rush, *still] if swapped else [*still, *rush])
    found = closest(breaks, coef, BALL)
    assert found.attained == pytest.approx(0.5, abs=1e-6)
    assert found.proven == pytest.approx(0.5, abs=1e-5)


def test_two_that_come_together_at_the_end_of_a_slab_are_not_left_out() -> None:
    # In its middle they are 1.78 m apart, and the others, who stand, 1.2 m.
    breaks = np.array([0.0, 1.0])
    stand = [straight(breaks, [50.0, y, 10.0], [0.0, 0.0, 0.0]) for y in (0.0, 1.2)]
    meet = [straight(breaks, [0.0, y, 10.0], [0.0, v, 0.0]) for y, v in ((0.0, 0.78), (2.56, -0.78))]
    found = closest(breaks, np.stack([*stand, *meet]), BALL)
    assert found.attained == pytest.approx(1.0, abs=1e-6)
    assert (found.first, found.second) == (2, 3)


def test_the_first_span_in_which_two_fleets_come_too_near_is_found_not_the_nearest() -> None:
    # One drone passes two that stand: the first at 0.8 m, 4 s later the other at 0.2 m.
    breaks = np.linspace(0.0, 12.0, 13)
    one = straight(breaks, [0, 0, 10], [1, 0, 0])[None]
    other = np.stack([straight(breaks, [4, 0.8, 10], [0, 0, 0]), straight(breaks, [8, 0.2, 10], [0, 0, 0])])
    flown, beside = (breaks, one), (breaks, other)
    whole = closest_between(*flown, *beside, BALL)
    assert (whole.attained, whole.time) == (pytest.approx(0.2), pytest.approx(8.0, abs=1e-3))
    marks = np.array([0.0, 2.0, 6.0, 7.0, 12.0])
    found = first_nearer(flown, beside, BALL, marks, 1.0)
    assert found is not None
    assert (found.attained, found.time, found.second) == (
        pytest.approx(0.8),
        pytest.approx(4.0, abs=1e-3),
        0,
    )
    later = first_nearer(flown, beside, BALL, marks, 0.7)
    assert later is not None
    assert (later.attained, later.second) == (pytest.approx(0.2), 1)
    assert first_nearer(flown, beside, BALL, marks, 0.199) is None
    assert first_nearer(flown, beside, BALL, marks[:3], 0.7) is None


def test_pairs_are_compared_only_on_pieces_on_which_both_count() -> None:
    # The first two are 1 m apart all the while, the third is 3 m from the second; who counts changes.
    breaks = np.array([0.0, 1.0, 2.0, 3.0])
    coef = np.stack([straight(breaks, [x, 0.0, 10.0], [0.0, 0.0, 0.0]) for x in (0.0, 1.0, 4.0)])
    nobody, pair, others = [False] * 3, [True, True, False], [False, True, True]

    def found(*pieces: list[bool]) -> tuple[float, tuple[int, int]]:
        nearest = closest(breaks, coef, BALL, np.array(pieces).T)
        return nearest.attained, (nearest.first, nearest.second)

    assert found(nobody, others, nobody) == (pytest.approx(3.0), (1, 2))
    assert found(others, pair, nobody) == (pytest.approx(1.0), (0, 1))
    assert found([True, False, True], others, others) == (pytest.approx(3.0), (1, 2))
    assert found([True, False, False], nobody, [False, False, True])[0] == np.inf
    timed = closest(breaks, coef, BALL, np.array([nobody, nobody, pair]).T)
    assert 2.0 <= timed.time <= 3.0


def test_the_union_of_no_bags_has_no_pair() -> None:
    none = joined([])
    assert [array.shape for array in (none.pairs, none.ends, none.ctrl)] == [(0, 2), (0, 2), (0, 4, 3)]
