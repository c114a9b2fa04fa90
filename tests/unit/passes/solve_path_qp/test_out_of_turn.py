"""Drones that find no way in order of priority: who goes first then, and what is said of it."""

from __future__ import annotations

from functools import cache

import pytest

from shotc.api import Compilation, PlanOptions, compile_source
from shotc.diag.registry import registry
from shotc.ir.path import PathIR

pytestmark = pytest.mark.slow

BESIDE = registry()["M038"].failing
"""A shot that binds beside another drone's shot at the same time, which yields."""
TWO_THAT_BIND = BESIDE.replace(
    "kind: lateral, drone: cam1, target: runner, side: left, distance: 8, altitude: 4,",
    "kind: keyframes, drone: cam1, target: runner,\n     keyframes: ["
    "{at: {from: runner, offset: [1.6, 10, 3.1]}, look_at: runner, time: 0}, "
    "{at: {from: runner, offset: [2.6, 10, 3.1]}, look_at: runner, time: 5}],",
).replace("timing: {start: 18, duration: 8}", "timing: {start: 20, duration: 5}")


@cache
def planned(mission: str) -> Compilation:
    options = PlanOptions(refiner="none", stop_after="solve-path-qp")
    return compile_source(mission.encode(), "m.yaml", None, options)


def codes(mission: str) -> list[str]:
    return [d.code for d in planned(mission).diagnostics]


@pytest.mark.long
def test_who_finds_no_way_goes_first_and_the_other_keeps_clear() -> None:
    path = planned(BESIDE).reports[-1].output
    assert isinstance(path, PathIR)
    assert [flown.drone for flown in path.timed] == ["cam2", "cam1"]
    whole = compile_source(BESIDE.encode(), "m.yaml", None, PlanOptions(refiner="none"))
    assert whole.plan is not None
    apart = [claim for claim in whole.plan.certificate if claim.constraint.startswith("separation")]
    assert apart
    assert all(claim.worst >= claim.limit for claim in apart)


@pytest.mark.long
def test_drones_of_one_priority_have_no_order_that_is_told() -> None:
    assert codes(BESIDE) == ["M038"]
    assert codes(BESIDE.replace("priority: 2", "priority: 1")) == []
    assert codes(BESIDE.replace(", priority: 1", ", priority: 3")) == []


@pytest.mark.long
def test_where_no_order_does_it_is_said_of_the_first_one() -> None:
    (fault,) = planned(TWO_THAT_BIND).diagnostics
    assert fault.code == "M015"
    assert "`cam2`" in fault.message


@pytest.mark.long
def test_who_waits_for_a_shot_of_another_drone_does_not_go_before_it() -> None:
    waiting = BESIDE.replace("start: 20, duration: 5", "after: side, duration: 5")
    path = planned(waiting).reports[-1].output
    assert isinstance(path, PathIR)
    assert [flown.drone for flown in path.timed] == ["cam1", "cam2"]
