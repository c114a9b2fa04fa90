"""Cameras that do not move with a target: they stand, rise, or fly through. Some pan and tilt."""

from __future__ import annotations

from itertools import pairwise
from math import atan2, degrees, hypot, pi
from typing import NamedTuple

from shotc.importers.multidrone.frames import Place, written
from shotc.importers.multidrone.read import Role
from shotc.importers.multidrone.task import NEAREST_M, ImportedShot, RoleTask, Said

BESIDE_M = 8.0  # metres to the East of its target, for a camera that would stand at the target's place
LEAST_RISE_M = 0.1  # least travel of an elevator, metres
LEVEL_TILT_DEG = 90.0  # degrees, tilt of a camera that looks at the horizon
MOST_PAN_DEG = 720.0  # degrees
LOWEST_PITCH_DEG, HIGHEST_PITCH_DEG = -90.0, 30.0  # degrees


def elevator(task: RoleTask) -> ImportedShot:
    """Return a camera that moves up or down at its place and films its target."""
    low, one = task.altitude("z_s")
    high, two = task.altitude("z_e")
    place, (lower, upper), said = _stand(task, low, high)
    if abs(high - low) < LEAST_RISE_M:
        noted = task.assume("an elevator that neither rises nor sinks", "a still camera")
        params = f"at: {lower}, look_at: {task.target}"
        return ImportedShot("static", params, ((*place, low),) * 3, (*one, *two, *said, noted))
    points = f"points: [{lower}, {upper}], look_at: {task.target}"
    path = ((*place, low), (*place, (low + high) / 2), (*place, high))
    return ImportedShot("follow-path", points, path, (*one, *two, *said))


def static(task: RoleTask) -> ImportedShot:
    """Return a camera that stands and films its target, or pans and tilts by the file's angles."""
    z, low = task.altitude()
    place, (at,), said = _stand(task, z)
    path = ((*place, z),) * 3
    if not _turned(task.role):
        if not task.target:
            heading = degrees(pi / 2 - task.course.heading(task.start)) % 360
            params = f"at: {at}, heading: {heading:.1f} deg, pitch: 0 deg"
            return ImportedShot("static", params, path, (*low, *said), watches=False)
        return ImportedShot("static", f"at: {at}, look_at: {task.target}", path, (*low, *said))
    poses = [(at, task.course.heading(task.start))] * 2
    rows, more = _panned(task, poses)
    return ImportedShot("keyframes", rows, path, (*low, *said, *more), watches=False)


def fly_through(task: RoleTask) -> ImportedShot:
    """Return a camera that flies along the trajectory, and pans by the file's angles or looks ahead."""
    z, low = task.altitude()
    points, frame = task.action.points, task.frame
    places = [frame.place(point) for point in points]
    if len(places) < 2 or hypot(places[-1][0] - places[0][0], places[-1][1] - places[0][1]) < 1.0:
        message = "a fly-through without a way"
        still = task.notes.assume(task.action.node, message, "a still camera at the origin of the formation")
        shot = static(task)
        return shot._replace(comments=(still, *shot.comments))
    path = ((*places[0], z), (*places[len(places) // 2], z), (*places[-1], z))
    if _turned(task.role):
        rows, said = _panned(task, [(frame.written(p, z), _course(places, i)) for i, p in enumerate(points)])
        return ImportedShot("keyframes", rows, path, (*low, *said), watches=False)
    joined = ", ".join(frame.written(p, z) for p in points)
    ahead = task.assume("a fly-through without pan and tilt", "the camera looks along the way, level")
    params = f"points: [{joined}], heading: along"
    return ImportedShot("follow-path", params, path, (*low, ahead), watches=False)


def _turned(role: Role) -> bool:
    """Return whether a role turns its camera by angles and films no target."""
    return "pan_s" in role.params or "tilt_s" in role.params


def _panned(task: RoleTask, poses: list[tuple[str, float]]) -> tuple[str, Said]:
    """Return keyframes in which the camera pans and tilts from start to end, and comments.

    poses : places with the course there, rad; pan angles are relative to the course
    """
    params = task.role.params
    pans, tilts = (_ends(params, "pan", 0.0), _ends(params, "tilt", LEVEL_TILT_DEG))
    node = task.role.node.first("targetIdentifierParams") or task.role.node
    message = "pan and tilt in degrees without a frame"
    taken = "pan counter-clockwise from the way, tilt from straight down: 90 is level"
    said: Said = (task.notes.assume(node, message, taken),)
    if max(map(abs, pans)) > MOST_PAN_DEG:
        message = f"a pan of {pans[0]:g} to {pans[1]:g} deg is none that can be meant"
        said = (*said, task.notes.assume(node, message, "the camera keeps to the way"))
        pans = (0.0, 0.0)
    rows, last = [], None
    for i, (at, course) in enumerate(poses):
        share = i / (len(poses) - 1)
        pan, tilt = (a + share * (b - a) for a, b in (pans, tilts))
        heading = 90.0 - degrees(course) - pan
        if last is not None and not (abs(pans[1] - pans[0]) >= 180.0):
            heading += 360.0 * round((last - heading) / 360.0)
        last = heading
        pitch = max(LOWEST_PITCH_DEG, min(HIGHEST_PITCH_DEG, tilt - LEVEL_TILT_DEG))
        rows.append(f"{{at: {at}, heading: {heading:.1f} deg, pitch: {pitch:g} deg}}")
    if (
        not LOWEST_PITCH_DEG + LEVEL_TILT_DEG
        <= min(tilts)
        <= max(tilts)
        <= HIGHEST_PITCH_DEG + LEVEL_TILT_DEG
    ):
        span = f"{min(tilts):g} to {max(tilts):g} deg"
        said = (
            *said,
            task.notes.assume(node, f"a tilt of {span} is out of a gimbal's range", "its nearest end"),
        )
    return f"keyframes: [{', '.join(rows)}]", said


def _ends(params: dict[str, float], name: str, otherwise: float) -> tuple[float, float]:
    """Return an angle at the start and at the end. If only one is given, it holds for both."""
    start, end = params.get(f"{name}_s"), params.get(f"{name}_e")
    first = start if start is not None else end if end is not None else otherwise
    return first, end if end is not None else first


def _course(places: list[Place], i: int) -> float:
    """Return the course from a point to the next, rad, counter-clockwise from East."""
    k = min(i, len(places) - 2)
    legs = [(q[0] - p[0], q[1] - p[1]) for p, q in pairwise(places)]
    x, y = next((leg for leg in (*legs[k:], *legs[k::-1]) if hypot(*leg) > 1e-3), (0.0, 1.0))
    return atan2(y, x)


class _CameraPlace(NamedTuple):
    """A place as East and North in metres, as text at some heights, and comments."""

    place: Place
    written: list[str]
    said: Said


def _stand(task: RoleTask, *altitudes: float) -> _CameraPlace:
    """Return the place of a standing camera: the formation's origin, or beside a target too near to it."""
    x, y = task.course.at(task.start)
    origin = task.action.origin
    if origin is not None:
        place = task.frame.place(origin)
        if hypot(place[0] - x, place[1] - y) >= NEAREST_M:
            return _CameraPlace(place, [task.frame.written(origin, z) for z in altitudes], ())
    message = "the camera would stand where its target begins"
    said = task.notes.assume(
        task.action.node.first("originOfFormation") or task.action.node,
        message,
        f"{BESIDE_M:g} m to the East of there",
    )
    place = (x + BESIDE_M, y)
    return _CameraPlace(place, [written(place, z) for z in altitudes], (said,))
