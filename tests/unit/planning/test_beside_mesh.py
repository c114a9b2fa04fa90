"""Clearances from meshes, held against all triangles one by one."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.interpolate import BPoly

from shotc.geom.bernstein import Array
from shotc.ir.owners import owner_of
from shotc.planning.beside_mesh import FAR_M
from shotc.planning.free_space import blocked, bounds_slack, breaches, corridor, shortfall
from tests.support.mesh_spaces import CLEARANCE, space_of
from tests.support.scenes import arch_wall, cone, house, turned
from tests.support.surfaces import distances
from tests.support.tampered_plans import MISSION

pytestmark = pytest.mark.slow


HOUSE = house(8.0, 6.0, 4.0, 6.0)


@pytest.fixture(scope="module")
def village():
    random = np.random.default_rng(5)
    made = (
        house(9.0, 7.0, 5.0, 8.0),
        arch_wall(30.0, 12.0, 7.0, 9.0),
        cone(4.0, 2.0, 12.0),
        house(12.0, 9.0, 7.0, 9.0),
    )
    parts = [turned(made[k % 4], random.uniform(0, 3), random.uniform(-38, 38, 2)) for k in range(16)]
    return np.concatenate(parts), space_of(*parts)


def curves(random: np.random.Generator, count: int, at: Array) -> Array:
    """Hulls of random pieces about places, (count, 6, 3)."""
    return at[:, None] + random.normal(size=(count, 1, 3)) * 2 + random.normal(size=(count, 6, 3))


def test_room_is_the_distance_from_the_nearest_triangle(village):
    triangles, space = village
    p = np.random.default_rng(1).uniform([-40, -40, 3], [40, 40, 20], size=(60, 3))
    outside = p[~space.meshes[0].mesh.holds(p)]
    room = distances(triangles, outside) - CLEARANCE
    told = space.meshes[0].slack(outside)
    near = room < FAR_M
    assert told[near] == pytest.approx(room[near], abs=1e-9)
    assert np.isinf(told[~near]).all()


def test_a_place_inside_of_a_house_is_as_far_from_free_as_its_wall_and_the_clearance():
    space = space_of(HOUSE)
    (breach,) = breaches(space, np.array([0.0, 0.0, 2.5]))
    assert breach.owner.kind == "scene"
    assert breach.lack == pytest.approx(CLEARANCE + 2.5)  # the floor is the nearest
    assert bounds_slack(space, np.array([[0.0, 0.0, 9.0]]))[0] == pytest.approx(3.0 - CLEARANCE)


@pytest.mark.long
def test_segments_are_stopped_as_samples_of_them_are(village):
    triangles, space = village
    random = np.random.default_rng(2)
    a = random.uniform([-40, -40, 3], [40, 40, 12], size=(40, 3))
    b = a + random.normal(size=(40, 3)) * [8, 8, 1]
    share = np.linspace(0.0, 1.0, 200)[:, None]
    nearest = np.array([distances(triangles, p + share * (q - p)).min() for p, q in zip(a, b, strict=True)])
    held = space.meshes[0].mesh.holds(a) | space.meshes[0].mesh.holds(b)
    stopped = blocked(space, a, b, 0.0)[:, 0]
    assert stopped[(nearest < CLEARANCE) | held].all()
    assert not stopped[(nearest > CLEARANCE + 0.05) & ~held].any()
    assert 5 < stopped.sum() < 35


@pytest.mark.long
def test_what_pieces_lack_is_never_less_than_their_samples_do(village):
    triangles, space = village
    random = np.random.default_rng(3)
    hulls = curves(random, 60, random.uniform([-40, -40, 6], [40, 40, 10], size=(60, 3)))
    lack = shortfall(space, hulls)
    curve = [BPoly(hull[:, None, :], [0.0, 1.0]) for hull in hulls]
    near = np.array([distances(triangles, c(np.linspace(0.0, 1.0, 200))).min() for c in curve])
    close = near < CLEARANCE
    assert 5 < close.sum() < 55
    assert (lack[close] >= CLEARANCE - near[close] - 1e-6).all()
    assert (lack[near > CLEARANCE + 0.01] <= 0.0).all()


@pytest.mark.long
def test_points_in_the_half_spaces_of_a_free_piece_keep_the_clearance(village):
    triangles, space = village
    random = np.random.default_rng(4)
    hulls = curves(random, 200, random.uniform([-40, -40, 6], [40, 40, 14], size=(200, 3)))
    free = np.flatnonzero((shortfall(space, hulls) < 0.0) & ~space.meshes[0].mesh.holds(hulls[:, 0]))
    planes = corridor(space, hulls[free], 4.0)
    assert len(planes.piece) > 20
    for k in np.unique(planes.piece):
        its = planes.piece == k
        p = hulls[free[k]].mean(axis=0) + random.normal(size=(400, 3))
        fits = (p @ planes.normal[its].T >= planes.offset[its].max(axis=1)).all(axis=1)
        near = np.linalg.norm(p - hulls[free[k]].mean(axis=0), axis=1) < 3.0
        some = p[fits & near]
        if len(some):
            assert distances(triangles, some[:60]).min() >= CLEARANCE - 1e-6


def test_a_mesh_that_gives_way_lets_more_pass():
    space = space_of(HOUSE)
    owner = space.meshes[0].owner
    p = np.array([[0.0, -3.0 - 1.5, 2.5]])
    assert bounds_slack(space, p)[0] < 0.0
    assert bounds_slack(space.giving({owner: 1.0}), p)[0] > 0.0
    assert not space.without(owner).meshes


def test_what_a_place_is_too_near_to_has_the_name_of_its_part():
    at = np.array([0.0, 20.0])
    space = space_of(turned(HOUSE, 0.3, at), turned(HOUSE, 0.3, -at))
    (breach,) = breaches(space, np.array([0.0, -20.0, 3.0]))
    assert (breach.owner.name, breach.owner.words) == ("part 1", "`part 1` of the scene")
    assert str(breach.owner) == "scene part 1"
    mesh = space.meshes[0].mesh
    assert owner_of(MISSION._replace(meshes=(mesh,)), "scene part 1") == breach.owner
    assert owner_of(MISSION._replace(meshes=(mesh,)), "scene part 7") is None
