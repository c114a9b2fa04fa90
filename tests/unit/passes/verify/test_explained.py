"""What explains that a shot is elsewhere than was asked: things by numbers, and none that is not there."""

from __future__ import annotations

import json
from importlib import import_module
from math import hypot, inf
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from shotc import api
from shotc.geom.shapes import CylinderShape
from shotc.geom.solids import Cylinder
from shotc.geom.track import Track
from shotc.ir.mission import MissionIR, Zone
from shotc.ir.path import PathDeviation
from shotc.ir.target import Target
from shotc.passes.verify.claims import JudgedFlight
from shotc.passes.verify.explained import (
    NEAR_M,
    ExpectedPlaces,
    believed,
    farthest,
    for_its_limits,
    for_the_picture,
    in_the_way,
)
from tests.support.compiled import compiled_text
from tests.support.film_plans import orbit_plan
from tests.support.mesh_spaces import with_meshes
from tests.support.records import replace
from tests.support.resealed_plans import Document, resealed
from tests.support.scenes import house

shots = import_module("shotc.passes.verify.shots")
EAST = ExpectedPlaces(np.linspace([-50.0, 0.0, 30.0], [50.0, 0.0, 30.0], 101), np.linspace(0.0, 20.0, 101))


def flight(*zones: Zone, **rules: object) -> JudgedFlight:
    plan = orbit_plan().trajectory
    mission: MissionIR = plan.keyframes.mission
    mission = replace(mission, zones=zones, targets=(), rules=replace(mission.rules, **rules))
    return JudgedFlight(mission, mission.drones[0], plan.drones[0])


def mast(y: float, keep: str = "out", radius: float = 3.0) -> Zone:
    return Zone("mast", keep, Cylinder((0.0, y), radius, 0.0, 40.0), ("world", "zones", "mast"))  # type: ignore[arg-type]


def test_what_stands_there_explains_as_much_as_it_takes_to_go_round_it() -> None:
    one = flight(mast(2.0))
    assert in_the_way(one, EAST) == {"zone mast": 40.0 + 2.0 * (one.drone.radius + NEAR_M)}
    assert in_the_way(flight(mast(3.0 + one.drone.radius + NEAR_M + 0.1)), EAST) == {}
    assert in_the_way(one, EAST, placed=True) == {}


def test_around_a_solid_that_is_wider_than_tall_the_detour_is_its_width() -> None:
    one = flight(mast(2.0, radius=30.0))
    body = one.drone.radius + NEAR_M
    assert in_the_way(one, EAST) == {"zone mast": pytest.approx(60.0 + 2.0 * body)}


def test_a_fence_and_the_ground_explain_what_the_way_is_beyond_them() -> None:
    one = flight(mast(0.0, "in", 20.0), ground_clearance=29.0)
    body = one.drone.radius + NEAR_M
    found = in_the_way(one, EAST)
    assert found["zone mast"] == pytest.approx(30.0 + body)
    assert found["ground"] == pytest.approx(29.0 + body - 30.0)


def test_a_cause_that_is_not_there_is_not_believed() -> None:
    told = [PathDeviation("a", 9.0, 0.0, "zone wall"), PathDeviation("a", 4.0, 0.0, "zone mast")]
    told.append(PathDeviation("a", 2.0, 0.0, "the drone's limits"))
    assert believed(told, {"zone mast": 5.0}) == [4.0, 2.0]


@pytest.mark.parametrize(
    ("cause", "thing"),
    [("building Town hall", "buildings"), ("scene arch", "scene"), ("buildings", "buildings")],
)
def test_a_building_is_one_of_the_buildings(cause: str, thing: str) -> None:
    told = [PathDeviation("a", 9.0, 0.0, cause)]
    assert believed(told, {thing: 20.0}) == [9.0]
    assert believed(told, {"zone mast": 20.0}) == []


def test_pictures_move_a_placed_camera_only_for_other_drones() -> None:
    alone = flight().mission
    both = replace(alone, drones=alone.drones * 2)
    assert for_the_picture(alone, 10.0, placed=False) == 5.0
    assert for_the_picture(alone, 10.0, placed=True) == 0.0
    strict = replace(alone, rules=replace(alone.rules, visibility="require"))
    assert for_the_picture(strict, 10.0, placed=True) == 0.0
    for strength, most in (("off", 0.0), ("prefer", 2.0), ("require", 5.0)):
        mission = replace(both, rules=replace(both.rules, visibility=strength))
        assert for_the_picture(mission, 10.0, placed=True) == most


