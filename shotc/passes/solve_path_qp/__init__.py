"""solve-path-qp: keyframes to geometry, KeyframeIR -> PathIR.

It takes keyframes with their camera angles. For every drone it gives all legs of its flight as curves q(s),
each from rest to rest, joined end to end. It guarantees that every leg except take-off and landing is proved
(by Bernstein hulls) to keep all clearances, that camera pitch and gimbal yaw stay in range, and that
keyframes placed by the user are passed exactly.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import ClassVar, NamedTuple

from shotc.diag.model import Diagnostic
from shotc.diag.registry import has_errors
from shotc.ir.drone import Drone
from shotc.ir.keyed import is_keyed
from shotc.ir.keyframes import KeyframeIR, PlacedShot
from shotc.ir.mission import MissionIR
from shotc.ir.pace import on_clock
from shotc.ir.passes import Outcome, PassContext
from shotc.ir.path import CORNERS, ClockLeg, Deviation, DronePath, Leg, PathIR, PathLeg, TimedPath
from shotc.ir.trajectory import DroneTrajectory
from shotc.passes.place_keyframes.keyed import misplaced
from shotc.passes.solve_path_qp.explain.on_clock import left_places, stopped_on_clock
from shotc.passes.solve_path_qp.explain.path import (
    cut_framing,
    failure,
    follow_camera_impossible,
    moved,
    pad_blocked,
    swings,
)
from shotc.passes.solve_path_qp.explain.schedule import out_of_turn, outside_track, too_late, way_met
from shotc.planning.clock.flights import crosswise, settled
from shotc.planning.clock.itinerary import Itinerary
from shotc.planning.clock.later_films import later_films
from shotc.planning.clock.moving import moving_targets, other_drones
from shotc.planning.clock.remedy import beside_meshes
from shotc.planning.clock.shot import NoMotion, OtherVehicles
from shotc.planning.clock.starts import ClockFailure, Meets, OutsideTrack, TooLate
from shotc.planning.clock.visibility import visibility_of
from shotc.planning.framing.moments import placed_at
from shotc.planning.free_space import FreeSpace
from shotc.planning.obstacles import free_spaces_of, pad_space
from shotc.planning.path.legs import BlockedWay, LegContext, drone_legs
from shotc.planning.path.pad import PadBlocked, transit_point
from shotc.planning.path.shots import PlannedShot, shot_curve
from shotc.solvers.headings import DEFAULT


@dataclass(frozen=True, slots=True)
class _Planned:
    """The result of one drone; ``legs`` is empty after an error."""

    legs: tuple[Leg, ...]
    deviations: tuple[Deviation, ...]
    stats: tuple[tuple[str, float | str], ...]
    diagnostics: tuple[Diagnostic, ...]


class _Ordered(NamedTuple):
    """The result of all drones in one order; stopped : the first drone without a feasible flight, if any."""

    path: PathIR | None
    diagnostics: tuple[Diagnostic, ...]
    stopped: Drone | None


class _EarlierDrones(NamedTuple):
    """The data that one drone passes on to the next.

    durations : of shots, as in the pass
    ends : mission times at which shots end, by id
    flights : those planned so far, by drone
    """

    durations: Mapping[str, float]
    ends: dict[str, float]
    flights: dict[str, DroneTrajectory]


@dataclass(frozen=True, slots=True)
class SolvePathQp:
    """The geometry pass.

    durations : seconds, by shot id, for shots whose duration the mission leaves free
    """

    durations: Mapping[str, float] = field(default_factory=dict)
    name: ClassVar[str] = "solve-path-qp"

    def run(self, ir: KeyframeIR, ctx: PassContext) -> Outcome[PathIR]:
        """Plan every drone's path, in order of priority.

        If a drone finds no feasible flight beside those before it, it is planned before them, provided that
        all are feasible then.
        """
        order = _after_needs(ir, sorted(ir.mission.drones, key=lambda d: (d.priority, d.name)))
        planned = first = self._in_order(ir, order, ctx)
        moved = set[str]()
        while (stopped := planned.stopped) is not None and stopped.name not in moved:
            moved.add(stopped.name)
            before, order = order, _earlier(ir, order, stopped)
            if order == before:
                break
            planned = self._in_order(ir, order, ctx, whole=False)
        if planned.path is None:
            return Outcome(None, first.diagnostics)
        swapped = () if first.stopped is None else out_of_turn(ir.mission, order, first.diagnostics)
        return Outcome(planned.path, (*swapped, *planned.diagnostics))

    def _in_order(
        self, ir: KeyframeIR, order: Sequence[Drone], ctx: PassContext, *, whole: bool = True
    ) -> _Ordered:
        """Plan drones one after the other; whole : whether the others are planned after one fails."""
        ends: dict[str, float] = {}
        once = partial(self._once, ir, order, ctx, ends, whole)
        return settled(once, ends, crosswise(ir.mission, [drone.name for drone in order]))

    def _once(
        self, ir: KeyframeIR, order: Sequence[Drone], ctx: PassContext, ends: dict[str, float], whole: bool
    ) -> _Ordered:
        """Plan drones one after the other with the ends of shots that are known, which are extended."""
        paths: list[DronePath] = []
        timed: list[TimedPath] = []
        known = _EarlierDrones(self.durations, ends, {})
        deviations: list[Deviation] = []
        stats: list[tuple[str, float | str]] = []
        diagnostics: list[Diagnostic] = []
        stopped: Drone | None = None
        for drone in order:
            planned = _plan(ir, drone, ctx, known)
            diagnostics += planned.diagnostics
            deviations += planned.deviations
            stats += planned.stats
            if has_errors(planned.diagnostics):
                stopped = stopped or drone
                if not whole:
                    break
            elif planned.legs and on_clock(ir):
                timed.append(TimedPath(drone.name, planned.legs))
            elif planned.legs:
                legs = tuple(leg for leg in planned.legs if isinstance(leg, PathLeg))
                paths.append(DronePath(drone.name, legs))
        diagnostics += _placed_late(ir, timed)
        if has_errors(diagnostics):
            return _Ordered(None, tuple(diagnostics), stopped)
        path = PathIR(ir, tuple(paths), tuple(deviations), tuple(stats), tuple(timed))
        return _Ordered(path, tuple(diagnostics), None)


def _placed_late(ir: KeyframeIR, timed: Sequence[TimedPath]) -> list[Diagnostic]:
    """Return the faults of keyframes whose picture depends on the start that planning chose."""
    placed, diagnostics = {p.shot.id: p for p in ir.shots if is_keyed(p.shot)}, list[Diagnostic]()
    for leg in (leg for path in timed for leg in path.legs if isinstance(leg, ClockLeg)):
        if leg.shot in placed:
            shot = placed_at(ir.mission, placed[leg.shot], leg.start)
            diagnostics += misplaced(ir.mission, shot, leg.start)
    return diagnostics


def _earlier(ir: KeyframeIR, order: Sequence[Drone], drone: Drone) -> list[Drone]:
    """Return an order in which a drone comes before all drones that it does not wait for."""
    return _after_needs(ir, [drone, *(other for other in order if other is not drone)])


def _after_needs(ir: KeyframeIR, drones: Sequence[Drone]) -> list[Drone]:
    """Return drones in the given order, but each after those that its shots wait for."""
    left = list(drones)
    owner = {placed.shot.id: placed.shot.drone for placed in ir.shots}
    needs: dict[str, set[str]] = {drone.name: set() for drone in left}
    for placed in ir.shots:
        needs[placed.shot.drone].add(owner.get(placed.shot.timing.after or "", placed.shot.drone))
    ordered: list[Drone] = []
    while left:
        names = {drone.name for drone in ordered}
        ready = next((d for d in left if needs[d.name] <= names | {d.name}), left[0])
        left.remove(ready)
        ordered.append(ready)
    return ordered


def _plan(
    ir: KeyframeIR,
    drone: Drone,
    ctx: PassContext,
    known: _EarlierDrones,
) -> _Planned:
    """Plan one drone's legs, and add its flight for the drones after it."""
    mission = ir.mission
    mine = [placed for placed in ir.shots if placed.shot.drone == drone.name]
    if not mine:
        return _Planned((), (), (), ())
    if drone.body == "follow-camera" and not drone.gimbal.yaw[0] <= 0.0 <= drone.gimbal.yaw[1]:
        return _stopped(follow_camera_impossible(mission, drone))
    spaces = free_spaces_of(mission, drone)
    top = transit_point(spaces.flight, pad_space(mission, drone), drone)
    shots, faults = _curves(mission, drone, spaces.flight, mine, ctx)
    shots = [s.lasting(known.durations.get(s.shot.shot.id)) for s in shots]
    if isinstance(top, PadBlocked):
        return _stopped(pad_blocked(mission, drone, top), *faults)
    if faults:
        return _stopped(*faults)
    ctx.progress(f"way of {drone.name}")
    flight, warnings = (
        LegContext(drone, spaces, top, mission.rules.look_ahead),
        _warnings(mission, drone, shots),
    )
    if not on_clock(ir):
        return _in_a_row(mission, flight, shots, warnings)
    moving = (*moving_targets(mission, drone), *other_drones(mission, drone.name, known.flights))
    later = later_films(mission, drone, ir.shots, known.flights)
    others = OtherVehicles(moving, visibility_of(mission, drone, known.flights), later)
    itinerary = Itinerary(mission, flight, others, known.ends)
    curves = {s.shot.shot.id: s for s in shots}
    planned = _on_clock(itinerary, [curves.get(p.shot.id, p) for p in mine], warnings, ctx)
    if planned.legs:
        known.flights[drone.name] = itinerary.track()
    return planned


