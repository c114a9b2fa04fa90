"""What is inside of closed bodies, and which bodies are closed."""

from __future__ import annotations

import numpy as np

from shotc.geom.surface.inside import bodies
from shotc.ir.obstacle_mesh import obstacle_mesh
from tests.support.scenes import cone, fine, house, quad, turned
from tests.support.surfaces import some_triangles

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


def union_find(triangles):
    """The least triangle of the body of each, and whether that is closed, in plain Python."""
    lead = list(range(len(triangles)))
    edges = {}

    def root(k):
        while lead[k] != k:
            k = lead[k]
        return k

    for k, t in enumerate(np.rint(triangles * 1e6).astype(int).tolist()):
        for i in range(3):
            a, b = sorted((tuple(t[i]), tuple(t[i - 1])))
            if a != b:
                edges.setdefault((a, b), []).append(k)
    for of in edges.values():
        for k in of[1:]:
            one, other = sorted((root(of[0]), root(k)))
            lead[other] = one
    least = [root(k) for k in range(len(triangles))]
    open_ones = {root(of[0]) for of in edges.values() if len(of) % 2}
    used = {k for of in edges.values() for k in of}
    return least, [r not in open_ones and k in used for k, r in enumerate(least)]


def test_bodies_are_those_of_a_search_along_edges():
    random = np.random.default_rng(3)
    for size in (1.0, 2.0, 5.0) * 4:
        triangles = np.rint(size * some_triangles(random, 60))
        triangles = np.concatenate([triangles, np.rint(fine(house(*BOX), 1))])[random.permutation(120)]
        made = bodies(triangles)
        least, closed = union_find(triangles)
        assert len(set(zip(least, made.body.tolist(), strict=True))) == len(set(least)) == len(made.closed)
        assert made.closed[made.body].tolist() == closed
