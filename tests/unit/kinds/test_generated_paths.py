"""Kinds that generate paths: their keyframes, by the definitions of bearing, radius and altitude."""

from __future__ import annotations

from itertools import pairwise
from math import atan2, cos, degrees, dist, hypot, pi, radians, sin

import pytest
from hypothesis import given
from hypothesis import strategies as st

from shotc.ir.mission import Keyframe
from shotc.kinds.rounds import LARGEST_ARC_RAD, bearing, line, ring
from tests.support.front_passes import resolved

HEAD = """\
shotc: 1
mission: kinds
targets:
  tower: {at: [10, 20, 12], radius: 4, height: 24}
  pond: {at: [-30, 5, 0.5], radius: 8, height: 1}
drones:
  cam1: {model: x500, home: [0, -60, 0], radius: 0.5}
rules: {composition: center}
shots:
"""


def keyframes(shot: str) -> tuple[Keyframe, ...]:
    mission, found = resolved(HEAD + f"  - {{id: a, drone: cam1, {shot}}}\n")
    assert not found, found
    assert mission is not None
    return mission.shots[0].keyframes


def azimuth(k: Keyframe) -> float:
    return degrees(atan2(k.at[0] - 10, k.at[1] - 20)) % 360


def radius(k: Keyframe) -> float:
    return hypot(k.at[0] - 10, k.at[1] - 20)


def test_bearings_count_clockwise_from_north() -> None:
    axis = (1.0, 2.0, 0.0)
    assert bearing(axis, 0.0, 5.0, 3.0) == pytest.approx((1.0, 7.0, 3.0))
    assert bearing(axis, pi / 2, 5.0, 3.0) == pytest.approx((6.0, 2.0, 3.0))
    assert bearing(axis, pi, 5.0, 3.0) == pytest.approx((1.0, -3.0, 3.0))


def test_an_orbit_is_a_circle_counter_clockwise_from_its_start() -> None:
    found = keyframes("kind: orbit, target: tower, radius: 50, altitude: 20, start_azimuth: 90 deg")
    assert len(found) == 25
    assert all(radius(k) == pytest.approx(50) and k.at[2] == 20 for k in found)
    assert found[0].at == pytest.approx((60, 20, 20))
    # Counter-clockwise seen from above: from East to North, so the bearing falls.
    assert azimuth(found[1]) == pytest.approx(75)
    assert found[-1].at == pytest.approx(found[0].at)
    assert all(k.target == "tower" and k.aim is None and not k.placed for k in found)
    assert found[0].composition.name == "center"


def test_a_negative_sweep_runs_clockwise() -> None:
    found = keyframes("kind: orbit, target: tower, radius: 50, altitude: 20, sweep: -90 deg")
    assert [azimuth(k) for k in found] == pytest.approx([0, 15, 30, 45, 60, 75, 90])


def test_a_turn_by_nothing_is_blamed_on_the_sweep() -> None:
    shot = "kind: orbit, drone: cam1, target: tower, radius: 50, altitude: 20, sweep: 0 deg"
    (fault,) = resolved(HEAD + f"  - {{id: a, {shot}}}\n")[1]
    assert fault.code == "K010"
    assert "give `sweep` an angle" in fault.help


def test_a_pair_for_an_orbit_proposes_a_spiral() -> None:
    shot = "kind: orbit, drone: cam1, target: tower, radius: 50, altitude: [10, 40]"
    (fault,) = resolved(HEAD + f"  - {{id: a, {shot}}}\n")[1]
    assert fault.code == "S007"
    assert "`kind: spiral`" in fault.help


@pytest.mark.parametrize(
    ("drift", "way"), [("[12, 0, 0]", "across"), ("[0, 0, 5]", "up"), ("[0, 0, -4]", "down")]
)
def test_a_drift_that_no_drone_keeps_up_names_one_that_it_does(drift: str, way: str) -> None:
    shot = (
        f"kind: top-down, drone: cam1, target: tower, altitude: 60, timing: {{duration: 20}}, drift: {drift}"
    )
    (fault,) = resolved(HEAD + f"  - {{id: a, {shot}}}\n")[1]
    assert fault.code == "K012"
    assert way in fault.message
    most = float(fault.help.split("less than ")[1].split(" m/s")[0])
    slower = (
        "["
        + ", ".join(f"{most * (float(c) > 0) - most * (float(c) < 0):.3f}" for c in drift[1:-1].split(","))
        + "]"
    )
    found = resolved(HEAD + f"  - {{id: a, {shot.replace(drift, slower)}}}\n")[1]
    assert "K012" not in {d.code for d in found}
    assert "K004" not in {d.code for d in found}


