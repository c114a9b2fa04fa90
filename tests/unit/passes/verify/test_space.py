"""Where a drone may be: every limit on both sides of its boundary, in flights that are known by hand."""

from __future__ import annotations

from math import hypot, inf

import numpy as np
import pytest

from shotc.geom.bernstein import Piecewise
from shotc.geom.shapes import CylinderShape
from shotc.geom.solids import Cylinder, Prism, Solid
from shotc.geom.track import Track
from shotc.geom.vec import Vec3
from shotc.ir.mission import Zone
from shotc.ir.phases import Phase
from shotc.ir.target import Target
from shotc.ir.trajectory import Claim
from shotc.passes.verify.space import DRIFT_M, space
from tests.support.plain_flights import HOP, PHASES, RADIUS_M, lines, plain_flight, plain_mission
from tests.support.records import replace

Way = tuple[tuple[float, Vec3], ...]
NEAR_M = 1e-4
"""How far each case is from its boundary."""


def zone(keep: str, solid: Solid) -> dict[str, object]:
    return {"zones": (Zone("it", keep, solid, ("world", "zones", "it")),)}  # type: ignore[arg-type]


def claims(way: Way = HOP, phases: tuple[Phase, ...] = PHASES, **changes: object) -> dict[str, Claim]:
    return {c.constraint: c for c in space(plain_flight(plain_mission(**changes), way, phases))}


def through(*places: tuple[float, Vec3]) -> Way:
    """The hop with other places at some times, or further ones."""
    return tuple(sorted((dict(HOP) | dict(places)).items()))


@pytest.mark.parametrize("spare", [NEAR_M, -NEAR_M])
@pytest.mark.parametrize("beside", [(20.0, 5.0), (43.0, 4.0), (25.0, -3.0)])
def test_a_drone_keeps_its_radius_from_a_zone(beside: tuple[float, float], spare: float) -> None:
    away = hypot(max(0.0, beside[0] - 40.0), beside[1])
    found = claims(**zone("out", Cylinder(beside, away - RADIUS_M - spare, 5.0, 20.0)))
    claim = found["zone it"]
    assert claim.worst == pytest.approx(spare, abs=1e-6)
    assert (claim.limit, claim.upper, claim.holds) == (0.0, False, spare > 0)
    assert claim.time is not None
    assert min(abs(claim.time - t) for t in (4 + beside[0] / 4, 24 - beside[0] / 4, 14.0)) < 0.1
    assert found["zone it at home"].worst > 1.0


def test_a_drone_inside_a_zone_is_as_deep_as_it_is() -> None:
    claim = claims(**zone("out", Cylinder((20.0, 0.0), 3.0, 5.0, 12.0)))["zone it"]
    assert claim.worst == pytest.approx(-2.0 - RADIUS_M, abs=0.01)
    assert not claim.holds


@pytest.mark.parametrize("spare", [NEAR_M, -NEAR_M])
def test_a_vertical_keeps_the_radius_from_what_is_not_at_the_pad(spare: float) -> None:
    overhang = Cylinder((2.0, 0.0), 1.5 - spare, 3.0, 5.0)
    claim = claims(**zone("out", overhang))["zone it at home"]
    assert (claim.limit, claim.holds) == (0.0, spare > 0)
    assert claim.worst == pytest.approx(spare, abs=1e-6)


@pytest.mark.parametrize("closer", [0.0, 1e-3])
def test_a_vertical_may_be_as_near_to_a_solid_as_its_pad_and_no_nearer(closer: float) -> None:
    wall = Cylinder((2.0, 0.0), 1.7, 0.0, 5.0)  # its wall is 0.3 m from the pad
    found = claims(through((2.0, (closer, 0.0, 5.0))), **zone("out", wall))
    claim = found["zone it at home"]
    assert claim.limit == pytest.approx(0.3 - RADIUS_M, abs=1e-9)
    assert claim.worst == pytest.approx(0.3 - RADIUS_M - closer, abs=1e-5)
    assert claim.holds == (closer == 0.0)
    assert found["zone it"].worst == pytest.approx(hypot(0.3, 5.0) - RADIUS_M, abs=0.1)


@pytest.mark.parametrize("spare", [NEAR_M, -NEAR_M])
@pytest.mark.parametrize("side", ["east", "west", "north", "top", "floor"])
def test_a_keep_in_zone_is_left_on_no_side(side: str, spare: float) -> None:
    reach = RADIUS_M + spare
    east, west = 40.0 + (reach if side == "east" else 9.0), reach if side == "west" else 9.0
    north = reach if side == "north" else 9.0
    top, bottom = 10.0 + (reach if side == "top" else 9.0), 10.0 - (reach if side == "floor" else 9.0)
    corners = ((-west, -9.0), (east, -9.0), (east, north), (-west, north))
    claim = claims(**zone("in", Prism(corners, bottom, top)))["zone it"]
    assert claim.worst == pytest.approx(spare, abs=1e-6)
    assert (claim.limit, claim.upper, claim.holds) == (0.0, False, spare > 0)


