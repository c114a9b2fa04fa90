"""The course of a target that a shot turns with, and its height: taken over seconds, not from one moment."""

from __future__ import annotations

from math import cos, exp, sin
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from shotc.geom.bernstein import Array
from shotc.ir.phases import Phase
from shotc.simulation.guidance import COURSE_S, PERIOD_S, Guidance
from shotc.simulation.kalman import STATE_COUNT, WAY, Estimate
from shotc.simulation.seen import Foreseen
from shotc.simulation.situations import Chased

SHOT = Chased(Phase("shot", 0.0, 60.0, "side"), "walker", turns=True)


class Taken:
    """Takes the course of a target whose track leads East, replan by replan."""

    def __init__(self) -> None:
        track = SimpleNamespace(heading=lambda time: 0.0)
        walker = SimpleNamespace(track=track, at=lambda time: (0.0, 0.0, 0.9))
        mission = SimpleNamespace(target=lambda name: walker)
        world = SimpleNamespace(mission=mission)
        self.of = SimpleNamespace(world=world, _course=np.zeros(1), _rise=np.zeros(1))

    def after(self, speed: float, course: float) -> float:
        way = (speed * cos(course), speed * sin(course), 0.0)
        turn: Array = Guidance._turn(cast("Any", self.of), SHOT, 0.0, known(way=way))
        return float(turn[0])

    def at_height(self, height: float) -> float:
        rise: Array = Guidance._risen(cast("Any", self.of), SHOT, 0.0, known(height=height))
        return float(rise[0])


def known(way: tuple[float, ...] = (1.3, 0.0, 0.0), height: float = 0.9) -> dict[str, Foreseen]:
    mean = np.zeros((1, STATE_COUNT))
    mean[0, 2], mean[0, WAY] = height, way
    now = Estimate(0.0, mean, np.zeros((1, STATE_COUNT, STATE_COUNT)))
    return {"walker": Foreseen(now, np.zeros((1, 1, 3)), np.zeros((1, 1, 3)))}


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


def test_a_height_is_taken_over_seconds_and_reached() -> None:
    noisy = Taken()
    found = [noisy.at_height(0.9 + 0.02 * (-1) ** k) for k in range(40)]
    assert max(map(abs, found)) < 0.004
    climbed = Taken()
    found = [climbed.at_height(2.9) for _ in range(round(3 * COURSE_S / PERIOD_S))]
    assert found[-1] == pytest.approx(2.0 * (1.0 - exp(-3.0)))
