"""The motion of a target: rows of time and position, with constant velocity between them. Plain Python."""

from bisect import bisect_right
from functools import lru_cache
from itertools import pairwise
from math import atan2, hypot, inf, pi
from typing import NamedTuple, Self

from shotc.geom.same import Same
from shotc.geom.vec import Vec3

HEADING_SPAN_S = 1.0  # seconds before and after, over which a heading follows from the motion
STILL_M = 1e-6  # metres or m/s, for rounding
MOVES_M = 0.1  # metres over that time; a target that moves less stands still
STRAIGHT_SINE = 1e-6  # largest sine of the angle between two segments of the same direction
LEAST_LEG_M = 1e-9  # metres, least length of a segment with a direction


class Track(NamedTuple):
    """The position of a target's centre over mission time.

    times : seconds, rising, at least one; points : p_WT at them, metres
    headings : rad counter-clockwise from East, unwrapped, or () if the target faces its direction of motion
    after : velocity after the last row, m/s
    since, until : times between which the motion is known, seconds; before, it stands at its first row
    smoothed : largest displacement of a row by smoothing, metres
    """

    times: tuple[float, ...]
    points: tuple[Vec3, ...]
    headings: tuple[float, ...] = ()
    after: Vec3 = (0.0, 0.0, 0.0)
    since: float = 0.0
    until: float = inf
    smoothed: float = 0.0

    def at(self, t: float) -> Vec3:
        """Return the position at a time, metres."""
        i, share = self._row(t)
        if i == len(self.times) - 1:
            late, (x, y, z), (u, v, w) = max(0.0, t - self.times[-1]), self.points[-1], self.after
            return (x + u * late, y + v * late, z + w * late)
        return between(self.points[i], self.points[i + 1], share)

    def heading(self, t: float) -> float:
        """Return the heading at a time, rad; without ``headings``, from the motion of the seconds around it.

        While it stands it keeps its last direction of motion. Before its first motion it has that one's
        direction.
        """
        if self.headings:
            i, share = self._row(t)
            if i == len(self.times) - 1:
                return self.headings[-1]
            return self.headings[i] + share * (self.headings[i + 1] - self.headings[i])
        moved = self._moved(t)
        return self._last_course(t) if moved is None else atan2(moved[1], moved[0])

    def course(self, t: float) -> tuple[float, float] | None:
        """Return the unit direction of motion over ground around a time; None if it stands."""
        moved = self._moved(t)
        return None if moved is None else (moved[0] / hypot(*moved), moved[1] / hypot(*moved))

    @property
    def underway(self) -> float:
        """A time from which its course is known, seconds."""
        return self.times[0] + HEADING_SPAN_S

    @property
    def straight(self) -> bool:
        """Whether it moves in one direction only and keeps its heading."""
        legs = [(b[0] - a[0], b[1] - a[1]) for a, b in pairwise(self.points)]
        legs = [leg for leg in (*legs, self.after[:2]) if hypot(*leg) > LEAST_LEG_M]
        if not legs:
            return False
        if self.headings and max(self.headings) - min(self.headings) > pi / 180:
            return False
        x, y = legs[0]
        return all(
            abs(x * b - y * a) <= STRAIGHT_SINE * hypot(x, y) * hypot(a, b) and x * a + y * b > 0
            for a, b in legs
        )

    def speed(self, t: float) -> float:
        """Return its speed at a time, m/s; at a row, that after it."""
        i, _ = self._row(t)
        if i == len(self.times) - 1:
            return hypot(*self.after)
        if t < self.times[0]:
            return 0.0
        distance = hypot(*(b - a for a, b in zip(self.points[i], self.points[i + 1], strict=True)))
        return distance / (self.times[i + 1] - self.times[i])

    def beginning(self, start: float) -> Self:
        """Return the same motion with its first row at a time, seconds."""
        times = tuple(start + (t - self.times[0]) for t in self.times)
        return self._replace(times=times, since=times[0], until=times[-1])

    def _row(self, t: float) -> tuple[int, float]:
        """Return the row before a time, and the share of the time to the next row, 0 to 1."""
        i = bisect_right(self.times, t) - 1
        if i < 0:
            return 0, 0.0
        if i == len(self.times) - 1:
            return i, 0.0
        before = self.times[i]
        return i, (t - before) / (self.times[i + 1] - before)

    def _moved(self, t: float) -> tuple[float, float] | None:
        """Return the ground displacement within HEADING_SPAN_S around a time, metres; None if it stands."""
        a, b = self.at(t - HEADING_SPAN_S), self.at(t + HEADING_SPAN_S)
        moved = (b[0] - a[0], b[1] - a[1])
        return moved if hypot(*moved) >= MOVES_M else None

    def _last_course(self, t: float) -> float:
        """Return the direction of the last motion before a time, or of the first motion, rad."""
        i, _ = self._row(t)
        carried = hypot(self.after[0], self.after[1]) > STILL_M
        moving = _moving(Same(self.points))
        if carried and (i == len(self.times) - 1 or not moving):
            return atan2(self.after[1], self.after[0])
        if not moving:
            return pi / 2
        a = moving[max(0, bisect_right(moving, i) - 1)]
        b = a + 1
        return atan2(self.points[b][1] - self.points[a][1], self.points[b][0] - self.points[a][0])


def between(a: Vec3, b: Vec3, share: float) -> Vec3:
    """Return the place at a share of the way between two, metres; asked for by the thousand."""
    x, y, z = a
    u, v, w = b
    return (x + share * (u - x), y + share * (v - y), z + share * (w - z))


@lru_cache(maxsize=64)
def _moving(rows: Same[tuple[Vec3, ...]]) -> tuple[int, ...]:
    """Return the rows after which the target moves over ground."""
    legs = enumerate(pairwise(rows.it))
    return tuple(i for i, (a, b) in legs if hypot(b[0] - a[0], b[1] - a[1]) > STILL_M)


def unwrapped(angles: list[float]) -> tuple[float, ...]:
    """Return unwrapped angles: none is more than half a turn from the one before."""
    turned: list[float] = []
    for angle in angles:
        turns = round((turned[-1] - angle) / (2 * pi)) if turned else 0
        turned.append(angle + 2 * pi * turns)
    return tuple(turned)
