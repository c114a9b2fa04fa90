"""Separating planes: what they prove must be true, whatever the solids and the points."""

from __future__ import annotations

from math import hypot, inf, pi

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from shotc.geom.bernstein import Piecewise
from shotc.geom.solid_arrays.planes import separate
from shotc.geom.solid_arrays.points import bounded, closest_points, distances, support
from shotc.geom.solid_arrays.segments import segment_distances
from shotc.geom.solids import Cylinder, Prism, box, convex_parts, distance
from shotc.planning.free_space import (
    COMFORT_M,
    Disc,
    FreeSpace,
    Obstacle,
    Wall,
    blocked,
    breaches,
    corridor,
    shortfall,
)
from tests.support.owners import owner

metres = st.floats(-15, 15)
cylinders = st.builds(
    lambda c, r, b, h: Cylinder(c, r, b, b + h),
    st.tuples(metres, metres), st.floats(0.05, 8), metres, st.floats(0.1, 20),
)  # fmt: skip
boxes = st.builds(
    box,
    st.tuples(metres, metres, metres),
    st.tuples(st.floats(0.1, 12), st.floats(0.1, 12), st.floats(0.1, 12)),
    st.floats(0, 2 * pi),
)
solids = st.one_of(cylinders, boxes)
points = st.tuples(metres, metres, metres).map(np.array)


def hulls(count):
    return st.lists(points, min_size=count, max_size=count).map(np.array)


@pytest.mark.slow
@given(solids, points)
def test_many_points_at_once_agree_with_one_at_a_time(solid, p):
    assert float(distances(solid, p)) == pytest.approx(distance(solid, tuple(p)), abs=1e-9)
    q = closest_points(solid, p)
    assert hypot(*(q - solid.closest(tuple(p)))) < 1e-6 or distances(solid, p) == pytest.approx(
        hypot(*(p - q))
    )


@pytest.mark.slow
@given(solids, points)
def test_support_agrees(solid, n):
    up = max(n[2] * solid.bottom, n[2] * solid.top)
    if isinstance(solid, Cylinder):
        level = n[:2] @ solid.centre + solid.radius * hypot(*n[:2])
    else:
        level = max(n[:2] @ corner for corner in solid.points)
    assert float(support(solid, n)) == pytest.approx(level + up, abs=1e-9)


@pytest.mark.slow
@settings(max_examples=60)
@given(solids, points, points)
def test_the_distance_of_a_segment_is_that_of_its_nearest_point(solid, a, b):
    x = np.linspace(0, 1, 2001)[:, None]
    sampled = float(distances(solid, (1 - x) * a + x * b).min())
    found = float(segment_distances(solid, a[None], b[None])[0])
    # As stated: good to the square of 1e-7 of the length, and to 1e-7 where the segment meets the solid.
    assert found <= sampled + 1e-7 * np.linalg.norm(b - a) + 1e-9
    assert found >= sampled - np.linalg.norm(b - a) / 2000


@pytest.mark.slow
@settings(max_examples=80)
@given(solids, hulls(6), st.integers(0, 99))
def test_a_gap_proves_a_distance(solid, hull, seed):
    normal, gap = separate(solid, hull[None])
    assume(gap[0] > 0)
    assert np.linalg.norm(normal[0]) == pytest.approx(1.0)
    weights = np.random.default_rng(seed).dirichlet(np.ones(6), size=100)
    assert float(distances(solid, weights @ hull).min()) >= gap[0] - 1e-9


@pytest.mark.slow
@settings(max_examples=60)
@given(solids, points, points)
def test_the_gap_of_a_segment_is_nearly_its_distance(solid, a, b):
    true = float(segment_distances(solid, a[None], b[None])[0])
    assume(true > 0.05)
    _, gap = separate(solid, np.stack([a, b])[None])
    assert gap[0] <= true + 1e-9
    assert gap[0] >= 0.9 * true - 0.01


