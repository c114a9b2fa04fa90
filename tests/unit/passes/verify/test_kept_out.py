"""What keeps a drone out of a picture: the angle to turn by, and where the drone may go."""

from __future__ import annotations

import re
from math import ceil, degrees, radians

import numpy as np
import pytest

from shotc.ir.mission import MissionIR
from shotc.ir.phases import Phase
from shotc.ir.trajectory import Claim, DroneTrajectory
from shotc.passes.verify.kept_out import kept_out
from shotc.passes.verify.sight import CameraAndBody
from tests.support.records import replace
from tests.support.sight_plans import EYE, at, claims, film, mission, still, through

WIDE_DEG = 45.0
"""Half the field of view; the camera looks East."""


def given_headings(of: MissionIR, count: int = 1, *, follows: bool = False) -> MissionIR:
    """The mission whose filming shot has keyframes with given headings, or one that looks at a target."""
    aims = [None if follows and k == count - 1 else (0.0, 0.0) for k in range(count)]
    keyframes = tuple(replace(of.shots[0].keyframes[0], aim=aim) for aim in aims)
    return replace(of, shots=(replace(of.shots[0], keyframes=keyframes), of.shots[1]))


def advice(other: DroneTrajectory, *, of: MissionIR | None = None) -> list[str]:
    asked = given_headings(mission()) if of is None else of
    tracks = film("eye", still(EYE)), other
    broken: Claim = next(c for c in claims(asked, *tracks) if c.subject == "eye")
    assert not broken.holds
    return list(kept_out(CameraAndBody(asked, *tracks), broken, tracks[0].phases[0]))


def beside(bearing_deg: float, far: float = 20.0) -> DroneTrajectory:
    """A drone that stands in a direction, counter-clockwise from the East, and films nothing."""
    x, y = far * np.cos(radians(bearing_deg)), far * np.sin(radians(bearing_deg))
    return DroneTrajectory("bird", still(at(x, y, 10.0)), (), (), ())


@pytest.mark.parametrize("bearing", [-44.0, -20.3, -5.0, 5.0, 20.3, 44.0])
@pytest.mark.parametrize("far", [8.0, 20.0])
def test_a_camera_is_turned_half_a_degree_beyond_the_edge_of_the_body(bearing: float, far: float) -> None:
    """What stands to the left leaves the picture when the camera turns right, and the radius counts."""
    least = WIDE_DEG + degrees(np.arcsin(0.5 / far)) - abs(bearing)
    by = ceil(least + 0.5)
    heading = 90 + by if bearing > 0 else 90 - by
    where = "right" if bearing > 0 else "left"
    text = f"turn the camera of `eyes` {by} deg to the {where}, by `heading: {heading % 360} deg`"
    assert text in advice(beside(bearing, far))


def test_of_two_keyframes_no_heading_is_named_and_without_headings_no_turn() -> None:
    two = advice(beside(20.0), of=given_headings(mission(), 2))
    assert "turn the camera of `eyes` 27 deg to the right" in two
    for of in (given_headings(mission(), 1, follows=True), given_headings(mission(), 2, follows=True)):
        assert not any("turn the camera" in text for text in advice(beside(20.0), of=of))


def test_no_turn_is_named_for_a_body_about_the_camera() -> None:
    near = DroneTrajectory("bird", still(at(0.3, 0.0, 10.0)), (), (), ())
    assert not any("turn the camera" in text for text in advice(near))


def test_within_a_cone_the_angle_of_the_cone_counts() -> None:
    of = given_headings(mission(half_angle=radians(30.0)))
    by = ceil(30.0 + degrees(np.arcsin(0.5 / 20.0)) - 10.0 + 0.5)
    found = advice(beside(10.0), of=of)
    assert f"turn the camera of `eyes` {by} deg to the right, by `heading: {90 + by} deg`" in found
    # Off the axis of the cone, to the right: 20 m away, at a bearing of 10 deg from the axis.
    x, y = 20.0 * np.cos(radians(10.0)), 20.0 * np.sin(radians(10.0))
    farther = (x + 0.5 / np.sin(radians(30.0))) * np.tan(radians(30.0)) - y
    said = re.fullmatch(r"film from where `bird` is ([\d.]+) m farther to the left in the picture", found[-1])
    assert said is not None
    assert 0.0 <= float(said[1]) - farther < 0.3


def test_a_drone_whose_pad_is_seen_moves_its_home() -> None:
    found = advice(beside(10.0))
    assert found[0] == "move the home of `bird` out of the picture"
    assert re.fullmatch(
        r"film from where `bird` is [\d.]+ m (higher|farther to the left) in the picture", found[-1]
    )


