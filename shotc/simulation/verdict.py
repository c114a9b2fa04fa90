"""Whether runs keep what the mission asks of rehearsals, and what they would keep."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from math import ceil, inf

from shotc.ir.rehearsal import RehearsalPromise
from shotc.simulation.judge import Run

Key = str

MEASURES: dict[Key, tuple[Callable[[Run], float], bool]] = {
    "in_frame": (lambda run: run.in_frame, False),
    "in_sight": (lambda run: run.in_sight, False),
    "mean_error": (lambda run: run.error, True),
    "clearance": (lambda run: run.clearance, False),
    "stray": (lambda run: run.stray, True),
}
"""What is measured of a run for each key of the promise, and whether it is to stay below what is asked."""


@dataclass(frozen=True, slots=True)
class Verdict:
    """One thing that is asked of the runs.

    key : as missions write it; limit : what is asked; upper : whether values are to stay below it
    held : in how many runs it holds; worst, run : the worst value, and the run that has it
    kept : the value that as many runs keep as are asked to; written : whether the mission asks for it
    """

    key: Key
    limit: float
    upper: bool
    held: int
    worst: float
    run: int
    kept: float
    written: bool


def verdicts(runs: Sequence[Run], promise: RehearsalPromise) -> tuple[Verdict, ...]:
    """Judge runs by what is asked of them; that nothing is touched is always asked."""
    return tuple(_verdicts(runs, promise))


def held(runs: Sequence[Run], found: Sequence[Verdict]) -> int:
    """Return in how many runs all of it holds."""
    return sum(all(_holds(each.key, run, each.limit) for each in found) for run in runs)


def enough(runs: Sequence[Run], promise: RehearsalPromise) -> int:
    """Return in how many runs all of it has to hold."""
    return ceil(promise.of * len(runs) - 1e-9)


def _verdicts(runs: Sequence[Run], promise: RehearsalPromise) -> Iterator[Verdict]:
    for key, (measure, upper) in MEASURES.items():
        asked = getattr(promise, key)
        if asked is None and key != "clearance":
            continue
        limit = 0.0 if asked is None else asked
        values = [(measure(run), run.number) for run in runs]
        ordered = sorted(values, reverse=not upper)  # the best first
        worst, number = ordered[-1]
        kept = ordered[enough(runs, promise) - 1][0]
        count = sum(_holds(key, run, limit) for run in runs)
        yield Verdict(key, limit, upper, count, worst, number, kept, asked is not None)


def _holds(key: Key, run: Run, limit: float) -> bool:
    measure, upper = MEASURES[key]
    value = measure(run)
    return value <= limit if upper else value >= limit or value == inf