@pytest.mark.parametrize("where", ["takeoff", "flight", "landing"])
def test_a_keep_in_zone_is_left_by_whatever_part_is_farthest_out(where: str) -> None:
    at = {
        "takeoff": (2.0, (0.0, 0.0, 30.0)),
        "flight": (9.0, (20.0, 0.0, 30.0)),
        "landing": (26.0, (0.0, 0.0, 30.0)),
    }
    field = Prism(((-9.0, -9.0), (49.0, -9.0), (49.0, 9.0), (-9.0, 9.0)), 5.0, 20.0)
    claim = claims(through(at[where]), **zone("in", field))["zone it"]
    assert claim.worst == pytest.approx(20.0 - 30.0 - RADIUS_M, abs=1e-6)
    assert claim.time == pytest.approx(at[where][0], abs=1e-6)
    assert not claim.holds


def test_the_floor_of_a_keep_in_zone_is_for_the_free_flight_alone() -> None:
    field = Prism(((-9.0, -9.0), (49.0, -9.0), (49.0, 9.0), (-9.0, 9.0)), 8.0, 20.0)
    claim = claims(**zone("in", field))["zone it"]
    assert claim.worst == pytest.approx(2.0 - RADIUS_M, abs=1e-6)
    low = claims(through((9.0, (20.0, 0.0, 7.0))), **zone("in", field))["zone it"]
    assert low.worst == pytest.approx(-1.0 - RADIUS_M, abs=1e-6)
    assert low.time == pytest.approx(9.0, abs=1e-6)


def post(at: Vec3, track: Track | None = None) -> Target:
    return Target("post", at, CylinderShape(1.0, 40.0), ("targets", "post"), track)


@pytest.mark.parametrize("spare", [NEAR_M, -NEAR_M])
def test_a_standing_target_is_kept_clear(spare: float) -> None:
    rules = replace(plain_mission().rules, target_clearance=2.0 - spare)
    found = claims(targets=(post((20.0, 1.0 + 2.0 + RADIUS_M, 20.0)),), rules=rules)
    claim = found["target post"]
    assert claim.worst == pytest.approx(2.0, abs=1e-6)
    assert (claim.limit, claim.holds) == (2.0 - spare, spare > 0)
    assert found["target post at home"].limit == 0.0
    assert found["target post at home"].holds


@pytest.mark.parametrize("spare", [NEAR_M, -NEAR_M])
def test_a_moving_target_is_kept_clear_where_it_is(spare: float) -> None:
    # Relative to the target the drone flies along (4 t - 36, 30 - 3 t), which is least at 9.36 s: 2.4 m.
    track = Track((0.0, 20.0), ((20.0, -30.0, 20.0), (20.0, 30.0, 20.0)))
    rules = replace(plain_mission().rules, target_clearance=2.4 - 1.0 - RADIUS_M - spare)
    claim = claims(targets=(post((20.0, -30.0, 20.0), track),), rules=rules)["target post"]
    assert claim.worst == pytest.approx(2.4 - 1.0 - RADIUS_M, abs=1e-6)
    assert claim.time == pytest.approx(9.36, abs=0.01)
    assert claim.holds == (spare > 0)


@pytest.mark.parametrize(("time", "holds"), [(2.0, False), (14.0, True), (26.0, False)])
def test_a_target_passes_a_pad_while_its_drone_is_away(time: float, holds: bool) -> None:
    track = Track((0.0, time, 30.0), ((1.0, -90.0, 20.0), (1.0, 0.0, 20.0), (1.0, 90.0, 20.0)))
    found = claims(targets=(post((1.0, -90.0, 20.0), track),))
    assert found["target post at home"].holds == holds
    assert found["target post"].holds


@pytest.mark.parametrize(("drift", "holds"), [(1.5 * DRIFT_M, True), (2.5 * DRIFT_M, False), (0.3, False)])
@pytest.mark.parametrize("time", [2.0, 26.0])
def test_take_off_and_landing_are_vertical(time: float, drift: float, holds: bool) -> None:
    claim = claims(through((time, (0.6 * drift, -0.8 * drift, 5.0))))["drift from the vertical"]
    assert claim.worst == pytest.approx(drift, rel=1e-3)
    assert (claim.limit, claim.upper, claim.holds) == (DRIFT_M, True, holds)
    assert claim.time == pytest.approx(time, abs=1e-6)


@pytest.mark.parametrize(("depth", "holds"), [(0.9e-6, True), (2e-6, False), (0.3, False)])
@pytest.mark.parametrize("time", [2.0, 26.0])
def test_take_off_and_landing_are_above_home(time: float, depth: float, holds: bool) -> None:
    claim = claims(through((time, (0.0, 0.0, -depth))))["depth below home"]
    assert claim.worst == pytest.approx(depth, rel=1e-6)
    assert (claim.limit, claim.upper, claim.holds) == (0.0, True, holds)


