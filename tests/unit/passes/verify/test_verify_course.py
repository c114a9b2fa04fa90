"""How a shot is flown as its kind asks: where nothing explains that a keyframe is missed, and the course."""

from __future__ import annotations

from collections.abc import Iterable
from math import pi

import numpy as np
import pytest

from shotc.geom.bernstein import quintic_hermite
from shotc.geom.solids import Cylinder
from shotc.ir.mission import MissionIR, Zone
from shotc.ir.path import CAM_YAW, HFOV, X, Y
from shotc.ir.phases import Phase
from shotc.ir.trajectory import Claim
from shotc.passes.verify.claims import JudgedFlight, Limit
from shotc.passes.verify.course import SWING_SHARE, UNREPORTED_M, _along, _is_free, _swing
from shotc.passes.verify.explained import NEAR_M
from shotc.passes.verify.looking import BESIDE_S, _off_course
from shotc.passes.verify.shots import PLACE_TOLERANCE, _still
from tests.support.mesh_spaces import made_of
from tests.support.records import replace
from tests.support.scenes import house
from tests.support.tampered_plans import MISSION, PLAN

KEYFRAME = PLAN.keyframes.shots[0].keyframes[0]
BODY = MISSION.drones[0].radius + NEAR_M


def free(at: tuple[float, float, float], mission: MissionIR) -> bool:
    flight = JudgedFlight(mission, mission.drones[0], PLAN.drones[0])
    return _is_free(flight, replace(KEYFRAME, at=at))


def with_zone(keep: str) -> MissionIR:
    mast = Zone("mast", keep, Cylinder((0.0, 0.0), 10.0, 0.0, 90.0), ("world", "zones", "mast"))  # type: ignore[arg-type]
    return replace(MISSION, zones=(mast,), targets=())


@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_a_keyframe_near_what_it_keeps_clear_of_is_not_free(side: float) -> None:
    aside = side * 0.01
    assert free((10.0 + BODY + aside, 0.0, 30.0), with_zone("out")) is (side > 0)
    assert free((10.0 - BODY - aside, 0.0, 30.0), with_zone("in")) is (side > 0)
    bare = replace(MISSION, zones=(), targets=())
    assert free((0.0, 0.0, bare.rules.ground_clearance + BODY + aside), bare) is (side > 0)
    (tower,) = MISSION.targets
    beside = replace(MISSION, zones=())
    away = tower.kept_clear.radius + MISSION.rules.target_clearance + BODY + aside
    assert free((away, 0.0, 12.0), beside) is (side > 0)


@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_a_keyframe_near_a_building_is_not_free(side: float) -> None:
    bare = replace(MISSION, zones=(), targets=(), meshes=(made_of(house(8.0, 8.0, 30.0, 30.0)),))
    away = bare.rules.beside_obstacle(MISSION.drones[0].radius) + NEAR_M + side * 0.01
    assert free((4.0 + away, 0.0, 20.0), bare) is (side > 0)


def flown(t: np.ndarray, rate: np.ndarray, look: float) -> JudgedFlight:
    """A flight with these velocities, (M, 2), at times, whose camera looks one way, rad."""
    value, first = np.zeros((len(t), 7)), np.zeros((len(t), 7))
    first[:, [X, Y]] = rate
    value[1:, [X, Y]] = np.cumsum(0.5 * (rate[1:] + rate[:-1]) * np.diff(t)[:, None], axis=0)
    value[:, CAM_YAW] = look
    curve = quintic_hermite(t, value, first, np.zeros_like(first))
    return JudgedFlight(MISSION, MISSION.drones[0], replace(PLAN.drones[0], curve=curve))


T = np.arange(0.0, 11.0)
EAST = np.tile([2.0, 0.0], (11, 1))


@pytest.mark.parametrize(
    ("off", "look", "beyond"),
    [
        (0.9, 0.5, 0.2),  # 0.5 rad off the course, 0.3 allowed
        (0.9, -0.5, 0.2),
        (-0.4, 0.5, 0.1),  # nearer to the heading of its keyframe
        (0.9, 0.2, 0.0),
        (0.1, 2.0, 0.0),
        (2.0, 2 * pi + 0.5, 0.2),  # by whole turns
    ],
)
def test_a_camera_along_its_path_is_off_by_the_nearer_of_heading_and_course(off, look, beyond) -> None:
    at = np.array([0.0, 5.0, 10.0])
    found = _off_course(flown(T, EAST, look), (np.full(3, off), at), 0.3, (0.0, 10.0))
    assert found == pytest.approx([beyond] * 3)


