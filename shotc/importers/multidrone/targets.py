"""The targets of a sequence: the ways of its actions, one after the other, on the mission's clock."""

from __future__ import annotations

from itertools import pairwise
from math import atan2, dist, pi
from typing import NamedTuple

from shotc.importers.multidrone.frames import CoordinateFrame, Place
from shotc.importers.multidrone.read import KMH, MissionPoint, Sequence, ShootingAction
from shotc.importers.notes import Notes

LEAD = 40.0  # seconds from take-off to the first frame
SAME = 0.05  # metres within which two points are one
FASTEST = 40.0  # m/s; what is faster between two points is a slip of the times
NEAR = 1.5  # metres within which two courses are those of one target
OVERLAP = 0.5  # seconds by which a trajectory may last longer than its action
SLOWEST = 0.05  # m/s; what is slower stands
DIFFERS = 1.5  # by which factor two speeds may differ and count as one


class GroundTrack(NamedTuple):
    """Where a target is, on the ground: mission times in seconds, East and North in metres.

    points : the same places as the file has them; comments : what had to be assumed
    """

    times: tuple[float, ...]
    places: tuple[Place, ...]
    points: tuple[MissionPoint, ...]
    comments: tuple[str, ...]

    @property
    def stands(self) -> bool:
        """Whether it does not move."""
        return all(dist(self.places[0], place) < SAME for place in self.places)

    def moves(self, t: float) -> bool:
        """Return whether it moves at a time."""
        return dist(self.at(t - 0.5), self.at(t + 0.5)) >= SLOWEST

    def heading(self, t: float) -> float:
        """Return the way it goes, rad counter-clockwise from East; while it stands, the way it will go."""
        legs = [
            (b, atan2(q[1] - p[1], q[0] - p[0]))
            for (_, b), (p, q) in zip(pairwise(self.times), pairwise(self.places), strict=True)
            if dist(p, q) >= SAME
        ]
        return next((way for end, way in legs if t < end), legs[-1][1] if legs else pi / 2)

    def at(self, t: float) -> Place:
        """Return where it is at a time; before and after its course it stands."""
        for (a, b), (p, q) in zip(pairwise(self.times), pairwise(self.places), strict=True):
            if t < b:
                share = min(1.0, max(0.0, (t - a) / (b - a)))
                return (p[0] + share * (q[0] - p[0]), p[1] + share * (q[1] - p[1]))
        return self.places[-1]


def courses_of(sequence: Sequence, frame: CoordinateFrame, notes: Notes) -> tuple[GroundTrack | None, ...]:
    """Return the course of every action's target: one for actions that take up where the last one ended.

    None for an action that films no target, or says nowhere where it is.
    """
    runs: list[_Run] = []
    found: list[int | None] = []
    begins = LEAD
    for action in sequence.actions:
        points, said = list(action.points), []
        if not points and action.origin is not None:
            taken = "its target stands where the formation begins"
            said.append(notes.assume(action.node, "an action without a trajectory", taken))
            points = [action.origin]
        if not points or action.flies:
            found.append(None)
        else:
            follows = begins
            if runs and begins < runs[-1].times[-1] - OVERLAP:
                follows = runs[-1].times[-1]
                message = "the trajectory before lasts longer than its action"
                said.append(notes.assume(action.node, message, "it is finished first"))
            places = [frame.place(p) for p in points]
            clock = _clock(action, points, places, follows, said, notes)
            if not runs or not runs[-1].takes_up(clock[0], places[0]):
                runs.append(_Run([], [], [], []))
            runs[-1].add(clock, places, points, said)
            found.append(len(runs) - 1)
        begins += action.duration
    courses = [GroundTrack(tuple(r.times), tuple(r.places), tuple(r.points), tuple(r.comments)) for r in runs]
    return tuple(None if k is None else courses[k] for k in found)


