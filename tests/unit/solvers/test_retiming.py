"""The timing of single moves against closed forms, and against dense sampling on random paths."""

from __future__ import annotations

from dataclasses import replace
from math import pi, radians, sqrt

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from shotc.geom.bernstein import Piecewise, quintic_hermite
from shotc.planning.path.monotone import steady
from shotc.planning.timing import move as move_module
from shotc.planning.timing.flown import straying, usages
from shotc.planning.timing.grid import sample
from shotc.planning.timing.limits import EASE_S, Ceiling
from shotc.planning.timing.move import axes_of, time_move, topp_limits
from shotc.planning.timing.profile import fly
from shotc.solvers.conic import Status
from shotc.solvers.retiming_socp import cell_times
from shotc.solvers.topp import fastest
from tests.support.timing_paths import CEILING, HFOV, circle, jumps, line, s_curve_time, smooth, uses

HERE = (0.0, 0.0, 10.0, 0.0, 0.0, 0.0, HFOV)


def at(x: float = 0.0, z: float = 10.0, yaw: float = 0.0, hfov: float = HFOV) -> tuple[float, ...]:
    return (x, 0.0, z, yaw, 0.0, yaw, hfov)


def test_the_closed_form_meets_its_limits_where_the_segments_change():
    # Triangle of jerk only: L = 2 j (T/4)^3. Trapezium: L = v (T - v/a - a/j).
    assert s_curve_time(2 * 8 * 0.3**3, 8, 3, 8) == pytest.approx(1.2)
    assert s_curve_time(100.0, 8, 3, 8) == pytest.approx(100 / 8 + 8 / 3 + 3 / 8)
    edge = 8 * (8 / 3 + 3 / 8)
    assert s_curve_time(edge * (1 - 1e-12), 8, 3, 8) == pytest.approx(s_curve_time(edge, 8, 3, 8))
    short = 2 * 3**3 / 8**2
    assert s_curve_time(short * (1 - 1e-12), 8, 3, 8) == pytest.approx(s_curve_time(short, 8, 3, 8))


@pytest.mark.parametrize("length", [0.01, 0.5, 3.0, 20.0, 100.0, 600.0])
def test_a_straight_line_takes_the_time_of_the_s_curve(length: float):
    move = time_move(line(HERE, at(length)), (0.0, length), CEILING)
    best = s_curve_time(length, CEILING.speed, CEILING.acceleration, CEILING.jerk)
    assert best * (1 - 1e-6) <= move.duration <= 1.02 * best


@pytest.mark.parametrize(("rise", "speed"), [(30.0, CEILING.climb), (-30.0, CEILING.descent)])
def test_climb_and_descent_have_limits_of_their_own(rise: float, speed: float):
    move = time_move(line(HERE, at(z=10.0 + rise)), (0.0, 30.0), CEILING)
    best = s_curve_time(30.0, speed, CEILING.acceleration, CEILING.jerk)
    assert best * (1 - 1e-6) <= move.duration <= 1.02 * best


def test_without_much_jerk_limit_the_profile_is_as_fast_as_topp_ra():
    ceiling = replace(CEILING, jerk=1e4)
    move = time_move(line(HERE, at(50.0)), (0.0, 50.0), ceiling)
    bang_bang = 50 / 8 + 8 / 3
    assert move.topp_time == pytest.approx(bang_bang, rel=5e-3)
    # An acceleration that jumps is reached over a cell or so.
    assert bang_bang <= move.duration <= 1.03 * bang_bang


def test_on_a_circle_the_centripetal_acceleration_holds_the_speed():
    radius = 10.0
    move = time_move(circle(radius, 6 * pi, 72), (0.0, radius * 6 * pi), CEILING)
    cruise = sqrt(CEILING.acceleration * radius)
    assert cruise < CEILING.speed
    t = np.linspace(0.4, 0.6, 50) * move.duration
    v = move.curve.derivative(1)(t)
    assert np.hypot(v[:, 0], v[:, 1]) == pytest.approx(cruise, rel=0.01)
    assert np.hypot(v[:, 0], v[:, 1]).max() <= cruise * (1 + 1e-9)


