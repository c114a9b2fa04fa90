"""Shots refined in a mission with a clock: each beside what other drones and moving targets do meanwhile.

A shot on a path is refined by the problem that it has alone, and flown in the time that its convex path
takes, so that nobody planned beside it has to move. What comes too near then is kept away from by half-spaces
at the nodes, at the times that these have, and the shot is solved again.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from shotc.plugin_api import Diagnostic, MovingLeg, Outcome, PassContext, PathIR, Piecewise, unrefined
from shotc.plugin_api.refiner import (
    MOST_MOVED,
    Array,
    CameraTask,
    FlownShot,
    HoldLeg,
    NoTransit,
    PlacedSubject,
    flown_shot,
    least_out,
    leg_time,
    prefers_free_pictures,
    quintic_hermite,
    rejoined,
    surroundings,
    with_need,
)
from shotc_casadi.clock.refiner import IN_PICTURE, OUT_M, refine_one
from shotc_casadi.conditions import Condition
from shotc_casadi.margins import REACH_M
from shotc_casadi.messages import stats
from shotc_casadi.proof import PROVED_M
from shotc_casadi.references import Subject, subject_of
from shotc_casadi.report import deviation, report
from shotc_casadi.rounds import Refined, refine_shot
from shotc_casadi.walls import NodePlanes

TRIES = 3  # about the last refined path; one more is about the convex path, which is known to be clear
APART_S = 1e-6  # seconds at least between two nodes
DEEPER_SHARE = 0.05  # share by which a drone may be deeper in a picture in which it is already
ROOM_SHARE = 0.5  # of the room beside a wall, kept; what moves has its own


def refine_in_company(path: PathIR, ctx: PassContext, condition: Condition) -> Outcome[PathIR]:
    """Return the path with every shot refined, drone by drone in order of priority.

    Shots on their own clock have no keyframes to interpolate; the conditions that do leave them alone.
    """
    diagnostics: list[Diagnostic] = []
    filmed = [
        (flown.drone, leg) for flown in path.timed for leg in flown.legs if not isinstance(leg, HoldLeg)
    ]
    for drone, leg in filmed:
        if leg.shot is None:
            continue
        ctx.progress(f"refine shot {leg.shot}")
        if isinstance(leg, MovingLeg):
            path, messages = _refined(path, subject_of(path, drone, leg), condition)
        elif condition.aims == "framing":
            keeps = condition.visibility != "none"
            path, messages = refine_one(path, leg.shot, condition.name, keeps_whole=keeps)
        else:
            messages = [unrefined(path, leg.shot, f"`{condition.name}` goes from keyframe to keyframe")]
        diagnostics += messages
    return Outcome(path, tuple(diagnostics))


def _refined(path: PathIR, subject: Subject, condition: Condition) -> tuple[PathIR, list[Diagnostic]]:
    """Return the path with one shot on a path refined, and what has to be said of it."""
    shot, task, why, needs = subject.placed.shot.id, subject, "", None
    plain: tuple[Refined, PathIR] | None = None  # where nothing but a preference stands against it
    for tries in range(1, TRIES + 2):
        refined = refine_shot(task, condition)
        if refined.camera is None and not why:
            error = report(path, refined, condition.name)
            return path, [] if error is None else [error]
        moved = path  # beside whose flight the next one is put
        if refined.camera is not None:
            try:
                moved = rejoined(path, {shot: refined.camera})
            except NoTransit as fault:
                why, needs = f"refined, it cannot keep {fault}", fault.least
                if task.leg.duration is not None:
                    break
                task = task._replace(leg=_in_its_time(subject))
                continue
            against = _against(path, moved, subject)
            if against is None and (plain is None or _near(subject, refined, plain[0])):
                return _told(path, moved, refined, condition)
            if against in (None, IN_PICTURE) and prefers_free_pictures(subject.mission):
                plain = plain or (refined, moved)
            why = against or IN_PICTURE
        course = path if tries == TRIES else moved
        task = task._replace(beside=_Passing(course, subject, flown_shot(course, shot)).half_spaces)
    if plain is not None:
        return _told(path, plain[1], plain[0], condition)
    left = path if needs is None else with_need(path, shot, needs)
    return left, [unrefined(path, shot, why)]


def _near(subject: Subject, refined: Refined, plain: Refined) -> bool:
    """Tell whether a shot stays as near to another as a preference may move it from that."""
    assert refined.camera is not None
    assert plain.camera is not None
    s = plain.nodes.s
    before, after = plain.camera(s)[:, :3], refined.camera(s)[:, :3]
    named = {k.target for k in subject.placed.keyframes if k.target is not None}
    centres = [np.array(subject.mission.target(name).centre) for name in named]
    away = np.min([np.linalg.norm(before - centre, axis=1) for centre in centres] or [np.inf], axis=0)
    return bool((np.linalg.norm(after - before, axis=1) <= MOST_MOVED * away).all())


def _in_its_time(subject: Subject) -> MovingLeg:
    """Return the leg with the time that it takes as the time that it is to take."""
    return replace(subject.leg, duration=leg_time(subject.drone, subject.leg))


def _told(
    path: PathIR, moved: PathIR, refined: Refined, condition: Condition
) -> tuple[PathIR, list[Diagnostic]]:
    """Return a path with a shot that is refined, with what is measured and said of it."""
    warning = report(path, refined, condition.name)
    entries = stats(refined.shot, refined.rounds, refined.solution)
    left = (*moved.deviations, *deviation(path, refined))
    whole = replace(moved, stats=(*moved.stats, *entries), deviations=left)
    return whole, [] if warning is None else [warning]


def _against(before: PathIR, after: PathIR, subject: Subject) -> str | None:
    """Return what stands against a refined shot as it is flown, None where nothing does.

    What its convex path keeps no better does not count: verification has the word on that.
    """
    lacks = _lacking(after, subject)
    kept = _lacking(before, subject) if lacks else {}
    for owner, lack in lacks.items():
        if lack > kept.get(owner, 0.0) + PROVED_M:
            return f"refined, it comes {lack:.2g} m too near to {owner}"
    free = least_out(before)
    return IN_PICTURE if least_out(after) < min(OUT_M, free - DEEPER_SHARE * abs(free)) else None


def _lacking(path: PathIR, subject: Subject) -> dict[str, float]:
    """Return what moves and is not proved to be clear of a shot as it is flown, with the metres that lack."""
    flown = flown_shot(path, subject.placed.shot.id).curve
    around = surroundings(path, subject.drone, flown.breaks, standing_too=False)
    lacks: dict[str, float] = {}
    for motion in around.motions:
        lack = float(replace(around, motions=(motion,)).lacking(flown.ctrl[:, :, :3]).max())
        if lack > PROVED_M:
            lacks[str(motion.what.owner)] = lack
    return lacks


@dataclass(frozen=True, slots=True, eq=False)
class _Passing:
    """What moves about a shot's flight, at the times at which it passes its nodes."""

    path: PathIR
    subject: Subject
    flown: FlownShot

    def half_spaces(self, s: Array) -> NodePlanes:
        """Return half-spaces for nodes at path parameters s, shape (N + 1,)."""
        t = self.flown.times(s) + APART_S * np.arange(len(s))
        t = np.minimum(t, self.flown.curve.end + APART_S * np.arange(len(s)))
        course = self._course(t)
        drone = self.subject.drone
        around = surroundings(self.path, drone, t, standing_too=False)
        camera_task = CameraTask(self.subject.mission, drone, tuple(self._subjects()))
        free = around.free(camera_task, (self.flown.start, self.flown.curve.end), course)
        planes = around.half_spaces(course.ctrl, REACH_M, ROOM_SHARE).and_also(free)
        ends = (planes.piece, planes.piece + 1)
        rows = [np.column_stack([planes.normal, planes.offset[:, end]]) for end in (0, -1)]
        return NodePlanes(np.concatenate(ends), np.concatenate(rows))

    def _course(self, t: Array) -> Piecewise:
        curve = self.flown.curve.channels(0, 1, 2)
        inside = np.minimum(t, curve.end)
        return quintic_hermite(t, *(curve.derivative(k)(inside) if k else curve(inside) for k in range(3)))

    def _subjects(self) -> Iterator[PlacedSubject]:
        """Yield what the shot frames, if that is one target in one place."""
        framed = {(k.target, k.reference) for k in self.subject.placed.keyframes}
        if len(framed) == 1:
            ((target, reference),) = framed
            if target is not None and reference is not None:
                yield PlacedSubject(target, reference, None, None, self.subject.placed.shot.path)
