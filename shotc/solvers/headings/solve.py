"""The solution of headings by a named method."""

from __future__ import annotations

from collections.abc import Callable

from shotc.geom.bernstein import Array
from shotc.solvers.conic import Status
from shotc.solvers.headings import DEFAULT
from shotc.solvers.headings.bounded_cubic import bounded_cubic
from shotc.solvers.headings.energy import energy
from shotc.solvers.headings.task import Headings, HeadingTask, nearest_turns, raw_turns, turned
from shotc.solvers.headings.virtual import by_virtual
from shotc.solvers.headings.winding import by_winding


def solve_headings(task: HeadingTask, method: str = DEFAULT) -> Headings:
    """Return the headings by a method of ``METHODS``; raise KeyError for any other.

    The curve meets keyframes modulo whole turns, and stated turns exactly. A single keyframe has no curve.
    """
    solver = SOLVERS[method]
    if len(task.yaw) == 1:
        return Headings(Status.SOLVED, task.yaw, None, complete=True)
    return solver(task)


def _by_turns(turns: Callable[[Array], Array]) -> Callable[[HeadingTask], Headings]:
    def solve(task: HeadingTask) -> Headings:
        angles = turned(task, turns(task.yaw))
        curve = bounded_cubic(task, energy(task.at, 0.0, task.rates), angles)
        return Headings(Status.INFEASIBLE if curve is None else Status.SOLVED, angles, curve)

    return solve


SOLVERS: dict[str, Callable[[HeadingTask], Headings]] = {
    "winding": by_winding,
    "nearest": _by_turns(nearest_turns),
    "bounded": _by_turns(raw_turns),
    "virtual": by_virtual,
}
