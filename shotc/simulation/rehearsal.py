"""A rehearsal: a plan simulated in many runs, judged by the mission's requirements."""

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
from shotc.simulation.outages import Outage
from shotc.simulation.runs import RunBlock, Strays
from shotc.simulation.sensors import GRADES
from shotc.simulation.truth import Truth
from shotc.simulation.verdict import RequirementVerdict, enough, held, verdicts
from shotc.spec.presets import RUN_COUNT

UNSTATED = Rehearsal(
    RehearsalPromise(), path=(), runs=RUN_COUNT, loop="replay", wind=None, gusts=0.0, gps="rtk", wander=0.0
)
"""The rehearsal of a mission that states none."""


class RehearsalOptions(NamedTuple):
    """The command line's options, which override the mission; None leaves the mission's value.

    wind : speed of the steady wind, m/s
    bearing : compass bearing from which it blows, degrees
    gusts : standard deviation, m/s
    gps : a name of GRADES
    bias : offset of all positions to the East, metres
    outages : when satellite positions are lost
    wander : standard deviation of the targets from their tracks, metres
    """

    loop: Loop | None = None
    runs: int | None = None
    wind: float | None = None
    bearing: float | None = None
    gusts: float | None = None
    gps: Receiver | None = None
    bias: float = 0.0
    outages: tuple[Outage, ...] = ()
    wander: float | None = None
    truth: Truth = Truth()
    seed: int = 1
    replanner: str = "ours"
    vehicle: VehicleName = "lag"


@dataclass(frozen=True, slots=True, eq=False)
class Rehearsed:
    """The result of a rehearsal.

    held, needed : number of runs that keep all requirements, and the number that must
    strays : distances of the drones from their plans over time; None for shows
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
        """The simulated mission."""
        return self.ir.keyframes.mission

    @property
    def worst(self) -> Run:
        """The worst run."""
        return min(self.runs, key=lambda run: run.merit)

    def run(self, number: int) -> Run:
        """Return the run with a number."""
        return next(run for run in self.runs if run.number == number)

    @property
    def kept(self) -> bool:
        """Whether enough runs keep all requirements."""
        return self.held >= self.needed


def conditions_of(mission: MissionIR, options: RehearsalOptions) -> Conditions:
    """Return the conditions of a mission and a command line."""
    stated = mission.rehearsal or UNSTATED
    wind = stated.wind or Wind(mission.wind, mission.wind_toward)
    return Conditions(
        loop=options.loop or stated.loop,
        wind=air.WindField(
            speed=_either(options.wind, wind.speed),
            toward=wind.toward if options.bearing is None else yaw_of(radians(options.bearing) + pi),
            gusts=_either(options.gusts, stated.gusts),
        ),
        gps=replace(GRADES[options.gps or stated.gps], offset=(options.bias, 0.0, 0.0)),
        outages=options.outages,
        truth=replace(options.truth, wander=_either(options.wander, stated.wander)),
        seed=options.seed,
        replanner=options.replanner,
        vehicle=options.vehicle,
    )


def _either(given: float | None, stated: float) -> float:
    return stated if given is None else given


def runs_of(ir: TrajectoryIR, conditions: Conditions, options: RehearsalOptions) -> int:
    """Return the number of runs of a mission and a command line; one if all runs are equal."""
    if alike(ir, conditions):
        return 1
    return options.runs or (ir.keyframes.mission.rehearsal or UNSTATED).runs


def alike(ir: TrajectoryIR, conditions: Conditions) -> bool:
    """Return whether all runs are equal: for fleets only gusts are random."""
    return not ir.drones and not conditions.wind.gusts


def rehearse(
    ir: TrajectoryIR, conditions: Conditions, blocks: Iterable[RunBlock], finished: Callable[[int], None]
) -> Rehearsed:
    """Return the rehearsal: all runs judged by the mission's requirements.

    blocks : of all runs, in any order
    finished : called with the number of finished runs
    """
    promise = (ir.keyframes.mission.rehearsal or UNSTATED).promise
    flown: list[RunBlock] = []
    for block in blocks:
        flown.append(block)
        finished(sum(len(each.runs) for each in flown))
    flown.sort(key=lambda block: block.runs[0].number)
    runs = tuple(run for block in flown for run in block.runs)
    verdicts_of_runs = verdicts(runs, promise)
    fulfilled, needed = held(runs, verdicts_of_runs), enough(runs, promise)
    return Rehearsed(ir, conditions, promise, runs, verdicts_of_runs, fulfilled, needed, _together(flown))


def _together(blocks: list[RunBlock]) -> Strays | None:
    every = [block.strays for block in blocks if block.strays is not None]
    if not every:
        return None
    return Strays(every[0].times, np.concatenate([each.metres for each in every], axis=1))
