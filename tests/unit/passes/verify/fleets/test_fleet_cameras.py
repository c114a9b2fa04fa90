"""How near fleets come to cameras and to whatever stands on a pad: from every side, and for all the time."""

from __future__ import annotations

import numpy as np
import pytest

from shotc.geom.shapes import CylinderShape
from shotc.geom.vec import Vec3
from shotc.ir.fleet import FrameTimes, Lights
from shotc.ir.keyframes import KeyframeIR
from shotc.ir.target import Target
from shotc.ir.trajectory import Claim, DroneTrajectory, TrajectoryIR
from shotc.passes.verify.fleets.apart import from_parked
from shotc.passes.verify.fleets.cameras import from_cameras, named_pictures
from tests.support.plain_fleets import flown
from tests.support.plain_flights import lines, plain_mission
from tests.support.records import replace
from tests.support.show_plans import display, fleet, mission

NEAR_M = 1e-4
FAR_END = (8.0, 20.0, 10.0)
"""Where the third drone stands from 12 s to 16 s."""


def from_camera(*way: tuple[float, Vec3], least: float = 5.0, begin: float = 0.0) -> Claim:
    camera = DroneTrajectory("cam1", lines(way), (), (), ())
    of = flown(rules=mission().rules._replace(separation=least))
    (claim,) = from_cameras([of], [camera], begin)
    return claim


@pytest.mark.parametrize("by", [(5.0, 0.0, 0.0), (0.0, 5.0, 0.0), (0.0, 3.0, 4.0), (0.0, 0.0, 5.0)])
@pytest.mark.parametrize("spare", [NEAR_M, -NEAR_M])
def test_a_camera_keeps_its_separation_from_the_nearest_drone(by: Vec3, spare: float) -> None:
    x, y, z = (a + b for a, b in zip(FAR_END, by, strict=True))
    claim = from_camera((0.0, (x, y, z)), (28.0, (x, y, z)), least=5.0 - spare)
    assert claim.worst == pytest.approx(5.0, abs=1e-5)
    assert (claim.limit, claim.upper, claim.holds) == (5.0 - spare, False, spare > 0)
    assert (claim.subject, claim.drones) == ("swarm", ("swarm-3", "cam1"))
    assert claim.time is not None
    assert 12.0 - 1e-3 <= claim.time <= 16.0 + 1e-3
    assert claim.position == pytest.approx((x, y, z))


def test_the_stricter_of_two_separations_counts() -> None:
    """A fleet of its own keeps 1.15 m aside and more upright."""
    still = (0.0, (50.0, 20.0, 10.0)), (28.0, (50.0, 20.0, 10.0))
    apart = fleet().apart
    assert from_camera(*still, least=0.1).limit == max(apart.across, apart.upright)
    assert from_camera(*still, least=9.0).limit == 9.0


@pytest.mark.parametrize(("over", "worst"), [(40.0, 3.0), (2.0, 3.0)])
def test_who_has_landed_first_stands_for_the_other_one(over: float, worst: float) -> None:
    """A camera passes over the pads 3 m high, before the fleet takes off or long after it has landed."""
    away, there, gone = (-50.0, 0.0, 3.0), (4.0, 0.0, 3.0), (58.0, 0.0, 3.0)
    way = [(over - 0.2, away), (over, there), (over + 0.2, gone)]
    claim = from_camera(*([(0.0, away)] * (over > 9)), *([(0.0, away), *way[1:]] if over < 9 else way))
    low = worst if over > 9 else worst - 10.0 / 6.0
    assert claim.worst == pytest.approx(low, abs=0.05)
    assert claim.time == pytest.approx(over, abs=0.05)


def test_time_before_the_claim_begins_does_not_count() -> None:
    """The camera flies past the third drone on its pad in the first second and is far away from then on."""
    way = (0.0, (8.0, -3.0, 0.5)), (1.0, (8.0, -90.0, 0.5)), (28.0, (8.0, -90.0, 0.5))
    assert not from_camera(*way).holds
    assert from_camera(*way, begin=1.0).holds


@pytest.mark.parametrize("spare", [NEAR_M, -NEAR_M])
def test_a_drone_that_stands_on_its_pad_is_kept_apart(spare: float) -> None:
    """Its home is 4 m beside the way of the third drone and 3 m below it."""
    base = plain_mission()
    home = (12.0, 10.0, 7.0)
    of = flown(
        drones=(replace(base.drones[0], home=home),), rules=mission().rules._replace(separation=5.0 - spare)
    )
    ir = TrajectoryIR(KeyframeIR(of.mission, ()), (), (), (), (of.track,))
    (claim,) = from_parked(ir, [of])
    assert claim.worst == pytest.approx(5.0, abs=1e-5)
    assert (claim.constraint, claim.limit, claim.holds) == ("separation from cam1", 5.0 - spare, spare > 0)
    assert claim.drones == ("swarm-3",)
    assert claim.upper is False


@pytest.mark.parametrize("spare", [1e-2, -1e-2])
def test_a_fleet_that_stands_on_its_pads_is_kept_apart(spare: float) -> None:
    """The pads of the other one are beside the way of the third drone, at its height."""
    own = fleet()
    least = own.apart.across
    pads = tuple((8.0 + least + spare + 20.0 * k, 10.0, 10.0) for k in range(3))
    other = fleet(pads, "spare")
    of = flown()
    both = of.mission._replace(fleets=(*of.mission.fleets, other))
    of = replace(of, mission=both)
    ir = TrajectoryIR(KeyframeIR(both, ()), (), (), (), (of.track,))
    (claim,) = from_parked(ir, [of])
    assert claim.worst == pytest.approx(least + spare, abs=1e-4)
    assert (claim.limit, claim.holds) == (pytest.approx(least), spare > 0)
    assert claim.drones == ("swarm-3", "spare-1")
    assert np.isfinite(claim.time or 0.0)


@pytest.mark.parametrize("spare", [1e-3, -1e-3])
def test_the_lights_of_a_named_picture_are_within_the_body_that_cameras_frame(spare: float) -> None:
    """Three drones stand in a row of 8 m at 12 s, about the middle of the body."""
    star = Target("star", (4.0, 20.0, 10.0), CylinderShape(4.0 + spare, 2.0), ("targets", "star"))
    shown = display()
    named = shown._replace(pictures=(shown.pictures[0]._replace(name="star"), *shown.pictures[1:]))
    of = flown(targets=(star,), displays=(named,))
    frames = (FrameTimes("globe", 0, 0, 12.0, 16.0), FrameTimes("globe", 1, 0, 16.0, 18.0))
    lit = replace(of.track, lights=Lights(np.array([0.0]), np.full((3, 1, 3), 255, dtype=np.uint8)))
    (claim,) = named_pictures(replace(of, track=lit), named, frames)
    assert claim.worst == pytest.approx(max(0.0, -spare), abs=1e-9)
    assert (claim.constraint, claim.limit, claim.holds) == ("lights outside star", 0.0, spare > 0)
    assert (claim.time, claim.shot) == (12.0, "globe")
    dark = replace(of.track, lights=Lights(np.array([0.0]), np.zeros((3, 1, 3), dtype=np.uint8)))
    (none,) = named_pictures(replace(of, track=dark), named, frames)
    assert none.worst == 0.0
