"""Gauss-Newton steps: PIQP solves a quadratic programme, and a line search lowers an exact-penalty merit.

The inputs are the unknowns; the states are rolled out from the measured one. So every iterate can be flown,
and the merit includes its violations.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import piqp

from shotc.plugin_api.replanner import Array
from shotc_casadi.replan.evaluation import Evaluation, HorizonFunctions, Rollout

SHORTER_RATIO = 0.4
MOST_TRIES = 5
TOLERANCE, GAP_TOLERANCE = 1e-4, 1e-4
"""Of PIQP: of the constraints, and of the cost, relative and absolute."""
MOST_ITERATIONS = 50
"""Of PIQP: about 10 are usual; an infeasible programme takes all of them."""


class StopRule(NamedTuple):
    """When to stop: after ``most`` steps, or if a step lowers the merit by less than the share ``gain``."""

    most: int
    gain: float


class Walk(NamedTuple):
    """The result of steps.

    steps : number of programmes
    stalled : whether no step lowered the merit
    opened : whether an infeasible programme got its bounds widened to the states of its iterate
    """

    motion: Rollout
    steps: int
    stalled: bool
    opened: bool


class Solver:
    """Takes steps over one horizon; only one thread may use it at a time."""

    def __init__(self, of: HorizonFunctions) -> None:
        """Allocate memory."""
        self.evaluation = Evaluation(of)
        cost, self._linear, motion, bound, self._rows, self._low, self._high = self.evaluation.programme
        laid = of.layout
        self._cost, self._motion = laid.cost.over(cost), laid.motion.over(motion)
        self._bound = laid.bound.over(bound)
        self._still = np.zeros(laid.motion.shape[0])
        self._shape, self._inputs = (of.stages, -1), of.inputs
        self._solver: Any = None

    def walk(self, inputs: Array, stop_rule: StopRule) -> Walk:
        """Take steps from inputs (N, U)."""
        taken, moved, opened = 0, False, False
        point = self.evaluation.step(inputs)
        while True:
            taken += 1
            step = self._solved()
            if step is None:
                opened = True
                np.minimum(self._low, 0.0, out=self._low)
                np.maximum(self._high, 0.0, out=self._high)
                step = self._solved()
            better = None if step is None else self._better(point, step)
            if better is None:
                return Walk(point, taken, not moved, opened)
            settled = point.merit - better.merit < stop_rule.gain * abs(point.merit)
            if settled or taken == stop_rule.most:
                return Walk(better, taken, stalled=False, opened=opened)
            point, moved = self.evaluation.step(better.inputs), True

    def _solved(self) -> Array | None:
        """Return the change of the inputs (N, U) by the programme, None if it is infeasible."""
        given = (self._cost, self._linear, self._motion, self._still, self._bound, self._rows, None)
        if self._solver is None:
            self._solver = _solver()
            self._solver.setup(*given, self._low, self._high)
        else:
            self._solver.update(*given, self._low, self._high)
        if self._solver.solve() != piqp.PIQP_SOLVED:
            return None
        return np.asarray(self._solver.result.x).reshape(self._shape)[:, : self._inputs]

    def _better(self, point: Rollout, step: Array) -> Rollout | None:
        share = 1.0
        for _ in range(MOST_TRIES):
            motion = self.evaluation.motion(point.inputs + share * step)
            if motion.merit < point.merit:  # false for NaN
                return motion
            share *= SHORTER_RATIO
        return None


def _solver() -> Any:
    """Return a solver whose results do not depend on earlier programmes.

    Its scaling would carry over from one programme to the next and change the last digits. In metres and
    seconds a programme is scaled well enough.
    """
    solver = piqp.SparseSolver()
    settings = solver.settings
    settings.eps_abs = settings.eps_rel = TOLERANCE
    settings.eps_duality_gap_abs = settings.eps_duality_gap_rel = GAP_TOLERANCE
    settings.max_iter, settings.preconditioner_iter = MOST_ITERATIONS, 0
    return solver
