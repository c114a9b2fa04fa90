"""Clearances on ways between shots: tapered towards nearer ends, on both sides of every limit."""

from __future__ import annotations

import numpy as np
import pytest

from shotc.geom.shapes import CylinderShape
from shotc.geom.solids import Cylinder
from shotc.geom.track import Track
from shotc.geom.vec import Vec3
from shotc.ir.mission import MissionIR, Zone
from shotc.ir.phases import Phase
from shotc.ir.rules import TransitClearance
from shotc.ir.target import Target
from shotc.ir.trajectory import Claim
from shotc.passes.verify.transits import transits
from tests.support.film_plans import TOWER
from tests.support.plain_flights import RADIUS_M, plain_flight, plain_mission
from tests.support.records import replace

NEAR_M = 1e-4
PHASES = (
    Phase("takeoff", None, 0.0, 4.0),
    Phase("transit", None, 4.0, 14.0),
    Phase("shot", "half", 14.0, 24.0),
    Phase("return", None, 24.0, 34.0),
    Phase("land", None, 34.0, 38.0),
)
HOME, FAR, SIDE = (0.0, 0.0, 10.0), (40.0, 0.0, 10.0), (40.0, 60.0, 10.0)
WAY = ((0.0, (0.0, 0.0, 0.0)), (4.0, HOME), (14.0, FAR), (24.0, SIDE), (34.0, HOME), (38.0, (0.0, 0.0, 0.0)))
"""Ten metres up, 40 m to the East on a way, 60 m to the North in the shot, and straight back on a way."""


def world(*solids: Cylinder | Target, keep: str = "out", **clearance: object) -> MissionIR:
    """A mission with masts as zones, and with targets; the shot films ``tower``."""
    zones = tuple(
        Zone(f"mast{k}", keep, s, ("world", "zones", f"mast{k}"))  # type: ignore[arg-type]
        for k, s in enumerate(solids)
        if isinstance(s, Cylinder)
    )
    targets = tuple(s for s in solids if isinstance(s, Target))
    if "tower" not in {t.name for t in targets}:
        targets += (TOWER._replace(centre=(-500.0, 0.0, 12.0)),)
    base = plain_mission()
    rules = replace(base.rules, transits=replace(TransitClearance(5.0, 3.0), **clearance))
    return replace(base, zones=zones, targets=targets, rules=rules)


def claims(of: MissionIR) -> dict[str, Claim]:
    found = list(transits(plain_flight(of, WAY, PHASES)))
    return {c.constraint: c for c in found if c.time is not None and c.worst < 100.0}


def mast(x: float, y: float, away: float) -> Cylinder:
    """A mast at a place whose wall is so far from the way out along y = 0."""
    return Cylinder((x, y), abs(y) - away, 0.0, 40.0)


@pytest.mark.parametrize("required", [True, False])
@pytest.mark.parametrize("spare", [NEAR_M, -NEAR_M])
def test_in_the_middle_of_a_way_the_whole_clearance_counts(spare: float, required: bool) -> None:
    claim = claims(world(mast(20.0, -6.0, 3.0 + RADIUS_M + spare), other_required=required))[
        "zone mast0 on transits"
    ]
    assert claim.worst == pytest.approx(3.0 + spare, abs=1e-5)
    assert (claim.limit, claim.upper, claim.hard, claim.holds) == (3.0, False, required, spare > 0)
    assert claim.time == pytest.approx(9.0, abs=0.1)
    assert claim.path == ("rules", "transit_clearance", "other")


def test_a_shot_and_a_vertical_are_no_way() -> None:
    """One mast stands beside the shot, one beside the take-off, where the way has both of its ends far."""
    beside_shot = Cylinder((43.0, 30.0), 2.0, 0.0, 40.0)
    assert claims(world(beside_shot))["zone mast0 on transits"].holds
    low = Cylinder((-2.0, 0.0), 1.0, 0.0, 2.0)
    assert claims(world(low))["zone mast0 on transits"].holds


def test_a_keep_in_zone_and_a_clearance_of_nothing_have_no_claim() -> None:
    assert claims(world(mast(20.0, -6.0, 1.0), keep="in")) == {}
    assert claims(world(mast(20.0, -6.0, 1.0), other=0.0)) == {}


