"""Write the mission as YAML of shotc, with each assumption as a comment above the lines that it is about."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from collections.abc import Sequence as Rows
from typing import NamedTuple

from shotc.importers.multidrone.films import FilmedAction, films_of
from shotc.importers.multidrone.frames import CoordinateFrame
from shotc.importers.multidrone.framing import composition_of, size_of
from shotc.importers.multidrone.read import Sequence
from shotc.importers.multidrone.scene import drones, targets, world
from shotc.importers.multidrone.shots import shot_of
from shotc.importers.multidrone.targets import LEAD_S
from shotc.importers.multidrone.timing import task_of, timed
from shotc.importers.notes import Notes, plain
from shotc.importers.words import safe_name
from shotc.importers.xml_tree import Node

HEAD = "# Imported from a mission of the MultiDrone project."


class FilmMission(NamedTuple):
    """A mission as text, and its numbers of drones and shots."""

    text: str
    drones: int
    shots: int


def written_mission(
    name: str, root: Node, sequences: Rows[Sequence], frame: CoordinateFrame, notes: Notes
) -> FilmMission | None:
    """Return a mission with this name, None if nothing is left to film."""
    films = list(timed(films_of(sequences, frame, notes), frame, notes))
    if not films:
        return None
    number = max(film.first + len(film.action.roles) - 1 for film in films)
    lines = [
        "shotc: 1",
        f"mission: {safe_name(name)}",
        *world(frame),
        *targets(films, root, frame, notes),
        *drones(films, number, root, notes),
        "shots:",
        f"  # {_event(root, notes)}",
    ]
    said = set(lines)
    for film in films:
        shots = [line for k in range(len(film.action.roles)) for line in _shot(film, k, frame, notes)]
        said.update(shots)
        lines += [*_not_yet_written(notes.below(film.action.node), said), *shots]
        said.update(lines)
    lines = [HEAD, *(line.strip() for line in _not_yet_written(notes.below(root), said)), *lines]
    return FilmMission("\n".join([*lines, ""]), number, sum(len(film.action.roles) for film in films))


def _not_yet_written(comments: Iterable[str], said: set[str]) -> Iterator[str]:
    """Yield the lines of comments that are not in ``said`` yet, with or without indent."""
    for comment in comments:
        if not {f"# {comment}", f"  # {comment}"} & said:
            yield f"  # {comment}"


def _event(root: Node, notes: Notes) -> str:
    event = plain(root.attributes.get("eventRef", ""), 40)
    name = f"its event `{event}`" if event else "an event that it does not name"
    message = f"the file counts time from {name}, whose time is not known"
    return notes.assume(root, message, f"the event is {LEAD_S:g} s after the first take-off")


def _shot(film: FilmedAction, k: int, frame: CoordinateFrame, notes: Notes) -> list[str]:
    role = film.action.roles[k]
    task = task_of(film, role, frame, notes)
    shot = shot_of(task)
    which = f"-{k + 1}" if len(film.action.roles) > 1 else ""
    fields = [
        f"id: {film.id}{which}-{safe_name(role.kind).lower()}",
        f"kind: {shot.kind}",
        f"drone: cam{film.first + k}",
    ]
    size, said = size_of(role, shot.watches, shot.fixed, notes)
    if shot.watches:
        composition, why = composition_of(role, film.course, shot.path[1][:2], task.middle, notes)
        said += why
        fields += [f"target: {film.target}", f"composition: {composition}"]
    if size:
        fields.append(f"size: {size}")
    comments = [*(film.comments if k == 0 else ()), *shot.comments, *said]
    return [
        *(f"  # {text}" for text in comments),
        f"  - {{{', '.join(fields)},",
        f"     {shot.params},",
        f"     timing: {{start: {film.start:g}, duration: {film.duration:g}}}}}",
    ]
