"""Planes beside what moves: what is left out for being far away would have changed nothing."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from shotc.geom.bernstein import Array
from shotc.geom.proof import box_gap
from shotc.geom.solid_arrays.planes import CLOSE_SHARE, separate
from shotc.geom.solids import Cylinder
from shotc.ir.owners import Owner
from shotc.planning.clock.moving import (
    REACH_M,
    LinearMotion,
    Moving,
    linearised,
    relative_to,
    shortfalls,
    sides,
)
from shotc.planning.free_space import beside

PIECES = 12
BREAKS = np.linspace(0.0, 6.0, PIECES + 1)

seeds = st.integers(0, 2**32 - 1)


def motions(random: np.random.Generator) -> list[LinearMotion]:
    """Bodies of several sizes that cross the same ground, each with a clearance of its own."""
    made = []
    for _ in range(4):
        start, velocity = random.uniform(-30, 30, 3), random.uniform(-5, 5, 3)
        part = Cylinder((0.0, 0.0), float(random.uniform(0.2, 4.0)), -2.0, 2.0)
        what = Moving(
            Owner("target", "t", ("targets", "t")),
            part,
            float(random.uniform(0.5, 6.0)),
            lambda t, s=start, v=velocity: s + np.outer(t, v),
        )
        made.append(linearised(what, BREAKS))
    return made


def hulls(random: np.random.Generator) -> Array:
    """A way with a wobble: shape (PIECES, 6, 3)."""
    line = np.linspace(random.uniform(-30, 30, 3), random.uniform(-30, 30, 3), PIECES * 6)
    return (line + random.uniform(-0.3, 0.3, line.shape)).reshape(PIECES, 6, 3)


@pytest.mark.slow
@given(seeds)
def test_a_shortfall_is_the_worst_of_all_motions(seed: int) -> None:
    random = np.random.default_rng(seed)
    moving, way = motions(random), hulls(random)
    each = []
    for m in moving:
        relative, part = relative_to(m, way), m.what.part
        box = box_gap(relative, part)
        gap = np.maximum(separate(part, relative)[1], np.where(box > 0.0, box, -np.inf))
        each.append(m.what.clearance + m.deviation_bound - gap)
    # Planes are sought until all of those that are asked together are as near to the best as that.
    assert np.allclose(shortfalls(moving, way), np.max(each, axis=0), atol=CLOSE_SHARE * 100.0)


@pytest.mark.slow
@given(seeds, st.floats(-5.0, 5.0))
def test_a_shortfall_is_told_from_the_least_that_is_asked_on(seed: int, least: float) -> None:
    random = np.random.default_rng(seed)
    moving, way = motions(random), hulls(random)
    found, every = shortfalls(moving, way, least), shortfalls(moving, way)
    assert np.allclose(found, np.maximum(every, least), atol=CLOSE_SHARE * 100.0)
    assert (found >= least).all()


@pytest.mark.slow
@given(seeds)
def test_every_piece_within_reach_has_its_plane(seed: int) -> None:
    random = np.random.default_rng(seed)
    moving, way = motions(random), hulls(random)
    planes = sides(moving, way)
    has = set(zip(planes.owner.tolist(), planes.piece.tolist(), strict=True))
    for index, motion in enumerate(moving):
        gap = separate(motion.what.part, relative_to(motion, way))[1] - motion.needs[:, 0]
        assert {(index, int(k)) for k in np.flatnonzero(gap < REACH_M - 0.05)} <= has


def test_a_half_space_that_a_piece_keeps_proves_it_where_the_search_for_a_plane_ends_short_of_it() -> None:
    part, clearance = Cylinder((0.0, 0.0), 2.5, 0.0, 10.0), 0.4
    what = Moving(Owner("zone", "mast", ("world",)), part, clearance, lambda t: np.zeros((len(t), 3)))
    standing = linearised(what, np.array([0.0, 1.0]))
    along = np.linspace(-0.5, 2.5, 6)
    # Both ends of an arc are exactly as far away as is needed; the rest is farther.
    off = part.radius + clearance + np.array([0.0, 0.10, 0.15, 0.15, 0.10, 0.0])
    angle = 0.24
    ahead, aside = np.array([np.cos(angle), np.sin(angle)]), np.array([-np.sin(angle), np.cos(angle)])
    piece = np.column_stack([np.outer(along, ahead) + np.outer(off, aside), np.full(6, 5.0)])[None]
    normal = np.array([[*aside, 0.0]])
    kept = beside(np.array([0]), normal, np.full((1, 2), part.radius + clearance))
    assert 1e-3 < shortfalls((standing,), piece)[0] < 0.05
    assert shortfalls((standing,), piece, planes=kept)[0] == pytest.approx(0.0, abs=1e-9)
    # A half-space that the piece does not keep proves nothing.
    nearer = piece - 0.2 * np.array([*aside, 0.0])
    assert shortfalls((standing,), nearer, planes=kept)[0] == pytest.approx(0.2, abs=0.01)
    assert shortfalls((standing,), piece - np.array([*(2.9 * aside), 0.0]), planes=kept)[0] > clearance
