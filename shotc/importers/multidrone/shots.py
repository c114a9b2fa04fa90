"""Shooting roles as shots of ours: what the parameters x_s, x_e, y_0, z_0, r_0 mean beside a target.

Alcantara et al. Table of shots: x ahead of the target along its way, y to its left, z above it; an index s
is the start of the shot, e its end, 0 all along.
"""

from __future__ import annotations

from collections.abc import Callable
from math import degrees, hypot, pi
from typing import NamedTuple

from shotc.importers.multidrone.read import Action, Role
from shotc.importers.multidrone.targets import Course, Frame
from shotc.importers.notes import Notes

NEAREST = 3.0  # metres beside a target that a shot keeps where nothing is said
LOWEST = 3.0  # metres over the ground
THIRDS = "RULE_OF_THIRDS"


class Made(NamedTuple):
    """A shot as written: its kind and parameters as YAML, and the comments above it."""

    kind: str
    params: str
    composition: str
    comments: tuple[str, ...]


class Task(NamedTuple):
    """One role to be made a shot, from mission time ``start`` on."""

    action: Action
    role: Role
    course: Course
    frame: Frame
    start: float
    target: str
    notes: Notes

    def param(self, name: str, otherwise: float) -> tuple[float, tuple[str, ...]]:
        """Return a parameter, or what is taken where it is missing, with the comment for that."""
        if name in self.role.params:
            return self.role.params[name], ()
        said = self.notes.assume(
            self.role.node, f"{self.role.kind} without `{name}`", f"{name} = {otherwise:g}"
        )
        return otherwise, (said,)

    def altitude(self, name: str = "z_0") -> tuple[float, tuple[str, ...]]:
        """Return an altitude over the ground, on which the target stands."""
        z, said = self.param(name, 5.0)
        if z >= LOWEST:
            return z, said
        more = self.notes.assume(self.role.node, f"{name} = {z:g} m is too low to be flown", f"{LOWEST:g} m")
        return LOWEST, (*said, more)


def shot_of(task: Task) -> Made:
    """Return one role as a shot; a kind that is not known becomes a still camera, which is noted."""
    make = KINDS.get(task.role.kind.replace(" ", "_"))
    if make is None:
        said = task.notes.assume(
            task.role.node, f"the shot `{task.role.kind[:30]}` is not known", "a still camera at the origin"
        )
        made = _static(task)
        return made._replace(comments=(said, *made.comments))
    return make(task)


def _chase(task: Task) -> Made:
    start, said = task.param("x_s", -8.0)
    z, low = task.altitude()
    if task.role.params.get("x_e", start) != start:
        return _flyby(task)
    kind = "chase" if start < 0 else "lead"
    away, near = _apart(task, abs(start))
    return Made(kind, f"distance: {away:g}, altitude: {z:g}", "lower-third", (*said, *low, *near))


def _lateral(task: Task) -> Made:
    y, said = task.param("y_0", 8.0)
    z, low = task.altitude()
    away, near = _apart(task, abs(y))
    side = "left" if y >= 0 else "right"
    # Seen from its left a target goes to the left: room is left in front of it.
    ahead = "right-third" if y >= 0 else "left-third"
    return Made("lateral", f"side: {side}, distance: {away:g}, altitude: {z:g}", ahead, (*said, *low, *near))


def _flyby(task: Task) -> Made:
    start, one = task.param("x_s", -10.0)
    end, two = task.param("x_e", 10.0)
    y, three = task.param("y_0", 0.0)
    z, low = task.altitude()
    params = f"behind: {-start:g}, ahead: {end:g}, offset: {y:g}, altitude: {z:g}".replace(": -0,", ": 0,")
    side = "right-third" if y > 0 else "left-third"
    return Made("flyby", params, side, (*one, *two, *three, *low))


def _orbit(task: Task) -> Made:
    r, one = task.param("r_0", 8.0)
    turn, two = task.param("azimuth_speed", 0.1)
    begin, three = task.param("azimuth_s", 0.0)
    z, low = task.altitude()
    away, near = _apart(task, r)
    if abs(begin) > 2 * pi:
        three = (
            *three,
            task.notes.assume(task.role.node, f"azimuth_s = {begin:g} is no angle in rad", "degrees"),
        )
        begin *= pi / 180
    sweep = max(-19 * pi, min(19 * pi, turn * task.action.duration))
    # From the way the target goes, counter-clockwise; ours is a compass bearing.
    bearing = degrees(pi / 2 - task.course.heading(task.start) - begin) % 360
    turned = f"sweep: {degrees(sweep):.1f} deg, start_azimuth: {bearing:.1f} deg"
    params = f"radius: {away:g}, altitude: {z:g}, {turned}"
    return Made("orbit", params, "left-third", (*one, *two, *three, *low, *near))


