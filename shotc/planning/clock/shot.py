"""Plan a shot on its own clock: its leg from rest to rest, and its deviation from the ideal."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array, Piecewise
from shotc.geom.sampling import worst_of_runs
from shotc.geom.solid_arrays.points import distances
from shotc.geom.vec import Vec2
from shotc.ir.ideal import ideal_place
from shotc.ir.keyframes import PlacedShot
from shotc.ir.mission import Shot
from shotc.ir.owners import Owner
from shotc.ir.path import LIMITS, SIGHT, ClockDeviation, ClockLeg
from shotc.ir.phases import Reference
from shotc.ir.preference import noted
from shotc.ir.setpoints import required_places
from shotc.planning.clock.aims import CameraTask, camera_task_of
from shotc.planning.clock.between import lacking_each
from shotc.planning.clock.bounds import Bound, bounds_of
from shotc.planning.clock.camera import AngleTask, turn
from shotc.planning.clock.clock import Clock, clock_of
from shotc.planning.clock.ends import END_REQUIREMENTS, EndRequirement, run_up_and_out
from shotc.planning.clock.ideals import ideal_places
from shotc.planning.clock.keyed import keyframe_times
from shotc.planning.clock.moving import Moving, linearised, standing
from shotc.planning.clock.position import PositionResult, fly, held_where_it_rests, standing_by
from shotc.planning.clock.seeing import led_to_see, visible_shares, ways_of
from shotc.planning.clock.task import ClockTask, led
from shotc.planning.clock.visibility import Visibility
from shotc.planning.framing.moments import placed_at, slowed
from shotc.planning.free_space import breaches
from shotc.planning.obstacles import FreeSpaces
from shotc.solvers.conic import Status

LESS_SHARE = 0.8  # ratio of deviations below which another motion is better
FAR_M = 5.0  # metres off the ideal, above which a freer place of rest is tried
NOTICE_M = 0.5  # metres off the ideal, above which a deviation is reported
LEFT_M = 0.1  # metres off the ideal, above which a sample belongs to a reported stretch
LONGER_RATIOS = (1.1, 1.25, 1.5, 2.0, 3.0)  # factors of the duration, tried if keyframes are out of reach
ON_PLACE_M = 1e-3  # metres
SAME_S, SAME_PLACE_M = 1e-6, 1e-9  # seconds, metres
NO_KEYFRAME = -1  # index of a bound place that is no keyframe's
SEEING_ROUNDS = 3  # rounds of leading the motion to where targets are visible
STEP_S = 0.1  # seconds between samples of the deviation
PICTURES = "the pictures of other drones"


@dataclass(frozen=True, slots=True, eq=False)
class OtherVehicles:
    """The moving obstacles of a shot, and the pictures of others that count.

    later : films of drones that are planned later, from which transfers keep away if they can
    """

    moving: tuple[Moving, ...]
    visibility: Visibility
    later: tuple[Moving, ...] = ()


Around = tuple[FreeSpaces, OtherVehicles]
"""The free spaces of a shot, and the other vehicles."""


@dataclass(frozen=True, slots=True, eq=False)
class TimedShot:
    """A planned shot, its deviations from the ideal, and the solver's statistics.

    off : largest deviation from the ideal, metres
    lacks : metres that the run-up and the run-out lack of the clearances of transfers
    """

    leg: ClockLeg
    deviations: tuple[ClockDeviation, ...]
    stats: tuple[tuple[str, float | str], ...]
    off: float
    lacks: tuple[float, float]


class Away(NamedTuple):
    """How far the motion that is nearest to the shot's course passes a keyframe, metres, and when.

    keyframe : its index
    owner : of the obstacle that is too near to its place then, if there is one
    lack : by how much it is too near, metres
    """

    keyframe: int
    distance: float
    t: float
    owner: Owner | None
    lack: float


@dataclass(frozen=True, slots=True)
class Missed:
    """Keyframes that a drone cannot pass at their times.

    away : the farthest first
    longer : feasible factor of the duration and the keyframes' times; None if none was found
    """

    away: tuple[Away, ...]
    longer: float | None


@dataclass(frozen=True, slots=True, eq=False)
class NoMotion:
    """Why a shot has no motion: the solver's status, and the lack of each owner in metres.

    missed : keyframes out of reach, if these are the reason
    start : mission time of the first frame, seconds
    """

    status: Status
    lacks: tuple[tuple[Owner, float], ...]
    what: str = "position"
    missed: Missed | None = None
    start: float = 0.0


def timed_shot(
    camera_task: CameraTask,
    around: Around,
    placed: PlacedShot,
    start: float,
    requirements: tuple[EndRequirement, ...] = END_REQUIREMENTS,
) -> TimedShot | NoMotion:
    """Return the motion of a shot whose first frame is at mission time ``start``, or why there is none.

    If feasible, nothing passes its first and last place for some seconds before and after, so that a drone
    has time to arrive and leave. The clearances of the transfers are checked separately.

    requirements : of its ends, from strict to weak; the first feasible ones are used
    """
    mission, drone = camera_task.mission, camera_task.drone
    placed = placed_at(mission, placed, start)
    task, flown = _flown(
        camera_task_of(mission, drone, placed, start), around, placed.shot, start, requirements
    )
    shot, camera_task, clock = task.shot, task.camera_task, task.clock
    if flown.curve is None:
        missed = _missed(task, around, placed, start) if task.bound else None
        return NoMotion(flown.status, _lacks(task, flown), missed=missed, start=start)
    curve = _with_camera(task, flown.curve)
    if isinstance(curve, Status):
        return NoMotion(curve, (), "camera")
    task, flown, curve = _seeing(_PlannedMotion(task, flown, curve))
    assert flown.curve is not None
    distances = _off_ideal(task, flown.curve)
    keyed, keyframes = camera_task.keyed, keyframe_times(placed, start)
    framing = _framing(placed, clock.start, clock.end) if keyed is None else keyed.framing(shot.id)
    leg = ClockLeg(shot.id, curve, clock.start, clock.end, framing, shot.path, keyframes)
    stats: tuple[tuple[str, float | str], ...] = (
        (f"{shot.id}.pieces", float(len(curve.ctrl))),
        (f"{shot.id}.qp_objective", flown.objective),
        (f"{shot.id}.qp_rounds", float(flown.rounds)),
        (f"{shot.id}.qp_status", str(flown.status)),
        *(() if flown.given_up is None else noted(shot.id, flown.given_up)),
    )
    lacks = lacking_each(task.motions, flown.curve, (clock.start, clock.end))
    deviations = _deviations(task, flown, distances)
    return TimedShot(leg, deviations, stats, float(distances.max()), (lacks[0].any, lacks[1].any))


def _with_camera(task: ClockTask, position: Piecewise) -> Piecewise | Status:
    """Return a motion with camera angles and lens, all channels; or the solver's status if there are no
    angles.
    """
    ideal = task.shot.ideal
    aim = None if ideal is None else ideal.aim
    begin = None if task.begins is None else task.begins.angles
    turned = turn(AngleTask(task.camera_task, aim, begin), task.clock, position)
    if turned.curve is None:
        return turned.status
    lens = _lens(task.camera_task, task.clock)
    return Piecewise(task.clock.breaks, np.concatenate([position.ctrl, turned.curve.ctrl, lens], axis=2))


class _PlannedMotion(NamedTuple):
    """A motion: its task, its position, and all channels of it."""

    task: ClockTask
    flown: PositionResult
    curve: Piecewise


def _seeing(best: _PlannedMotion) -> _PlannedMotion:
    """Return the motion with ways between keyframes led to where targets are visible, if that helps."""
    task = best.task
    spans = ways_of(task)
    if not spans:
        return best
    least = visible_shares(task, spans, best.curve)
    for _ in range(SEEING_ROUNDS):
        led = led_to_see(task, spans, best.curve)
        if led is None:
            break
        motion = fly(led)
        turned = motion.status if motion.curve is None else _with_camera(led, motion.curve)
        if isinstance(turned, Status):
            break
        improved = visible_shares(led, spans, turned)
        if not improved.better(least):
            break
        best, least = _PlannedMotion(led, motion, turned), improved
    return best


def _flown(
    camera_task: CameraTask,
    around: Around,
    shot: Shot,
    start: float,
    requirements: tuple[EndRequirement, ...],
) -> tuple[ClockTask, PositionResult]:
    """Return the motion with the strictest feasible requirements, or the last infeasible one.

    The requirements must not move the film: a motion that deviates from its ideal is replaced by one with
    weaker requirements that deviates much less.
    """
    best, least = None, np.inf
    for required in requirements:
        task = _task(camera_task, around, shot, start, required)
        flown = fly(task)
        if flown.curve is None:
            continue
        off = float(_off_ideal(task, flown.curve).max())
        if best is None or off < LESS_SHARE * least:
            best, least = (task, flown), off
        if off <= NOTICE_M or (off <= FAR_M and not held_where_it_rests(task, flown.curve)):
            break
    return best or (task, flown)


def _task(
    camera_task: CameraTask, around: Around, shot: Shot, start: float, required: EndRequirement
) -> ClockTask:
    """Return the task of the position for given requirements of its ends."""
    spaces, others = around
    near = (*standing(spaces), *others.moving)
    run_ups = run_up_and_out(camera_task, shot, start, required, (near, spaces.flight))
    clock = clock_of(shot, start, run_ups, camera_task.drone.lens)
    motions = tuple(linearised(m, clock.breaks) for m in near)
    passing = standing_by(near, clock.breaks, required.stand)
    bound = bounds_of(camera_task.mission, shot, start)
    task = ClockTask(
        camera_task, shot, clock, run_ups, spaces.flight, motions, passing, others.visibility, bound
    )
    return led(
        task
        if required.begins is None
        else replace(task, begins=required.begins, held=_standing_camera(task))
    )


def _standing_camera(task: ClockTask) -> tuple[Bound, ...]:
    """Return the place of a standing camera that the author gave, for a run-up whose beginning is given;
    otherwise that camera would still come to rest in the first frames.
    """
    shot, clock = task.shot, task.clock
    if shot.ideal is None or not shot.ideal.placed:
        return ()
    places = ideal_places(task.mission, shot, clock.start, _filmed(task))
    if np.ptp(places, axis=0).max() > SAME_PLACE_M:
        return ()
    x, y, z = map(float, places[0])
    return (Bound(NO_KEYFRAME, (x, y, z), clock.start, clock.end),)


def _missed(task: ClockTask, around: Around, placed: PlacedShot, start: float) -> Missed | None:
    """Return which keyframes are out of reach; None if the shot is infeasible without them as well."""
    free = fly(replace(task, free=True)).curve
    if free is None:
        return None
    missed = []
    for b in task.bound:
        place = np.array(b.place)
        owner, lack = _in_the_way(task, place, b.start) or (None, 0.0)
        missed.append(Away(b.index, float(np.linalg.norm(free(b.start) - place)), b.start, owner, lack))
    far = tuple(sorted((a for a in missed if a.distance > ON_PLACE_M), key=lambda a: -a.distance))
    for longer in LONGER_RATIOS:
        slower = slowed(task.mission, placed, start, longer)
        camera_task = camera_task_of(task.mission, task.drone, slower, start)
        if fly(_task(camera_task, around, slower.shot, start, END_REQUIREMENTS[-1])).curve is not None:
            return Missed(far, longer)
    return Missed(far, None)


def _lens(camera_task: CameraTask, clock: Clock) -> Array:
    """Return the control points of the field of view on a clock's pieces, shape (P, 6, 1), rad."""
    if camera_task.keyed is not None:
        return camera_task.keyed.lens(clock.breaks).ctrl
    return np.full((len(clock.breaks) - 1, 6, 1), camera_task.drone.hfov)


