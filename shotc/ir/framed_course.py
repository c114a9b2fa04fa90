"""The course of a framing, and what single and several subjects share. Plain Python."""

from __future__ import annotations

from collections.abc import Sequence
from math import hypot, pi
from typing import NamedTuple

from shotc.geom.camera import aim_at
from shotc.geom.pose_search import Pose
from shotc.geom.vec import Vec2, Vec3, plus
from shotc.geom.viewpoint import Lens
from shotc.ir.hidden import HALF_SHARE
from shotc.ir.mission import Composition, OffsetPoints, Shot, Subject


class StartedFraming(NamedTuple):
    """The course of a framing for one start time.

    shot : with its ideal and its subjects' places on screen; times, poses : of the course
    blocked, hidden : share of the course at which the camera lacks a clearance; hidden share of a subject
    lost : share of the course from which half of a subject is hidden, as ``FramedScene.lost``
    asked : the shot before its subjects had places on screen
    avoided : the course of least cost, if this one is another since that one does not show its subjects
    """

    shot: Shot
    times: tuple[float, ...]
    poses: tuple[Pose, ...]
    blocked: float
    hidden: float
    lost: float
    asked: Shot
    avoided: StartedFraming | None = None

    @property
    def shows(self) -> bool:
        """Return whether the camera has room somewhere, and no subject is hidden in most frames."""
        return shows(self.blocked, self.lost)


def eyes_of(times: Sequence[float], poses: Sequence[Pose]) -> list[tuple[float, Vec3]]:
    """Return times, seconds, with the positions of the poses then, W, metres."""
    return [(t, (p[0], p[1], p[2])) for t, p in zip(times, poses, strict=True)]


def shows(blocked: float, lost: float) -> bool:
    """Return whether a camera has room somewhere on its course, and no subject is hidden in most frames.

    blocked, lost : as in ``StartedFraming``
    """
    return blocked < 1.0 and lost <= HALF_SHARE


def places_of(composition: Composition) -> list[Vec2]:
    """Return the places (u, v) of a composition, the nearest to the middle first.

    A line gives its nearest.
    """
    points = [*composition.points, *((c, 0.0) for c in composition.u_lines)]
    points += [(0.0, c) for c in composition.v_lines]
    return sorted(points, key=lambda p: hypot(*p)) or [(0.0, 0.0)]


def evenly(offsets: Sequence[Vec3]) -> OffsetPoints:
    """Return offsets with their shares of a shot's time, at equal intervals."""
    return tuple((i / (len(offsets) - 1), offset) for i, offset in enumerate(offsets))


def at_place(subject: Subject, place: Vec2 | None) -> Subject:
    """Return a subject with one place on screen, or with none."""
    name = subject.composition.name
    return subject._replace(composition=Composition(name, () if place is None else (place,)))


def aimed(centre: Vec3, offset: Vec3, uv: Vec2, lens: Lens) -> Pose:
    """Return the pose of a camera at an offset from a subject that shows its centre at a place on screen."""
    back = (-offset[0], -offset[1], -offset[2])
    aim = aim_at(back, uv, lens.hfov, lens.aspect, pi / 2) or (0.0, 0.0)
    return (*plus(centre, offset), *aim)