def _curves(
    mission: MissionIR, drone: Drone, space: FreeSpace, mine: Sequence[PlacedShot], ctx: PassContext
) -> tuple[list[PlannedShot], list[Diagnostic]]:
    """Return the shots of a drone on paths, and the errors of those that are infeasible."""
    shots: list[PlannedShot] = []
    faults: list[Diagnostic] = []
    for placed in mine:
        if placed.shot.ideal is not None:
            continue
        ctx.progress(f"path of shot {placed.shot.id}")
        result = shot_curve(mission, drone, space, placed, ctx.headings or DEFAULT)
        if isinstance(result, PlannedShot):
            shots.append(result)
        else:
            faults.append(failure(mission, drone, space, placed, result))
    return shots, faults


def _warnings(mission: MissionIR, drone: Drone, shots: Sequence[PlannedShot]) -> tuple[Diagnostic, ...]:
    return (
        *(moved(mission, s.shot, d) for s in shots for d in s.deviations if d.cause != CORNERS),
        *(cut_framing(mission, drone, s.shot, s.cuts) for s in shots if s.cuts),
        *(swings(mission, s.shot, s.swing) for s in shots if s.swing is not None),
    )


def _in_a_row(
    mission: MissionIR, flight: LegContext, shots: list[PlannedShot], warnings: tuple[Diagnostic, ...]
) -> _Planned:
    """Plan the legs of a drone without a clock: its shots one after another."""
    joined = drone_legs(flight, shots)
    if isinstance(joined, BlockedWay):
        shot = joined.shot.shot if joined.shot else None
        return _stopped(*warnings, failure(mission, flight.drone, flight.space, shot, joined.failure))
    deviations = tuple(d for s in shots for d in s.deviations)
    return _Planned(joined, deviations, tuple(x for s in shots for x in s.stats), warnings)


