"""Assign a time, a target and drones to each action."""

from __future__ import annotations

from collections.abc import Iterator
from collections.abc import Sequence as Rows
from typing import NamedTuple

from shotc.importers.multidrone.frames import CoordinateFrame
from shotc.importers.multidrone.read import Sequence, ShootingAction
from shotc.importers.multidrone.targets import (
    LEAD_S,
    SAME_POINT_M,
    SAME_TARGET_M,
    GroundTrack,
    courses_of,
    gap,
    route_of,
)
from shotc.importers.notes import Notes, plain
from shotc.rounding import at_least


class FilmedAction(NamedTuple):
    """An action with its target, its time and its drones.

    target   : its name, empty if the cameras fly through; then ``course`` is the course of the cameras
    start    : mission time, seconds
    duration : seconds
    first    : number of the first of its drones
    main     : whether its drones are planned before those of a secondary sequence
    """

    id: str
    action: ShootingAction
    course: GroundTrack
    target: str
    start: float
    duration: float
    first: int
    main: bool
    comments: tuple[str, ...]


class _Target(NamedTuple):
    """A target of an earlier action. ``identity``: its number in the file, or None."""

    name: str
    course: GroundTrack
    identity: float | None


def films_of(sequences: Rows[Sequence], frame: CoordinateFrame, notes: Notes) -> Iterator[FilmedAction]:
    """Yield all filmed actions, sequence by sequence. Each sequence has its own drones."""
    targets: list[_Target] = []
    first = 1
    for number, sequence in enumerate(sequences, 1):
        clock = LEAD_S
        courses = courses_of(sequence, frame, notes)
        for k, (action, known) in enumerate(zip(sequence.actions, courses, strict=True), 1):
            start, clock = clock, clock + action.duration
            if known is None and not (action.flies and (action.points or action.origin)):
                notes.assume(action.node, "an action that says nowhere where its target is", "it is left out")
                continue
            course = route_of(action, frame, start) if known is None else known
            name, said = ("", ()) if known is None else _name(action, known, targets, notes)
            if k == 1:
                said = (f"sequence `{plain(sequence.name, 60)}`", *said)
            yield FilmedAction(
                f"s{number}-{k}", action, course, name, start, action.duration, first, sequence.main, said
            )
        first += max(len(action.roles) for action in sequence.actions)


def _name(
    action: ShootingAction, course: GroundTrack, targets: list[_Target], notes: Notes
) -> tuple[str, tuple[str, ...]]:
    """Return the name of the known or new target with this course, and comments."""
    identity = next((role.params["ID"] for role in action.roles if "ID" in role.params), None)
    node = action.node.first("RTTrajectory") or action.node
    for known in targets:
        apart = gap(known.course, course)
        if apart < SAME_TARGET_M and (known.identity == identity or None in (known.identity, identity)):
            if apart < SAME_POINT_M:
                return known.name, ()
            message = f"the path of one target is given again, and up to {at_least(apart, 1)} m beside"
            return known.name, (notes.assume(node, message, f"{known.name}, as it was given first"),)
    name = f"target{len(targets) + 1}"
    other = next((t.name for t in targets if identity is not None and t.identity == identity), None)
    targets.append(_Target(name, course, identity))
    if other is None:
        return name, ()
    message = f"target {identity:g} goes another way here than before"
    return name, (notes.assume(node, message, f"{name}, beside {other}"),)
