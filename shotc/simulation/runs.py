"""Simulates many runs of a plan, block by block on all cores.

A run depends only on the seed and its number. The blocks do not depend on the number of processes.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from shotc.geom.bernstein import Array
from shotc.ir.trajectory import TrajectoryIR
from shotc.parallel import Hands, as_done
from shotc.simulation.conditions import Conditions
from shotc.simulation.flight import DroneRuns, fly_all
from shotc.simulation.judge import Run, judged
from shotc.simulation.shows import fly_fleets
from shotc.simulation.world import World, at_times

BLOCK_RUNS = 25
"""Runs of cameras that are simulated together as rows of arrays; fleets are simulated run by run."""

STRAYS_S = 0.2
"""Seconds between the samples of ``Strays``."""


@dataclass(frozen=True, slots=True, eq=False)
class Strays:
    """The largest stray of all drones at times (F,), seconds, in each run, (F, R), metres."""

    times: Array
    metres: Array


@dataclass(frozen=True, slots=True, eq=False)
class RunBlock:
    """Runs that were simulated together.

    strays : None for shows
    """

    runs: tuple[Run, ...]
    strays: Strays | None


def simulated(
    ir: TrajectoryIR, conditions: Conditions, count: int, hands: Hands, earlier: Sequence[RunBlock] = ()
) -> Iterator[RunBlock]:
    """Yield blocks of judged runs of a plan as they finish, ``count`` runs in total.

    earlier : finished blocks; those that fit the requested number of runs are not simulated again
    """
    size = 1 if ir.fleets else BLOCK_RUNS
    needed = {i: range(i, min(i + size, count)) for i in range(0, count, size)}
    for block in earlier:
        first = block.runs[0].number
        if [run.number for run in block.runs] == list(needed.get(first, ())):
            del needed[first]
            yield block
    yield from as_done(partial(fly_block, ir, conditions), list(needed.values()), hands)


def flown(
    ir: TrajectoryIR, conditions: Conditions, runs: Sequence[int]
) -> tuple[World, tuple[DroneRuns, ...]]:
    """Return the world and the cameras' flights in the runs with these numbers, for drawings and files."""
    world = World.of(ir, conditions, runs)
    return world, fly_all(world, ir.drones)


def fly_block(ir: TrajectoryIR, conditions: Conditions, block: range) -> RunBlock:
    """Return the judged runs of a plan with these numbers."""
    if not ir.drones:
        fleets = fly_fleets(ir, conditions, block)
        runs = tuple(Run(number, (), (), *each) for number, each in zip(block, fleets, strict=True))
        return RunBlock(runs, None)
    world, tracks = flown(ir, conditions, block)
    fleets = fly_fleets(ir, conditions, block, tracks)
    return RunBlock(judged(world, ir, tracks, fleets), _strays(ir, world, tracks))


def _strays(ir: TrajectoryIR, world: World, tracks: tuple[DroneRuns, ...]) -> Strays:
    times = np.arange(0.0, float(world.times[-1]), STRAYS_S)
    off = [
        np.linalg.norm(at_times(each.position, each.times, times) - track.curve(times)[:, None, :3], axis=2)
        for each, track in zip(tracks, ir.drones, strict=True)
    ]
    return Strays(times, np.max(off, axis=0))
