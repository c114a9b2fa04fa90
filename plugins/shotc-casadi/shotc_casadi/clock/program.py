"""Solves the programme of one shot on its own clock, and evaluates its cost for a motion."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np

from shotc.plugin_api.refiner import Array
from shotc_casadi.clock.problem import ClockProblem
from shotc_casadi.clock.symbols import CONTROL_POINTS, Sizes, derived
from shotc_casadi.horizon import Solver
from shotc_casadi.solving import Instance, Solution, solved

SOLVER_TOLERANCE = 1e-5
UNIT_TOLERANCE = 1e-2  # the same if the cost is scaled by the problem's unit
FEASIBLE_RESIDUAL = 1e-4  # of a constraint's residual, each in its own unit
HELD = ("speed", "acceleration", "distance from its place")
ROWS = (*HELD, "jerk", "speed", "climb and descent")


def solve(task: ClockProblem, solver: Solver) -> Solution:
    """Solve a problem from its initial guess."""
    solution = solved(instance(task), solver)
    return replace(
        solution,
        inputs=solution.inputs * task.units,
        objective=solution.objective / task.unit,
        multipliers=solution.multipliers / task.unit,
    )


def instance(task: ClockProblem) -> Instance:
    """Return a problem in the form that the solvers take, with each slack in its unit."""
    return Instance(
        kind=derived(task.sizes),
        parameters=task.parameters,
        states=task.states,
        inputs=task.inputs / task.units,
        state_bounds=task.state_bounds,
        input_bounds=(np.tile(task.least, (task.stages, 1)), np.full_like(task.inputs, np.inf)),
        held=task.held,
        driven=task.driven,
        named=partial(_named, task.sizes),
        tolerance=UNIT_TOLERANCE if task.unit > 1.0 else SOLVER_TOLERANCE,
        feasible=FEASIBLE_RESIDUAL,
    )


def cost(task: ClockProblem, states: Array, inputs: Array) -> float:
    """Return the cost of a motion, including the slacks that its ellipsoids need.

    inputs : shape (N, sizes.moves), without those slacks
    """
    sizes, functions = task.sizes, derived(task.sizes)
    u = np.zeros((len(inputs), sizes.inputs))
    u[:, : sizes.moves] = inputs[:, : sizes.moves]
    rows = np.array(functions.rows.map(len(u))(np.hstack([states[:-1], u]).T, task.parameters[:-1].T)[1])
    lack = np.maximum(-rows[len(HELD) + sizes.limits + CONTROL_POINTS * sizes.planes :].T, 0.0)
    if sizes.occluders:
        u[:, sizes.moves] = lack[:, : sizes.occluders].max(axis=1)
    if sizes.bodies:
        u[:, -1] = lack[:, sizes.occluders :].max(axis=1)
    value = functions.cost.map(len(u))(np.hstack([states[:-1], u / task.units]).T, task.parameters[:-1].T)
    last = functions.last_cost(states[-1], task.parameters[-1])
    return (float(np.array(value).sum()) + float(last)) / task.unit


def _named(sizes: Sizes, row: int) -> str:
    """Return the readable name of a row of held and driven constraints."""
    if row < len(ROWS):
        return ROWS[row]
    row -= len(HELD)
    if row < sizes.limits:
        return "the gimbal's pitch"
    row -= sizes.limits + CONTROL_POINTS * sizes.planes
    if row < 0:
        return "clearance"
    return "the line of sight" if row < sizes.occluders else "distance"