def test_a_spiral_changes_radius_and_altitude_evenly() -> None:
    found = keyframes("kind: spiral, target: tower, radius: [45, 65], altitude: [10, 40], sweep: 300 deg")
    assert len(found) == 21
    assert [radius(k) for k in found] == pytest.approx([45 + i for i in range(21)])
    assert [k.at[2] for k in found] == pytest.approx([10 + 1.5 * i for i in range(21)])


def test_an_elevator_only_rises() -> None:
    found = keyframes("kind: elevator, target: tower, azimuth: 180 deg, distance: 50, altitude: [5, 30]")
    assert all(k.at[:2] == pytest.approx((10, -30)) for k in found)
    assert (found[0].at[2], found[-1].at[2]) == (5, 30)
    assert all(a.at[2] < b.at[2] for a, b in pairwise(found))


def test_a_dolly_only_comes_closer() -> None:
    found = keyframes("kind: dolly, target: tower, azimuth: 90 deg, distance: [60, 45], altitude: 15")
    assert all(k.at[1:] == pytest.approx((20, 15)) for k in found)
    assert (found[0].at[0], found[-1].at[0]) == pytest.approx((70, 55))


def test_a_crane_moves_both_ways_in_one_line() -> None:
    found = keyframes("kind: crane, target: tower, azimuth: 0 deg, distance: [60, 50], altitude: [5, 35]")
    assert all(k.at[0] == pytest.approx(10) for k in found)
    assert (found[0].at[1], found[-1].at[1]) == pytest.approx((80, 70))
    assert all((k.at[2] - 5) / 30 == pytest.approx((80 - k.at[1]) / 10) for k in found)


def test_a_crane_may_keep_its_distance() -> None:
    found = keyframes("kind: crane, target: tower, azimuth: 0 deg, distance: 50, altitude: [5, 35]")
    assert all(radius(k) == pytest.approx(50) for k in found)


@pytest.mark.slow
@given(st.floats(-20 * pi, 20 * pi), st.floats(-pi, pi), st.floats(1, 100), st.floats(1, 100))
def test_rings_turn_by_their_sweep_in_small_even_steps(
    sweep: float, start: float, r0: float, r1: float
) -> None:
    points = ring((0.0, 0.0, 0.0), start, sweep, (r0, r1), (5.0, 9.0))
    n = len(points) - 1
    assert abs(sweep) / n <= LARGEST_ARC_RAD + 1e-9
    for i, p in enumerate(points):
        a = start - sweep * i / n
        r = r0 + (r1 - r0) * i / n
        assert p == pytest.approx((r * sin(a), r * cos(a), 5 + 4 * i / n), abs=1e-9)


@pytest.mark.slow
@given(
    st.tuples(st.floats(5, 100), st.floats(5, 100)),
    st.tuples(st.floats(2, 100), st.floats(2, 100)),
    st.floats(0, 40),
)
def test_lines_are_straight_and_end_where_they_should(
    distance: tuple[float, float], altitude: tuple[float, float], height: float
) -> None:
    points = line((0.0, 0.0, 0.0), radians(90), distance, altitude, height)
    assert points[0] == pytest.approx((distance[0], 0, altitude[0]), abs=1e-9)
    assert points[-1] == pytest.approx((distance[1], 0, altitude[1]), abs=1e-9)
    whole = dist(points[0], points[-1])
    steps = [dist(a, b) for a, b in pairwise(points)]
    assert sum(steps) == pytest.approx(whole, abs=1e-6)
    assert max(steps) <= whole / 4 + 1e-9


def test_a_view_from_above_that_tilts_has_its_target_ahead() -> None:
    """Behind it, the picture turned over on the way, since no gimbal tilts past the vertical."""
    first, last = keyframes(
        "kind: top-down, target: pond, altitude: 40, drift: [0.6, 0.8, 0], timing: {duration: 10}, "
        "composition: thirds-first"
    )
    assert first.aim == last.aim == pytest.approx((atan2(-0.8, -0.6), -pi / 2))


def test_a_view_from_above_looks_down_along_its_drift() -> None:
    still = keyframes("kind: top-down, target: pond, altitude: 40")
    assert [k.at for k in still] == [(-30, 5, 40)]
    assert still[0].hold == 5
    assert still[0].aim == pytest.approx((pi / 2, -pi / 2))
    first, last = keyframes(
        "kind: top-down, target: pond, altitude: 40, drift: [0.6, 0.8, 0.1], timing: {duration: 10}"
    )
    assert first.at == (-30, 5, 40)
    assert last.at == pytest.approx((-24, 13, 41))
    assert first.aim == pytest.approx((atan2(0.8, 0.6), -pi / 2))
    assert first.hold == last.hold == 0
    assert first.composition.watches