@pytest.mark.parametrize("end", ["start", "end"])
@pytest.mark.parametrize("spare", [NEAR_M, -NEAR_M])
def test_from_a_near_end_half_a_metre_is_gained_a_metre(end: str, spare: float) -> None:
    """The end is g from the wall, and the way passes it at 45 deg: what it gains is compared with the taper.

    At s along the way the distance is |end + s direction - axis| - radius, the need g + s / 2 at most.
    """
    x, sign = (0.0, 1.0) if end == "start" else (40.0, -1.0)
    gap, radius = 0.8, 2.0

    along = np.linspace(0.001, 12.0, 4000)

    def lack(turn: float) -> float:
        """The largest need minus distance along the way for an axis at an angle from the way."""
        axis_along, axis_aside = (radius + gap) * turn, (radius + gap) * (1 - turn**2) ** 0.5
        away = np.hypot(along - axis_along, axis_aside) - radius
        return float((np.minimum(3.0 + RADIUS_M, gap + along / 2) - away).max())

    low, high = -1.0, 1.0
    for _ in range(40):
        low, high = (low, (low + high) / 2) if lack((low + high) / 2) > 1e-6 else ((low + high) / 2, high)
    turn = (
        low - 100.0 * spare
    )  # the cosine of the angle; the more it is, the more the way goes along the wall
    axis = (x + sign * (radius + gap) * turn, -(radius + gap) * (1 - turn**2) ** 0.5)
    claim = claims(world(Cylinder(axis, radius, 0.0, 40.0)))["zone mast0 on transits"]
    assert claim.holds == (spare > 0)


@pytest.mark.parametrize(("name", "clearance"), [("tower", 5.0), ("shed", 3.0)])
@pytest.mark.parametrize("spare", [NEAR_M, -NEAR_M])
def test_what_is_filmed_has_a_clearance_of_its_own(name: str, clearance: float, spare: float) -> None:
    away = clearance + RADIUS_M + spare + 1.0
    target = Target(name, (20.0, -away, 20.0), CylinderShape(1.0, 40.0), ("targets", name))
    claim = claims(world(target))[f"target {name} on transits"]
    assert (claim.limit, claim.holds) == (clearance, spare > 0)
    assert claim.path[-1] == ("filmed" if name == "tower" else "other")
    assert claim.worst == pytest.approx(clearance + spare, abs=1e-5)
    soft = world(target, filmed=1.0, other=1.0)
    assert claims(soft) == {}  # the target clearance of one metre holds anyway


def test_of_a_moving_target_the_place_at_the_time_counts() -> None:
    """It stands on the way for the first second of the shot, and is 90 m away else."""
    off: Vec3 = (20.0, -90.0, 20.0)
    track = Track((0.0, 14.2, 14.5, 14.8, 40.0), (off, off, (20.0, 0.0, 20.0), off, off))
    target = Target("shed", off, CylinderShape(1.0, 40.0), ("targets", "shed"), track)
    assert claims(world(target))["target shed on transits"].holds
    early = track._replace(times=(0.0, 8.7, 9.0, 9.3, 40.0))
    found = claims(world(target._replace(track=early)))["target shed on transits"]
    assert not found.holds
    assert found.time == pytest.approx(9.0, abs=0.1)


def test_a_flight_without_ways_has_no_claims() -> None:
    all_shot = (
        Phase("takeoff", None, 0.0, 4.0),
        Phase("shot", "half", 4.0, 34.0),
        Phase("land", None, 34.0, 38.0),
    )
    assert not list(transits(plain_flight(world(mast(20.0, -6.0, 1.0)), WAY, all_shot)))


@pytest.mark.parametrize("spare", [NEAR_M, -NEAR_M])
def test_what_is_above_a_way_is_as_near_as_what_is_beside_it(spare: float) -> None:
    bridge = Cylinder((20.0, 0.0), 2.0, 10.0 + 3.0 + RADIUS_M + spare, 40.0)
    claim = claims(world(bridge))["zone mast0 on transits"]
    assert claim.worst == pytest.approx(3.0 + spare, abs=1e-5)
    assert claim.holds == (spare > 0)
