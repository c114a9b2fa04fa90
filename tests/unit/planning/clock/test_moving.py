"""Planes beside what moves: what is left out for being far away would have changed nothing."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from shotc.geom.bernstein import Array
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
    each = [
        m.what.clearance + m.deviation_bound - separate(m.what.part, relative_to(m, way))[1] for m in moving
    ]
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
