"""That a shot with keyframes has their lens, and looks where they do: each limit on both sides."""

from __future__ import annotations

from math import cos, pi

import numpy as np
import pytest

from shotc.geom.bernstein import Piecewise
from shotc.ir.drone import LensRange
from shotc.ir.keyframes import PlacedKeyframe
from shotc.ir.path import CAM_PITCH, CAM_YAW, HFOV
from tests.support.plain_courses import AIM, BOTH, LENS, TURN, judged
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
    claim = judged(shot(*BOTH), curve=turned(HFOV, sign * off, time))[LENS]
    assert (claim.worst, claim.limit) == (pytest.approx(off), 1e-3)
    assert (claim.holds, claim.time) == (holds, time)


def test_a_zoom_that_nobody_asked_for_is_free() -> None:
    """The generated keyframe has the lens's own field of view, the placed one what its author chose."""
    own = plain_mission().drones[0].hfov
    zoom = LensRange(0.3, 1.4, 1.0)
    for placed, expected in ((False, 0.0), (True, abs(1.2 - own))):
        asked = tuple(keyframe(at, placed=placed, hfov=own) for at in (WEST, EAST))
        assert judged(shot(*asked), lens=zoom)[LENS].worst == pytest.approx(expected, abs=1e-9)
        assert judged(shot(*asked))[LENS].worst == pytest.approx(abs(1.2 - own), abs=1e-9)


@pytest.mark.parametrize("channel", [CAM_YAW, CAM_PITCH])
@pytest.mark.parametrize("turns", [0, 1, -2])
@pytest.mark.parametrize(("off", "holds"), [(0.199, True), (-0.199, True), (0.201, False), (-0.201, False)])
def test_a_camera_that_frames_nothing_looks_as_asked(
    channel: int, turns: int, off: float, holds: bool
) -> None:
    by = off + 2 * pi * turns * (channel == CAM_YAW)
    claim = judged(shot(*BOTH), curve=turned(channel, by))[AIM]
    assert claim.worst == pytest.approx(abs(off))
    assert (claim.limit, claim.holds, claim.time) == (0.2, holds, 14.0)
    framed = tuple(k._replace(reference=(0.0, 0.0)) for k in BOTH)
    assert judged(shot(*framed), curve=turned(channel, by))[AIM].worst == 0.0


def test_straight_down_the_heading_counts_less() -> None:
    steep = tuple(k._replace(pitch=-1.2) for k in BOTH)
    curve = turned(CAM_PITCH, -1.2)
    ctrl = curve.ctrl.copy()
    ctrl[..., CAM_PITCH] = -1.2
    ctrl[1, -1, CAM_YAW] = ctrl[2, 0, CAM_YAW] = 0.4
    claim = judged(shot(*steep), curve=Piecewise(curve.breaks, ctrl))[AIM]
    assert claim.worst == pytest.approx(0.4 * cos(1.2))


@pytest.mark.parametrize(
    ("by", "holds"), [(2.0 - 1.57, True), (2.0 - 1.58, False), (2.0 + 1.57, True), (2.0 + 1.58, False)]
)
def test_a_stated_turn_is_flown_to_a_quarter_of_a_turn(by: float, holds: bool) -> None:
    stated: tuple[PlacedKeyframe, ...] = (BOTH[0], BOTH[1]._replace(turn=2.0, yaw=by))
    claim = judged(shot(*stated), curve=turned(CAM_YAW, by))[TURN]
    assert claim.worst == pytest.approx(abs(by - 2.0))
    assert (claim.limit, claim.holds) == (pytest.approx(pi / 2), holds)
    assert judged(shot(*BOTH), curve=turned(CAM_YAW, by))[TURN].worst == 0.0
