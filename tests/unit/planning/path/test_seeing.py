"""Ways between placed keyframes: led to where their target is seen, and otherwise as they were."""

from __future__ import annotations

import numpy as np
import pytest

from shotc.geom.shapes import CylinderShape
from shotc.ir.allow import HIDDEN
from shotc.ir.coverage import coverage
from shotc.ir.keyframes import PlacedShot
from shotc.ir.limits import Timing
from shotc.ir.mission import MissionIR
from shotc.ir.path import MovingLeg
from shotc.ir.promise import Promise
from shotc.ir.target import Target
from tests.support.mesh_spaces import with_meshes
from tests.support.path_scenes import framed, legs, mission, planned, shot
from tests.support.records import replace
from tests.support.scenes import cone, house, turned

pytestmark = pytest.mark.slow

STATUE = Target("statue", (0.0, 0.0, 2.0), CylinderShape(0.8, 4.0), ("targets", "statue"))
BENCH = Target("bench", (4.0, 0.0, 1.0), CylinderShape(0.8, 2.0), ("targets", "bench"))
TREE = turned(cone(1.5, 1.0, 5.0), 0.0, (0.0, -12.0))


def pair(a: Target = STATUE, b: Target = STATUE) -> PlacedShot:
    """From the left to the right, past what stands in the middle."""
    return shot([framed(0, (-14.0, -20.0, 4.0), a), framed(1, (14.0, -20.0, 4.0), b)])


def square(*targets: Target) -> MissionIR:
    return mission(targets=targets or (STATUE,))


def film(of: MissionIR, placed: PlacedShot) -> MovingLeg:
    (leg,) = legs(planned(of, placed), "shot")
    assert isinstance(leg, MovingLeg)
    return leg


def covered(of: MissionIR, leg: MovingLeg) -> np.ndarray:
    s = np.linspace(leg.curve.start, leg.curve.end, 300)
    return coverage(of, (), "statue", leg.curve(s)[:, :3], np.zeros(300)).share


def same(a: MovingLeg, b: MovingLeg) -> bool:
    return a.curve.ctrl.shape == b.curve.ctrl.shape and bool((a.curve.ctrl == b.curve.ctrl).all())


@pytest.fixture(scope="module")
def plain() -> MovingLeg:
    return film(square(), pair())


@pytest.mark.long
def test_a_way_between_placed_keyframes_is_led_to_where_its_target_is_seen(plain):
    of = with_meshes(square(), TREE)
    leg = film(of, pair())
    assert covered(of, plain).max() > 0.9
    assert covered(of, leg).max() < 0.5
    assert covered(of, leg).mean() < 0.3 * covered(of, plain).mean()
    for mark, keyframe in zip(leg.marks, pair().keyframes, strict=True):
        assert leg.curve(np.array([mark.s]))[0, :3] == pytest.approx(keyframe.at, abs=1e-6)


def test_it_comes_no_nearer_to_its_target_than_the_way_without(plain):
    of = with_meshes(square(), TREE)
    leg = film(of, pair())
    nearest = [
        np.linalg.norm(
            one.curve(np.linspace(one.curve.start, one.curve.end, 300))[:, :3] - STATUE.centre, axis=1
        )
        for one in (leg, plain)
    ]
    assert nearest[0].min() > nearest[1].min() - 0.5


def test_a_way_from_which_its_target_is_seen_stays_as_it_is(plain):
    barn = turned(house(6.0, 6.0, 5.0, 7.0), 0.0, (0.0, 30.0))
    assert same(film(with_meshes(square(), barn), pair()), plain)


@pytest.mark.parametrize(
    "meant", [{"allow": (HIDDEN,)}, {"promise": Promise(reveal=(0.0, 1.0))}], ids=["allow", "reveal"]
)
def test_a_way_stays_as_it_is_where_its_target_may_be_hidden(plain, meant):
    placed = pair()
    placed = placed._replace(shot=replace(placed.shot, **meant))
    assert same(film(with_meshes(square(), TREE), placed), plain)


@pytest.mark.long
def test_a_way_stays_as_it_is_where_the_time_asked_for_leaves_none_to_go_aside():
    placed = shot(pair().keyframes, timing=Timing(duration=7.0))
    assert same(film(with_meshes(square(), TREE), placed), film(square(), placed))
    free = shot(pair().keyframes, timing=Timing(duration=30.0))
    assert not same(film(with_meshes(square(), TREE), free), film(square(), free))


def test_a_way_from_one_target_to_another_stays_as_it_is():
    of = square(STATUE, BENCH)
    assert same(film(with_meshes(of, TREE), pair(b=BENCH)), film(of, pair(b=BENCH)))


@pytest.mark.long
def test_a_way_stays_as_it_is_where_nothing_beside_it_sees_more(plain):
    walls = [turned(house(40.0, 1.0, 60.0, 61.0), 0.0, (0.0, -10.0))]
    assert same(film(with_meshes(square(), *walls), pair()), plain)
