"""The courses of a sequence's targets: the trajectories of its actions, in order, in mission time."""

from __future__ import annotations

from itertools import pairwise
from math import atan2, dist, pi
from typing import NamedTuple

from shotc.importers.multidrone.frames import CoordinateFrame, Place
from shotc.importers.multidrone.read import KMH_PER_M_S, MissionPoint, Sequence, ShootingAction
from shotc.importers.notes import Notes

LEAD_S = 40.0  # seconds from take-off to the first frame
SAME_POINT_M = 0.05  # metres, largest distance at which two points count as equal
FASTEST_M_S = 40.0  # m/s, a larger speed between two points means wrong times
SAME_TARGET_M = 1.5  # metres, largest distance of two courses of the same target
OVERLAP_S = 0.5  # seconds, largest difference between the durations of an action and its trajectory
SLOWEST_M_S = 0.05  # m/s, a slower target counts as standing
SAME_SPEED_RATIO = 1.5  # largest ratio of two speeds that count as equal


class GroundTrack(NamedTuple):
    """The course of a target on the ground: mission times in seconds, East and North in metres.

    points   : the same places as in the file
    comments : the assumptions about them
    """

    times: tuple[float, ...]
    places: tuple[Place, ...]
    points: tuple[MissionPoint, ...]
    comments: tuple[str, ...]

    @property
    def stands(self) -> bool:
        """Whether the target never moves."""
        return all(dist(self.places[0], place) < SAME_POINT_M for place in self.places)

    def moves(self, t: float) -> bool:
        """Return whether the target moves at a time."""
        return dist(self.at(t - 0.5), self.at(t + 0.5)) >= SLOWEST_M_S

    def heading(self, t: float) -> float:
        """Return the direction of motion, rad, counter-clockwise from East; the next one while it stands."""
        legs = [
            (b, atan2(q[1] - p[1], q[0] - p[0]))
            for (_, b), (p, q) in zip(pairwise(self.times), pairwise(self.places), strict=True)
            if dist(p, q) >= SAME_POINT_M
        ]
        return next((heading for end, heading in legs if t < end), legs[-1][1] if legs else pi / 2)

    def at(self, t: float) -> Place:
        """Return the position at a time. The target stands before and after its course."""
        for (a, b), (p, q) in zip(pairwise(self.times), pairwise(self.places), strict=True):
            if t < b:
                share = min(1.0, max(0.0, (t - a) / (b - a)))
                return (p[0] + share * (q[0] - p[0]), p[1] + share * (q[1] - p[1]))
        return self.places[-1]


def courses_of(sequence: Sequence, frame: CoordinateFrame, notes: Notes) -> tuple[GroundTrack | None, ...]:
    """Return the course of each action's target. Actions that continue the one before share a course.

    The course is None if an action films no target, or gives no position for it.
    """
    runs: list[_CourseBuilder] = []
    indices: list[int | None] = []
    start = LEAD_S
    for action in sequence.actions:
        points, said = list(action.points), []
        if not points and action.origin is not None:
            taken = "its target stands where the formation begins"
            said.append(notes.assume(action.node, "an action without a trajectory", taken))
            points = [action.origin]
        if not points or action.flies:
            indices.append(None)
        else:
            follows = start
            if runs and start < runs[-1].times[-1] - OVERLAP_S:
                follows = runs[-1].times[-1]
                message = "the trajectory before lasts longer than its action"
                said.append(notes.assume(action.node, message, "it is finished first"))
            places = [frame.place(p) for p in points]
            clock = _clock(action, points, places, follows, said, notes)
            if not runs or not runs[-1].takes_up(clock[0], places[0]):
                runs.append(_CourseBuilder([], [], [], []))
            runs[-1].add(clock, places, points, said)
            indices.append(len(runs) - 1)
        start += action.duration
    courses = [GroundTrack(tuple(r.times), tuple(r.places), tuple(r.points), tuple(r.comments)) for r in runs]
    return tuple(None if k is None else courses[k] for k in indices)