class _Run(NamedTuple):
    """A course while it grows."""

    times: list[float]
    places: list[Place]
    points: list[MissionPoint]
    comments: list[str]

    def takes_up(self, t: float, place: Place) -> bool:
        """Return whether a target can be at a place at a time after what it did so far."""
        return dist(self.places[-1], place) <= max(SAME, FASTEST * (t - self.times[-1]))

    def add(
        self, clock: list[float], places: list[Place], points: list[MissionPoint], comments: list[str]
    ) -> None:
        """Add places with their times; what repeats the one before, place and time, is dropped."""
        self.comments.extend(comments)
        for t, place, point in zip(clock, places, points, strict=True):
            if self.places and dist(self.places[-1], place) < SAME and t < self.times[-1] + 0.1:
                continue
            self.times.append(max(t, self.times[-1] + 0.1) if self.times else t)
            self.places.append(place)
            self.points.append(point)


def route_of(action: ShootingAction, frame: CoordinateFrame, begins: float) -> GroundTrack:
    """Return the way of a fly-through, which is its camera's own, evenly over the action's time."""
    points = action.points or ((action.origin,) if action.origin else ())
    share = action.duration / max(len(points) - 1, 1)
    times = tuple(begins + i * share for i in range(len(points)))
    return GroundTrack(times, tuple(frame.place(p) for p in points), points, ())


def gap(one: GroundTrack, other: GroundTrack) -> float:
    """Return how far two courses are apart, at most, in metres."""
    return max(dist(one.at(t), other.at(t)) for t in {*one.times, *other.times})


def _clock(
    action: ShootingAction,
    points: list[MissionPoint],
    places: list[Place],
    begins: float,
    said: list[str],
    notes: Notes,
) -> list[float]:
    """Return the mission time of every point: as written where that can be meant, else by the speed."""
    ways = [dist(p, q) for p, q in pairwise(places)]
    if sum(ways) < SAME:
        return [begins] * len(points)
    given = [p.time for p in points if p.time is not None]
    wrong = _wrong(points, given, ways)
    if wrong is None:
        _compare(action, sum(ways) / (given[-1] - given[0]), said, notes)
        return [begins + t - given[0] for t in given]
    node, message = wrong
    if action.speed is not None and SLOWEST <= action.speed <= FASTEST:
        pace, taken = action.speed, f"its points are passed at formationSpeed, {action.speed * KMH:g} km/h"
    else:
        pace, taken = 1.0, "its points are passed at 1 m/s, for formationSpeed is of no use"
    said.append(notes.assume(node.node.first("time") or node.node, message, taken))
    clock = [begins]
    for way in ways:
        clock.append(clock[-1] + max(way / pace, 0.1))
    return clock


def _wrong(
    points: list[MissionPoint], given: list[float], ways: list[float]
) -> tuple[MissionPoint, str] | None:
    """Return the first point whose time cannot be meant, and why."""
    missing = next((p for p in points if p.time is None), None)
    if missing is not None:
        return missing, "a point of the trajectory has no time"
    if not any(given):
        return points[0], "the times of the trajectory are all 0"
    for (a, b), way, point in zip(pairwise(given), ways, points[1:], strict=True):
        if b <= a:
            return point, f"the times of the trajectory do not rise: {b:g} s follows {a:g} s"
        if way / (b - a) > FASTEST:
            return point, f"the times ask for {way / (b - a):.0f} m/s up to this point"
    return None


def _compare(action: ShootingAction, pace: float, said: list[str], notes: Notes) -> None:
    """Say where the times and the formation's speed contradict each other."""
    node = action.node.first("formationSpeed")
    if node is None or action.speed is None:
        return
    if pace <= action.speed * DIFFERS and action.speed <= pace * DIFFERS:
        return
    message = f"formationSpeed says {action.speed:.2f} m/s, the times of the trajectory {pace:.2f} m/s"
    said.append(notes.assume(node, message, "the times hold"))
