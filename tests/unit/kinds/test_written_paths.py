"""Kinds whose positions the user writes down: keyframes, static, follow-path."""

from __future__ import annotations

from itertools import pairwise
from math import cos, degrees, dist, pi, radians
from pathlib import Path

import pymap3d
import pytest
from hypothesis import given
from hypothesis import strategies as st

from shotc.geom.geodetic import above_ground, to_world
from shotc.ir.limits import Vec3
from shotc.ir.mission import Keyframe
from shotc.kinds.follow_path import thin
from tests.support.front_passes import resolved

HEAD = """\
shotc: 1
mission: kinds
world: {origin: {lat: 47.3769, lon: 8.5417, alt: 408}}
targets:
  tower: {at: [0, 0, 12], radius: 4, height: 24}
drones:
  cam1: {model: x500, home: [0, -60, 0], radius: 0.5, camera: {hfov: 80 deg}}
rules: {composition: phi}
shots:
"""


def keyframes(shot: str, folder: Path | None = None) -> tuple[Keyframe, ...]:
    mission, found = resolved(HEAD + f"  - {{id: a, drone: cam1, {shot}}}\n", folder)
    assert not found, found
    assert mission is not None
    return mission.shots[0].keyframes


def test_keyframes_keep_what_the_user_wrote() -> None:
    a, b, c = keyframes(
        "kind: keyframes, target: tower, keyframes: [{at: [-40, -30, 10], heading: 45 deg, pitch: -4 deg}, "
        "{at: [0, -45, 18], look_at: tower, frame: left-third, hold: 2}, "
        "{at: [50, 20, 15], look_at: [0, 0, 5], hfov: 60 deg}]"
    )
    assert a.at == (-40, -30, 10)
    assert a.aim == pytest.approx((radians(45), radians(-4)))
    assert (a.target, a.composition.name, a.hfov) == ("tower", "phi", pytest.approx(radians(80)))
    assert (b.aim, b.target, b.hold) == (None, "tower", 2)
    assert b.composition.points == ((-1 / 3, 0.0),)
    assert (c.aim, c.target, c.hfov) == ((0, 0, 5), "tower", pytest.approx(radians(60)))
    assert all(k.placed for k in (a, b, c))
    assert b.path == ("shots", 0, "keyframes", 1)


def test_a_compass_heading_becomes_a_yaw_from_east() -> None:
    north, _ = keyframes(
        "kind: keyframes, keyframes: [{at: [0, -45, 9], heading: 0 deg, pitch: 0 deg}, "
        "{at: [0, -50, 9], heading: 270 deg, pitch: 10 deg}]"
    )
    assert north.aim == pytest.approx((pi / 2, 0))
    assert north.target is None


def test_a_still_camera_films_for_the_duration_or_five_seconds() -> None:
    (k,) = keyframes("kind: static, at: [0, -50, 15], look_at: tower")
    assert (k.hold, k.target, k.placed) == (5.0, "tower", True)
    (k,) = keyframes("kind: static, at: [0, -50, 15], heading: 90 deg, pitch: 0 deg, timing: {duration: 12}")
    assert (k.hold, k.target) == (12.0, None)
    assert k.aim == pytest.approx((0.0, 0.0))


def test_a_path_looks_along_itself_or_at_what_it_is_told() -> None:
    along = keyframes("kind: follow-path, points: [[0, 30, 9], [0, 60, 9], [30, 60, 9]], heading: along")
    assert [degrees(k.aim[0]) for k in along if k.aim] == pytest.approx([90, 45, 0])
    assert all(k.target is None for k in along)
    at = keyframes("kind: follow-path, points: [[0, 40, 9], [40, 40, 9]], look_at: [0, 0, 5]")
    assert [k.aim for k in at] == [(0, 0, 5)] * 2
    framed = keyframes("kind: follow-path, target: tower, points: [[0, 50, 9], [50, 50, 9]]")
    assert [(k.aim, k.target) for k in framed] == [(None, "tower")] * 2
    assert framed[1].path == ("shots", 0, "points", 1)


def test_a_path_may_keep_one_heading() -> None:
    """Surveys and flights along a facade look one way, whatever the way of the drone."""
    points = "points: [[0, 30, 9], [0, 60, 9], [30, 60, 9]]"
    survey = keyframes(f"kind: follow-path, {points}, heading: 270 deg, pitch: -90 deg")
    assert [k.aim for k in survey] == [pytest.approx((pi, -pi / 2))] * 3
    assert [(k.heading, k.target) for k in survey] == [(pytest.approx(1.5 * pi), None)] * 3
    level = keyframes(f"kind: follow-path, {points}, heading: 90 deg")
    assert [k.aim for k in level] == [pytest.approx((0.0, 0.0))] * 3


def test_a_vertical_stretch_keeps_the_course() -> None:
    lift = keyframes(
        "kind: follow-path, points: [[0, 30, 9], [0, 30, 19], [0, 60, 19], [0, 60, 9]], heading: along"
    )
    assert [degrees(k.aim[0]) for k in lift if k.aim] == pytest.approx([90] * 4)


