"""Which action is filmed when, of which target, by which drones."""

from __future__ import annotations

from collections.abc import Iterator
from collections.abc import Sequence as Rows
from typing import NamedTuple

from shotc.importers.multidrone.frames import Frame
from shotc.importers.multidrone.read import Action, Sequence
from shotc.importers.multidrone.targets import LEAD, NEAR, OVERLAP, SAME, Course, courses_of, gap, route_of
from shotc.importers.notes import Notes

CHANGE, SHARE = 16.0, 0.6  # seconds to change from shot to shot, and the most of a shot that takes
SHORTEST = 2.0  # seconds
WATCHING = frozenset(("STATIC", "ELEVATOR", "FLY_THROUGH", "FLYTHROUGH"))


class Film(NamedTuple):
    """An action with its target, as it is filmed.

    start, lasts : mission time and length, seconds; first : number of the first of its drones
    """

    id: str
    action: Action
    course: Course
    target: str
    start: float
    lasts: float
    first: int
    comments: tuple[str, ...]


class _Target(NamedTuple):
    """A target that has been seen; identity : the number that the file gives it, or None."""

    name: str
    course: Course
    identity: float | None


def films_of(sequences: Rows[Sequence], frame: Frame, notes: Notes) -> Iterator[Film]:
    """Return all that is filmed, sequence by sequence; a sequence has drones of its own."""
    targets: list[_Target] = []
    first = 1
    for number, sequence in enumerate(sequences, 1):
        begins, follows = LEAD, False
        courses = courses_of(sequence, frame, notes)
        for k, (action, known) in enumerate(zip(sequence.actions, courses, strict=True), 1):
            start, begins = begins, begins + action.duration
            if known is None and not (action.flies and (action.points or action.origin)):
                notes.assume(action.node, "an action that says nowhere where its target is", "it is left out")
                continue
            course = route_of(action, frame, start) if known is None else known
            name, said = ("", ()) if known is None else _name(action, known, targets, notes)
            start, lasts, more = _window(action, course, start, follows, notes)
            follows = True
            yield Film(f"s{number}-{k}", action, course, name, start, lasts, first, (*said, *more))
        first += max(len(action.roles) for action in sequence.actions)


def _name(
    action: Action, course: Course, targets: list[_Target], notes: Notes
) -> tuple[str, tuple[str, ...]]:
    """Return the name of the target with this course, which may be a new one, and comments."""
    identity = next((role.params["ID"] for role in action.roles if "ID" in role.params), None)
    node = action.node.first("RTTrajectory") or action.node
    for known in targets:
        apart = gap(known.course, course)
        if apart < NEAR and (known.identity == identity or None in (known.identity, identity)):
            if apart < SAME:
                return known.name, ()
            message = f"the way of one target is told again, and up to {apart:.1f} m beside"
            return known.name, (notes.assume(node, message, f"{known.name}, as it was told first"),)
    name = f"target{len(targets) + 1}"
    other = next((t.name for t in targets if identity is not None and t.identity == identity), None)
    targets.append(_Target(name, course, identity))
    if other is None:
        return name, ()
    message = f"target {identity:g} goes another way here than before"
    return name, (notes.assume(node, message, f"{name}, beside {other}"),)


def _window(
    action: Action, course: Course, start: float, follows: bool, notes: Notes
) -> tuple[float, float, tuple[str, ...]]:
    """Return when an action is filmed and how long, and comments.

    It ends where nothing more is known of its target, if its camera goes with that.
    """
    said: list[str] = []
    lasts = action.duration
    if follows:
        change = min(CHANGE, SHARE * lasts)
        message, taken = (
            "the action begins as the last one ends",
            f"the drones change places for {change:g} s",
        )
        said.append(notes.assume(action.node, message, taken))
        start, lasts = start + change, lasts - change
    known = course.times[-1] - start
    goes_along = any(role.kind.replace(" ", "_") not in WATCHING for role in action.roles)
    if goes_along and not course.stands and SHORTEST < known < lasts - OVERLAP:
        node = action.node.first("duration") or action.node
        message = (
            f"the action lasts {action.duration:g} s, but the way of its target is told for {known:.1f} s"
        )
        said.append(notes.assume(node, message, "the shot ends with the way"))
        lasts = round(known, 2)
    return start, lasts, tuple(said)
