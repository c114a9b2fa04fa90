"""The course of a framing of one subject: one offset from it, or one a knot if setpoints change it.

A camera without room, or one from which the subject is hidden in most frames, is put elsewhere as far as the
mission leaves it free: at another bearing, at the nearest other size, or higher. Plain Python.
"""

from math import cos, hypot, inf, pi, radians, sin
from typing import NamedTuple

from shotc.geom.vec import Vec2, Vec3, plus
from shotc.geom.viewpoint import WHOLE_SIZE, RequiredView, stand, whole
from shotc.ir.framed_course import StartedFraming, aimed, at_place, evenly, places_of, shows
from shotc.ir.framed_scene import FramedScene, required_view_at
from shotc.ir.hidden import HALF_SHARE
from shotc.ir.mission import OffsetPoints
from shotc.ir.target import Target

BEARING_STEP_RAD = pi / 36  # rad between the bearings that are tried
MOST_RAISES = 4  # iterations of the camera's height over terrain
SMALLER = tuple(WHOLE_SIZE * 0.95**k for k in range(60))
"""Sizes that are tried for one subject without a required size; the first at which it is whole is taken."""
OTHER_SIZES, FEW_OTHER_SIZES = (
    tuple(step ** (sign * k) for k in range(1, count + 1) for sign in (1, -1))
    for step, count in ((0.9, 24), (0.65, 6))
)
"""Factors on that size, the nearest first, tried if the camera has no room; few where its bearing is free."""
ELEVATIONS_RAD = tuple(radians(e) for e in range(10, 90, 10))
"""Elevations that are tried if the subject is hidden from where the camera is level with it."""


def alone(scene: FramedScene) -> StartedFraming:
    """Return the course for one subject: an offset from it, constant unless setpoints change it."""
    subject = scene.shot.subjects[0]
    target = scene.mission.target(subject.target)
    lowest = min((target.at(t) for t in scene.looks), key=lambda c: c[2])
    sizes = SMALLER if subject.size is None else (subject.size,)
    tried = (
        _OffsetCamera(scene, lowest, uv, size) for size in sizes for uv in places_of(subject.composition)
    )
    first = _OffsetCamera(scene, lowest, places_of(subject.composition)[0], sizes[0])
    fitting = next((one for one in tried if one.is_whole()), first)
    beside, points, (blocked, hidden), lost = _with_room(scene, target, fitting)
    ideal = scene.shot.ideal
    assert ideal is not None
    shot = scene.shot._replace(ideal=ideal._replace(points=points), subjects=(at_place(subject, beside.uv),))
    poses = tuple(
        aimed(target.at(t), scene.along(points, t), beside.place_at(t), scene.lens) for t in scene.times
    )
    return StartedFraming(shot, scene.times, poses, blocked, hidden, lost, scene.shot)


class _OffsetCamera:
    """A camera that keeps an offset from one subject, with a place on screen and a size at the first frame.

    wanted : the subject at its lowest position with its required appearance at each knot of the course; one
        entry if nothing changes
    """

    def __init__(
        self, scene: FramedScene, lowest: Vec3, uv: Vec2, size: float, elevation: float | None = None
    ) -> None:
        """Elevation : of a view whose elevation is free, rad; None for a level one."""
        mission, start, subject = scene.mission, scene.start, scene.shot.subjects[0]
        self.scene, self.uv, self.size = scene, uv, size
        self.subject = at_place(subject, uv)._replace(size=size)
        knots = scene.times if subject.setpoints else (start,)
        self.wanted = tuple(
            _elevated(required_view_at(mission, self.subject, start, t), elevation)._replace(centre=lowest)
            for t in knots
        )

    def place_at(self, t: float) -> Vec2:
        """Return the subject's place on screen at a mission time."""
        return self.subject.asked(t - self.scene.start).place or self.uv

    def is_whole(self) -> bool:
        """Return whether the whole subject is in the frame at every knot."""
        lens = self.scene.lens
        return all(
            not w.whole or whole(aimed(w.centre, _stood(self.scene, w, 0.0), w.uv or self.uv, lens), lens, w)
            for w in self.wanted
        )

    def points(self, azimuth: float) -> OffsetPoints:
        """Return the camera's offsets as in ``Ideal``; azimuth : its bearing where none is required, rad."""
        offsets = tuple(_stood(self.scene, subject, azimuth) for subject in self.wanted)
        return evenly(offsets * 2 if len(offsets) == 1 else offsets)

    def turned(self, points: OffsetPoints, azimuth: float) -> OffsetPoints:
        """Return offsets, given for bearing 0 (North), at bearing ``azimuth``, rad."""
        if self.scene.mission.terrain is not None:
            return self.points(azimuth)
        polar = [(share, hypot(x, y), z) for share, (x, y, z) in points]
        return tuple((share, (far * sin(azimuth), far * cos(azimuth), z)) for share, far, z in polar)


