"""solve-path-qp: keyframes to geometry, KeyframeIR -> PathIR.

Takes keyframes with their camera angles; gives, for every drone, all legs of its flight as curves
q(s), each from rest to rest, joined end to end. Guarantees: every leg but take-off and landing is
proved (by Bernstein hulls) to keep all clearances, camera pitch and gimbal yaw stay in range, and
keyframes that the user placed are passed exactly.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from shotc.diag.model import Diagnostic
from shotc.diag.registry import has_errors
from shotc.ir.keyframes import KeyframeIR
from shotc.ir.mission import Drone
from shotc.ir.path import Deviation, DronePath, Leg, PathIR
from shotc.passes.base import Outcome, PassContext
from shotc.passes.solve_path_qp.faults import (
    cut_framing,
    failure,
    follow_camera_impossible,
    moved,
    pad_blocked,
    swings,
)
from shotc.passes.solve_path_qp.legs import Flight, drone_legs
from shotc.passes.solve_path_qp.pad import PadBlocked, transit_point
from shotc.passes.solve_path_qp.room import flight_room, pad_room
from shotc.passes.solve_path_qp.shots import ShotCurve, shot_curve
from shotc.solvers.headings import DEFAULT


@dataclass(frozen=True, slots=True)
class _Planned:
    """One drone's share of the result; ``legs`` is empty where an error stopped it."""

    legs: tuple[Leg, ...]
    deviations: tuple[Deviation, ...]
    stats: tuple[tuple[str, float | str], ...]
    diagnostics: tuple[Diagnostic, ...]


@dataclass(frozen=True, slots=True)
class SolvePathQp:
    """The geometry stage."""

    name: ClassVar[str] = "solve-path-qp"

    def run(self, ir: KeyframeIR, ctx: PassContext) -> Outcome[PathIR]:
        """Plan every drone's path, in order of priority."""
        paths: list[DronePath] = []
        deviations: list[Deviation] = []
        stats: list[tuple[str, float | str]] = []
        diagnostics: list[Diagnostic] = []
        for drone in sorted(ir.mission.drones, key=lambda d: (d.priority, d.name)):
            planned = _plan(ir, drone, ctx)
            diagnostics += planned.diagnostics
            deviations += planned.deviations
            stats += planned.stats
            if planned.legs:
                paths.append(DronePath(drone.name, planned.legs))
        if has_errors(diagnostics):
            return Outcome(None, tuple(diagnostics))
        return Outcome(PathIR(ir, tuple(paths), tuple(deviations), tuple(stats)), tuple(diagnostics))


def _plan(ir: KeyframeIR, drone: Drone, ctx: PassContext) -> _Planned:
    mission = ir.mission
    mine = [placed for placed in ir.shots if placed.shot.drone == drone.name]
    if not mine:
        return _Planned((), (), (), ())
    if drone.body == "follow-camera" and not drone.gimbal.yaw[0] <= 0.0 <= drone.gimbal.yaw[1]:
        return _stopped(follow_camera_impossible(mission, drone))
    room = flight_room(mission, drone)
    top = transit_point(room, pad_room(mission, drone), drone)
    faults = [pad_blocked(mission, drone, top)] if isinstance(top, PadBlocked) else []
    shots: list[ShotCurve] = []
    for placed in mine:
        ctx.progress(f"path of shot {placed.shot.id}")
        result = shot_curve(mission, drone, room, placed, ctx.headings or DEFAULT)
        if isinstance(result, ShotCurve):
            shots.append(result)
        else:
            faults.append(failure(mission, drone, room, placed, result))
    if faults or isinstance(top, PadBlocked):
        return _stopped(*faults)
    warnings = [
        *(moved(mission, s.shot, d) for s in shots for d in s.deviations),
        *(cut_framing(mission, drone, s.shot, s.cuts) for s in shots if s.cuts),
        *(swings(mission, s.shot, s.swing) for s in shots if s.swing is not None),
    ]
    ctx.progress(f"way of {drone.name}")
    joined = drone_legs(Flight(drone, room, top), shots)
    if not isinstance(joined[0], Leg):
        what, before = joined
        return _stopped(*warnings, failure(mission, drone, room, before.shot if before else None, what))
    deviations = tuple(d for s in shots for d in s.deviations)
    return _Planned(joined, deviations, tuple(x for s in shots for x in s.stats), tuple(warnings))


def _stopped(*diagnostics: Diagnostic) -> _Planned:
    return _Planned((), (), (), diagnostics)
