"""Gauss-Newton steps, each a quadratic programme, shortened until an exact-penalty merit falls.

Inputs are the unknowns: the states are rolled out from the measured one, so that every iterate can be flown,
and what it lacks is known and priced.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from shotc.plugin_api.replanner import Array
from shotc_casadi.replan.evaluation import Evaluation, Horizon, Motion
from shotc_casadi.replan.program import Program

SHORTER = 0.4
TRIES = 5


class Bounds(NamedTuple):
    """Of inputs, (U,), and of the states of stages 1 to N, (N, X)."""

    low_input: Array
    high_input: Array
    low: Array
    high: Array


class Until(NamedTuple):
    """When to stop: after so many steps, or one that lowers the merit by less than this share of it."""

    most: int
    gain: float


class Walk(NamedTuple):
    """Where steps led.

    steps : how many programmes were taken up; stalled : whether none of the steps lowered the merit
    opened : whether a programme had no solution until its bounds were widened to the states of its iterate
    """

    motion: Motion
    steps: int
    stalled: bool
    opened: bool


class Solver:
    """Takes steps over one horizon; one thread may use it at a time."""

    def __init__(self, of: Horizon, lacking: float, outside: float) -> None:
        """Take memory; lacking, outside : prices of what the worst row of a stage lacks, and of excess."""
        self.evaluation = Evaluation(of)
        self._program = Program(of, lacking)
        self._lacking, self._outside = lacking, outside

    def walk(self, inputs: Array, bounds: Bounds, until: Until) -> Walk:
        """Take steps from inputs (N, U) on."""
        taken, moved, opened = 0, False, False
        point, slopes = self.evaluation.slopes(inputs)
        while True:
            taken += 1
            step = self._program.solve(slopes, *_about(bounds, point, opened=False))
            if step is None:
                opened = True
                step = self._program.solve(slopes, *_about(bounds, point, opened=True))
            better = None if step is None else self._better(point, step[:, : inputs.shape[1]])
            if better is None:
                return Walk(point, taken, not moved, opened)
            gained = self._merit(point) - self._merit(better)
            settled = gained < until.gain * abs(self._merit(point))
            point, moved = better, True
            if settled or taken == until.most:
                return Walk(point, taken, stalled=False, opened=opened)
            point, slopes = self.evaluation.slopes(point.inputs)

    def _better(self, point: Motion, step: Array) -> Motion | None:
        share, before = 1.0, self._merit(point)
        for _ in range(TRIES):
            found = self.evaluation.motion(point.inputs + share * step)
            if self._merit(found) < before:  # what is no number is not
                return found
            share *= SHORTER
        return None

    def _merit(self, motion: Motion) -> float:
        return motion.cost + self._lacking * motion.lack + self._outside * motion.excess


def _about(bounds: Bounds, point: Motion, opened: bool) -> tuple[Array, Array]:
    low, high = bounds.low, bounds.high
    if opened:
        low, high = np.minimum(low, point.states), np.maximum(high, point.states)
    return (
        np.hstack([bounds.low_input - point.inputs, low - point.states]),
        np.hstack([bounds.high_input - point.inputs, high - point.states]),
    )
