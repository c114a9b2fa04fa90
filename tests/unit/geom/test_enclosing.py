"""Boxes and cylinders about prisms: they hold all of them, and little beside."""

from __future__ import annotations

from math import cos, hypot, pi, sin

import numpy as np
import pytest

from shotc.geom.enclosing import (
    MOST_PIECES,
    EnclosingShape,
    UprightPrism,
    _Aligned,
    _common,
    bodies_about,
)
from shotc.geom.shapes import BoxShape, CylinderShape
from shotc.geom.solids import signed_area

L = ((0.0, 0.0), (12.0, 0.0), (12.0, 5.0), (6.0, 5.0), (6.0, 9.0), (0.0, 9.0))


def turned(ring, angle, at=(0.0, 0.0)):
    c, s = cos(angle), sin(angle)
    return tuple((at[0] + x * c - y * s, at[1] + x * s + y * c) for x, y in ring)


def gap(bodies: tuple[EnclosingShape, ...], p) -> float:
    """Return how far a place is outside of all bodies."""
    return min(b.shape.gap((p[0] - b.centre[0], p[1] - b.centre[1], p[2] - b.centre[2])) for b in bodies)


def volume(body: EnclosingShape) -> float:
    shape = body.shape
    base = shape.length * shape.width if isinstance(shape, BoxShape) else pi * shape.radius**2
    return base * shape.height


def inner(block: UprightPrism, rng, count=200):
    """Return places in a block whose ring is star-shaped about its first three corners' middle, or any."""
    ring = np.array(block.ring)
    share = rng.uniform(0, 1, (count, 1))
    i = rng.integers(0, len(ring), count)
    level = ring[i] + share * (np.roll(ring, -1, axis=0)[i] - ring[i])
    return np.column_stack([level, rng.uniform(block.bottom, block.top, count)])


@pytest.mark.parametrize("angle", [0.0, 0.3, 1.2])
def test_an_l_is_two_boxes_without_its_notch(angle):
    bodies = bodies_about([UprightPrism(turned(L, angle, (40, -7)), 2.0, 10.0)], 8)
    assert sorted(map(volume, bodies)) == pytest.approx([8 * 30, 8 * 54]) or sorted(
        map(volume, bodies)
    ) == pytest.approx([8 * 24, 8 * 60])
    assert all(b.centre[2] == 6.0 and b.shape.height == 8.0 for b in bodies)


def test_a_rectangle_is_one_box_that_lies_as_it_does():
    (body,) = bodies_about([UprightPrism(turned(((0, 0), (10, 0), (10, 4), (0, 4)), 0.4), 0.0, 5.0)], 8)
    assert isinstance(body.shape, BoxShape)
    assert (body.shape.length, body.shape.width) == pytest.approx((10, 4))
    assert abs(body.shape.ahead[0] * cos(0.4) + body.shape.ahead[1] * sin(0.4)) == pytest.approx(1)


def test_what_is_round_is_a_cylinder():
    ring = tuple((3 + 5 * cos(k * pi / 8), 5 * sin(k * pi / 8)) for k in range(16))
    (body,) = bodies_about([UprightPrism(ring, 0.0, 20.0)], 8)
    assert isinstance(body.shape, CylinderShape)
    assert body.shape.radius == pytest.approx(5)
    assert body.centre == pytest.approx((3, 0, 10))


def test_a_tower_stays_apart_from_its_nave_and_halves_of_a_nave_do_not():
    nave = [
        UprightPrism(((0, 0), (15, 0), (15, 10), (0, 10)), 0, 12, "w"),
        UprightPrism(((15, 0), (30, 0), (30, 10), (15, 10)), 0, 12),
    ]
    tower = UprightPrism(((30, 2), (36, 2), (36, 8), (30, 8)), 0, 40, "tower")
    bodies = bodies_about([*nave, tower], 8)
    assert [(b.shape.height, b.name) for b in bodies] == [(12, ""), (40, "tower")]


def test_many_parts_become_few_bodies_that_hold_them_all():
    rng = np.random.default_rng(3)
    blocks = []
    for _ in range(40):
        x, y, side, top = *rng.uniform(0, 60, 2), rng.uniform(1, 9), rng.uniform(4, 50)
        ring = turned(((0, 0), (side, 0), (side, side), (0, side)), rng.uniform(0, 3), (x, y))
        blocks.append(UprightPrism(ring, rng.uniform(0, 3), top))
    bodies = bodies_about(blocks, 8)
    assert len(bodies) <= 8
    assert all(gap(bodies, p) < 1e-9 for block in blocks for p in inner(block, rng, 20))


