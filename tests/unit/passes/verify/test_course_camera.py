"""That a shot with keyframes has their lens, and looks where they do: each limit on both sides."""

from __future__ import annotations

from math import cos, pi

import numpy as np
import pytest

from shotc.geom.bernstein import Piecewise
from shotc.ir.drone import LensRange
from shotc.ir.keyframes import PlacedKeyframe
from shotc.ir.mission import Ideal
from shotc.ir.path import BODY_YAW, CAM_PITCH, CAM_YAW, HFOV
from tests.support.plain_courses import AIM, BOTH, LENS, TURN, looked
from tests.support.plain_flights import EAST, HOP, WEST, lines, plain_mission
from tests.support.plain_flights import plain_keyframe as keyframe
from tests.support.plain_flights import plain_shot as shot


def turned(channel: int, by: float, time: float = 14.0) -> Piecewise:
    """The hop with another value of a channel at one of its times."""
    plain = lines(HOP)
    k = int(np.searchsorted(plain.breaks, time))
    ctrl = plain.ctrl.copy()
    ctrl[k - 1, -1, channel] += by
    ctrl[k, 0, channel] += by
    return Piecewise(plain.breaks, ctrl)


@pytest.mark.parametrize("time", [4.0, 14.0])
@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize(("off", "holds"), [(0.99e-3, True), (1.01e-3, False)])
def test_the_lens_is_that_of_the_keyframe(time: float, sign: float, off: float, holds: bool) -> None:
    claim = looked(shot(*BOTH), curve=turned(HFOV, sign * off, time))[LENS]
    assert (claim.worst, claim.limit) == (pytest.approx(off), 1e-3)
    assert (claim.holds, claim.time) == (holds, time)


def test_a_zoom_that_nobody_asked_for_is_free() -> None:
    """The generated keyframe has the lens's own field of view, the placed one what its author chose."""
    own = plain_mission().drones[0].hfov
    zoom = LensRange(0.3, 1.4, 1.0)
    for placed, expected in ((False, 0.0), (True, abs(1.2 - own))):
        asked = tuple(keyframe(at, placed=placed, hfov=own) for at in (WEST, EAST))
        assert looked(shot(*asked), lens=zoom)[LENS].worst == pytest.approx(expected, abs=1e-9)
        assert looked(shot(*asked))[LENS].worst == pytest.approx(abs(1.2 - own), abs=1e-9)


@pytest.mark.parametrize("channel", [CAM_YAW, CAM_PITCH])
@pytest.mark.parametrize("turns", [0, 1, -2])
@pytest.mark.parametrize(("off", "holds"), [(0.199, True), (-0.199, True), (0.201, False), (-0.201, False)])
def test_a_camera_that_frames_nothing_looks_as_asked(
    channel: int, turns: int, off: float, holds: bool
) -> None:
    by = off + 2 * pi * turns * (channel == CAM_YAW)
    claim = looked(shot(*BOTH), curve=turned(channel, by))[AIM]
    assert claim.worst == pytest.approx(abs(off))
    assert (claim.limit, claim.holds, claim.time) == (0.2, holds, 14.0)
    framed = tuple(k._replace(reference=(0.0, 0.0)) for k in BOTH)
    assert looked(shot(*framed), curve=turned(channel, by))[AIM].worst == 0.0


def test_straight_down_the_heading_counts_less() -> None:
    steep = tuple(k._replace(pitch=-1.2) for k in BOTH)
    curve = turned(CAM_PITCH, -1.2)
    ctrl = curve.ctrl.copy()
    ctrl[..., CAM_PITCH] = -1.2
    ctrl[1, -1, CAM_YAW] = ctrl[2, 0, CAM_YAW] = 0.4
    claim = looked(shot(*steep), curve=Piecewise(curve.breaks, ctrl))[AIM]
    assert claim.worst == pytest.approx(0.4 * cos(1.2))


@pytest.mark.parametrize(
    ("by", "holds"), [(2.0 - 1.57, True), (2.0 - 1.58, False), (2.0 + 1.57, True), (2.0 + 1.58, False)]
)
def test_a_stated_turn_is_flown_to_a_quarter_of_a_turn(by: float, holds: bool) -> None:
    stated: tuple[PlacedKeyframe, ...] = (BOTH[0], BOTH[1]._replace(turn=2.0, yaw=by))
    claim = looked(shot(*stated), curve=turned(CAM_YAW, by))[TURN]
    assert claim.worst == pytest.approx(abs(by - 2.0))
    assert (claim.limit, claim.holds) == (pytest.approx(pi / 2), holds)
    assert looked(shot(*BOTH), curve=turned(CAM_YAW, by))[TURN].worst == 0.0


BETWEEN, LENS_BETWEEN, LENS_OF_SHOT = (
    "direction between keyframes",
    "lens between keyframes",
    "lens off its shot",
)
OFF_AIM, OFF_CAMERA = "direction off its aim", "body off its camera"
MIDDLE = (20.0, 0.0, 10.0)
HALF_WAY = tuple(sorted({*HOP, (9.0, MIDDLE)}))


def swung(channel: int, by: float) -> Piecewise:
    """The hop with another value of a channel in the middle between its keyframes."""
    plain = lines(HALF_WAY)
    k = int(np.searchsorted(plain.breaks, 9.0))
    ctrl = plain.ctrl.copy()
    ctrl[k - 1, -1, channel] += by
    ctrl[k, 0, channel] += by
    return Piecewise(plain.breaks, ctrl)


