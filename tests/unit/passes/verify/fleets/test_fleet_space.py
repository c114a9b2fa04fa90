"""Where the drones of a fleet may be: every limit on both sides, and the drone that is named."""

from __future__ import annotations

from importlib import import_module
from math import hypot

import numpy as np
import pytest

from shotc.geom.bernstein import Array
from shotc.geom.fleet_pieces import FleetPieces
from shotc.geom.fleet_spline import places
from shotc.geom.pieces import Pieces
from shotc.geom.proof import inf_distance
from shotc.geom.shapes import CylinderShape
from shotc.geom.solids import Cylinder, Prism, Solid, box
from shotc.geom.track import Track
from shotc.geom.vec import Vec3
from shotc.ir.mission import Zone
from shotc.ir.target import Target
from shotc.ir.trajectory import Claim
from shotc.passes.verify.claims import gap
from shotc.passes.verify.fleets.flight import FleetFlight
from shotc.passes.verify.fleets.space import SEED_PIECES, nearest, space
from shotc.passes.verify.space import DRIFT_M
from tests.support.plain_fleets import PADS, PHASES, flown
from tests.support.show_plans import mission

module = import_module("shotc.passes.verify.fleets.space")

RADIUS_M = 0.3
NEAR_M = 1e-4
"""How far each case is from its boundary."""

UP, FAR, DOWN = 3, 8, 13
"""Control points by which the take-off, the far end of the way, and the landing are moved."""


def claims(moved: dict[tuple[int, int], Vec3] | None = None, **changes: object) -> dict[str, Claim]:
    return {c.constraint: c for c in space(flown(moved, **changes))}


def zone(keep: str, solid: Solid) -> dict[str, object]:
    return {"zones": (Zone("it", keep, solid, ("world", "zones", "it")),)}  # type: ignore[arg-type]


def places_of(of: FleetFlight, names: tuple[str, ...]) -> Array:
    """Return places of all drones in some phases, every 5 ms: shape (n, M, 3)."""
    spans = [(p.start, p.end) for p in PHASES if p.name in names]
    times = np.concatenate([np.linspace(low, high, 1 + round((high - low) / 0.005)) for low, high in spans])
    return places(of.track.breaks, of.track.coef, times)


@pytest.mark.parametrize("spare", [NEAR_M, -NEAR_M])
@pytest.mark.parametrize(("side", "named"), [(-1.0, "swarm-1"), (1.0, "swarm-3")])
def test_the_drone_nearest_to_a_zone_keeps_its_radius(side: float, named: str, spare: float) -> None:
    mast = Cylinder((4.0 + 10.0 * side, 10.0), 6.0 - RADIUS_M - spare, 0.0, 40.0)
    found = claims(**zone("out", mast))
    claim = found["zone it"]
    assert claim.worst == pytest.approx(spare, abs=1e-6)
    assert (claim.limit, claim.upper, claim.holds, claim.drones) == (0.0, False, spare > 0, (named,))
    assert found["zone it at home"].worst > 1.0


@pytest.mark.parametrize("spare", [NEAR_M, -NEAR_M])
def test_a_vertical_keeps_the_radius_from_what_is_not_at_its_pad(spare: float) -> None:
    overhang = Cylinder((12.0, 0.0), 4.0 - RADIUS_M - spare, 3.0, 5.0)
    claim = claims(**zone("out", overhang))["zone it at home"]
    assert claim.worst == pytest.approx(spare, abs=1e-6)
    assert (claim.limit, claim.holds, claim.drones) == (0.0, spare > 0, ("swarm-3",))


@pytest.mark.parametrize("when", [UP, DOWN])
@pytest.mark.parametrize("closer", [0.0, 1e-3])
def test_a_vertical_may_be_as_near_as_its_pad_and_no_nearer(when: int, closer: float) -> None:
    """A wall is 0.1 m from the first pad, one that overhangs is 0.4 m from the vertical of the third."""
    wall, over = Cylinder((-2.0, 0.0), 1.9, 0.0, 30.0), Cylinder((12.0, 0.0), 3.6, 3.0, 5.0)
    moved = {(0, when): (-closer, 0.0, 0.0)}
    at_wall = claims(moved, **zone("out", wall))["zone it at home"]
    part = places_of(flown(moved), ("takeoff", "land"))
    assert at_wall.worst == pytest.approx(float(part[0, :, 0].min()), abs=1e-6)
    assert (at_wall.holds, at_wall.drones) == (closer == 0.0, ("swarm-1",))
    assert claims(moved, **zone("out", over))["zone it at home"].worst == pytest.approx(0.1, abs=1e-4)


