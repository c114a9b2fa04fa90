"""That a shot with keyframes is flown along its path, in order and as aimed: each limit on both sides."""

from __future__ import annotations

from math import inf

import numpy as np
import pytest

from shotc.geom.shapes import CylinderShape
from shotc.geom.solids import Cylinder
from shotc.geom.vec import Vec3
from shotc.ir.keyframes import KeyframeIR, PlacedShot
from shotc.ir.mission import Zone
from shotc.ir.path import PathDeviation
from shotc.ir.phases import KeyframeTime
from shotc.ir.preference import PICTURE_SHARE
from shotc.ir.target import Target
from shotc.ir.trajectory import DroneTrajectory, TrajectoryIR
from shotc.passes.verify.claims import JudgedFlight
from shotc.passes.verify.course import course
from tests.support.plain_courses import BOTH, Way, judged
from tests.support.plain_flights import EAST, HOP, PHASES, WEST, lines, plain_mission
from tests.support.plain_flights import plain_keyframe as keyframe
from tests.support.plain_flights import plain_shot as shot
from tests.support.records import replace

MIDDLE = (20.0, 0.0, 10.0)
GENERATED = (keyframe(WEST, placed=False), keyframe(EAST, placed=False))
MAST = Target("mast", (20.0, 100.0, 10.0), CylinderShape(1.0, 20.0), ("targets", "mast"))
ORDER, PATH, ENDS, DETOUR, WAY = (
    "keyframes out of order",
    "distance from its path",
    "distance from its ends",
    "detour where it is free",
    "way between keyframes",
)


def through(*places: tuple[float, Vec3]) -> Way:
    return tuple(sorted((dict(HOP) | dict(places)).items()))


def test_shots_of_others_on_their_own_clock_or_not_flown_are_not_judged_here() -> None:
    assert judged(shot(*BOTH, drone="cam2")) == {}
    assert judged(shot(*BOTH, id="back")) == {}
    assert judged(shot(*BOTH, ideal=object())) == {}
    assert ORDER in judged(shot(*BOTH))


@pytest.mark.parametrize(
    ("first", "last", "worst"),
    [
        (4.0, 14.0, 0.0), (4.0009, 14.0, 9e-4), (4.0011, 14.0, 11e-4), (3.9991, 14.0, 9e-4),
        (3.9989, 14.0, 11e-4), (4.0, 13.9991, 9e-4), (4.0, 13.9989, 11e-4), (4.0, 14.0009, 9e-4),
        (4.0, 14.0011, 11e-4), (6.0, 12.0, 2.0),
    ],
)  # fmt: skip
def test_the_first_and_the_last_keyframe_are_the_ends_of_the_shot(
    first: float, last: float, worst: float
) -> None:
    claim = judged(shot(*BOTH), met=((0, first), (1, last)))[ORDER]
    assert claim.worst == pytest.approx(worst, abs=1e-9)
    assert (claim.limit, claim.holds) == (1e-3, worst < 1e-3)


def test_before_and_after_keyframes_with_times_the_camera_may_stand() -> None:
    timed = shot(keyframe(WEST, time=1.0), keyframe(EAST, time=8.0))
    assert judged(timed, met=((0, 5.0), (1, 12.0)))[ORDER].worst == 0.0
    assert judged(timed, met=((0, 3.9), (1, 12.0)))[ORDER].worst == pytest.approx(0.1)
    assert judged(timed, met=((0, 5.0), (1, 14.2)))[ORDER].worst == pytest.approx(0.2)
    one = shot(keyframe(WEST))
    assert judged(one, met=((0, 4.0),))[ORDER].worst == 0.0
    assert judged(one, met=((0, 5.0),))[ORDER].worst == pytest.approx(1.0)


def test_keyframes_follow_one_another_with_their_holds() -> None:
    held = shot(keyframe(WEST), keyframe(MIDDLE, hold=2.0), keyframe(EAST))
    for middle, worst in ((9.0, 0.0), (12.0, 0.0), (12.5, 0.5), (3.0, 1.0)):
        claim = judged(held, met=((0, 4.0), (1, middle), (2, 14.0)))[ORDER]
        assert claim.worst == pytest.approx(worst)
    last = shot(keyframe(WEST), keyframe(EAST, hold=2.0))
    assert judged(last, met=((0, 4.0), (1, 12.0)))[ORDER].worst == 0.0
    assert judged(last, met=((0, 4.0), (1, 14.0)))[ORDER].worst == pytest.approx(2.0)


@pytest.mark.parametrize("met", [((0, 4.0),), ((0, 4.0), (1, 9.0), (1, 14.0)), ((0, 4.0), (2, 14.0)), ()])
def test_every_keyframe_is_met_once(met: tuple[tuple[int, float], ...]) -> None:
    claim = judged(shot(*BOTH), met=met)[ORDER]
    assert (claim.worst, claim.holds) == (inf, False)


