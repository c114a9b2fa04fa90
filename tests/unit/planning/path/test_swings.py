"""A camera that passes over what it films: the turn of the picture is told, and what avoids it."""

from __future__ import annotations

from math import pi

import pytest

from shotc.diag.model import Diagnostic
from shotc.geom.shapes import CylinderShape
from shotc.ir.target import Target
from tests.support.path_scenes import circle, framed, free, mission, shot, solve

LAMP = Target("lamp", (0.0, 0.0, 1.0), CylinderShape(0.5, 2.0), ("targets", "tower"))
MADE = mission(targets=(LAMP,))


def said(*keyframes) -> tuple[Diagnostic, ...]:
    outcome = solve(MADE, shot(keyframes))
    assert outcome.value is not None
    return outcome.diagnostics


def over(aside: float, height: float = 30.0) -> tuple[Diagnostic, ...]:
    return said(framed(0, (-20, aside, height), LAMP), framed(1, (20, aside, height), LAMP))


@pytest.mark.parametrize("aside", [0.0, 0.01, 0.5, 3.0])
def test_a_camera_that_passes_straight_over_its_target_is_told(aside: float):
    (warning,) = over(aside)
    assert warning.code == "Q009"
    assert "shot `s0` passes straight over target `lamp`" in warning.message
    assert "between keyframes 1 and 2" in warning.notes[0]
    turned = float(warning.message.split("turns by ")[1].split(" deg")[0])
    assert 100 < turned <= 200
    metres = float(warning.notes[0].split(" m along")[0])
    assert metres == pytest.approx(20.0, abs=1.0)


def test_where_the_camera_cannot_follow_the_error_is_told():
    (warning,) = over(0.0)
    assert "meanwhile the target is up to" in warning.notes[1]


def test_the_distance_it_proposes_is_enough():
    (warning,) = over(0.0)
    aside = float(warning.help.split("at least ")[1].split(" m")[0])
    assert over(aside + 0.1) == ()
    assert over(0.7 * aside) != ()


def test_turning_with_the_course_is_no_fault():
    assert said(*circle(LAMP, 9, 3.0, 30.0)) == ()


def test_going_back_the_same_way_is_no_fault():
    assert said(*(framed(i, (x, 4.0, 40.0), LAMP) for i, x in enumerate((2.0, 6.0, 2.0)))) == ()


def test_rising_over_it_is_no_fault():
    assert said(*(framed(i, (0.5, 0.0, z), LAMP) for i, z in enumerate((10.0, 40.0)))) == ()


def test_looking_down_without_a_target_is_no_fault():
    down = [free(0, (-20, 0, 30), pitch=-pi / 2), free(1, (20, 0, 30), pitch=-pi / 2, yaw=pi)]
    assert said(*down) == ()
