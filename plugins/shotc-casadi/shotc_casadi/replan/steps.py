"""Gauss-Newton steps, each a quadratic programme, halved until an exact-penalty merit falls.

Inputs are the unknowns: the states are rolled out from the measured one, so that every iterate can be flown,
and what it lacks is known and priced.
"""

from __future__ import annotations

from typing import NamedTuple, Protocol

import numpy as np

from shotc.plugin_api.replanner import Array
from shotc_casadi.replan.program import Programs, Quadratic
from shotc_casadi.replan.rows import Rows

SHORTER = 0.4
TRIES = 5


class Model(Protocol):
    """What is planned: inputs (N, U) and the states (N, X) that they lead to."""

    @property
    def prices(self) -> tuple[float, float]:
        """Return the price of what the worst row of a stage lacks, and of what a state is out of bounds."""
        ...

    def allowed(self, inputs: Array) -> Array:
        """Return the nearest inputs that the vehicle takes."""
        ...

    def rolled(self, inputs: Array) -> Array:
        """Return the states of stages 1 to N."""
        ...

    def cost(self, inputs: Array, states: Array) -> float:
        """Return what is to be least."""
        ...

    def rows(self, inputs: Array, states: Array) -> Rows:
        """Return what is to be kept, linearised."""
        ...

    def excess(self, states: Array) -> float:
        """Return by how much states are out of their bounds, added up."""
        ...

    def quadratic(self, inputs: Array, states: Array, rows: Rows, opened: bool) -> Quadratic:
        """Return the programme of a step; opened : whether bounds are widened to the iterate's states."""
        ...


class Walk(NamedTuple):
    """Where steps led.

    lack : of the worst row; steps : how many programmes were taken up
    stalled : whether none of the steps lowered the merit; opened : whether a programme had no solution until
    its bounds were widened
    """

    inputs: Array
    states: Array
    lack: float
    steps: int
    stalled: bool
    opened: bool


def walk(model: Model, programs: Programs, inputs: Array, until: tuple[int, float]) -> Walk:
    """Take steps from inputs (N, U) on.

    until : how many at most, and the share of the merit by which a step lowers it that is not the last
    """
    most, gain = until
    point = _Point.at(model, model.allowed(inputs))
    taken, moved, opened = 0, False, False
    for _ in range(most):
        taken += 1
        step = programs.solve(model.quadratic(point.inputs, point.states, point.rows, opened=False))
        if step is None:
            opened = True
            step = programs.solve(model.quadratic(point.inputs, point.states, point.rows, opened=True))
        better = None if step is None else _better(model, point, step[:, : inputs.shape[1]])
        if better is None:
            break
        settled = point.merit - better.merit < gain * abs(point.merit)
        point, moved = better, True
        if settled:
            break
    lack = float(point.rows.lack(len(inputs)).max(initial=0.0))
    return Walk(point.inputs, point.states, lack, taken, not moved, opened)


class _Point(NamedTuple):
    inputs: Array
    states: Array
    rows: Rows
    merit: float

    @classmethod
    def at(cls, model: Model, inputs: Array) -> _Point:
        states = model.rolled(inputs)
        rows = model.rows(inputs, states)
        lacking, outside = model.prices
        lack = float(rows.lack(len(inputs)).sum())
        merit = model.cost(inputs, states) + lacking * lack + outside * model.excess(states)
        return cls(inputs, states, rows, merit)


def _better(model: Model, point: _Point, step: Array) -> _Point | None:
    share = 1.0
    for _ in range(TRIES):
        found = _Point.at(model, model.allowed(point.inputs + share * step))
        if np.isfinite(found.merit) and found.merit < point.merit:
            return found
        share *= SHORTER
    return None