@pytest.mark.parametrize(("beyond", "holds"), [(0.2499, True), (0.2501, False)])
def test_a_generated_path_is_left_by_its_bow_and_a_quarter_of_a_metre(beyond: float, holds: bool) -> None:
    """The bow between two keyframes may be a quarter of their distance."""
    bent = through((9.0, (20.0, 10.0 + beyond, 10.0)))
    claim = judged(shot(*GENERATED), way=bent)[PATH]
    assert claim.worst == pytest.approx(beyond, abs=1e-3)
    assert (claim.limit, claim.holds) == (0.25, holds)
    assert claim.time == pytest.approx(9.0, abs=0.01)


@pytest.mark.parametrize(("off", "holds"), [(0.2499, True), (0.2501, False)])
def test_at_a_generated_keyframe_there_is_no_bow(off: float, holds: bool) -> None:
    three = shot(GENERATED[0], keyframe(MIDDLE, placed=False), GENERATED[1])
    aside = through((9.0, (20.0, -off, 10.0)))
    claim = judged(three, way=aside, met=((0, 4.0), (1, 9.0), (2, 14.0)))[PATH]
    assert (claim.worst, claim.time, claim.holds) == (pytest.approx(off), 9.0, holds)


def test_what_is_reported_and_explained_is_allowed() -> None:
    """Two deviations at most count, as far as the picture and obstacles explain them."""

    def limit(*distances: float, cause: str = "the picture", of: str = "out", **world: object) -> float:
        told = tuple(PathDeviation(of, d, 0.0, cause) for d in distances)
        return judged(shot(*GENERATED), told=told, **world)[PATH].limit

    assert limit(0.5) == pytest.approx(0.75)
    assert limit(0.1, 0.5, 0.3) == pytest.approx(1.05)
    assert limit(0.5, of="back") == 0.25
    assert limit(0.5, cause="zone tree") == 0.25
    tree = Zone("tree", "out", Cylinder((20.0, 2.0), 1.0, 0.0, 6.0), ("world", "zones", "tree"))
    assert limit(0.5, cause="zone tree", zones=(tree,)) == 0.25
    tall = replace(tree, solid=tree.solid._replace(top=12.0))
    assert limit(0.5, cause="zone tree", zones=(tall,)) == pytest.approx(0.75)
    most = limit(1e6)
    assert most == limit(1e3) < limit(1e6, zones=(tall,)) == pytest.approx(most + 12.0 + 2 * 1.5)


@pytest.mark.parametrize("end", [0, 1])
@pytest.mark.parametrize(("off", "holds"), [(0.499, True), (0.501, False)])
def test_a_free_end_of_a_generated_path_is_met_to_half_a_metre(end: int, off: float, holds: bool) -> None:
    places = [WEST, EAST]
    x, y, z = places[end]
    places[end] = (x, y + off, z)
    wanted = tuple(keyframe(p, placed=False) for p in places)
    claim = judged(shot(*wanted))[ENDS]
    assert claim.worst == pytest.approx(off)
    assert (claim.limit, claim.holds, claim.time) == (0.5, holds, (4.0, 14.0)[end])


def near(away: float, keep: str = "out") -> dict[str, object]:
    """A zone about both ends of the path: its wall is so far from the first of them."""
    solid = Cylinder((-100.0, 0.0), 100.0 - away, 0.0, 50.0)
    inside = Cylinder((0.0, 0.0), away, 0.0, 50.0)
    kept = solid if keep == "out" else inside
    return {"zones": (Zone("it", keep, kept, ("world", "zones", "it")),)}  # type: ignore[arg-type]


def clearance(metres: float, name: str) -> dict[str, object]:
    rules = replace(plain_mission().rules, **{name: metres})
    return {"rules": rules}


BODY_M = 0.5 + 1.0
"""Radius of the drone, and how much farther an obstacle still counts."""


@pytest.mark.parametrize("spare", [1e-3, -1e-3])
@pytest.mark.parametrize("obstacle", ["zone", "fence", "ground", "target"])
def test_an_end_that_an_obstacle_is_near_is_not_free(obstacle: str, spare: float) -> None:
    beside = Target("mast", (0.0, 10.0, 10.0), CylinderShape(1.0, 20.0), ("targets", "mast"))
    world: dict[str, dict[str, object]] = {
        "zone": near(BODY_M + spare),
        "fence": near(BODY_M + spare, "in"),
        "ground": clearance(10.0 - BODY_M - spare, "ground_clearance"),
        "target": {"targets": (beside,)} | clearance(9.0 - BODY_M - spare, "target_clearance"),
    }
    off = keyframe((0.0, 0.0, 10.0), placed=False), keyframe((40.0, 0.0, 10.0), placed=False)
    shifted = through((4.0, (0.0, 0.0, 10.4)), (3.9, (0.0, 0.0, 10.0)))
    found = judged(shot(*off), way=shifted, **world[obstacle])
    if obstacle == "ground":  # both ends are as high
        assert (ENDS in found) == (spare > 0)
        return
    other_end_is_free = obstacle != "fence"
    first = 0.4 if spare > 0 else 0.0
    if not other_end_is_free and spare < 0:
        assert ENDS not in found
    else:
        assert found[ENDS].worst == pytest.approx(first)


