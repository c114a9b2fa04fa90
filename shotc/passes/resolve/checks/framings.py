"""Framings that no camera can have, and remedies, which are tried before they are proposed."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial
from math import asin, degrees, dist, hypot, isnan
from typing import NamedTuple

from shotc.diag.model import Diagnostic, Label
from shotc.diag.registry import has_errors
from shotc.geom.pose_search import Pose
from shotc.geom.vec import wrapped
from shotc.geom.viewpoint import RequiredView, SubjectAppearance, direction, judged, nearest, size_from
from shotc.ir.begins import first_start
from shotc.ir.framed import course_of
from shotc.ir.framed_course import StartedFraming
from shotc.ir.framed_scene import lens_of, required_view_at
from shotc.ir.hidden import lacks
from shotc.ir.keyed import near_at
from shotc.ir.mission import MissionIR, Near, Shot, Subject
from shotc.ir.origin import KeyPath
from shotc.passes.resolve.checks.framing import beyond_gimbal
from shotc.passes.resolve.checks.framing_remedies import (
    as_at,
    for_azimuth,
    for_compromise,
    for_elevation,
    for_free_elevation,
    for_hidden,
    for_lens,
    for_place,
    for_size,
    for_size_and_elevation,
    for_sizes,
    why_not_direct,
)
from shotc.rounding import up

OFF_PLACE_HALF_FRAMES = 0.05  # half frames
OFF_PLACE_M = 0.5  # metres from the place given by `near`
OFF_PLACE_RAD = 0.05  # rad from its angles
OFF_SIZE_SHARE = 0.1  # relative error of a size
OFF_VIEW_RAD = 0.09  # rad
SIZES_APART_RATIO = 2.0  # factor by which a subject may be smaller, to have others in the picture
OUT_HALF_FRAMES = 0.02  # half frames by which a whole subject may reach out of the frame
ROUNDING_TOLERANCE = 1e-6  # metres, and share of a size


def check_course(mission: MissionIR, course: StartedFraming, *, advise: bool = True) -> Iterator[Diagnostic]:
    """Yield the faults of a framing; only the first fault of a subject is reported.

    advise : whether to try remedies; a remedy itself is tried without
    """
    shot = course.shot
    near = [fault for s in shot.subjects if (fault := _never_so_large(mission, shot, s, advise)) is not None]
    yield from near
    if near:
        return
    blocked = _blocked(mission, course, advise)
    if blocked is not None:
        yield blocked
        return
    if len(shot.subjects) > 1 or (shot.ideal is not None and shot.ideal.near is not None):
        yield from _together(mission, course, advise)


def _fits(mission: MissionIR, shot: Shot, *, exactly: bool = False) -> bool:
    """Return whether a framing is feasible as written; exactly : without a compromise."""
    course = course_of(mission, shot, first_start(mission, shot))
    faults = [*check_course(mission, course, advise=False)]
    return not (faults if exactly else has_errors(faults))


def _either(*remedies: Iterator[str], otherwise: str) -> str:
    return ", or ".join(text for remedy in remedies for text in remedy) or otherwise


def _never_so_large(mission: MissionIR, shot: Shot, subject: Subject, advise: bool) -> Diagnostic | None:
    """Return the fault of the first infeasible size of a subject, at the start or at a setpoint, or None."""
    led = (as_at(shot, subject, s.time, lambda setpoint: setpoint.size) for s in subject.setpoints)
    shots = ((shot, subject), *led)
    faults = (_too_large(mission, then, one, advise) for then, one in shots)
    return next((fault for fault in faults if fault is not None), None)


def _too_large(mission: MissionIR, shot: Shot, subject: Subject, advise: bool) -> Diagnostic | None:
    """Return the fault of a size that is infeasible even at the clearance of the subject, or None."""
    if subject.size is None:
        return None
    drone = mission.drone(shot.drone)
    near = mission.rules.beside_target(drone.radius)
    start = first_start(mission, shot)
    needed = required_view_at(mission, subject, start, start)
    toward = direction(needed.azimuth or 0.0, needed.elevation or 0.0)
    least = nearest(needed, toward, near)
    x, y, z = (c * least for c in toward)
    largest = size_from(needed, lens_of(drone), (x, y, z))
    if largest >= subject.size * (1 - ROUNDING_TOLERANCE):
        return None
    if isnan(largest):
        return _never_in_its_place(mission, shot, subject, advise)
    labels: tuple[Label, ...] = (mission.origins.value(shot_key(mission, shot, subject, "size")),)
    if ("rules", "target_clearance") in mission.origins.values:
        labels = (*labels, mission.origins.value(("rules", "target_clearance"), "the clearance"))
    return Diagnostic(
        "M031",
        f"target `{subject.target}` is never {_share(subject.size)} of the frame high",
        labels,
        (
            f"the clearance of {mission.rules.target_clearance:.2f} m and the body radius of "
            f"{drone.radius:.2f} m keep the camera {least:.2f} m from its middle; from there its size is "
            f"{_share(largest)}",
        ),
        _either(
            for_size(_fits, mission, shot, subject, largest),
            for_lens(_fits, mission, shot, needed, (x, y, z)),
            otherwise=_either(
                for_size_and_elevation(_fits, mission, shot, subject, subject.size),
                otherwise="film it from another side",
            ),
        )
        if advise
        else "",
    )


def _never_in_its_place(mission: MissionIR, shot: Shot, subject: Subject, advise: bool) -> Diagnostic:
    remedies = for_place(_fits, mission, shot, subject)
    return Diagnostic(
        "M031",
        f"no camera shows `{subject.target}` at its place on screen",
        (mission.origins.value(shot_key(mission, shot, subject, "frame")),),
        ("it would look so steeply up or down that this place cannot be reached without tilting",),
        _either(remedies, otherwise="lower the elevation of its view") if advise else "",
    )


def _blocked(mission: MissionIR, course: StartedFraming, advise: bool) -> Diagnostic | None:
    """Return the fault of a view that is underground, beyond the gimbal, or blocked throughout, or None."""
    alone = len(course.shot.subjects) == 1
    fault = (_too_low(mission, course, advise) or _beyond_reach(mission, course)) if alone else None
    if fault is not None or course.blocked < 1.0 or not _known(mission, course.shot):
        return fault
    return _without_room(mission, course, advise)


def _too_low(mission: MissionIR, course: StartedFraming, advise: bool) -> Diagnostic | None:
    need = mission.rules.over_ground(mission.drone(course.shot.drone).radius)
    heights = [pose[2] - mission.ground(pose[0], pose[1]) for pose in course.poses]
    z = min(heights)
    shot, subject = _alone_at(course, heights.index(z))
    if z >= need - ROUNDING_TOLERANCE:
        return None
    where = f"{-z:.2f} m underground" if z < 0 else f"{z:.2f} m over the ground"
    return Diagnostic(
        "M032",
        f"the view of `{subject.target}` puts the camera {where}",
        (_view_label(mission, shot, subject, "elevation"),),
        (f"the ground clearance and the body radius need {need:.2f} m",),
        _either(
            for_elevation(_fits, mission, shot, subject, _enough(course, need)),
            for_free_elevation(_fits, mission, shot, subject),
            otherwise=_either(
                for_size_and_elevation(_fits, mission, shot, subject, subject.size or 0.0),
                otherwise="ask for a smaller size, from farther away",
            ),
        )
        if advise
        else "",
    )


def _beyond_reach(mission: MissionIR, course: StartedFraming) -> Diagnostic | None:
    drone = mission.drone(course.shot.drone)
    pitches = [pose[4] for pose in course.poses]
    beyond = [p for p in (min(pitches), max(pitches)) if not drone.gimbal.reaches(p)]
    if not beyond:
        return None
    shot, subject = _alone_at(course, pitches.index(beyond[0]))
    path = (*subject.path[:-1], "view", "elevation")
    known = path if path in mission.origins.values else (*shot.path, "kind")
    return beyond_gimbal(mission, drone, known, beyond[0])


def _alone_at(course: StartedFraming, i: int) -> tuple[Shot, Subject]:
    """Return a framing of one subject as it is at a knot, by the nearest setpoint."""
    subject, time = course.shot.subjects[0], course.times[i] - course.times[0]
    if not subject.setpoints:
        return course.shot, subject
    nearest = min((0.0, *(s.time for s in subject.setpoints)), key=lambda t: abs(t - time))
    return as_at(course.shot, subject, nearest, lambda s: None if s.view is None else s.view[1])


def _without_room(mission: MissionIR, course: StartedFraming, advise: bool) -> Diagnostic:
    shot, drone = course.shot, mission.drone(course.shot.drone)
    subject = shot.subjects[0]
    viewed = next((s for s in shot.subjects if s.view is not None), subject)
    x, y, z = course.poses[0][:3]
    owner, lack = max(lacks(mission, drone, (x, y, z), course.times[0]), key=lambda entry: entry[1])
    free = all(s.view is None or s.view[0] is None for s in shot.subjects)
    size = mission.origins.value(shot_key(mission, shot, subject, "size"))
    label = size if free else _view_label(mission, shot, viewed, "azimuth")
    return Diagnostic(
        "M032",
        f"the camera of shot `{shot.id}` has no room where it sees `{subject.target}` as asked",
        (
            label,
            mission.origins.key(owner.path, "what is in its way"),
        ),
        (
            f"it would be at [{x:.1f}, {y:.1f}, {z:.1f}], where {owner.words} lacks {lack:.2f} m",
            "this holds all through the shot",
        ),
        _either(
            *(remedy(_fits, mission, shot, viewed) for remedy in (for_azimuth, for_elevation)),
            for_size(_fits, mission, shot, subject, subject.size or 0.0),
            otherwise="move what is in its way, or film it with another `kind`",
        )
        if advise
        else "",
    )


def _enough(course: StartedFraming, need: float) -> float:
    """Return the elevation that would be sufficient at the same distance, degrees; 90 where none is."""
    x, y, z = course.shot.ideal.points[0][1] if course.shot.ideal is not None else (0.0, 0.0, 0.0)
    distance = (x * x + y * y + z * z) ** 0.5
    rise = (z + need - min(p[2] for p in course.poses)) / max(distance, 1e-9)
    return up(degrees(asin(rise)), 0) if rise < 1.0 else 90.0


def _view_label(mission: MissionIR, shot: Shot, subject: Subject, key: str) -> Label:
    base = subject.path[:-1]
    for path in ((*base, "view", key), (*base, "view"), base):
        if path in mission.origins.values:
            return mission.origins.value(path)
    return mission.origins.value((*shot.path, "kind"))


def shot_key(mission: MissionIR, shot: Shot, subject: Subject, key: str) -> KeyPath:
    """Return the key path of a subject's key: in it, in its shot, or the subject where it is not written."""
    for path in ((*subject.path[:-1], key), (*shot.path, key)):
        if path in mission.origins.values:
            return path
    return subject.path


