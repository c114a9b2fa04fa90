"""That a shot is flown as asked: every tolerance on both sides, in flights that are known by hand."""

from __future__ import annotations

from math import inf, nan

import numpy as np
import pytest

from shotc.geom.bernstein import Piecewise
from shotc.geom.shapes import CylinderShape
from shotc.geom.track import Track
from shotc.geom.vec import Vec3
from shotc.ir.keyed import KEYED
from shotc.ir.keyframes import KeyframeIR, PlacedShot
from shotc.ir.limits import Timing
from shotc.ir.mission import Beside, Ideal
from shotc.ir.path import CAM_PITCH, CAM_YAW, HFOV, PathDeviation
from shotc.ir.phases import KeyframeTime, Phase
from shotc.ir.target import Target
from shotc.ir.trajectory import Claim, DroneTrajectory, TrajectoryIR
from shotc.passes.verify.claims import JudgedFlight
from shotc.passes.verify.shots import shots
from tests.support.plain_flights import EAST, HOP, PHASES, WEST, lines, plain_mission
from tests.support.plain_flights import plain_keyframe as keyframe
from tests.support.plain_flights import plain_shot as shot
from tests.support.records import replace

MM = 1e-3


def judged(
    *placed: PlacedShot,
    way: tuple[tuple[float, Vec3], ...] = HOP,
    curve: Piecewise | None = None,
    phases: tuple[Phase, ...] = PHASES,
    met: dict[int, float] | None = None,
    told: tuple[PathDeviation, ...] = (),
    targets: tuple[Target, ...] = (),
) -> dict[str, Claim]:
    """Return the claims of a drone's shots by their names; met : the time of each keyframe."""
    mission = plain_mission(targets=targets)
    times = {0: 4.0, 1: 14.0} if met is None else met
    reached = tuple(KeyframeTime("out", i, t) for i, t in times.items())
    track = DroneTrajectory("cam1", lines(way) if curve is None else curve, phases, reached, ())
    ir = TrajectoryIR(KeyframeIR(mission, placed), (track,), told, ())
    found = list(shots(JudgedFlight(mission, mission.drones[0], track), ir))
    assert len({c.constraint for c in found}) == len(found)
    return {c.constraint: c for c in found}


def through(*places: tuple[float, Vec3]) -> tuple[tuple[float, Vec3], ...]:
    return tuple(sorted((dict(HOP) | dict(places)).items()))


def renamed(*shots_of_phases: str | None) -> tuple[Phase, ...]:
    return tuple(replace(p, shot=name) for p, name in zip(PHASES, shots_of_phases, strict=True))


@pytest.mark.parametrize("times", [0, 1, 2])
def test_a_shot_is_flown_once(times: int) -> None:
    names = ["out" if k < times else None for k in range(2)]
    found = judged(shot(keyframe(WEST), keyframe(EAST)), phases=renamed(None, *names, None))
    claim = found["times flown"]
    assert (claim.worst, claim.limit, claim.holds) == (times, 1.0, times == 1)
    assert claim.upper == (times > 0)
    assert ("distance from keyframes" in found) == (times == 1)


def test_shots_of_another_drone_are_not_asked_of_this_one() -> None:
    of_another = shot(keyframe(WEST), keyframe(EAST), drone="cam2", id="away")
    assert judged(of_another) == {}
    assert judged(of_another, shot(keyframe(WEST), keyframe(EAST)))["times flown"].holds


@pytest.mark.parametrize(("off", "holds"), [(0.9 * MM, True), (1.1 * MM, False), (2.0, False)])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_duration_and_a_start_are_kept(off: float, holds: bool, sign: float) -> None:
    both = shot(keyframe(WEST), keyframe(EAST))
    duration = replace(both, shot=replace(both.shot, timing=Timing(duration=10.0 + sign * off)))
    claim = judged(duration)["error of duration"]
    assert (claim.worst, claim.holds) == (pytest.approx(off), holds)
    start = replace(both, shot=replace(both.shot, timing=Timing(start=4.0 + sign * off)))
    claim = judged(start)["error of start"]
    assert (claim.worst, claim.holds) == (pytest.approx(off), holds)
    assert not {"error of duration", "error of start", "start too early"} & set(judged(both))


