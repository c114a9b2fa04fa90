"""The nonlinear solver: growth with the number of stages, and fatrop against IPOPT on one problem."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from multiprocessing import get_context
from statistics import fmean, median
from typing import Any

from shotc.ir.path import PathIR
from tests.experiments.papers import plots
from tests.experiments.papers.missions import Draft, convex_path
from tests.experiments.papers.report import Section, Table

STAGES = (50, 100, 200, 400)
GROWTH_MISSIONS = 5
RATIO_MISSIONS = 10
REPEATS = 3


def section(drafts: Sequence[Draft], say: Callable[[str], None]) -> Section:
    """Measure both; the first missions are used."""
    paths = [path for draft in drafts[:RATIO_MISSIONS] if (path := convex_path(draft)) is not None]
    return Section("The solver", (growth(paths[:GROWTH_MISSIONS], say), ratios(paths, say)))


def growth(paths: Sequence[PathIR], say: Callable[[str], None]) -> Table:
    """Return solve times over the number of stages, condition ours, solvers warm."""
    from shotc_casadi.refiner import OURS, subjects
    from shotc_casadi.rounds import refine_shot

    rows, line = [], []
    base = 0.0
    for count in STAGES:
        say(f"growth: {count} stages")
        problems = [refine_shot(subjects(path)[0], OURS.condition, count).problem for path in paths]
        solutions = [_quickest(problem, "fatrop") for problem in problems]
        seconds = median(s.seconds for s in solutions)
        step = fmean(s.seconds / max(1, s.iterations) for s in solutions)
        base = base or step / count
        line.append((float(count), seconds))
        rows.append(
            (
                str(count),
                f"{seconds:.3f} s",
                f"{median(s.iterations for s in solutions):.0f}",
                f"{1000 * step:.2f} ms",
                f"{1e6 * step / count:.1f} us",
                f"x{step / count / base:.2f}",
            )
        )
    columns = (
        "stages",
        "one solve, median",
        "iterations",
        "an iteration",
        "an iteration and stage",
        f"against N = {STAGES[0]}",
    )
    notes = (
        f"{len(paths)} missions under ours, solver warm, each one's last round, the quickest of {REPEATS} "
        "solves; linear growth is x1.00",
    )
    return Table(
        "Growth with the number of stages",
        columns,
        tuple(rows),
        notes,
        plots.lines({"one solve, median": line}, "stages", "seconds"),
    )


def _quickest(problem: Any, solver: Any) -> Any:
    """Return the solution that took least time: what else runs only ever adds to it."""
    from shotc_casadi.program import solve

    return min((solve(problem, solver) for _ in range(REPEATS)), key=lambda s: s.seconds)


def ratios(paths: Sequence[PathIR], say: Callable[[str], None]) -> Table:
    """Return the times of both solvers on identical problems, in this process and in fresh ones."""
    from shotc_casadi.refiner import OURS, subjects
    from shotc_casadi.rounds import SOLVERS, refine_shot

    problems = [refine_shot(subjects(path)[0], OURS.condition).problem for path in paths]
    warm: dict[str, list[Any]] = {}
    cold: dict[str, float] = {}
    for solver in SOLVERS:
        say(f"solvers: {solver}")
        warm[solver] = [_quickest(problem, solver) for problem in problems]
        with get_context("spawn").Pool(1) as pool:
            cold[solver] = pool.apply(first_solve, (problems[0], solver))
    rows = []
    for solver, found in warm.items():
        ratio = [a.seconds / b.seconds for a, b in zip(found, warm[SOLVERS[0]], strict=True)]
        rows.append(
            (
                solver,
                f"{median(s.seconds for s in found):.3f} s",
                f"{median(s.iterations for s in found):.0f}",
                f"x{median(ratio):.2f}",
                f"{cold[solver]:.3f} s",
                f"x{cold[solver] / cold[SOLVERS[0]]:.2f}",
                f"{sum(s.status == 'solved' for s in found)} of {len(found)}",
                f"{_apart(found, warm[SOLVERS[0]]):.1e}",
            )
        )
    return Table(
        "fatrop and IPOPT on the identical problem",
        (
            "solver",
            "warm, median",
            "iterations",
            f"against {SOLVERS[0]}",
            "cold",
            f"against {SOLVERS[0]}",
            "solved",
            "objective, largest difference",
        ),
        tuple(rows),
        (
            f"{len(problems)} problems of condition ours, N = 100 or as many as their keyframes need; warm: "
            f"the quickest of {REPEATS} solves of each",
            "cold: the first solve of a fresh process with CasADi loaded, building the programme included",
        ),
    )


def first_solve(problem: Any, solver: Any) -> float:
    """Return the seconds of a process's first solve, its libraries loaded."""
    from shotc_casadi.program import solve

    began = time.perf_counter()
    solve(problem, solver)
    return time.perf_counter() - began


def _apart(found: Sequence[Any], other: Sequence[Any]) -> float:
    """Return the largest relative difference of two solvers' objectives."""
    pairs = zip(found, other, strict=True)
    return max(abs(a.objective - b.objective) / max(abs(b.objective), 1e-12) for a, b in pairs)
