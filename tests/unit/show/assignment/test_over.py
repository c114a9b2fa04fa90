"""Fleets that rise over what lies between two formations: as high as it takes, together, within limits."""

from __future__ import annotations

from math import inf

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.interpolate import BSpline
from scipy.spatial.distance import pdist

from shotc.geom.bernstein import Array
from shotc.geom.fleet_spline import knots
from shotc.geom.solids import box
from shotc.ir.mission import MissionIR, Zone
from shotc.ir.show import Fleet, Picture, Sphere
from shotc.show.assignment.moves import Mover
from shotc.show.assignment.over import MoveSurroundings
from shotc.show.assignment.score import Motion
from shotc.show.geom.arcs import Gaps
from shotc.show.goals.room import DisplaySurroundings, RoomLack
from shotc.show.solvers.lifted_move import Course, Drive, LiftedMove, lifted, rising_paths, sampled
from shotc.show.solvers.match import matched
from shotc.show.solvers.move import CommonMove
from tests.support.display_missions import LIMITS, display, fleet, picture, show
from tests.support.few import examples
from tests.support.standing_worlds import from_box, height_over, house, ridge, terrain
from tests.support.surfaces import Grid, grid

CLEAR = 2.0 + 0.3
"""The ground clearance of these missions and the radius of a drone, metres."""
BESIDE = 2.0 + 0.3
COUNT = 25