@pytest.mark.parametrize(
    ("early", "holds"), [(0.9 * MM, True), (1.1 * MM, False), (2.0, False), (-5.0, True)]
)
def test_a_shot_after_another_one_begins_no_earlier_than_that_one_ends(early: float, holds: bool) -> None:
    phases = list(renamed(None, "out", "back", None))
    phases[1] = replace(phases[1], end=14.0 + early)
    back = shot(
        keyframe(EAST, placed=False), keyframe(WEST, placed=False), id="back", timing=Timing(after="out")
    )
    claim = judged(back, phases=tuple(phases))["start too early"]
    assert (claim.worst, claim.holds) == (pytest.approx(early), holds)
    nowhere = replace(back, shot=replace(back.shot, timing=Timing(after="gone")))
    assert "start too early" not in judged(nowhere, phases=tuple(phases))


@pytest.mark.parametrize("at", [0, 1])
@pytest.mark.parametrize(("off", "holds"), [(0.9 * MM, True), (1.1 * MM, False), (3.0, False)])
def test_the_camera_is_at_every_placed_keyframe(at: int, off: float, holds: bool) -> None:
    places = [WEST, EAST]
    x, y, z = places[at]
    places[at] = (x, y + 0.6 * off, z - 0.8 * off)
    claim = judged(shot(*map(keyframe, places)))["distance from keyframes"]
    assert (claim.worst, claim.holds) == (pytest.approx(off), holds)
    assert claim.time == (4.0, 14.0)[at]
    assert "distance from keyframes" not in judged(shot(*(keyframe(p, placed=False) for p in places)))


@pytest.mark.parametrize(
    "met", [{0: 4.0}, {1: 14.0}, {}, {0: 3.9989, 1: 14.0}, {0: 4.0, 1: 14.0011}, {0: 4.0, 1: nan}]
)
def test_a_keyframe_is_met_within_its_shot(met: dict[int, float]) -> None:
    rest = through((3.9, WEST), (14.1, EAST))
    claim = judged(shot(keyframe(WEST), keyframe(EAST)), met=met, way=rest)["distance from keyframes"]
    assert (claim.worst, claim.holds) == (inf, False)


def test_a_keyframe_may_be_met_a_millisecond_beside_its_shot() -> None:
    rest = through((3.9, WEST), (14.1, EAST))
    found = judged(shot(keyframe(WEST), keyframe(EAST)), met={0: 3.9991, 1: 14.0009}, way=rest)
    assert found["distance from keyframes"].holds


@pytest.mark.parametrize(("late", "holds"), [(0.9 * MM, True), (1.1 * MM, False), (2.0, False)])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_keyframe_with_a_time_is_met_then(late: float, holds: bool, sign: float) -> None:
    timed = shot(keyframe(WEST, time=0.0), keyframe((20.0, 0.0, 10.0), time=5.0), keyframe(EAST))
    met = {0: 4.0, 1: 9.0 + sign * late, 2: 14.0}
    claim = judged(timed, met=met)["delay of keyframes"]
    assert (claim.worst, claim.holds) == (pytest.approx(late), holds)
    missed = judged(timed, met={0: 4.0, 2: 14.0})["delay of keyframes"]
    assert (missed.worst, missed.holds) == (inf, False)
    assert "delay of keyframes" not in judged(shot(keyframe(WEST), keyframe(EAST)))


def resting(channel: int, by: float) -> Piecewise:
    """The hop with a rest from 4 s to 6 s, in the middle of which one channel differs."""
    plain = lines(through((5.0, WEST), (6.0, WEST)))
    k = int(np.searchsorted(plain.breaks, 5.0))
    ctrl = plain.ctrl.copy()
    ctrl[k - 1, -1, channel] += by
    ctrl[k, 0, channel] += by
    return Piecewise(plain.breaks, ctrl)


@pytest.mark.parametrize(("by", "holds"), [(0.9 * MM, True), (-1.1 * MM, False), (1.1 * MM, False)])
@pytest.mark.parametrize("channel", range(HFOV + 1))
@pytest.mark.parametrize("hold", [1.0, 2.0])
def test_a_hold_is_at_rest_in_every_channel(channel: int, by: float, holds: bool, hold: float) -> None:
    held = shot(keyframe(WEST, hold=hold), keyframe(EAST))
    claim = judged(held, curve=resting(channel, by))["drift at keyframe 1"]
    assert (claim.worst, claim.holds) == (pytest.approx(abs(by), rel=1e-3), holds)
    through_it = shot(keyframe(WEST), keyframe(EAST))
    assert not any(name.startswith("drift") for name in judged(through_it, curve=resting(channel, by)))


