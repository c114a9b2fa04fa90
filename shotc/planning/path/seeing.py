"""Ways between placed keyframes, led to where the shot's targets are visible.

The curve through the keyframes is found first. Where surfaces hide a target from it, places beside it that
see more attract a second curve, which is used if less is hidden from it. Keyframes keep their places.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise

import numpy as np

from shotc.geom.bernstein import Array, Piecewise
from shotc.geom.solid_arrays.points import distances
from shotc.geom.solids import Cylinder, Solid
from shotc.geom.vec import Vec3
from shotc.ir.allow import hidden_on_purpose
from shotc.ir.hiding_surfaces import surfaces_before
from shotc.ir.keyframes import PlacedKeyframe, PlacedShot
from shotc.ir.limits import Limits
from shotc.ir.mission import MissionIR, Shot
from shotc.planning.free_space import MARGIN_M, FreeSpace, breaches
from shotc.planning.layered import VisibleSubject, led_round
from shotc.planning.path.lines import PACE_M_S, SAME_PLACE_M

STEP_M = 1.0  # least metres of path between led places
MOST_PLACES = 80  # most led places between two keyframes
FINER_RATIO = 2  # factor of their number, for the comparison of curves
ABOUT_M = 1.5  # metres by which a target is enlarged
COURSE_SMOOTHINGS = 6  # smoothing passes over the led places
CURVE_ROUNDS = 4  # rounds, each from the last curve
MOST_SHARE = 1 / 3  # hidden share of a target above which a way is led
LESS_SHARE = 0.9  # largest ratio of hidden times between a led curve and the plain one
LONGER_RATIO = 2.0  # largest ratio of durations between a led curve and the plain one
NO_LENGTH_M = 1e-9


@dataclass(frozen=True, eq=False)
class FilmedCurve:
    """A curve through placed keyframes.

    at : path parameters of the keyframes, (K,), not decreasing
    watched : the targets of keyframes, by name, each at one time
    limits : of the drone
    pace : share of its speed
    """

    keyframes: tuple[PlacedKeyframe, ...]
    at: Array
    curve: Piecewise
    watched: Mapping[str, VisibleSubject]
    limits: Limits
    pace: float

    @cached_property
    def seconds(self) -> tuple[float, float]:
        """Return the approximate duration of the curve, and how long its targets are hidden, seconds.

        Where a target is hidden in part, its hidden share counts. The speed keeps limits of speed, lateral
        and tangential acceleration; jerk is ignored.
        """
        s = [self._samples(k, FINER_RATIO) for k in range(len(self.at) - 1)]
        every = np.concatenate(s)
        shares = np.concatenate([self._hidden.get(k, np.zeros(len(part))) for k, part in enumerate(s)])
        steps = self._steps(every)
        return float(steps.sum()), float((0.5 * (shares[1:] + shares[:-1]) * steps).sum())

    def serves(self, plain: FilmedCurve) -> bool:
        """Return whether targets are hidden notably less than from a plain curve, at an acceptable
        duration.
        """
        (takes, hidden), (least, most) = self.seconds, plain.seconds
        return hidden <= LESS_SHARE * most and takes <= LONGER_RATIO * least

    def beside(self, space: FreeSpace) -> tuple[Array, ...]:
        """Return places that lead each way to see its target, (N, 3), in order; empty where it is visible."""
        places = [np.zeros((0, 3))] * (len(self.at) - 1)
        for k, who in self._ways():
            if self._hidden[k].max() > MOST_SHARE:
                places[k] = self._led(space, k, who)
        return tuple(places)

    @cached_property
    def _hidden(self) -> dict[int, Array]:
        """The hidden shares of its target on each way that films one, at samples."""
        hidden = {}
        for k, who in self._ways():
            s = self._samples(k, FINER_RATIO)
            hidden[k] = _repeated(who, len(s)).hidden(self.curve(s)[:, None])[:, 0]
        return hidden

    def _ways(self) -> Iterator[tuple[int, VisibleSubject]]:
        """Yield the ways from one keyframe to the next that film one target, and that target."""
        for k, (a, b) in enumerate(pairwise(self.keyframes)):
            moves = float(np.linalg.norm(np.subtract(a.at, b.at))) >= SAME_PLACE_M
            if moves and a.target is not None and a.target == b.target:
                yield k, self.watched[a.target]

    def _samples(self, k: int, finer: int) -> Array:
        long = float(self.at[k + 1] - self.at[k])
        return np.linspace(
            self.at[k], self.at[k + 1], finer * min(MOST_PLACES, max(2, round(long / STEP_M))) + 1
        )

    def _steps(self, s: Array) -> Array:
        """Return the approximate seconds between path parameters (N,), shape (N - 1,)."""
        first, second = self.curve.derivative()(s), self.curve.derivative(2)(s)
        along = np.maximum(np.linalg.norm(first, axis=1), NO_LENGTH_M)
        bend = np.linalg.norm(np.cross(first, second), axis=1) / along**3
        most = self.limits.usable_acceleration
        square = np.minimum(most / np.maximum(bend, NO_LENGTH_M), self.limits.speed**2)
        long = np.linalg.norm(np.diff(self.curve(s), axis=0), axis=1)
        square[[0, -1]] = 0.0
        for i in range(1, len(s)):
            square[i] = min(square[i], square[i - 1] + 2.0 * most * long[i - 1])
        for i in range(len(s) - 2, -1, -1):
            square[i] = min(square[i], square[i + 1] + 2.0 * most * long[i])
        speed = self.pace * np.sqrt(square)
        return np.asarray(2.0 * long / np.maximum(speed[1:] + speed[:-1], NO_LENGTH_M))

    def _led(self, space: FreeSpace, k: int, who: VisibleSubject) -> Array:
        """Return places of the way after a keyframe, (N, 3), led to where its target is visible."""
        places = self.curve(self._samples(k, 1))
        steps = np.linalg.norm(np.diff(places, axis=0), axis=1)
        times = np.concatenate([[0.0], np.cumsum(steps)]) / PACE_M_S
        held = np.zeros(len(times), dtype=bool)
        held[[0, -1]] = True
        near = [_Standing(o.part, o.clearance) for o in space.obstacles] + [_no_nearer(who, places)]
        seen = _repeated(_larger(who), len(times))
        course = led_round(space.bounds, near, (times, places), seen, held, joined=False)
        if not course.for_sight.any():
            return np.zeros((0, 3))
        led = places + _smooth(course.places - places)
        free = np.array([not breaches(space.lent(-MARGIN_M), p) for p in led])
        return np.asarray(led[free & ~held])


def watched_at_keyframes(mission: MissionIR, placed: PlacedShot) -> VisibleSubject | None:
    """Return the subject that a shot's keyframes should see; None where no mesh or terrain may hide it."""
    keyframes, names = placed.keyframes, [k.target for k in placed.keyframes]
    name = next((name for name in names if name is not None), None)
    if name is None or not is_led(mission, placed.shot):
        return None
    places = [k.at if k.target is None else mission.target(k.target).centre for k in keyframes]
    filmed = np.array([k.target is not None for k in keyframes])
    return replace(watched_at(mission, name, places), filmed=filmed)


