"""Remedies for infeasible framings: sizes, lenses, views and places. Each is tried before it is proposed.

Notes say why a framing is not the one of least cost.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from math import degrees, radians

from shotc.geom.vec import Vec3
from shotc.geom.viewpoint import RequiredView, lens_for
from shotc.ir.allow import HIDDEN
from shotc.ir.framed_course import StartedFraming, eyes_of
from shotc.ir.framed_scene import FramedScene, lens_of
from shotc.ir.hidden import hides, lacks
from shotc.ir.mission import MissionIR, Shot, Subject
from shotc.ir.setpoints import Setpoint
from shotc.rounding import down, rounded_outward

Fits = Callable[[MissionIR, Shot], bool]
"""Whether a framing is feasible in a mission."""

SHARES = (1.0, 0.95, 0.9, 0.85, 0.8, 0.7, 0.6, 0.5, 0.4, 0.3, 0.2, 0.1)
"""Shares of a size, a field of view or a place on screen that are tried, the nearest first."""
TURNS = tuple(sign * d for d in range(10, 181, 10) for sign in (1, -1))  # degrees from the written azimuth
RISES_DEG = tuple(range(5, 86, 5))  # degrees of elevation
LARGEST_SIZE = 1.0
"""The largest size that a mission writes as a number; only a name asks for a cropped target."""


def for_size(fits: Fits, mission: MissionIR, shot: Shot, subject: Subject, most: float) -> Iterator[str]:
    """Yield the largest feasible size, at most ``most``."""
    for share in SHARES:
        size = down(share * min(most, LARGEST_SIZE), 2)
        if size > 0 and fits(mission, _with(shot, subject, subject._replace(size=size))):
            yield f"ask for `size: {size:g}` or less"
            return


def for_sizes(fits: Fits, mission: MissionIR, shot: Shot, target: str, most: float) -> Iterator[str]:
    """Yield a largest size, for one of several subjects or for all of them, if it is feasible.

    shot : before its subjects have places on screen
    most : size that the target has beside the others as written
    """
    size = down(min(most, LARGEST_SIZE), 3)
    smaller = tuple(_at_most(s, size) for s in shot.subjects)
    one = tuple(less if less.target == target else s for s, less in zip(shot.subjects, smaller, strict=True))
    if fits(mission, shot._replace(subjects=one)):
        yield f"ask for {size:g} or less"
    elif fits(mission, shot._replace(subjects=smaller)):
        yield f"ask for `size: {size:g}` or less of every subject"


def for_compromise(exactly: Fits, mission: MissionIR, shot: Shot) -> str:
    """Return each size or view of one of several subjects without which all else is had, as remedies.

    exactly : whether a framing appears as written
    shot    : before its subjects have places on screen
    """
    found = []
    for subject in shot.subjects:
        for key, less in (("size", subject._replace(size=None)), ("view", subject._replace(view=None))):
            asked = less != subject and (*subject.path[:-1], key) in mission.origins.values
            if asked and exactly(mission, _with(shot, subject, less)):
                found.append(f"leave `{key}` of `{subject.target}` out")
    return ", or ".join(found) or "leave out what matters least"


def for_size_and_elevation(
    fits: Fits, mission: MissionIR, shot: Shot, subject: Subject, most: float
) -> Iterator[str]:
    """Yield the largest feasible size without the elevation, if an elevation is written."""
    azimuth, elevation = subject.view or (None, None)
    if elevation is None:
        return
    free = subject._replace(view=None if azimuth is None else (azimuth, None))
    for remedy in for_size(fits, mission, _with(shot, subject, free), free, most):
        yield f"leave `elevation` out and {remedy}"


def for_lens(
    fits: Fits, mission: MissionIR, shot: Shot, needed: RequiredView, nearest: Vec3
) -> Iterator[str]:
    """Yield the widest lens with which a subject has its size at its clearance or beyond.

    nearest : the camera's offset from the subject at its clearance, metres
    """
    drone = mission.drone(shot.drone)
    widest = None if needed.size is None else lens_for(needed, lens_of(drone), nearest, needed.size)
    camera = (*drone.path, "camera")
    if widest is None:
        return
    if any((*camera, key) in mission.origins.values for key in ("sensor", "focal_length")):
        yield "take a longer lens"
        return
    for share in SHARES:
        hfov = rounded_outward(degrees(widest) * share, upper=False, digits=2)
        lens = drone._replace(hfov=radians(hfov))
        drones = tuple(lens if d is drone else d for d in mission.drones)
        if hfov >= 1.0 and fits(mission._replace(drones=drones), shot):
            yield f"take a longer lens for `{drone.name}`, `camera: {{hfov: {hfov:g} deg}}`"
            return


def for_place(fits: Fits, mission: MissionIR, shot: Shot, subject: Subject) -> Iterator[str]:
    """Yield the feasible place on screen nearest to the written one, towards the middle."""
    u, v = subject.composition.points[0]
    for share in (*SHARES[1:], 0.0):
        place = (round(share * u, 2) + 0.0, round(share * v, 2) + 0.0)
        nearer = subject._replace(composition=subject.composition._replace(points=(place,)))
        if fits(mission, _with(shot, subject, nearer)):
            yield f"put it at `frame: [{place[0]:g}, {place[1]:g}]`"
            return


def for_elevation(
    fits: Fits, mission: MissionIR, shot: Shot, subject: Subject, least: float = 0.0
) -> Iterator[str]:
    """Yield the lowest feasible elevation of at least ``least`` degrees."""
    azimuth, elevation = subject.view or (None, None)
    written = (*subject.path[:-1], "view") in mission.origins.values
    lowest = round(max(least, -90.0 if elevation is None else degrees(elevation) + 1.0))
    for rise in sorted({lowest, *(r for r in RISES_DEG if r > lowest)}):
        if rise < 90 and fits(mission, _with(shot, subject, subject._replace(view=(azimuth, radians(rise))))):
            yield (
                f"raise `elevation` to {rise} deg" if written else f"write `view: {{elevation: {rise} deg}}`"
            )
            return


def for_free_elevation(fits: Fits, mission: MissionIR, shot: Shot, subject: Subject) -> Iterator[str]:
    """Yield the remedy to remove the elevation, if one is written and this is feasible."""
    azimuth, elevation = subject.view or (None, None)
    view = None if azimuth is None else (azimuth, None)
    if elevation is not None and fits(mission, _with(shot, subject, subject._replace(view=view))):
        yield "leave `elevation` out: then it is as low as it may be"


def for_azimuth(fits: Fits, mission: MissionIR, shot: Shot, subject: Subject) -> Iterator[str]:
    """Yield the nearest feasible azimuth, and the remedy to remove it if that is feasible as well."""
    azimuth, elevation = subject.view or (None, None)
    if azimuth is None:
        return
    for turn in TURNS:
        bearing = round(degrees(azimuth) + turn) % 360
        if fits(mission, _with(shot, subject, subject._replace(view=(radians(bearing), elevation)))):
            yield f"take `azimuth: {bearing} deg`"
            break
    view = None if elevation is None else (None, elevation)
    if fits(mission, _with(shot, subject, subject._replace(view=view))):
        yield "leave `azimuth` out"


def as_at(
    shot: Shot, subject: Subject, time: float, writes: Callable[[Setpoint], object]
) -> tuple[Shot, Subject]:
    """Return a shot in which a subject appears throughout as it does at one time, and that subject.

    writes : returns the relevant part of a setpoint, None where it has none; the key path of the subject is
        that of the last setpoint with this part up to the time, or its own
    """
    appearance, composition = subject.asked(time), subject.composition
    if appearance.place is not None:
        composition = composition._replace(points=(appearance.place,))
    own = [s.path for s in subject.setpoints if s.time <= time and writes(s) is not None]
    still = Subject(
        subject.target, composition, appearance.size, appearance.view, (own or [subject.path])[-1]
    )
    return _with(shot, subject, still), still


def _with(shot: Shot, old: Subject, new: Subject) -> Shot:
    return shot._replace(subjects=tuple(new if s is old else s for s in shot.subjects))


def _at_most(subject: Subject, size: float) -> Subject:
    """Return a subject that is nowhere asked to be larger than a size."""
    setpoints = tuple(s if s.size is None else s._replace(size=min(s.size, size)) for s in subject.setpoints)
    own = None if subject.size is None else min(subject.size, size)
    return subject._replace(size=own, setpoints=setpoints)


def why_not_direct(mission: MissionIR, course: StartedFraming) -> Iterator[str]:
    """Yield a note on what a course avoids, if it is not the one of least cost."""
    if course.avoided is None:
        return
    direct = course.avoided
    eyes = eyes_of(direct.times, direct.poses)
    if direct.blocked >= 1.0:
        t, eye = eyes[0]
        owner, lack = max(lacks(mission, mission.drone(direct.shot.drone), eye, t), key=lambda one: one[1])
        yield f"where all appear as asked the camera has no room: {owner.words} lacks {lack:.2f} m"
        return
    lost = ((_lost(mission, direct.shot, one, eyes), one) for one in direct.shot.subjects)
    share, subject = max(lost, key=lambda pair: pair[0])
    named = (hides(mission, subject.target, eye, t) for t, eye in eyes)
    by = Counter(name for name in named if name is not None).most_common(1)
    yield (
        f"where all appear as asked, `{by[0][0]}` hides more than half of `{subject.target}` in "
        f"{100 * share:.0f} % of the shot"
    )


def for_hidden(fits: Fits, mission: MissionIR, course: StartedFraming) -> Iterator[str]:
    """Yield the key that accepts hidden subjects, if all appear as asked then."""
    shot = course.asked
    if course.avoided is not None and fits(mission, shot._replace(allow=(*shot.allow, HIDDEN))):
        yield f"write `allow: [{HIDDEN}]` in the shot to accept hidden subjects"


def _lost(mission: MissionIR, shot: Shot, subject: Subject, eyes: Sequence[tuple[float, Vec3]]) -> float:
    """Return the share of times and places from which at least half of one subject is hidden."""
    return FramedScene(mission, shot._replace(subjects=(subject,)), eyes[0][0]).lost(eyes)