@pytest.mark.parametrize("channel", [1, CAM_YAW, CAM_PITCH])
def test_a_camera_that_follows_turns_while_it_rests(channel: int) -> None:
    keyed = KEYED._replace(points=((0.0, WEST), (1.0, EAST)))
    held = shot(keyframe(WEST, hold=2.0), keyframe(EAST), ideal=keyed, timing=Timing(4.0, None, 10.0))
    claim = judged(held, curve=resting(channel, 0.1))["drift at keyframe 1"]
    assert claim.holds == (channel != 1)


@pytest.mark.parametrize(
    ("start", "hold", "holds"),
    [(4.0, 2.0, True), (3.9991, 2.0, True), (3.9989, 2.0, False), (8.0, 6.0009, True), (8.0, 6.0011, False)],
)
def test_a_hold_is_within_its_shot(start: float, hold: float, holds: bool) -> None:
    still = tuple((t, WEST if 3 < t < 25 else place) for t, place in through((3.5, WEST), (15.0, WEST)))
    held = shot(keyframe(WEST, hold=hold), keyframe(WEST))
    claim = judged(held, way=still, met={0: start, 1: 14.0})["drift at keyframe 1"]
    assert (claim.worst < inf, claim.holds) == (holds, holds)


@pytest.mark.parametrize("met", [{}, {0: 4.0}])
def test_a_hold_without_its_time_is_none(met: dict[int, float]) -> None:
    held = shot(keyframe(WEST), keyframe(EAST, hold=2.0))
    assert judged(held, met=met)["drift at keyframe 2"].worst == inf


@pytest.mark.parametrize(("time", "holds"), [(3.0, True), (9.0, False), (13.99, False), (15.0, True)])
def test_a_single_keyframe_is_held_for_the_whole_shot(time: float, holds: bool) -> None:
    still = tuple((t, WEST if 3 < t < 25 else place) for t, place in HOP)
    moved = tuple(sorted((dict(still) | {time: (0.0, 0.5, 10.0), 14.0: WEST, 4.0: WEST}).items()))
    claim = judged(shot(keyframe(WEST)), way=moved, met={0: 4.0})["drift at keyframe 1"]
    assert claim.holds == holds


WALK = Track((0.0, 30.0), ((0.0, 5.0, 1.0), (120.0, 5.0, 1.0)))
WALKER = Target("walker", WALK.points[0], CylinderShape(0.4, 2.0), ("targets", "walker"), WALK)
WITH_IT = Beside("walker", (-16.0, -5.0, 10.0))
"""A place that moves as the drone does from 4 s to 14 s."""


@pytest.mark.parametrize("hold", [0.0, 6.0])
@pytest.mark.parametrize("time", [5.0, 8.0, 11.0, 13.0])
def test_beside_a_target_the_camera_is_in_place_when_a_hold_begins_and_ends(time: float, hold: float) -> None:
    aside = through(*((t, (4 * t - 16.0, 2 * MM * (t == time), 10.0)) for t in (5.0, 8.0, 11.0, 13.0)))
    beside = shot(keyframe((0.0, 0.0, 0.0), hold=hold), beside=WITH_IT)
    beside = replace(beside, keyframes=(*beside.keyframes, keyframe(EAST, placed=False)))
    beside = replace(beside, shot=replace(beside.shot, keyframes=beside.shot.keyframes * 2))
    found = judged(beside, way=aside, met={0: 5.0, 1: 14.0}, targets=(WALKER,))
    counts = (5.0, 11.0) if hold else (5.0,)
    claim = found["distance from keyframes"]
    assert claim.worst == pytest.approx(2 * MM * (time in counts), abs=1e-9)
    assert claim.holds == (time not in counts)
    assert "drift at keyframe 1" not in found


def ideal(*, placed: bool, last: Vec3 = EAST) -> PlacedShot:
    course = Ideal("world", None, ((0.0, WEST), (1.0, last)), placed)
    return shot(ideal=course, timing=Timing(duration=10.0))


def aside(by: float, at: float = 9.0) -> tuple[tuple[float, Vec3], ...]:
    return through(
        (at - 0.5, (4 * at - 18.0, 0.0, 10.0)),
        (at, (4 * at - 16.0, by, 10.0)),
        (at + 0.5, (4 * at - 14.0, 0.0, 10.0)),
    )


