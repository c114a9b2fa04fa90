"""Whether a solid stands between two points: the plain function against the one on arrays."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import assume, example, given
from hypothesis import strategies as st

from shotc.geom.line_of_sight import crosses, gap_beside
from shotc.geom.solid_arrays.segments import blocks
from shotc.geom.solids import Cylinder, Prism, Solid, box, signed_distance

SOLIDS = (
    (Cylinder((1.0, 0.5), 2.0, 0.0, 3.0), (1.0, 0.5)),
    (box((0.0, 1.0, 2.0), (3.0, 2.0, 4.0), 0.4), (0.0, 1.0)),
    (Prism(((0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (3.0, 1.0)), 0.0, 3.0), (3.4, 1.0)),
)
"""Solids, each with a place inside from which all of its walls are seen."""

point = st.tuples(*[st.floats(-6, 6)] * 3)


def resized(solid: Solid, middle: tuple[float, float], by: float) -> Solid:
    """Return a solid with all its places so many times as far from its middle."""
    centre, half = 0.5 * (solid.bottom + solid.top), 0.5 * by * (solid.top - solid.bottom)
    bottom, top = centre - half, centre + half
    if isinstance(solid, Cylinder):
        return Cylinder(solid.centre, by * solid.radius, bottom, top)
    x, y = middle
    return Prism(tuple((x + by * (u - x), y + by * (v - y)) for u, v in solid.points), bottom, top)


@pytest.mark.slow
@given(a=point, b=point, which=st.integers(0, 2))
@example(a=(0.0, 0.0, 4.0), b=(0.0, -1e-9, 0.0), which=2)  # past an acute corner
def test_it_agrees_with_the_one_on_arrays(a, b, which) -> None:
    assume(np.linalg.norm(np.subtract(a, b)) > 0.1)
    solid, middle = SOLIDS[which]
    smaller, larger = (crosses(resized(solid, middle, by), a, b) for by in (0.999, 1.001))
    assume(smaller == larger)  # not at the very edge
    assert crosses(solid, a, b) == larger
    assert bool(blocks(solid, np.array([a]), np.array(b))[0]) == larger


def test_a_line_along_a_wall_is_met_where_the_wall_is_and_not_on_its_way_beyond() -> None:
    room = Prism(((0.0, 0.0), (4.0, 0.0), (4.0, 2.0), (0.0, 2.0)), 0.0, 3.0)
    assert crosses(room, (-3.0, 0.0, 1.0), (1.0, 0.0, 1.0))
    assert not crosses(room, (-3.0, 0.0, 1.0), (-1.0, 0.0, 1.0))
    assert not crosses(room, (-3.0, 0.0, 1.0), (-3.0, 0.0, 2.0))  # upright, in the wall's line


SHARES = np.linspace(0.0, 1.0, 201)


def least_distance(solid: Solid, a, b) -> float:
    """Return the least signed distance of a segment's sampled points from a solid."""
    return min(signed_distance(solid, tuple(np.add(a, s * np.subtract(b, a)))) for s in SHARES)


@pytest.mark.slow
@given(a=point, b=point, which=st.integers(0, 1))
def test_a_gap_is_positive_where_a_line_passes_and_never_more_than_its_distance(a, b, which) -> None:
    assume(np.hypot(b[0] - a[0], b[1] - a[1]) > 0.1)
    solid, _ = SOLIDS[which]
    gap, away = gap_beside(solid, a, b, 100.0), least_distance(solid, a, b)
    assert gap <= away + 1e-9
    if isinstance(solid, Prism) and abs(gap) > 1e-9:
        assert (gap > 0.0) == (not crosses(solid, a, b))


@pytest.mark.parametrize("scale", [1.0, 1000.0])
@pytest.mark.parametrize(("aside", "height", "gap"), [(3.0, 1.0, 1.0), (0.5, 4.0, 1.0), (0.5, 1.0, -1.5)])
def test_a_gap_beside_a_cylinder_counts_from_its_side_or_its_top(scale, aside, height, gap) -> None:
    """The cylinder has a radius of 2 and is 3 high; the line passes it aside of its axis."""
    solid = Cylinder((0.0, 0.0), 2.0 * scale, -2.0 * scale, 3.0 * scale)
    a, b = (-9.0 * scale, aside * scale, height * scale), (7.0 * scale, aside * scale, height * scale)
    assert gap_beside(solid, a, b, 100.0 * scale) == pytest.approx(gap * scale)
    assert gap_beside(solid, a, b, 0.4 * scale) == pytest.approx(min(gap, 0.4) * scale)


def test_a_gap_beside_a_zone_of_any_height_counts_from_its_sides() -> None:
    tall = Cylinder((0.0, 0.0), 2.0, 0.0, float("inf"))
    assert gap_beside(tall, (-9.0, 3.0, 500.0), (9.0, 3.0, 0.0), 100.0) == pytest.approx(1.0)


@pytest.mark.parametrize("turned", [False, True])
def test_only_the_segment_counts_for_how_far_it_passes_and_not_the_line_beyond_its_ends(
    turned: bool,
) -> None:
    # West of the walls x = 10 to 20 by 8 - 5 s, south of y = 0 to 10 by 10 - 6.5 s: equal at s = 4 / 3.
    ends = (2.0, -10.0, 5.0), (7.0, -3.5, 5.0)
    a, b = ends[::-1] if turned else ends
    assert gap_beside(box((15.0, 5.0, 5.0), (10.0, 10.0, 10.0), 0.0), a, b, 9.0) == pytest.approx(3.5)
