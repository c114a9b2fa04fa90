"""The task of one shot on its own clock, and the reference positions of its motion."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from shotc.geom.bernstein import Array
from shotc.ir.allow import hidden_on_purpose
from shotc.ir.bodies import moved
from shotc.ir.drone import Drone
from shotc.ir.hiding_surfaces import surfaces_before
from shotc.ir.mission import MissionIR, Shot
from shotc.ir.owners import Owner
from shotc.planning.clock.aims import CameraTask
from shotc.planning.clock.bounds import Bound
from shotc.planning.clock.clock import Clock
from shotc.planning.clock.ideals import ideal_places
from shotc.planning.clock.moving import LinearMotion
from shotc.planning.clock.run_up import Departure, Link, RunUp
from shotc.planning.clock.visibility import Visibility
from shotc.planning.free_space import FreeSpace
from shotc.planning.layered import VisiblePath, VisibleSubject, led_round
from shotc.solvers.spline_problem import HalfSpaceRows

ROUNDING_S = 1e-9  # seconds


@dataclass(frozen=True, slots=True, eq=False)
class ClockTask:
    """One shot to be planned.

    camera_task : the drone and its subjects
    ways : run-up and run-out
    motions : standing and moving obstacles, linearised on the clock's pieces
    passing : obstacles while the drone stands at the start of the motion, and at its end
    space : free space of the drone
    visibility : pictures of others that count
    bound : places that it passes at given times
    free : whether ``bound`` is ignored
    held : other places that it passes, always
    begins : where its run-up begins; None if it begins at rest anywhere
    apart : half-spaces for the clearances of transfers in run-up and run-out
    course : initial guess at the clock's breaks, for corridors; the ideal where it is None
    """

    camera_task: CameraTask
    shot: Shot
    clock: Clock
    ways: tuple[RunUp | Link, RunUp]
    space: FreeSpace
    motions: tuple[LinearMotion, ...]
    passing: tuple[tuple[LinearMotion, ...], tuple[LinearMotion, ...]]
    visibility: Visibility
    bound: tuple[Bound, ...] = ()
    free: bool = False
    held: tuple[Bound, ...] = ()
    begins: Departure | None = None
    apart: tuple[HalfSpaceRows, ...] = ()
    course: VisiblePath | None = None

    @property
    def mission(self) -> MissionIR:
        """The mission."""
        return self.camera_task.mission

    @property
    def drone(self) -> Drone:
        """The drone that flies."""
        return self.camera_task.drone

    @property
    def owners(self) -> tuple[Owner, ...]:
        """Owners of all obstacles, by index: those of the walls, then those of the motions."""
        return (*self.walls.owners, *(m.what.owner for m in self.motions))

    @property
    def walls(self) -> FreeSpace:
        """The free space without its obstacles."""
        return self.space.bounds


def ideal_of(task: ClockTask, times: Array) -> Array:
    """Return the reference positions: the ideal in the film, and the run-up and run-out outside of it.

    times : shape (M,), mission time; result (M, 3)
    """
    clock, (before, after) = task.clock, task.ways
    inside = np.clip(times, clock.start, clock.end)
    filmed = ideal_places(task.mission, task.shot, clock.start, inside)
    early, late = (times < clock.start)[:, None], (times > clock.end)[:, None]
    led = np.where(early, before.at(times - clock.start), filmed)
    return np.asarray(np.where(late, after.at(times - clock.end), led))


def led(task: ClockTask) -> ClockTask:
    """Return the task with a course around meshes, and to where its subject is visible."""
    breaks, near = task.clock.breaks, [motion.what for motion in task.motions]
    course = led_round(task.walls, near, (breaks, ideal_of(task, breaks)), _watched(task))
    return replace(task, course=course)


def _watched(task: ClockTask) -> VisibleSubject | None:
    """Return the subject to see at the clock's breaks; None where the author gave the camera's places."""
    mission, camera_task, ideal = task.mission, task.camera_task, task.shot.ideal
    bound = (
        not (mission.meshes or mission.terrain)
        or ideal is None
        or ideal.placed
        or camera_task.keyed is not None
    )
    if bound or not camera_task.subjects or hidden_on_purpose(task.shot):
        return None
    times, target = task.clock.breaks, mission.target(camera_task.subjects[0].target)
    filmed = (times >= task.clock.start - ROUNDING_S) & (times <= task.clock.end + ROUNDING_S)
    surfaces = tuple(surface for _, surface in surfaces_before(mission, target.name))
    places = np.array(target.centre) + moved(target, times)
    return VisibleSubject(places, filmed, target.radius, target.height, surfaces)


def drawn_to(task: ClockTask, times: Array) -> Array:
    """Return the reference positions: the ideal, or the course where that leads to see the subject.

    times : shape (M,), mission time; result (M, 3)
    """
    ideal, course, breaks = ideal_of(task, times), task.course, task.clock.breaks
    if course is None or not course.for_sight.any():
        return ideal
    shift = course.for_sight[:, None] * (course.places - ideal_of(task, breaks))
    return ideal + np.column_stack([np.interp(times, breaks, shift[:, axis]) for axis in range(3)])
