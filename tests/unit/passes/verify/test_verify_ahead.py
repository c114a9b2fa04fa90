"""Whether drones look where they fly: of which spans and shots it is claimed, and why not of others."""

from __future__ import annotations

from math import pi, radians

import numpy as np
import pytest

from shotc.geom.bernstein import quintic_hermite
from shotc.geom.vec import wrapped
from shotc.ir.path import BODY_YAW, X, Y
from shotc.ir.phases import Phase
from shotc.ir.rules import SLOW_M_S
from shotc.ir.transits import transit_intervals
from shotc.passes.verify.ahead import ahead, judged, unjudged
from shotc.passes.verify.claims import JudgedFlight
from tests.support.records import replace
from tests.support.tampered_plans import MISSION, PLAN

TRACK = PLAN.drones[0]
FREE_BODY = "free"


def flight(half_angle_deg: float | None, body: str = "follow-camera", pan_deg: float = 135.0, **shot):
    """The half orbit about a tower, which the camera films at a right angle to the course."""
    drone = MISSION.drones[0]
    gimbal = replace(drone.gimbal, yaw=(-radians(pan_deg), radians(pan_deg)))
    rules = replace(MISSION.rules, look_ahead=None if half_angle_deg is None else radians(half_angle_deg))
    mission = replace(
        MISSION,
        rules=rules,
        drones=(replace(drone, body=body, gimbal=gimbal),),
        shots=(replace(MISSION.shots[0], **shot),),
    )
    return JudgedFlight(mission, mission.drones[0], TRACK)


def claimed(one: JudgedFlight) -> dict[str | None, float]:
    return {claim.shot: claim.worst for claim in ahead(one)}


def reasons(one: JudgedFlight) -> list[str]:
    return [found.why for found in unjudged(one.mission, [one.track])]


def sampled(start: float, end: float) -> float:
    """The largest angle between heading and course at samples at which the drone moves."""
    t = np.linspace(start, end, 4001)
    rate = TRACK.curve.channels(X, Y).derivative()(t)
    off = np.abs(wrapped(TRACK.curve(t)[:, BODY_YAW] - np.arctan2(rate[:, 1], rate[:, 0])))
    return float(off[np.linalg.norm(rate, axis=1) > SLOW_M_S].max())


def test_where_no_rule_asks_it_nothing_is_claimed() -> None:
    assert claimed(flight(None)) == {}


def test_a_body_that_turns_with_its_camera_is_judged_on_ways_alone() -> None:
    one = flight(30.0)
    worst = max(sampled(8.0, 22.0), sampled(52.0, 112.0))
    assert claimed(one) == {None: pytest.approx(worst, abs=2e-3)}
    assert reasons(one) == ["its body turns with its camera"]


@pytest.mark.parametrize(
    ("half_angle", "pan", "bound"),
    [
        (30.0, 135.0, None),  # the gimbal reaches aside: the body is free
        (30.0, 60.0, 30.0),  # it leaves the nose 30 deg off
        (30.0, 64.0, None),  # 26 deg, which leaves room within 30
        (30.0, 62.0, 28.0),  # 28 deg leaves too little
        (35.0, 60.0, None),
    ],
)
def test_a_body_is_judged_where_its_gimbal_leaves_it_room(half_angle: float, pan: float, bound) -> None:
    one = flight(half_angle, FREE_BODY, pan)
    if bound is None:
        assert reasons(one) == []
        assert claimed(one)["half"] == pytest.approx(sampled(22.0, 52.0), abs=2e-3)
    else:
        assert list(claimed(one)) == [None]
        (why,) = reasons(one)
        assert (
            f"leaves the nose {bound + 0.0:.0f} deg" in why or f"leaves the nose {bound + 1.0:.0f} deg" in why
        )


def test_a_shot_of_what_moves_says_why_its_heading_is_bound() -> None:
    assert reasons(flight(30.0, FREE_BODY, ideal=object())) == ["its place follows what it films"]


def test_a_camera_that_looks_along_its_path_is_judged_whatever_its_body() -> None:
    keyframes = tuple(
        replace(k, target=None, composition=None, aim=(0.0, 0.0)) for k in MISSION.shots[0].keyframes
    )
    one = flight(30.0, keyframes=keyframes)
    assert reasons(one) == []
    assert set(claimed(one)) == {None, "half"}
    told = tuple(replace(k, heading=0.3) for k in keyframes)
    assert reasons(flight(30.0, keyframes=told)) == ["its body turns with its camera"]


def moving(rest: list[float]) -> JudgedFlight:
    """A flight east that rests at some whole times of 0 to 16 s, and films from 6 to 10 s."""
    t = np.arange(0.0, 17.0, 1.0)
    value, rate = np.zeros((17, 7)), np.zeros((17, 7))
    value[:, X], rate[:, X] = 2.0 * t, 2.0
    rate[[int(r) for r in rest], X] = 0.0
    phases = (
        Phase("transit", None, 0.0, 6.0),
        Phase("shot", "half", 6.0, 10.0),
        Phase("return", None, 10.0, 16.0),
    )
    track = replace(TRACK, curve=quintic_hermite(t, value, rate, np.zeros((17, 7))), phases=phases)
    return replace(flight(30.0), track=track)


@pytest.mark.parametrize(
    ("rest", "on_clock", "spans"),
    [
        ([0, 3, 13, 16], False, [(0.0, 6.0), (10.0, 16.0)]),
        ([0, 3, 13, 16], True, [(0.0, 3.0), (13.0, 16.0)]),  # from and to where it rests
        ([0, 2, 5, 11, 14, 16], True, [(0.0, 5.0), (11.0, 16.0)]),
        ([0, 16], True, [None, None]),  # nothing is left between its rests
        ([], True, [None, None]),
        ([], False, [(0.0, 6.0), (10.0, 16.0)]),
    ],
)
def test_beside_a_shot_of_what_moves_a_way_is_judged_between_rests(rest, on_clock: bool, spans) -> None:
    one = moving(rest)
    if on_clock:
        shots = (replace(one.mission.shots[0], ideal=object()),)
        one = replace(one, mission=replace(one.mission, shots=shots))
    assert [judged(one, way) for way in transit_intervals(one.track.phases)] == spans


def test_where_it_hardly_moves_it_has_no_course() -> None:
    one = moving([0, 16])
    still = replace(one.track, curve=quintic_hermite(np.array([0.0, 16.0]), *np.zeros((3, 2, 7))))
    assert claimed(replace(one, track=still)) == {}
    assert reasons(replace(one, track=still)) == []
    aside = moving([0, 16])
    assert max(claimed(aside).values()) == pytest.approx(0.0, abs=1e-6)
    assert pi > max(claimed(flight(30.0)).values()) > 0.0
