"""Many runs of a plan, block by block on all cores.

A run depends on the seed and its own number alone, and blocks are the same however many processes there are.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import dataclass
from multiprocessing import get_context

import numpy as np

from shotc.geom.bernstein import Array
from shotc.ir.trajectory import TrajectoryIR
from shotc.simulation.conditions import Conditions
from shotc.simulation.flight import Flown, fly_all
from shotc.simulation.judge import Run, judged
from shotc.simulation.shows import fly_fleets
from shotc.simulation.world import World, at_times

BLOCK = 25
"""Runs that are flown at once, as rows of arrays."""

STRAYS_S = 0.2
"""Seconds between the instants of ``Strays``."""

Done = Callable[[int], None]
"""Called with the number of runs that are done."""


@dataclass(frozen=True, slots=True, eq=False)
class Strays:
    """How far the farthest drone is from its plan: at times (F,), s, in each run, (F, R), metres."""

    times: Array
    metres: Array


@dataclass(frozen=True, slots=True, eq=False)
class Block:
    """Runs that were flown together; strays : None for shows."""

    runs: tuple[Run, ...]
    strays: Strays | None


def simulated(
    ir: TrajectoryIR, conditions: Conditions, count: int, jobs: int, done: Done
) -> tuple[Block, ...]:
    """Fly a plan ``count`` times, in so many processes at most, and judge every run."""
    blocks = [range(i, min(i + BLOCK, count)) for i in range(0, count, BLOCK)]
    found: dict[int, Block] = {}
    for block in _each(ir, conditions, blocks, jobs):
        found[block.runs[0].number] = block
        done(sum(len(each.runs) for each in found.values()))
    return tuple(found[first] for first in sorted(found))


def flown(ir: TrajectoryIR, conditions: Conditions, runs: Sequence[int]) -> tuple[World, tuple[Flown, ...]]:
    """Fly the cameras of a plan in the runs of these numbers, for what is drawn or written of them."""
    world = World.of(ir, conditions, runs)
    return world, fly_all(world, ir.drones)


def _each(ir: TrajectoryIR, conditions: Conditions, blocks: list[range], jobs: int) -> Iterator[Block]:
    workers = min(jobs, len(blocks))
    if workers < 2:
        yield from (_block(ir, conditions, block) for block in blocks)
        return
    context = get_context("fork" if sys.platform == "linux" else "spawn")
    with ProcessPoolExecutor(workers, context) as pool:
        waiting = [pool.submit(_block, ir, conditions, block) for block in blocks]
        yield from (each.result() for each in as_completed(waiting))


def _block(ir: TrajectoryIR, conditions: Conditions, block: range) -> Block:
    fleets = fly_fleets(ir, conditions, block)
    if not ir.drones:
        runs = tuple(Run(number, (), (), each) for number, each in zip(block, fleets, strict=True))
        return Block(runs, None)
    world, tracks = flown(ir, conditions, block)
    return Block(judged(world, ir, tracks, fleets), _strays(ir, world, tracks))


def _strays(ir: TrajectoryIR, world: World, tracks: tuple[Flown, ...]) -> Strays:
    times = np.arange(0.0, float(world.times[-1]), STRAYS_S)
    off = [
        np.linalg.norm(at_times(each.position, each.times, times) - track.curve(times)[:, None, :3], axis=2)
        for each, track in zip(tracks, ir.drones, strict=True)
    ]
    return Strays(times, np.max(off, axis=0))
