"""When each action is filmed: after its drones have come from where their last shot ended."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from math import dist

from shotc.geom.vec import Vec3
from shotc.importers.multidrone.films import FilmedAction
from shotc.importers.multidrone.frames import CoordinateFrame
from shotc.importers.multidrone.read import Role
from shotc.importers.multidrone.shots import shot_of
from shotc.importers.multidrone.targets import OVERLAP
from shotc.importers.multidrone.task import RoleTask
from shotc.importers.notes import Notes

SETTLE, PACE = 9.0, 3.0  # seconds to leave one shot and enter the next, and m/s between them
SHARE = 0.6  # of an action that its drones may need to change places
SHORTEST = 2.0  # seconds
WATCHING = frozenset(("STATIC", "ELEVATOR", "FLY_THROUGH", "FLYTHROUGH"))


def timed(films: Iterable[FilmedAction], frame: CoordinateFrame, notes: Notes) -> Iterator[FilmedAction]:
    """Return films with the times at which they can be filmed."""
    ended: dict[int, Vec3] = {}
    for film in films:
        unheard = Notes()
        asked = _cut(film, 0.0, unheard)
        begins = [shot_of(task_of(asked, role, frame, unheard)).path[0] for role in film.action.roles]
        ways = [dist(ended[k], at) for k, at in enumerate(begins, film.first) if k in ended]
        found = _cut(film, round(SETTLE + max(ways) / PACE, 1) if ways else 0.0, notes)
        for k, role in enumerate(film.action.roles, film.first):
            ended[k] = shot_of(task_of(found, role, frame, unheard)).path[2]
        yield found


def task_of(film: FilmedAction, role: Role, frame: CoordinateFrame, notes: Notes) -> RoleTask:
    """Return what has to be known to make a shot of one role of a film."""
    return RoleTask(film.action, role, film.course, frame, film.start, film.duration, film.target, notes)


def _cut(film: FilmedAction, change: float, notes: Notes) -> FilmedAction:
    """Return a film with its time, once the drones have had so many seconds to change places.

    It ends where nothing more is known of its target, if its camera goes with that.
    """
    action, said = film.action, list(film.comments)
    start, duration = film.start, film.duration
    if change > 0:
        change = min(change, SHARE * duration)
        message = "the action begins as the last one ends"
        said.append(notes.assume(action.node, message, f"the drones change places for {change:g} s"))
        start, duration = round(start + change, 2), round(duration - change, 2)
    if start < film.course.times[0]:
        start = film.course.times[0]
        message = "the action begins before its target is anywhere"
        said.append(notes.assume(action.node, message, f"it begins at {start:g} s"))
    known = film.course.times[-1] - start
    goes_along = any(role.kind.replace(" ", "_") not in WATCHING for role in action.roles)
    if goes_along and not film.course.stands and SHORTEST < known < duration - OVERLAP:
        node = action.node.first("duration") or action.node
        told = film.course.times[-1] - film.start
        message = f"the action lasts {action.duration:g} s, the way of its target is told for {told:.1f} s"
        said.append(notes.assume(node, message, "the shot ends with the way"))
        duration = round(known, 2)
    return film._replace(start=start, duration=duration, comments=tuple(said))