@pytest.mark.parametrize("placed", [True, False])
@pytest.mark.parametrize(("by", "holds"), [(0.99, True), (1.01, False), (-1.01, False)])
def test_a_shot_leaves_its_ideal_by_a_metre_unreported(by: float, holds: bool, placed: bool) -> None:
    claim = judged(ideal(placed=placed), way=aside(by))["distance from its place"]
    assert claim.worst == pytest.approx(abs(by), abs=1e-6)
    assert (claim.limit, claim.holds, claim.time) == (1.0, holds, pytest.approx(9.0))


def test_what_is_reported_and_explained_adds_to_that_metre() -> None:
    def limit(distance: float, cause: str, of: str = "out", less: float = 0.0) -> float:
        told = (PathDeviation(of, less, 0.0, cause), PathDeviation(of, distance, 0.0, cause))
        return judged(ideal(placed=False), told=told)["distance from its place"].limit

    assert limit(0.3, "the drone's limits") == pytest.approx(1.3)
    assert limit(0.3, "the drone's limits", less=0.2) == pytest.approx(1.3)
    assert limit(0.3, "the drone's limits", of="back") == 1.0
    assert limit(0.3, "zone tree") == 1.0
    assert 2.0 < limit(1e3, "the drone's limits") == limit(1e6, "the drone's limits") < 100.0


@pytest.mark.parametrize(("by", "holds"), [(9 * MM, True), (11 * MM, False)])
def test_a_standing_camera_is_in_place_to_a_centimetre(by: float, holds: bool) -> None:
    still = tuple((t, (0.0, by, 10.0) if 3 < t < 25 else place) for t, place in HOP)
    claim = judged(ideal(placed=True, last=WEST), way=still)["distance from its place"]
    assert (claim.worst, claim.holds) == (pytest.approx(by), holds)
    assert claim.limit == pytest.approx(10 * MM)
    generated = judged(ideal(placed=False, last=WEST), way=still)["distance from its place"]
    slow = judged(ideal(placed=True, last=(0.1, 0.0, 10.0)), way=still)["distance from its place"]
    assert generated.limit == slow.limit == 1.0


@pytest.mark.parametrize("time", [4.003, 13.997])
def test_the_first_and_the_last_frame_count_between_two_samples(time: float) -> None:
    start, end = (time, 14.0) if time < 9 else (4.0, time)
    phases = list(PHASES)
    phases[1] = replace(phases[1], start=start, end=end)
    near = 1 * MM
    spike = through(
        (time - near, (4 * (time - near) - 16.0, 0.0, 10.0)),
        (time, (4 * time - 16.0, 7.0, 10.0)),
        (time + near, (4 * (time + near) - 16.0, 0.0, 10.0)),
    )
    claim = judged(ideal(placed=False), way=spike, phases=tuple(phases))["distance from its place"]
    assert claim.worst == pytest.approx(7.0, abs=0.01)
    assert claim.time == time


@pytest.mark.parametrize("names", [("out", "back"), ("back", "out")])
def test_shots_of_a_drone_are_flown_in_the_order_of_the_mission(names: tuple[str, str]) -> None:
    """The mission has `out` before `back`; the second is flown on the way home."""
    mission = plain_mission()
    phases = renamed(None, names[0], names[1], None)
    track = DroneTrajectory("cam1", lines(HOP), tuple(replace(p, name="shot") for p in phases), (), ())
    asked = (shot(keyframe(WEST)), shot(keyframe(WEST), id="back"))
    ir = TrajectoryIR(KeyframeIR(mission, asked), (track,), (), ())
    found = shots(JudgedFlight(mission, mission.drones[0], track), ir)
    (claim,) = (c for c in found if c.constraint == "shots out of order")
    turned = names[0] == "back"
    assert (claim.worst, claim.limit, claim.holds, claim.hard) == (float(turned), 0.0, not turned, True)
    assert claim.time == (14.0 if turned else None)


@pytest.mark.parametrize(("hold", "holds"), [(10.0, True), (10.0009, True), (10.0011, False), (9.0, False)])
def test_a_still_shot_without_a_duration_lasts_as_long_as_its_kind_holds(hold: float, holds: bool) -> None:
    claim = judged(shot(keyframe(WEST, hold=hold)))["error of duration"]
    assert (claim.worst, claim.holds) == (pytest.approx(abs(10.0 - hold), abs=1e-9), holds)
    assert "error of duration" not in judged(shot(keyframe(WEST, hold=hold), keyframe(EAST)))
