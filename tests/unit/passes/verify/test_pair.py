"""The separation of drones on a common clock: every pair, from take-off to long after landing."""

from __future__ import annotations

import numpy as np
import pytest

from shotc.geom.vec import Vec3
from shotc.ir.keyframes import KeyframeIR
from shotc.ir.mission import MissionIR
from shotc.ir.trajectory import Claim, DroneTrajectory, TrajectoryIR
from shotc.passes.verify.claims import JudgedFlight
from shotc.passes.verify.pair import from_fleets, separation
from tests.support.plain_flights import HOP, PHASES, lines, plain_mission
from tests.support.records import replace
from tests.support.show_plans import fleet

NEAR_M = 1e-4
NAMES = ("cam1", "cam2", "cam3")


def mission(least: float = 3.0) -> MissionIR:
    base = plain_mission()
    drones = tuple(replace(base.drones[0], name=name, path=("drones", name)) for name in NAMES)
    return replace(base, drones=drones, rules=replace(base.rules, separation=least))


def flights(*ways: tuple[tuple[float, Vec3], ...], least: float = 3.0) -> list[JudgedFlight]:
    of = mission(least)
    tracks = [
        DroneTrajectory(name, lines(way), PHASES, (), ()) for name, way in zip(NAMES, ways, strict=False)
    ]
    return [JudgedFlight(of, of.drone(t.drone), t) for t in tracks]


def moved(by: Vec3, later: float = 0.0) -> tuple[tuple[float, Vec3], ...]:
    """The hop, elsewhere and later; before, the drone waits on its pad."""
    way = [(t + later, (x + by[0], y + by[1], z + by[2])) for t, (x, y, z) in HOP]
    return ((0.0, way[0][1]), *way) if later else tuple(way)


@pytest.mark.parametrize("by", [(0.0, 7.0, 0.0), (2.0, -3.0, 6.0)])
@pytest.mark.parametrize("spare", [NEAR_M, -NEAR_M])
def test_two_drones_keep_their_centres_apart(by: Vec3, spare: float) -> None:
    (claim,) = separation(flights(HOP, moved(by), least=7.0 - spare), [])
    assert claim.worst == pytest.approx(7.0, abs=1e-5)
    assert (claim.limit, claim.upper, claim.holds) == (7.0 - spare, False, spare > 0)
    assert (claim.subject, claim.constraint) == ("cam1", "separation from cam2")
    assert claim.path == ("rules", "separation")


def test_the_clock_is_common() -> None:
    """Along one line, 2 s apart at 4 m/s: 8 m behind each other, and nearer only where one has turned.

    One comes back while the other still goes on: they meet. With a lane between them they pass.
    """
    (met,) = separation(flights(HOP, moved((0.0, 0.0, 0.0), 2.0)), [])
    assert (met.worst <= 1e-6, met.holds) == (True, False)
    (passed,) = separation(flights(HOP, moved((0.0, 5.0, 0.0), 2.0)), [])
    assert passed.worst == pytest.approx(5.0, abs=1e-4)
    assert passed.time == pytest.approx(15.0, abs=0.1)


@pytest.mark.parametrize("first", [True, False])
def test_a_drone_that_has_landed_stands_at_home(first: bool) -> None:
    """The other one passes over its pad at 2 m, half a minute later."""
    late = ((0.0, (50.0, 0.0, 2.0)), (58.0, (50.0, 0.0, 2.0)), (68.0, (-50.0, 0.0, 2.0)))
    ways = (HOP, late) if first else (late, HOP)
    (claim,) = separation(flights(*ways), [])
    assert claim.worst == pytest.approx(2.0, abs=1e-4)
    assert claim.time == pytest.approx(63.0, abs=0.1)
    assert not claim.holds


def test_every_pair_has_its_claim_and_pads_have_one_with_each_that_flies() -> None:
    one, two, three = flights(HOP, moved((0.0, 9.0, 0.0)), moved((0.0, 19.0, 0.0)))

    def pairs(found: list[Claim]) -> list[tuple[str, str, float]]:
        return [(c.subject, c.constraint[-4:], round(c.worst, 3)) for c in found]

    assert pairs(list(separation([one, two, three], []))) == [
        ("cam1", "cam2", 9.0), ("cam1", "cam3", 19.0), ("cam2", "cam3", 10.0),
    ]  # fmt: skip
    assert pairs(list(separation([one, two], [three]))) == [
        ("cam1", "cam2", 9.0), ("cam1", "cam3", 19.0), ("cam2", "cam3", 10.0),
    ]  # fmt: skip
    assert list(separation([one], [])) == list(separation([], [two, three])) == []


@pytest.mark.parametrize("spare", [NEAR_M, -NEAR_M])
def test_fleets_that_do_not_fly_stand_on_all_of_their_pads(spare: float) -> None:
    """One pad is 5 m beside the middle of the way; the boxes of another one are nearer, but it is not."""
    pads = ((70.0, 0.0, 9.0), (20.0, 3.0, 6.0), (20.0, -30.0, 10.0), (43.0, 5.0, 10.0))
    of = replace(mission(5.0 - spare), fleets=(fleet(pads),))
    track = DroneTrajectory("cam1", lines(HOP), PHASES, (), ())
    ir = TrajectoryIR(KeyframeIR(of, ()), (track,), (), ())
    (claim,) = from_fleets(ir, [JudgedFlight(of, of.drone("cam1"), track)])
    assert claim.worst == pytest.approx(5.0, abs=1e-5)
    assert (claim.limit, claim.holds, claim.constraint) == (5.0 - spare, spare > 0, "separation from swarm")
    assert claim.time is not None
    assert min(abs(claim.time - 9.0), abs(claim.time - 19.0)) < 0.1


@pytest.mark.parametrize("seed", range(4))
def test_the_nearest_pad_is_that_of_all(seed: int) -> None:
    pads = np.random.default_rng(seed).uniform((-20.0, -20.0, 0.0), (60.0, 20.0, 20.0), (9, 3))
    of = replace(mission(), fleets=(fleet(tuple(map(tuple, pads.tolist()))),))
    track = DroneTrajectory("cam1", lines(HOP), PHASES, (), ())
    ir = TrajectoryIR(KeyframeIR(of, ()), (track,), (), ())
    (claim,) = from_fleets(ir, [JudgedFlight(of, of.drone("cam1"), track)])
    way = track.curve(np.linspace(0.0, 28.0, 2801))[:, :3]
    least = np.linalg.norm(way[:, None] - pads, axis=2).min()
    assert claim.worst == pytest.approx(least, abs=5e-3)
    assert claim.worst <= least