class _SeenAt(NamedTuple):
    """How a subject appears at a mission time, and how it is required to."""

    t: float
    appearance: SubjectAppearance
    required: RequiredView


def _together(mission: MissionIR, course: StartedFraming, advise: bool) -> Iterator[Diagnostic]:
    """Yield what several subjects cannot have at once."""
    shot, lens = course.shot, lens_of(mission.drone(course.shot.drone))
    notes: list[str] = []
    labels: list[Label] = []
    for subject in shot.subjects:
        seen: list[_SeenAt] = []
        for t, pose in zip(course.times, course.poses, strict=True):
            required = required_view_at(mission, subject, course.times[0], t)
            appearance = judged(pose, lens, required)
            if appearance is not None:
                seen.append(_SeenAt(t, appearance, required))
        apart = _apart(mission, course, subject, seen, advise) if _known(mission, shot) else None
        if apart is not None:
            yield _with_reasons(mission, course, apart, advise)
            return
        if not seen:
            continue
        compromise = _compromise(subject, seen)
        if compromise:
            notes.append(f"`{subject.target}` is {', '.join(compromise)}")
            labels.append(mission.origins.value(subject.path))
    far = _far_from_place(mission, course)
    if far is not None:
        notes.append(far)
        labels.append(mission.origins.value((*shot.path, "near")))
    if notes:
        if not _known(mission, shot):
            notes.append(
                f"this assumes that the shot begins at {course.times[0]:.1f} s; `plan` finds when it does"
            )
        near = shot.ideal is not None and shot.ideal.near is not None
        what = "what is asked of" if near else "the subjects of"
        yield Diagnostic(
            "M034",
            f"{what} shot `{shot.id}` cannot all {'be had' if near else 'appear as asked'} at once",
            tuple(labels),
            (*notes, *why_not_direct(mission, course)),
            for_compromise(partial(_fits, exactly=True), mission, course.asked) if advise else "",
        )


