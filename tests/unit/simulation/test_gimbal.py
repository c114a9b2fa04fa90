import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from shotc.geom.camera import view
from shotc.simulation.gimbal import Attitude, GimbalModel, angles_of, axes_of, rotated, turn_rate, turned

ANGLES = st.floats(-3.0, 3.0)
PITCHES = st.floats(-1.4, 1.4)


@given(ANGLES, PITCHES)
def test_attitudes_are_those_of_the_camera_model(yaw, pitch):
    axes = axes_of(np.array([yaw]), np.array([pitch]))[0]
    offset = (1.0, 2.0, 3.0)
    assert axes.T @ np.array(offset) == pytest.approx(view(yaw, pitch, 1.0, 1.5).to_camera(offset))
    assert np.linalg.det(axes) == pytest.approx(1.0)
    found = angles_of(axes[None])
    assert [float(a[0]) for a in found] == pytest.approx([yaw, pitch, 0.0], abs=1e-12)


@pytest.mark.slow
@given(ANGLES, PITCHES, st.floats(-1.0, 1.0))
def test_roll_is_read_back(yaw, pitch, roll):
    axes = axes_of(np.array([yaw]), np.array([pitch]))
    tilted = rotated(axes, roll * axes[:, :, 2])
    assert abs(float(angles_of(tilted)[2][0])) == pytest.approx(abs(roll), abs=1e-9)


@pytest.mark.slow
@given(st.tuples(*[st.floats(-4.0, 4.0)] * 3))
def test_a_rotation_vector_turns_as_the_exponential_map_does(vector):
    axes = axes_of(np.array([0.3]), np.array([-0.4]))
    wanted = Rotation.from_rotvec(vector).as_matrix() @ axes[0]
    assert rotated(axes, np.array([vector]))[0] == pytest.approx(wanted, abs=1e-12)


def test_turn_rates_are_the_derivative_of_the_attitude():
    h, yaw, pitch = 1e-6, np.array([0.7]), np.array([-0.5])
    axes = axes_of(yaw, pitch)
    slope = (axes_of(yaw + 0.3 * h, pitch - 0.2 * h) - axes) / h
    omega = turn_rate(axes, np.array([0.3]), np.array([-0.2]))
    assert slope[0] == pytest.approx(np.cross(omega[0], axes[0], axisb=0, axisc=0), abs=1e-5)


def test_a_camera_without_lag_follows_a_turn_that_is_fed_forward():
    gimbal, step, rate = GimbalModel(rate=2.0, lag=1e-9), 0.02, 0.5
    attitude = Attitude(axes_of(np.array([0.0]), np.array([0.0])), np.zeros((1, 3)))
    for k in range(200):
        wanted = axes_of(np.array([rate * k * step]), np.array([0.0]))
        omega = turn_rate(wanted, np.array([rate]), np.array([0.0]))
        attitude = turned(gimbal, attitude, wanted, omega, step)
    assert float(angles_of(attitude.axes)[0][0]) == pytest.approx(rate * 200 * step, abs=1e-9)


def test_an_error_of_attitude_decays_with_the_gain():
    gimbal = GimbalModel(rate=10.0, gain=4.0, lag=1e-9)
    attitude = Attitude(axes_of(np.array([0.02]), np.array([0.0])), np.zeros((1, 3)))
    wanted = axes_of(np.array([0.0]), np.array([0.0]))
    for _ in range(100):
        attitude = turned(gimbal, attitude, wanted, np.zeros((1, 3)), 0.005)
    assert float(angles_of(attitude.axes)[0][0]) == pytest.approx(0.02 * (1.0 - 4.0 * 0.005) ** 100, rel=1e-3)


def test_no_camera_turns_faster_than_both_axes_at_their_limit():
    gimbal = GimbalModel(rate=0.5, lag=1e-9)
    attitude = Attitude(axes_of(np.array([0.0]), np.array([0.0])), np.zeros((1, 3)))
    fast = np.array([[0.0, 0.0, 9.0]])
    after = turned(gimbal, attitude, attitude.axes, fast, 0.1)
    assert float(angles_of(after.axes)[0][0]) == pytest.approx(0.1 * 0.5 * np.sqrt(2.0))
