"""Find the time of each action: its drones first fly there from the end of their last shot."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from math import dist

from shotc.geom.vec import Vec3
from shotc.importers.multidrone.films import FilmedAction
from shotc.importers.multidrone.frames import CoordinateFrame
from shotc.importers.multidrone.read import Role
from shotc.importers.multidrone.shots import shot_of
from shotc.importers.multidrone.targets import OVERLAP_S
from shotc.importers.multidrone.task import RoleTask
from shotc.importers.notes import Notes

SETTLE_S, PACE_M_S = 9.0, 3.0  # seconds to leave one shot and enter the next, and m/s between them
TRANSFER_SHARE = 0.6  # largest share of an action's duration for the flight of its drones to their places
SHORTEST_S = 2.0  # seconds
WATCHING = frozenset(("STATIC", "ELEVATOR", "FLY_THROUGH", "FLYTHROUGH"))


def timed(films: Iterable[FilmedAction], frame: CoordinateFrame, notes: Notes) -> Iterator[FilmedAction]:
    """Yield the films with the times at which the drones can film them."""
    ended: dict[int, Vec3] = {}
    for film in films:
        unheard = Notes()
        uncut = _cut(film, 0.0, unheard)
        starts = [shot_of(task_of(uncut, role, frame, unheard)).path[0] for role in film.action.roles]
        lengths = [dist(ended[k], at) for k, at in enumerate(starts, film.first) if k in ended]
        cut = _cut(film, round(SETTLE_S + max(lengths) / PACE_M_S, 1) if lengths else 0.0, notes)
        for k, role in enumerate(film.action.roles, film.first):
            ended[k] = shot_of(task_of(cut, role, frame, unheard)).path[2]
        yield cut


def task_of(film: FilmedAction, role: Role, frame: CoordinateFrame, notes: Notes) -> RoleTask:
    """Return the data to make a shot from one role of a film."""
    return RoleTask(film.action, role, film.course, frame, film.start, film.duration, film.target, notes)


def _cut(film: FilmedAction, change: float, notes: Notes) -> FilmedAction:
    """Return a film with its time, after ``change`` seconds for the drones to change places.

    If a camera moves with the target, the film ends where the target's course ends.
    """
    action, said = film.action, list(film.comments)
    start, duration = film.start, film.duration
    if change > 0:
        change = min(change, TRANSFER_SHARE * duration)
        message = "the action begins as the last one ends"
        said.append(notes.assume(action.node, message, f"the drones change places for {change:g} s"))
        start, duration = round(start + change, 2), round(duration - change, 2)
    if start < film.course.times[0]:
        start = film.course.times[0]
        message = "the action begins before its target is anywhere"
        said.append(notes.assume(action.node, message, f"it begins at {start:g} s"))
    known = film.course.times[-1] - start
    goes_along = any(role.kind.replace(" ", "_") not in WATCHING for role in action.roles)
    if goes_along and not film.course.stands and SHORTEST_S < known < duration - OVERLAP_S:
        node = action.node.first("duration") or action.node
        course_s = film.course.times[-1] - film.start
        message = (
            f"the action lasts {action.duration:g} s, the path of its target is given for {course_s:.1f} s"
        )
        said.append(notes.assume(node, message, "the shot ends with the way"))
        duration = round(known, 2)
    return film._replace(start=start, duration=duration, comments=tuple(said))