def test_a_turn_in_place_is_bound_by_the_body_and_eased():
    angle = radians(150)
    ceiling = replace(CEILING, gimbal_rate=9.0, gimbal_acceleration=9.0)
    move = time_move(line(HERE, at(yaw=angle)), (0.0, angle), ceiling)
    most = CEILING.yaw_acceleration
    best = s_curve_time(angle, CEILING.yaw_rate, most, most / EASE_S)
    assert best * (1 - 0.01) <= move.duration <= 1.02 * best
    assert uses(move.curve, CEILING)["yaw_rate"] == pytest.approx(1.0, abs=0.01)


def test_the_gimbal_turns_at_its_own_rate_relative_to_the_body():
    end = (0.0, 0.0, 10.0, 2.0, 0.0, 0.0, HFOV)
    move = time_move(line(HERE, end), (0.0, 2.0), CEILING)
    assert uses(move.curve, CEILING)["gimbal_rate"] == pytest.approx(1.0, abs=0.02)
    assert uses(move.curve, CEILING)["yaw_rate"] == 0.0


def test_a_zoom_on_the_spot_takes_time_but_binds_nothing_in_flight():
    zoom = time_move(line(HERE, at(hfov=radians(20))), (0.0, radians(50)), CEILING)
    assert zoom.duration > 1.0
    assert jumps(zoom.curve)[2] < 1e-9
    flying = time_move(line(HERE, at(20.0, hfov=radians(5))), (0.0, 20.0), CEILING)
    alone = time_move(line(HERE, at(20.0)), (0.0, 20.0), CEILING)
    assert flying.duration == pytest.approx(alone.duration, rel=1e-3)


def test_every_move_begins_and_ends_at_rest_without_acceleration():
    move = time_move(smooth(3), (0.0, smooth(3).end), CEILING)
    for order in (1, 2):
        derivative = move.curve.derivative(order).ctrl
        assert np.abs(derivative[0, 0]).max() == 0.0
        assert np.abs(derivative[-1, -1]).max() == 0.0


@pytest.mark.long
@settings(max_examples=25, deadline=None, derandomize=True)
@given(
    seed=st.integers(0, 10**6),
    size=st.sampled_from([0.5, 3.0, 15.0, 60.0]),
    shares=st.tuples(*[st.sampled_from([0.3, 1.0, 3.0])] * 9),
)
def test_no_limit_is_broken_at_any_instant_of_a_random_path(
    seed: int, size: float, shares: tuple[float, ...]
):
    ceiling = Ceiling(
        *(share * getattr(CEILING, name) for share, name in zip(shares, CEILING.__slots__, strict=False))
    )
    path = smooth(seed, size=size)
    move = time_move(path, (0.0, path.end), ceiling)
    found = uses(move.curve, ceiling)
    assert max(found.values()) <= 1.0, found
    # Not slower than need be: something binds, and scaling took little.
    assert max(found.values()) > 0.98, found
    assert move.scale < 1.03
    assert move.duration >= move.topp_time * (1 - 2e-3)
    value, rate, acceleration = jumps(move.curve)
    assert value < 1e-9
    assert rate < 1e-8
    assert acceleration < 1e-6


def test_where_the_jerk_binds_the_programme_keeps_it_without_much_of_a_stretch_afterwards():
    ceiling = replace(CEILING, jerk=0.3 * CEILING.jerk)
    path = smooth(0, size=3.0)
    move = time_move(path, (0.0, path.end), ceiling)
    assert 0.98 < uses(move.curve, ceiling)["jerk"] <= 1.0
    assert move.scale < 1.01


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(4))
def test_without_any_answer_of_the_solver_a_rough_profile_keeps_every_limit(
    seed: int, monkeypatch: pytest.MonkeyPatch
):
    path = smooth(seed)
    best = time_move(path, (0.0, path.end), CEILING)
    monkeypatch.setattr(move_module, "retime", lambda _problem, around: (Status.FAILED, around))
    move = time_move(path, (0.0, path.end), CEILING)
    assert best.held is None
    assert move.held in CEILING.__slots__
    assert max(uses(move.curve, CEILING).values()) <= 1.0
    assert best.duration < move.duration < 2.0 * best.duration
    assert all(jump < 1e-6 for jump in jumps(move.curve))


