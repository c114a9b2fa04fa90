"""Where drones rest beside films: aside of what passes, and without moving the film; and when films begin."""

from __future__ import annotations

import re

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from shotc.geom.bernstein import Array
from shotc.geom.solid_arrays.points import distances
from shotc.geom.solids import Cylinder
from shotc.ir.limits import Limits
from shotc.ir.trajectory import VerifiedIR
from shotc.planning.clock.ends import FARTHEST_M, shift_beside_traffic
from shotc.planning.clock.moving import Moving
from shotc.planning.clock.run_up import RunUp
from shotc.planning.free_space import FreeSpace, Wall
from tests.support.compiled import compiled_text
from tests.support.few import few
from tests.support.owners import owner

pytestmark = pytest.mark.slow

LIMITS = Limits(
    speed=8.0, climb=3.0, descent=2.0, acceleration=3.0, jerk=8.0, yaw_rate=1.0, yaw_acceleration=1.0
)
GROUND = FreeSpace((), (Wall(owner("ground"), (0.0, 0.0, 1.0), 1.0, 1.0),), ())
BODY = Cylinder((0.0, 0.0), 0.5, -0.9, 0.9)
LEAD = """\
shotc: 1
mission: lead
targets:
  runner: {track: {points: [[0, -120, 0.9], [0, 120, 0.9]], speed: 3.5 m/s}, radius: 0.45, height: 1.8}
drones:
  cam: {model: solo, home: [-30, 0, 0]}
rules: {ground_clearance: 0.8, target_clearance: 1.0}
shots:
  - {id: ahead, kind: lead, drone: cam, target: runner, distance: 3.5, altitude: 1.5,
     timing: {start: 32, duration: 8}}
"""
GATE = """\
shotc: 1
mission: gate
world:
  zones:
    field: {keep: in, polygon: {points: [[-30, -40], [60, -40], [60, 40], [-30, 40]], height: [0, 40]}}
targets:
  rider: {track: {points: [[-90, 0, 1.25], [90, 0, 1.25]], speed: 2.5 m/s}, radius: 1.1, height: 2.5}
drones:
  cam: {model: x500, home: [0, 12, 0]}
shots:
  - {id: side, kind: lateral, drone: cam, target: rider, side: right, distance: 9, altitude: 4,
     timing: {duration: 8}}
"""
NEXT = (
    LEAD.replace(
        "drones:",
        "  walker: {track: {points: [[10, 40, 0.9], [10, 90, 0.9]], speed: 0.3 m/s}, radius: 0.45,\n"
        "    height: 1.8}\ndrones:",
    )
    + """\
  - {id: next, kind: chase, drone: cam, target: walker, distance: 6, altitude: 4,
     timing: {start: START, duration: 5}}
"""
)
TWO = """\
shotc: 1
mission: two
targets:
  rider: {track: {points: [[0, -140, 1.2], [0, 140, 1.2]], speed: 4 m/s}, radius: 1, height: 2.3}
drones:
  a: {model: pro, home: [12, 0, 0], priority: 1}
  b: {model: pro, home: [-32, 8, 0], priority: 2}
rules: {separation: 4, ground_clearance: 1}
shots:
  - {id: tail, kind: chase, drone: b, target: rider, distance: 10, altitude: 2.2,
     timing: {start: 36, duration: 10}}
  - {id: by, kind: flyby, drone: a, target: rider, behind: 2.5, ahead: 4, offset: 8, altitude: 2.2,
     timing: {start: 34, duration: 12}}
"""
STATUE = """\
shotc: 1
mission: statue
targets:
  statue: {at: [26.6, 1.2, 1.6], radius: 1.1, height: 3.2}
drones:
  first: {model: x500, home: [48, -2.3, 0], limits: {speed: 9.5 m/s}}
  then: {model: mini, home: [38.1, -6.7, 0]}
rules: {ground_clearance: 2, target_clearance: 1, separation: 3}
shots:
  - {id: a1, kind: crane, drone: first, target: statue, azimuth: 232 deg, distance: [7.7, 9.1],
     altitude: [6.64, 2.8], timing: {duration: 13.9}}
  - {id: b1, kind: crane, drone: then, target: statue, azimuth: 139 deg, distance: [9.1, 7.6],
     altitude: [3.3, 2.5], timing: {after: a1}}
"""


def planned(text: str) -> tuple[VerifiedIR, set[str]]:
    done = compiled_text(text, "none", "m.yaml")
    assert done.plan is not None, done.diagnostics
    return done.plan, {d.code for d in done.diagnostics}


def passing(start: tuple[float, float], velocity: tuple[float, float]) -> Moving:
    def at(times: Array) -> Array:
        flat = np.array(start) + times[:, None] * np.array(velocity)
        return np.column_stack([flat, np.full(len(times), 0.9)])

    return Moving(owner("target runner"), BODY, 1.3, at, apart=5.3)


@given(st.floats(-3, 3), st.floats(-20, 20), st.floats(0, 6), st.floats(0, 6.28))
def test_a_place_aside_is_left_alone_and_over_the_ground(
    beside: float, along: float, speed: float, way: float
) -> None:
    rest, direction = np.array([0.0, 0.0, 1.5]), np.array([np.cos(way), np.sin(way)])
    across = np.array([-direction[1], direction[0]])
    first = along * direction + beside * across
    runner = passing((first[0], first[1]), (speed * direction[0], speed * direction[1]))
    place = rest + shift_beside_traffic([runner], GROUND, rest, (0.0, 20.0))
    times = np.linspace(0.0, 20.0, 400)
    assert distances(BODY, place - runner.at(times)).min() >= 5.3
    assert place[2] >= 1.0


