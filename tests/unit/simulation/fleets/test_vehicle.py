"""The simulated drone and the wind."""

import numpy as np
import pytest

from shotc.simulation.fleets.vehicle import FleetState, FleetVehicle, Gusts, moved, within


def at_rest(n=1, gust=(0.0, 0.0, 0.0)):
    still = np.zeros((n, 3))
    return FleetState(still, still, still, still + gust)


def test_a_small_command_is_followed_as_two_lags_in_a_row():
    # 0.15 s a' = (c - v) / 0.3 s - a, so v'' + v'/0.15 + v/0.045 = c/0.045: damped, (1/0.15)^2 < 4/0.045.
    vehicle, command, h = FleetVehicle(), np.array([[0.5, 0.0, 0.0]]), 0.01
    state, seen = at_rest(), []
    for _ in range(200):
        state = moved(vehicle, state, command, h)
        seen.append(float(state.velocity[0, 0]))
    decay, swing = 1 / 0.3, np.sqrt(1 / 0.045 - 1 / 0.3**2)
    t = h * np.arange(1, 201)
    exact = 0.5 * (1 - np.exp(-decay * t) * (np.cos(swing * t) + decay / swing * np.sin(swing * t)))
    assert np.abs(np.array(seen) - exact).max() < 0.01


def test_neither_acceleration_nor_command_goes_beyond_the_limits():
    state, speeds, accelerations = at_rest(), [], []
    for _ in range(300):
        state = moved(FleetVehicle(), state, np.array([[30.0, 40.0, 0.0]]), 0.02)
        speeds.append(np.linalg.norm(state.velocity))
        accelerations.append(np.linalg.norm(state.acceleration))
    assert max(accelerations) <= 4.0 + 1e-9
    assert speeds[-1] == pytest.approx(3.5, abs=1e-3)
    assert state.velocity[0, :2] == pytest.approx([2.1, 2.8], abs=1e-3)


def test_a_steady_wind_is_leant_into():
    state = at_rest(gust=(1.0, 0.0, 0.0))
    for _ in range(200):
        state = moved(FleetVehicle(), state, np.zeros((1, 3)), 0.05)
    assert state.over_ground == pytest.approx(np.zeros((1, 3)), abs=1e-3)
    assert 0.2 < state.position[0, 0] < 0.5


def test_gusts_have_the_deviation_and_the_memory_they_say():
    gusts, rng, step = Gusts(0.3, 1.0), np.random.default_rng(5), 0.05
    blowing = gusts.at_first(400, rng)
    seen = [blowing]
    for _ in range(400):
        seen.append(gusts.after(seen[-1], step, rng))
    seen = np.array(seen)
    assert seen.std() == pytest.approx(0.3, rel=0.03)
    assert abs(seen.mean()) < 0.01
    for lag in (1.0, 2.0):
        k = round(lag / step)
        assert (seen[:-k] * seen[k:]).mean() / 0.09 == pytest.approx(np.exp(-lag), abs=0.03)
    assert abs((seen[..., 0] * seen[..., 1]).mean()) < 0.003


def test_no_gusts_are_none():
    rng = np.random.default_rng(0)
    assert not np.any(Gusts().after(Gusts().at_first(3, rng), 0.05, rng))


def test_vectors_are_shortened_only():
    found = within(np.array([[3.0, 4.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, 0.0]]), 2.5)
    assert found == pytest.approx(np.array([[1.5, 2.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, 0.0]]))
