"""Clearances that taper are bounded at every instant."""

import numpy as np
import pytest

from shotc.geom.bernstein import Piecewise
from shotc.geom.pieces import pieces
from shotc.geom.proof import inf_tapered
from shotc.geom.solids import Cylinder, Prism, Solid, distance
from shotc.geom.taper import TAPER_SLOPE, Taper

MAST = Cylinder((0.0, 0.0), 2.0, 0.0, 10.0)
CORNER = Prism(((0.0, 0.0), (8.0, 0.0), (8.0, 2.0), (2.0, 2.0), (2.0, 8.0), (0.0, 8.0)), 0.0, 6.0)


def curve(seed: int) -> Piecewise:
    draw = np.random.default_rng(seed)
    ctrl = np.cumsum(draw.normal(0.0, 1.5, (4, 6, 3)).reshape(-1, 3), axis=0).reshape(4, 6, 3)
    return Piecewise(np.arange(5.0), ctrl + np.array([9.0, 6.0, 5.0]))


def taper_at_ends(of: Piecewise, solid: Solid) -> Taper:
    ends = of(np.array([of.start, of.end]))
    return Taper(5.0, TAPER_SLOPE, ends, np.array([distance(solid, tuple(map(float, end))) for end in ends]))


@pytest.mark.parametrize("solid", [MAST, CORNER], ids=["convex", "not convex"])
@pytest.mark.parametrize("seed", range(6))
def test_the_bound_is_below_every_value_and_attained(seed: int, solid: Solid) -> None:
    flown = curve(seed)
    taper = taper_at_ends(flown, solid)
    found = inf_tapered(pieces(flown), solid, taper, lambda _: 1e-6)
    places = flown(np.linspace(flown.start, flown.end, 4001))
    gaps = np.array([distance(solid, tuple(map(float, p))) for p in places])
    value = np.maximum(gaps, taper.clearance + gaps - taper.needs(places))
    assert found.proven <= value.min() + 1e-9
    assert found.attained - found.proven <= 1e-6
    assert value.min() - 0.02 <= found.attained <= value.min() + 1e-6


def test_what_is_needed_grows_by_half_a_metre_with_each_from_an_end_up_to_the_clearance() -> None:
    taper = Taper(5.0, TAPER_SLOPE, np.array([[4.0, 0.0, 5.0], [30.0, 0.0, 5.0]]), np.array([2.0, 28.0]))
    needs = taper.needs(np.array([[4.0, 0.0, 5.0], [6.0, 0.0, 5.0], [4.0, 0.0, 9.0], [20.0, 0.0, 5.0]]))
    assert needs == pytest.approx([2.0, 3.0, 4.0, 5.0])


def test_where_a_way_rests_at_a_near_end_nothing_is_lacking() -> None:
    still = Piecewise(np.array([0.0, 9.0]), np.tile([3.5, 0.0, 5.0], (1, 6, 1)))
    found = inf_tapered(pieces(still), MAST, taper_at_ends(still, MAST), lambda _: 1e-6)
    assert found.proven == pytest.approx(5.0)
