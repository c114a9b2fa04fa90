"""Places on earth in W: the projection of many places is that of each."""

from __future__ import annotations

import numpy as np
import pytest

from shotc.geom.geodetic import above_ground, onto_plane


@pytest.mark.parametrize(
    "origin", [(46.68, 7.68, 500.0), (-33.9, 151.2, 5.0), (0.0, 180.0, 0.0), (78.2, 15.6, 300.0)]
)
def test_places_on_the_plane_are_those_of_height_zero(origin):
    put = onto_plane(origin)
    for lat, lon in np.random.default_rng(1).uniform(-0.09, 0.09, (50, 2)) + origin[:2]:
        x, y, _ = above_ground((lat, lon, 0.0), origin)
        assert put(lat, lon) == pytest.approx((x, y), abs=1e-6)