@pytest.mark.parametrize("moved", [0.0, 0.3])
def test_a_drone_whose_pad_is_near_hides_none_that_is_not(moved: float) -> None:
    """One wing of a house is 0.1 m from the first pad, the other one 0.4 m from the third."""
    ring = (
        (-9.0, -9.0),
        (14.0, -9.0),
        (14.0, 1.0),
        (8.4, 1.0),
        (8.4, -5.0),
        (-0.1, -5.0),
        (-0.1, 1.0),
        (-9.0, 1.0),
    )
    claim = claims({(2, UP): (moved, 0.0, 0.0)}, **zone("out", Prism(ring, 0.0, 9.0)))["zone it at home"]
    assert claim.holds == (moved == 0.0)
    assert claim.drones == (("swarm-3",) if moved else ("swarm-1",))


@pytest.mark.parametrize("spare", [NEAR_M, -NEAR_M])
@pytest.mark.parametrize(
    ("side", "named"),
    [("east", "swarm-3"), ("west", "swarm-1"), ("north", ""), ("south", ""), ("top", ""), ("floor", "")],
)
def test_a_keep_in_zone_is_left_on_no_side(side: str, named: str, spare: float) -> None:
    reach = dict.fromkeys(("east", "west", "north", "south", "top", "floor"), 9.0)
    reach[side] = RADIUS_M + spare
    west, east, south, north = -reach["west"], 8.0 + reach["east"], -reach["south"], 20.0 + reach["north"]
    corners = ((west, south), (east, south), (east, north), (west, north))
    claim = claims(**zone("in", Prism(corners, 10.0 - reach["floor"], 10.0 + reach["top"])))["zone it"]
    assert claim.worst == pytest.approx(spare, abs=1e-6)
    assert (claim.limit, claim.upper, claim.holds) == (0.0, False, spare > 0)
    assert not named or claim.drones == (named,)


FIELD = Prism(((-9.0, -9.0), (17.0, -9.0), (17.0, 29.0), (-9.0, 29.0)), 5.0, 14.0)


@pytest.mark.parametrize("drone", range(3))
@pytest.mark.parametrize("when", [UP, FAR, DOWN])
@pytest.mark.parametrize("pieces_at_once", [1, 50_000])
def test_the_part_and_the_drone_that_are_farthest_out_are_named(
    drone: int, when: int, pieces_at_once: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module, "BATCH_PIECES", pieces_at_once)
    moved: dict[tuple[int, int], Vec3] = {
        (drone, when): (0.0, 0.0, 20.0),
        ((drone + 1) % 3, when): (0.0, 0.0, 12.0),
    }
    of = flown(moved, **zone("in", FIELD))
    claim = next(c for c in space(of) if c.constraint == "zone it")
    highest = float(places_of(of, ("takeoff", "transit", "land"))[..., 2].max())
    assert highest > 14.5
    assert claim.worst == pytest.approx(14.0 - highest - RADIUS_M, abs=1e-3)
    assert (claim.holds, claim.drones) == (False, (f"swarm-{drone + 1}",))


def test_a_drone_below_the_floor_at_take_off_is_not_named_for_one_that_is_aside() -> None:
    """While the second leaves the zone to the side, the others are deeper below its floor."""
    narrow = FIELD._replace(bottom=9.0)
    claim = claims({(1, UP): (0.0, -14.0, 0.0)}, **zone("in", narrow))["zone it"]
    assert claim.time is not None
    assert claim.time < 6.0
    assert claim.drones == ("swarm-2",)


def test_the_floor_of_a_keep_in_zone_is_for_the_free_flight_alone() -> None:
    assert claims(**zone("in", FIELD._replace(bottom=9.0)))["zone it"].worst == pytest.approx(1.0 - RADIUS_M)
    low = claims({(1, FAR): (0.0, 0.0, -3.0)}, **zone("in", FIELD._replace(bottom=9.0)))["zone it"]
    assert (low.holds, low.drones) == (False, ("swarm-2",))


