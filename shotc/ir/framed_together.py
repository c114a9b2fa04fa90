"""The course of a framing of several subjects: a least-squares solution knot by knot. Plain Python.

Each knot starts from the one before. Where the course of least cost hides a subject in most frames, or has no
room, the course is computed again with both as terms of the cost.
"""

from collections.abc import Sequence
from itertools import permutations
from math import atan2, dist, hypot, inf, pi
from typing import NamedTuple

from shotc.geom.pose_search import Pose
from shotc.geom.vec import Vec2, Vec3, minus, plus
from shotc.geom.viewpoint import (
    Lens,
    PreviousView,
    RequiredView,
    first_pose,
    judged,
    middle_of,
    viewpoint,
)
from shotc.ir.framed_course import StartedFraming, at_place, evenly, eyes_of, places_of, shows
from shotc.ir.framed_scene import FramedScene
from shotc.ir.mission import Subject

WIDE_BEARING_STEP_RAD = pi / 6  # rad between the bearings that are tried
NEARLY_AS_GOOD_COST = (
    0.02  # cost difference of equally good bearings; relative fall of the cost that ends polishing
)
BRISK_SHARE = 0.8  # share of the drone's speed that a course may use, unless the subjects are faster
BEST_BEARINGS = 4  # equally good bearings whose course is computed before the first clear one is taken
MOST_RESTARTS = 5  # most restarts of the first pose


def together(scene: FramedScene) -> StartedFraming:
    """Return the course for several subjects, or for one subject and a preferred pose.

    Where something hides a subject or is in the camera's way all through, a course that avoids it is computed
    as well, and taken if it does.
    """
    course = _course(scene)
    if course.shows:
        return course
    other = _course(FramedScene(scene.mission, scene.shot, scene.start, looks_past=True))
    return other._replace(avoided=course) if other.shows else course


def _course(scene: FramedScene) -> StartedFraming:
    """Return the course of least cost."""
    shot, ideal = scene.shot, scene.shot.ideal
    assert ideal is not None
    opening = _opening(scene)
    poses, subjects = _follow(scene, opening, scene.times), opening.subjects
    lead = scene.mission.target(subjects[0].target)
    eyes = eyes_of(scene.times, poses)
    points = evenly([minus(eye, lead.at(t)) for t, eye in eyes])
    blocked, hidden = scene.shares(eyes)
    framed = shot._replace(ideal=ideal._replace(points=points), subjects=subjects)
    return StartedFraming(framed, scene.times, poses, blocked, hidden, scene.lost(eyes), shot)


class _FirstPose(NamedTuple):
    """A first pose, its cost, and the subjects with their places on screen."""

    cost: float
    pose: Pose
    subjects: tuple[Subject, ...]


def _opening(scene: FramedScene) -> _FirstPose:
    """Return the first pose for several subjects.

    Bearings all round are tried. Among the equally good ones a clear one is preferred, then the nearest to
    the drone's. A scene that looks past its occluders takes the one of least cost whose course shows all
    subjects.
    """
    openings = _openings(scene)
    if scene.looks_past:
        ordered = sorted(openings, key=lambda o: o.cost)
        return _polished(scene, next((o for o in ordered if _shows(scene, o)), ordered[0]))
    least = min(o.cost for o in openings)
    good = [o for o in openings if o.cost <= least + NEARLY_AS_GOOD_COST]
    if len(good) == 1:
        return _polished(scene, good[0])
    scores: list[tuple[float, float, int]] = []
    for i, opening in enumerate(good):
        scores.append((*_score(scene, opening), i))
        if i + 1 >= BEST_BEARINGS and min(scores)[:2] == (0.0, 0.0):
            break
    *least_hidden, i = min(scores)
    polished = _polished(scene, good[i])
    return polished if _score(scene, polished) <= tuple(least_hidden) else good[i]


def _openings(scene: FramedScene) -> list[_FirstPose]:
    """Return the first poses of least cost for bearings all round, the nearest to the drone's first."""
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
    openings = []
    for azimuth in [*azimuths, *(come + turn for turn in turns)]:
        guess = first_pose(required, scene.lens, bounds, azimuth)
        pose, cost = viewpoint(required, scene.lens, bounds, guess)
        settled = _assigned(subjects, required, pose, scene.lens)
        if settled != subjects:
            pose, cost = viewpoint(scene.required_views(settled, scene.start), scene.lens, bounds, pose)
        openings.append(_FirstPose(cost, pose, settled))
    return openings


