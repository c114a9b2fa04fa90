"""Which moments of a plan the storyboard shows, and what is true at them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from shotc.emit.screen import ScreenSummary, certified
from shotc.geom.bernstein import Array
from shotc.ir.keyframes import PlacedShot
from shotc.ir.limits import Vec2
from shotc.ir.mission import Composition, Drone, MissionIR, Shot, Target
from shotc.ir.occlusion import others_of
from shotc.ir.sampling import SAME_TIME, references, seen
from shotc.ir.trajectory import DroneTrajectory, KeyframeTime, VerifiedIR

MOST_PLACED, MOST_GENERATED = 12, 6


@dataclass(frozen=True, slots=True, eq=False)
class Moment:
    """One keyframe as it is flown, or a moment of a shot whose keyframes a kind generated.

    number : from 1, of the keyframe in the shot, or of the moment among those shown
    time, hold : seconds; pose : channels, shape (7,)
    reference : (u, v) wanted of the subject, or None
    asked : (u, v) where the user's own heading and pitch had put it, or None
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
    total : how many keyframes the user wrote, or None where a kind generated them
    framing : what the certificate says of it; note : where the path left its ideal, or ""
    """

    shot: Shot
    drone: Drone
    start: float
    end: float
    moments: tuple[Moment, ...]
    total: int | None
    path: Array
    flight: Array
    framing: ScreenSummary
    note: str


def shot_boards(plan: VerifiedIR, most_generated: int = MOST_GENERATED) -> tuple[ShotBoard, ...]:
    """Return the boards of all shots in the order they are filmed.

    most_generated : how many moments of a shot to show whose keyframes a kind generated
    """
    found = []
    for placed in plan.trajectory.keyframes.shots:
        for flight in plan.trajectory.drones:
            phases = [p for p in flight.phases if p.shot == placed.shot.id]
            if phases:
                found.append((phases[0].start, phases[-1].end, placed, flight))
    found.sort(key=lambda item: (item[0], item[2].shot.id))
    return tuple(
        _board(plan, (start, end), (placed, flight), most_generated) for start, end, placed, flight in found
    )


def _board(
    plan: VerifiedIR, interval: Vec2, pair: tuple[PlacedShot, DroneTrajectory], most_generated: int
) -> ShotBoard:
    placed, flight = pair
    shot, (start, end) = placed.shot, interval
    times = [k for k in flight.keyframes if k.shot == shot.id]
    by_hand = all(keyframe.placed for keyframe in placed.keyframes)
    # One or two generated keyframes are the whole shot; more only sample a curve.
    if shot.ideal is None and (by_hand or len(times) <= 2):
        moments = tuple(_keyframe(plan, pair, k) for k in _spread(times, MOST_PLACED))
    else:
        even = np.linspace(start, end, most_generated)
        moments = tuple(passing(plan, pair, float(t), n) for n, t in enumerate(even, start=1))
    deviations = [d for d in plan.trajectory.deviations if d.shot == shot.id]
    worst = max(deviations, key=lambda d: d.distance, default=None)
    return ShotBoard(
        shot=shot,
        drone=plan.trajectory.keyframes.mission.drone(flight.drone),
        start=start,
        end=end,
        moments=moments,
        total=len(times) if by_hand and shot.ideal is None else None,
        path=flight.curve(np.linspace(start, end, 200))[:, :3],
        flight=flight.curve(np.linspace(flight.curve.start, flight.curve.end, 600))[:, :3],
        framing=certified(plan.certificate, shot.id),
        note="" if worst is None else f"leaves its ideal by up to {worst.distance:.1f} m: {worst.cause}",
    )


def _spread(times: list[KeyframeTime], most: int) -> list[KeyframeTime]:
    if len(times) <= most:
        return times
    return [times[i] for i in np.linspace(0, len(times) - 1, most).round().astype(int)]


def _keyframe(plan: VerifiedIR, pair: tuple[PlacedShot, DroneTrajectory], at: KeyframeTime) -> Moment:
    placed, flight = pair
    keyframe, written = placed.keyframes[at.index], placed.shot.keyframes[at.index]
    own_angles = keyframe.placed and written.aim is not None and len(written.aim) == 2
    return Moment(
        number=at.index + 1,
        time=at.time,
        pose=flight.curve(at.time),
        hold=keyframe.hold,
        target=keyframe.target,
        reference=keyframe.reference,
        asked=keyframe.asked if own_angles else None,
        composition=written.composition,
        fault=_fault(plan, flight, keyframe.target, at.time),
    )


def passing(plan: VerifiedIR, pair: tuple[PlacedShot, DroneTrajectory], time: float, number: int) -> Moment:
    """Return the moment of a shot at some time, seconds."""
    placed, flight = pair
    shot = placed.shot
    spans = [f for f in flight.framing if f.shot == shot.id and f.start - SAME_TIME <= time]
    target = spans[-1].target if spans and time <= spans[-1].end + SAME_TIME else None
    wanted = None
    if target is not None:
        u, v = (float(c) for c in references(flight, shot.id, target, np.array([time]))[0])
        wanted = None if np.isnan(u) else (u, v)
    passed = [k.index for k in flight.keyframes if k.shot == shot.id and k.time <= time + SAME_TIME]
    return Moment(
        number=number,
        time=time,
        pose=flight.curve(time),
        hold=0.0,
        target=target,
        reference=wanted,
        asked=None,
        composition=_composition(shot, passed[-1] if passed else 0),
        fault=_fault(plan, flight, target, time),
    )


def _composition(shot: Shot, keyframe: int) -> Composition:
    if shot.ideal is None:
        return shot.keyframes[keyframe].composition
    return shot.subjects[0].composition if shot.subjects else Composition("none")


def standing(mission: MissionIR, board: ShotBoard) -> MissionIR:
    """Return the mission with a moving target standing wherever it is at one of a shot's moments."""
    found: list[Target] = []
    for target in mission.targets:
        places = dict.fromkeys(target.at(moment.time) for moment in board.moments)
        found += [target] if target.track is None else [target._replace(centre=p, track=None) for p in places]
    return mission._replace(targets=tuple(found))


def _fault(plan: VerifiedIR, flight: DroneTrajectory, target: str | None, time: float) -> str:
    if target is None:
        return ""
    others = others_of(plan.trajectory.drones, flight.drone)
    frames = seen(plan.trajectory.keyframes.mission, flight, target, np.array([time]), others)
    if not frames.in_frame[0]:
        return "cropped"
    return "hidden" if frames.hidden[0] else ""