def test_limits_explain_the_way_to_stop_and_what_is_too_fast() -> None:
    one = flight()
    limits = replace(one.drone.limits, speed=4.0, climb=inf, acceleration=2.0, jerk=8.0)
    slow = JudgedFlight(one.mission, replace(one.drone, limits=limits), one.track)
    held_back = 1.0 * 20.0 + 4.0**2 / 4.0 + 4.0 * 2.0 / 8.0
    assert for_its_limits(slow, EAST, 0.5) == pytest.approx(held_back)
    assert for_its_limits(slow, EAST, 1.5) == pytest.approx(held_back + 4.0 * 1.0)
    still = ExpectedPlaces(np.zeros((5, 3)), np.arange(5.0))
    assert for_its_limits(slow, still, 1.5) == 0.0


def test_wind_from_ahead_makes_a_course_too_fast_and_rise_counts_in_both_directions() -> None:
    one = flight()
    limits = replace(
        one.drone.limits, speed=4.0, climb=1.0, descent=0.5, acceleration=2.0, jerk=8.0, wind=(-1.0, 3.0)
    )
    slow = JudgedFlight(one.mission, replace(one.drone, limits=limits), one.track)
    times = np.linspace(0.0, 10.0, 101)
    for rise, slower in ((2.0, 1.0), (-2.0, 1.5)):
        places = times[:, None] * np.array([3.0, 0.0, rise])
        fastest = min(3.0, limits.fastest) + 1.0
        stops = fastest**2 / (2.0 * limits.usable_acceleration) + fastest * limits.usable_acceleration / 8.0
        behind = 10.0 * hypot(5.0 - 4.0, slower)
        assert for_its_limits(slow, ExpectedPlaces(places, times), 0.5) == pytest.approx(behind + stops)


@pytest.mark.parametrize("axis", [0, 1])
def test_wind_from_any_side_that_is_against_a_course_holds_a_drone_back(axis: int) -> None:
    one, ahead = flight(), np.eye(3)[axis]
    wind = tuple((-2.0 * ahead[:2]).tolist())
    limits = replace(one.drone.limits, speed=5.0, acceleration=2.0, jerk=8.0, wind=wind)
    slow = JudgedFlight(one.mission, replace(one.drone, limits=limits), one.track)
    times = np.linspace(0.0, 10.0, 101)
    against, along = (
        for_its_limits(slow, ExpectedPlaces(times[:, None] * way * 4.0 * ahead, times), 0.5)
        for way in (1.0, -1.0)
    )
    assert against - along == pytest.approx(10.0 * (4.0 + 2.0 - 5.0))


def body(name: str, centre: tuple[float, float, float], *, moves: bool) -> Target:
    there = (centre[0] + 4.0, centre[1], centre[2])
    track = Track((0.0, 20.0), (centre, there)) if moves else None
    return Target(name, centre, CylinderShape(1.0, 6.0), ("targets", name), track)


def test_a_target_stands_in_the_way_where_it_is_when_the_drone_comes_by() -> None:
    """It crosses the course from south to north, in time or late."""
    one = flight()
    for first, meets in ((-40.0, True), (0.0, False)):
        track = Track((0.0, 20.0), ((0.0, first, 30.0), (0.0, first + 80.0, 30.0)))
        boat = Target("boat", (0.0, first, 30.0), CylinderShape(2.0, 4.0), ("targets", "boat"), track)
        crossed = JudgedFlight(replace(one.mission, targets=(boat,)), one.drone, one.track)
        assert ("target boat" in in_the_way(crossed, EAST)) is meets


def test_targets_explain_the_way_round_them_where_they_are_then() -> None:
    one = flight()
    near = one.mission.rules.target_clearance + one.drone.radius + NEAR_M
    beside = 1.0 + near
    # EAST passes x = 0 at 10 s, when what moves is 2 m further.
    for moves in (False, True):
        for aside, met in ((beside - 0.1, True), (beside + 0.1, False)):
            targets = (
                body("far", (0.0, 500.0, 30.0), moves=False),
                body("it", (0.0, aside, 30.0), moves=moves),
            )
            there = replace(one, mission=replace(one.mission, targets=targets))
            expected = {"target it": 6.0 + 2.0 * near} if met else {}
            assert in_the_way(there, EAST) == pytest.approx(expected)
            assert in_the_way(there, EAST, placed=True) == (pytest.approx(expected) if moves else {})
            assert in_the_way(there, EAST._replace(times=None)) == ({} if moves else pytest.approx(expected))


