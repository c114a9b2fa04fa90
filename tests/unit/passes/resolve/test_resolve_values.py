"""What resolve gives: presets, wind, places, timings and promises, as the mission says."""

from __future__ import annotations

import subprocess
import sys
from math import degrees, inf, radians

import pytest
from hypothesis import given
from hypothesis import strategies as st

from shotc.geom.solids import Cylinder, Prism
from shotc.ir.limits import Limits, Timing, Vec3
from shotc.ir.mission import MissionIR
from shotc.ir.promise import Promise
from shotc.passes.resolve.checks.motion import least_shot, least_travel
from shotc.spec.presets import PRESETS
from tests.support import resolve_missions
from tests.support.front_passes import resolved
from tests.support.records import replace
from tests.support.resolve_missions import at, faults, span

TEXT = """\
shotc: 1
mission: values
world:
  origin: {lat: 47.3769, lon: 8.5417, alt: 408}
  wind: 3 m/s
  zones:
    tree: {keep: out, cylinder: {center: [-30, 20], radius: 3, height: [0, 12]}}
    box: {keep: out, box: {center: {lat: 47.3769, lon: 8.5417, height: 44}, size: [2, 4, 8], heading: 90 deg}}
targets:
  tower: {at: {lat: 47.3769, lon: 8.5417, height: 12}, radius: 4, height: 24}
drones:
  cam1:
    model: mini
    home: [0, -60, 0]
    limits: {speed: 36 km/h, yaw_rate: 30 deg/s}
    gimbal: {pitch: [-80 deg, 10 deg]}
    camera: {sensor: 36 mm, focal_length: 25 mm, aspect: "4:3"}
    endurance: 10 min
  cam2: {home: [6, -60, 0]}
rules: {composition: phi, separation: 4, ground_clearance: 1, target_clearance: 2, pace: calm}
shots:
  - {id: a, kind: static, drone: cam1, at: [0, -70, 15], look_at: tower, timing: {start: 30, duration: 8},
     pace: brisk, require: {in_frame: 95 %, screen_error: 0.1, size: [0.1, 0.9]}, refine: {optional: true}}
  - {id: b, kind: static, drone: cam1, target: tower, at: [70, 0, 15], look_at: tower, timing: {after: a},
     composition: keep}
output: {rate: 25, emit: [csv]}
"""


@pytest.fixture(scope="module")
def mission() -> MissionIR:
    value, found = resolved(TEXT)
    assert found == []
    assert value is not None
    return value


def test_the_mission_itself(mission: MissionIR) -> None:
    assert (mission.name, mission.rate, mission.emit, mission.wind) == ("values", 25, ("csv",), 3)
    assert mission.origin is not None
    assert (mission.origin.lat_deg, mission.origin.lon_deg, mission.origin.alt) == (47.3769, 8.5417, 408)
    assert (mission.rules.separation, mission.rules.ground_clearance, mission.rules.target_clearance) == (
        4,
        1,
        2,
    )
    assert len(mission.source_sha256) == 64
    assert mission.deferred == ()


def test_drones_override_their_presets_and_lose_the_wind(mission: MissionIR) -> None:
    drone, preset = mission.drone("cam1"), PRESETS["mini"]
    assert drone.limits == replace(
        preset.limits, speed=pytest.approx(7.0), yaw_rate=pytest.approx(radians(30))
    )
    assert drone.gimbal == replace(preset.gimbal, pitch=pytest.approx((radians(-80), radians(10))))
    assert degrees(drone.hfov) == pytest.approx(71.51, abs=0.01)
    assert drone.aspect == pytest.approx(4 / 3)
    assert (drone.endurance, drone.radius, drone.body) == (600, preset.radius, preset.body)
    other = mission.drone("cam2")
    assert (other.model, other.limits.speed) == ("x500", PRESETS["x500"].limits.speed - 3)


def test_places_and_solids(mission: MissionIR) -> None:
    assert mission.target("tower").centre == pytest.approx((0, 0, 12), abs=1e-9)
    tree, house = (z.solid for z in mission.zones)
    assert tree == Cylinder((-30, 20), 3, 0, 12)
    assert isinstance(house, Prism)
    assert (house.bottom, house.top) == pytest.approx((40, 48))
    xs, ys = zip(*house.points, strict=True)
    assert (max(xs), max(ys)) == pytest.approx((2, 1))  # turned by 90 deg: the depth lies east


def test_shots(mission: MissionIR) -> None:
    a, b = mission.shots
    assert a.timing == Timing(30, None, 8)
    assert b.timing == Timing(None, "a", None)
    assert (a.pace, b.pace) == (1.0, 0.5)
    assert a.promise == Promise(0.95, 0.1, (0.1, 0.9))
    assert b.promise == Promise()
    assert (a.refine_optional, b.refine_optional) == (True, False)
    assert (a.subject, b.subject) == (None, "tower")
    assert (a.keyframes[0].composition.name, b.keyframes[0].composition.keep) == ("phi", True)