@pytest.mark.long
@pytest.mark.parametrize("seed", [0, 10, 12, 13])
def test_turns_within_centimetres_among_long_ways_cost_no_more_than_they_must(seed: int):
    rng = np.random.default_rng(seed)
    at = np.concatenate([[0.0], np.cumsum(10 ** rng.uniform(-2, 1.3, 12))])
    yaw = steady(at, np.cumsum(rng.uniform(-3, 3, 13))).ctrl[:, :, 0]
    pitch = steady(at, rng.uniform(-1, 0, 13)).ctrl[:, :, 0]
    place = np.linspace(at[:-1], at[1:], 6, axis=1)
    zero = np.zeros_like(place)
    path = Piecewise(at, np.stack([place, zero, zero + 10, yaw, pitch, yaw, zero + HFOV], axis=2))
    move = time_move(path, (0.0, path.end), CEILING)
    assert max(uses(move.curve, CEILING).values()) <= 1.0
    assert move.scale < 1.03


def test_a_path_along_the_end_of_the_gimbal_s_range_is_flown_within_it():
    # Pitch rises to 0.3 rad and stays: what is flown must not swing over by the least bit.
    s = np.linspace(0.0, 30.0, 4)
    pitch = np.array([0.0, 0.3, 0.3, 0.3])
    value = np.column_stack([s, 0 * s, 0 * s + 10, 0 * s, pitch, 0 * s, 0 * s + HFOV])
    slope = np.zeros_like(value)
    slope[:, 0] = 1.0
    path = quintic_hermite(s, value, slope, np.zeros_like(value))
    narrow = replace(CEILING, pitch=(-0.5, 0.3))
    move = time_move(path, (0.0, 30.0), narrow)
    t = np.linspace(0.0, move.duration, 20_001)
    assert move.curve(t)[:, 4].max() <= 0.3 + 2e-7


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(4))
def test_the_flown_quintics_stay_on_the_path(seed: int):
    path = smooth(seed)
    move = time_move(path, (0.0, path.end), CEILING)
    assert not straying(path, move.profile, move.curve, CEILING).any()
    # And of themselves: the nearest point of the path to any flown position is a millimetre away.
    t = np.linspace(0.0, move.duration, 400)
    near = path(np.linspace(0.0, path.end, 200_001))[:, :3]
    for p in move.curve(t)[::20, :3]:
        assert np.linalg.norm(near - p, axis=1).min() < 2e-3


@pytest.mark.parametrize("seed", range(3))
def test_the_bound_of_a_share_is_no_less_than_any_sample_and_close(seed: int):
    path = smooth(seed)
    move = time_move(path, (0.0, path.end), CEILING)
    dense = uses(move.curve, CEILING)
    proved: dict[str, float] = {}
    for usage in usages(move.curve, axes_of(path, (0.0, path.end), CEILING)):
        proved[usage.name] = max(proved.get(usage.name, 0.0), float(usage.share.max()))
    for name, share in dense.items():
        assert share <= proved[name] + 1e-12
        assert proved[name] <= share + 0.01 * max(share, 0.1)


def test_part_of_a_path_is_timed_like_a_path_of_its_own():
    path = smooth(5)
    span = (0.25 * path.end, 0.75 * path.end)
    move = time_move(path, span, CEILING)
    assert move.curve(0.0) == pytest.approx(path(span[0]))
    assert move.curve(move.duration) == pytest.approx(path(span[1]))
    assert max(uses(move.curve, CEILING).values()) <= 1.0


def test_a_kink_in_the_third_derivative_is_no_surprise():
    # Straight, then an arc with a C2 but not C3 transition, laid with few pieces.
    s = np.array([0.0, 15.0, 22.0, 40.0])
    x = np.array([0.0, 15.0, 21.0, 27.0])
    y = np.array([0.0, 0.0, 3.0, 20.0])
    value, rate, bend = np.zeros((4, 7)), np.zeros((4, 7)), np.zeros((4, 7))
    value[:, 0], value[:, 1], value[:, 6] = x, y, HFOV
    rate[:, 0], rate[:, 1] = [1, 1, 0.7, 0.2], [0, 0, 0.7, 1.0]
    bend[2, 1] = 0.05
    path = quintic_hermite(s, value, rate, bend)
    move = time_move(path, (0.0, 40.0), CEILING)
    assert max(uses(move.curve, CEILING).values()) <= 1.0
    assert move.scale < 1.03


