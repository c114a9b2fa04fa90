"""Systems of coordinates against published points, pyproj, pymap3d and the plain way to W."""

from __future__ import annotations

import sys

import numpy as np
import pymap3d
import pytest
from hypothesis import given
from hypothesis import strategies as st

from shotc.geom import geodetic
from shotc.geom.earth import of_world, to_world
from shotc.geom.terrain.posts import TerrainFault
from shotc.geom.terrain.systems import System, degrees_of_utm, system_of, utm_of_degrees

ORIGIN = (46.68, 7.68, 560.0)


def known(code: int) -> System:
    found = system_of(code)
    assert isinstance(found, System)
    return found


def test_a_published_point_of_utm():
    # The documentation of PROJ: cct +proj=utm +zone=32 of 12 E, 56 N; its ellipsoid is 0.1 mm from WGS84.
    x, y = utm_of_degrees(np.array(56.0), np.array(12.0), 32, True)
    assert (x, y) == (pytest.approx(687071.4391, abs=5e-4), pytest.approx(6210141.3267, abs=5e-4))


def test_the_central_meridian_on_the_equator():
    x, y = utm_of_degrees(np.zeros(1), np.full(1, 9.0), 32, True)
    assert (x[0], y[0]) == (pytest.approx(500_000), pytest.approx(0.0, abs=1e-9))
    _, south = utm_of_degrees(np.zeros(1), np.full(1, 9.0), 32, False)
    assert south[0] == pytest.approx(10_000_000)


@pytest.mark.slow
@given(st.floats(-84, 84), st.floats(-4, 4), st.integers(1, 60))
def test_the_way_there_and_back_ends_where_it_began(lat: float, away: float, zone: int):
    lon = 6 * zone - 183 + away
    x, y = utm_of_degrees(np.array(lat), np.array(lon), zone, lat >= 0)
    back = degrees_of_utm(x, y, zone, lat >= 0)
    assert back[0] == pytest.approx(lat, abs=1e-10)
    assert (back[1] - lon + 180) % 360 == pytest.approx(180, abs=1e-9)


@pytest.mark.parametrize("code", [32601, 32632, 32660, 32719])
def test_utm_is_that_of_pyproj(code: int):
    pyproj = pytest.importorskip("pyproj")
    north, zone = code < 32700, code % 100
    random = np.random.default_rng(code)
    lat = random.uniform(0, 84, 400) * (1 if north else -1)
    lon = 6 * zone - 183 + random.uniform(-4, 4, 400)
    expected = pyproj.Transformer.from_crs(4326, code, always_xy=True).transform(lon, lat)
    found = known(code).of_degrees(lat, lon)
    # The series end at the fourth power of the third flattening: 0.2 um up to 4 degrees beside the meridian.
    assert np.abs(np.array(found) - np.array(expected)).max() < 3e-7
    assert np.abs(np.array(known(code).to_degrees(*expected)) - np.array([lat, lon])).max() < 1e-9


def test_other_systems_are_those_of_pyproj():
    pytest.importorskip("pyproj")
    swiss = known(2056)
    x, y = swiss.of_degrees(np.array([46.95108]), np.array([7.43864]))
    assert (x[0], y[0]) == (pytest.approx(2_600_000, abs=3), pytest.approx(1_200_000, abs=3))  # Bern
    lat, lon = swiss.to_degrees(x, y)
    assert (lat[0], lon[0]) == (pytest.approx(46.95108, abs=1e-7), pytest.approx(7.43864, abs=1e-7))


def test_a_system_that_epsg_does_not_have_is_told():
    pytest.importorskip("pyproj")
    found = system_of(999_999)
    assert isinstance(found, TerrainFault)
    assert found.kind == "system"
    assert "999999" in found.message


def test_without_pyproj_other_systems_are_told(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setitem(sys.modules, "pyproj", None)
    found = system_of(2056)
    assert isinstance(found, TerrainFault)
    assert found.kind == "pyproj"
    assert "shotc[geo]" in found.help
    assert isinstance(system_of(32632), System)


def test_places_are_put_into_the_world_as_one_by_one():
    random = np.random.default_rng(1)
    places = np.column_stack(
        [random.uniform(-89, 89, 50), random.uniform(-180, 180, 50), random.uniform(-100, 5000, 50)]
    )
    expected = [geodetic.to_world((lat, lon, alt), ORIGIN) for lat, lon, alt in places.tolist()]
    points = to_world(places, ORIGIN)
    assert points == pytest.approx(np.array(expected), abs=1e-7)
    assert np.abs(of_world(points, ORIGIN) - places).max() < 1e-7
    other = pymap3d.geodetic2enu(*places.T, *ORIGIN)
    assert points == pytest.approx(np.column_stack(other), abs=1e-4)