def test_where_it_rests_the_course_is_from_a_little_before_to_a_little_after() -> None:
    # East until t = 5, where it rests, then north: the course there is north-east.
    rate = np.where((T < 5)[:, None], [2.0, 0.0], [0.0, 2.0])
    rate[5] = 0.0
    found = _off_course(
        flown(T, rate, pi / 4), (np.full(3, 2.0), np.array([2.0, 5.0, 8.0])), 0.1, (0.0, 10.0)
    )
    assert found == pytest.approx([pi / 4 - 0.1, 0.0, pi / 4 - 0.1], abs=1e-6)


def test_only_the_shot_itself_has_a_course() -> None:
    # It turns north at t = 5, where the shot ends: the course at its end is that of before.
    rate = np.where((T <= 5)[:, None], [2.0, 0.0], [0.0, 2.0])
    one = flown(T, rate, 0.0)
    within = _off_course(one, (np.full(1, 2.0), np.array([5.0])), 0.0, (0.0, 5.0))
    beyond = _off_course(one, (np.full(1, 2.0), np.array([5.0])), 0.0, (0.0, 10.0))
    assert within == pytest.approx([0.0], abs=1e-6)
    assert beyond[0] > 0.05
    assert BESIDE_S < 1.0


def claims(found: Iterable[Claim]) -> dict[str, Claim]:
    return {claim.constraint: claim for claim in found}


def test_a_free_keyframe_may_be_missed_by_a_share_of_its_distance_from_what_it_films() -> None:
    first, *others = (replace(k, placed=False) for k in PLAN.keyframes.shots[0].keyframes)
    x, y, z = first.at
    keyframes = (replace(first, at=(x, y, z + 0.2)), *others)
    flight = JudgedFlight(MISSION, MISSION.drones[0], PLAN.drones[0])
    t = np.array([k.time for k in PLAN.drones[0].keyframes])
    placed = replace(PLAN.keyframes.shots[0], keyframes=keyframes)
    found = claims(_along(flight, placed, t, PLAN))["detour where it is free"]
    (tower,) = MISSION.targets
    far = np.linalg.norm(np.array([x, y, z + 0.2]) - tower.centre)
    assert found.worst == pytest.approx(0.2 / far, rel=0.01)
    assert found.holds


def test_the_way_that_swings_most_for_its_length_is_told() -> None:
    t = np.array([0.0, 50.0, 55.0, 60.0])
    x = np.array([0.0, 100.0, 110.0, 120.0])
    keyframes = tuple(replace(KEYFRAME, at=(a, 300.0, 40.0), placed=True, hold=0.0, time=None) for a in x)
    placed = replace(PLAN.keyframes.shots[0], keyframes=keyframes)
    value, first = np.zeros((4, 7)), np.zeros((4, 7))
    value[:, :3] = [k.at for k in keyframes]
    first[:, 0], first[-1, 1] = 2.0, 20.0  # it leaves the last chord to the side
    curve = quintic_hermite(t, value, first, np.zeros((4, 7)))
    bare = replace(MISSION, zones=(), targets=())
    flight = JudgedFlight(bare, bare.drones[0], replace(PLAN.drones[0], curve=curve))
    found = claims(_swing(flight, placed, t))["way between keyframes"]
    assert not found.holds
    assert t[2] < found.time < t[3]
    assert found.limit == pytest.approx(SWING_SHARE * 10.0 + UNREPORTED_M)


@pytest.mark.parametrize(("channel", "drifts"), [(Y, True), (CAM_YAW, True), (HFOV, True), (None, False)])
def test_a_camera_that_rests_at_a_keyframe_neither_moves_nor_turns_nor_zooms(
    channel: int | None, drifts: bool
) -> None:
    value = np.tile(PLAN.drones[0].curve(30.0), (2, 1))
    if channel is not None:
        value[1, channel] += 0.1
    curve = quintic_hermite(np.array([30.0, 32.0]), value, np.zeros((2, 7)), np.zeros((2, 7)))
    flight = JudgedFlight(MISSION, MISSION.drones[0], replace(PLAN.drones[0], curve=curve))
    phase = Phase("shot", PLAN.keyframes.shots[0].shot.id, 20.0, 40.0)
    limit = Limit("drift at keyframe 1", PLACE_TOLERANCE, "m", KEYFRAME.path)
    found = _still(flight, limit, (30.0, 32.0), PLAN.keyframes.shots[0].shot, phase)
    assert found.holds is not drifts
    assert found.worst == pytest.approx(0.1 if drifts else 0.0, abs=1e-6)
