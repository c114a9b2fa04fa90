"""How near flights of one clock come, each with breaks of its own, against dense sampling."""

from __future__ import annotations

from itertools import combinations
from math import hypot

import numpy as np
import pytest

from shotc.geom.bernstein import Array, Piecewise
from shotc.geom.meetings import closest_of
from shotc.ir.show import Apart

BALL = Apart("ellipsoid", 0.9, 1.9, 0.1)
CAN = Apart("cylinder", 0.9, 1.9, 0.1)
TIMES = np.linspace(0.0, 8.0, 4001)


def drawn(seed: int, count: int, *, common: bool) -> list[Piecewise]:
    """Return flights that begin and end at times of their own, or all have the same breaks."""
    random = np.random.default_rng(seed)
    found = []
    breaks = np.linspace(0.0, 8.0, 5)
    for _ in range(count):
        if not common:
            breaks = np.sort(random.uniform(0.0, 8.0, 4))
        ctrl = random.uniform(-4.0, 4.0, (len(breaks) - 1, 4, 3))
        ctrl[1:, 0] = ctrl[:-1, -1]
        found.append(Piecewise(breaks, ctrl))
    return found


def sampled(flights: list[Piecewise], apart: Apart, pairs, spans: Array | None = None) -> float:
    """Return the nearest at samples of the pairs while both count."""
    at = [flight(TIMES) * [1.0, 1.0, apart.across / apart.upright] for flight in flights]
    least = np.inf
    for i, j in pairs:
        r = (at[i] - at[j])[counting(spans, i) & counting(spans, j)]
        across, up = np.hypot(r[:, 0], r[:, 1]), np.abs(r[:, 2])
        sizes = np.hypot(across, up) if apart.shape == "ellipsoid" else np.maximum(across, up)
        least = min(least, float(sizes.min(initial=np.inf)))
    return least


def counting(spans: Array | None, i: int) -> Array:
    return np.ones(len(TIMES), bool) if spans is None else (spans[i, 0] <= TIMES) & (spans[i, 1] >= TIMES)


def holds(found, flights: list[Piecewise], apart: Apart, expected: float) -> None:
    """Hold what is found against samples, and against the two flights at the time that it tells."""
    assert found.proven <= expected + 1e-9
    assert found.attained <= expected + 1e-6
    assert found.attained - found.proven < 1e-5
    assert expected - found.attained < 0.02
    one, other = (flights[k](found.time) for k in (found.first, found.second))
    r = (one - other) * [1.0, 1.0, apart.across / apart.upright]
    size = np.linalg.norm(r) if apart.shape == "ellipsoid" else max(hypot(r[0], r[1]), abs(r[2]))
    assert found.attained == pytest.approx(size, abs=1e-6)
    assert found.position == pytest.approx(0.5 * (one + other), abs=1e-6)


@pytest.mark.parametrize("apart", [BALL, CAN])
@pytest.mark.parametrize("common", [False, True])
@pytest.mark.parametrize("count", [2, 6])
def test_the_nearest_of_all_pairs_is_found(apart: Apart, common: bool, count: int) -> None:
    flights = drawn(3 + count, count, common=common)
    holds(closest_of(flights, apart), flights, apart, sampled(flights, apart, combinations(range(count), 2)))


@pytest.mark.parametrize("first", [1, 2, 4])
def test_of_two_groups_only_pairs_across_count(first: int) -> None:
    flights = drawn(21, 5, common=False)
    pairs = [(i, j) for i in range(first) for j in range(first, 5)]
    found = closest_of(flights, CAN, first)
    holds(found, flights, CAN, sampled(flights, CAN, pairs))
    assert found.first < first <= found.second


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_flights_count_only_within_their_spans(seed: int) -> None:
    flights = drawn(30 + seed, 5, common=False)
    spans = np.array([[f.breaks[1], f.breaks[2]] for f in flights])
    found = closest_of(flights, BALL, spans=spans)
    expected = sampled(flights, BALL, combinations(range(5), 2), spans)
    assert found.proven <= expected + 1e-9
    assert expected - found.proven < 0.02


def test_who_has_landed_stands_there_and_who_has_not_begun_stands_at_its_start() -> None:
    east = np.linspace(0.0, 6.0, 4)
    passing = Piecewise(np.array([0.0, 6.0]), np.stack([east, 0 * east, 0 * east], axis=1)[None])
    landed = Piecewise(np.array([0.0, 1.0]), np.array([[[4.0, 9.0 - 2 * k, 0.0] for k in range(4)]]))
    waits = Piecewise(np.array([5.0, 6.0]), np.array([[[2.0, 2.5 + 2 * k, 0.0] for k in range(4)]]))
    assert closest_of([passing, landed], BALL).attained == pytest.approx(3.0)
    assert closest_of([passing, landed], BALL).time == pytest.approx(4.0, abs=1e-2)
    assert closest_of([passing, waits], BALL).attained == pytest.approx(2.5)
    assert closest_of([passing, waits], BALL).time == pytest.approx(2.0, abs=1e-2)


def test_flights_that_never_count_together_come_near_nowhere() -> None:
    flights = drawn(5, 2, common=True)
    found = closest_of(flights, BALL, spans=np.array([[0.0, 3.0], [5.0, 8.0]]))
    assert (found.proven, found.position) == (np.inf, (0.0, 0.0, 0.0))


def test_a_control_point_that_a_flight_only_turns_to_is_no_place_that_it_comes_to() -> None:
    """It flies towards the other one till the last moment: y = 12 t^2 (1 - t), 16 / 9 m at most."""
    breaks = np.array([0.0, 1.0])
    turning = np.array([[0.0, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 4.0, 0.0], [0.0, 0.0, 0.0]])
    still = np.tile([0.0, 4.0, 0.0], (4, 1))
    found = closest_of([Piecewise(breaks, turning[None]), Piecewise(breaks, still[None])], BALL)
    assert found is not None
    assert found.attained == pytest.approx(4.0 - 16.0 / 9.0, abs=1e-5)


def test_before_a_span_begins_nearness_does_not_count_though_it_is_a_moment_before() -> None:
    """They are nearest at t = 6; the second one counts from t = 7.5 on."""
    breaks = np.linspace(0.0, 8.0, 5)
    still, x = np.zeros((4, 4, 3)), np.abs(breaks - 6.0) + 1.0
    coming = still.copy()
    coming[..., 0] = np.linspace(x[:-1], x[1:], 4, axis=1)
    flights = [Piecewise(breaks, ctrl) for ctrl in (still, coming)]
    found = closest_of(flights, BALL, spans=np.array([[0.0, 8.0], [7.5, 8.0]]))
    assert found is not None
    assert (found.attained, found.time) == pytest.approx((2.5, 7.5), abs=1e-4)
