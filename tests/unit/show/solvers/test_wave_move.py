"""Moves whose drones set out one after another: the limits, the rests, and when everybody is where."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from shotc.geom.bernstein import Array
from shotc.geom.fleet_spline import differences, places
from shotc.ir.show import Easing
from shotc.show.solvers.move import LIMIT_SHARE, fastest
from shotc.show.solvers.wave_move import WaveMove, fastest_wave
from tests.support.fleet_scenes import LIMITS

EASINGS: tuple[Easing, ...] = ("ease-in-out", "linear", "ease-in", "ease-out")


def spline(move: WaveMove, starts: Array, goals: Array) -> tuple[Array, Array]:
    points = [starts] * 3 + move.between(starts, goals) + [goals] * 3
    return move.piece * np.arange(move.pieces + 1), np.stack(points, axis=1)


@pytest.mark.slow
@given(
    seed=st.integers(0, 2**31),
    count=st.integers(2, 12),
    size=st.floats(0.01, 150.0),
    wave=st.floats(0.02, 60.0),
    easing=st.sampled_from(EASINGS),
    longer=st.floats(1.0, 4.0),
)
def test_everybody_keeps_every_limit_whenever_it_sets_out(
    seed: int, count: int, size: float, wave: float, easing: Easing, longer: float
) -> None:
    rng = np.random.default_rng(seed)
    starts, goals = rng.normal(scale=size, size=(2, count, 3))
    departs = wave * rng.random(count)
    departs[[0, -1]] = 0.0, wave
    move = fastest_wave(goals - starts, departs, LIMITS, 1.0, easing)
    move = move.lasting(longer * move.duration)
    breaks, coef = spline(move, starts, goals)
    assert coef.shape[1] == len(breaks) + 2
    first, second, third = (np.einsum("kp,npd->nkd", differences(breaks, k), coef) for k in (1, 2, 3))
    assert np.hypot(first[..., 0], first[..., 1]).max() <= LIMITS.speed
    assert first[..., 2].max() <= LIMITS.climb
    assert -first[..., 2].min() <= LIMITS.descent
    assert np.linalg.norm(second, axis=2).max() <= LIMITS.usable_acceleration
    assert np.linalg.norm(third, axis=2).max() <= LIMITS.jerk
    # Before it sets out and after it has arrived nobody moves.
    at = places(breaks, coef, breaks)
    for k, late in enumerate(departs):
        assert np.allclose(at[k, breaks <= late], starts[k], atol=1e-9 * size)
        assert np.allclose(at[k, breaks >= late + move.own + 2.0 * move.piece], goals[k], atol=1e-9 * size)


@pytest.mark.parametrize("easing", EASINGS)
def test_all_fly_the_same_move_one_after_another(easing: Easing) -> None:
    goals = np.tile([30.0, 20.0, 5.0], (9, 1))
    departs = np.linspace(0.0, 6.0, 9) ** 1.5 / 6.0**0.5
    move = fastest_wave(goals, departs, LIMITS, 1.0, easing)
    breaks, coef = spline(move, np.zeros((9, 3)), goals)
    fine = np.linspace(0.0, move.duration, 20_001)
    shares = places(breaks, coef, fine)[..., 0] / 30.0
    for share in (0.1, 0.5, 0.9):
        passed = np.array([np.interp(share, row, fine) for row in shares])
        assert np.allclose(passed - passed[0], departs, atol=0.02)


def test_a_wave_of_no_time_takes_hardly_longer_than_a_move_of_all_at_once() -> None:
    ways = np.array([[40.0, 0.0, 0.0], [0.0, 12.0, 4.0]])
    together, wave = fastest(ways, LIMITS, 0.75), fastest_wave(ways, np.zeros(2), LIMITS, 0.75, "ease-in-out")
    # Two pieces of 24 are rest, and peaks count in full that samples take the top off.
    assert together.duration <= wave.duration <= 1.15 * together.duration
    assert wave.own >= 40.0 / (0.75 * LIMIT_SHARE * LIMITS.speed)


def test_a_wave_of_somebody_who_stays_is_no_fault() -> None:
    here = np.array([[0.0, 0.0, 9.0], [4.0, 0.0, 9.0]])
    move = fastest_wave(here - here, np.array([0.0, 3.0]), LIMITS, 1.0, "ease-in-out")
    _, coef = spline(move, here, here)
    assert (coef == here[:, None]).all()
