"""What is inside of closed bodies, and which bodies are closed."""

from __future__ import annotations

import numpy as np

from shotc.ir.obstacle_mesh import obstacle_mesh
from tests.support.scenes import cone, fine, house, quad, turned

BOX = (8.0, 6.0, 4.0, 6.0)


def mesh(*parts):
    number = np.concatenate([np.full(len(part), k) for k, part in enumerate(parts)])
    names = tuple(f"part {k}" for k in range(len(parts)))
    return obstacle_mesh("scene", "a.ply", np.concatenate(parts), (number, names))


def in_house(p):
    """Whether a point is in the house BOX about the origin, by arithmetic."""
    width, depth, eaves, ridge = BOX
    roof = eaves + (ridge - eaves) * (1.0 - 2.0 * np.abs(p[:, 1]) / depth)
    return (np.abs(p[:, 0]) < width / 2) & (np.abs(p[:, 1]) < depth / 2) & (p[:, 2] > 0) & (p[:, 2] < roof)


def test_points_are_inside_of_a_house_as_arithmetic_says():
    made = mesh(fine(house(*BOX), 2))
    assert made.closed.all()
    p = np.random.default_rng(1).uniform([-6, -5, -1], [6, 5, 8], size=(4000, 3))
    assert (made.holds(p) == in_house(p)).all()


def test_places_below_edges_and_corners_of_triangles_are_told_right():
    made = mesh(fine(house(*BOX), 2))
    p = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 2.0], [2.0, 1.5, 1.0], [0.0, 0.0, -1.0], [4.5, 0.0, 1.0]])
    assert made.holds(p).tolist() == [True, True, True, False, False]


def test_what_is_in_two_houses_that_overlap_is_inside():
    one = house(*BOX)
    made = mesh(one, turned(one, 0.4, (1.0, 0.5)))
    assert made.closed.tolist() == [True, True]
    assert len(set(made.body.tolist())) == 2
    assert made.holds(np.array([[0.5, 0.2, 1.0], [0.5, 0.2, 9.0]])).tolist() == [True, False]


def test_what_is_open_has_no_inside():
    without_floor = house(*BOX)[:-2]
    roof = quad((-5, -5, 3), (5, -5, 3), (5, 5, 3), (-5, 5, 3))
    made = mesh(
        without_floor,
        roof,
        turned(cone(2.0, 1.0, 6.0)[:-1], 0.0, (40, 0)),
        house(*BOX) + np.array([20.0, 0.0, 0.0]),
    )
    of = {made.name_at(k): bool(made.closed[made.body[k]]) for k in range(len(made.part))}
    assert of == {"part 0": False, "part 1": False, "part 2": True, "part 3": True}
    assert made.holds(np.array([[0.0, 0.0, 1.0], [20.0, 0.0, 1.0]])).tolist() == [False, True]


def test_a_scene_of_one_part_has_the_bodies_that_it_is_made_of():
    far = house(*BOX) + np.array([20.0, 0.0, 0.0])
    made = mesh(np.concatenate([house(*BOX), far, quad((-5, -5, 9), (5, -5, 9), (5, 5, 9), (-5, 5, 9))]))
    assert sorted(made.closed.tolist()) == [False, True, True]
    assert made.holds(np.array([[0.0, 0.5, 1.0], [20.0, 0.5, 1.0], [10.0, 0.0, 1.0]])).tolist() == [
        True,
        True,
        False,
    ]


def test_points_of_a_cloud_have_no_inside():
    p = np.random.default_rng(1).normal(size=(50, 1, 3))
    made = mesh(np.repeat(p, 3, axis=1))
    assert not made.closed.any()
    assert not made.holds(np.zeros((3, 3))).any()