def test_stretching_slows_evenly():
    path = smooth(1)
    move = time_move(path, (0.0, path.end), CEILING)
    slow = move.stretched(2.0)
    assert slow.duration == pytest.approx(2 * move.duration)
    t = np.linspace(0.0, move.duration, 50)
    assert slow.curve(2 * t) == pytest.approx(move.curve(t))
    assert fly(path, slow.profile).ctrl == pytest.approx(slow.curve.ctrl)


def test_cell_times_are_exact_for_constant_jerk():
    # s = 2 t^3 / 6 + 0.5 t^2 from t = 0.3, cut at four instants.
    t = np.array([0.3, 0.5, 0.9, 1.0])
    s, v, a = t**3 / 3 + t**2 / 2, t**2 + t, 2 * t + 1
    assert cell_times(np.diff(s), v**2, a) == pytest.approx(np.diff(t), rel=1e-12)
    # From rest.
    t = np.array([0.0, 0.4])
    assert cell_times(np.diff(t**3), 9 * t**4, 6 * t) == pytest.approx(np.diff(t), rel=1e-12)


@pytest.mark.slow
@pytest.mark.parametrize(
    "path",
    [
        pytest.param(line(HERE, at(1e-6)), id="a micrometre"),
        pytest.param(line(HERE, at(5000.0)), id="five kilometres"),
        pytest.param(line(HERE, at(yaw=1e-6)), id="a microradian on the spot"),
        pytest.param(line(HERE, at(yaw=50.0)), id="eight turns on the spot"),
        pytest.param(line(HERE, at(1.0, yaw=20.0)), id="a pirouette"),
        pytest.param(circle(0.05, 2 * pi), id="a tiny circle"),
        pytest.param(circle(3000.0, 2 * pi), id="a huge circle"),
        pytest.param(smooth(1, points=40), id="forty points"),
    ],
)
def test_paths_of_any_size_are_timed_within_the_limits(path: Piecewise):
    move = time_move(path, (0.0, path.end), CEILING)
    assert max(uses(move.curve, CEILING, samples=20).values()) <= 1.0
    assert move.scale < 1.03
    assert np.diff(move.curve.breaks).min() > 1e-6


@pytest.mark.slow
@pytest.mark.parametrize("jerk", [1e-3, 0.1, 1e3])
def test_any_jerk_limit_will_do(jerk: float):
    ceiling = replace(CEILING, jerk=jerk)
    path = smooth(1)
    move = time_move(path, (0.0, path.end), ceiling)
    assert max(uses(move.curve, ceiling).values()) <= 1.0
    assert move.scale < 1.03


def test_topp_ra_bounds_what_the_jerk_limit_leaves():
    path = smooth(4)
    move = time_move(path, (0.0, path.end), CEILING)
    limits = axes_of(path, (0.0, path.end), CEILING)
    quickest = fastest(topp_limits(sample(path, move.profile.s), limits))
    assert quickest.status is Status.SOLVED
    # The fastest profile is the upper envelope of all. Its accelerations are constant in each cell and
    # hold at both ends of it, which costs it some speed where they change; 32 corners cost 0.1 %.
    ratio = move.profile.sd[1:-1] ** 2 / quickest.b[1:-1]
    assert ratio.max() < 1.15
    assert np.median(ratio) < 1.02


def test_the_same_path_gives_the_same_bytes():
    path = smooth(2)
    a, b = (time_move(path, (0.0, path.end), CEILING) for _ in range(2))
    assert a.curve.ctrl.tobytes() == b.curve.ctrl.tobytes()
    assert a.curve.breaks.tobytes() == b.curve.breaks.tobytes()


def test_places_to_be_passed_are_passed_exactly():
    path = smooth(7)
    places = (0.31 * path.end, 0.5 * path.end, 0.8 * path.end)
    move = time_move(path, (0.0, path.end), CEILING, places)
    assert set(places) <= set(move.profile.s)
    for place in places:
        at = move.curve.breaks[list(move.profile.s).index(place)]
        assert move.curve(at) == pytest.approx(path(place), abs=1e-12)
        assert path.derivative()(place) @ move.curve.derivative()(at) > 0
