"""The targets of a sequence: the ways of its actions, one after the other, on the mission's clock."""

from __future__ import annotations

from itertools import pairwise
from math import atan2, dist, hypot, pi
from typing import NamedTuple

from shotc.geom.geodetic import to_world
from shotc.importers.multidrone.read import Point, Sequence
from shotc.importers.notes import Notes

LEAD = 40.0  # seconds from take-off to the first frame
SAME = 0.05  # metres within which two points are one
FASTEST = 40.0  # m/s; what is faster between two points is a slip of the times
NEAR = 1.5  # metres within which two courses are those of one target
OVERLAP = 0.5  # seconds by which a trajectory may last longer than its action
SLOWEST = 0.05  # m/s; what is slower stands

Place = tuple[float, float]


class Course(NamedTuple):
    """Where a target is, on the ground: East and North in metres, and mission times in seconds.

    comments : what had to be assumed
    """

    times: tuple[float, ...]
    places: tuple[Place, ...]
    comments: tuple[str, ...]

    @property
    def stands(self) -> bool:
        """Whether it does not move."""
        return len(self.places) < 2

    def heading(self, t: float) -> float:
        """Return the way it goes, rad counter-clockwise from East; before it goes, the first way."""
        legs = [
            (b, atan2(q[1] - p[1], q[0] - p[0]))
            for (_, b), (p, q) in zip(pairwise(self.times), pairwise(self.places), strict=True)
        ]
        return next((way for end, way in legs if t < end), legs[-1][1] if legs else pi / 2)

    def at(self, t: float) -> Place:
        """Return where it is at a time; before and after its course it stands."""
        for (a, b), (p, q) in zip(pairwise(self.times), pairwise(self.places), strict=True):
            if t < b:
                share = min(1.0, max(0.0, (t - a) / (b - a)))
                return (p[0] + share * (q[0] - p[0]), p[1] + share * (q[1] - p[1]))
        return self.places[-1]


class Frame(NamedTuple):
    """Where W's origin is: latitude and longitude in degrees, or None where everything is local."""

    origin: tuple[float, float] | None

    def place(self, point: Point) -> Place:
        """Return a point as East and North of the origin, metres."""
        if not point.on_earth or self.origin is None:
            return point.at
        x, y, _ = to_world((*point.at, 0.0), (*self.origin, 0.0))
        return (x, y)


def frame_of(sequences: tuple[Sequence, ...], notes: Notes) -> Frame:
    """Choose the origin: the first place on the earth, if there is one."""
    points = [
        p for s in sequences for a in s.actions for p in (*a.points, *((a.origin,) if a.origin else ()))
    ]
    earthly, local = [p for p in points if p.on_earth], [p for p in points if not p.on_earth]
    if not earthly:
        return Frame(None)
    if local:
        notes.assume(
            local[0].node,
            f"{len(local)} points in metres stand beside {len(earthly)} in latitude and longitude",
            f"metres count from the first place on the earth, {earthly[0].at[0]:.6f}, {earthly[0].at[1]:.6f}",
        )
    return Frame(earthly[0].at)


def courses_of(sequence: Sequence, frame: Frame, notes: Notes) -> tuple[Course | None, ...]:
    """Return the course of every action's target: one for actions that take up where the last one ended."""
    runs: list[_Run] = []
    found: list[int | None] = []
    begins = LEAD
    for action in sequence.actions:
        points, said = [(p, frame.place(p)) for p in action.points], []
        if not points and action.origin is not None:
            said.append(
                notes.assume(action.node, "an action without a trajectory", "its target stands at its origin")
            )
            points = [(action.origin, frame.place(action.origin))]
        if not points:
            found.append(None)
        else:
            follows = begins
            if runs and begins < runs[-1].times[-1] - OVERLAP:
                follows = runs[-1].times[-1]
                said.append(
                    notes.assume(
                        action.node,
                        "the trajectory before lasts longer than its action",
                        "it is finished first",
                    )
                )
            clock = _clock(action.speed, points, follows, said, notes)
            if not runs or not runs[-1].takes_up(clock[0], points[0][1]):
                runs.append(_Run([], [], []))
            runs[-1].add(clock, [place for _, place in points], said)
            found.append(len(runs) - 1)
        begins += action.duration
    courses = [Course(tuple(r.times), tuple(r.places), tuple(r.comments)) for r in runs]
    return tuple(None if k is None else courses[k] for k in found)


class _Run(NamedTuple):
    """A course while it grows."""

    times: list[float]
    places: list[Place]
    comments: list[str]

    def takes_up(self, t: float, place: Place) -> bool:
        """Tell whether a target can be at a place at a time after what it did so far."""
        return dist(self.places[-1], place) <= max(SAME, FASTEST * (t - self.times[-1]))

    def add(self, clock: list[float], places: list[Place], comments: list[str]) -> None:
        """Add places with their times; what repeats the one before is dropped."""
        self.comments.extend(comments)
        for t, place in zip(clock, places, strict=True):
            if self.places and dist(self.places[-1], place) < SAME:
                continue
            self.times.append(max(t, self.times[-1] + 0.1) if self.times else t)
            self.places.append(place)


def alike(one: Course, other: Course) -> bool:
    """Tell whether two courses are those of one target: never far from each other while both are known."""
    times = sorted({*one.times, *other.times})
    return all(dist(one.at(t), other.at(t)) < NEAR for t in times)


def _clock(
    speed: float, points: list[tuple[Point, Place]], begins: float, comments: list[str], notes: Notes
) -> list[float]:
    """Return the mission time of every point: as written where that can be meant, else by the speed."""
    written = [p.time for p, _ in points]
    given = [t for t in written if t is not None]
    if len(given) == len(points) and all(b > a for a, b in pairwise(given)):
        clock = [begins + t - given[0] for t in given]
        ways = [hypot(q[0] - p[0], q[1] - p[1]) for (_, p), (_, q) in pairwise(points)]
        if all(way / (b - a) <= FASTEST for way, (a, b) in zip(ways, pairwise(clock), strict=True)):
            return clock
        wrong = f"the times ask for more than {FASTEST:g} m/s between two points"
    elif len(points) < 2:
        return [begins] * len(points)
    else:
        wrong = "the times of the trajectory are missing, or do not rise"
    pace = speed if speed >= SLOWEST else 1.0
    comments.append(notes.assume(points[0][0].node, wrong, f"the points are passed at {pace:g} m/s"))
    clock = [begins]
    for (_, p), (_, q) in pairwise(points):
        clock.append(clock[-1] + max(dist(p, q) / pace, 0.1))
    return clock
