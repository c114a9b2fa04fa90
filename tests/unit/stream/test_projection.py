"""Local frames lay the globe out as the autopilots' own sources do."""

from __future__ import annotations

from math import acos, cos, radians, sin

import numpy as np
import pytest

from shotc.geom.geodetic import to_world
from shotc.stream.messages import GlobeFix
from shotc.stream.projection import LocalFrame, azimuthal, equirectangular

ORIGIN = GlobeFix(47.3769, 8.5417, 408.0)
PLACES = [(47.3769, 8.5417), (47.3795, 8.5417), (47.3769, 8.5460), (47.3700, 8.5500), (47.38, 8.53)]


@pytest.mark.parametrize(("lat", "lon"), PLACES[1:])
def test_px4_is_azimuthal_equidistant_on_a_sphere(lat, lon):
    (north,), (east,) = azimuthal(np.array([lat]), np.array([lon]), ORIGIN)
    a, b, turn = radians(lat), radians(ORIGIN.lat), radians(lon - ORIGIN.lon)
    c = acos(sin(b) * sin(a) + cos(b) * cos(a) * cos(turn))
    k = c / sin(c) * 6371000.0
    # The arc cosine of what is all but 1 keeps eight digits of a kilometre.
    assert north == pytest.approx(k * (cos(b) * sin(a) - sin(b) * cos(a) * cos(turn)), abs=2e-3)
    assert east == pytest.approx(k * cos(a) * sin(turn), abs=2e-3)
    assert north**2 + east**2 == pytest.approx((c * 6371000.0) ** 2, rel=1e-5)


def test_the_origin_is_where_all_is_zero():
    for layout in (azimuthal, equirectangular):
        north, east = layout(np.array([ORIGIN.lat]), np.array([ORIGIN.lon]), ORIGIN)
        assert (north[0], east[0]) == (0.0, 0.0)


def test_ardupilot_goes_by_the_mean_latitude():
    (north,), (east,) = equirectangular(np.array([47.3869]), np.array([8.5517]), ORIGIN)
    assert north == pytest.approx(0.01 * 1e7 * 0.011131884502145034, rel=1e-6)
    assert east == pytest.approx(north * cos(radians(47.3819)), rel=1e-6)


def test_the_ellipsoid_would_be_off_by_as_much_as_a_home_may_be():
    place = (47.3769, 8.5417 + 300 / 75_000)
    true = to_world((*place, 408.0), tuple(ORIGIN))
    (_, east) = azimuthal(np.array([place[0]]), np.array([place[1]]), ORIGIN)
    assert true[0] - east[0] == pytest.approx(0.89, abs=0.05)


def test_heights_are_down_and_raised_to_the_home():
    frame = LocalFrame(azimuthal, ORIGIN, raised=0.4)
    (there,) = frame.of_places(np.array([[ORIGIN.lat, ORIGIN.lon, 418.0]]))
    assert there.tolist() == pytest.approx([0.0, 0.0, -10.4])
