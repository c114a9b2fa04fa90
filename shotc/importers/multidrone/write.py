"""The mission as text: YAML of ours, with every assumption as a comment above what it is about."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from math import cos, sin
from typing import NamedTuple

from shotc.importers.multidrone.read import Action, Role, Sequence
from shotc.importers.multidrone.shots import THIRDS, Task, shot_of
from shotc.importers.multidrone.targets import LEAD, Course, Frame, alike, courses_of
from shotc.importers.notes import Notes
from shotc.importers.xml_tree import Node

SIZES = {"TARGET_BOAT": (2.0, 1.5), "TARGET_CYCLIST": (0.9, 1.8), "TARGET_RUNNER": (0.4, 1.8)}
USUAL = (1.0, 1.8)  # radius and height of a target of no known sort, metres
APART = 6.0  # metres between two homes
CHANGE, SHARE = 16.0, 0.6  # seconds to change from shot to shot, and the most of a shot that takes
AWAY = 20.0  # metres from the first target's start to the homes


class Filmed(NamedTuple):
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


def mission_text(
    name: str, kinds: Iterable[str], sequences: tuple[Sequence, ...], frame: Frame, notes: Notes
) -> str:
    """Return a mission.

    name : of the mission; kinds : names of the sorts of targets, as the file says them
    """
    filmed = list(_filmed(sequences, frame, notes))
    head = sequences[0].node
    lines = ["# Imported from a mission of the MultiDrone project.", "shotc: 1", f"mission: {_safe(name)}"]
    if frame.origin is not None:
        lines += [f"world: {{origin: {{lat: {frame.origin[0]:.7f}, lon: {frame.origin[1]:.7f}, alt: 0}}}}"]
    lines += ["targets:", *_targets(filmed, list(kinds), head, notes)]
    lines += ["drones:", *_drones(filmed, head, notes)]
    lines += ["rules: {ground_clearance: 1.5, mutual_visibility: {strength: prefer}}", "shots:"]
    for film in filmed:
        for k, role in enumerate(film.action.roles):
            task = Task(film.action, role, film.course, frame, film.start, film.target, notes)
            lines += _lines(task, film, k)
    return "\n".join([*lines, ""])


def _filmed(sequences: tuple[Sequence, ...], frame: Frame, notes: Notes) -> Iterator[Filmed]:
    targets: list[tuple[Course, str]] = []
    first = 1
    for number, sequence in enumerate(sequences, 1):
        begins, said = LEAD, False
        for k, (action, course) in enumerate(
            zip(sequence.actions, courses_of(sequence, frame, notes), strict=True), 1
        ):
            start, begins = begins, begins + action.duration
            if course is None:
                notes.assume(action.node, "an action that says nowhere where its target is", "it is left out")
                continue
            name = next((n for known, n in targets if alike(known, course)), "")
            if not name:
                name = f"target{len(targets) + 1}"
                targets.append((course, name))
            change = 0.0
            comments: tuple[str, ...] = ()
            if said:
                change = min(CHANGE, SHARE * action.duration)
                told = notes.assume(
                    action.node,
                    "the next shot begins as the last one ends",
                    f"the drones change places for {change:g} s",
                )
                comments = (told,)
            said = True
            yield Filmed(
                f"s{number}-{k}",
                action,
                course,
                name,
                start + change,
                action.duration - change,
                first,
                comments,
            )
        first += max(len(action.roles) for action in sequence.actions)


def _lines(task: Task, film: Filmed, k: int) -> list[str]:
    made = shot_of(task)
    role = task.role
    target = "" if "heading: along" in made.params else f" target: {task.target},"
    composition, said = _composition(role, made.composition, task.notes)
    wanted = f" composition: {composition}," if composition else ""
    which = f"-{k + 1}" if len(task.action.roles) > 1 else ""
    id_ = f"{film.id}{which}-{_safe(role.kind).lower()}"
    return [
        *(f"  # {text}" for text in [*film.comments, *made.comments, *_framing(role), *said]),
        f"  - {{id: {id_}, kind: {made.kind}, drone: cam{film.first + k},{target}{wanted}",
        f"     {made.params},",
        f"     timing: {{{_timing(task)}duration: {film.lasts:g}}}}}",
    ]


def _timing(task: Task) -> str:
    """Return the start of a shot that films what moves; one of what stands takes its turn."""
    return "" if task.course.stands or task.role.kind.startswith("FLY_THR") else f"start: {task.start:g}, "


def _framing(role: Role) -> list[str]:
    if not role.framing:
        return []
    return [f"the file asks for {role.framing}; the distances that it gives are flown"]


def _composition(role: Role, ours: str, notes: Notes) -> tuple[str, list[str]]:
    if not ours:
        return "", []
    if role.composition == THIRDS:
        return ours, [f"{THIRDS}: {ours}, with the room on the side to which the target goes"]
    if role.composition in {"", "CENTRAL", "CENTER", "CENTERED"}:
        return "center", []
    node = role.node.first("shootingTypeName") or role.node
    return "center", [notes.assume(node, f"the composition `{role.composition[:30]}` is not known", "center")]


def _targets(filmed: list[Filmed], kinds: list[str], head: Node, notes: Notes) -> Iterator[str]:
    known = next((kind for kind in kinds if kind in SIZES), None)
    radius, height = SIZES[known] if known is not None else USUAL
    size = f"radius {radius:g} m, height {height:g} m"
    yield f"  # {notes.assume(head, 'the file does not say how large its targets are', size)}"
    ground = notes.assume(head, "its altitudes of targets are -1 or missing", "they go on the ground, z = 0")
    yield f"  # {ground}"
    for name, course in {film.target: film.course for film in reversed(filmed)}.items():
        yield from (f"  # {comment}" for comment in course.comments)
        places = [f"[{x:.2f}, {y:.2f}, {height / 2:g}]" for x, y in course.places]
        body = f"radius: {radius:g}, height: {height:g}}}"
        if course.stands:
            yield f"  {name}: {{at: {places[0]}, {body}"
            continue
        yield f"  {name}:"
        yield f"    {{track: {{points: [{', '.join(places)}],"
        yield f"      times: [{', '.join(f'{t:.2f}' for t in course.times)}]}}, {body}"


def _drones(filmed: list[Filmed], head: Node, notes: Notes) -> Iterator[str]:
    homes = f"folding camera drones, {APART:g} m apart, {AWAY:g} m beside where the first target begins"
    yield f"  # {notes.assume(head, 'the file does not name its drones nor their homes', homes)}"
    course = filmed[0].course
    way = course.heading(0.0)
    x, y = course.places[0]
    number = max(film.first + len(film.action.roles) - 1 for film in filmed)
    for i in range(number):
        along = APART * (i - 0.5 * (number - 1))
        home = (
            f"[{x + along * cos(way) - AWAY * sin(way):.2f}, {y + along * sin(way) + AWAY * cos(way):.2f}, 0]"
        )
        yield f"  cam{i + 1}: {{model: pro, home: {home}, priority: {i + 1}, endurance: 45 min}}"


def _safe(name: str) -> str:
    kept = re.sub(r"[^A-Za-z0-9]+", "-", name).strip("-")[:40].strip("-")
    return kept or "mission"