def _shows(scene: FramedScene, opening: _FirstPose) -> bool:
    """Return whether an opening shows all subjects, and its course as well."""
    if scene.lost(eyes_of((scene.start,), (opening.pose,))) > 0.0:
        return False  # computing a course costs more than an opening
    eyes = _sampled(scene, opening)
    return shows(scene.blocked(eyes), scene.lost(eyes))


def _score(scene: FramedScene, opening: _FirstPose) -> tuple[float, float]:
    """Return the share of a course with too little clearance, and the hidden share of its subjects."""
    eyes = _sampled(scene, opening)
    return scene.blocked(eyes), scene.covered(eyes)


def _sampled(scene: FramedScene, opening: _FirstPose) -> list[tuple[float, Vec3]]:
    """Return some times and positions of the course after an opening."""
    times = scene.times[:: max(1, len(scene.times) // 6)]
    return eyes_of(times, _follow(scene, opening, times))


def _polished(scene: FramedScene, opening: _FirstPose) -> _FirstPose:
    """Return an opening, solved again from its result until the cost hardly falls."""
    cost, pose, subjects = opening
    required = scene.required_views(subjects, scene.start)
    for _ in range(MOST_RESTARTS):
        pose, later = viewpoint(required, scene.lens, scene.room_at(scene.start), pose)
        if later > (1 - NEARLY_AS_GOOD_COST) * cost:
            break
        cost = later
    return _FirstPose(cost, pose, subjects)


def _follow(scene: FramedScene, opening: _FirstPose, times: Sequence[float]) -> tuple[Pose, ...]:
    """Return the poses at times.

    The initial guess of each is the one before, moved along with the subjects.
    """
    poses, subjects = [opening.pose], opening.subjects
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

    The assignment changes least how the subjects appear without places. Where no subject has a place of its
    own, the camera turns to shift the whole picture, so only the places relative to each other count, and the
    shift only among equals. A subject that gets no place is only kept in the frame.
    """
    silent = [i for i, w in enumerate(required) if w.uv is None and not subjects[i].composition.watches]
    if not silent:
        return subjects
    at = {i: _on_screen(pose, lens, required[i]) for i in silent}
    taken = [w.uv for w in required if w.uv is not None]
    free = [p for p in places_of(subjects[silent[0]].composition) if p not in taken]
    free = [] if subjects[silent[0]].composition.keep else free
    spots: list[Vec2 | None] = [*free, *([None] * max(0, len(silent) - len(free)))]

    shifts = all(w.uv is None for w in required)

    def sort_key(order: tuple[Vec2 | None, ...]) -> tuple[int, float, float]:
        moves = [
            (p[0] - at[i][0], p[1] - at[i][1]) for i, p in zip(silent, order, strict=True) if p is not None
        ]
        shift = _mean(moves) if shifts else (0.0, 0.0)
        relative = sum(dist(move, shift) ** 2 for move in moves)
        return len(order) - len(moves), round(relative, 6), sum(hypot(*move) for move in moves)

    best = min(permutations(spots[:8], len(silent)), key=sort_key)
    settled = list(subjects)
    for i, place in zip(silent, best, strict=True):
        settled[i] = at_place(subjects[i], place)
    return tuple(settled)


def _mean(moves: Sequence[Vec2]) -> Vec2:
    count = max(1, len(moves))
    return (sum(u for u, _ in moves) / count, sum(v for _, v in moves) / count)


def _on_screen(pose: Pose, lens: Lens, subject: RequiredView) -> Vec2:
    seen = [judged(pose, lens, subject._replace(uv=uv)) for uv in ((0.0, 0.0), (1.0, 0.0), (0.0, 1.0))]
    if any(s is None for s in seen):
        return (0.0, 0.0)
    a, b, c = (s.screen**2 for s in seen if s is not None)
    return (0.5 * (a - b + 1.0), 0.5 * (a - c + 1.0))