def test_the_fastest_stretch_of_a_course_tells_how_long_it_takes_to_stop() -> None:
    one = flight()
    limits = replace(one.drone.limits, speed=9.0, climb=2.0, descent=2.0, acceleration=2.0, jerk=8.0)
    free = JudgedFlight(one.mission, replace(one.drone, limits=limits), one.track)
    steps = np.array([[1.0, 0.0, 0.0], [3.0, 0.0, 0.5], [2.0, 0.0, -1.5]])
    course = ExpectedPlaces(np.vstack([np.zeros(3), np.cumsum(steps, axis=0)]), np.arange(4.0))
    fastest = 3.0 + 1.5
    stops = fastest**2 / (2.0 * limits.usable_acceleration) + fastest * limits.usable_acceleration / 8.0
    assert for_its_limits(free, course, 0.5) == pytest.approx(stops)


def test_another_drone_that_passes_explains_the_way_round_it() -> None:
    one = flight()
    near = one.mission.rules.separation + NEAR_M
    beside = replace(one, others=(replace(one.track, drone="other"),))
    times = np.linspace(one.track.curve.start, one.track.curve.end, 40)
    there = one.track.curve(times)[:, :3]
    for away, met in ((near - 0.1, True), (near + 0.1, False)):
        # It comes as near as that at one time alone.
        off = np.where(np.arange(40) == 25, away, away + 30.0)[:, None] * np.array([0.6, 0.8, 0.0])
        course = ExpectedPlaces(there + off, times)
        found = in_the_way(beside, course, placed=True)
        assert found == ({"drone other": pytest.approx(2.0 * near)} if met else {})
        assert in_the_way(beside, course._replace(times=None), placed=True) == {}


def test_a_target_that_goes_along_is_as_far_as_it_is_then() -> None:
    east = ((-50.0, 8.0, 30.0), (50.0, 8.0, 30.0))
    runner = Target("it", (-50.0, 8.0, 30.0), CylinderShape(1.0, 6.0), (), Track((0.0, 20.0), east))
    mission = replace(flight().mission, targets=(runner, body("post", (50.0, 0.0, 30.0), moves=False)))
    assert farthest(mission, ("it",), EAST) == pytest.approx(8.0)
    assert farthest(mission, ("post",), EAST) == pytest.approx(100.0)
    assert farthest(mission, ("it", "post"), EAST) == pytest.approx(8.0)
    assert farthest(mission, ("it",), EAST._replace(times=None)) == pytest.approx(hypot(100.0, 8.0))


def test_what_films_nobody_counts_as_ten_metres_away() -> None:
    assert farthest(flight().mission, (), EAST) == 10.0


STANDS = """\
shotc: 1
mission: stands
targets:
  runner: {track: {start: [-10, 0, 0.9], velocity: [2, 0, 0]}, radius: 0.4, height: 1.8}
drones:
  cam1: {model: x500, home: [0, -30, 0]}
shots:
  - {id: watch, kind: static, drone: cam1, look_at: runner, at: [0, -20, 6],
     timing: {start: 10, duration: 6}}
"""


@pytest.mark.slow
def test_a_camera_that_was_placed_stands_there() -> None:
    done = api.compile_source(STANDS.encode(), "stands.yaml", None, api.PlanOptions(refiner="none"))
    assert done.plan is not None, done.diagnostics
    document: Document = json.loads(api.emit_plan(done.plan, []).artifacts[0].data)
    assert limit_of(document) == 0.01
    (flown,) = document["drones"]
    document["deviations"] = [{"shot": "watch", "distance": 5.0, "s": 12.0, "cause": "the drone's limits"}]
    for point in (p for piece in flown["curve"]["control"] for p in piece):
        point[0] += 0.05
    data = resealed(document)
    assert limit_of(json.loads(data)) == 0.01
    assert "V044" in {d.code for d in api.verify_plan(data, "plan.json").diagnostics}


def limit_of(document: Document) -> float:
    (found,) = (c for c in document["certificate"] if c["constraint"] == "distance from its place")
    assert found["hard"]
    return float(found["limit"])


def test_houses_explain_as_much_as_it_takes_to_go_over_or_round_what_is_near() -> None:
    one = flight()
    near = one.mission.rules.beside_obstacle(one.drone.radius) + NEAR_M
    row = [house(8.0, 6.0, 31.0, 33.0) + np.array([10.0 * k, 0.0, 0.0]) for k in range(3)]
    far = house(300.0, 300.0, 31.0, 33.0) + np.array([0.0, 900.0, 0.0])
    there = replace(one, mission=with_meshes(one.mission, *row, far))
    wide = np.hypot(28.0 + 2.0 * near, 6.0 + 2.0 * near)
    assert in_the_way(there, EAST) == {"scene": pytest.approx(wide + 2.0 * near)}
    assert in_the_way(replace(one, mission=with_meshes(one.mission, far)), EAST) == {}
    told = [PathDeviation("a", 9.0, 0.0, "scene"), PathDeviation("a", 4.0, 0.0, "buildings")]
    assert believed(told, in_the_way(there, EAST)) == [9.0]


