import numpy as np
import pytest

from shotc.simulation.vehicle import (
    G_M_S2,
    STEP_S,
    Vehicle,
    VehicleSetpoint,
    VehicleState,
    braked,
    within,
)
from tests.support.plant_steps import moved

STILL = np.zeros((1, 3))


def flown(vehicle, state, asked, wind, seconds, error=0.0):
    for _ in range(round(seconds / STEP_S)):
        state = moved(vehicle, state, asked, wind, error)
    return state


def test_a_drone_that_brakes_stops_at_the_square_of_its_speed_over_twice_its_deceleration():
    place, velocity = (
        np.array([[1.0, 2.0, 3.0], [0.0, 0.0, 9.0]]),
        np.array([[3.0, 4.0, 0.0], [0.0, 0.0, 0.0]]),
    )
    one = braked(place, velocity, 2.5, 1.0)
    assert one.position == pytest.approx(place + np.array([[2.25, 3.0, 0.0], [0.0, 0.0, 0.0]]))
    assert one.velocity == pytest.approx(0.5 * velocity)
    assert one.acceleration == pytest.approx(np.array([[-1.5, -2.0, 0.0], [0.0, 0.0, 0.0]]))
    for seconds in (2.0, 60.0):
        rest = braked(place, velocity, 2.5, seconds)
        assert rest.position == pytest.approx(place + np.array([[3.0, 4.0, 0.0], [0.0, 0.0, 0.0]]))
        assert rest.velocity == pytest.approx(np.zeros((2, 3)), abs=1e-12)
        assert not rest.acceleration.any()


@pytest.mark.slow
def test_a_drone_comes_to_rest_where_it_is_asked_to_be():
    goal = np.array([[3.0, -2.0, 5.0]])
    state = flown(Vehicle(), VehicleState.at_rest(STILL), VehicleSetpoint(goal, STILL, STILL), STILL, 30.0)
    assert state.position == pytest.approx(goal, abs=1e-3)
    assert state.velocity == pytest.approx(STILL, abs=1e-3)


@pytest.mark.slow
def test_in_a_steady_wind_the_integrator_takes_over_all_of_the_drag():
    vehicle, wind = Vehicle(), np.array([[6.0, -2.0, 0.0]])
    state = flown(vehicle, VehicleState.at_rest(STILL), VehicleSetpoint(STILL, STILL, STILL), wind, 60.0)
    assert state.position == pytest.approx(STILL, abs=1e-3)
    assert state.held == pytest.approx(-vehicle.drag * wind, abs=1e-3)


def test_without_lag_and_drag_what_is_fed_forward_is_flown_exactly():
    vehicle = Vehicle(lag=1e-9, drag=0.0)
    t, dt = 0.0, STEP_S
    state = VehicleState(np.array([[0.0, 0.0, 0.0]]), np.array([[0.0, 0.0, 0.0]]), STILL, STILL)
    for _ in range(300):
        asked = VehicleSetpoint(
            np.array([[0.5 * t * t, 0, 0]]), np.array([[t, 0, 0]]), np.array([[1.0, 0, 0]])
        )
        state = moved(vehicle, state, asked, STILL)
        t += dt
    # The integration is of first order: half a step of speed.
    assert state.position[0, 0] == pytest.approx(0.5 * t * t, abs=2 * dt * t)


def test_a_lagging_acceleration_leaves_a_drone_behind_by_the_lag_times_the_change_of_speed():
    vehicle = Vehicle(position=(0, 0, 0), velocity=(0, 0, 0), integral=(0, 0, 0), drag=0.0, lag=0.2)
    push = VehicleSetpoint(STILL, STILL, np.array([[1.0, 0.0, 0.0]]))
    state = flown(vehicle, VehicleState.at_rest(STILL), push, STILL, 5.0)
    assert state.velocity[0, 0] == pytest.approx(5.0 - 0.2, abs=0.01)


def test_no_more_is_asked_of_a_drone_than_its_tilt_gives():
    vehicle = Vehicle(lag=1e-9)
    far = VehicleSetpoint(np.array([[1000.0, 1000.0, 1000.0]]), STILL, STILL)
    state = moved(vehicle, VehicleState.at_rest(STILL), far, STILL)
    assert np.hypot(*state.acceleration[0, :2]) == pytest.approx(G_M_S2 * np.tan(vehicle.tilt))
    assert state.acceleration[0, 2] == pytest.approx(vehicle.climb)


@pytest.mark.slow
def test_a_drone_hovers_as_far_off_as_it_takes_its_own_place_to_be():
    error = np.array([[0.4, 0.0, -0.2]])
    asked = VehicleSetpoint(STILL, STILL, STILL)
    state = flown(Vehicle(), VehicleState.at_rest(STILL), asked, STILL, 60.0, error)
    assert state.position == pytest.approx(-error, abs=1e-3)


@pytest.mark.slow
def test_wind_faster_than_the_tilt_can_hold_blows_a_drone_away_and_leaves_numbers_finite():
    wind = np.array([[60.0, 0.0, 0.0]])
    state = flown(Vehicle(), VehicleState.at_rest(STILL), VehicleSetpoint(STILL, STILL, STILL), wind, 60.0)
    assert state.position[0, 0] > 100.0
    assert np.isfinite(state.position).all()


def test_vectors_are_shortened_to_a_norm_and_left_alone_below_it():
    out = within(np.array([[3.0, 4.0, 0.0], [0.3, 0.4, 0.0], [0.0, 0.0, 0.0]]), 1.0)
    assert out == pytest.approx(np.array([[0.6, 0.8, 0.0], [0.3, 0.4, 0.0], [0.0, 0.0, 0.0]]))


@pytest.mark.slow
def test_a_drone_overshoots_where_it_brakes_by_the_drag_that_its_integrator_still_holds():
    def past(drag):
        """Fly at 8 m/s for 20 s, brake at 3 m/s^2, and return how far past the end it is 3 s later."""
        vehicle, state = Vehicle(drag=drag), VehicleState(STILL, np.array([[8.0, 0, 0]]), STILL, STILL)
        stops = 20.0 + 8.0 / 3.0
        for k in range(round((stops + 3.0) / STEP_S)):
            t = k * STEP_S
            left = min(max(t - 20.0, 0.0), 8.0 / 3.0)
            x = 8.0 * min(t, stops) - 1.5 * left**2
            braking = -3.0 if 20.0 < t < stops else 0.0
            asked = (np.array([[value, 0.0, 0.0]]) for value in (x, 8.0 - 3.0 * left, braking))
            state = moved(vehicle, state, VehicleSetpoint(*asked), STILL)
        return state.position[0, 0] - (8.0 * stops - 1.5 * (8.0 / 3.0) ** 2)

    assert 0.3 < past(Vehicle().drag) < 0.7
    assert abs(past(0.0)) < 0.1
