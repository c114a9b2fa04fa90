"""Polygons around circles."""

from __future__ import annotations

import numpy as np
import pytest

from shotc.geom.solid_arrays.rings import POLYGON_SIDES, ring


@pytest.mark.parametrize("sides", [3, 4, POLYGON_SIDES])
def test_the_sides_of_a_ring_touch_its_circle_in_their_middles(sides: int) -> None:
    corners = ring(2.0, sides)
    middles = 0.5 * (corners + np.roll(corners, -1, axis=0))
    assert len(corners) == sides
    assert np.linalg.norm(middles, axis=1) == pytest.approx(2.0)