@pytest.mark.parametrize(("channel", "name", "most"), [
    (CAM_YAW, BETWEEN, 0.5), (CAM_PITCH, BETWEEN, 0.5), (HFOV, LENS_BETWEEN, 1e-3),
])  # fmt: skip
@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize(("share", "holds"), [(0.99, True), (1.01, False)])
def test_between_keyframes_the_camera_stays_between_their_angles(
    channel: int, name: str, most: float, sign: float, share: float, holds: bool
) -> None:
    found = looked(shot(*BOTH), curve=swung(channel, sign * share * most))
    assert (found[name].worst, found[name].limit) == (pytest.approx(share * most, rel=1e-3), most)
    assert (found[name].holds, found[name].hard, found[name].time) == (holds, True, 9.0)
    assert found[AIM].worst == found[LENS].worst == 0.0


def test_a_camera_may_turn_and_zoom_from_one_keyframe_to_the_next() -> None:
    to = BOTH[1]._replace(yaw=1.0, pitch=-0.5, hfov=0.8)
    curve = lines(HALF_WAY)
    ctrl = curve.ctrl.copy()
    k = int(np.searchsorted(curve.breaks, 9.0))
    for channel, end in ((CAM_YAW, 1.0), (CAM_PITCH, -0.5), (HFOV, 0.8 - 1.2)):
        ctrl[k - 1, -1, channel] += 0.5 * end
        ctrl[k, 0, channel] += 0.5 * end
        ctrl[k, -1, channel] += end
        ctrl[k + 1, 0, channel] += end
    found = looked(shot(BOTH[0], to), curve=Piecewise(curve.breaks, ctrl))
    assert [found[name].worst for name in (BETWEEN, LENS_BETWEEN)] == [0.0, 0.0]


@pytest.mark.parametrize(("beyond", "holds"), [(0.749, True), (0.751, False)])
def test_a_camera_may_swing_by_a_quarter_of_its_turn_beyond_it(beyond: float, holds: bool) -> None:
    """It turns by 1 rad, so 0.25 rad count beside the 0.5 rad of a camera that does not turn."""
    curve = lines(HALF_WAY)
    ctrl = curve.ctrl.copy()
    k = int(np.searchsorted(curve.breaks, 9.0))
    ctrl[k - 1, -1, CAM_YAW] = ctrl[k, 0, CAM_YAW] = 1.0 + beyond
    ctrl[k, -1, CAM_YAW] = ctrl[k + 1, 0, CAM_YAW] = 1.0
    claim = looked(shot(BOTH[0], BOTH[1]._replace(yaw=1.0)), curve=Piecewise(curve.breaks, ctrl))[BETWEEN]
    assert (claim.worst, claim.limit) == (pytest.approx(beyond, rel=1e-3), pytest.approx(0.75))
    assert claim.holds is holds


def test_a_camera_that_follows_a_target_up_to_the_middle_of_a_way_turns_as_it_does() -> None:
    framed = tuple(k._replace(target="mast", reference=(0.0, 0.0)) for k in BOTH)
    for ends in (framed, (framed[0], framed[1]._replace(target="tower")), (framed[0], BOTH[1])):
        assert BETWEEN not in looked(shot(*ends), curve=swung(CAM_YAW, 1.0))


@pytest.mark.parametrize(("off", "holds"), [(0.99e-3, True), (1.01e-3, False)])
def test_a_body_that_turns_with_its_camera_is_held_to_it(off: float, holds: bool) -> None:
    for turns in (0, 2):
        curve = lines(HALF_WAY)
        ctrl = curve.ctrl.copy()
        ctrl[:, :, BODY_YAW] += 2 * pi * turns
        ctrl[int(np.searchsorted(curve.breaks, 9.0)) - 1, -1, BODY_YAW] += off
        claim = looked(shot(*BOTH), curve=Piecewise(curve.breaks, ctrl), body="follow-camera")[OFF_CAMERA]
        assert (claim.worst, claim.holds, claim.hard) == (pytest.approx(off, rel=1e-3), holds, True)
    assert OFF_CAMERA not in looked(shot(*BOTH))


@pytest.mark.parametrize(("off", "holds"), [(0.199, True), (0.201, False)])
@pytest.mark.parametrize("turns", [0, 1])
def test_an_aim_that_is_given_is_kept_for_the_whole_shot(off: float, holds: bool, turns: int) -> None:
    standing = Ideal("world", None, ((0.0, WEST), (1.0, WEST)), placed=True, aim=(2 * pi * turns, 0.0))
    found = looked(shot(ideal=standing), curve=swung(CAM_YAW, off))
    assert (found[OFF_AIM].worst, found[OFF_AIM].holds) == (pytest.approx(off, rel=1e-3), holds)
    free = looked(shot(ideal=standing._replace(aim=None)), curve=swung(CAM_YAW, off))
    assert set(free) == {LENS_OF_SHOT}


def test_the_lens_of_a_shot_on_its_own_clock_is_the_drones() -> None:
    own = plain_mission().drones[0].hfov
    following = shot(ideal=Ideal("world", None, ((0.0, WEST), (1.0, EAST))))
    for off, holds in ((0.99e-3, True), (1.01e-3, False)):
        plain = lines(HOP)
        ctrl = plain.ctrl.copy()
        ctrl[:, :, HFOV] = own - off
        claim = looked(following, curve=Piecewise(plain.breaks, ctrl))[LENS_OF_SHOT]
        assert (claim.worst, claim.holds, claim.limit) == (pytest.approx(off), holds, 1e-3)


def test_keyframes_outside_of_their_shot_have_no_picture() -> None:
    assert looked(shot(*BOTH), met=((0, 3.0), (1, 14.0))) == {}
    assert looked(shot(*BOTH), met=((0, 4.0), (7, 14.0))) == {}
