"""Convert shooting roles to shots of shotc, with their parameters x_s, x_e, y_0, z_0, r_0.

Alcantara et al. Table of shots: x is ahead of the target along its course, y to its left, z above the ground
under it. Index s is the start of the shot, e its end, 0 the whole shot. Angles are counter-clockwise from the
target's course.
"""

from __future__ import annotations

from collections.abc import Callable
from math import cos, degrees, pi, radians, sin

from shotc.importers.multidrone.cameras import elevator, fly_through, static
from shotc.importers.multidrone.task import NEAREST_M, ImportedShot, RoleTask, Said
from shotc.importers.notes import plain

LARGEST_TURN_RAD = 19 * pi  # rad, largest turn of an orbit
NEARER_M = 1.0  # metres
LEAST_TURN_RAD = radians(5.0)
FOLLOWING = frozenset(("CHASE", "LEAD", "LATERAL", "FLYBY", "FLY_BY", "FLYOVER"))


def shot_of(task: RoleTask) -> ImportedShot:
    """Return one role as a shot. An unknown kind becomes a static camera, with a note."""
    kind = task.role.kind.replace(" ", "_")
    make = KINDS.get(kind)
    if make is None:
        node = task.role.node.first("name") or task.role.node
        message = f"the shot `{plain(task.role.kind, 30)}` is not known"
        said = task.notes.assume(node, message, "a still camera at the origin of the formation")
        shot = static(task)
        return shot._replace(comments=(said, *shot.comments))
    if kind in FOLLOWING and task.course.stands:
        said = task.notes.assume(task.role.node, f"{kind} of a target that stands", "a still camera")
        shot = static(task)
        return shot._replace(comments=(said, *shot.comments))
    return make(task)


def _chase(task: RoleTask) -> ImportedShot:
    usual = 8.0 if task.role.kind == "LEAD" else -8.0
    start, said = task.param("x_s", usual)
    z, low = task.altitude()
    if task.role.params.get("x_e", start) != start:
        shot = _flyby(task, beside=0.0)
        return shot._replace(comments=("its distance changes, which is a flyby of ours", *shot.comments))
    kind = "chase" if start < 0 else "lead"
    distance, near = _apart(task, abs(start))
    spot = (distance if start >= 0 else -distance, 0.0, z)
    params = f"distance: {distance:g}, altitude: {z:g}"
    return ImportedShot(kind, params, task.along(spot, spot), (*said, *low, *near), not said)


def _lateral(task: RoleTask) -> ImportedShot:
    y, said = task.param("y_0", 8.0)
    z, low = task.altitude()
    distance, near = _apart(task, abs(y))
    side = "left" if y >= 0 else "right"
    params = f"side: {side}, distance: {distance:g}, altitude: {z:g}"
    spot = (0.0, distance if y >= 0 else -distance, z)
    return ImportedShot("lateral", params, task.along(spot, spot), (*said, *low, *near), not said)


def _flyby(task: RoleTask, beside: float | None = None) -> ImportedShot:
    start, one = task.param("x_s", -10.0)
    end, two = task.param("x_e", 10.0)
    y, three = task.param("y_0", 0.0) if beside is None else (beside, ())
    z, low = task.altitude()
    params = f"behind: {-start:g}, ahead: {end:g}, offset: {y:g}, altitude: {z:g}".replace(": -0,", ": 0,")
    path = task.along((start, y, z), (end, y, z))
    return ImportedShot("flyby", params, path, (*one, *two, *three, *low), not one)


def _orbit(task: RoleTask) -> ImportedShot:
    r, one = task.param("r_0", 8.0)
    turn, two = task.param("azimuth_speed", 0.1)
    begin, three = task.param("azimuth_s", 0.0)
    z, low = task.altitude()
    distance, near = _apart(task, r)
    if abs(begin) > 2 * pi:
        more = task.assume(f"azimuth_s = {begin:g} is no angle in rad", "degrees")
        begin, three = radians(begin), (*three, more)
    sweep = turn * task.duration
    if abs(sweep) > LARGEST_TURN_RAD:
        message = (
            f"azimuth_speed = {turn:g} rad/s over {task.duration:g} s are {abs(sweep) / (2 * pi):.0f} turns"
        )
        sweep = LARGEST_TURN_RAD if sweep > 0 else -LARGEST_TURN_RAD
        two = (
            *two,
            task.assume(
                message, f"{LARGEST_TURN_RAD / (2 * pi):g} turns, the most that are flown, and slower"
            ),
        )
    if abs(sweep) < LEAST_TURN_RAD:
        two = (*two, task.assume("an orbit that does not turn", f"{degrees(LEAST_TURN_RAD):.0f} deg"))
        sweep = LEAST_TURN_RAD
    # Counter-clockwise from the target's course; shotc uses a compass bearing.
    bearing = degrees(pi / 2 - task.course.heading(task.start) - begin) % 360
    turned = f"sweep: {degrees(sweep):.1f} deg, start_azimuth: {bearing:.1f} deg"
    first, halfway, ends = (
        task.beside(
            (distance * cos(begin + s * sweep), distance * sin(begin + s * sweep), z),
            task.start + s * task.duration,
        )
        for s in (0.0, 0.5, 1.0)
    )
    params = f"radius: {distance:g}, altitude: {z:g}, {turned}"
    said = "the side on which a target leaves room changes in an orbit: it is that of the middle of the shot"
    return ImportedShot(
        "orbit", params, (first, halfway, ends), (*one, *two, *three, *low, *near, said), not one
    )


def _establish(task: RoleTask) -> ImportedShot:
    far, one = task.param("x_s", -30.0)
    near, two = task.param("x_e", -15.0)
    high, low = task.altitude("z_s")
    last, lowest = task.altitude("z_e")
    heading = task.course.heading(task.start)
    bearing = degrees(pi / 2 - heading + (pi if far < 0 else 0.0)) % 360
    begin, apart = _apart(task, abs(far))
    ends, close = _apart(task, abs(near))
    if max(abs(ends - begin), abs(last - high)) < NEARER_M / 2:
        close = (
            *close,
            task.assume("an approach that goes nowhere", f"it begins {NEARER_M:g} m farther away"),
        )
        begin += NEARER_M
    params = f"azimuth: {bearing:.1f} deg, distance: [{begin:g}, {ends:g}], altitude: [{high:g}, {last:g}]"
    side = -1.0 if far < 0 else 1.0
    path = task.along((side * begin, 0.0, high), (side * ends, 0.0, last))
    noted: Said = ()
    if not task.course.stands:
        noted = (
            task.assume(
                "an approach is given along the target's path", "along its way at the start of the shot"
            ),
        )
    return ImportedShot("crane", params, path, (*one, *two, *low, *lowest, *apart, *close, *noted), not one)


def _apart(task: RoleTask, distance: float) -> tuple[float, Said]:
    if distance >= NEAREST_M:
        return distance, ()
    return NEAREST_M, (task.assume(f"{distance:g} m from the target is too near", f"{NEAREST_M:g} m"),)


KINDS: dict[str, Callable[[RoleTask], ImportedShot]] = {
    "CHASE": _chase,
    "LEAD": _chase,
    "LATERAL": _lateral,
    "FLYBY": _flyby,
    "FLY_BY": _flyby,
    "FLYOVER": _flyby,
    "ORBIT": _orbit,
    "ESTABLISH": _establish,
    "ELEVATOR": elevator,
    "STATIC": static,
    "FLY_THROUGH": fly_through,
    "FLYTHROUGH": fly_through,
}
