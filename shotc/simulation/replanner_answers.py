"""Checks what a replanner returns before a drone flies it."""

from __future__ import annotations

from typing import Any, get_args

import numpy as np

from shotc.geom.bernstein import Array
from shotc.plugin_api.replanner import Plan, Replan, Status

SAME_TIME_S = 1e-6


def fault_of(answer: Any, stages: Array) -> str:
    """Return why an answer cannot be flown; "" if it can.

    stages : mission times of the replan, (N + 1,), seconds
    """
    if not isinstance(answer, Replan):
        return f"it returned {_kind(answer)} and no Replan"
    if answer.status not in get_args(Status):
        return f"its status is {answer.status!r}"
    if answer.plan is None or answer.status == "failed":
        return answer.reason or "it gave no plan and no reason"
    plan: Any = answer.plan
    if not isinstance(plan, Plan):
        return f"its plan is {_kind(plan)} and no Plan"
    return _misshapen(plan, stages) or _unreal(answer, plan, stages)


def _misshapen(plan: Plan, stages: Array) -> str:
    count = len(stages)
    shapes = {
        "times": (count,),
        "places": (count, 3),
        "velocities": (count, 3),
        "accelerations": (count - 1, 3),
        "aim": (count, 2),
    }
    for name, expected in shapes.items():
        part = getattr(plan, name)
        if name == "aim" and part is None:
            continue
        if not isinstance(part, np.ndarray) or part.dtype.kind != "f":
            return f"`{name}` of its plan is {_kind(part)} and no array of floats"
        if part.shape != expected:
            return f"`{name}` of its plan has the shape {part.shape}, and {expected} is wanted"
    return ""


def _unreal(answer: Replan, plan: Plan, stages: Array) -> str:
    parts = [plan.times, plan.places, plan.velocities, plan.accelerations]
    parts += [] if plan.aim is None else [plan.aim]
    if not (np.isfinite(answer.lack) and all(np.isfinite(part).all() for part in parts)):
        return "its plan holds numbers that are not finite"
    if np.abs(plan.times - stages).max() > SAME_TIME_S:
        return "the times of its plan are not those of the stages"
    return ""


def _kind(value: Any) -> str:
    return f"a {type(value).__name__}"
