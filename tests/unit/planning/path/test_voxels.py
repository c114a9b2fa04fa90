"""Ways through scenes: free, short, under what is high enough, and none where none is."""

from __future__ import annotations

import numpy as np
import pytest

from shotc.geom.pieces import pieces
from shotc.geom.solids import Cylinder
from shotc.geom.surface.distance import inf_distance
from shotc.ir.mission import Zone
from shotc.ir.owners import zone_owner
from shotc.planning.free_space import Obstacle, blocked
from shotc.planning.path.lines import NoWay, Polyline, straight_line
from shotc.planning.path.route import find_route, length
from shotc.planning.path.transit import smooth
from tests.support.few import few
from tests.support.mesh_spaces import CLEARANCE, space_of
from tests.support.path_scenes import mission
from tests.support.scenes import arch_wall, house, quad, some_scene
from tests.support.surfaces import distances, samples

A, B = np.array([-12.0, 0.0, 5.0]), np.array([12.0, 0.0, 5.0])


@pytest.mark.long
@pytest.mark.parametrize("seed", few([1, 2, 3], [1]))
def test_ways_through_villages_are_flown_clear_of_every_triangle(seed):
    scene = some_scene(np.random.default_rng(seed))
    space = space_of(scene.triangles)
    line = straight_line(space, scene.start, scene.end)
    assert isinstance(line, Polyline)
    assert length(line.corners) < 1.4 * np.linalg.norm(scene.end - scene.start)
    curve = smooth(space, mission().drones[0], line)
    bound = inf_distance(pieces(curve), space.meshes[0].mesh.surface, lambda _: 1e-6)
    dense = distances(scene.triangles, samples(curve, 400)).min()
    assert CLEARANCE - 1e-5 <= bound.proven <= dense


def test_a_way_leads_through_a_gate():
    way = find_route(space_of(arch_wall(400.0, 60.0, 8.0, 9.0)), A, B)
    assert way is not None
    assert length(way) < 26.0
    assert way[:, 2].max() < 9.0 - CLEARANCE


@pytest.mark.slow
def test_a_way_leads_over_a_wall_whose_gate_is_too_narrow():
    way = find_route(space_of(arch_wall(400.0, 12.0, 4.0, 9.0)), A, B)
    assert way is not None
    assert way[:, 2].max() >= 12.0 + CLEARANCE


@pytest.mark.long
def test_nothing_leads_out_of_a_closed_yard():
    walls = [quad((x, y, -1), (u, v, -1), (u, v, 9), (x, y, 9)) for x, y, u, v in _ring(9.0)]
    lid = quad((-9, -9, 9), (9, -9, 9), (9, 9, 9), (-9, 9, 9))
    yard = np.array([0.0, 0.0, 4.0])
    assert isinstance(straight_line(space_of(*walls, lid), yard, B + 20.0), NoWay)
    assert isinstance(straight_line(space_of(*walls), yard, B + 20.0), Polyline)


def _ring(half):
    corners = [(-half, -half), (half, -half), (half, half), (-half, half)]
    return [(*corners[i], *corners[(i + 1) % 4]) for i in range(4)]


@pytest.mark.slow
def test_a_way_keeps_clear_of_zones_beside_meshes():
    zone = Zone("mast", "out", Cylinder((0.0, 7.0), 5.0, 0.0, 40.0), ("world", "zones", "mast"))
    tree = Obstacle(zone_owner(zone), zone.solid, 0.3)
    space = space_of(house(6.0, 5.0, 8.0, 12.0), obstacles=(tree,))
    way = find_route(space, A, B)
    assert way is not None
    assert not blocked(space, way[:-1], way[1:], 0.0).any()


def test_a_place_inside_of_a_large_building_is_not_free():
    hall = house(60.0, 60.0, 30.0, 35.0)
    found = straight_line(space_of(hall), np.array([0.0, 0.0, 15.0]), np.array([60.0, 0.0, 15.0]))
    assert not isinstance(found, Polyline | NoWay)
    assert found.breach.lack > CLEARANCE