def _establish(task: Task) -> Made:
    far, one = task.param("x_s", -30.0)
    near, two = task.param("x_e", -15.0)
    high, low = task.altitude("z_s")
    last, lowest = task.altitude("z_e")
    heading = task.course.heading(task.start)
    bearing = degrees(pi / 2 - heading + (pi if far < 0 else 0.0)) % 360
    params = (
        f"azimuth: {bearing:.1f} deg, distance: [{abs(far):g}, {max(abs(near), NEAREST):g}], "
        f"altitude: [{high:g}, {last:g}]"
    )
    kept = task.notes.assume(
        task.role.node, "an approach is told along the target's way", "along its way at the start of the shot"
    )
    return Made("crane", params, "lower-third", (*one, *two, *low, *lowest, kept))


def _elevator(task: Task) -> Made:
    low, one = task.altitude("z_s")
    high, two = task.altitude("z_e")
    (x, y), said = _stand(task)
    points = f"points: [[{x:.2f}, {y:.2f}, {low:g}], [{x:.2f}, {y:.2f}, {high:g}]], look_at: {task.target}"
    return Made("follow-path", points, "left-third", (*one, *two, *said))


def _static(task: Task) -> Made:
    z, low = task.altitude()
    (x, y), said = _stand(task)
    params = f"at: [{x:.2f}, {y:.2f}, {z:g}], look_at: {task.target}"
    if {"pan_s", "tilt_s"} & set(task.role.params):
        said = (
            *said,
            task.notes.assume(task.role.node, "pan and tilt angles without a frame", "look at the target"),
        )
    return Made("static", params, "left-third", (*low, *said))


def _fly_through(task: Task) -> Made:
    z, low = task.altitude()
    way = [task.frame.place(point) for point in task.action.points]
    if len(way) < 2 or hypot(way[-1][0] - way[0][0], way[-1][1] - way[0][1]) < 1.0:
        said = task.notes.assume(
            task.role.node, "a fly-through without a way", "a still camera at the origin"
        )
        made = _static(task)
        return made._replace(comments=(said, *made.comments))
    points = ", ".join(f"[{x:.2f}, {y:.2f}, {z:g}]" for x, y in way)
    said = task.notes.assume(
        task.role.node, "pan and tilt of a fly-through without a frame", "look along the way, level"
    )
    return Made("follow-path", f"points: [{points}], heading: along", "", (*low, said))


def _apart(task: Task, away: float) -> tuple[float, tuple[str, ...]]:
    if away >= NEAREST:
        return away, ()
    said = task.notes.assume(task.role.node, f"{away:g} m from the target is too near", f"{NEAREST:g} m")
    return NEAREST, (said,)


def _stand(task: Task) -> tuple[tuple[float, float], tuple[str, ...]]:
    """Return where a camera that goes with nobody stands: the formation's origin, but beside the target."""
    place, said = task.course.at(task.start), ()
    if task.action.origin is not None:
        place = task.frame.place(task.action.origin)
    x, y = task.course.at(task.start)
    if hypot(place[0] - x, place[1] - y) >= NEAREST:
        return place, said
    beside = task.notes.assume(
        task.role.node, "the camera would stand where its target begins", "8 m to the East of there"
    )
    return (place[0] + 8.0, place[1]), (beside,)


KINDS: dict[str, Callable[[Task], Made]] = {
    "CHASE": _chase,
    "LEAD": _chase,
    "LATERAL": _lateral,
    "FLYBY": _flyby,
    "FLY_BY": _flyby,
    "FLYOVER": _flyby,
    "ORBIT": _orbit,
    "ESTABLISH": _establish,
    "ELEVATOR": _elevator,
    "STATIC": _static,
    "FLY_THROUGH": _fly_through,
    "FLYTHROUGH": _fly_through,
}
