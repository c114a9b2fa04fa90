"""Refines shots in a mission with a clock, where other drones and targets move near them.

First, a shot on a path is refined alone and takes the time of its convex path, so that nothing planned around
it has to change. Then half-spaces at the nodes keep it away from what comes too near at the nodes' times, and
the shot is solved again.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from shotc.plugin_api import Diagnostic, MovingLeg, Outcome, PassContext, PathIR, Piecewise, unrefined
from shotc.plugin_api.refiner import (
    MOST_MOVED_SHARE,
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
from shotc_casadi.conditions import AimCondition
from shotc_casadi.margins import REACH_M
from shotc_casadi.messages import stats
from shotc_casadi.proof import PROVED_M
from shotc_casadi.references import ShotContext, subject_of
from shotc_casadi.report import deviation, report
from shotc_casadi.rounds import Refined, refine_shot
from shotc_casadi.walls import NodePlanes

MOST_TRIES = 3  # with half-spaces about the last refined path; one more about the convex path, which is clear
APART_S = 1e-6  # seconds at least between two nodes
DEEPER_SHARE = 0.05  # a drone that is already in a picture may come this share deeper into it
ROOM_SHARE = 0.5  # share of the room beside a wall that is kept; moving obstacles have their own share


def refine_in_company(path: PathIR, ctx: PassContext, condition: AimCondition) -> Outcome[PathIR]:
    """Return the path with every shot refined, drone by drone in order of priority.

    Shots on their own clock have no keyframes to interpolate, so only conditions that frame refine them.
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


def _refined(path: PathIR, subject: ShotContext, condition: AimCondition) -> tuple[PathIR, list[Diagnostic]]:
    """Return the path with one shot on a path refined, and its diagnostics."""
    shot, task, why, needs = subject.placed.shot.id, subject, "", None
    plain: tuple[Refined, PathIR] | None = None  # the first solution that is only against a preference
    for tries in range(1, MOST_TRIES + 2):
        refined = refine_shot(task, condition)
        if refined.camera is None and not why:
            error = report(path, refined, condition.name)
            return path, [] if error is None else [error]
        moved = path  # the next attempt is put beside the flights of this path
        if refined.camera is not None:
            try:
                moved = rejoined(path, {shot: refined.camera})
            except NoTransit as fault:
                why, needs = f"the refined path cannot keep {fault}", fault.least
                if task.leg.duration is not None:
                    break
                task = task._replace(leg=subject.leg.given(leg_time(subject.drone, subject.leg)))
                continue
            against = _against(path, moved, subject)
            if against is None and (plain is None or _near(subject, refined, plain[0])):
                return _result(path, moved, refined, condition)
            if against in (None, IN_PICTURE) and prefers_free_pictures(subject.mission):
                plain = plain or (refined, moved)
            why = against or IN_PICTURE
        course = path if tries == MOST_TRIES else moved
        task = task._replace(beside=_Passing(course, subject, flown_shot(course, shot)).half_spaces)
    if plain is not None:
        return _result(path, plain[1], plain[0], condition)
    left = path if needs is None else with_need(path, shot, needs)
    return left, [unrefined(path, shot, why)]


def _near(subject: ShotContext, refined: Refined, plain: Refined) -> bool:
    """Return whether a refined shot moved no farther from ``plain`` than a preference may move it."""
    assert refined.camera is not None
    assert plain.camera is not None
    s = plain.nodes.s
    before, after = plain.camera(s)[:, :3], refined.camera(s)[:, :3]
    named = {k.target for k in subject.placed.keyframes if k.target is not None}
    centres = [np.array(subject.mission.target(name).centre) for name in named]
    distances = np.min([np.linalg.norm(before - centre, axis=1) for centre in centres] or [np.inf], axis=0)
    return bool((np.linalg.norm(after - before, axis=1) <= MOST_MOVED_SHARE * distances).all())


def _result(
    path: PathIR, moved: PathIR, refined: Refined, condition: AimCondition
) -> tuple[PathIR, list[Diagnostic]]:
    """Return the path with a refined shot, its statistics and its diagnostics."""
    warning = report(path, refined, condition.name)
    entries = stats(refined.shot, refined.rounds, refined.solution)
    left = (*moved.deviations, *deviation(path, refined))
    whole = replace(moved, stats=(*moved.stats, *entries), deviations=left)
    return whole, [] if warning is None else [warning]


def _against(before: PathIR, after: PathIR, subject: ShotContext) -> str | None:
    """Return why a refined shot may not be flown, or None if it may.

    A lack that the convex path has as well does not count: verification decides on that.
    """
    lacks = _lacking(after, subject)
    known = _lacking(before, subject) if lacks else {}
    for owner, lack in lacks.items():
        if lack > known.get(owner, 0.0) + PROVED_M:
            return f"the refined path comes {lack:.2g} m too near to {owner}"
    free = least_out(before)
    return IN_PICTURE if least_out(after) < min(OUT_M, free - DEEPER_SHARE * abs(free)) else None


def _lacking(path: PathIR, subject: ShotContext) -> dict[str, float]:
    """Return the lack of clearance, metres, of each moving obstacle that is not proved clear."""
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
    """The moving obstacles around a shot, at the times at which it passes its nodes."""

    path: PathIR
    subject: ShotContext
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
        """Yield the subject of the shot if it is one target at one place on screen."""
        framed = {(k.target, k.reference) for k in self.subject.placed.keyframes}
        if len(framed) == 1:
            ((target, reference),) = framed
            if target is not None and reference is not None:
                yield PlacedSubject(target, reference, None, None, self.subject.placed.shot.path)