@pytest.mark.slow
@settings(max_examples=80)
@given(solids, hulls(2), hulls(6), st.floats(0.1, 2))
def test_control_points_beyond_the_plane_keep_the_curve_clear(solid, chord, ctrl, clearance):
    """The corridor's whole promise: all six points beyond the half-space, all of the curve clear."""
    space = FreeSpace((Obstacle(owner("zone z"), solid, clearance),), (), ())
    planes = corridor(space, chord[None], 1e3)
    assume(len(planes.piece))
    n, offset = planes.normal[0], planes.offset[0, 0]
    assume(float(distances(solid, chord).min()) > clearance)
    moved = ctrl + np.maximum(0.0, offset - ctrl @ n)[:, None] * n  # push stray points onto the plane
    assume(offset >= float(support(solid, n)) + clearance - 1e-9)
    curve = Piecewise(np.array([0.0, 1.0]), moved[None])
    assert float(distances(solid, curve(np.linspace(0, 1, 200))).min()) >= clearance - 1e-7


def test_a_piece_keeps_half_of_what_there_is_but_no_more_than_comfort():
    solid = Cylinder((0.0, 0.0), 2.0, 0.0, 10.0)
    space = FreeSpace((Obstacle(owner("zone z"), solid, 1.0),), (), ())
    for distance_, kept in ((1.2, 1.1), (9.0, 1.0 + COMFORT_M)):
        chord = np.array([[[2 + distance_, -1.0, 5.0], [2 + distance_, 1.0, 5.0]]])
        planes = corridor(space, chord, 100.0)
        assert planes.offset[0, 0] - support(solid, planes.normal)[0] == pytest.approx(kept, abs=0.02)


def test_unbounded_pockets_have_level_planes():
    pocket = bounded(Prism(((0, 0), (1, 0), (0, 1)), -inf, inf))
    normal, gap = separate(pocket, np.array([[[3.0, 0.0, 5.0], [3.0, 2.0, 9.0]]]))
    assert normal[0, 2] == 0.0
    assert gap[0] == pytest.approx(2.0, abs=1e-6)


def test_breaches_name_what_is_too_near_the_worst_first():
    space = FreeSpace(
        (Obstacle(owner("zone a"), Cylinder((0.0, 0.0), 1.0, 0.0, 5.0), 1.0),),
        (Wall(owner("ground"), (0.0, 0.0, 1.0), 2.6),),
        (Disc(owner("zone ring"), (0.0, 0.0), 30.0),),
    )
    found = breaches(space, np.array([1.5, 0.0, 1.0]))
    assert [(str(b.owner), round(b.lack, 6)) for b in found] == [("ground", 1.6), ("zone a", 0.5)]
    assert [str(b.owner) for b in breaches(space, np.array([31.0, 0.0, 5.0]))] == ["zone ring"]
    assert tuple(map(str, space.owners)) == ("zone a", "ground", "zone ring")
    assert tuple(map(str, space.without(owner("zone a")).owners)) == ("ground", "zone ring")
    assert space.lent(0.4).obstacles[0].clearance == pytest.approx(0.6)


def test_blocked_spares_ends_that_are_legal_but_close():
    space = FreeSpace((Obstacle(owner("zone a"), Cylinder((0.0, 0.0), 1.0, 0.0, 5.0), 1.0),), (), ())
    a = np.array([[2.001, 0.0, 2.0], [2.001, 0.0, 2.0], [-9.0, 0.0, 2.0]])
    b = np.array([[9.0, 0.0, 2.0], [-9.0, 0.0, 2.0], [9.0, 0.0, 2.0]])
    assert blocked(space, a, b)[:, 0].tolist() == [False, True, True]


def test_shortfall_is_positive_exactly_where_nothing_is_proved():
    (part,) = convex_parts(box((0, 0, 5), (2, 2, 10), 0))
    space = FreeSpace(
        (Obstacle(owner("zone a"), part, 0.5),), (Wall(owner("ground"), (0.0, 0.0, 1.0), 1.0),), ()
    )
    clear = np.tile([4.0, 0.0, 5.0], (6, 1))
    low = np.tile([4.0, 0.0, 0.8], (6, 1))
    near = np.tile([1.3, 0.0, 5.0], (6, 1))
    assert shortfall(space, np.stack([clear, low, near])) == pytest.approx([-2.5, 0.2, 0.2])
