"""What of a mesh is the target itself, and hides nothing of it."""

from __future__ import annotations

import numpy as np
import pytest

from shotc.geom.shapes import BoxShape
from shotc.geom.surface.cloud import median_spacing
from shotc.ir import hiding_surfaces
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


def scanned(triangles: np.ndarray, spacing: float) -> np.ndarray:
    """Places spread over triangles at random, about so far from one another."""
    random, found = np.random.default_rng(2), []
    for a, b, c in triangles:
        area = 0.5 * float(np.linalg.norm(np.cross(b - a, c - a)))
        u, v = random.uniform(size=(2, max(1, int(area / spacing**2)), 1))
        u, v = np.where(u + v > 1.0, 1.0 - u, u), np.where(u + v > 1.0, 1.0 - v, v)
        found.append(a + u * (b - a) + v * (c - a))
    return np.concatenate(found)


def of_cloud(points: np.ndarray):
    made = mission(np.repeat(points[:, None], 3, axis=1))
    half = 0.5 * median_spacing(made.meshes[0].surface)
    return replace(made, meshes=(replace(made.meshes[0], spacing=half),))


@pytest.mark.slow
def test_a_scan_hides_what_the_faces_that_it_is_of_hide():
    beside = turned(house(6.0, 30.0, 9.0, 11.0), 0.0, (20.0, 0.0))
    eyes = np.column_stack([np.full(60, 60.0), np.linspace(-45.0, 45.0, 60), np.linspace(4.0, 30.0, 60)])
    wanted = coverage(mission(WALLS, beside), (), "church", eyes, np.zeros(60)).share
    made = of_cloud(np.concatenate([scanned(WALLS, 0.15), scanned(beside, 0.15)]))
    found = coverage(made, (), "church", eyes, np.zeros(60)).share
    assert ((wanted > 0.1) & (wanted < 0.9)).any()
    assert np.abs(found - wanted).max() < 0.1
    assert np.abs(found - wanted).mean() < 0.02
    both = (made, mission(WALLS, beside))
    lines = [next(hides for _, hides in hiders(of, (), "church", eyes, np.zeros(60))) for of in both]
    assert (lines[0] == lines[1]).mean() > 0.9


def test_a_scan_of_what_is_filmed_does_not_hide_it():
    made = of_cloud(scanned(WALLS, 0.15))
    assert coverage(made, (), "church", EYES, TIMES).share.max() == 0.0
    assert not any(hides.any() for _, hides in hiders(made, (), "church", EYES, TIMES))


@pytest.mark.slow
def test_of_a_large_cloud_fewer_and_larger_discs_hide_as_much():
    beside = turned(house(6.0, 30.0, 9.0, 11.0), 0.0, (20.0, 0.0))
    points = scanned(beside, 0.1)
    shares = []
    for most in (10**6, 2000):
        with pytest.MonkeyPatch.context() as patched:
            patched.setattr(hiding_surfaces, "MOST_DISCS", most)
            made = of_cloud(points)
            ((_, surface),) = surfaces_before(made, "church")
            assert len(surface) <= most
            shares.append(coverage(made, (), "church", EYES, TIMES).share)
    assert np.abs(shares[0] - shares[1]).max() < 0.1
