"""Which moments of a plan the storyboard shows, and what is true at them."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from shotc.emit.screen import ScreenSummary, certified, framed_targets
from shotc.emit.storyboard.composition import composition_text
from shotc.emit.storyboard.fleet_lights import FleetLights, lights_at
from shotc.emit.storyboard.subjects import FramedSubject, at_keyframe, at_time
from shotc.emit.storyboard.worst import WorstFrame, worst_framing
from shotc.geom.bernstein import Array
from shotc.ir.drone import Drone
from shotc.ir.keyed import is_keyed
from shotc.ir.keyframes import PlacedShot
from shotc.ir.limits import Vec2
from shotc.ir.mission import MissionIR, Shot
from shotc.ir.path import from_what_was_asked
from shotc.ir.phases import KeyframeTime
from shotc.ir.target import Target
from shotc.ir.trajectory import DroneTrajectory, VerifiedIR
from shotc.rounding import at_least

MOST_PLACED, MOST_GENERATED = 12, 6

SAME_MOMENT = 0.05
"""Seconds within which a picture shows the same as another."""


@dataclass(frozen=True, slots=True, eq=False)
class StoryboardFrame:
    """One keyframe as it is flown, or a moment of a shot whose keyframes a kind generated.

    number : from 1, of the keyframe in the shot, or of the moment among those shown; 0 of neither
    time, hold : seconds; pose : channels, shape (7,)
    framed : its subjects, the foremost first
    worst : where none of its shot is framed worse, by how much, in words; else ""
    lights : of fleets, or None where none flies
    """

    number: int
    time: float
    pose: Array
    hold: float
    framed: tuple[FramedSubject, ...]
    worst: str = ""
    lights: FleetLights | None = None

    @property
    def mark(self) -> str:
        """What it is called by in its picture and on the map: its number, or W where it is only the worst."""
        return str(self.number) if self.number else "W"

    def is_at(self, time: float) -> bool:
        """Tell whether it shows what is so at a time, seconds."""
        return self.time - SAME_MOMENT <= time <= self.time + self.hold + SAME_MOMENT

    @property
    def targets(self) -> tuple[str, ...]:
        """The names of its subjects."""
        return tuple(subject.target for subject in self.framed)


@dataclass(frozen=True, slots=True, eq=False)
class ShotBoard:
    """Everything one shot's part of the storyboard needs.

    start, end : seconds; path : shape (n, 3), W; flight : the whole flight, shape (m, 3)
    total : how many keyframes the user wrote, or None where a kind generated them
    composition : which places on screen it gives its subjects, in words, or ""
    framing : what the certificate says of each of its subjects, by name
    note : where the path left its ideal, or ""
    """

    shot: Shot
    drone: Drone
    start: float
    end: float
    moments: tuple[StoryboardFrame, ...]
    total: int | None
    path: Array
    flight: Array
    composition: str
    framing: tuple[tuple[str, ScreenSummary], ...]
    note: str

    @property
    def numbered(self) -> int:
        """How many of its moments are keyframes, or chosen for a kind's path."""
        return sum(moment.number > 0 for moment in self.moments)


def shot_boards(plan: VerifiedIR, most_generated: int = MOST_GENERATED) -> tuple[ShotBoard, ...]:
    """Return the boards of all shots in the order they are filmed.

    most_generated : how many moments of a shot to show whose keyframes a kind generated
    """
    boards = []
    for placed in plan.trajectory.keyframes.shots:
        for flight in plan.trajectory.drones:
            phases = [p for p in flight.phases if p.shot == placed.shot.id]
            if phases:
                boards.append((phases[0].start, phases[-1].end, placed, flight))
    boards.sort(key=lambda item: (item[0], item[2].shot.id))
    return tuple(
        _board(plan, (start, end), (placed, flight), most_generated) for start, end, placed, flight in boards
    )


def _board(
    plan: VerifiedIR, interval: Vec2, pair: tuple[PlacedShot, DroneTrajectory], most_generated: int
) -> ShotBoard:
    placed, flight = pair
    shot, (start, end) = placed.shot, interval
    times = [k for k in flight.keyframes if k.shot == shot.id]
    by_hand = all(keyframe.placed for keyframe in placed.keyframes)
    flown = plan.trajectory
    asked = from_what_was_asked(flown.keyframes.mission, flown.deviations)
    deviations = [d for d in asked if d.shot == shot.id]
    worst = max(deviations, key=lambda d: d.distance, default=None)
    return ShotBoard(
        shot=shot,
        drone=plan.trajectory.keyframes.mission.drone(flight.drone),
        start=start,
        end=end,
        moments=_moments(plan, pair, interval, most_generated),
        total=len(times) if times and by_hand else None,
        path=flight.curve(np.linspace(start, end, 200))[:, :3],
        flight=flight.curve(np.linspace(flight.curve.start, flight.curve.end, 600))[:, :3],
        composition=composition_text(placed),
        framing=tuple(
            (target, certified(plan.certificate, shot.id, target))
            for target in framed_targets(plan.certificate, shot.id)
        ),
        note=""
        if worst is None
        else f"leaves its ideal by up to {at_least(worst.distance, 1)} m: {worst.cause}",
    )