@pytest.mark.slow
def test_any_ring_is_held_and_cuts_take_away_what_is_beside_it():
    rng = np.random.default_rng(7)
    shares = []
    for _ in range(60):
        count = int(rng.integers(3, 14))
        turn = np.sort(rng.uniform(0, 2 * pi, count))
        if np.max(np.diff(np.append(turn, turn[0] + 2 * pi))) > 3.0:
            continue
        far = rng.uniform(2, 12, count)
        ring = tuple((float(r * cos(a)), float(r * sin(a))) for r, a in zip(far, turn, strict=True))
        block = UprightPrism(ring, 0.0, 6.0)
        bodies = bodies_about([block], 8)
        assert all(gap(bodies, p) < 1e-9 for p in inner(block, rng))
        circle = pi * max(hypot(*p) for p in ring) ** 2
        assert sum(map(volume, bodies)) <= 6.0 * circle * 1.3
        shares.append(6.0 * signed_area(ring) / sum(map(volume, bodies)))
    assert np.mean(shares) > 0.55


@pytest.mark.parametrize("turned_round", [False, True])
def test_a_ring_becomes_at_most_six_pieces(turned_round):
    # Stairs of twenty steps: a cut takes an eighth away or more, again and again.
    steps = [p for k in range(20, 0, -1) for p in ((k, k), (k - 1, k))]
    ring = ((0, 0), (20, 0), *steps)
    stairs = UprightPrism(turned(ring, 3.0 if turned_round else 0.0), 0.0, 5.0)
    bodies = bodies_about([stairs], 20)
    assert 4 <= len(bodies) <= MOST_PIECES
    rng = np.random.default_rng(1)
    assert all(gap(bodies, p) < 1e-9 for p in inner(stairs, rng))


@pytest.mark.parametrize("axis", [0, 1, 2])
@pytest.mark.parametrize(
    ("low", "high", "width"), [(1.0, 5.0, 1.0), (0.5, 1.5, 1.0), (-3.0, 0.5, 0.5), (3.0, 4.0, 0.0)]
)
def test_the_volume_that_two_boxes_have_in_common(axis: int, low: float, high: float, width: float) -> None:
    least, most = np.zeros(3), np.full(3, 2.0)
    one = _Aligned((), (0.0, 0.0, 0.0), (2.0, 2.0, 2.0))
    least[axis], most[axis] = low, high
    other = _Aligned((), tuple(least), tuple(most))
    assert _common(one, other) == _common(other, one) == 4.0 * width


@pytest.mark.parametrize(("notch", "bodies"), [(1.9, 1), (2.1, 2), (5.0, 2)])
def test_a_ring_is_cut_where_it_fills_less_than_four_fifths_of_its_box(notch: float, bodies: int) -> None:
    """A square of ten metres without a corner of 10 m times as much as the notch says."""
    low = 10.0 - 2 * notch
    ring = ((0.0, 0.0), (10.0, 0.0), (10.0, low), (5.0, low), (5.0, 10.0), (0.0, 10.0))
    found = bodies_about([UprightPrism(ring, 0.0, 5.0)], 8)
    assert len(found) == bodies
    assert sum(map(volume, found)) == pytest.approx(5.0 * (100.0 - 10.0 * notch * (bodies > 1)))


@pytest.mark.parametrize(("longer", "shape"), [(1.0, CylinderShape), (1.2, CylinderShape), (1.3, BoxShape)])
def test_the_smaller_of_a_box_and_a_cylinder_is_taken(longer: float, shape: type) -> None:
    """The box of an ellipse has 4 times the product of its half axes, its circle pi times a square."""
    ring = tuple((longer * cos(k * pi / 8), sin(k * pi / 8)) for k in range(16))
    (body,) = bodies_about([UprightPrism(ring, 0.0, 2.0)], 8)
    assert isinstance(body.shape, shape)
    assert volume(body) == pytest.approx(2.0 * min(4.0 * longer, pi * longer**2), rel=0.03)


@pytest.mark.parametrize("turn", [0.0, 0.7])
def test_a_body_of_several_prisms_reaches_from_the_lowest_to_the_highest(turn: float) -> None:
    """Three stand side by side: the first is the lowest, the second the highest, the third hangs between."""
    square = ((0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0))
    heights = ((1.0, 6.0, "low"), (2.0, 9.0, "high"), (3.0, 5.0, "low"))
    blocks = [
        UprightPrism(turned(square, turn, (4.0 * k * cos(turn), 4.0 * k * sin(turn))), *each)
        for k, each in enumerate(heights)
    ]
    (one,) = bodies_about(blocks, 1)
    assert (one.shape.height, one.centre[2], one.name) == (8.0, 5.0, "")
    assert volume(one) == pytest.approx(12.0 * 4.0 * 8.0)
    apart = bodies_about(blocks, 3)
    assert sorted((b.centre[2] - b.shape.height / 2, b.shape.height, b.name) for b in apart) == [
        (1.0, 5.0, "low"), (2.0, 7.0, "high"), (3.0, 2.0, "low"),
    ]  # fmt: skip
