"""Targets found in scenes that are made to mislead: what is meant is found, or it is said that nothing is."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from shotc.geom.camera import ScreenBox, aim_at
from shotc.identify.find import ClusterTarget, Glance, SearchResult, find, held
from shotc.identify.views import FRAME, CameraPose
from shotc.ir.mission import MissionIR
from tests.support.cities import ASPECT, HFOV_RAD, block, box_of, mission_of, tube
from tests.support.meshes import box_mesh
from tests.support.scenes import quad


def looking(eye: tuple[float, float, float], at: tuple[float, float, float]) -> CameraPose:
    offset = tuple(b - a for a, b in zip(eye, at, strict=True))
    aim = aim_at(offset, (0.1, -0.05), HFOV_RAD, ASPECT)
    assert aim is not None
    return CameraPose(eye, aim[0], aim[1], HFOV_RAD, ASPECT)


def glance(triangles: np.ndarray, eye: tuple[float, float, float]) -> Glance:
    """A keyframe that looks at triangles, with the box round them."""
    points = triangles.reshape(-1, 3)
    camera = looking(eye, tuple(0.5 * (points.min(axis=0) + points.max(axis=0))))
    box = box_of(triangles, camera)
    assert box is not None
    return Glance(camera, box)


def only(found: SearchResult) -> ClusterTarget:
    (target,) = found.targets
    return target


def house(x: float, y: float, size: tuple[float, float, float]) -> np.ndarray:
    """A closed box on the ground."""
    return box_mesh((x, y, size[2] / 2), size)


def around(radius: float, height: float) -> list[tuple[float, float, float]]:
    """Places of three cameras about the origin."""
    return [(radius * np.cos(a), radius * np.sin(a), height) for a in (-1.6, -0.6, 0.9)]


def test_touching_buildings_are_two_targets():
    left, right = house(-8, 0, (16, 12, 20)), house(8, 0, (16, 14, 26))
    mission = mission_of(left, right)
    found = find(mission, [glance(t, eye) for t in (left, right) for eye in ((-30, -70, 25), (30, -70, 30))])
    a, b = found.targets
    assert (a.glances, b.glances) == ((0, 1), (2, 3))
    assert a.cylinder.centre == pytest.approx((-8, 0), abs=0.5)
    assert a.cylinder.radius == pytest.approx(10.0, rel=0.03)
    assert (a.cylinder.height, b.cylinder.height) == pytest.approx((20, 26), rel=0.03)


def test_touching_buildings_of_one_surface_stay_with_their_boxes():
    """A surface without floors does not tell where a building ends: what counts is what is in the box."""
    left, right = block((-8, 0), (16, 12), 20, 0.0), block((8, 0), (16, 14), 26, 0.0)
    found = find(mission_of(left, right), [glance(left, (-40, -70, 25)), glance(left, (-60, -30, 25))])
    assert np.hypot(*np.subtract(only(found).cylinder.centre, (-8, 0))) < 6.0


def test_a_tower_behind_a_low_hall_stands_on_the_ground():
    hall, tower = house(0, -25, (60, 20, 9)), house(0, 0, (10, 10, 40))
    found = find(mission_of(hall, tower), [glance(tower, (0, -90, 14)), glance(tower, (30, -80, 12))])
    cylinder = only(found).cylinder
    assert cylinder.centre == pytest.approx((0, 0), abs=0.6)
    assert cylinder.radius == pytest.approx(7.07, rel=0.1)
    assert (cylinder.bottom, cylinder.top) == pytest.approx((0, 40), abs=1.0)
    assert min(choice.share for choice in found.choices if choice) > 0.8


def test_the_deck_of_a_bridge_hangs_in_the_air():
    deck = box_mesh((0, 0, 12), (60, 8, 1.5))
    piers = [box_mesh((x, 0, 5.6), (3, 6, 11.2)) for x in (-20, 0, 20)]
    mission = mission_of(deck, *piers)
    seen = glance(deck, (10, -70, 22))
    # The box of a hand that draws close round the deck.
    close = seen.box._replace(v_min=seen.box.v_min + 0.35 * (seen.box.v_max - seen.box.v_min))
    found = find(mission, [seen._replace(box=close)])
    assert only(found).cylinder.radius == pytest.approx(30.2, rel=0.05)
    assert only(found).cylinder.top == pytest.approx(12.75, abs=0.3)


def test_a_wing_seen_from_the_courtyard_is_what_is_found():
    rings = ((-20, -20), (20, -20), (20, 20), (-20, 20), (-20, -20))
    walls = [quad((*a, 0), (*b, 0), (*b, 12), (*a, 12)) for a, b in pairwise(rings)]
    statue = tube((10, 0), 1.5, 6.0)
    mission = mission_of(*walls, statue)
    found = find(mission, [glance(statue, (-12, 3, 5)), glance(statue, (-8, -9, 4))])
    assert only(found).cylinder.centre == pytest.approx((10, 0), abs=0.3)
    assert only(found).cylinder.radius == pytest.approx(1.5, rel=0.15)


def cloud(triangles: np.ndarray, spacing: float, random: np.random.Generator) -> np.ndarray:
    """Points on triangles, one to each square of the spacing, as triangles without a size."""
    sides = triangles[:, 1:] - triangles[:, :1]
    area = 0.5 * np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1)
    of = random.choice(len(area), int(area.sum() / spacing**2), p=area / area.sum())
    a, b = random.uniform(size=(2, len(of)))
    a, b = np.where(a + b > 1, 1 - a, a), np.where(a + b > 1, 1 - b, b)
    points = triangles[of, 0] + a[:, None] * sides[of, 0] + b[:, None] * sides[of, 1]
    return np.repeat(points[:, None], 3, axis=1)


@pytest.mark.slow
def test_a_cloud_full_of_holes_gives_the_same_target():
    random = np.random.default_rng(2)
    tower, other = tube((0, 0), 8.0, 30.0), house(30, 14, (12, 12, 20))
    points = cloud(np.concatenate([tower, other]), 0.6, random)
    for hole in random.uniform([-10, -10, 0], [10, 10, 30], (12, 3)):
        points = points[np.linalg.norm(points[:, 0] - hole, axis=1) > 3.0]
    # Half of what is between neighbours, at the median.
    mission = mission_of(points, spacing=0.5 * 0.47 * 0.6)
    cylinder = only(find(mission, [glance(tower, eye) for eye in around(70, 28)])).cylinder
    assert cylinder.centre == pytest.approx((0, 0), abs=0.6)
    assert cylinder.radius == pytest.approx(8.0, rel=0.07)
    assert cylinder.height == pytest.approx(30.0, rel=0.03)


@pytest.mark.parametrize(
    ("at", "sky", "ground"), [((0.0, -200.0, 90.0), 1.0, 0.0), ((60.0, -60.0, 0.0), 0.0, 1.0)]
)
def test_boxes_on_the_sky_and_on_the_ground_hold_no_target(at, sky, ground):
    mission = mission_of(house(0, 0, (10, 10, 20)))
    camera = looking((0.0, -100.0, 30.0), at)
    found = find(mission, [Glance(camera, ScreenBox(0.0, 0.2, -0.15, 0.05))])
    assert found.choices == (None,)
    assert held(found.clustered.seen[0]) == pytest.approx((sky, ground, 0.0))


def test_a_name_of_the_file_is_the_targets_name():
    town, church = house(30, 0, (10, 10, 10)), house(0, 0, (10, 10, 20))
    mission = mission_of(town, church, names=("scene", "St. Mary"))
    assert [
        t.name for t in find(mission, [glance(town, (40, -60, 20)), glance(church, (0, -60, 20))]).targets
    ] == [
        None,
        "St. Mary",
    ]


def test_two_keyframes_of_one_building_are_one_target_and_a_bare_frame_is_no_fault():
    tower = tube((0, 0), 6.0, 25.0)
    mission = mission_of(tower)
    glances = [glance(tower, eye) for eye in around(60, 20)]
    target = only(find(mission, [*glances, Glance(glances[0].camera, FRAME)]))
    assert target.glances == (0, 1, 2, 3)
    assert target.cylinder.radius == pytest.approx(6.0, rel=0.02)


def test_nothing_is_found_in_nothing():
    mission: MissionIR = mission_of(house(0, 0, (10, 10, 20)))
    assert find(mission, []).targets == ()
