"""A rehearsal: a plan flown in many runs, and what the mission asks of them."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from math import pi, radians
from typing import NamedTuple

import numpy as np

from shotc.geom.camera import yaw_of
from shotc.ir.mission import MissionIR
from shotc.ir.rehearsal import Loop, Receiver, Rehearsal, RehearsalPromise, VehicleName, Wind
from shotc.ir.trajectory import TrajectoryIR
from shotc.simulation import wind as air
from shotc.simulation.conditions import Conditions
from shotc.simulation.judge import Run
from shotc.simulation.runs import RunBlock, Strays
from shotc.simulation.sensors import GRADES
from shotc.simulation.truth import Truth
from shotc.simulation.verdict import RequirementVerdict, enough, held, verdicts
from shotc.spec.presets import RUN_COUNT

SILENT = Rehearsal(
    RehearsalPromise(), path=(), runs=RUN_COUNT, loop="replay", wind=None, gusts=0.0, gps="rtk", wander=0.0
)
"""What is asked of the rehearsals of a mission that says nothing of them."""


class RehearsalOptions(NamedTuple):
    """What a command line says in the place of the mission; None leaves it to the mission.

    wind : of the steady wind, m/s; bearing : compass bearing that it comes from, deg; gusts : m/s
    gps : a name of GRADES; bias : offset of all positions to the East, m
    lost : stretches without satellite positions, s; wander : m
    """

    loop: Loop | None = None
    runs: int | None = None
    wind: float | None = None
    bearing: float | None = None
    gusts: float | None = None
    gps: Receiver | None = None
    bias: float = 0.0
    lost: tuple[tuple[float, float], ...] = ()
    wander: float | None = None
    truth: Truth = Truth()
    seed: int = 1
    replanner: str = "ours"
    vehicle: VehicleName = "lag"


@dataclass(frozen=True, slots=True, eq=False)
class Rehearsed:
    """What came of a rehearsal.

    held, needed : in how many runs all that is asked holds, and in how many it has to
    strays : of cameras over time, None for shows
    """

    ir: TrajectoryIR
    conditions: Conditions
    promise: RehearsalPromise
    runs: tuple[Run, ...]
    verdicts: tuple[RequirementVerdict, ...]
    held: int
    needed: int
    strays: Strays | None

    @property
    def mission(self) -> MissionIR:
        """The mission that was flown."""
        return self.ir.keyframes.mission

    @property
    def worst(self) -> Run:
        """The worst of the runs."""
        return min(self.runs, key=lambda run: run.merit)

    def run(self, number: int) -> Run:
        """Return the run of a number."""
        return next(run for run in self.runs if run.number == number)

    @property
    def kept(self) -> bool:
        """Whether enough runs keep all that is asked."""
        return self.held >= self.needed


def conditions_of(mission: MissionIR, asked: RehearsalOptions) -> Conditions:
    """Return the conditions that a mission and a command line ask for."""
    usual = mission.rehearsal or SILENT
    wind = usual.wind or Wind(mission.wind, mission.wind_toward)
    return Conditions(
        loop=asked.loop or usual.loop,
        wind=air.WindField(
            speed=_either(asked.wind, wind.speed),
            toward=wind.toward if asked.bearing is None else yaw_of(radians(asked.bearing) + pi),
            gusts=_either(asked.gusts, usual.gusts),
        ),
        gps=replace(GRADES[asked.gps or usual.gps], offset=(asked.bias, 0.0, 0.0), lost=asked.lost),
        truth=replace(asked.truth, wander=_either(asked.wander, usual.wander)),
        seed=asked.seed,
        replanner=asked.replanner,
        vehicle=asked.vehicle,
    )


def _either(asked: float | None, usual: float) -> float:
    return usual if asked is None else asked


def runs_of(ir: TrajectoryIR, conditions: Conditions, asked: RehearsalOptions) -> int:
    """Return how many runs a mission and a command line ask for: one where nothing differs between runs."""
    if alike(ir, conditions):
        return 1
    return asked.runs or (ir.keyframes.mission.rehearsal or SILENT).runs


def alike(ir: TrajectoryIR, conditions: Conditions) -> bool:
    """Tell whether all runs are the same: of what fleets meet gusts alone are drawn."""
    return not ir.drones and not conditions.wind.gusts


def rehearse(
    ir: TrajectoryIR, conditions: Conditions, blocks: Iterable[RunBlock], done: Callable[[int], None]
) -> Rehearsed:
    """Judge runs by what the mission of their plan asks.

    blocks : of all runs, in any order; done : called with how many runs have come
    """
    promise = (ir.keyframes.mission.rehearsal or SILENT).promise
    found: list[RunBlock] = []
    for block in blocks:
        found.append(block)
        done(sum(len(each.runs) for each in found))
    found.sort(key=lambda block: block.runs[0].number)
    runs = tuple(run for block in found for run in block.runs)
    told = verdicts(runs, promise)
    kept, needed = held(runs, told), enough(runs, promise)
    return Rehearsed(ir, conditions, promise, runs, told, kept, needed, _together(found))


def _together(blocks: list[RunBlock]) -> Strays | None:
    every = [block.strays for block in blocks if block.strays is not None]
    if not every:
        return None
    return Strays(every[0].times, np.concatenate([each.metres for each in every], axis=1))