def _far_from_place(mission: MissionIR, course: StartedFraming) -> str | None:
    """Return a note on how far the camera is from the place given by `near`, if that is notable."""
    near = None if course.shot.ideal is None else course.shot.ideal.near
    if near is None:
        return None
    distance, t = max(
        (dist(pose[:3], near_at(mission, near, t)), t)
        for t, pose in zip(course.times, course.poses, strict=True)
    )
    turned, when = max((_turned(near, pose), t) for t, pose in zip(course.times, course.poses, strict=True))
    reasons = [f"is {distance:.1f} m from the place that it stays near at t = {t:.1f} s"] * (
        distance > OFF_PLACE_M
    )
    if turned > OFF_PLACE_RAD:
        reasons.append(
            f"looks {degrees(turned):.0f} deg beside the way that it stays near at t = {when:.1f} s"
        )
    return f"the camera {', and '.join(reasons)}" if reasons else None


def _turned(near: Near, pose: Pose) -> float:
    """Return the error of a camera's angles from those given by `near`, rad."""
    yaw = 0.0 if near.yaw is None else wrapped(pose[3] - near.yaw)
    return hypot(yaw, 0.0 if near.pitch is None else pose[4] - near.pitch)


def _known(mission: MissionIR, shot: Shot) -> bool:
    """Return whether a framing is independent of the shot's start, or the start is written."""
    moves = any(mission.target(s.target).track is not None for s in shot.subjects)
    return shot.timing.start is not None or not moves


