"""Judges whether runs keep the mission's requirements on rehearsals, and which values they would keep."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from math import ceil, inf
from typing import Literal, NamedTuple

from shotc.ir.rehearsal import RehearsalPromise
from shotc.simulation.judge import Run

Key = str

Unit = Literal["share", "half frames", "m"]


class Measure(NamedTuple):
    """A measure of a run, and whether the requirement is an upper limit."""

    of: Callable[[Run], float]
    upper: bool
    unit: Unit


MEASURES: dict[Key, Measure] = {
    "in_frame": Measure(lambda run: run.in_frame, False, "share"),
    "in_sight": Measure(lambda run: run.in_sight, False, "share"),
    "mean_error": Measure(lambda run: run.error, True, "half frames"),
    "clearance": Measure(lambda run: run.clearance, False, "m"),
    "stray": Measure(lambda run: run.stray, True, "m"),
}
"""The measure of each key of the requirements."""


@dataclass(frozen=True, slots=True)
class RequirementVerdict:
    """The verdict on one requirement.

    key : in the mission language
    limit : required value
    upper : whether it is an upper limit
    held : number of runs that keep it
    worst, run : the worst value, and its run
    kept : the value that the required number of runs keep
    written : whether the mission states it
    """

    key: Key
    limit: float
    upper: bool
    held: int
    worst: float
    run: int
    kept: float
    written: bool

    @property
    def unit(self) -> Unit:
        """Unit of its values."""
        return MEASURES[self.key].unit


def verdicts(runs: Sequence[Run], promise: RehearsalPromise) -> tuple[RequirementVerdict, ...]:
    """Return the verdicts on runs; that no drone touches anything is always required."""
    return tuple(_verdicts(runs, promise))


def held(runs: Sequence[Run], judged: Sequence[RequirementVerdict]) -> int:
    """Return the number of runs that keep all requirements."""
    return sum(all(_holds(each.key, run, each.limit) for each in judged) for run in runs)


def enough(runs: Sequence[Run], promise: RehearsalPromise) -> int:
    """Return the number of runs that must keep all requirements."""
    return ceil(promise.of * len(runs) - 1e-9)


def _verdicts(runs: Sequence[Run], promise: RehearsalPromise) -> Iterator[RequirementVerdict]:
    for key, measure in MEASURES.items():
        required = getattr(promise, key)
        if required is None and key != "clearance":
            continue
        limit = 0.0 if required is None else required
        values = [(measure.of(run), run.number) for run in runs]
        ordered = sorted(values, reverse=not measure.upper)  # from best to worst
        worst, number = ordered[-1]
        reached = ordered[enough(runs, promise) - 1][0]
        count = sum(_holds(key, run, limit) for run in runs)
        yield RequirementVerdict(
            key, limit, measure.upper, count, worst, number, reached, required is not None
        )


def _holds(key: Key, run: Run, limit: float) -> bool:
    measure = MEASURES[key]
    value = measure.of(run)
    return value <= limit if measure.upper else value >= limit or value == inf
