"""A path and the time it is asked to take."""

from __future__ import annotations

import pytest

from shotc.ir.limits import Timing
from shotc.ir.passes import PassContext
from shotc.passes.parameterize_time import ParameterizeTime
from tests.support.few import few
from tests.support.path_scenes import (
    free,
    legs,
    mission,
    planned,
    shot,
    solve,
)

BENDS = [(-40, -30, 10), (0, -42, 18), (40, -30, 12), (45, 10, 20)]


def test_the_path_does_not_depend_on_the_duration():
    asked = [Timing(), Timing(duration=9.0), Timing(duration=200.0)]
    curves = []
    for timing in asked:
        keyframes = [free(i, at, yaw=0.4 * i) for i, at in enumerate(BENDS)]
        (leg,) = legs(planned(mission(), shot(keyframes, timing=timing)), "shot")
        curves.append(leg.curve)
    assert all(curve.ctrl.tobytes() == curves[0].ctrl.tobytes() for curve in curves)


@pytest.mark.slow
@pytest.mark.parametrize("count", few([2, 3, 4], [2, 3]))
def test_the_shortest_duration_named_is_met_and_a_hundredth_less_is_not(count):
    made = mission()

    def timed(duration: float):
        keyframes = [free(i, at, yaw=0.4 * i) for i, at in enumerate(BENDS[:count])]
        outcome = solve(made, shot(keyframes, timing=Timing(duration=duration)))
        return ParameterizeTime().run(outcome.value, PassContext())

    (fault,) = timed(3.0).diagnostics
    shortest = float(fault.message.split("but ")[1].split(" s")[0])
    assert timed(shortest).value is not None
    assert [d.code for d in timed(shortest - 0.011).diagnostics] == ["T001"]
