"""The choice of drones as a mixed-integer linear programme."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import combinations

import numpy as np

from shotc.passes.assign_drones.tasks import ShotTask
from shotc.solvers.assignment import AssignmentProgramme, least_cost

Choice = Mapping[int, str]

WORK_PER_METRE_S = 1e-3  # seconds of work per metre of distance
EARLIER_COST = 1e-6  # preference of a drone over those written after it
SAME_TIME_S = 1e-6

Row = tuple[dict[int, float], float]


def choose(tasks: Sequence[ShotTask], drones: Sequence[str]) -> Choice | None:
    """Return the drone of every task by the task's index; None if infeasible.

    As few shots as possible get a drone that cannot film them as they are asked. Among such choices the work
    of the busiest drone is minimal, in seconds of film and transfers. Then the least distance is taken, then
    the drones written first.
    """
    programme = _programme(tasks, drones)
    refused = np.zeros(len(programme.cost))
    refused[:-1] = [d in task.refused for task in tasks for d in drones]
    if refused.any():
        fewest = least_cost(replace(programme, cost=refused))
        if fewest is None:
            return None
        rows = np.vstack([programme.rows, refused])
        programme = replace(programme, rows=rows, most=np.append(programme.most, np.rint(refused @ fewest)))
    solution = least_cost(programme)
    if solution is None:
        return None
    chosen = solution[:-1].reshape(len(tasks), len(drones)).argmax(axis=1)
    return {task.number: drones[k] for task, k in zip(tasks, chosen, strict=True)}


def _programme(tasks: Sequence[ShotTask], drones: Sequence[str]) -> AssignmentProgramme:
    """Return the choice of the least work: one unknown for each task and drone, then the work of the busiest
    drone.
    """
    count = len(tasks) * len(drones)
    column = {(i, d): i * len(drones) + k for i, _ in enumerate(tasks) for k, d in enumerate(drones)}
    cost, highest = np.ones(count + 1), np.ones(count + 1)
    once = np.zeros((len(tasks), count + 1))
    highest[count] = np.inf
    for (i, d), c in column.items():
        cost[c] = WORK_PER_METRE_S * tasks[i].length(d) + EARLIER_COST * drones.index(d)
        once[i, c] = 1.0
        highest[c] = float(_can(tasks[i], d))
    rows = [*_work(tasks, drones, column, count), *_clashes(tasks, drones, column)]
    matrix = np.zeros((len(rows), count + 1))
    for r, (terms, _) in enumerate(rows):
        for c, value in terms.items():
            matrix[r, c] = value
    most = np.array([bound for _, bound in rows])
    return AssignmentProgramme(cost, highest, once, matrix, most, whole=count)


def _can(task: ShotTask, drone: str) -> bool:
    """Return whether a drone can film a shot at all: by assignment, in time, and within its endurance."""
    if task.flown_by is not None:
        return task.flown_by == drone
    travel = task.travel_time(drone)
    if task.start is not None and travel > task.start + SAME_TIME_S:
        return False
    return travel + task.duration + task.back(drone) <= task.drones[drone].endurance


def _work(
    tasks: Sequence[ShotTask], drones: Sequence[str], column: Mapping[tuple[int, str], int], busiest: int
) -> Iterator[Row]:
    """Yield the constraints that no drone works more than the busiest one, whose work is the last unknown."""
    for d in drones:
        work = {
            column[i, d]: task.duration + 0.5 * (task.travel_time(d) + task.back(d))
            for i, task in enumerate(tasks)
        }
        yield {**work, busiest: -1.0}, 0.0


def _clashes(
    tasks: Sequence[ShotTask], drones: Sequence[str], column: Mapping[tuple[int, str], int]
) -> Iterator[Row]:
    """Yield the constraints that no drone films two shots between which it has too little time."""
    for (i, a), (j, b) in combinations(enumerate(tasks), 2):
        if a.start is None or b.start is None:
            continue
        (k, first), (m, second) = ((i, a), (j, b)) if a.start <= b.start else ((j, b), (i, a))
        assert first.start is not None
        assert second.start is not None
        for d in drones:
            if first.start + first.duration + first.to(second, d) > second.start + SAME_TIME_S:
                yield {column[k, d]: 1.0, column[m, d]: 1.0}, 1.0
