"""Write the head of a mission: its world, its targets and its drones."""

from __future__ import annotations

from collections.abc import Iterator
from collections.abc import Sequence as Rows
from math import cos, sin

from shotc.importers.multidrone.films import FilmedAction
from shotc.importers.multidrone.frames import CoordinateFrame, written
from shotc.importers.multidrone.read import below
from shotc.importers.multidrone.targets import GroundTrack
from shotc.importers.notes import Notes, plain
from shotc.importers.xml_tree import Node

SIZES = {
    "TARGET_BOAT": (2.0, 1.5),
    "TARGET_CYCLIST": (0.9, 1.8),
    "TARGET_RUNNER": (0.4, 1.8),
    "TARGET_MONUMENT": (3.0, 10.0),
}
USUAL_SIZE_M = (1.0, 1.8)  # radius and height of a target of unknown type, metres
HOMES_APART_M = 6.0  # distance between two homes, metres
HOMES_AWAY_M = 20.0  # distance from the first target's start to the homes, metres


def world(frame: CoordinateFrame) -> Iterator[str]:
    """Yield the lines of the origin, if there is one."""
    yield from (f"# {comment}" for comment in frame.comments)
    if frame.origin is not None:
        yield f"world: {{origin: {{lat: {frame.origin[0]:.7f}, lon: {frame.origin[1]:.7f}, alt: 0}}}}"


def targets(films: Rows[FilmedAction], root: Node, frame: CoordinateFrame, notes: Notes) -> Iterator[str]:
    """Yield the lines of all targets, each once; nothing if no shot has a target."""
    courses: dict[str, GroundTrack] = {}
    for film in films:
        if film.target:
            courses.setdefault(film.target, film.course)
    if not courses:
        return
    yield "targets:"
    sort = next((node for types in root.all("targetTypes") for node in types.all("targetType")), None)
    name = "" if sort is None else sort.value("name")
    radius, height = SIZES.get(name, USUAL_SIZE_M)
    message = "the file does not say how large its targets are"
    if name not in SIZES:
        message += ", nor what they are" if sort is None else f", and `{plain(name, 30)}` is not known"
    size = f"radius {radius:g} m, height {height:g} m"
    yield f"  # {notes.assume(sort or root.first('targetTypes') or root, message, size)}"
    ground = list(_ground(films, notes))
    yield from (f"  # {comment}" for comment in ground)
    body = f"radius: {radius:g}, height: {height:g}}}"
    for target, course in courses.items():
        trajectories = [f.action.node.first("RTTrajectory") for f in films if f.target == target]
        more = [said for route in trajectories if route is not None for said in notes.below(route)]
        said = dict.fromkeys(comment for comment in (*course.comments, *more) if comment not in ground)
        yield from (f"  # {comment}" for comment in said)
        yield from _target(target, course, [frame.written(p, height / 2) for p in course.points], body)


def _target(name: str, course: GroundTrack, places: list[str], body: str) -> Iterator[str]:
    if course.stands:
        yield f"  {name}: {{at: {places[0]}, {body}"
        return
    yield f"  {name}:"
    yield f"    {{track: {{points: [{', '.join(places)}],"
    yield f"      times: [{', '.join(f'{t:.2f}' for t in course.times)}]}}, {body}"


def _ground(films: Rows[FilmedAction], notes: Notes) -> Iterator[str]:
    """Yield a comment if points have altitudes: they are not flown, as in the MultiDrone planner."""
    points = [p for film in films for p in film.action.points]
    odd = [p for p in points if p.z != 0]
    if not odd:
        return
    given = sorted({p.z for p in odd if p.z is not None})
    heights = (
        "none" if not given else f"{given[0]:g}" if len(given) == 1 else f"{given[0]:g} to {given[-1]:g}"
    )
    node = odd[0].node.first("altitude") or odd[0].node
    message = f"the altitude of {len(odd)} of {len(points)} points is {heights}"
    yield notes.assume(node, message, "targets go on the ground, z = 0, as in the project's own planner")


def drones(films: Rows[FilmedAction], number: int, root: Node, notes: Notes) -> Iterator[str]:
    """Yield the lines of ``number`` drones beside the start of the first film, and of their rules."""
    team = [node for node in below(root, "drone") if node.value("name")][:number]
    message = "the file does not say what its drones are, nor where they stand"
    if len(team) < number:
        named = f"{len(team)} drone" if len(team) == 1 else f"{len(team)} drones"
        message = f"the file names {named}, its shots need {number}; it does not say where they stand"
    beside = f"{HOMES_AWAY_M:g} m beside where the first trajectory begins"
    taken = f"folding camera drones, {HOMES_APART_M:g} m apart, {beside}"
    yield "drones:"
    yield f"  # {notes.assume(root.first('droneTeam') or root, message, taken)}"
    course = films[0].course
    heading = course.heading(0.0)
    x, y = course.places[0]
    secondary = {f.first + k for f in films if not f.main for k in range(len(f.action.roles))}
    order = sorted(range(1, number + 1), key=lambda drone: drone in secondary)
    for i in range(number):
        along = HOMES_APART_M * (i - 0.5 * (number - 1))
        home = (
            x + along * cos(heading) - HOMES_AWAY_M * sin(heading),
            y + along * sin(heading) + HOMES_AWAY_M * cos(heading),
        )
        named = f"  # {plain(team[i].value('name'), 60)}" if i < len(team) else ""
        place, rank = written(home, 0.0), order.index(i + 1) + 1
        yield f"  cam{i + 1}: {{model: pro, home: {place}, priority: {rank}}}{named}"
    taken = "1.5 m over the ground, for its shots are low, and out of each other's pictures where that can be"
    yield f"# {notes.assume(root, 'the file has no rules for its drones', taken)}"
    yield "rules: {ground_clearance: 1.5, mutual_visibility: {strength: prefer}}"
