"""The mission as text: YAML of ours, with every assumption as a comment above what it is about."""

from __future__ import annotations

import re
from collections.abc import Iterator
from collections.abc import Sequence as Rows
from math import cos, sin
from typing import NamedTuple

from shotc.importers.multidrone.films import Film, films_of
from shotc.importers.multidrone.frames import Frame, written
from shotc.importers.multidrone.framing import composition_of, size_of
from shotc.importers.multidrone.read import Role, Sequence, below
from shotc.importers.multidrone.shots import shot_of
from shotc.importers.multidrone.targets import LEAD, Course
from shotc.importers.multidrone.task import Task
from shotc.importers.notes import Notes, plain
from shotc.importers.xml_tree import Node

SIZES = {
    "TARGET_BOAT": (2.0, 1.5),
    "TARGET_CYCLIST": (0.9, 1.8),
    "TARGET_RUNNER": (0.4, 1.8),
    "TARGET_MONUMENT": (3.0, 10.0),
}
USUAL = (1.0, 1.8)  # radius and height of a target of no known sort, metres
APART = 6.0  # metres between two homes
AWAY = 20.0  # metres from the first target's start to the homes


class Written(NamedTuple):
    """A mission as text, and how many drones film how many shots in it."""

    text: str
    drones: int
    shots: int


def written_mission(
    name: str, root: Node, sequences: Rows[Sequence], frame: Frame, notes: Notes
) -> Written | None:
    """Return a mission, None where nothing is left to film; name : of the mission."""
    films = list(films_of(sequences, frame, notes))
    if not films:
        return None
    drones = max(film.first + len(film.action.roles) - 1 for film in films)
    lines = [
        "# Imported from a mission of the MultiDrone project.",
        "shotc: 1",
        f"mission: {_safe(name)}",
        *_world(frame),
        *_targets(films, root, frame, notes),
        "drones:",
        *_drones(films, drones, root, notes),
        *_rules(),
        "shots:",
        f"  # {_event(root, notes)}",
    ]
    for film in films:
        for k, role in enumerate(film.action.roles):
            lines += _shot(film, k, role, frame, notes)
    return Written("\n".join([*lines, ""]), drones, sum(len(film.action.roles) for film in films))


def _world(frame: Frame) -> Iterator[str]:
    yield from (f"# {comment}" for comment in frame.comments)
    if frame.origin is not None:
        yield f"world: {{origin: {{lat: {frame.origin[0]:.7f}, lon: {frame.origin[1]:.7f}, alt: 0}}}}"


def _targets(films: Rows[Film], root: Node, frame: Frame, notes: Notes) -> Iterator[str]:
    courses = {film.target: film.course for film in reversed(films) if film.target}
    if not courses:
        return
    yield "targets:"
    sort = next((node for types in root.all("targetTypes") for node in types.all("targetType")), None)
    name = "" if sort is None else sort.value("name")
    radius, height = SIZES.get(name, USUAL)
    message = "the file does not say how large its targets are"
    if name not in SIZES:
        message += ", nor what they are" if sort is None else f", and `{plain(name, 30)}` is not known"
    size = f"radius {radius:g} m, height {height:g} m"
    yield f"  # {notes.assume(sort or root.first('targetTypes') or root, message, size)}"
    yield from (f"  # {comment}" for comment in _ground(films, notes))
    body = f"radius: {radius:g}, height: {height:g}}}"
    for target, course in sorted(courses.items()):
        yield from _target(target, course, [frame.written(p, height / 2) for p in course.points], body)


def _target(name: str, course: Course, places: list[str], body: str) -> Iterator[str]:
    yield from (f"  # {comment}" for comment in course.comments)
    if course.stands:
        yield f"  {name}: {{at: {places[0]}, {body}"
        return
    yield f"  {name}:"
    yield f"    {{track: {{points: [{', '.join(places)}],"
    yield f"      times: [{', '.join(f'{t:.2f}' for t in course.times)}]}}, {body}"


def _ground(films: Rows[Film], notes: Notes) -> Iterator[str]:
    """Say that altitudes of points are not flown: the project's own planner does not read them, either."""
    points = [p for film in films for p in film.action.points]
    odd = [p for p in points if p.z != 0]
    if not odd:
        return
    given = sorted({p.z for p in odd if p.z is not None})
    shown = "none" if not given else f"{given[0]:g}" if len(given) == 1 else f"{given[0]:g} to {given[-1]:g}"
    node = odd[0].node.first("altitude") or odd[0].node
    message = f"the altitude of {len(odd)} of {len(points)} points is {shown}"
    yield notes.assume(node, message, "targets go on the ground, z = 0, as in the project's own planner")


def _drones(films: Rows[Film], number: int, root: Node, notes: Notes) -> Iterator[str]:
    team = [node for node in below(root, "drone") if node.value("name")][:number]
    message = "the file does not say what its drones are, nor where they stand"
    if len(team) < number:
        message = (
            f"the file names {len(team)} drones, its shots need {number}; it does not say where they stand"
        )
    taken = f"folding camera drones, {APART:g} m apart, {AWAY:g} m beside where the first target begins"
    yield f"  # {notes.assume(root.first('droneTeam') or root, message, taken)}"
    course = films[0].course
    way = course.heading(0.0)
    x, y = course.places[0]
    for i in range(number):
        along = APART * (i - 0.5 * (number - 1))
        home = (x + along * cos(way) - AWAY * sin(way), y + along * sin(way) + AWAY * cos(way))
        named = f"  # {plain(team[i].value('name'), 60)}" if i < len(team) else ""
        yield f"  cam{i + 1}: {{model: pro, home: {written(home, 0.0)}, priority: {i + 1}}}{named}"


def _rules() -> Iterator[str]:
    yield "# The file has no rules. Its shots are low, and several drones film one target from all sides."
    yield "rules: {ground_clearance: 1.5, mutual_visibility: {strength: prefer}}"


def _event(root: Node, notes: Notes) -> str:
    event = plain(root.attributes.get("eventRef", ""), 40)
    name = f"its event `{event}`" if event else "an event that it does not name"
    message = f"the file counts time from {name}, whose time is not known"
    return notes.assume(root, message, f"the event is {LEAD:g} s after the first take-off")


def _shot(film: Film, k: int, role: Role, frame: Frame, notes: Notes) -> list[str]:
    task = Task(film.action, role, film.course, frame, film.start, film.lasts, film.target, notes)
    made = shot_of(task)
    composition, said = composition_of(role, film.course, made.camera, task.middle, notes)
    size, sized = size_of(role, made.camera is not None, made.fixed, notes)
    which = f"-{k + 1}" if len(film.action.roles) > 1 else ""
    fields = [
        f"id: {film.id}{which}-{_safe(role.kind).lower()}",
        f"kind: {made.kind}",
        f"drone: cam{film.first + k}",
        *([f"target: {film.target}"] if made.camera is not None else []),
        *([f"composition: {composition}"] if composition else []),
        *([f"size: {size}"] if size else []),
    ]
    return [
        *(f"  # {text}" for text in [*film.comments, *made.comments, *sized, *said]),
        f"  - {{{', '.join(fields)},",
        f"     {made.params},",
        f"     timing: {{start: {film.start:g}, duration: {film.lasts:g}}}}}",
    ]


def _safe(name: str) -> str:
    kept = re.sub(r"[^A-Za-z0-9]+", "-", name).strip("-")[:40].strip("-")
    return kept or "mission"
