"""Which moments of a plan the storyboard shows, and what is true at them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from shotc.emit.screen import ScreenSummary, screen_tracks, summary
from shotc.ir.keyframes import PlacedKeyframe, PlacedShot
from shotc.ir.mission import Composition, Drone, Shot, Vec2
from shotc.ir.trajectory import DroneTrajectory, KeyframeTime, VerifiedIR

Array = NDArray[np.float64]

MOST_PLACED, MOST_GENERATED = 12, 6


@dataclass(frozen=True, slots=True, eq=False)
class Moment:
    """One keyframe as it is flown.

    number : from 1, in the shot, or among those shown where a kind generated them
    time : seconds; pose : channels, shape (7,)
    reference, asked : (u, v) wanted of the subject, and what the user's own framing gave
    """

    number: int
    time: float
    pose: Array
    hold: float
    target: str | None
    reference: Vec2 | None
    asked: Vec2 | None
    composition: Composition


@dataclass(frozen=True, slots=True, eq=False)
class ShotBoard:
    """Everything one shot's part of the storyboard needs.

    start, end : seconds; path : shape (n, 3), W; flight : the whole flight, shape (m, 3)
    total : how many keyframes the shot has; note : where the path left its ideal, or ""
    """

    number: int
    shot: Shot
    drone: Drone
    start: float
    end: float
    moments: tuple[Moment, ...]
    total: int
    path: Array
    flight: Array
    framing: ScreenSummary
    note: str


def shot_boards(plan: VerifiedIR, most_generated: int = MOST_GENERATED) -> tuple[ShotBoard, ...]:
    """Return the boards of all shots in the order they are filmed.

    most_generated : how many frames of a shot to show whose keyframes a kind generated
    """
    found = []
    for placed in plan.trajectory.keyframes.shots:
        for flight in plan.trajectory.drones:
            phases = [p for p in flight.phases if p.shot == placed.shot.id]
            if phases:
                found.append((phases[0].start, phases[-1].end, placed, flight))
    found.sort(key=lambda item: (item[0], item[2].shot.id))
    return tuple(
        _board(plan, number, (start, end), (placed, flight), most_generated)
        for number, (start, end, placed, flight) in enumerate(found, start=1)
    )


def _board(
    plan: VerifiedIR,
    number: int,
    interval: Vec2,
    pair: tuple[PlacedShot, DroneTrajectory],
    most_generated: int,
) -> ShotBoard:
    placed, flight = pair
    shot, (start, end) = placed.shot, interval
    tracks = tuple(t for t in screen_tracks(plan) if t.shot == shot.id and t.drone == flight.drone)
    by_hand = all(keyframe.placed for keyframe in placed.keyframes)
    times = [k for k in flight.keyframes if k.shot == shot.id]
    chosen = _spread(times, MOST_PLACED if by_hand else most_generated)
    numbers = [k.index + 1 if by_hand else i for i, k in enumerate(chosen, start=1)]
    moments = tuple(_moment(placed, flight, k, n) for k, n in zip(chosen, numbers, strict=True))
    deviations = [d for d in plan.trajectory.deviations if d.shot == shot.id]
    worst = max(deviations, key=lambda d: d.distance, default=None)
    return ShotBoard(
        number=number,
        shot=shot,
        drone=plan.trajectory.keyframes.mission.drone(flight.drone),
        start=start,
        end=end,
        moments=moments,
        total=len(times),
        path=flight.curve(np.linspace(start, end, 200))[:, :3],
        flight=flight.curve(np.linspace(flight.curve.start, flight.curve.end, 600))[:, :3],
        framing=summary(tracks),
        note="" if worst is None else f"leaves its ideal by up to {worst.distance:.1f} m: {worst.cause}",
    )


def _spread(times: list[KeyframeTime], most: int) -> list[KeyframeTime]:
    if len(times) <= most:
        return times
    return [times[i] for i in np.linspace(0, len(times) - 1, most).round().astype(int)]


def _moment(placed: PlacedShot, flight: DroneTrajectory, at: KeyframeTime, number: int) -> Moment:
    keyframe: PlacedKeyframe = placed.keyframes[at.index]
    return Moment(
        number=number,
        time=at.time,
        pose=flight.curve(at.time),
        hold=keyframe.hold,
        target=keyframe.target,
        reference=keyframe.reference,
        asked=keyframe.asked,
        composition=placed.shot.keyframes[at.index].composition,
    )
