from heapq import heappush

import numpy as np
import pytest

from shotc.geom.shapes import CylinderShape
from shotc.geom.track import Track
from shotc.ir.target import Target
from shotc.simulation.aim import Shown, aim_rates, aimed
from shotc.simulation.conditions import Conditions, Outage
from shotc.simulation.gimbal import axes_of
from shotc.simulation.kalman import MotionModel, PositionFix, projection
from shotc.simulation.seen import TrackedTarget, Waiting
from shotc.simulation.sensors import PLAIN, RECKONED_M_S, RECKONED_M_S2, RTK, Detector, Gps, within
from shotc.simulation.tracker import Tracker
from shotc.simulation.truth import Truth
from shotc.simulation.wind import WindField, wandering


def chances(n, what="x"):
    return Conditions(seed=3).chances(range(n), what)


def test_a_process_of_deviation_one_stays_so_and_forgets_at_its_rate():
    noise = np.random.default_rng(1).standard_normal((4000, 200))
    out = wandering(noise, 0.1)
    assert out.std() == pytest.approx(1.0, abs=0.02)
    assert np.mean(out[:-10] * out[10:]) == pytest.approx(np.exp(-1.0), abs=0.02)


def test_wind_with_a_bearing_is_the_same_in_all_runs_and_else_of_one_speed():
    assert WindField(3.0, 0.0).steady(chances(4)) == pytest.approx(np.tile([3.0, 0.0, 0.0], (4, 1)))
    drawn = WindField(3.0).steady(chances(50))
    assert np.linalg.norm(drawn, axis=1) == pytest.approx(np.full(50, 3.0))
    assert drawn[:, 0].min() < -1.0 < 1.0 < drawn[:, 0].max()


def test_gusts_have_the_deviation_that_is_asked_for():
    blown = WindField(gusts=1.5).blown(2000, 0.1, chances(60))
    assert blown.std() == pytest.approx(1.5, rel=0.05)
    assert not WindField().blown(10, 0.1, chances(2)).any()


def test_a_run_has_the_same_chances_whichever_runs_stand_beside_it():
    alone = Conditions(seed=3).chances([7], "gps")[0].standard_normal(4)
    among = Conditions(seed=3).chances(range(9), "gps")[7].standard_normal(4)
    assert alone == pytest.approx(among)
    other = Conditions(seed=3).chances([7], "wind")[0].standard_normal(4)
    assert abs(alone - other).min() > 0


def test_positions_are_off_by_noise_bias_and_offset():
    times = np.arange(4000) * 0.2
    error = Gps(0.3, 1.0, (10.0, 0.0, 0.0)).error(times, chances(40))
    assert error.mean(axis=(0, 1)) == pytest.approx([10.0, 0.0, 0.0], abs=0.15)
    assert error[:, :, 1].std() == pytest.approx(np.hypot(0.3, 1.0), rel=0.05)
    # The bias is nearly the same 0.2 s later, the noise is not.
    step = np.diff(error[:, :, 1], axis=0).std()
    assert step == pytest.approx(np.sqrt(2 * 0.3**2 + 2 * (1 - np.exp(-0.01))), rel=0.05)
    assert PLAIN.deviation == pytest.approx(np.hypot(0.3, 1.5))


def test_longer_recordings_begin_as_shorter_ones_do():
    short, long = (PLAIN.error(np.arange(n) * 0.2, chances(2)) for n in (50, 80))
    assert long[:50] == pytest.approx(short)


def test_no_position_arrives_while_it_is_lost():
    conditions = Conditions(outages=(Outage(14.0, 15.0), Outage(10.0, 14.5), Outage(2.0, 3.0, "walker")))
    assert conditions.lost("cam") == ((10.0, 15.0),)
    assert conditions.lost("walker") == ((2.0, 3.0), (10.0, 15.0))
    assert [within(t, conditions.lost("cam")) for t in (9.9, 10.0, 15.0)] == [False, True, False]


@pytest.mark.slow
def test_without_satellites_a_drone_drifts_by_its_inertial_sensors_and_comes_back():
    times = np.arange(1150) * 0.02
    plain = RTK.own_error(times, chances(150))
    lost = RTK.own_error(times, chances(150), ((10.0, 15.0),))
    before, inside, after = times < 10.0, (times >= 10.0) & (times < 15.0), times >= 22.0
    assert np.array_equal(lost[before], plain[before])
    assert np.array_equal(lost[..., 2], plain[..., 2])  # the barometer needs no satellites
    assert lost[after] == pytest.approx(plain[after], abs=5e-3)
    off = lost[inside][..., :2]
    wanted = np.hypot(RECKONED_M_S * 5.0, RECKONED_M_S2 * 12.5)
    assert off[-1].std() == pytest.approx(wanted, rel=0.15)
    assert np.abs(np.diff(lost, axis=0)).max() < 0.1  # no jump, when positions are back either
    assert np.abs(lost[times >= 15.0][0, :, :2] - off[-1]).max() < 0.02


