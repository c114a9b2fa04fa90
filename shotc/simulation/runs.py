"""Many runs of a plan, block by block on all cores.

A run depends on the seed and its own number alone, and blocks are the same however many processes there are.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from multiprocessing import get_context

from shotc.ir.trajectory import TrajectoryIR
from shotc.simulation.conditions import Conditions
from shotc.simulation.flight import Flown, fly_all
from shotc.simulation.judge import Run, judged
from shotc.simulation.shows import fly_fleets
from shotc.simulation.world import World

BLOCK = 25
"""Runs that are flown at once, as rows of arrays."""

Done = Callable[[int], None]
"""Called with the number of runs that are done."""


def simulated(ir: TrajectoryIR, conditions: Conditions, count: int, jobs: int, done: Done) -> tuple[Run, ...]:
    """Fly a plan ``count`` times, in so many processes at most, and judge every run."""
    blocks = [range(i, min(i + BLOCK, count)) for i in range(0, count, BLOCK)]
    found: list[Run] = []
    for runs in _each(ir, conditions, blocks, jobs):
        found += runs
        done(len(found))
    return tuple(sorted(found, key=lambda run: run.number))


def flown(ir: TrajectoryIR, conditions: Conditions, runs: Sequence[int]) -> tuple[World, tuple[Flown, ...]]:
    """Fly the cameras of a plan in the runs of these numbers, for what is drawn or written of them."""
    world = World.of(ir, conditions, runs)
    return world, fly_all(world, ir.drones)


def _each(
    ir: TrajectoryIR, conditions: Conditions, blocks: list[range], jobs: int
) -> Iterator[tuple[Run, ...]]:
    workers = min(jobs, len(blocks))
    if workers < 2:
        for block in blocks:
            yield _block(ir, conditions, block)
        return
    context = get_context("fork" if sys.platform == "linux" else "spawn")
    with ProcessPoolExecutor(workers, context) as pool:
        waiting = [pool.submit(_block, ir, conditions, block) for block in blocks]
        for each in as_completed(waiting):
            yield each.result()


def _block(ir: TrajectoryIR, conditions: Conditions, block: range) -> tuple[Run, ...]:
    fleets = fly_fleets(ir, conditions, block)
    if not ir.drones:
        return tuple(Run(number, (), (), courses) for number, courses in zip(block, fleets, strict=True))
    return judged(*_with_plan(ir, flown(ir, conditions, block)), fleets)


def _with_plan(
    ir: TrajectoryIR, of: tuple[World, tuple[Flown, ...]]
) -> tuple[World, TrajectoryIR, tuple[Flown, ...]]:
    return of[0], ir, of[1]
