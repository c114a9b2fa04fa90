from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from shotc.geom.track import Track
from shotc.simulation.gimbal import axes_of
from shotc.simulation.kalman import (
    BIAS,
    GATE_CHI2,
    Estimate,
    MotionModel,
    PictureFix,
    PositionFix,
    ahead,
    predicted,
    projection,
)
from shotc.simulation.seen import WALKS
from shotc.simulation.tracker import Tracker
from shotc.simulation.truth import Truth

USED = np.array([True])


def tracker(place=(0.0, 0.0, 0.0), velocity=(0.0, 0.0, 0.0)):
    return Tracker.beginning(0.0, np.array([place]), np.array([velocity]), MotionModel(1.0))


def fix(time, place, deviation=0.02, used=USED):
    return PositionFix(time, np.array([place]), deviation, used)


WEAVER = MotionModel(0.3, memory=0.8, drift=0.02)


def integrated(motion, seconds, steps=20_000):
    """Return F and Q of one axis by Euler's rule on dF = A F and dQ = A Q + Q A' + N."""
    pull = 1.0 / motion.memory
    a = np.array([[0.0, 1.0, 0.0], [0.0, -pull, pull], [0.0, 0.0, 0.0]])
    noise, f, q, h = (
        np.diag([0.0, motion.agility, motion.drift]),
        np.eye(3),
        np.zeros((3, 3)),
        seconds / steps,
    )
    for _ in range(steps):
        f, q = f + h * a @ f, q + h * (a @ q + q @ a.T + noise)
    return f, q


@pytest.mark.slow
@pytest.mark.parametrize("seconds", [0.1, 4.0])
def test_who_weaves_comes_back_to_his_way(seconds):
    f, q = integrated(WEAVER, seconds)
    mean = np.array([[1.0, 2.0, 3.0, 0.5, -0.4, 0.0, 1.2, 0.1, 0.0, 0.3, 0.0, 0.0]])
    spread = np.diag([0.4, 0.3, 0.2])
    covariance = np.zeros((1, 12, 12))
    covariance[0, :9, :9] = np.kron(spread, np.eye(3))
    found = predicted(Estimate(0.0, mean, covariance), seconds, WEAVER)
    for axis in range(3):
        rows = [axis, 3 + axis, 6 + axis]
        assert found.mean[0, rows] == pytest.approx(f @ mean[0, rows], abs=1e-3)
        assert found.covariance[0][np.ix_(rows, rows)] == pytest.approx(f @ spread @ f.T + q, abs=1e-3)
    places = ahead(Estimate(0.0, mean, covariance), np.array([0.0, seconds]), WEAVER)
    assert places[0, 0] == pytest.approx(mean[0, :6])
    assert places[1, 0] == pytest.approx(found.mean[0, :6])


def weaving(rng, seconds, step=0.2):
    """Return times and places of a walker at 1.3 m/s who is 0.5 m off a straight way (`--wander 0.5`)."""
    times = 0.01 * np.arange(round(seconds / 0.01) + 1)
    target = SimpleNamespace(
        name="walker", track=Track((0.0, seconds), ((0.0, 0.0, 0.9), (1.3 * seconds, 0.0, 0.9)))
    )
    places = Truth(0.5).places(target, times, [rng])
    return times[:: round(step / 0.01)], places[:: round(step / 0.01), 0]


