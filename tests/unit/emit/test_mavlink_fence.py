from __future__ import annotations

import numpy as np
import pytest

from shotc.emit.mavlink import EMITTER
from shotc.emit.mavlink.fence import fence_of
from shotc.emit.waypoints.clearance import shortfall
from shotc.emit.waypoints.geo import tie
from shotc.geom.solids import Cylinder, Prism, distance, signed_area
from shotc.ir.mission import MissionIR, Zone
from shotc.ir.owners import GROUND
from shotc.planning.clearances import Clearance
from tests.support.film_plans import orbit_mission
from tests.support.mavlink_flights import plan, straight
from tests.support.records import replace

TRACK = np.array([[x, -60.0, 20.0] for x in np.linspace(0, 40, 81)])
SQUARE = ((-10.0, -10.0), (10.0, -10.0), (10.0, 10.0), (-10.0, 10.0))


def mission(*zones: Zone) -> MissionIR:
    return replace(orbit_mission(), zones=zones)


def zone(name: str, keep: str, solid: object) -> Zone:
    return Zone(name, keep, solid, ("world", "zones", name))  # type: ignore[arg-type]


def moved(points: tuple[tuple[float, float], ...], x: float, y: float, size: float = 1.0) -> tuple:
    return tuple((size * a + x, size * b + y) for a, b in points)


def fence(source: MissionIR, *, one: bool = True):
    return fence_of(source, tie(source.origin, (0.0, -60.0, 0.0)), TRACK, one_inclusion=one)


def test_zones_become_polygons_and_circles_in_their_place() -> None:
    source = mission(
        zone("field", "in", Prism(moved(SQUARE, 0, 0, 10.0), 2.0, 60.0)),
        zone("house", "out", Prism(SQUARE, 0.0, 6.0)),
        zone("tree", "out", Cylinder((-20.0, 10.0), 3.0, 0.0, 12.0)),
    )
    made = fence(source)
    assert [p.inclusion for p in made.polygons] == [True, False]
    assert [(c.inclusion, c.radius) for c in made.circles] == [(False, 3.0)]
    assert made.left_out == ()
    geo = tie(source.origin, (0.0, 0.0, 0.0))
    tree = geo.place((-20.0, 10.0, 0.0))
    assert made.circles[0].centre == pytest.approx((tree.lat, tree.lon), abs=1e-8)
    for polygon in made.polygons:
        # (lat, lon) swapped to (x, y): clockwise has a negative area.
        assert signed_area(tuple((lon, lat) for lat, lon in polygon.corners)) < 0


def test_a_zone_below_the_flight_is_left_out_with_its_reason() -> None:
    made = fence(mission(zone("shed", "out", Prism(moved(SQUARE, 20, -60), 0.0, 6.0))))
    assert made.polygons == ()
    assert [left.zone.name for left in made.left_out] == ["shed"]
    assert "over or under" in made.left_out[0].reason


def test_a_keep_in_zone_that_the_flight_leaves_is_left_out() -> None:
    made = fence(mission(zone("yard", "in", Cylinder((0.0, -60.0), 20.0, 0.0, 60.0))))
    assert made.circles == ()
    assert "leaves it" in made.left_out[0].reason


def test_px4_gets_only_the_smallest_keep_in_area() -> None:
    source = mission(
        zone("wide", "in", Prism(moved(SQUARE, 0, 0, 20.0), 0.0, 60.0)),
        zone("near", "in", Cylinder((0.0, -60.0), 60.0, 0.0, 60.0)),
    )
    px4, ardupilot = fence(source), fence(source, one=False)
    assert [left.zone.name for left in px4.left_out] == ["wide"]
    assert len(px4.circles) == 1
    assert (len(ardupilot.polygons), len(ardupilot.circles)) == (1, 1)


def test_a_zone_left_out_is_a_warning_on_its_key() -> None:
    source = mission(zone("shed", "out", Prism(moved(SQUARE, 20, -60), 0.0, 6.0)))
    emission = EMITTER.emit(plan(straight(), mission=source))
    assert [d.code for d in emission.diagnostics] == ["E102"]
    assert "shed" in emission.diagnostics[0].message


def test_distances_agree_with_the_solids_own() -> None:
    rng = np.random.default_rng(1)
    points = rng.uniform(-30, 30, (200, 3))
    bent = Prism(((0.0, 0.0), (20.0, 0.0), (20.0, 5.0), (5.0, 5.0), (5.0, 20.0), (0.0, 20.0)), -5.0, 8.0)
    for solid in (Cylinder((3.0, -4.0), 6.0, -5.0, 8.0), Prism(SQUARE, -5.0, 8.0), bent):
        near = shortfall(Clearance(GROUND, solid, 1.5), points)
        exact = [1.5 - distance(solid, tuple(p)) for p in points]
        assert near == pytest.approx(exact, abs=1e-9)