def test_a_position_is_known_at_the_step_on_which_it_arrives():
    stamp = 0.2 + 0.1 - 0.1  # the sum with its delay is a little more than 0.3
    fix = PositionFix(stamp, np.ones((1, 3)), 0.02, np.ones(1, dtype=bool))
    tracker = Tracker.beginning(0.0, np.zeros((1, 3)), np.zeros((1, 3)), MotionModel(1.0))
    seen = TrackedTarget("walker", np.zeros((1, 1, 3)), np.zeros(1), tracker, chances(1))
    heappush(seen.waiting, Waiting(stamp + 0.1, 0, fix))
    assert stamp + 0.1 > 0.3
    seen.learn(0.3)
    assert not seen.waiting
    assert tracker.now(0.3).position[0, 0] > 0.9


def test_detections_are_missed_as_often_as_said_and_never_out_of_the_picture():
    detector, n = Detector(noise=0.02, misses=0.2), 3000
    uv = np.tile([0.3, -0.2], (n, 1))
    uv[:300] = [1.2, 0.0]
    uv[300:600] = np.nan
    found, used = detector.detections(uv, chances(n))
    assert not used[:600].any()
    assert used[600:].mean() == pytest.approx(0.8, abs=0.03)
    assert (found - uv)[used].std() == pytest.approx(0.02, rel=0.05)


WAY = Track((0.0, 60.0), ((0.0, 0.0, 0.9), (60.0, 0.0, 0.9)))
WALKER = Target("walker", (0.0, 0.0, 0.9), CylinderShape(0.4, 1.8), (), WAY)


@pytest.mark.slow
def test_a_target_wanders_smoothly_about_its_track_from_its_start_on():
    times = np.arange(6000) * 0.01
    places = Truth(wander=0.5).places(WALKER, times, chances(200))
    off = places - np.column_stack([times, 0 * times, 0 * times + 0.9])[:, None]
    assert not off[0].any()
    assert off[3000:, :, :2].std() == pytest.approx(0.5, rel=0.1)
    assert not off[:, :, 2].any()
    assert np.abs(np.diff(off, axis=0)).max() < 0.02  # 2 m/s


def test_a_true_track_takes_the_place_of_the_planned_one():
    track = Track((0.0, 10.0), ((0.0, 5.0, 0.9), (0.0, 15.0, 0.9)))
    places = Truth(tracks=(("walker", track),)).places(WALKER, np.array([0.0, 5.0]), chances(2))
    assert places[1] == pytest.approx(np.array([[0.0, 10.0, 0.9]] * 2))


def test_what_stands_stays():
    still = WALKER._replace(track=None)
    places = Truth(wander=1.0).places(still, np.array([0.0, 1.0]), chances(3))
    assert places == pytest.approx(np.broadcast_to([0.0, 0.0, 0.9], (2, 3, 3)))


def test_aimed_cameras_show_the_point_where_it_is_wanted():
    rng = np.random.default_rng(5)
    offset = rng.uniform(-10, 10, (300, 3)) * [1, 1, 0.5]
    uv, half = rng.uniform(-0.8, 0.8, (300, 2)), np.tile([0.6, 0.4], (300, 1))
    yaw, pitch = aimed(offset, uv, half)
    shown, _ = projection(offset, axes_of(yaw, pitch), half)
    # Straight above or below, no camera without roll shows every place.
    level = np.hypot(offset[:, 0], offset[:, 1]) > np.abs(offset[:, 2])
    assert shown[level] == pytest.approx(uv[level], abs=1e-9)


def test_rates_of_a_camera_are_the_slopes_of_its_angles():
    """A target that moves, a place on screen that wanders, a lens that zooms; one by one and at once."""
    rng = np.random.default_rng(6)
    offset, velocity, h = rng.uniform(2, 9, (50, 3)), rng.uniform(-2, 2, (50, 3)), 1e-6
    now = Shown(rng.uniform(-0.5, 0.5, (50, 2)), np.full((50, 2), 0.5))
    drift, zoom = rng.uniform(-0.3, 0.3, (50, 2)), rng.uniform(-0.2, 0.2, (50, 2))
    for moves, wanders, zooms in ((1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 1)):
        later = Shown(now.uv + 0.02 * wanders * drift, now.half + 0.02 * zooms * zoom)
        soon = Shown(now.uv + h * wanders * drift, now.half + h * zooms * zoom)
        a, b = aimed(offset, *now), aimed(offset + moves * velocity * h, *soon)
        for rate, first, then in zip(
            aim_rates(offset, moves * velocity, now, later, 0.02), a, b, strict=True
        ):
            assert rate == pytest.approx((then - first) / h, abs=0.01)
            assert np.abs(rate).max() > 0.02
