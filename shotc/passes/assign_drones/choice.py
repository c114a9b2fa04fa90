"""The choice itself, as a mixed-integer linear programme."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import combinations

import numpy as np

from shotc.passes.assign_drones.tasks import Task
from shotc.solvers.assignment import Programme, least_cost

Choice = Mapping[int, str]

LEAST_WAY = 1e-3  # seconds of work that a metre of way counts for
EARLIER = 1e-6  # by which a drone is preferred to those written after it
SLACK = 1e-6

Row = tuple[dict[int, float], float]


def choose(tasks: Sequence[Task], drones: Sequence[str]) -> Choice | None:
    """Return the drone of every task by its index, or None where there is no choice.

    The busiest drone has as little to do as can be, in seconds of film and of the ways there and back; of
    such choices the one with the least way is taken, then the one with the drones written first.
    """
    count = len(tasks) * len(drones)
    column = {(i, d): i * len(drones) + k for i, _ in enumerate(tasks) for k, d in enumerate(drones)}
    cost, highest = np.ones(count + 1), np.ones(count + 1)
    once = np.zeros((len(tasks), count + 1))
    highest[count] = np.inf
    for (i, d), c in column.items():
        cost[c] = LEAST_WAY * tasks[i].length(d) + EARLIER * drones.index(d)
        once[i, c] = 1.0
        highest[c] = float(_can(tasks[i], d))
    rows = [*_work(tasks, drones, column, count), *_clashes(tasks, drones, column)]
    matrix = np.zeros((len(rows), count + 1))
    for r, (terms, _) in enumerate(rows):
        for c, value in terms.items():
            matrix[r, c] = value
    most = np.array([bound for _, bound in rows])
    solution = least_cost(Programme(cost, highest, once, matrix, most, whole=count))
    if solution is None:
        return None
    chosen = solution[:count].reshape(len(tasks), len(drones)).argmax(axis=1)
    return {task.number: drones[k] for task, k in zip(tasks, chosen, strict=True)}


def _can(task: Task, drone: str) -> bool:
    """Tell whether a drone may film a shot at all: it is its own, in reach in time, and in its endurance."""
    if task.flown_by is not None:
        return task.flown_by == drone
    away = task.way(drone)
    if task.start is not None and away > task.start + SLACK:
        return False
    return away + task.duration + task.back(drone) <= task.drones[drone].endurance


def _work(
    tasks: Sequence[Task], drones: Sequence[str], column: Mapping[tuple[int, str], int], busiest: int
) -> Iterator[Row]:
    """Yield that no drone has more to do than the busiest one, whose work is the last unknown."""
    for d in drones:
        work = {
            column[i, d]: task.duration + 0.5 * (task.way(d) + task.back(d)) for i, task in enumerate(tasks)
        }
        yield {**work, busiest: -1.0}, 0.0


def _clashes(
    tasks: Sequence[Task], drones: Sequence[str], column: Mapping[tuple[int, str], int]
) -> Iterator[Row]:
    """Yield that no drone films two shots which it cannot get to one after the other."""
    for (i, a), (j, b) in combinations(enumerate(tasks), 2):
        if a.start is None or b.start is None:
            continue
        (k, first), (m, second) = ((i, a), (j, b)) if a.start <= b.start else ((j, b), (i, a))
        assert first.start is not None
        assert second.start is not None
        for d in drones:
            if first.start + first.duration + first.to(second, d) > second.start + SLACK:
                yield {column[k, d]: 1.0, column[m, d]: 1.0}, 1.0