class _CourseBuilder(NamedTuple):
    """A course under construction."""

    times: list[float]
    places: list[Place]
    points: list[MissionPoint]
    comments: list[str]

    def takes_up(self, t: float, place: Place) -> bool:
        """Return whether the target can reach a place at a time from the end of its course."""
        return dist(self.places[-1], place) <= max(SAME_POINT_M, FASTEST_M_S * (t - self.times[-1]))

    def add(
        self, clock: list[float], places: list[Place], points: list[MissionPoint], comments: list[str]
    ) -> None:
        """Add places with their times, without points that repeat the place and time of the one before."""
        self.comments.extend(comments)
        for t, place, point in zip(clock, places, points, strict=True):
            if self.places and dist(self.places[-1], place) < SAME_POINT_M and t < self.times[-1] + 0.1:
                continue
            self.times.append(max(t, self.times[-1] + 0.1) if self.times else t)
            self.places.append(place)
            self.points.append(point)


def route_of(action: ShootingAction, frame: CoordinateFrame, start: float) -> GroundTrack:
    """Return the course of a fly-through's camera, with points evenly spaced over the action's time."""
    points = action.points or ((action.origin,) if action.origin else ())
    share = action.duration / max(len(points) - 1, 1)
    times = tuple(start + i * share for i in range(len(points)))
    return GroundTrack(times, tuple(frame.place(p) for p in points), points, ())


def gap(one: GroundTrack, other: GroundTrack) -> float:
    """Return the largest distance of two courses, metres."""
    return max(dist(one.at(t), other.at(t)) for t in {*one.times, *other.times})


def _clock(
    action: ShootingAction,
    points: list[MissionPoint],
    places: list[Place],
    start: float,
    said: list[str],
    notes: Notes,
) -> list[float]:
    """Return the mission time of each point: from the file if plausible, else from the speed."""
    lengths = [dist(p, q) for p, q in pairwise(places)]
    if sum(lengths) < SAME_POINT_M:
        return [start] * len(points)
    given = [p.time for p in points if p.time is not None]
    wrong = _wrong(points, given, lengths)
    if wrong is None:
        _compare(action, sum(lengths) / (given[-1] - given[0]), said, notes)
        return [start + t - given[0] for t in given]
    node, message = wrong
    if action.speed is not None and SLOWEST_M_S <= action.speed <= FASTEST_M_S:
        pace, taken = (
            action.speed,
            f"its points are passed at formationSpeed, {action.speed * KMH_PER_M_S:g} km/h",
        )
    else:
        pace, taken = 1.0, "its points are passed at 1 m/s, for formationSpeed is of no use"
    said.append(notes.assume(node.node.first("time") or node.node, message, taken))
    clock = [start]
    for length in lengths:
        clock.append(clock[-1] + max(length / pace, 0.1))
    return clock


def _wrong(
    points: list[MissionPoint], given: list[float], lengths: list[float]
) -> tuple[MissionPoint, str] | None:
    """Return the first point whose time is not plausible, and the reason."""
    missing = next((p for p in points if p.time is None), None)
    if missing is not None:
        return missing, "a point of the trajectory has no time"
    if not any(given):
        return points[0], "the times of the trajectory are all 0"
    for (a, b), length, point in zip(pairwise(given), lengths, points[1:], strict=True):
        if b <= a:
            return point, f"the times of the trajectory do not rise: {b:g} s follows {a:g} s"
        if length / (b - a) > FASTEST_M_S:
            return point, f"the times ask for {length / (b - a):.0f} m/s up to this point"
    return None


def _compare(action: ShootingAction, pace: float, said: list[str], notes: Notes) -> None:
    """Add a comment if the times and the formation's speed contradict each other."""
    node = action.node.first("formationSpeed")
    if node is None or action.speed is None:
        return
    if pace <= action.speed * SAME_SPEED_RATIO and action.speed <= pace * SAME_SPEED_RATIO:
        return
    message = f"formationSpeed says {action.speed:.2f} m/s, the times of the trajectory {pace:.2f} m/s"
    said.append(notes.assume(node, message, "the times hold"))
