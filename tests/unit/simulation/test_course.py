"""The course of a target that a shot turns with: taken over seconds, not from one moment."""

from __future__ import annotations

from math import cos, exp, sin
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from shotc.geom.bernstein import Array
from shotc.ir.phases import Phase
from shotc.simulation.guidance import COURSE_S, PERIOD_S, Guidance
from shotc.simulation.kalman import Estimate
from shotc.simulation.situations import Chased

SHOT = Chased(Phase("shot", 0.0, 60.0, "side"), "walker", turns=True)


class Taken:
    """Takes the course of a target whose track leads East, replan by replan."""

    def __init__(self) -> None:
        track = SimpleNamespace(heading=lambda time: 0.0)
        mission = SimpleNamespace(target=lambda name: SimpleNamespace(track=track))
        world = SimpleNamespace(mission=mission)
        self.of = SimpleNamespace(world=world, _course=np.zeros(1))

    def after(self, speed: float, course: float) -> float:
        mean = np.zeros((1, 9))
        mean[0, 3:5] = speed * cos(course), speed * sin(course)
        known = {"walker": Estimate(0.0, mean, np.zeros((1, 9, 9)))}
        turn: Array = Guidance._turn(cast("Any", self.of), SHOT, 0.0, known)
        return float(turn[0])


def test_who_weaves_does_not_turn_a_shot_and_who_turns_does() -> None:
    weaving = Taken()
    found = [weaving.after(1.3, 0.2 * (-1) ** k) for k in range(40)]
    assert max(map(abs, found)) < 0.04
    turning = Taken()
    found = [turning.after(1.3, 1.5) for _ in range(round(3 * COURSE_S / PERIOD_S))]
    assert found[-1] == pytest.approx(1.5 * (1.0 - exp(-3.0)))
    assert (np.diff(found) > 0.0).all()


def test_half_a_turn_is_made_the_shorter_way_and_who_stands_keeps_his_course() -> None:
    taken = Taken()
    for _ in range(200):
        taken.after(1.3, 3.0)
    on = taken.after(1.3, -3.0)  # a step of 0.28 rad beyond pi, not back through 0
    assert on > 3.0
    assert taken.after(0.1, 1.0) == on