def post(at: Vec3, track: Track | None = None) -> Target:
    return Target("post", at, CylinderShape(1.0, 40.0), ("targets", "post"), track)


@pytest.mark.parametrize("spare", [NEAR_M, -NEAR_M])
@pytest.mark.parametrize("moves", [False, True])
def test_a_target_is_kept_clear_where_it_is(moves: bool, spare: float) -> None:
    """A moving one comes from far and is there from 12 s to 16 s, while the drones stand beside it.

    They pass the other one.
    """
    there = (8.0 + RADIUS_M + 1.0 + 2.0, 20.0 if moves else 7.7, 20.0)
    far = (90.0, 20.0, 20.0)
    track = Track((0.0, 12.0, 16.0, 28.0), (far, there, there, far)) if moves else None
    rules = mission().rules._replace(target_clearance=2.0 - spare)
    found = claims(targets=(post(far if moves else there, track),), rules=rules)
    claim = found["target post"]
    assert claim.worst == pytest.approx(2.0, abs=1e-5)
    assert (claim.limit, claim.upper, claim.drones) == (2.0 - spare, False, ("swarm-3",))
    assert claim.holds == (spare > 0)
    assert (found["target post at home"].limit, found["target post at home"].holds) == (0.0, True)


@pytest.mark.parametrize(("time", "holds"), [(3.0, False), (14.0, True), (25.0, False)])
def test_a_target_passes_the_pads_while_the_drones_are_away(time: float, holds: bool) -> None:
    """It goes along y = 0 and is at x = 4, the second pad, at the time given."""
    track = Track((0.0, 60.0), ((4.0 - 4.0 * time, 0.0, 2.0), (244.0 - 4.0 * time, 0.0, 2.0)))
    low = Target("cart", track.points[0], CylinderShape(0.5, 4.0), ("targets", "cart"), track)
    assert claims(targets=(low,))["target cart at home"].holds == holds


def test_a_target_that_stands_beside_a_pad_at_first_is_passed_no_nearer() -> None:
    """It is 0.1 m from the first drone on its pad, and comes 1 mm closer during its take-off, or does not."""
    for closer in (0.0, 1e-3):
        track = Track((0.0, 3.0), ((-1.1, 0.0, 20.0), (-1.1 + closer, 0.0, 20.0)))
        claim = claims(targets=(post(track.points[0], track),))["target post at home"]
        assert claim.worst == pytest.approx(-closer, abs=1e-5)
        assert (claim.holds, claim.drones) == (closer == 0.0, ("swarm-1",))


@pytest.mark.parametrize("when", [UP, DOWN])
@pytest.mark.parametrize(("drift", "holds"), [(1.5 * DRIFT_M, True), (6.0 * DRIFT_M, False), (0.3, False)])
def test_verticals_are_vertical(when: int, drift: float, holds: bool) -> None:
    moved = {(1, when): (0.6 * drift, -0.8 * drift, 0.0)}
    claim = claims(moved)["drift from the vertical"]
    part = places_of(flown(moved), ("takeoff", "land")) - np.array(PADS)[:, None]
    assert claim.worst == pytest.approx(float(np.hypot(part[..., 0], part[..., 1]).max()), rel=1e-3)
    assert (claim.limit, claim.upper, claim.holds, claim.drones) == (DRIFT_M, True, holds, ("swarm-2",))


@pytest.mark.parametrize("when", [1, 15])
@pytest.mark.parametrize(("depth", "holds"), [(1e-6, True), (1e-5, False), (0.3, False)])
def test_verticals_are_above_their_pads(when: int, depth: float, holds: bool) -> None:
    moved = {(1, when): (0.0, 0.0, -depth)}
    claim = claims(moved)["depth below home"]
    part = places_of(flown(moved), ("takeoff", "land"))
    assert claim.worst == pytest.approx(-float(part[..., 2].min()), rel=1e-3)
    assert (claim.limit, claim.upper, claim.holds, claim.drones) == (0.0, True, holds, ("swarm-2",))


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("more", [0, 40])
def test_the_nearest_of_many_pieces_is_that_of_all(seed: int, more: int) -> None:
    """As many pieces as are looked at first, or more; in half of the cases some are inside the solid."""
    rng = np.random.default_rng(seed)
    count = SEED_PIECES + more
    starts = rng.uniform(-30.0, 30.0, (count, 1, 3))
    starts[np.linalg.norm(starts[:, 0], axis=1) < 14.0] += 60.0 * (seed % 2)
    starts[7] *= seed % 2
    many = Pieces(
        np.arange(count), np.arange(count) + 1.0, starts + rng.normal(scale=2.0, size=(count, 4, 3))
    )
    solid = box((0.0, 0.0, 0.0), (6.0, 4.0, 5.0), 0.4)
    one, other = nearest(many, solid, gap(1.0)), inf_distance(many, solid, gap(1.0))
    assert (one.proven, one.at) == (pytest.approx(other.proven, abs=1e-4), pytest.approx(other.at))
    assert (other.attained > 0) == bool(seed % 2)