@pytest.mark.long
def test_who_weaves_is_foreseen_better_by_his_way_than_by_how_he_moves_now():
    """Three seconds ahead; and what is foreseen moves half as far from one plan to the next."""
    off, moves = {}, {}
    for name, models in {"moves on": (MotionModel(0.03), MotionModel(1.0)), "comes back": WALKS}.items():
        missed, told = [], []
        for seed in range(6):
            rng = np.random.default_rng(seed)
            times, places = weaving(rng, 60.0)
            seen = places + 0.02 * rng.standard_normal(places.shape)
            velocity = (places[1:2] - places[:1]) / 0.2
            under_test = Tracker.beginning(0.0, seen[:1], velocity, *models)
            found = []
            for k in range(1, len(times) - 15):
                under_test.take(fix(times[k], seen[k]))
                (place,) = under_test.ahead(np.array([times[k], times[k] + 3.0]))[1, :, :2]
                found.append(place - [1.3 * times[k], 0.0])
                missed.append(place - places[k + 15, :2])
            told.extend(np.diff(found[::3], axis=0))  # two plans a second
        off[name], moves[name] = (np.sqrt((np.array(each) ** 2).mean()) for each in (missed, told))
    assert off["comes back"] < 0.85 * off["moves on"]
    assert moves["comes back"] < 0.6 * moves["moves on"]


def oracle(fixes, end, q=1.0):
    """Return the Kalman filter of one run as the textbook writes it."""
    x, p, now = np.zeros(6), 0.5 * np.eye(6), 0.0
    h = np.hstack([np.eye(3), np.zeros((3, 3))])

    def predict(dt):
        f = np.block([[np.eye(3), dt * np.eye(3)], [np.zeros((3, 3)), np.eye(3)]])
        noise = q * np.block(
            [[dt**3 / 3 * np.eye(3), dt**2 / 2 * np.eye(3)], [dt**2 / 2 * np.eye(3), dt * np.eye(3)]]
        )
        return f @ x, f @ p @ f.T + noise

    for time, place, deviation in fixes:
        x, p = predict(time - now)
        now = time
        gain = p @ h.T @ np.linalg.inv(h @ p @ h.T + deviation**2 * np.eye(3))
        x, p = x + gain @ (np.array(place) - h @ x), (np.eye(6) - gain @ h) @ p
    return predict(end - now)


FIXES = [(0.2 * k, (0.3 * k, -0.1 * k, 1.0), 0.1 + 0.01 * k) for k in range(1, 12)]


def test_it_is_the_textbook_filter():
    under_test = tracker()
    for each in FIXES:
        under_test.take(fix(*each))
    found, (mean, covariance) = under_test.now(2.5), oracle(FIXES, 2.5)
    assert found.mean[0, :6] == pytest.approx(mean, abs=1e-9)
    assert found.covariance[0, :6, :6] == pytest.approx(covariance, abs=1e-9)


@pytest.mark.slow
@given(st.permutations(range(6)))
def test_the_order_of_arrival_does_not_matter(order):
    in_order, shuffled = tracker(), tracker()
    for each in FIXES[:6]:
        in_order.take(fix(*each))
    for k in order:
        assert shuffled.take(fix(*FIXES[k]))
    assert shuffled.now(2.0).mean == pytest.approx(in_order.now(2.0).mean, abs=1e-9)
    assert shuffled.now(2.0).covariance == pytest.approx(in_order.now(2.0).covariance, abs=1e-9)


def test_what_is_older_than_all_that_is_kept_is_refused():
    under_test = tracker()
    for k in range(1, 40):
        under_test.take(fix(0.2 * k, (0.0, 0.0, 0.0)))
    before = under_test.now(8.0).mean
    assert not under_test.take(fix(0.1, (50.0, 0.0, 0.0)))
    assert under_test.now(8.0).mean == pytest.approx(before)


def test_a_run_without_the_measurement_only_predicts():
    under_test = Tracker.beginning(0.0, np.zeros((2, 3)), np.ones((2, 3)), MotionModel(1.0))
    start = under_test.now(0.0)
    both = np.tile([5.0, 5.0, 5.0], (2, 1))
    under_test.take(PositionFix(1.0, both, 0.1, np.array([True, False])))
    alone = predicted(start, 1.0, MotionModel(1.0))
    found = under_test.now(1.0)
    assert found.mean[1] == pytest.approx(alone.mean[1])
    assert found.covariance[1] == pytest.approx(alone.covariance[1])
    assert found.position[0] == pytest.approx([5.0, 5.0, 5.0], abs=0.1)


