"""Shots told by keyframes on their own clock: their times, and the way between them."""

from __future__ import annotations

from math import dist, inf

import pytest

from shotc.geom.shapes import CylinderShape
from shotc.geom.track import Track
from shotc.ir.framed import at_start
from shotc.ir.ideal import ideal_place
from shotc.ir.keyed import KEYED, arrivals, in_order, place_of, settled
from shotc.ir.limits import Timing, Vec3
from shotc.ir.mission import Beside, Composition, Keyframe, MissionIR, Shot
from shotc.ir.origin import OriginMap
from shotc.ir.promise import Promise
from shotc.ir.rules import Rules
from shotc.ir.target import Target

BEND = Track((0.0, 20.0, 40.0), ((0.0, 0.0, 1.0), (40.0, 0.0, 1.0), (40.0, 40.0, 1.0)), until=inf)
MISSION = MissionIR(
    "m",
    None,
    0.0,
    (),
    (Target("walker", (0.0, 0.0, 1.0), CylinderShape(0.4, 2.0), (), BEND),),
    (),
    Rules(3.0, 2.0, 1.0),
    (),
    50.0,
    (),
    "",
    (),
    OriginMap("m.yaml", {}, {}),
)


def keyframe(at: Vec3 = (0.0, 0.0, 0.0), beside: Beside | None = None, **changes: object) -> Keyframe:
    made = Keyframe(
        at, None, "walker", Composition("center", ((0.0, 0.0),)), 1.2, 0.0, None, True, (), beside=beside
    )
    return made._replace(**changes)  # type: ignore[arg-type]


def beside(x: float, y: float, z: float, *, turns: bool = False, **changes: object) -> Keyframe:
    return keyframe(beside=Beside("walker", (x, y, z), turns), **changes)


def shot(*keyframes: Keyframe, duration: float = 10.0) -> Shot:
    timing = Timing(duration=duration)
    made = Shot("s", "keyframes", "cam", None, keyframes, timing, 1.0, Promise(), False, (), KEYED)
    return settled(MISSION, made, 5.0)


def test_a_place_counts_from_the_foot_of_its_target() -> None:
    assert place_of(MISSION, beside(-3.0, 2.0, 4.0), 10.0) == pytest.approx((17.0, 2.0, 4.0))


def test_a_place_that_turns_is_ahead_of_its_target_and_to_its_left() -> None:
    east, north = (place_of(MISSION, beside(5.0, 1.0, 4.0, turns=True), t) for t in (10.0, 30.0))
    assert east == pytest.approx((25.0, 1.0, 4.0))
    assert north == pytest.approx((39.0, 25.0, 4.0))


def test_every_keyframe_is_reached_at_its_time() -> None:
    made = shot(beside(-8.0, 0.0, 3.0, turns=True), beside(0.0, -8.0, 3.0), keyframe((40.0, -20.0, 9.0)))
    for one, t in zip(made.keyframes, arrivals(made), strict=True):
        assert ideal_place(MISSION, made, 5.0, 5.0 + t) == pytest.approx(place_of(MISSION, one, 5.0 + t))


def test_times_follow_the_way_as_the_target_sees_it() -> None:
    made = shot(beside(-8.0, 0.0, 3.0), beside(-8.0, 6.0, 3.0), beside(10.0, 6.0, 3.0))
    assert arrivals(made) == pytest.approx((0.0, 2.5, 10.0))


def test_holds_and_given_times_are_kept() -> None:
    made = shot(
        beside(-8.0, 0.0, 3.0, hold=1.0),
        beside(-8.0, 6.0, 3.0, hold=2.0),
        beside(-8.0, 12.0, 3.0, time=7.0),
        beside(0.0, 12.0, 3.0, hold=1.0),
    )
    assert arrivals(made) == pytest.approx((0.0, 3.0, 7.0, 9.0))
    assert in_order(made)


def test_a_hold_beside_a_target_goes_along_and_one_in_the_world_stands() -> None:
    made = shot(beside(-8.0, 0.0, 3.0, hold=3.0), keyframe((30.0, -20.0, 9.0), hold=3.0))
    along = [ideal_place(MISSION, made, 5.0, t)[0] - MISSION.targets[0].at(t)[0] for t in (5.0, 6.5, 8.0)]
    assert along == pytest.approx([-8.0] * 3)
    assert {ideal_place(MISSION, made, 5.0, t) for t in (12.0, 13.5, 15.0)} == {(30.0, -20.0, 9.0)}


def test_the_way_has_no_kinks() -> None:
    made = shot(beside(-8.0, 0.0, 3.0), beside(0.0, -8.0, 5.0, time=2.0), keyframe((45.0, -15.0, 9.0)))
    step = 1e-4
    places = [ideal_place(MISSION, made, 5.0, 7.0 + k * step) for k in (-1, 0, 1)]
    a, b, c = places
    assert dist(a, b) / step == pytest.approx(dist(b, c) / step, abs=0.01)
    assert dist(a, c) == pytest.approx(dist(a, b) + dist(b, c), rel=1e-4)


def test_a_slow_way_beside_a_fast_one_does_not_overshoot() -> None:
    made = shot(beside(-8.0, 0.0, 3.0), beside(-7.0, 0.0, 3.0, time=9.0), beside(20.0, 0.0, 3.0))
    track = MISSION.targets[0]
    ahead = [ideal_place(MISSION, made, 5.0, 5.0 + t / 10)[0] - track.at(5.0 + t / 10)[0] for t in range(91)]
    assert min(ahead) >= -8.0 - 1e-9
    assert max(ahead) <= -7.0 + 1e-9


def test_a_later_start_carries_the_keyframes_along() -> None:
    made = shot(beside(-8.0, 0.0, 3.0), keyframe((45.0, -15.0, 9.0)))
    later = at_start(MISSION, made, 9.0)
    assert later.keyframes[0].at == pytest.approx((10.0, 0.0, 3.0))
    assert later.keyframes[1].at == (45.0, -15.0, 9.0)


def test_keyframes_with_no_time_between_them_are_found() -> None:
    assert not in_order(shot(beside(-8.0, 0.0, 3.0, hold=4.0), beside(0.0, 8.0, 3.0, time=4.0)))
