"""What of a mesh is the target itself, and hides nothing of it."""

from __future__ import annotations

import numpy as np

from shotc.geom.shapes import BoxShape
from shotc.ir.coverage import coverage
from shotc.ir.hiding_surfaces import surfaces_before
from shotc.ir.occlusion import hiders
from shotc.ir.target import Target
from tests.support.film_plans import orbit_mission
from tests.support.mesh_spaces import with_meshes
from tests.support.records import replace
from tests.support.scenes import house, quad, turned

CHURCH = Target("church", (0.0, 0.0, 5.0), BoxShape(12.0, 8.0, 10.0, (1.0, 0.0)), ("targets", "church"))
WALLS = house(12.2, 8.2, 7.0, 10.2)
EYES, TIMES = np.array([[40.0, 3.0, 6.0], [0.0, 40.0, 6.0]]), np.zeros(2)


def mission(*parts):
    return with_meshes(replace(orbit_mission(), zones=(), targets=(CHURCH,)), *parts)


def test_a_building_that_is_filmed_does_not_hide_itself():
    made = mission(WALLS)
    ((name, surface),) = surfaces_before(made, "church")
    assert name == "scene a.ply"
    assert len(surface) == 0
    assert coverage(made, (), "church", EYES, TIMES).share.max() == 0.0
    assert not any(hides.any() for _, hides in hiders(made, (), "church", EYES, TIMES))


def test_the_house_beside_it_does():
    made = mission(WALLS, turned(house(6.0, 30.0, 12.0, 14.0), 0.0, (20.0, 0.0)))
    share = coverage(made, (), "church", EYES, TIMES).share
    assert share[0] > 0.9
    assert share[1] == 0.0


def test_the_ground_of_a_scan_is_not_the_target_that_stands_on_it():
    hill = quad((20.0, -30.0, 0.0), (20.0, 30.0, 0.0), (25.0, 30.0, 30.0), (25.0, -30.0, 30.0))
    ground = quad((-60.0, -60.0, 0.0), (60.0, -60.0, 0.0), (60.0, 60.0, 0.0), (-60.0, 60.0, 0.0))
    ((_, surface),) = surfaces_before(mission(np.concatenate([WALLS, ground, hill])), "church")
    assert len(surface) >= 4


def test_a_target_that_moves_has_no_part_in_a_mesh():
    walker = replace(CHURCH, track=object())
    made = with_meshes(replace(orbit_mission(), zones=(), targets=(walker,)), WALLS)
    ((_, surface),) = surfaces_before(made, "church")
    assert surface is made.meshes[0].surface
