"""The yaw paper's comparison, Sec. V-B and Fig. 2, with its methods and ours.

Run it alone by `python -m tests.experiments.papers --only yaw`.
"""

from __future__ import annotations

import time
from dataclasses import dataclass

import numpy as np
from matplotlib.figure import Figure

from shotc.solvers.headings import METHODS
from shotc.solvers.headings.solve import solve_headings
from shotc.solvers.headings.task import HeadingTask
from tests.experiments.papers import nose
from tests.experiments.papers.headings import SETTINGS, instances
from tests.experiments.papers.plots import png
from tests.experiments.papers.report import Table
from tests.support.heading_measures import distance, effort

MAIN, SIDE = 500, 250  # instances of uniform headings with roomy times, and of each other setting

COLUMNS = (
    "method",
    "solved",
    "effort mean",
    "effort median",
    "of nearest",
    "distance rad",
    "of nearest",
    "speed rad/s",
    "ms median",
    "ms max",
)
PAPER = (
    "The paper (500 instances in 20 x 20 x 5 m, cubic pieces, OSQP; Fig. 2, a plot without numbers) says: "
    "yaw in (-pi, pi] costs most effort, distance and speed and sometimes finds no solution; the nearest "
    "angle costs more effort than virtual variables; most instances succeed given feasible times.",
    "It does not say how many keyframes, which headings, times and limits. Here: 5 to 11 keyframes, "
    "1.5 rad/s, 2 rad/s^2, rest at both ends.",
    "Roomy times: flying at 1.5 m/s and 1.5 m/s^2, and at least 1.3 times the shortest turn. Tight times: "
    "1.3 times the shortest turn, at least 0.6 s.",
    "Effort is the integral of the real angular acceleration squared, rad^2/s^3, over what each method "
    "solved; `of nearest` compares on the instances that both solved. Solved means that rate and "
    "acceleration are proved within their limits over continuous time. Times are those of the process.",
    "`virtual` is Eq. 10 and 11 with half-planes, free radii and a free knot in each interval; as printed, "
    "with radius 1, a turn by d from rest to rest comes within cos(d / 2) of the origin.",
)


@dataclass(frozen=True)
class Outcome:
    """What one method made of one instance; infinite where it found nothing."""

    effort: float
    distance: float
    speed: float
    seconds: float

    @property
    def solved(self) -> bool:
        """Whether there is a curve."""
        return bool(np.isfinite(self.effort))


def tables() -> list[Table]:
    """Run all methods on all settings."""
    found = []
    for roomy in (True, False):
        for setting, said in SETTINGS.items():
            count = MAIN if roomy and setting == "uniform" else SIDE
            outcomes = run(instances(setting, count, roomy=roomy))
            title = f"{said}, {'roomy' if roomy else 'tight'} times, {count} instances"
            first = not found
            notes, plot = (PAPER, _plot(outcomes)) if first else ((), None)
            found.append(Table(title[0].upper() + title[1:], COLUMNS, rows(outcomes), notes, plot))
    return [*found, nose.table()]


def run(tasks: list[HeadingTask]) -> dict[str, list[Outcome]]:
    """Return the outcomes by method, in the order of the tasks."""
    return {name: [_outcome(task, name) for task in tasks] for name in METHODS}


def rows(outcomes: dict[str, list[Outcome]]) -> tuple[tuple[str, ...], ...]:
    """Return a table's rows, a method each."""
    return tuple(_row(name, each, outcomes["nearest"]) for name, each in outcomes.items())


def share(each: list[Outcome], nearest: list[Outcome], what: str) -> float:
    """Return the ratio of two methods' means over what both solved."""
    pairs = [(getattr(a, what), getattr(b, what)) for a, b in zip(each, nearest, strict=True)]
    both = np.array([pair for pair in pairs if np.isfinite(pair).all()])
    return float(both[:, 0].mean() / both[:, 1].mean()) if len(both) else float("nan")


def _outcome(task: HeadingTask, method: str) -> Outcome:
    began = time.process_time()
    curve = solve_headings(task, method).curve
    seconds = time.process_time() - began
    if curve is None:
        return Outcome(np.inf, np.inf, np.inf, seconds)
    way = distance(curve)
    return Outcome(effort(curve), way, way / (curve.end - curve.start), seconds)


def _row(name: str, each: list[Outcome], nearest: list[Outcome]) -> tuple[str, ...]:
    solved = [o for o in each if o.solved]
    spent = np.array([o.effort for o in solved] or [np.nan])
    took = 1e3 * np.array([o.seconds for o in each])
    return (
        name,
        f"{100 * len(solved) / len(each):.1f} %",
        f"{spent.mean():.3f}",
        f"{np.median(spent):.3f}",
        f"{share(each, nearest, 'effort'):.2f}",
        f"{np.mean([o.distance for o in solved] or [np.nan]):.2f}",
        f"{share(each, nearest, 'distance'):.2f}",
        f"{np.mean([o.speed for o in solved] or [np.nan]):.3f}",
        f"{np.median(took):.1f}",
        f"{took.max():.1f}",
    )


def _plot(outcomes: dict[str, list[Outcome]]) -> bytes:
    """Draw the paper's four measures as Fig. 2 does, a bar a method."""
    figure = Figure(figsize=(9, 3))
    measures = ("effort", "distance", "speed")
    axes = figure.subplots(1, 4)
    names = list(outcomes)
    for one, what in zip(axes, measures, strict=False):
        values = [[getattr(o, what) for o in outcomes[name] if o.solved] for name in names]
        one.boxplot(values, tick_labels=names, showfliers=False)
        one.set_title({"effort": "effort rad²/s³", "distance": "distance rad", "speed": "speed rad/s"}[what])
    axes[3].bar(names, [100 * np.mean([o.solved for o in outcomes[name]]) for name in names])
    axes[3].set_title("solved %")
    for one in axes:
        one.tick_params(axis="x", rotation=60)
    figure.tight_layout()
    return png(figure)
