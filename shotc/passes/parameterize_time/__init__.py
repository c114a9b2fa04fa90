"""parameterize-time: PathIR to TrajectoryIR.

It takes q(s) of every leg with its stops, marks and deadlines. It gives quintics over mission time, C2, at
rest at every stop, and within every limit at every instant (their own control points prove it). They meet the
durations, keyframe times and starts that the mission fixes; the rest is as fast as its pace of the limits
allows. An infeasible deadline is an error that states a feasible one.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import partial
from math import isfinite
from typing import ClassVar

from shotc.diag.model import Diagnostic
from shotc.geom.bernstein import concatenate, lift_off
from shotc.ir.drone import Drone
from shotc.ir.mission import MissionIR
from shotc.ir.passes import Outcome, PassContext
from shotc.ir.path import ClockLeg, DronePath, HoldLeg, Leg, PathIR, PathLeg, TimedPath
from shotc.ir.trajectory import TrajectoryIR
from shotc.passes.parameterize_time.explain.binding import binding
from shotc.passes.parameterize_time.explain.times import (
    TimeRemedies,
    endurance_exceeded,
    roughly_timed,
    start_too_early,
    too_fast,
    without_length,
)
from shotc.planning.timing.flight import TrajectoryBuilder
from shotc.planning.timing.leg import SHORTEST_HOLD_S
from shotc.planning.timing.limits import ceiling_of
from shotc.planning.timing.move import TimedMove
from shotc.planning.timing.timed_leg import LegTiming, can_be_timed, time_leg

Stats = list[tuple[str, float | str]]


@dataclass(frozen=True, slots=True)
class ParameterizeTime:
    """The pass; it has no options."""

    name: ClassVar[str] = "parameterize-time"

    def run(self, ir: PathIR, ctx: PassContext) -> Outcome[TrajectoryIR]:
        """Time every leg of every drone.

        A shot that waits for one of another drone is timed after it, so the drones alternate. Raises
        ValueError if shots wait for each other in a circle, which ``check`` refuses.
        """
        paths: tuple[DronePath | TimedPath, ...] = (*ir.drones, *ir.timed)
        pilots = [_LegTimer(ir.keyframes.mission, path, ctx) for path in paths]
        ends: dict[str, float] = {}
        while any(pilot.advance(ends) for pilot in pilots):
            pass
        if any(pilot.done < len(pilot.path.legs) for pilot in pilots):
            raise ValueError("shots wait for each other in a circle")
        faults = [d for pilot in pilots for d in pilot.faults]
        if faults:
            return Outcome(None, tuple(faults))
        stats = tuple(entry for pilot in pilots for entry in pilot.stats)
        drones = tuple(pilot.flight.trajectory() for pilot in pilots if pilot.path.legs)
        warnings = tuple(d for pilot in pilots for d in pilot.warnings)
        return Outcome(TrajectoryIR(ir.keyframes, drones, ir.deviations, (*ir.stats, *stats)), warnings)


@dataclass(slots=True)
class _LegTimer:
    """Times the legs of one drone in order, as far as the ends of the shots that it waits for are known."""

    mission: MissionIR
    path: DronePath | TimedPath
    ctx: PassContext
    faults: list[Diagnostic] = field(default_factory=list)
    warnings: list[Diagnostic] = field(default_factory=list)
    stats: Stats = field(default_factory=list)
    done: int = 0
    flight: TrajectoryBuilder = field(init=False)
    drone: Drone = field(init=False)

    def __post_init__(self) -> None:
        self.flight = TrajectoryBuilder(self.path.drone)
        self.drone = self.mission.drone(self.path.drone)

    def advance(self, ends: dict[str, float]) -> bool:
        """Time the next legs and return whether there were any; ends : of the shots so far, extended."""
        before = self.done
        while self.done < len(self.path.legs):
            leg = self.path.legs[self.done]
            waits = self._waits(leg)
            if waits is not None and waits not in ends:
                break
            if isinstance(leg, ClockLeg):
                self._film(leg, ends.get(waits or "", 0.0))
                ends[leg.shot] = leg.end
            else:
                self._fly(leg, ends.get(waits or "", 0.0))
                if leg.shot is not None:
                    ends[leg.shot] = self.flight.clock
            self.done += 1
            if self.done == len(self.path.legs) and not self.faults:
                self._check_endurance()
        return self.done > before

    def _film(self, leg: ClockLeg, ready: float) -> None:
        """Add a shot on its own clock, and an error if the drone is late for it."""
        first = float(leg.curve.start)
        earliest = max(self.flight.clock, ready - (leg.start - first))
        if first < earliest - SHORTEST_HOLD_S and not self.faults:
            lead = leg.start - first
            before = tuple(self.flight.phases)
            self.faults.append(start_too_early(self.mission, leg, leg.start, earliest + lead, before))
        self.flight.wait(first, leg.pose)
        self.flight.film(leg)

    def _waits(self, leg: Leg) -> str | None:
        return next((s.timing.after for s in self.mission.shots if s.id == leg.shot), None)

    def _fly(self, leg: PathLeg, ready: float) -> None:
        name = f"shot {leg.shot}" if leg.shot else f"{self.path.drone} {leg.phase} {self.done}"
        self.ctx.progress(f"timing {name}")
        timing = time_leg(leg, ceiling_of(self.drone))
        motion, fault = timing.motion, _fault(self.mission, self.drone, leg, timing)
        if fault is not None:
            self.faults.append(fault)
        earliest = max(self.flight.clock, ready)
        if leg.start is not None and leg.start < earliest - SHORTEST_HOLD_S and not self.faults:
            before = tuple(self.flight.phases)
            self.faults.append(start_too_early(self.mission, leg, leg.start, earliest, before))
        self.flight.wait(max(earliest, leg.start or 0.0), leg.pose)
        if motion is not None:
            self.flight.fly(leg, motion)
            rough = next((move.held for move in motion.moves if move.held), None)
            if rough is not None:
                self.warnings.append(roughly_timed(self.mission, self.drone, leg, rough))
            self.stats += [
                entry for i, m in enumerate(motion.moves) for entry in _stats(f"{name} move {i}", m)
            ]

    def _check_endurance(self) -> None:
        waited = lift_off(concatenate(self.flight.curves))
        if self.flight.clock - waited > self.drone.endurance:
            first, *others = self.flight.phases
            phases = (replace(first, start=first.start + waited), *others)
            self.faults.append(endurance_exceeded(self.mission, self.drone, phases))


def _fault(mission: MissionIR, drone: Drone, leg: PathLeg, timing: LegTiming) -> Diagnostic | None:
    """Return the error of infeasible deadlines of a leg, or None."""
    if timing.motion is None and leg.shot is not None:
        return without_length(mission, leg)
    if timing.too_fast is None or isinstance(leg, HoldLeg):
        return None
    remedies = TimeRemedies(binding(leg, timing.fast, ceiling_of(drone)), partial(can_be_timed, leg))
    return too_fast(mission, drone, leg, timing.too_fast, remedies)


def _stats(name: str, move: TimedMove) -> Stats:
    return [
        (f"{name} topp_time", move.topp_time if isfinite(move.topp_time) else "none"),
        (f"{name} time", move.duration),
        (f"{name} scale", move.scale),
        (f"{name} steps", float(move.steps)),
        (f"{name} cells", float(move.cells)),
    ]
