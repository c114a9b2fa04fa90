"""The common part of all planners: constraints, the warm start from the last plan, and the result."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from math import isfinite

import numpy as np

from shotc.plugin_api.replanner import (
    NO_TRAFFIC,
    NO_WALLS,
    Array,
    Horizon,
    Keeping,
    Plan,
    Replan,
    Status,
    Traffic,
    Walls,
)
from shotc_casadi.replan.evaluation import HorizonFunctions
from shotc_casadi.replan.keeping import RowCounts, StaticObstacles, common, each, row_counts
from shotc_casadi.replan.steps import Solver, Walk

BEYOND = "the motion from here is beyond all numbers"
SOON_S = 1e-6
"""A step that begins this soon has begun, seconds."""
BOUND_PARAMETERS = 6
"""The first parameters of a stage: lower and upper bounds of the velocity."""


class ShotSolvers:
    """The solvers of one shot: one for each number of other drones and set of near obstacles.

    The parameters of a stage begin with the velocity bounds and end with those of ``keeping.each``. The
    common parameters end with those of ``keeping.common``. The planner defines those in between.
    """

    def __init__(
        self,
        keeping: Keeping,
        ahead: Horizon,
        made: Callable[[RowCounts], HorizonFunctions],
        begun: Callable[[Solver], None],
    ) -> None:
        """Make the solver of a shot without traffic.

        made : returns a horizon
        begun : writes the constants into a new solver
        """
        limits, n = keeping.limits, ahead.stages
        self._keeping, self._step, self._made, self._begun = keeping, ahead.step, made, begun
        self._standing = StaticObstacles(keeping)
        self._solvers: dict[RowCounts, Solver] = {}
        self.times = ahead.step * np.arange(n + 1)
        self._way = float(self.times[-1])  # metres at 1 m/s
        self._back = limits.usable_acceleration / np.sqrt(3.0) * self.times[1:, None] * np.ones(3)
        east, north = limits.wind
        self._lowest = np.array([east - limits.speed, north - limits.speed, -limits.descent])
        self._highest = np.array([east + limits.speed, north + limits.speed, limits.climb])
        self._solver(row_counts(keeping, self._standing.near(np.zeros(3), 0.0), NO_TRAFFIC, NO_WALLS))

    def solver(self, place: Array, v: Array, traffic: Traffic, walls: Walls) -> tuple[Solver, bool]:
        """Return the solver with all constraints written, and whether the velocity widens its bounds.

        place, v : of the drone, shape (3,); they are written as the first entries of the measured state
        """
        fastest = max(self._keeping.limits.fastest, float(np.linalg.norm(v)))
        near = self._standing.near(place, fastest * self._way)
        of = row_counts(self._keeping, near, traffic, walls)
        solver = self._solver(of)
        into = solver.evaluation
        into.start[:3], into.start[3:6] = place, v
        if of.each:
            into.given[:, -of.each :] = each(traffic, walls, self._keeping.margin)
        shared = common(self._keeping, near, self._step, traffic, walls)
        into.common[len(into.common) - of.common :] = shared
        return solver, self._bound(into.given, v)

    def index(self, time: float, last: Plan) -> Array:
        """Return which steps of the last plan the steps from now on are, (N,); past its end, their number."""
        now = time + self.times[:-1] + SOON_S
        return np.asarray(np.maximum(np.searchsorted(last.times, now, side="right") - 1, 0))

    def replan_of(self, solver: Solver, walk: Walk, time: float, widened: bool) -> Replan:
        """Return the result of steps from a measured state."""
        motion = walk.motion
        if not (isfinite(motion.worst) and isfinite(motion.states.sum())):
            return Replan(None, "failed", BEYOND)
        states = np.concatenate([solver.evaluation.start[None], motion.states])
        aim = states[:, 6:8] if states.shape[1] > 6 else None
        times = np.asarray(self.times + time)
        plan = Plan(times, states[:, :3], states[:, 3:6], motion.inputs[:, :3], aim)
        opened = walk.opened or widened
        status: Status = "stalled" if walk.stalled else "opened" if opened else "planned"
        return Replan(plan, status, "", motion.worst, walk.steps)

    def _solver(self, of: RowCounts) -> Solver:
        if of not in self._solvers:
            self._solvers[of] = Solver(self._made(of))
            self._begun(self._solvers[of])
        return self._solvers[of]

    def _bound(self, given: Array, v: Array) -> bool:
        """Write the velocity bounds, and return whether the measured velocity widens them.

        If it is outside, the bounds narrow again at the acceleration that is available along every axis at
        once.
        """
        back = self._back[0]
        given[:, :3], given[:, 3:BOUND_PARAMETERS] = self._lowest, self._highest
        if (v >= self._lowest - back).all() and (v <= self._highest + back).all():
            return False
        given[:, :3] = np.minimum(self._lowest, v + self._back)
        given[:, 3:BOUND_PARAMETERS] = np.maximum(self._highest, v - self._back)
        return True


def fault(given: Mapping[str, Sequence[Array]]) -> Replan:
    """Return the failure of a replan, with the name of the first input that is not finite.

    given : inputs by name, arrays of any shape
    """
    broken = (name for name, arrays in given.items() if not all(np.isfinite(a).all() for a in arrays))
    return Replan(None, "failed", next((f"{name} is not finite" for name in broken), BEYOND))


def sent(traffic: Traffic) -> list[Array]:
    """Return all arrays that other drones have sent; shapes as in ``Traffic``."""
    return [traffic.others, *(a for cone in traffic.cones for a in (cone.apex, cone.axis))]


def beside(walls: Walls) -> list[Array]:
    """Return all arrays of half-spaces; shapes as in ``Walls``."""
    return [walls.normals, walls.offsets]
