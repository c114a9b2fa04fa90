"""Choose the path to fly from a refiner's answer: its path, or the convex one where the mission allows it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace
from typing import Any

import numpy as np

from shotc.diag.model import Diagnostic
from shotc.diag.plugin_faults import one_line
from shotc.ir.passes import Outcome
from shotc.ir.path import (
    CAM_PITCH,
    CAM_YAW,
    ClockLeg,
    Deviation,
    DronePath,
    HoldLeg,
    Leg,
    MovingLeg,
    PathIR,
    TimedPath,
    X,
    Y,
    Z,
    filmed,
)
from shotc.passes.refine_path.ask import RefinerAnswer
from shotc.passes.refine_path.clocked import on_clock
from shotc.passes.refine_path.finding import RefinerFault, RefinerFinding, error_of
from shotc.passes.refine_path.form import form, structure
from shotc.passes.refine_path.limits import limits
from shotc.passes.refine_path.seat import Seat
from shotc.planning.obstacles import flight_space
from shotc.planning.path.deviations import off_drawn
from shotc.planning.path.drawn import drawn_path
from shotc.planning.path.rejoin import rejoined
from shotc.planning.path.with_camera import NoTransit

CAMERA = (X, Y, Z, CAM_YAW, CAM_PITCH)


def settle(before: PathIR, seat: Seat, answer: RefinerAnswer) -> Outcome[PathIR]:
    """Return the path to fly: refined where sound, convex in optional shots that are not; or errors."""
    shots = before.keyframes.mission.shots
    path, faults = _mended(before, seat, answer)
    if path is None:
        path, concerned = before, {shot.id for shot in shots}
    else:
        concerned = {fault.shot for fault in faults if fault.shot is not None}
    optional = {shot.id for shot in shots if shot.refine_optional}
    if concerned <= optional:
        told_of = (kept_convex(before, seat, name, faults) for name in sorted(concerned))
        return Outcome(path if path is before else measured(path), (*answer.warnings, *told_of))
    errors = dict.fromkeys(fault.diagnostic for fault in faults if fault.shot not in optional)
    return Outcome(None, (*answer.warnings, *(errors or dict.fromkeys(fault.diagnostic for fault in faults))))


def _mended(before: PathIR, seat: Seat, answer: RefinerAnswer) -> tuple[PathIR | None, list[RefinerFault]]:
    """Return the refined path with convex legs for shots that failed, and all faults.

    None where nothing of the refined path is usable.
    """
    path, faults = answer.path, list(answer.faults)
    failed = {fault.shot for fault in faults}
    corrected: set[str | None] = set()
    while path is not None and path is not before:
        left = [fault for fault in _judged(before, seat, path) if fault.shot not in failed]
        faults += left
        failed |= {fault.shot for fault in left}
        if None in failed or failed == corrected:
            break
        path, corrected = _with_convex(before, path, failed), set(failed)
    return (None if None in failed else path), faults


def _judged(before: PathIR, seat: Seat, path: Any) -> list[RefinerFault]:
    """Return the faults of a value that should be a path; detailed checks need a sound structure."""
    try:
        faults = list(structure(before, path)) or [
            *form(before, path),
            *on_clock(before, path),
            *limits(path),
        ]
    except Exception as raised:  # noqa: BLE001  a plugin may hand back anything, and reading it may raise
        faults = [
            RefinerFinding(
                "R002", "returned a path that cannot be flown", (f"to read it raises {one_line(raised)}",)
            )
        ]
    return [error_of(before.keyframes.mission, seat, finding) for finding in faults]


def _with_convex(before: PathIR, path: PathIR, failed: Iterable[str | None]) -> PathIR | None:
    """Return the path with the convex legs of some shots; itself where it has them, None where none joins."""
    convex = {name for name in failed if name is not None}
    if all(same(filmed(before, name), filmed(path, name)) for name in convex):
        return path
    refined = {
        leg.shot: leg.curve.channels(*CAMERA)
        for drone in path.drones
        for leg in drone.legs
        if isinstance(leg, MovingLeg) and leg.shot is not None and leg.shot not in convex
    }
    refined |= {
        now.shot: now.curve.channels(*CAMERA)
        for was, now in _on_paths(before, path)
        if now.shot is not None and now.shot not in convex and not same(was, now)
    }
    try:
        joined = rejoined(before, refined)
    except (NoTransit, ValueError):
        return None
    bent = [d for d in before.deviations if d.shot in convex]
    bent += [d for d in path.deviations if d.shot not in convex]
    timed = tuple(_guided(old, new, convex) for old, new in zip(joined.timed, path.timed, strict=True))
    return replace(joined, deviations=tuple(bent), stats=path.stats, timed=timed)


def _on_paths(before: PathIR, after: PathIR) -> Iterator[tuple[MovingLeg, MovingLeg]]:
    """Yield the filmed legs on paths of drones on the mission's clock, old and new."""
    for old, new in zip(before.timed, after.timed, strict=True):
        for was, now in zip(old.legs, new.legs, strict=True):
            if isinstance(was, MovingLeg) and isinstance(now, MovingLeg) and now.phase == "shot":
                yield was, now