@pytest.mark.parametrize("seed", range(4))
def test_boxes_are_no_farther_apart_than_what_is_in_them(seed: int) -> None:
    rng = np.random.default_rng(seed)
    rows = tuple(map(tuple, rng.uniform(-20.0, 20.0, (9, 3)) + np.array([4.0, 10.0, 10.0])))
    track = Track(tuple(np.linspace(0.0, 28.0, 9).tolist()), rows)  # type: ignore[arg-type]
    bird = Target("bird", rows[0], CylinderShape(1.5, 2.0), ("targets", "bird"), track)  # type: ignore[arg-type]
    of = flown()
    spans = [(6.0, 22.0)]
    apart = module._boxes_apart(of.flown.between(spans), bird)
    times = np.linspace(6.0, 22.0, 3201)
    at = np.stack([np.interp(times, track.times, np.array(rows)[:, k]) for k in range(3)], axis=1)
    away = np.abs(places(of.track.breaks, of.track.coef, times) - at)
    box_away = np.maximum(away - [1.5, 1.5, 1.0], 0.0)
    assert (apart <= np.linalg.norm(box_away, axis=2).min(axis=1) + 1e-9).all()


def test_boxes_of_what_stands_are_as_far_apart_as_they_are() -> None:
    still = Track((0.0,), ((20.0, 40.0, 30.0),))
    bird = Target("bird", still.points[0], CylinderShape(1.5, 2.0), ("targets", "bird"), still)
    standing = FleetPieces(
        np.array([0.0]), np.array([1.0]), np.tile(np.array(PADS)[:, None, None], (1, 1, 4, 1))
    )
    expected = [hypot(20.0 - 1.5 - x, 40.0 - 1.5, 30.0 - 1.0) for x, _, _ in PADS]
    np.testing.assert_allclose(module._boxes_apart(standing, bird), expected)


def test_a_target_that_darts_in_and_out_within_a_piece_is_in_its_box() -> None:
    """It is far away at 10 s and at 12 s, the ends of a piece, and above the third drone at 11 s."""
    far, near = (300.0, 20.0, 10.0), (8.0, 19.0, 14.0)
    track = Track((0.0, 10.0, 11.0, 12.0, 28.0), (far, far, near, far, far))
    bird = Target("bird", far, CylinderShape(1.5, 2.0), ("targets", "bird"), track)
    of = flown()
    apart = module._boxes_apart(of.flown.between([(6.0, 22.0)]), bird)
    assert apart == pytest.approx([6.5, 2.5, 0.0])  # its box begins 1.5 m to the West of the third drone


@pytest.mark.parametrize("spare", [NEAR_M, -NEAR_M])
def test_over_flat_ground_the_highest_drone_keeps_the_greatest_height_and_the_lowest_the_clearance(
    spare: float,
) -> None:
    rules = mission().rules._replace(max_height=11.0 + spare, ground_clearance=8.0 - RADIUS_M - spare)
    # A control point that is alone on its side of 10 m moves a spline by two thirds of its own way.
    found = claims({(1, FAR): (0.0, 0.0, 1.5), (2, FAR): (0.0, 0.0, -3.0)}, rules=rules)
    high, low = found["height above ground"], found["ground clearance"]
    assert (high.worst, high.drones, high.holds) == (pytest.approx(11.0, abs=1e-5), ("swarm-2",), spare > 0)
    assert (low.worst, low.drones) == (pytest.approx(8.0 - RADIUS_M, abs=1e-5), ("swarm-3",))
    assert low.holds == (spare > 0)