def _elevated(view: RequiredView, elevation: float | None) -> RequiredView:
    return view if view.elevation is not None else view._replace(elevation=elevation)


def _stood(scene: FramedScene, subject: RequiredView, bearing: float) -> Vec3:
    """Return the camera's offset from a subject; bearing : the camera's where none is required, rad."""
    azimuth, size = bearing if subject.azimuth is None else subject.azimuth, subject.size or WHOLE_SIZE
    offset = stand(subject, scene.lens, scene.room, azimuth, size)
    if scene.mission.terrain is None:
        return offset
    target = scene.mission.target(scene.shot.subjects[0].target)
    for _ in range(MOST_RAISES):  # a higher camera is nearer in the plan, over other ground
        bounds = scene.room_beside(target, subject.centre, offset)
        offset = stand(subject, scene.lens, bounds, azimuth, size)
    return offset


class _FramingTry(NamedTuple):
    """A camera beside one subject, its offsets, and its ``FramedScene.shares``.

    lost : share of the frames in which the subject is half hidden
    """

    beside: _OffsetCamera
    points: OffsetPoints
    shares: tuple[float, float]
    lost: float

    @property
    def shows(self) -> bool:
        """Return whether the camera has room somewhere, and the subject is not hidden in most frames."""
        return shows(self.shares[0], self.lost)


def _with_room(scene: FramedScene, target: Target, beside: _OffsetCamera) -> _FramingTry:
    """Return a camera at its place, or where it has room and sees, as far as size and elevation are free."""
    best = _at_bearing(scene, target, beside)
    if scene.shot.subjects[0].size is None and (best.shares[0] > 0.0 or not best.shows):
        best = _at_other_size(scene, target, best)
    return best if best.shows else _from_above(scene, target, best)


def _at_other_size(scene: FramedScene, target: Target, best: _FramingTry) -> _FramingTry:
    """Return a camera at the nearest size at which it has room and sees."""
    beside = best.beside
    for ratio in OTHER_SIZES if beside.wanted[0].azimuth is not None else FEW_OTHER_SIZES:
        other = _OffsetCamera(scene, beside.wanted[0].centre, beside.uv, ratio * beside.size)
        if not other.is_whole():
            continue
        tried = _at_bearing(scene, target, other)
        if tried.shares < best.shares:
            best = tried
        if best.shares == (0.0, 0.0):
            break
    return best


def _from_above(scene: FramedScene, target: Target, best: _FramingTry) -> _FramingTry:
    """Return a camera at the lowest elevation from which it sees all of its subject, if that is free.

    If there is none, it is the lowest one from which it sees most of it.
    """
    beside, (lowest, highest) = best.beside, scene.lens.pitch
    if beside.wanted[0].elevation is not None:
        return best
    ceiling = scene.mission.rules.max_height or inf
    for elevation in ELEVATIONS_RAD:
        higher = _OffsetCamera(scene, beside.wanted[0].centre, beside.uv, beside.size, elevation)
        if not higher.is_whole():
            continue
        tried = _at_bearing(scene, target, higher)
        x, y, z, _, pitch = aimed(target.at(scene.start), tried.points[0][1], higher.uv, scene.lens)
        too_high = z - scene.mission.ground(x, y) > ceiling
        if not tried.shows or not lowest <= pitch <= highest or too_high:
            continue
        if tried.shares == (0.0, 0.0):
            return tried
        best = best if best.shows else tried
    return best


def _at_bearing(scene: FramedScene, target: Target, beside: _OffsetCamera) -> _FramingTry:
    """Return a camera at the required bearing, or at the clear one that is nearest to the drone's."""
    north = beside.points(0.0)
    if beside.wanted[0].azimuth is not None:
        return _tried(scene, target, beside, north)
    first = scene.comes_from(target.at(scene.start))
    best: _FramingTry | None = None
    for k in range(round(2 * pi / BEARING_STEP_RAD)):
        turned = beside.turned(north, first + BEARING_STEP_RAD * ((k + 1) // 2) * (1 if k % 2 else -1))
        tried = _tried(scene, target, beside, turned)
        if best is None or tried.shares < best.shares:
            best = tried
        if best.shares == (0.0, 0.0):
            break
    assert best is not None
    return best


def _tried(scene: FramedScene, target: Target, beside: _OffsetCamera, points: OffsetPoints) -> _FramingTry:
    eyes = [(t, plus(target.at(t), scene.along(points, t))) for t in scene.looks]
    shares = scene.shares(eyes)
    # Where half of a subject is hidden, the hidden share is at least one half.
    may_be_lost = shares[1] > HALF_SHARE * HALF_SHARE
    return _FramingTry(beside, points, shares, scene.lost(eyes) if may_be_lost else 0.0)
