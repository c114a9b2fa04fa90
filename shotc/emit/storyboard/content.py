"""Which moments of a plan the storyboard shows, and what is true at them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from shotc.emit.screen import ScreenSummary, ScreenTrack, summary
from shotc.geom.bernstein import Array
from shotc.ir.keyframes import PlacedKeyframe, PlacedShot
from shotc.ir.mission import Composition, Drone, Shot, Vec2
from shotc.ir.sampling import seen
from shotc.ir.trajectory import DroneTrajectory, KeyframeTime, VerifiedIR

MOST_PLACED, MOST_GENERATED = 12, 6


@dataclass(frozen=True, slots=True, eq=False)
class Moment:
    """One keyframe as it is flown.

    number : from 1, in the shot, or among those shown where a kind generated them
    time : seconds; pose : channels, shape (7,)
    reference, asked : (u, v) wanted of the subject, and what the user's own framing gave
    fault : "cropped" or "hidden" where the subject is not seen as it should be, or ""
    """

    number: int
    time: float
    pose: Array
    hold: float
    target: str | None
    reference: Vec2 | None
    asked: Vec2 | None
    composition: Composition
    fault: str


@dataclass(frozen=True, slots=True, eq=False)
class ShotBoard:
    """Everything one shot's part of the storyboard needs.

    start, end : seconds; path : shape (n, 3), W; flight : the whole flight, shape (m, 3)
    total : how many keyframes the shot has; note : where the path left its ideal, or ""
    """

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


def shot_boards(
    plan: VerifiedIR, tracks: tuple[ScreenTrack, ...], most_generated: int = MOST_GENERATED
) -> tuple[ShotBoard, ...]:
    """Return the boards of all shots in the order they are filmed.

    tracks : the framing of the whole plan
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
        _board(plan, (start, end), (placed, flight), tracks, most_generated)
        for start, end, placed, flight in found
    )


def _board(
    plan: VerifiedIR,
    interval: Vec2,
    pair: tuple[PlacedShot, DroneTrajectory],
    tracks: tuple[ScreenTrack, ...],
    most_generated: int,
) -> ShotBoard:
    placed, flight = pair
    shot, (start, end) = placed.shot, interval
    own = tuple(track for track in tracks if track.shot == shot.id and track.drone == flight.drone)
    by_hand = all(keyframe.placed for keyframe in placed.keyframes)
    times = [k for k in flight.keyframes if k.shot == shot.id]
    chosen = _spread(times, MOST_PLACED if by_hand else most_generated)
    numbers = [k.index + 1 if by_hand else i for i, k in enumerate(chosen, start=1)]
    moments = tuple(_moment(plan, (placed, flight), k, n) for k, n in zip(chosen, numbers, strict=True))
    deviations = [d for d in plan.trajectory.deviations if d.shot == shot.id]
    worst = max(deviations, key=lambda d: d.distance, default=None)
    return ShotBoard(
        shot=shot,
        drone=plan.trajectory.keyframes.mission.drone(flight.drone),
        start=start,
        end=end,
        moments=moments,
        total=len(times),
        path=flight.curve(np.linspace(start, end, 200))[:, :3],
        flight=flight.curve(np.linspace(flight.curve.start, flight.curve.end, 600))[:, :3],
        framing=summary(own),
        note="" if worst is None else f"leaves its ideal by up to {worst.distance:.1f} m: {worst.cause}",
    )


def _spread(times: list[KeyframeTime], most: int) -> list[KeyframeTime]:
    if len(times) <= most:
        return times
    return [times[i] for i in np.linspace(0, len(times) - 1, most).round().astype(int)]


def _moment(
    plan: VerifiedIR, pair: tuple[PlacedShot, DroneTrajectory], at: KeyframeTime, number: int
) -> Moment:
    placed, flight = pair
    keyframe: PlacedKeyframe = placed.keyframes[at.index]
    fault = ""
    if keyframe.target is not None:
        frames = seen(plan.trajectory.keyframes.mission, flight, keyframe.target, np.array([at.time]))
        fault = "" if frames.in_frame[0] else "cropped"
        fault = "hidden" if not fault and frames.hidden[0] else fault
    return Moment(
        number=number,
        time=at.time,
        pose=flight.curve(at.time),
        hold=keyframe.hold,
        target=keyframe.target,
        reference=keyframe.reference,
        asked=keyframe.asked,
        composition=placed.shot.keyframes[at.index].composition,
        fault=fault,
    )