def picture(uv, eye=(0.0, 0.0, 0.0), time=1.0, used=USED):
    axes = axes_of(np.array([0.0]), np.array([0.0]))
    return PictureFix(time, np.array([uv]), np.array([eye]), axes, np.array([[0.5, 0.4]]), 0.01, used)


def test_pictures_from_two_sides_find_a_place():
    under_test = tracker((20.0, 0.0, 0.0))
    true = np.array([[20.4, 0.6, -0.5]])
    half = np.array([[0.5, 0.4]])
    for k, (yaw, eye) in enumerate([(0.0, (0.0, 0.0, 0.0)), (np.pi / 2, (20.0, -15.0, 0.0))] * 8):
        axes = axes_of(np.array([yaw]), np.array([0.0]))
        uv, _ = projection(true - np.array([eye]), axes, half)
        under_test.take(PictureFix(0.1 * k + 0.1, uv, np.array([eye]), axes, half, 0.005, USED))
    assert under_test.now(1.7).position == pytest.approx(true, abs=0.1)


def test_a_detection_of_something_else_is_left_out():
    under_test = tracker((20.0, 0.0, 0.0))
    for k in range(1, 20):
        under_test.take(fix(0.05 * k, (20.0, 0.0, 0.0)))
    before = under_test.now(1.0).mean
    under_test.take(picture((0.9, 0.9)))
    assert under_test.now(1.0).mean == pytest.approx(before)
    assert pytest.approx(-2 * np.log(0.01), abs=0.01) == GATE_CHI2


def test_a_detection_from_a_camera_that_has_its_target_behind_it_changes_nothing():
    under_test = tracker((-20.0, 0.0, 0.0))
    expected = predicted(under_test.now(0.0), 1.0, MotionModel(1.0))
    under_test.take(picture((0.1, 0.1)))
    assert under_test.now(1.0).mean == pytest.approx(expected.mean)
    assert np.isfinite(under_test.now(1.0).covariance).all()


@pytest.mark.slow
@given(*[st.floats(-3.0, 3.0)] * 2, st.floats(5.0, 30.0), st.floats(-3.0, 3.0), st.floats(-1.2, 1.2))
def test_the_derivative_of_the_picture_is_its_slope(x, y, z, yaw, pitch):
    axes, half = axes_of(np.array([yaw]), np.array([pitch])), np.array([[0.5, 0.3]])
    offset = (axes @ np.array([x, y, z]))[None, 0]
    _, jacobian = projection(offset, axes, half)
    h = 1e-6
    for k in range(3):
        step = np.eye(3)[k] * h
        ahead, behind = (projection(offset + sign * step, axes, half)[0] for sign in (1, -1))
        slope = (ahead - behind) / (2 * h)
        assert jacobian[0, :, k] == pytest.approx(slope[0], abs=1e-6)


def test_pictures_find_what_a_receiver_is_off_and_are_not_taken_for_another_thing():
    """The case of a bias of 1.5 m: without a state of its own it makes the filter sure of a wrong place."""
    true, off = np.array([[20.0, 0.0, 0.0]]), np.array([[0.0, 1.5, -1.0]])
    under_test = Tracker.beginning(0.0, true + off, np.zeros((1, 3)), MotionModel(1.0, 1.5))
    axes, half = axes_of(np.array([0.0]), np.array([0.0])), np.array([[0.5, 0.4]])
    for k in range(1, 60):
        under_test.take(PositionFix(0.1 * k, true + off, 0.1, USED))
        if k > 30:
            uv, _ = projection(true, axes, half)
            under_test.take(PictureFix(0.1 * k, uv, np.zeros((1, 3)), axes, half, 0.01, USED))
    found = under_test.now(5.9)
    assert found.position[0, 1:] == pytest.approx([0.0, 0.0], abs=0.1)
    assert found.mean[0, BIAS][1:] == pytest.approx([1.5, -1.0], abs=0.15)