@pytest.mark.parametrize("spare", [1e-3, -1e-3])
def test_a_detour_where_it_is_free_is_a_share_of_the_distance_to_what_is_filmed(spare: float) -> None:
    filmed = tuple(k._replace(target="mast") for k in GENERATED)
    three = shot(filmed[0], keyframe(MIDDLE, placed=False, target="mast"), filmed[1])
    off = 100.0 * (PICTURE_SHARE - spare)
    aside = through((9.0, (20.0, 0.0, 10.0 + off)))
    found = judged(three, way=aside, met=((0, 4.0), (1, 9.0), (2, 14.0)), targets=(MAST,))[DETOUR]
    assert found.worst == pytest.approx(PICTURE_SHARE - spare)
    assert (found.limit, found.holds, found.time) == (PICTURE_SHARE, spare > 0, 9.0)
    unseen = shot(GENERATED[0], keyframe(MIDDLE, placed=False), GENERATED[1])
    free = judged(unseen, way=aside, met=((0, 4.0), (1, 9.0), (2, 14.0)), targets=(MAST,))[DETOUR]
    assert free.worst == 0.0


@pytest.mark.parametrize(("beyond", "holds"), [(-1e-2, True), (1e-2, False)])
def test_between_placed_keyframes_half_of_the_chord_is_allowed(beyond: float, holds: bool) -> None:
    most = 0.5 * 40.0 + 0.25
    bent = through((9.0, (20.0, 0.6 * (most + beyond), 10.0 + 0.8 * (most + beyond))))
    found = judged(shot(*BOTH), way=bent)
    claim = found[WAY]
    assert claim.worst == pytest.approx(most + beyond, abs=1e-3)
    assert (claim.limit, claim.holds) == (pytest.approx(most), holds)
    assert not {PATH, ENDS, DETOUR} & set(found)


def test_beside_a_longer_way_a_short_one_may_swing_as_far_and_holds_do_not_count() -> None:
    """36 m until 9 s, a hold in which the camera is elsewhere, and 4 m."""
    three = shot(keyframe(WEST), keyframe((36.0, 0.0, 10.0), hold=1.0), keyframe(EAST))
    met = ((0, 4.0), (1, 9.0), (2, 14.0))
    way = through(
        (9.0, (36.0, 0.0, 10.0)),
        (9.5, (36.0, 50.0, 10.0)),
        (10.0, (36.0, 0.0, 10.0)),
        (12.0, (38.0, 15.0, 10.0)),
    )
    claim = judged(three, way=way, met=met)[WAY]
    assert claim.worst == pytest.approx(15.0, abs=1e-3)
    assert claim.limit == pytest.approx(0.5 * 36.0 + 0.25)
    assert claim.time == pytest.approx(12.0, abs=0.01)


def test_every_shot_of_the_drone_is_judged_whatever_stands_before_it() -> None:
    mission = plain_mission()
    reached = (KeyframeTime("out", 0, 4.0), KeyframeTime("out", 1, 14.0))
    track = DroneTrajectory("cam1", lines(HOP), PHASES, reached, ())
    shots = (shot(*BOTH, drone="cam2", id="away"), shot(*BOTH))
    ir = TrajectoryIR(KeyframeIR(mission, shots), (track,), (), ())
    found = {c.constraint for c in course(JudgedFlight(mission, mission.drones[0], track), ir)}
    assert found == {ORDER, WAY, "detour between keyframes"}


@pytest.mark.parametrize(
    "met", [((0, 3.0), (1, 14.0)), ((0, 4.0), (1, 15.0)), ((0, 4.0),), ((0, 3.0), (1, 15.0))]
)
def test_keyframes_outside_of_the_shot_have_no_course(met: tuple[tuple[int, float], ...]) -> None:
    assert set(judged(shot(*BOTH), met=met)) == {ORDER}


@pytest.mark.parametrize("end", [0, 2])
def test_only_a_keyframe_with_a_time_of_its_own_frees_its_end(end: int) -> None:
    three = [keyframe(WEST), keyframe(MIDDLE, time=5.0), keyframe(EAST)]
    met = ((0, 4.0 + (end == 0)), (1, 9.0), (2, 14.0 - (end == 2)))
    assert judged(shot(*three), met=met)[ORDER].worst == pytest.approx(1.0)
    three[end] = three[end]._replace(time=1.0)
    assert judged(shot(*three), met=met)[ORDER].worst == 0.0


