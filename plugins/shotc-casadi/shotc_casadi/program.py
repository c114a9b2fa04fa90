"""The programme of one shot on a path, in numbers, and its solution."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import numpy as np

from shotc_casadi.conditions import Visibility
from shotc_casadi.derivatives import derived
from shotc_casadi.horizon import Solver
from shotc_casadi.solving import Array, Instance, Solution, solved

SOLVER_TOLERANCE = 1e-4
FEASIBLE_RESIDUAL = 1e-3  # of a constraint's residual, each in its own unit
NARROW_WIDTH = 1e-3  # least width of a state's bounds: without an interior, fatrop does not end
ROWS = ("speed", "acceleration")


@dataclass(frozen=True, slots=True, eq=False)
class Problem:
    """One instance of the programme: N stages, N + 1 nodes.

    parameters : shape (N + 1, symbols.size(planes, extents, windy, zooms))
    states, inputs : initial guess, shapes (N + 1, STATES) and (N, INPUTS), with those of the lens if it zooms
    state_bounds, input_bounds : (lower, upper), shapes as states and inputs
    held, driven : (lower, upper) of a stage's constraints, each of shape (2 + planes,) and (1,)
    extents : number of bodies of the target, 0 for one upright cylinder
    windy : whether there is wind
    zooms : whether the lens is part of the problem
    """

    visibility: Visibility
    parameters: Array
    states: Array
    inputs: Array
    state_bounds: tuple[Array, Array]
    input_bounds: tuple[Array, Array]
    held: tuple[Array, Array]
    driven: tuple[Array, Array]
    extents: int = 0
    windy: bool = False
    zooms: bool = False

    @property
    def stages(self) -> int:
        """N."""
        return len(self.inputs)

    @property
    def planes(self) -> int:
        """Number of half-spaces of each node."""
        return len(self.held[0]) - 2


def solve(problem: Problem, solver: Solver) -> Solution:
    """Solve a problem from its initial guess."""
    return solved(instance(problem), solver)


def instance(problem: Problem) -> Instance:
    """Return a problem in the form that the solvers take.

    State bounds narrower than NARROW_WIDTH are widened to it about their middle.
    """
    return Instance(
        kind=derived(problem.visibility, problem.planes, problem.extents, problem.windy, problem.zooms),
        parameters=problem.parameters,
        states=problem.states,
        inputs=problem.inputs,
        state_bounds=_opened(*problem.state_bounds),
        input_bounds=problem.input_bounds,
        held=problem.held,
        driven=problem.driven,
        named=partial(_named, problem.planes),
        tolerance=SOLVER_TOLERANCE,
        feasible=FEASIBLE_RESIDUAL,
    )


def _named(planes: int, row: int) -> str:
    """Return the readable name of a row of held and driven constraints."""
    if row < len(ROWS):
        return ROWS[row]
    return "clearance" if row < len(ROWS) + planes else "jerk"


def _opened(low: Array, high: Array) -> tuple[Array, Array]:
    short = np.where(low <= high, np.maximum(0.0, 0.5 * (NARROW_WIDTH - (high - low))), 0.0)
    return low - short, high + short