def sheet(x: float, z: float, step: float = 4.0) -> Array:
    return np.array([[x + step * (k % 5), -8.0 + step * (k // 5), z] for k in range(COUNT)])


def asked(path: str = "auto", transition: float | None = None) -> Picture:
    plain = picture(Sphere((0.0, 0.0, 60.0), 5.0))
    return plain._replace(transition_path=path, transition=transition)  # type: ignore[arg-type]


def world(**changes: object) -> tuple[MissionIR, Fleet]:
    swarm = fleet(COUNT)
    mission = show(display(asked()), swarm).mission
    rules = mission.rules._replace(obstacle_clearance=2.0)
    return mission._replace(**{"rules": rules, **changes}), swarm  # type: ignore[arg-type]


def flown(ends: tuple[Array, Array], move: Motion, order: int = 0, count: int = 1500) -> Array:
    """Return places, or a derivative, of all drones at even times, shape (count, n, 3)."""
    starts, goals = ends
    coef = np.stack([*[starts] * 3, *move.between(starts, goals), *[goals] * 3], axis=0)
    breaks = np.linspace(0.0, move.duration, move.pieces + 1)
    spline = BSpline(knots(breaks), coef, 3)
    return np.asarray((spline.derivative(order) if order else spline)(np.linspace(0.0, move.duration, count)))


def keeps_limits(ends: tuple[Array, Array], move: Motion) -> bool:
    velocity = flown(ends, move, 1)
    speed = np.hypot(velocity[..., 0], velocity[..., 1]).max()
    up, down = velocity[..., 2].max(), -velocity[..., 2].min()
    acceleration, jerk = (np.linalg.norm(flown(ends, move, k), axis=2).max() for k in (2, 3))
    within = (
        speed <= LIMITS.speed,
        up <= LIMITS.climb,
        down <= LIMITS.descent,
        acceleration <= LIMITS.usable_acceleration,
        jerk <= LIMITS.jerk,
    )
    return all(within)


@pytest.mark.slow
@pytest.mark.parametrize("height", [45.0, 70.0])
def test_over_a_ridge_of_known_height_the_fleet_rises_by_what_it_lacks_and_little_more(height: float) -> None:
    shape = ridge(height)
    mission, swarm = world(terrain=terrain(shape))
    ends = sheet(-20.0, 30.0), sheet(120.0, 30.0)
    mover = Mover(mission, swarm)
    move = mover.move(*ends, 1.0, asked())
    assert not mover.faults
    assert isinstance(move, LiftedMove)
    least = height + CLEAR - 30.0
    assert least < move.height < least + 5.0
    at = flown(ends, move)
    assert height_over(shape, at).min() >= CLEAR - 1e-6
    assert keeps_limits(ends, move)
    assert move.limit in {"climb", "descent", "speed", "acceleration", "jerk"}
    assert mover.sky.lack(ends, move).metres <= 1e-6


@pytest.mark.slow
def test_drones_that_rise_together_are_as_far_apart_as_on_level_ways() -> None:
    mission, swarm = world(terrain=terrain(ridge(50.0)))
    ends = sheet(-20.0, 30.0), sheet(120.0, 34.0, 5.0)
    lifted, level = (Mover(m, swarm).move(*ends, 1.0, asked()) for m in (mission, world()[0]))
    assert isinstance(level, CommonMove)
    least = [min(float(pdist(at).min()) for at in flown(ends, move, 0, 300)) for move in (lifted, level)]
    assert least[0] >= 4.0 - 1e-6
    assert least[1] >= 4.0 - 1e-6


def test_where_nothing_is_in_the_way_a_move_over_terrain_is_that_over_flat_ground() -> None:
    mission, swarm = world(terrain=terrain(ridge(50.0)))
    ends = sheet(-20.0, 60.0), sheet(120.0, 60.0)
    over, flat = (Mover(m, swarm).move(*ends, 1.0, asked()) for m in (mission, world()[0]))
    assert isinstance(over, CommonMove)
    assert isinstance(flat, CommonMove)
    assert (over.piece, over.s.tolist()) == (flat.piece, flat.s.tolist())


@pytest.mark.slow
@pytest.mark.parametrize("path", ["auto", "straight", "arc"])
def test_a_house_between_two_pictures_is_passed_at_its_clearance(path: str) -> None:
    centre, size = (60.0, 0.0, 25.0), (20.0, 60.0, 50.0)
    mission, swarm = world(meshes=(house(centre, size),))
    ends = sheet(-20.0, 30.0), sheet(120.0, 30.0)
    mover = Mover(mission, swarm)
    move = mover.move(*ends, 1.0, asked(path))
    assert not mover.faults
    at = flown(ends, move, 0, 4000)
    assert from_box(at, centre, size).min() >= BESIDE - 1e-6
    assert keeps_limits(ends, move)


@pytest.mark.slow
def test_a_zone_in_straight_ways_is_passed_over() -> None:
    wall = Zone("wall", "out", box((60.0, 0.0, 20.0), (4.0, 2000.0, 40.0), 0.0), ("world", "zones", "wall"))
    mission, swarm = world(zones=(wall,))
    ends = sheet(-20.0, 30.0), sheet(120.0, 30.0)
    mover = Mover(mission, swarm)
    move = mover.move(*ends, 1.0, asked())
    assert isinstance(move, LiftedMove)
    assert not mover.faults
    assert from_box(flown(ends, move, 0, 4000), (60.0, 0.0, 20.0), (4.0, 2000.0, 40.0)).min() >= 0.3 - 1e-6


@pytest.mark.slow
@pytest.mark.parametrize("at", [0.0, 60.0, 110.0])
@pytest.mark.parametrize("height", [60.0, 120.0])
def test_beside_a_wall_the_fleet_rises_by_hardly_more_than_its_height(at: float, height: float) -> None:
    """The wall is 2 m from the nearest drone of the first picture, half-way, or 8 m from the last picture."""
    wall = Zone(
        "wall", "out", box((at, 0.0, 0.5 * height), (4.0, 2000.0, height), 0.0), ("world", "zones", "wall")
    )
    mission, swarm = world(zones=(wall,))
    ends = sheet(-20.0, 30.0), sheet(120.0, 30.0)
    mover = Mover(mission, swarm)
    move = mover.move(*ends, 1.0, asked())
    assert not mover.faults
    assert isinstance(move, LiftedMove)
    least = height + 0.3 - 30.0
    assert least < move.height < 1.09 * least
    away = from_box(flown(ends, move, 0, 4000), (at, 0.0, 0.5 * height), (4.0, 2000.0, height))
    assert away.min() >= 0.3 - 1e-6
    assert keeps_limits(ends, move)


@pytest.mark.slow
def test_what_the_obstacles_require_is_looked_up_once_for_all_heights_that_are_tried(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    looked_up, proved = [], []
    up, lack = DisplaySurroundings.up, MoveSurroundings.lack

    def counted_up(self: DisplaySurroundings, p: Array, *, every: bool) -> Array:
        looked_up.append(every)
        return up(self, p, every=every)

    def counted_lack(self: MoveSurroundings, ends: tuple[Array, Array], move: Motion) -> RoomLack:
        proved.append(move)
        return lack(self, ends, move)

    monkeypatch.setattr(DisplaySurroundings, "up", counted_up)
    monkeypatch.setattr(MoveSurroundings, "lack", counted_lack)
    mission, swarm = world(terrain=terrain(ridge(70.0)))
    Mover(mission, swarm).move(sheet(-20.0, 30.0), sheet(120.0, 30.0), 1.0, asked())
    assert sum(isinstance(move, LiftedMove) for move in proved) > 1
    assert looked_up == [False]


@pytest.mark.slow
def test_over_terrain_the_greatest_height_counts_from_the_ground() -> None:
    shape, rules = ridge(70.0), world()[0].rules._replace(max_height=60.0)
    mission, swarm = world(terrain=terrain(shape), rules=rules)
    ends = sheet(-20.0, 30.0), sheet(120.0, 30.0)
    mover = Mover(mission, swarm)
    at = flown(ends, mover.move(*ends, 1.0, asked()))
    assert not mover.faults
    assert at[..., 2].max() > 70.0
    assert height_over(shape, at).max() <= 60.0 + 1e-6


@pytest.mark.slow
def test_a_wall_above_what_the_mission_allows_is_refused_with_the_height_that_does() -> None:
    wall = Zone("wall", "out", box((60.0, 0.0, 50.0), (4.0, 4000.0, 100.0), 0.0), ("world", "zones", "wall"))
    ends = sheet(-20.0, 30.0), sheet(120.0, 30.0)
    rules = world()[0].rules._replace(max_height=60.0)
    mission, swarm = world(zones=(wall,), rules=rules)
    mover = Mover(mission, swarm)
    mover.move(*ends, 1.0, asked())
    (fault,) = mover.faults
    assert fault.code == "D160"
    (most,) = [int(word.strip("}`,")) for word in fault.help.split() if word.strip("}`,").isdigit()]
    mission, swarm = world(zones=(wall,), rules=rules._replace(max_height=float(most)))
    again = Mover(mission, swarm)
    again.move(*ends, 1.0, asked())
    assert not again.faults


@pytest.mark.slow
def test_dense_formations_rise_on_arcs_over_a_ridge() -> None:
    shape = ridge(45.0)
    mission, swarm = world(terrain=terrain(shape))
    ends = sheet(-10.0, 30.0, 1.2), sheet(130.0, 30.0, 1.2)
    mover = Mover(mission, swarm)
    move = mover.move(*ends, 1.0, asked())
    assert not mover.faults
    at = flown(ends, move)
    assert height_over(shape, at).min() >= CLEAR - 1e-6
    assert min(float(pdist(one).min()) for one in at[::20]) >= 1.15 - 1e-6
    assert keeps_limits(ends, move)


def hills(seed: int, height: float) -> Grid:
    rng = np.random.default_rng(seed)
    x, y = np.meshgrid(np.arange(61), np.arange(61), indexing="ij")
    waves = sum(
        np.sin(2 * np.pi * (x * a + y * b) / 61 + c) / (abs(a) + abs(b))
        for a, b, c in zip(*rng.uniform(-4, 4, (2, 6)), rng.uniform(0, 6, 6), strict=True)
    )
    return grid(height * np.asarray(waves), 10.0)


@pytest.mark.slow
@settings(max_examples=examples(8, 200), deadline=None)
@given(st.integers(0, 2**31), st.floats(5.0, 40.0), st.floats(1.0, 25.0))
def test_whatever_the_hills_a_move_without_a_fault_is_clear_at_every_sample(
    seed: int, height: float, over: float
) -> None:
    """Formations are so much above what they need; the ground is looked up cell by cell, without a tree."""
    shape, rng = hills(seed, height), np.random.default_rng(seed)
    mission, swarm = world(terrain=terrain(shape))
    starts, goals = (sheet(0.0, 0.0) + np.append(rng.uniform(-150, 150, 2), 0.0) for _ in range(2))
    for places in (starts, goals):
        places[:, 2] += CLEAR + over - height_over(shape, places).min()
    ends = starts, goals[matched(starts, goals)]
    mover = Mover(mission, swarm)
    move = mover.move(*ends, 1.0, asked())
    assert not mover.faults
    assert height_over(shape, flown(ends, move, 0, 800)).min() >= CLEAR - 1e-6
    assert keeps_limits(ends, move)


def test_what_no_height_helps_is_no_move() -> None:
    ends = sheet(0.0, 30.0), sheet(80.0, 30.0)

    def never(places: Array) -> Array:
        return np.where((places[:, 1] > 0.4) & (places[:, 1] < 0.6), inf, 0.0)

    course = Course(np.zeros(3))
    assert lifted(ends, course, rising_paths(ends, course, never), Drive(LIMITS, 1.0, "ease-in-out")) is None


@pytest.mark.slow
@pytest.mark.parametrize("arcs", [None, Gaps(1.0, 1.0)])
def test_a_height_that_is_asked_for_is_reached_where_it_is(arcs: Gaps | None) -> None:
    """By how far along the fleet is: on straight ways b, on arcs the angle."""
    ends = sheet(0.0, 30.0), sheet(80.0, 30.0)

    def hill(places: Array) -> Array:
        along = np.arctan2(places[:, 1], places[:, 0]) / (0.5 * np.pi) if arcs else places[:, 1]
        need = 12.0 * np.exp(-(((along - 0.3) / 0.1) ** 2))
        return np.where((along < 1e-6) | (along > 1.0 - 1e-6), 0.0, need)

    course = Course(np.array([40.0, 0.0, 30.0]), arcs)
    move = lifted(ends, course, rising_paths(ends, course, hill), Drive(LIMITS, 1.0, "ease-in-out"))
    assert move is not None
    a, b, height = (sampled(channel) for channel in (*move.ctrl.T, move.lift))
    assert (height >= hill(np.column_stack([a, b])) - 0.06).all()
    assert 12.0 <= move.height < 15.0
    if arcs:
        assert np.hypot(a, b).min() >= 1.0 - 1e-9
