"""The ideal of a framing shot: the camera course from which the subjects appear as required. Plain Python.

For one subject there is a closed form: the camera keeps one offset from it, or one offset a knot if setpoints
change the requirements. For several subjects the course is a least-squares solution knot by knot, each
started from the one before. Rules determine what the mission does not state:

- bearing: the one from which the drone comes. If an occluder or an obstacle is in the way during the shot, it
  is the nearest bearing that is clear;
- elevation: level with the subject, or as little above it as the ground clearance needs;
- size: ``viewpoint.WHOLE_SIZE``, where no subject has one; for one subject the largest size up to that at
  which it is whole, where it is wider than the frame. If the camera lacks a clearance there, it is the
  nearest size at which it has room;
- place on screen: for one subject, the place of its composition nearest to the middle at which it is whole;
  for several, each place of the composition once.
"""

from collections.abc import Sequence
from itertools import permutations
from math import atan2, cos, dist, hypot, inf, pi, sin
from typing import NamedTuple

from shotc.geom.camera import aim_at
from shotc.geom.pose_search import Pose
from shotc.geom.vec import Vec2, Vec3, minus, plus
from shotc.geom.viewpoint import (
    WHOLE_SIZE,
    Lens,
    PreviousView,
    RequiredView,
    first_pose,
    judged,
    middle_of,
    stand,
    viewpoint,
    whole,
)
from shotc.ir.framed_scene import FramedScene, required_view_at
from shotc.ir.keyed import is_keyed, settled
from shotc.ir.mission import Composition, MissionIR, OffsetPoints, Shot, Subject
from shotc.ir.target import Target

BEARING_STEP_RAD = pi / 36  # rad between the bearings that are tried for one subject
WIDE_BEARING_STEP_RAD = pi / 6  # rad between those for several subjects
NEARLY_AS_GOOD_COST = (
    0.02  # cost difference of equally good bearings; relative fall of the cost that ends polishing
)
BRISK_SHARE = 0.8  # share of the drone's speed that a course may use, unless the subjects are faster
BEST_BEARINGS = 4  # equally good bearings whose course is computed before the first clear one is taken
MOST_RAISES = 4  # iterations of the camera's height over terrain
MOST_RESTARTS = 5  # most restarts of the first pose
SAME_TIME_S = 1e-6  # seconds
SMALLER = tuple(WHOLE_SIZE * 0.95**k for k in range(60))
"""Sizes that are tried for one subject without a required size; the first at which it is whole is taken."""
OTHER_SIZES, FEW_OTHER_SIZES = (
    tuple(step ** (sign * k) for k in range(1, count + 1) for sign in (1, -1))
    for step, count in ((0.9, 24), (0.65, 6))
)
"""Factors on that size, the nearest first, tried if the camera has no room; few where its bearing is free."""


class StartedFraming(NamedTuple):
    """The course of a framing for one start time.

    shot : with its ideal and its subjects' places on screen; times, poses : of the course
    blocked, hidden : share of the course at which the camera lacks a clearance; hidden share of a subject
    """

    shot: Shot
    times: tuple[float, ...]
    poses: tuple[Pose, ...]
    blocked: float
    hidden: float


def at_start(mission: MissionIR, shot: Shot, start: float) -> Shot:
    """Return a shot resolved for its first frame at ``start``, s: framings and keyframes depend on it."""
    if shot.timing.start is not None and abs(shot.timing.start - start) <= SAME_TIME_S:
        return shot
    if is_keyed(shot):
        return settled(mission, shot, start)
    if shot.ideal is None or not shot.ideal.framed or not shot.subjects:
        return shot
    return course_of(mission, shot, start).shot


def course_of(mission: MissionIR, shot: Shot, start: float) -> StartedFraming:
    """Return the course of a framing whose first frame is at ``start``, seconds."""
    scene = FramedScene(mission, shot, start)
    return _alone(scene) if len(shot.subjects) == 1 and scene.near is None else _several(scene)


def places_of(composition: Composition) -> list[Vec2]:
    """Return the places (u, v) of a composition, the nearest to the middle first.

    A line gives its nearest.
    """
    points = [*composition.points, *((c, 0.0) for c in composition.u_lines)]
    points += [(0.0, c) for c in composition.v_lines]
    return sorted(points, key=lambda p: hypot(*p)) or [(0.0, 0.0)]