def _moments(
    plan: VerifiedIR, pair: tuple[PlacedShot, DroneTrajectory], interval: Vec2, most_generated: int
) -> tuple[StoryboardFrame, ...]:
    """Return the moments of a shot in the order of time, its worst among them."""
    placed, flight = pair
    times = [k for k in flight.keyframes if k.shot == placed.shot.id]
    by_hand = all(keyframe.placed for keyframe in placed.keyframes)
    worst = worst_framing(plan, flight, placed.shot.id)
    # One or two generated keyframes are the whole shot; more only sample a curve.
    if is_keyed(placed.shot) and by_hand:
        return _with(plan, pair, [_passed(plan, pair, k) for k in _spread(times, MOST_PLACED)], worst)
    if placed.shot.ideal is None and (by_hand or len(times) <= 2):
        return _with(plan, pair, [_keyframe(plan, pair, k) for k in _spread(times, MOST_PLACED)], worst)

    even = np.linspace(*interval, most_generated)
    shown = [passing(plan, pair, float(t), n) for n, t in enumerate(even, start=1)]
    if worst is not None and not any(moment.is_at(worst.time) for moment in shown):
        nearest = 1 + int(np.argmin(np.abs(even[1:-1] - worst.time)))
        shown[nearest] = passing(plan, pair, worst.time, nearest + 1)
    return _with(plan, pair, shown, worst)


def _with(
    plan: VerifiedIR,
    pair: tuple[PlacedShot, DroneTrajectory],
    moments: list[StoryboardFrame],
    worst: WorstFrame | None,
) -> tuple[StoryboardFrame, ...]:
    """Return moments with the worst one marked, which joins them where none of them shows it."""
    if worst is None:
        return tuple(moments)
    if not any(moment.is_at(worst.time) for moment in moments):
        moments = sorted([*moments, passing(plan, pair, worst.time, 0)], key=lambda moment: moment.time)
    first = next(i for i, moment in enumerate(moments) if moment.is_at(worst.time))
    return tuple(replace(m, worst=worst.words) if i == first else m for i, m in enumerate(moments))


def _spread(times: list[KeyframeTime], most: int) -> list[KeyframeTime]:
    if len(times) <= most:
        return times
    return [times[i] for i in np.linspace(0, len(times) - 1, most).round().astype(int)]


def _keyframe(
    plan: VerifiedIR, pair: tuple[PlacedShot, DroneTrajectory], at: KeyframeTime
) -> StoryboardFrame:
    placed, flight = pair
    return StoryboardFrame(
        number=at.index + 1,
        time=at.time,
        pose=flight.curve(at.time),
        hold=placed.keyframes[at.index].hold,
        framed=at_keyframe(plan, pair, at),
        lights=lights_at(plan, at.time),
    )


def _passed(plan: VerifiedIR, pair: tuple[PlacedShot, DroneTrajectory], at: KeyframeTime) -> StoryboardFrame:
    """Return a keyframe of a shot on its own clock, whose picture is that of the moment."""
    moment = passing(plan, pair, at.time, at.index + 1)
    return replace(moment, hold=pair[0].keyframes[at.index].hold)


def passing(
    plan: VerifiedIR, pair: tuple[PlacedShot, DroneTrajectory], time: float, number: int
) -> StoryboardFrame:
    """Return the moment of a shot at some time, seconds."""
    return StoryboardFrame(
        number,
        time,
        pair[1].curve(time),
        hold=0.0,
        framed=at_time(plan, pair, time),
        lights=lights_at(plan, time),
    )


def standing(mission: MissionIR, board: ShotBoard) -> MissionIR:
    """Return the mission with a moving target standing wherever it is at one of a shot's moments.

    A picture of a fleet that the shot films is a target that stands there.
    """
    targets: list[Target] = [t for t in mission.groups if t.name == board.shot.subject and not t.parts]
    for target in mission.targets:
        if target.track is None:
            targets.append(target)
            continue
        times = {target.at(moment.time): moment.time for moment in board.moments}
        targets += [target._replace(centre=p, shape=target.shape_at(t), track=None) for p, t in times.items()]
    return mission._replace(targets=tuple(targets))
