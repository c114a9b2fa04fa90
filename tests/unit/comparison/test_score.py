"""The measures of a comparison, on errors and motions whose scores are known."""

from __future__ import annotations

from math import inf, nan, sqrt

import numpy as np
import pytest

from shotc.comparison.score import flown_shots, score, squared_jerk, total
from shotc.geom.bernstein import Piecewise, quintic_hermite
from shotc.ir.comparison import MotionMeasures, Trace
from shotc.ir.passes import PassContext
from shotc.passes.verify import judge
from tests.support.film_plans import orbit_plan

STILL = MotionMeasures(0.0, 0.0, 0.0, 0.0, 1.0)


def trace(error, margin=None, points=None, covered=None) -> Trace:
    n = len(error)
    share = np.linspace(0, 1, n)
    margin = np.ones(n) if margin is None else np.array(margin, dtype=float)
    points = np.ones(n) if points is None else np.array(points, dtype=float)
    covered = np.zeros(n) if covered is None else np.array(covered)
    return Trace("tower", 10 * share, share, np.array(error, dtype=float), margin, points, covered)


def polynomial(times, value, *derivatives) -> Piecewise:
    """Return a curve of seven channels of which x is given by value and derivatives, at breaks."""
    columns = [np.zeros((len(times), 7)) for _ in range(3)]
    for column, f in zip(columns, (value, *derivatives), strict=True):
        column[:, 0] = f(times)
    return quintic_hermite(times, *columns)


def test_mean_95_percent_and_worst_of_known_errors():
    found = score([trace(np.arange(1, 101) / 100)], STILL)
    assert found.frames == 100
    assert found.error_mean == pytest.approx(0.505)
    assert found.error_p95 == pytest.approx(0.95)
    assert found.error_worst == 1.0


def test_the_frame_that_shows_least_counts():
    assert score([trace([0.0] * 3, covered=[0.0, 0.4, 0.1]), trace([0.0])], STILL).visible == 0.6
    assert score([], STILL).visible is None


def test_frames_of_several_targets_count_alike():
    found = score([trace([0.0] * 30), trace([1.0] * 10)], STILL)
    assert found.error_mean == pytest.approx(0.25)
    assert found.frames == 40


def test_a_target_behind_the_camera_is_infinitely_far_off():
    few = score([trace([0.1] * 99 + [inf])], STILL)
    assert (few.error_mean, few.error_p95, few.error_worst) == (inf, 0.1, inf)
    assert score([trace([0.1] * 9 + [inf])], STILL).error_p95 == inf


def test_frames_without_a_wanted_place_have_no_error_but_are_frames():
    found = score([trace([nan, 0.2, nan, 0.4])], STILL)
    assert found.error_mean == pytest.approx(0.3)
    assert found.frames == 4
    assert score([trace([nan, nan])], STILL).error_worst is None


def test_both_shares_in_frame_are_counted_apart():
    found = score([trace([0] * 4, [1.0, 0.0, -1e-5, -3.0], [1, 1, 1, 0])], STILL)
    assert found.in_frame == 0.5
    assert found.in_frame_four_points == 0.75


def test_a_shot_that_frames_nothing_has_jerk_and_duration_only():
    found = score([], MotionMeasures(36.0 * 5, 0.25 * 5, 6.0, 4.0, 5.0))
    assert found == (0, None, None, None, None, None, None, 6.0, 0.5, 1.5, 5.0)


def test_squared_jerk_of_powers_of_time_is_exact():
    times = np.array([0.0, 0.7, 2.0])
    cubic = polynomial(times, lambda t: t**3, lambda t: 3 * t**2, lambda t: 6 * t)
    assert squared_jerk(cubic, 0.0, 2.0) == pytest.approx(36 * 2, rel=1e-12)
    assert squared_jerk(cubic, 0.5, 0.9) == pytest.approx(36 * 0.4, rel=1e-10)
    fifth = polynomial(times, lambda t: t**5, lambda t: 5 * t**4, lambda t: 20 * t**3)
    # The third derivative is 60 t^2; the integral of 3600 t^4 is 720 t^5.
    assert squared_jerk(fifth, 0.0, 2.0) == pytest.approx(720 * 2**5, rel=1e-12)
    assert squared_jerk(fifth, 1.0, 1.5) == pytest.approx(720 * (1.5**5 - 1), rel=1e-10)


def test_turning_the_camera_is_no_jerk():
    times = np.array([0.0, 1.0])
    value = np.zeros((2, 7))
    turn = value.copy()
    turn[:, 3] = times**3
    curve = quintic_hermite(times, turn, value, value)
    assert squared_jerk(curve, 0.0, 1.0) == 0.0


@pytest.mark.slow
def test_a_plan_is_measured_by_what_its_certificate_says():
    plan = orbit_plan()
    (shot,) = flown_shots(plan)
    claims = {c.constraint: c for c in judge(plan.trajectory, PassContext()).certificate if c.shot == shot.id}
    assert shot.score.error_worst == claims["tower screen error"].worst
    assert shot.score.in_frame == claims["tower in frame"].worst
    assert shot.score.duration == pytest.approx(30.0)
    together = total(plan, (shot,))
    assert together == shot.score
    (curve,) = (track.curve for track in plan.trajectory.drones)
    t = np.linspace(shot.start, shot.end, 200_001)[:-1]
    jerk = np.linalg.norm(curve.channels(0, 1, 2).derivative(3)(t), axis=1)
    assert together.jerk_rms == pytest.approx(sqrt((jerk**2).mean()), rel=1e-3)
    turning = np.linalg.norm(curve.channels(3, 4).derivative(3)(t), axis=1)
    assert together.turn_jerk_rms == pytest.approx(sqrt((turning**2).mean()), rel=1e-3)
    assert together.off_place is None  # nobody asks for a place between keyframes