def _alone(scene: FramedScene) -> StartedFraming:
    """Return the course for one subject: an offset from it, constant unless setpoints change it."""
    subject = scene.shot.subjects[0]
    target = scene.mission.target(subject.target)
    lowest = min((target.at(t) for t in scene.looks), key=lambda c: c[2])
    sizes = SMALLER if subject.size is None else (subject.size,)
    tried = (_Beside(scene, lowest, uv, size) for size in sizes for uv in places_of(subject.composition))
    first = _Beside(scene, lowest, places_of(subject.composition)[0], sizes[0])
    whole = next((one for one in tried if one.is_whole()), first)
    beside, points, (blocked, hidden) = _with_room(scene, target, whole)
    ideal = scene.shot.ideal
    assert ideal is not None
    shot = scene.shot._replace(ideal=ideal._replace(points=points), subjects=(_at_place(subject, beside.uv),))
    poses = tuple(
        _aimed(target.at(t), scene.along(points, t), beside.place_at(t), scene.lens) for t in scene.times
    )
    return StartedFraming(shot, scene.times, poses, blocked, hidden)


class _Beside:
    """A camera that keeps an offset from one subject, with a place on screen and a size at the first frame.

    wanted : the subject at its lowest position with its required appearance at each knot of the course; one
        entry if nothing changes
    """

    def __init__(self, scene: FramedScene, lowest: Vec3, uv: Vec2, size: float) -> None:
        mission, start, subject = scene.mission, scene.start, scene.shot.subjects[0]
        self.scene, self.uv, self.size = scene, uv, size
        self.subject = _at_place(subject, uv)._replace(size=size)
        knots = scene.times if subject.setpoints else (start,)
        self.wanted = tuple(
            required_view_at(mission, self.subject, start, t)._replace(centre=lowest) for t in knots
        )

    def place_at(self, t: float) -> Vec2:
        """Return the subject's place on screen at a mission time."""
        return self.subject.asked(t - self.scene.start).place or self.uv

    def is_whole(self) -> bool:
        """Return whether the whole subject is in the frame at every knot."""
        lens = self.scene.lens
        return all(
            not w.whole or whole(_aimed(w.centre, _stood(self.scene, w, 0.0), w.uv or self.uv, lens), lens, w)
            for w in self.wanted
        )

    def points(self, azimuth: float) -> OffsetPoints:
        """Return the camera's offsets as in ``Ideal``; azimuth : its bearing where none is required, rad."""
        offsets = tuple(_stood(self.scene, subject, azimuth) for subject in self.wanted)
        return _evenly(offsets * 2 if len(offsets) == 1 else offsets)

    def turned(self, points: OffsetPoints, azimuth: float) -> OffsetPoints:
        """Return offsets, given for bearing 0 (North), at bearing ``azimuth``, rad."""
        if self.scene.mission.terrain is not None:
            return self.points(azimuth)
        away = [(share, hypot(x, y), z) for share, (x, y, z) in points]
        return tuple((share, (far * sin(azimuth), far * cos(azimuth), z)) for share, far, z in away)


def _evenly(offsets: Sequence[Vec3]) -> OffsetPoints:
    return tuple((i / (len(offsets) - 1), offset) for i, offset in enumerate(offsets))


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


class _Tried(NamedTuple):
    """A camera beside one subject, its offsets, and its ``FramedScene.shares``."""

    beside: _Beside
    points: OffsetPoints
    shares: tuple[float, float]


def _with_room(scene: FramedScene, target: Target, beside: _Beside) -> _Tried:
    """Return a camera at its place; if its size is free, at the nearest size at which it has room."""
    best = _at_bearing(scene, target, beside)
    if scene.shot.subjects[0].size is not None or best.shares[0] == 0.0:
        return best
    for ratio in OTHER_SIZES if beside.wanted[0].azimuth is not None else FEW_OTHER_SIZES:
        other = _Beside(scene, beside.wanted[0].centre, beside.uv, ratio * beside.size)
        if not other.is_whole():
            continue
        tried = _at_bearing(scene, target, other)
        if tried.shares < best.shares:
            best = tried
        if best.shares == (0.0, 0.0):
            break
    return best


