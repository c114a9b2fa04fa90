"""Who is in whose picture, held against code of its own: corner rays, cross products, a dense clock."""

from __future__ import annotations

from math import cos, pi, sin, tan

import numpy as np
import pytest
from hypothesis import event, given, settings
from hypothesis import strategies as st

from shotc.geom.framing import Cameras
from shotc.geom.sight import off_axis, outside
from shotc.passes.verify.claims import slack
from tests.support.few import examples
from tests.support.sight_plans import at, claims, film, mission, through, unfilmed

pytestmark = pytest.mark.slow

RADIUS = 0.5
LENGTH = 6.0
COARSE, DENSE = 2.0, 200.0  # Hz

PLACE = st.tuples(*[st.floats(-25, 25)] * 2, st.floats(2, 20))
POSE = st.tuples(PLACE, st.floats(-pi, pi), st.floats(-1.5, 0.5), st.floats(0.2, 2.0))


def normals(yaw: float, pitch: float, hfov: float, aspect: float) -> np.ndarray:
    """Return the inward unit normals of the frame's four edges and of the image plane, in W."""
    forward = np.array([cos(pitch) * cos(yaw), cos(pitch) * sin(yaw), sin(pitch)])
    right = np.array([sin(yaw), -cos(yaw), 0.0])
    up = np.cross(right, forward)
    wide = tan(hfov / 2)
    rays = [
        forward + u * wide * right + v * wide / aspect * up for u, v in ((-1, -1), (1, -1), (1, 1), (-1, 1))
    ]
    planes = [np.cross(rays[(i + 1) % 4], rays[i]) for i in range(4)]
    found = [plane / np.linalg.norm(plane) * np.sign(plane @ forward) for plane in planes]
    return np.array([*found, forward])


def metres_out(pose: np.ndarray, place: np.ndarray, aspect: float) -> float:
    yaw, pitch, hfov = pose[3], pose[4], pose[6]
    return float((-normals(yaw, pitch, hfov, aspect) @ (place - pose[:3])).max()) - RADIUS


def angle_off(pose: np.ndarray, place: np.ndarray) -> float:
    """Return the angle to the nearest point of the body, by the law of sines in the plane of both."""
    away = place - pose[:3]
    far = float(np.linalg.norm(away))
    if far <= RADIUS:
        return -pi / 2
    axis = normals(pose[3], pose[4], pose[6], 1.0)[4]
    to_centre = float(np.arccos(np.clip(away @ axis / far, -1.0, 1.0)))
    return to_centre - float(np.arctan2(RADIUS, np.sqrt(far**2 - RADIUS**2)))


def pose_of(drawn: tuple) -> np.ndarray:
    pose = at(*drawn[0])
    pose[3], pose[4], pose[6] = drawn[1:]
    return pose


@pytest.mark.long
@pytest.mark.timeout(240)
@settings(max_examples=examples(8, 20), deadline=None)
@given(
    st.lists(POSE, min_size=2, max_size=3),
    st.lists(PLACE, min_size=2, max_size=4),
    st.sampled_from([1.0, 16 / 9, 0.5]),
    st.sampled_from([None, 0.2, 0.7, pi / 2]),
    st.booleans(),
)
def test_the_claim_agrees_with_a_dense_check(poses, places, aspect, half_angle, lands) -> None:
    eye = through(list(np.linspace(0.0, LENGTH, len(poses))), [pose_of(p) for p in poses])
    until = 0.6 * LENGTH if lands else LENGTH
    bird = through(list(np.linspace(0.0, until, len(places))), [at(*p) for p in places])
    (found,) = claims(
        mission(rate=COARSE, aspect=aspect, half_angle=half_angle), film("eye", eye), unfilmed("bird", bird)
    )

    def out(t: np.ndarray) -> np.ndarray:
        pairs = zip(eye(t), bird(np.minimum(t, until))[:, :3], strict=True)
        return np.array(
            [metres_out(p, q, aspect) if half_angle is None else angle_off(p, q) for p, q in pairs]
        )

    t = np.arange(int(LENGTH * DENSE) + 1) / DENSE
    nearest = t[np.argsort(out(t))[:3]]
    finer = np.concatenate([np.linspace(x - 1 / DENSE, x + 1 / DENSE, 101) for x in nearest])
    least = float(out(np.clip(finer, 0.0, LENGTH)).min())
    event(f"{'holds' if found.holds else 'broken'}, {found.method}")
    near = 0.011 * abs(least - found.limit) + 1e-3  # the last for what the dense check misses
    assert found.worst == pytest.approx(least, abs=near)
    if abs(least - found.limit) > 2e-3:
        assert found.holds is (least >= found.limit)
    if found.holds:
        assert found.method == "bounded"
        assert found.worst <= least + 1e-9 + slack(found.limit)
    if not found.holds:
        (then,) = out(np.array([found.time]))
        assert found.worst - 1e-9 <= then == pytest.approx(found.worst, abs=near)  # a bound is told


@given(POSE, st.lists(PLACE, min_size=1, max_size=20), st.sampled_from([1.0, 16 / 9]))
def test_the_question_of_a_planner_is_answered_the_same(drawn, places, aspect) -> None:
    pose = pose_of(drawn)
    many = len(places)
    cameras = Cameras(np.tile(pose[:3], (many, 1)), *(np.full(many, pose[i]) for i in (3, 4, 6)), aspect)
    there = np.array(places)
    expected = [metres_out(pose, q, aspect) for q in there]
    clear = np.abs(expected) > 1e-9
    assert ((outside(cameras, there, RADIUS) < 0) == (np.array(expected) < 0))[clear].all()
    angles = np.array([angle_off(pose, q) for q in there])
    clear = np.abs(angles - 0.4) > 1e-9
    assert ((off_axis(cameras, there, RADIUS) < 0.4) == (angles < 0.4))[clear].all()