def test_a_drone_that_waits_and_rises_in_the_picture_moves_its_home() -> None:
    """It was only told to be higher in the picture, which a pad cannot be."""
    pad, over = at(20.0, 3.0, 10.0), at(20.0, 3.0, 12.0)
    rises = through([0.0, 6.0, 10.0], [pad, pad, over])
    found = advice(DroneTrajectory("bird", rises, (), (Phase("takeoff", None, 0.0, 10.0),), ()))
    assert found[0] == "move the home of `bird` out of the picture"


@pytest.mark.parametrize("first", ["eye", "bird"])
def test_a_drone_that_comes_from_elsewhere_is_put_off(first: str) -> None:
    """The later one of the two waits: for the other's shot, or for its landing."""
    away, there = at(-20.0, 0.0, 10.0), at(20.0, 5.0, 10.0)
    curve = through([0.0, 4.0, 6.0, 10.0], [away, there, there, away])
    phases = (
        Phase("transit", None, 0.0, 4.0),
        Phase("shot", "birds", 4.0, 6.0),
        Phase("return", None, 6.0, 10.0),
    )
    bird = DroneTrajectory("bird", curve, phases, (), ())
    start, end = (2.0, 10.0) if first == "eye" else (5.0, 10.0)
    of = given_headings(mission())
    eye = film("eye", still(EYE), (start, end))
    (broken,) = (c for c in claims(of, eye, bird) if c.subject == "eye")
    shown = next(p for p in eye.phases if p.shot)
    found = next(kept_out(CameraAndBody(of, eye, bird), broken, shown))
    moved = "start shot `birds` after `eyes`" if first == "eye" else "start shot `eyes` after `birds`"
    assert found.startswith(moved)


@pytest.mark.parametrize("yaw", [0.7, 3.0, -2.5])
def test_the_turn_counts_from_where_the_camera_is_and_looks(yaw: float) -> None:
    eye = EYE.copy()
    eye[:2], eye[3] = (30.0, -50.0), yaw
    x, y = 30.0 + 20.0 * np.cos(yaw + 0.3), -50.0 + 20.0 * np.sin(yaw + 0.3)
    bird = DroneTrajectory("bird", still(at(x, y, 10.0)), (), (), ())
    of, tracks = given_headings(mission()), (film("eye", still(eye)), bird)
    broken = next(c for c in claims(of, *tracks) if c.subject == "eye")
    found = list(kept_out(CameraAndBody(of, *tracks), broken, tracks[0].phases[0]))
    by = ceil(WIDE_DEG + degrees(np.arcsin(0.5 / 20.0)) - degrees(0.3) + 0.5)
    heading = round(90.0 - degrees(yaw) + by) % 360
    assert f"turn the camera of `eyes` {by} deg to the right, by `heading: {heading} deg`" in found


@pytest.mark.parametrize(("first", "last"), [(10.0, -20.0), (-10.0, 20.0), (25.0, 5.0)])
def test_the_turn_is_enough_for_all_of_the_shot(first: float, last: float) -> None:
    ends = [at(20.0 * np.cos(radians(b)), 20.0 * np.sin(radians(b)), 10.0) for b in (first, last)]
    moves = through([0.0, 10.0], ends)
    x, y = moves(np.linspace(0.0, 10.0, 501))[:, :2].T
    edge = WIDE_DEG + np.degrees(np.arcsin(0.5 / np.hypot(x, y)))
    off = np.degrees(np.arctan2(y, x))
    by = {"right": float((edge - off).max()), "left": float((edge + off).max())}
    where = min(by, key=lambda side: by[side])
    found = advice(DroneTrajectory("bird", moves, (), (), ()))
    assert any(
        f"turn the camera of `eyes` {ceil(by[where] + 0.5)} deg to the {where}" in text for text in found
    )


def test_a_body_that_is_about_the_camera_once_has_no_turn() -> None:
    moves = through([0.0, 5.0, 10.0], [at(20.0, 3.0, 10.0), at(0.2, 0.2, 10.0), at(20.0, -3.0, 10.0)])
    found = advice(DroneTrajectory("bird", moves, (), (), ()))
    assert not any("turn the camera" in text for text in found)


@pytest.mark.parametrize(("until", "moved"), [(radians(80.0), True), (radians(20.0), False)])
def test_a_pad_that_is_seen_at_any_time_is_moved(until: float, moved: bool) -> None:
    """The camera turns to the left, perhaps to the other drone's pad; that one flies ahead of it."""
    turns = EYE.copy()
    turns[3] = until
    eye = film("eye", through([0.0, 10.0], [EYE, turns]))
    pad, ahead = at(0.0, 30.0, 10.0), at(20.0, 0.0, 10.0)
    bird = DroneTrajectory("bird", through([0.0, 1.0, 9.0, 10.0], [pad, ahead, ahead, pad]), (), (), ())
    of = given_headings(mission())
    broken = next(c for c in claims(of, eye, bird) if c.subject == "eye")
    found = list(kept_out(CameraAndBody(of, eye, bird), broken, eye.phases[0]))
    assert (found[0] == "move the home of `bird` out of the picture") == moved