def _on_clock(
    itinerary: Itinerary,
    shots: list[PlannedShot | PlacedShot],
    warnings: tuple[Diagnostic, ...],
    ctx: PassContext,
) -> _Planned:
    """Plan the legs of a drone in a mission with a clock."""
    mission = itinerary.mission
    for shot in shots:
        placed = shot.shot if isinstance(shot, PlannedShot) else shot
        ctx.progress(f"way to and through shot {placed.shot.id}")
        trouble = itinerary.film(shot)
        if trouble is not None:
            return _stopped(*warnings, _diagnostic(itinerary, placed, trouble))
    trouble = itinerary.home()
    if trouble is not None:
        return _stopped(*warnings, _diagnostic(itinerary, None, trouble))
    curved = [s for s in shots if isinstance(s, PlannedShot)]
    left = left_places(mission, itinerary.deviations)
    deviations: list[Deviation] = [d for s in curved for d in s.deviations]
    deviations += itinerary.deviations
    stats = (*(x for s in curved for x in s.stats), *itinerary.stats)
    return _Planned(tuple(itinerary.legs), tuple(deviations), stats, (*warnings, *left))


def _diagnostic(itinerary: Itinerary, placed: PlacedShot | None, trouble: ClockFailure) -> Diagnostic:
    """Return the error for a shot on the clock that is infeasible, or for the way home."""
    mission, flight = itinerary.mission, itinerary.flight
    if isinstance(trouble, Meets):
        return way_met(mission, flight.drone, None if placed is None else placed.shot, trouble)
    if placed is not None:
        if isinstance(trouble, OutsideTrack):
            return outside_track(mission, placed.shot, trouble)
        if isinstance(trouble, TooLate):
            return too_late(mission, placed.shot, trouble)
        if isinstance(trouble, NoMotion):
            return stopped_on_clock(mission, placed.shot, trouble, beside_meshes(itinerary, placed, trouble))
    assert not isinstance(trouble, NoMotion | OutsideTrack | TooLate)
    return failure(mission, flight.drone, flight.space, placed, trouble)


def _stopped(*diagnostics: Diagnostic) -> _Planned:
    return _Planned((), (), (), diagnostics)