def _apart(
    mission: MissionIR,
    course: StartedFraming,
    subject: Subject,
    seen: Sequence[_SeenAt],
    advise: bool,
) -> Diagnostic | None:
    """Return the fault of a subject out of the picture, or much too small because of others, or None."""
    shot = course.shot
    others = ", ".join(f"`{s.target}`" for s in shot.subjects if s is not subject) or "its camera near there"
    message = f"`{subject.target}` cannot be in one picture with {others}"
    labels = (mission.origins.value(subject.path),)
    if len(seen) < len(course.times):
        note = "from where they appear as asked, it is behind the camera"
        return Diagnostic("M033", message, labels, (note,), "film it in another shot")
    t, worst, _ = max(seen, key=lambda entry: entry.appearance.out)
    if worst.out > OUT_HALF_FRAMES:
        note = f"at t = {t:.1f} s it reaches {worst.out:.2f} of half a frame out of it, at best"
        return Diagnostic("M033", message, labels, (note,), "film it in another shot, or take a wider lens")
    sized = [(e.appearance.size / e.required.size, e) for e in seen if e.required.size is not None]
    if not sized:
        return None
    share, (t, small, needed) = min(sized, key=lambda pair: pair[0])
    if share * SIZES_APART_RATIO >= 1.0 or needed.size is None:
        return None
    smaller = for_sizes(_fits, mission, course.asked, subject.target, small.size) if advise else ()
    return Diagnostic(
        "M033",
        f"`{subject.target}` cannot be {_share(needed.size)} of the frame high in one picture with {others}",
        (mission.origins.value(shot_key(mission, shot, subject, "size")),),
        (f"at t = {t:.1f} s its size is {_share(small.size)} where all are in the frame",),
        ", or ".join((*smaller, "film them in two shots")),
    )


def _with_reasons(mission: MissionIR, course: StartedFraming, fault: Diagnostic, advise: bool) -> Diagnostic:
    """Return a fault of a course with what the course avoids, and with the key that switches this off."""
    ways_out = (fault.help, *(for_hidden(_fits, mission, course) if advise else ()))
    return fault._replace(notes=(*fault.notes, *why_not_direct(mission, course)), help=", or ".join(ways_out))


def _compromise(subject: Subject, seen: Sequence[_SeenAt]) -> list[str]:
    """Return notes on how far one subject is from what was asked of it, where that is notable."""
    notes = []
    t, worst, required = max(seen, key=lambda entry: entry.appearance.screen)
    if worst.screen > OFF_PLACE_HALF_FRAMES and required.uv is not None:
        place = f"({required.uv[0]:.2f}, {required.uv[1]:.2f})"
        notes.append(f"{worst.screen:.2f} of half a frame from {place} at t = {t:.1f} s")
    sized = [(abs(e.appearance.size / e.required.size - 1.0), e) for e in seen if e.required.size]
    if sized:
        off, (t, worst, required) = max(sized, key=lambda pair: pair[0])
        if off > OFF_SIZE_SHARE and required.size:
            notes.append(
                f"{_share(worst.size)} of the frame high instead of {_share(required.size)} at t = {t:.1f} s"
            )
    t, worst, _ = max(seen, key=lambda entry: entry.appearance.angle)
    if worst.angle > OFF_VIEW_RAD:
        notes.append(f"seen {degrees(worst.angle):.0f} deg off its view at t = {t:.1f} s")
    return notes


def _share(size: float) -> str:
    return f"{size:.3g}"