FOLLOWS = (
    STANDS.replace("kind: static", "kind: lateral")
    .replace("start: 10,", "start: 12,")
    .replace("look_at: runner, at: [0, -20, 6]", "target: runner, side: right, distance: 8, altitude: 4")
)


@pytest.mark.slow
def test_a_shot_may_be_as_far_off_as_is_reported_and_no_farther_than_is_explained() -> None:
    done = compiled_text(FOLLOWS, "none", "follows.yaml")
    assert done.plan is not None, done.diagnostics
    document: Document = json.loads(api.emit_plan(done.plan, []).artifacts[0].data)
    limits = []
    for reported in ((), (0.5, 2.0), (1e3,), (1e4,)):
        document["deviations"] = [
            {"shot": "watch", "distance": distance, "s": 12.0, "cause": "the drone's limits"}
            for distance in reported
        ]
        limits.append(limit_of(json.loads(resealed(document))))
    assert limits[:2] == [1.0, 3.0]
    # Half of the distance to the runner for the picture, and a little for the drone's limits, at 2 m/s.
    assert 1.0 + 0.5 * hypot(8.0, 4.0 - 0.9) < limits[2] == limits[3] < 1.0 + 0.5 * hypot(8.0, 4.0) + 3.0


@pytest.mark.parametrize(
    ("reported", "allowed"), [((), 1.0), ((0.5, 2.0), 3.0), ((2.0, 0.5), 3.0), ((7.0,), 8.0), ((1e3,), 8.0)]
)
def test_a_metre_beyond_what_is_reported_and_explained_is_allowed(
    reported: tuple[float, ...], allowed: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Explained are 2 m by a zone, 4 m by the picture and 1 m by the limits."""
    monkeypatch.setattr(shots, "in_the_way", lambda *_, **__: {"zone mast": 2.0})
    monkeypatch.setattr(shots, "farthest", lambda *_: 8.0)
    monkeypatch.setattr(shots, "for_the_picture", lambda _, far, **__: far / 2)
    monkeypatch.setattr(shots, "for_its_limits", lambda *_: 1.0)
    told = [PathDeviation("watch", distance, 0.0, "the drone's limits") for distance in reported]
    told.append(PathDeviation("another", 50.0, 0.0, "the drone's limits"))
    ir: Any = SimpleNamespace(deviations=told)
    for placed, course, most in (
        (False, EAST, allowed),
        (True, EAST, allowed),
        (True, EAST._replace(places=0.0 * EAST.places), min(allowed, 7.0)),
    ):
        shot: Any = SimpleNamespace(
            id="watch", subjects=(), smoothing=0.5, ideal=SimpleNamespace(placed=placed)
        )
        assert shots._allowed(flight(), ir, shot, course) == pytest.approx(most)


def plate(x: tuple[float, float], z: float) -> np.ndarray:
    """A level rectangle of triangles, 4 m wide."""
    a, b, c, d = ((x[0], -2.0, z), (x[1], -2.0, z), (x[1], 2.0, z), (x[0], 2.0, z))
    return np.array([[a, b, c], [a, c, d]])


def test_parts_one_above_the_other_are_gone_round_together_and_parts_aside_are_not() -> None:
    one = flight()
    near = one.mission.rules.beside_obstacle(one.drone.radius) + NEAR_M
    climb = ExpectedPlaces(
        np.linspace([0.5, 0.0, 30.0], [0.5, 0.0, 31.0 + 2.0 * near], 50), np.linspace(0.0, 9.0, 50)
    )
    low, high = plate((-30.0, 0.0), 30.0), plate((1.0, 31.0), 31.0 + 2.0 * near)
    both = replace(one, mission=with_meshes(one.mission, low, high))
    wide = np.hypot(61.0 + 2.0 * near, 4.0 + 2.0 * near)
    assert in_the_way(both, climb) == {"scene": pytest.approx(wide + 2.0 * near)}
    apart = with_meshes(one.mission, plate((-40.0, -20.0), 30.0), plate((15.0, 45.0), 30.0))
    wide = np.hypot(30.0 + 2.0 * near, 4.0 + 2.0 * near)
    assert in_the_way(replace(one, mission=apart), EAST) == {"scene": pytest.approx(wide + 2.0 * near)}