def test_one_placed_keyframe_makes_its_shot_one_of_placed_keyframes() -> None:
    assert WAY in judged(shot(GENERATED[0], BOTH[1]))
    assert WAY not in judged(shot(*GENERATED))


def along(*lengths: float) -> tuple[PlacedShot, tuple[tuple[int, float], ...], list[float]]:
    """A shot along the East with ways of given lengths, its keyframes met every second from 4 s on."""
    at = [0.0, *np.cumsum(lengths).tolist()]
    placed = shot(*(keyframe((x, 0.0, 10.0)) for x in at))
    return placed, tuple((k, 4.0 + k) for k in range(len(at))), at


@pytest.mark.parametrize(
    ("lengths", "which", "longest"),
    [((100.0, 4.0, 6.0, 4.0), 2, 6.0), ((4.0, 6.0, 4.0, 100.0), 0, 6.0), ((4.0, 6.0, 4.0, 100.0), 2, 100.0),
     ((100.0, 4.0, 6.0, 4.0), 1, 100.0), ((4.0, 6.0, 5.0), 1, 6.0)],
)  # fmt: skip
def test_a_way_swings_by_half_of_the_longest_of_itself_and_its_neighbours(
    lengths: tuple[float, ...], which: int, longest: float
) -> None:
    placed, met, at = along(*lengths)
    middle = 0.5 * (at[which] + at[which + 1])
    way = dict(HOP) | {4.0 + k: (x, 0.0, 10.0) for k, x in enumerate(at)}
    way[4.5 + which] = (middle, 60.0, 10.0)
    claim = judged(placed, way=tuple(sorted(way.items())), met=met)[WAY]
    assert claim.limit == pytest.approx(0.5 * longest + 0.25)
    assert (claim.worst, claim.time) == (pytest.approx(60.0, abs=0.01), pytest.approx(4.5 + which, abs=0.01))


def test_of_several_ways_the_one_that_uses_most_of_its_limit_is_told() -> None:
    """The long way is left by 40 of 50.25 m, the short one at the end by 7 of 3.25 m."""
    placed, met, at = along(100.0, 6.0, 6.0)
    way = dict(HOP) | {4.0 + k: (x, 0.0, 10.0) for k, x in enumerate(at)}
    way |= {4.5: (50.0, 40.0, 10.0), 6.5: (109.0, 7.0, 10.0)}
    claim = judged(placed, way=tuple(sorted(way.items())), met=met)[WAY]
    assert (claim.limit, claim.worst) == (pytest.approx(3.25), pytest.approx(7.0, abs=0.01))


def test_an_obstacle_on_a_way_explains_a_swing_and_none_beside_or_beyond_it() -> None:
    def limit(x: float) -> float:
        tree = Zone("tree", "out", Cylinder((x, 2.0), 1.0, 0.0, 12.0), ("world", "zones", "tree"))
        placed, met, at = along(20.0, 20.0)
        way = dict(HOP) | {4.0 + k: (x, 0.0, 10.0) for k, x in enumerate(at)} | {4.5: (10.0, 15.0, 10.0)}
        return judged(placed, way=tuple(sorted(way.items())), met=met, zones=(tree,))[WAY].limit

    assert limit(10.0) == pytest.approx(10.25 + 12.0 + 2 * BODY_M)
    assert limit(30.0) == limit(60.0) == pytest.approx(10.25)


@pytest.mark.parametrize("beyond", [15.0, -15.0])
def test_a_way_is_left_beyond_its_ends_too(beyond: float) -> None:
    x = 40.0 + beyond if beyond > 0 else beyond
    claim = judged(shot(*BOTH), way=through((9.0, (x, 0.0, 10.0))))[WAY]
    assert claim.worst == pytest.approx(15.0, abs=1e-3)


def test_where_nothing_is_free_there_is_no_detour() -> None:
    filmed = tuple(k._replace(target="mast") for k in GENERATED)
    low = clearance(9.0, "ground_clearance")
    found = judged(shot(*filmed), way=through((4.0, (0.0, 3.0, 10.0)), (3.9, WEST)), targets=(MAST,), **low)
    assert found[DETOUR].worst == 0.0
    assert ENDS not in found


def test_an_obstacle_beyond_a_generated_path_explains_nothing() -> None:
    tree = Zone("tree", "out", Cylinder((70.0, 0.0), 1.0, 0.0, 12.0), ("world", "zones", "tree"))
    told = (PathDeviation("out", 0.5, 0.0, "zone tree"),)
    assert judged(shot(*GENERATED), told=told, zones=(tree,))[PATH].limit == 0.25