def test_routes_come_from_csv_and_gpx_alike(tmp_path: Path) -> None:
    places = [(47.3780, 8.5430, 20.0), (47.3784, 8.5430, 25.0), (47.3784, 8.5440, 25.0)]
    wanted = [pymap3d.geodetic2enu(a, o, h + 408, 47.3769, 8.5417, 408) for a, o, h in places]
    (tmp_path / "r.csv").write_text("lat,lon,height\n" + "".join(f"{a},{o},{h}\n" for a, o, h in places))
    points = "".join(f'<trkpt lat="{a}" lon="{o}"><ele>{h + 408}</ele></trkpt>' for a, o, h in places)
    (tmp_path / "r.gpx").write_text(f"<gpx><trk><trkseg>{points}</trkseg></trk></gpx>")
    (tmp_path / "x.csv").write_text("x,y,z\n" + "".join(f"{x},{y},{z}\n" for x, y, z in wanted))
    for name in ("r.csv", "r.gpx", "x.csv"):
        found = keyframes(f"kind: follow-path, file: {name}, heading: along", tmp_path)
        curve = 5e-3 if name == "r.csv" else 1e-6  # heights count from the plane, elevations from the sea
        assert [k.at for k in found] == [pytest.approx(p, abs=curve) for p in wanted]
    assert found[0].path == ("shots", 0, "file")


def test_a_long_track_is_thinned_and_stops_are_dropped(tmp_path: Path) -> None:
    rows = [(-50 + i / 10, -60.0, 20.0) for i in range(1000)]
    rows = [*rows, *[rows[-1]] * 50, *((49.9, -60 + i / 10, 20.0) for i in range(500))]
    (tmp_path / "r.csv").write_text("".join(f"{x},{y},{z}\n" for x, y, z in rows))
    found = keyframes("kind: follow-path, file: r.csv, heading: along", tmp_path)
    assert 3 <= len(found) < 20
    assert (found[0].at, found[-1].at) == (rows[0], rows[-1])


@pytest.mark.slow
@given(st.lists(st.tuples(*[st.floats(-100, 100)] * 3), min_size=2, max_size=200))
def test_thinning_leaves_no_point_farther_than_the_tolerance(points: list[Vec3]) -> None:
    kept = thin(points, 5.0)
    assert (kept[0], kept[-1]) == (points[0], points[-1])
    lines = list(pairwise(kept))
    assert all(min(_off(p, a, b) for a, b in lines) <= 5.0 + 1e-9 for p in points)


def _off(p: Vec3, a: Vec3, b: Vec3) -> float:
    """Distance to a segment by ternary search: the distance is convex along it."""

    def at(t: float) -> float:
        return dist(p, [x + (y - x) * t for x, y in zip(a, b, strict=True)])

    low, high = 0.0, 1.0
    for _ in range(30):
        left, right = low + (high - low) / 3, high - (high - low) / 3
        low, high = (low, right) if at(left) < at(right) else (left, high)
    return at((low + high) / 2) - dist(a, b) * (high - low)


NEAR_AN_ORIGIN = given(
    st.floats(-85, 85),
    st.floats(-180, 180),
    st.floats(-0.05, 0.05),
    st.floats(-0.05, 0.05),
    st.floats(0, 500),
)
"""Latitude and longitude of an origin, how far off a place is, degrees, and its height."""


@pytest.mark.slow
@NEAR_AN_ORIGIN
def test_places_on_earth_agree_with_pymap3d(
    lat: float, lon: float, dlat: float, dlon: float, h: float
) -> None:
    place, origin = (lat + dlat, lon + dlon, h), (lat, lon, 100.0)
    assert to_world(place, origin) == pytest.approx(pymap3d.geodetic2enu(*place, *origin), abs=1e-6)


@pytest.mark.slow
@NEAR_AN_ORIGIN
def test_a_height_over_the_ground_is_z_and_the_way_back_differs_by_the_curve(
    lat: float, lon: float, dlat: float, dlon: float, height: float
) -> None:
    place, origin = (lat + dlat, lon + dlon, height), (lat, lon, 100.0)
    x, y, z = above_ground(place, origin)
    assert z == height
    there, over, alt = pymap3d.enu2geodetic(x, y, z, *origin)
    assert float(there) == pytest.approx(lat + dlat, abs=1e-9)
    assert _turned(float(over) - lon - dlon) == pytest.approx(0.0, abs=1e-9)
    assert float(alt) - 100 - height == pytest.approx((x * x + y * y) / (2 * 6378137), rel=0.01, abs=1e-6)


def _turned(lon: float) -> float:
    return (lon + 180) % 360 - 180


def test_a_degree_of_longitude_shrinks_with_latitude() -> None:
    east, north, up = to_world((60.0, 10.001, 0.0), (60.0, 10.0, 0.0))
    assert east == pytest.approx(radians(0.001) * 6378137 * cos(radians(60)), rel=5e-3)
    assert abs(north) < 1e-3
    assert abs(up) < 1e-3