def is_led(mission: MissionIR, shot: Shot) -> bool:
    """Return whether a shot is led around meshes and terrain that hide its targets."""
    return bool(mission.meshes or mission.terrain) and not hidden_on_purpose(shot)


def watched_at(mission: MissionIR, name: str, places: Sequence[Vec3]) -> VisibleSubject:
    """Return a target as it is watched at places of W, metres."""
    target, surfaces = mission.target(name), tuple(s for _, s in surfaces_before(mission, name))
    filmed = np.ones(len(places), dtype=bool)
    return VisibleSubject(np.array(places, dtype=np.float64), filmed, target.radius, target.height, surfaces)


@dataclass(frozen=True, slots=True)
class _Standing:
    """A standing obstacle as a solid about the origin of W, with its clearance."""

    part: Solid
    clearance: float

    def at(self, times: Array) -> Array:
        """Return the origin at times (M,)."""
        return np.zeros((len(times), 3))


def _no_nearer(who: VisibleSubject, places: Array) -> _Standing:
    """Return a target as an obstacle with the least distance of places (N, 3) as its clearance.

    A nearer camera would crop it.
    """
    x, y, z = who.places[0].tolist()
    body = Cylinder((x, y), who.radius, z - 0.5 * who.height, z + 0.5 * who.height)
    return _Standing(body, float(distances(body, places).min()) - MARGIN_M)


def _larger(who: VisibleSubject) -> VisibleSubject:
    """Return an enlarged target on the same ground, because a curve deviates from its led places."""
    higher = who.places + np.array([0.0, 0.0, 0.5 * ABOUT_M])
    return replace(who, places=higher, radius=who.radius + ABOUT_M, height=who.height + ABOUT_M)


def _smooth(off: Array) -> Array:
    """Return smoothed offsets (N, 3); both ends stay."""
    off = off.copy()
    for _ in range(COURSE_SMOOTHINGS):
        off[1:-1] = 0.25 * off[:-2] + 0.5 * off[1:-1] + 0.25 * off[2:]
    return off


def _repeated(who: VisibleSubject, times: int) -> VisibleSubject:
    return who.at(np.zeros(times, dtype=np.intp))