def _guided(old: TimedPath, new: TimedPath, convex: set[str]) -> TimedPath:
    """Return a drone's legs with refined shots on their own clock, except those that keep their guides.

    Refined legs begin and end where the guides do.
    """
    legs = zip(old.legs, new.legs, strict=True)
    return TimedPath(
        old.drone,
        tuple(now if isinstance(now, ClockLeg) and now.shot not in convex else was for was, now in legs),
    )


def same(a: Leg, b: Leg) -> bool:
    """Return whether two legs are flown in the same way."""
    if a is b:
        return True
    if isinstance(a, HoldLeg) or isinstance(b, HoldLeg):
        return isinstance(a, HoldLeg) and isinstance(b, HoldLeg) and a.pose == b.pose
    return np.array_equal(a.curve.breaks, b.curve.breaks) and np.array_equal(a.curve.ctrl, b.curve.ctrl)


def kept_convex(before: PathIR, seat: Seat, shot: str, faults: list[RefinerFault]) -> Diagnostic:
    """Return the warning of a shot that keeps its convex path, with the faults of the refined one."""
    mission = before.keyframes.mission
    path = mission.shot(shot).path
    about = [fault.diagnostic for fault in faults if fault.shot in (shot, None)]
    notes = [note for d in about or [f.diagnostic for f in faults] for note in (d.message, *d.notes)]
    return Diagnostic(
        "R003",
        f"shot `{shot}` flies its convex path, since {seat.named} gave none that can be flown",
        (mission.origins.key((*path, "refine"), "this allows it"),),
        tuple(notes),
        "correct what is named, or plan with `--refiner none`",
    )


def measured(path: PathIR) -> PathIR:
    """Return a path with the deviations of its drawn shots measured anew, whatever a refiner says of them."""
    mission, anew = path.keyframes.mission, dict[str, tuple[Deviation, ...]]()
    placed = {p.shot.id: p for p in path.keyframes.shots}
    every: tuple[DronePath | TimedPath, ...] = (*path.drones, *path.timed)
    for track in every:
        for leg in track.legs:
            if not isinstance(leg, MovingLeg) or leg.shot is None:
                continue
            shot = placed[leg.shot]
            drawn = drawn_path(shot, leg.keyframes_at)
            if drawn is not None:
                space = flight_space(mission, mission.drone(track.drone))
                anew[leg.shot] = off_drawn(space, shot, drawn, leg.curve.channels(X, Y, Z))
    if not anew:
        return path
    others = (d for d in path.deviations if d.shot not in anew)
    return replace(path, deviations=(*others, *(d for each in anew.values() for d in each)))