def test_a_place_where_nothing_passes_stays() -> None:
    aside = shift_beside_traffic([passing((0, 40), (3, 0))], GROUND, np.array([0.0, 0.0, 1.5]), (0.0, 20.0))
    assert not aside.any()


def test_where_there_is_no_place_aside_the_drone_stays() -> None:
    low = FreeSpace((), (*GROUND.walls, Wall(owner("ceiling"), (0.0, 0.0, -1.0), -3.0, 0.0)), ())
    crowd = [passing((0.0, y), (0.0, 0.0)) for y in np.arange(-FARTHEST_M, FARTHEST_M + 1, 3.0)]
    crowd += [passing((x, y), (0, 0)) for x in (-12, -6, 6, 12) for y in np.arange(-15, 16, 3.0)]
    assert not shift_beside_traffic(crowd, low, np.array([0.0, 0.0, 1.5]), (0.0, 20.0)).any()


@pytest.mark.parametrize("sign", [-1.0, 1.0])
def test_a_way_to_aside_leaves_the_film_at_its_speed_and_ends_there_at_rest(sign: float) -> None:
    straight = RunUp(2.4, np.array([1.0, 2.0, 3.0]), np.array([0.0, 3.5, 0.0]))
    way = straight.led(np.array([6.0, 0.0, 1.0]), LIMITS)
    away = sign * np.linspace(0.0, way.seconds, 2001)
    places = way.at(away)
    rate = np.gradient(places, away, axis=0)
    assert places[0] == pytest.approx(straight.place)
    assert rate[0] == pytest.approx(straight.velocity, abs=0.01)
    assert rate[-1] == pytest.approx([0.0, 0.0, 0.0], abs=0.02)
    assert places[-1][0] == pytest.approx(7.0)
    assert places[-1][2] == pytest.approx(4.0)
    assert np.hypot(rate[:, 0], rate[:, 1]).max() <= LIMITS.speed
    assert (np.abs(np.diff(places[:, 1])) <= 3.5 * way.seconds / 2000 + 1e-9).all()


def test_a_drone_that_leads_gets_out_of_the_way_when_the_film_ends() -> None:
    """It is 3.5 m ahead, and stopping there let the runner come to 1.2 m."""
    plan, _ = planned(LEAD)
    curve, half = plan.trajectory.drones[0].curve, 0.9
    times = np.arange(40.0, curve.end, 0.02)
    runner = np.column_stack([np.zeros(len(times)), -120.0 + 3.5 * times, np.full(len(times), half)])
    away = distances(Cylinder((0.0, 0.0), 0.45, -half, half), curve(times)[:, :3] - runner)
    assert away[0] == pytest.approx(3.05, abs=0.3)
    assert away.min() >= away[0] - 0.1


@pytest.mark.long
@pytest.mark.parametrize("start", few([52.0, 54.0], [52.0]))
def test_a_drone_leads_straight_on_where_aside_it_would_miss_the_next_start(start: float) -> None:
    """Aside of the runner, it is at the walker after 58 s; straight on, after 51 s."""
    plan, codes = planned(NEXT.replace("START", str(start)))
    assert not codes & {"T003", "M008"}
    (shot,) = (p for p in plan.trajectory.drones[0].phases if p.shot == "next")
    assert shot.start == start


@pytest.mark.long
def test_the_earliest_start_is_the_one_that_straight_on_allows() -> None:
    """At 44 s not even a way without a stop is in time."""
    done = compiled_text(NEXT.replace("START", "44"), "none", "m.yaml")
    (late,) = (d for d in done.diagnostics if d.code == "T003")
    earliest = re.search(r"but (\S+) s is the earliest", late.message)
    assert earliest is not None
    assert 44.0 < float(earliest[1]) <= 52.0
    planned(NEXT.replace("START", earliest[1]))


def test_a_film_with_an_open_start_waits_until_no_fence_keeps_it_from_its_place() -> None:
    """The rider comes through the fence, 30 m West, after 24 s."""
    plan, codes = planned(GATE)
    assert "M008" not in codes
    (shot,) = (p for p in plan.trajectory.drones[0].phases if p.name == "shot")
    assert 24.0 <= shot.start <= 26.0


@pytest.mark.long
def test_where_a_drone_rests_after_a_film_does_not_move_the_film() -> None:
    plan, codes = planned(TWO)
    assert "M008" not in codes
    curve = next(d for d in plan.trajectory.drones if d.drone == "b").curve
    behind = np.column_stack([np.zeros(101), -150.0 + 4.0 * np.linspace(36, 46, 101), np.full(101, 2.2)])
    assert np.linalg.norm(curve(np.linspace(36, 46, 101))[:, :3] - behind, axis=1).max() < 0.5


def test_a_film_begins_when_nobody_flies_through_the_place_where_it_ends() -> None:
    """The first drone flies home over it just after the film would have ended."""
    plan, _ = planned(STATUE)
    first, then = (d.curve for d in plan.trajectory.drones)
    times = np.linspace(0.0, min(first.end, then.end), 4000)
    assert np.linalg.norm((first(times) - then(times))[:, :3], axis=1).min() >= 3.0