LIMITS = Limits(8.0, 4.0, 2.0, 3.0, 8.0, 1.0, 1.0)


def test_the_least_time_from_rest_to_rest() -> None:
    assert least_travel([(0, 0, 0), (80, 0, 0)], LIMITS) == pytest.approx(80 / 8 + 8 / 3)
    assert least_travel([(0, 0, 0), (12, 0, 0)], LIMITS) == pytest.approx(4.0)  # never at full speed
    assert least_travel([(0, 0, 0), (80, 0, 0)], LIMITS, rests=False) == pytest.approx(10)
    assert least_travel([(0, 0, 0), (0, 0, 40)], LIMITS) == pytest.approx(40 / 4 + 4 / 3)
    assert least_travel([(0, 0, 40), (0, 0, 0)], LIMITS) == pytest.approx(40 / 2 + 2 / 3)
    assert least_travel([(0, 0, 0), (0, 0, 40), (0, 0, 0)], LIMITS) == pytest.approx(30)
    assert least_travel([(0, 0, 0)], LIMITS) == 0


positions = st.tuples(st.floats(-50, 50), st.floats(-50, 50), st.floats(0, 50))


@pytest.mark.slow
@given(positions, positions)
def test_a_straight_trapezoidal_flight_is_never_faster_than_the_bound(p: Vec3, q: Vec3) -> None:
    # Fly straight with each axis scaled to its own limit: a feasible flight, so the bound lies below it.
    across = ((q[0] - p[0]) ** 2 + (q[1] - p[1]) ** 2) ** 0.5
    rise = q[2] - p[2] if abs(q[2] - p[2]) > 1e-9 else 0.0
    way = (across**2 + rise**2) ** 0.5
    if way < 1e-6:
        return
    speed = min(
        8.0 / (across / way) if across else inf,
        (4.0 if rise > 0 else 2.0) / (abs(rise) / way) if rise else inf,
    )
    flown = way / speed + speed / 3 if way * 3 > speed**2 else 2 * (way / 3) ** 0.5
    assert least_travel([p, q], LIMITS) <= flown + 1e-9


def test_holds_cut_a_shot_into_rests(mission: MissionIR) -> None:
    k = mission.shots[0].keyframes[0]
    three = [replace(k, at=(x, 0.0, 9.0), hold=h) for x, h in ((0.0, 0.0), (80.0, 2.0), (160.0, 0.0))]
    assert least_shot(three, LIMITS) == pytest.approx(2 * (10 + 8 / 3) + 2)
    assert least_shot([replace(k, hold=0.0) for k in three], LIMITS) == pytest.approx(20 + 8 / 3)
    assert least_shot(three[1:2], LIMITS) == 2


@pytest.mark.slow
def test_the_front_loads_neither_numpy_nor_a_solver() -> None:
    code = (
        "import sys; from tests.support.front_passes import placed; placed(sys.argv[1]); "
        "heavy = {'numpy', 'scipy', 'cvxpy', 'toppra', 'rerun', 'casadi'}; "
        "print(sorted(heavy & set(sys.modules)))"
    )
    found = subprocess.run([sys.executable, "-c", code, TEXT], capture_output=True, text=True, check=True)
    assert found.stdout.strip() == "[]"


@pytest.mark.parametrize(
    ("limits", "told"),
    [
        ("speed: 16", []),
        ("speed: 16.1", ["speed"]),
        ("speed: 50 km/h", []),
        ("speed: 50", ["speed"]),
        ("climb: 7, descent: 4, acceleration: 7", ["climb", "descent", "acceleration"]),
        ("jerk: 90, yaw_rate: 300 deg/s", []),
    ],
)
def test_a_limit_of_more_than_twice_the_named_models_is_told_and_taken(limits: str, told: list[str]) -> None:
    text = resolve_missions.mission(at(0, -50, 15)).replace(
        "limits: {speed: 8, climb: 4, descent: 3, acceleration: 3}", "LIMITS"
    )
    text = text.replace("LIMITS", f"limits: {{{limits}}}")
    found = faults(text)
    assert [(d.code, d.message.split("`")[1]) for d in found] == [("K015", key) for key in told]
    for d, key in zip(found, told, strict=True):
        line, column, _ = span(d)
        assert text.splitlines()[line - 1][: column - 1].endswith(f"{key}: ")
    assert faults(text.replace("model: x500, ", "")) == []
    value, _ = resolved(text)
    assert value is not None
    if "speed: 50" in limits and told:
        assert value.drones[0].limits.speed == 50


def test_the_limits_of_a_fleet_are_told_too() -> None:
    text = """\
shotc: 1
mission: show
fleets:
  swarm: {count: 4, layout: {grid: {spacing: 4}}, model: show-drone, limits: {speed: 11 m/s}}
shots:
  - {id: s, kind: display, fleet: swarm, frames: [{sphere: {center: [0, 0, 40], radius: 8}, hold: 4}]}
"""
    assert [d.code for d in resolved(text)[1]] == ["K015"]
    assert resolved(text.replace("11 m/s", "10 m/s"))[1] == []