def _lacks(task: ClockTask, flown: PositionResult) -> tuple[tuple[Owner, float], ...]:
    if flown.relaxation is None:
        return ()
    lacks = zip(task.owners, flown.relaxation.owner_lack, strict=True)
    return tuple((owner, float(lack)) for owner, lack in lacks if lack > 1e-3)


def _framing(placed: PlacedShot, start: float, end: float) -> tuple[Reference, ...]:
    spans = []
    for subject in placed.subjects:
        reference = None
        if subject.reference is not None:
            reference = _place_curve(required_places(subject.reference, subject.setpoints), start, end)
        spans.append(Reference(placed.shot.id, subject.target, start, end, reference))
    return tuple(spans)


def _place_curve(known: Sequence[tuple[float, Vec2]], start: float, end: float) -> Piecewise:
    """Return the curve of a subject's reference on screen, from the times of its shot at which it is given.

    Three equal control points at either end make the quintic that rests there, as in ``ir.setpoints``.
    """
    places = [place for _, place in known]
    breaks = [start + t for t, _ in known]
    pieces = [[a] * 3 + [b] * 3 for a, b in pairwise(places)]
    if end - breaks[-1] > SAME_S:
        breaks.append(end)
        pieces.append([places[-1]] * 6)
    return Piecewise(np.array([*breaks[:-1], end]), np.array(pieces, dtype=np.float64))