def test_each_part_has_its_claims_and_no_more() -> None:
    both = zone("out", Cylinder((20.0, 9.0), 1.0, 0.0, 20.0))
    free, upright = {"zone it", "ground clearance"}, {"drift from the vertical", "depth below home"}
    assert set(claims(**both)) == free | upright | {"zone it at home"}
    in_air = tuple(replace(p, name="transit") if p.shot is None else p for p in PHASES)
    assert set(claims(phases=in_air, **both)) == free
    on_pad = (Phase("takeoff", None, 0.0, 28.0),)
    assert set(claims(phases=on_pad, **both)) == upright | {"zone it at home"}


@pytest.mark.parametrize("spare", [NEAR_M, -NEAR_M])
@pytest.mark.parametrize("time", [9.0, 2.0])
def test_the_ground_is_kept_clear_in_free_flight(time: float, spare: float) -> None:
    dip = through((time, (20.0 * (time > 4), 0.0, 3.0)))
    rules = replace(plain_mission().rules, ground_clearance=3.0 - RADIUS_M - spare)
    claim = claims(dip, rules=rules)["ground clearance"]
    assert claim.worst == pytest.approx((3.0 if time > 4 else 10.0) - RADIUS_M, abs=1e-5)
    assert (claim.limit, claim.upper, claim.holds) == (3.0 - RADIUS_M - spare, False, spare > 0 or time < 4)


@pytest.mark.parametrize("spare", [NEAR_M, -NEAR_M])
@pytest.mark.parametrize("time", [2.0, 9.0, 26.0])
def test_the_greatest_height_holds_for_verticals_too(time: float, spare: float) -> None:
    high = through((time, (20.0 * (time == 9.0), 0.0, 30.0)))
    rules = replace(plain_mission().rules, max_height=30.0 + spare)
    claim = claims(high, rules=rules)["height above ground"]
    assert claim.worst == pytest.approx(30.0, abs=1e-5)
    assert (claim.upper, claim.holds, claim.time) == (True, spare > 0, time)
    for none in (None, inf):
        assert "height above ground" not in claims(rules=replace(rules, max_height=none))


@pytest.mark.parametrize("home", [(5.0, -7.0, 2.0), (-30.0, 4.0, -1.0)])
def test_verticals_are_over_the_home_wherever_it_is(home: Vec3) -> None:
    drone = replace(plain_mission().drones[0], home=home)
    shifted = tuple((t, (x + home[0], y + home[1], z + home[2])) for t, (x, y, z) in HOP)
    wall = Cylinder((home[0] + 2.0, home[1]), 1.7, home[2], home[2] + 5.0)
    found = claims(shifted, drones=(drone,), **zone("out", wall))
    for name in ("drift from the vertical", "depth below home"):
        assert found[name].worst == pytest.approx(0.0, abs=1e-9)
        assert found[name].holds
    assert found["zone it at home"].limit == pytest.approx(0.3 - RADIUS_M)
    assert found["zone it at home"].holds
    moved = dict(shifted) | {2.0: (home[0] + 0.3, home[1] - 0.4, home[2] - 0.2)}
    found = claims(tuple(sorted(moved.items())), drones=(drone,))
    assert found["drift from the vertical"].worst == pytest.approx(0.5, abs=1e-6)
    assert found["depth below home"].worst == pytest.approx(0.2, abs=1e-6)


@pytest.mark.parametrize("spare", [1e-5, -1e-5])
@pytest.mark.parametrize("keep", ["in", "out"])
def test_a_bend_is_bounded_as_closely_as_the_limit_asks(keep: str, spare: float) -> None:
    """The way out bends to the North by 36 x (1 - x)^2 + 9 x^2 (1 - x) at the share x of its time."""
    plain = lines(HOP)
    first, last = plain.ctrl[:, 0], plain.ctrl[:, 1]
    ctrl = np.stack([first, (2 * first + last) / 3, (first + 2 * last) / 3, last], axis=1)
    ctrl[1, 1:3, 1] = 12.0, 3.0
    x = min(np.roots([81.0, -126.0, 36.0]))
    wall = 36.0 * x * (1 - x) ** 2 + 9.0 * x**2 * (1 - x) + RADIUS_M + spare
    field = Prism(((-9.0, -9.0), (49.0, -9.0), (49.0, wall), (-9.0, wall)), 0.0, 30.0)
    beyond = Prism(((-9.0, wall), (49.0, wall), (49.0, 99.0), (-9.0, 99.0)), 0.0, 30.0)
    mission = plain_mission(**zone(keep, field if keep == "in" else beyond))
    flight = plain_flight(mission)
    track = replace(flight.track, curve=Piecewise(plain.breaks, ctrl))
    (claim,) = (c for c in space(replace(flight, track=track)) if c.constraint == "zone it")
    assert claim.worst == pytest.approx(spare, abs=1e-6)
    assert claim.holds == (spare > 0)
