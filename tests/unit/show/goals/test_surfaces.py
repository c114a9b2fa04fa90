"""Terrain and meshes as shows keep clear of them, held to answers computed place by place, without a tree."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from shotc.geom.bernstein import Array, bernstein_basis
from shotc.geom.pieces import Pieces
from shotc.show.goals.room import DisplaySurroundings, least_shift, room_of
from shotc.show.goals.surfaces import OverTerrain, surfaces_of
from tests.support.display_missions import display, fleet, picture, show
from tests.support.few import examples
from tests.support.standing_worlds import MIDDLE, from_box, height_over, house, ridge, terrain
from tests.support.terrain_missions import relief

CLEAR, BESIDE, RADIUS = 2.3, 2.3, 0.3
CENTRE, SIZE = (20.0, 10.0, 15.0), (24.0, 16.0, 30.0)


def room(max_height: float | None = None) -> DisplaySurroundings:
    from shotc.ir.show import Sphere

    swarm = fleet(20)
    mission = show(display(picture(Sphere((0.0, 0.0, 60.0), 5.0))), swarm).mission
    rules = mission.rules._replace(obstacle_clearance=2.0, max_height=max_height)
    return room_of(
        mission._replace(terrain=terrain(relief(5, 20.0)), meshes=(house(CENTRE, SIZE),), rules=rules), swarm
    )


ROOM = room()
SHAPE = relief(5, 20.0)


def places(seed: int, count: int, spread: float) -> Array:
    rng = np.random.default_rng(seed)
    p = rng.normal(size=(count, 3)) * [spread, spread, 6.0] + [20.0, 10.0, 0.0]
    p[:, 2] += p[:, 2] - height_over(SHAPE, p) + rng.uniform(0.0, 30.0)
    return p


@pytest.mark.slow
@settings(max_examples=examples(25, 500), deadline=None)
@given(st.integers(0, 2**31), st.floats(1.0, 60.0))
def test_what_lacks_room_is_what_is_too_low_or_too_near(seed: int, spread: float) -> None:
    p = places(seed, 60, spread)
    low = CLEAR - height_over(SHAPE, p)
    near = BESIDE - from_box(p, CENTRE, SIZE)
    lack = ROOM.lack(p)
    wanting = (low > 1e-9) | (near > 1e-9)
    assert ((lack > 1e-9) >= wanting).all()
    clear = (low < -1e-9) & (near < -1e-9) & (height_over(SHAPE, p) > 1.0)
    assert (lack[clear] <= 1e-9).all()  # with a clearance of two metres no slope here is as near as a body


@pytest.mark.slow
@settings(max_examples=examples(25, 500), deadline=None)
@given(st.integers(0, 2**31), st.floats(1.0, 60.0), st.booleans())
def test_places_that_rise_by_what_is_told_are_clear(seed: int, spread: float, every: bool) -> None:
    p = places(seed, 60, spread)
    up = ROOM.up(p, every=every)
    assert (up >= 0.0).all()
    if every:
        assert (ROOM.lack(p + up[:, None] * np.array([0.0, 0.0, 1.0])) <= 1e-6).all()
        return
    # Who rises out of the ground below a house is in the house: each thing tells for itself then.
    for surface in ROOM.surfaces:
        if isinstance(surface, OverTerrain) or surface.mesh is not None:
            own = surface.up(p, every=False)
            assert (surface.lack(p + own[:, None] * np.array([0.0, 0.0, 1.0])) <= 1e-6).all()
    assert (up[ROOM.lack(p) <= 0.0] == 0.0).all()


@pytest.mark.slow
@settings(max_examples=examples(20, 300), deadline=None)
@given(st.integers(0, 2**31))
def test_the_worst_of_pieces_is_no_less_than_at_any_sample_and_no_more_than_a_little(seed: int) -> None:
    rng = np.random.default_rng(seed)
    middle = places(seed, 6, 25.0)
    ctrl = middle[:, None] + rng.normal(size=(6, 4, 3)) * [8.0, 8.0, 3.0]
    pieces = Pieces(np.zeros(6), np.ones(6), ctrl)
    at = np.stack([bernstein_basis(3, u) @ ctrl for u in np.linspace(0.0, 1.0, 400)]).reshape(-1, 3)
    low = CLEAR - height_over(SHAPE, at).min()
    near = BESIDE - from_box(at, CENTRE, SIZE).min()
    for surface in ROOM.surfaces:
        worst = surface.worst(pieces)
        if isinstance(surface, OverTerrain):
            assert worst >= low - 1e-6
            assert worst <= max(low, 0.0) + 0.5
        elif surface.mesh is not None:
            assert worst >= near - 1e-6


def test_pieces_that_leave_the_terrain_lack_everything() -> None:
    ctrl = np.array([[[MIDDLE - 5.0 + 5.0 * k, 0.0, 200.0] for k in range(4)]])
    (ground, _, _) = ROOM.surfaces
    assert ground.worst(Pieces(np.zeros(1), np.ones(1), ctrl)) >= 1000.0
    assert ground.lack(ctrl[0]).max() >= 1000.0
    assert ground.worst(Pieces(np.zeros(1), np.ones(1), ctrl - [20.0, 0.0, 0.0])) <= 0.0


@pytest.mark.parametrize("over", [38.0, 41.0])
def test_the_greatest_height_counts_from_the_ground_below(over: float) -> None:
    ceiling = room(40.0).surfaces[1]
    assert isinstance(ceiling, OverTerrain)
    p = places(1, 30, 40.0)
    p[:, 2] += over - height_over(SHAPE, p)
    assert ceiling.lack(p) == pytest.approx(over - 40.0, abs=1e-6) or over < 40.0
    assert (ceiling.lack(p) > 0.0).all() == (over > 40.0)


@pytest.mark.slow
def test_a_picture_in_a_hill_is_shifted_by_what_gives_all_of_it_room() -> None:
    p = places(3, 40, 6.0)
    p[:, 2] -= 30.0
    shift = least_shift(p, ROOM)
    assert shift is not None
    assert (ROOM.lack(p + shift) <= 1e-6).all()


def test_over_flat_ground_without_meshes_there_is_nothing_to_keep() -> None:
    from shotc.ir.show import Sphere

    swarm = fleet(4)
    mission = show(display(picture(Sphere((0.0, 0.0, 60.0), 5.0))), swarm).mission
    assert surfaces_of(mission, swarm) == ()
    assert room_of(mission, swarm).lowest == CLEAR
    assert room_of(mission._replace(terrain=terrain(ridge(10.0))), swarm).lowest == -np.inf