def _deviations(task: ClockTask, flown: PositionResult, off_ideal: Array) -> tuple[ClockDeviation, ...]:
    """Return the worst deviation of each interval off the ideal; off_ideal : as of ``_off_ideal``."""
    times = _filmed(task)
    return tuple(
        ClockDeviation(
            task.shot.id, float(off_ideal[i]), float(times[i]), _cause(task, flown, float(times[i]))
        )
        for i in worst_of_runs(off_ideal, LEFT_M, NOTICE_M)
    )


def _filmed(task: ClockTask) -> Array:
    """Return the times at which the film is compared with its ideal, shape (M,)."""
    return np.append(np.arange(task.clock.start, task.clock.end, STEP_S), task.clock.end)


def _off_ideal(task: ClockTask, curve: Piecewise) -> Array:
    """Return the distances of the camera from its ideal at those times, metres, shape (M,)."""
    times = _filmed(task)
    ideal = ideal_places(task.mission, task.shot, task.clock.start, times)
    return np.asarray(np.linalg.norm(curve(times) - ideal, axis=1))


def _cause(task: ClockTask, flown: PositionResult, t: float) -> str:
    near = _in_the_way(task, np.array(ideal_place(task.mission, task.shot, task.clock.start, t)), t)
    if near is not None:
        return str(near[0])
    if flown.freed:
        return PICTURES
    course = task.course
    for_sight = course is not None and np.interp(t, task.clock.breaks, course.for_sight) > 0.0
    return SIGHT if for_sight else LIMITS


def _in_the_way(task: ClockTask, place: Array, t: float) -> tuple[Owner, float] | None:
    """Return the owner of an obstacle too near to a place, shape (3,), at a time, and the lack in metres."""
    near = breaches(task.space, place)
    if near:
        return near[0].owner, near[0].lack
    for motion in task.motions:
        relative = place[None] - motion.what.at(np.array([t]))
        lack = motion.what.clearance - float(distances(motion.what.part, relative)[0])
        if lack > 0.0:
            return motion.what.owner, lack
    return None
