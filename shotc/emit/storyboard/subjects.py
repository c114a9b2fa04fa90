"""The framed subjects at a moment of a shot: reference, composition and faults of each."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from shotc.ir.coverage import coverage
from shotc.ir.hidden import HALF_SHARE
from shotc.ir.keyframes import PlacedShot
from shotc.ir.limits import Vec2
from shotc.ir.mission import Composition, Shot
from shotc.ir.occlusion import others_of
from shotc.ir.parked import bodies
from shotc.ir.phases import KeyframeTime, Reference
from shotc.ir.sampling import SAME_TIME_S, projected, references
from shotc.ir.trajectory import DroneTrajectory, VerifiedIR

NOTICE_SHARE = 0.05
"""Covered share of an outline, below which it is not mentioned beside a picture."""

MOVED_HALF_FRAMES = 0.02
"""Distance in (u, v) units, above which the user's own framing of a subject is shown."""


@dataclass(frozen=True, slots=True)
class FramedSubject:
    """One subject at one moment.

    reference : (u, v) of its reference, or None
    requested : (u, v) that the user's own heading and pitch give, or None
    fault : "cropped", "hidden", or its covered share in words; "" without a fault
    """

    target: str
    reference: Vec2 | None
    requested: Vec2 | None
    composition: Composition
    fault: str

    @property
    def is_moved(self) -> bool:
        """Whether composition moved the subject visibly away from the user's own framing."""
        if self.requested is None or self.reference is None:
            return False
        return bool(np.hypot(*np.subtract(self.requested, self.reference)) > MOVED_HALF_FRAMES)


def at_keyframe(
    plan: VerifiedIR, pair: tuple[PlacedShot, DroneTrajectory], at: KeyframeTime
) -> tuple[FramedSubject, ...]:
    """Return the framed subject of a keyframe, if there is one."""
    placed, flight = pair
    keyframe, written = placed.keyframes[at.index], placed.shot.keyframes[at.index]
    if keyframe.target is None:
        return ()
    own_angles = keyframe.placed and written.aim is not None and len(written.aim) == 2
    return (
        FramedSubject(
            target=keyframe.target,
            reference=keyframe.reference,
            requested=keyframe.asked if own_angles else None,
            composition=written.composition,
            fault=_fault(plan, flight, keyframe.target, at.time),
        ),
    )


def at_time(
    plan: VerifiedIR, pair: tuple[PlacedShot, DroneTrajectory], time: float
) -> tuple[FramedSubject, ...]:
    """Return the framed subjects of a shot at a time, seconds, the most important first."""
    placed, flight = pair
    shot = placed.shot
    spans = _spans([f for f in flight.framing if f.shot == shot.id], time)
    passed = [k.index for k in flight.keyframes if k.shot == shot.id and k.time <= time + SAME_TIME_S]
    framed = []
    for target in dict.fromkeys(span.target for span in spans):
        u, v = (float(c) for c in references(flight, shot.id, target, np.array([time]))[0])
        framed.append(
            FramedSubject(
                target=target,
                reference=None if np.isnan(u) else (u, v),
                requested=None,
                composition=_composition(shot, target, passed[-1] if passed else 0),
                fault=_fault(plan, flight, target, time),
            )
        )
    return tuple(framed)


def _spans(framing: Sequence[Reference], time: float) -> list[Reference]:
    """Return the references that hold at a time; where one ends as another begins, only the later one."""
    inside = [f for f in framing if f.start - SAME_TIME_S <= time <= f.end + SAME_TIME_S]
    last = max((f.start for f in inside), default=0.0)
    return [f for f in inside if time < f.end - SAME_TIME_S] or [f for f in inside if f.start == last]


def _composition(shot: Shot, target: str, keyframe: int) -> Composition:
    if shot.keyframes:
        return shot.keyframes[keyframe].composition
    # For a subject that goes from place to place, the lines of one place would mislead.
    own = (
        subject.composition
        for subject in shot.subjects
        if subject.target == target and all(setpoint.place is None for setpoint in subject.setpoints)
    )
    return next(own, Composition("none"))


def _fault(plan: VerifiedIR, flight: DroneTrajectory, target: str, time: float) -> str:
    others = others_of(bodies(plan.trajectory), flight.drone)
    mission = plan.trajectory.keyframes.mission
    if not projected(mission, flight, target, np.array([time])).in_frame[0]:
        return "cropped"
    eye = flight.curve(np.array([time]))[:, :3]
    covered = float(coverage(mission, others, target, eye, np.array([time])).share[0])
    if covered > 1.0 - HALF_SHARE:
        return "hidden"
    return f"{100 * covered:.0f} % covered" if covered >= NOTICE_SHARE else ""