def _at_bearing(scene: FramedScene, target: Target, beside: _Beside) -> _Tried:
    """Return a camera at the required bearing, or at the clear one that is nearest to the drone's."""
    north = beside.points(0.0)
    if beside.wanted[0].azimuth is not None:
        return _tried(scene, target, beside, north)
    first = scene.comes_from(target.at(scene.start))
    best: _Tried | None = None
    for k in range(round(2 * pi / BEARING_STEP_RAD)):
        turned = beside.turned(north, first + BEARING_STEP_RAD * ((k + 1) // 2) * (1 if k % 2 else -1))
        tried = _tried(scene, target, beside, turned)
        if best is None or tried.shares < best.shares:
            best = tried
        if best.shares == (0.0, 0.0):
            break
    assert best is not None
    return best


def _tried(scene: FramedScene, target: Target, beside: _Beside, points: OffsetPoints) -> _Tried:
    eyes = [(t, plus(target.at(t), scene.along(points, t))) for t in scene.looks]
    return _Tried(beside, points, scene.shares(eyes))


def _several(scene: FramedScene) -> StartedFraming:
    """Return the course for several subjects, or for one subject and a preferred pose."""
    shot, ideal = scene.shot, scene.shot.ideal
    assert ideal is not None
    first, subjects = _opening(scene)
    poses = _follow(scene, subjects, first, scene.times)
    lead = scene.mission.target(subjects[0].target)
    points = _evenly([minus((p[0], p[1], p[2]), lead.at(t)) for t, p in zip(scene.times, poses, strict=True)])
    blocked, hidden = scene.shares([(t, (p[0], p[1], p[2])) for t, p in zip(scene.times, poses, strict=True)])
    made = shot._replace(ideal=ideal._replace(points=points), subjects=subjects)
    return StartedFraming(made, scene.times, poses, blocked, hidden)


def _opening(scene: FramedScene) -> tuple[Pose, tuple[Subject, ...]]:
    """Return the first pose for several subjects, and the subjects with their places on screen.

    Bearings all round are tried. Among the equally good ones a clear one is preferred, then the nearest to
    the drone's.
    """
    subjects = scene.shot.subjects
    required, bounds = scene.required_views(subjects, scene.start), scene.room_at(scene.start)
    come = scene.comes_from(middle_of(required))
    turns = [
        WIDE_BEARING_STEP_RAD * ((k + 1) // 2) * (1 if k % 2 else -1)
        for k in range(round(2 * pi / WIDE_BEARING_STEP_RAD))
    ]
    azimuths = [w.azimuth for w in required if w.azimuth is not None]
    if bounds.drawn is not None:
        x, y, _ = minus(bounds.drawn.at, middle_of(required))
        azimuths.append(atan2(x, y))
    openings: list[tuple[float, Pose, tuple[Subject, ...]]] = []
    for azimuth in [*azimuths, *(come + turn for turn in turns)]:
        guess = first_pose(required, scene.lens, bounds, azimuth)
        pose, cost = viewpoint(required, scene.lens, bounds, guess)
        settled = _assigned(subjects, required, pose, scene.lens)
        if settled != subjects:
            pose, cost = viewpoint(scene.required_views(settled, scene.start), scene.lens, bounds, pose)
        openings.append((cost, pose, settled))
    least = min(cost for cost, _, _ in openings)
    good = [f for f in openings if f[0] <= least + NEARLY_AS_GOOD_COST]
    if len(good) == 1:
        return _polished(scene, good[0])
    scores: list[tuple[float, float, int]] = []
    for i, (_, pose, settled) in enumerate(good):
        scores.append((*_score(scene, pose, settled), i))
        if i + 1 >= BEST_BEARINGS and min(scores)[:2] == (0.0, 0.0):
            break
    *least_hidden, i = min(scores)
    opening = _polished(scene, good[i])
    return opening if _score(scene, *opening) <= tuple(least_hidden) else good[i][1:]


def _score(scene: FramedScene, first: Pose, subjects: tuple[Subject, ...]) -> tuple[float, float]:
    """Return the share of a course with too little clearance, and the hidden share of its subjects."""
    times = scene.times[:: max(1, len(scene.times) // 6)]
    poses = _follow(scene, subjects, first, times)
    eyes = [(t, (p[0], p[1], p[2])) for t, p in zip(times, poses, strict=True)]
    return scene.blocked(eyes), scene.covered(eyes)


def _polished(
    scene: FramedScene, opening: tuple[float, Pose, tuple[Subject, ...]]
) -> tuple[Pose, tuple[Subject, ...]]:
    """Return an opening, solved again from its result until the cost hardly falls."""
    cost, pose, subjects = opening
    required = scene.required_views(subjects, scene.start)
    for _ in range(MOST_RESTARTS):
        pose, later = viewpoint(required, scene.lens, scene.room_at(scene.start), pose)
        if later > (1 - NEARLY_AS_GOOD_COST) * cost:
            break
        cost = later
    return pose, subjects


def _follow(
    scene: FramedScene, subjects: Sequence[Subject], first: Pose, times: Sequence[float]
) -> tuple[Pose, ...]:
    """Return the poses at times.

    The initial guess of each is the one before, moved along with the subjects.
    """
    poses = [first]
    middle, before = middle_of(scene.required_views(subjects, times[0])), times[0]
    for t in times[1:]:
        required, bounds = scene.required_views(subjects, t), scene.room_at(t)
        later, last = middle_of(required), poses[-1]
        eye, along = (last[0], last[1], last[2]), minus(later, middle)
        largest_step = max(BRISK_SHARE * scene.drone.limits.speed * (t - before), hypot(*along))
        previous = PreviousView(eye, plus(eye, along), largest_step)
        pose, cost = viewpoint(required, scene.lens, bounds, (*previous.kept, last[3], last[4]), previous)
        if cost == inf:
            x, y, _ = minus(previous.kept, later)
            guess = first_pose(required, scene.lens, bounds, atan2(x, y))
            pose, _ = viewpoint(required, scene.lens, bounds, guess, previous)
        poses.append(pose)
        middle, before = later, t
    return tuple(poses)


def _assigned(
    subjects: tuple[Subject, ...], required: Sequence[RequiredView], pose: Pose, lens: Lens
) -> tuple[Subject, ...]:
    """Assign places of the composition to the subjects without a place of their own, each place once.

    The assignment minimises the distances from where the subjects appear without one. A subject that gets no
    place is only kept in the frame.
    """
    silent = [i for i, w in enumerate(required) if w.uv is None and not subjects[i].composition.watches]
    if not silent:
        return subjects
    at = {i: _on_screen(pose, lens, required[i]) for i in silent}
    taken = [w.uv for w in required if w.uv is not None]
    free = [p for p in places_of(subjects[silent[0]].composition) if p not in taken]
    free = [] if subjects[silent[0]].composition.keep else free
    spots: list[Vec2 | None] = [*free, *([None] * max(0, len(silent) - len(free)))]

    def away(order: tuple[Vec2 | None, ...]) -> float:
        return sum(9.0 if p is None else dist(p, at[i]) for i, p in zip(silent, order, strict=True))

    best = min(permutations(spots[:8], len(silent)), key=away)
    settled = list(subjects)
    for i, place in zip(silent, best, strict=True):
        settled[i] = _at_place(subjects[i], place)
    return tuple(settled)


def _on_screen(pose: Pose, lens: Lens, subject: RequiredView) -> Vec2:
    seen = [judged(pose, lens, subject._replace(uv=uv)) for uv in ((0.0, 0.0), (1.0, 0.0), (0.0, 1.0))]
    if any(s is None for s in seen):
        return (0.0, 0.0)
    a, b, c = (s.screen**2 for s in seen if s is not None)
    return (0.5 * (a - b + 1.0), 0.5 * (a - c + 1.0))


def _at_place(subject: Subject, place: Vec2 | None) -> Subject:
    name = subject.composition.name
    return subject._replace(composition=Composition(name, () if place is None else (place,)))


def _aimed(centre: Vec3, offset: Vec3, uv: Vec2, lens: Lens) -> Pose:
    back = (-offset[0], -offset[1], -offset[2])
    aim = aim_at(back, uv, lens.hfov, lens.aspect, pi / 2) or (0.0, 0.0)
    return (*plus(centre, offset), *aim)
