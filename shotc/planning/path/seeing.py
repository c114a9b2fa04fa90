"""Ways between keyframes that their author placed, led to where the shot's targets are seen.

The curve through the keyframes is looked at first. Where surfaces hide a target from it, places beside it
that see more draw a second curve, which is taken where less is hidden from it. Keyframes stay where they are.
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
from shotc.planning.layered import Watched, led_round
from shotc.planning.path.lines import PACE_M_S, SAME_PLACE_M

STEP_M = 1.0  # metres of path between the places that are led, at least
MOST = 80  # of such places between two keyframes
FINER = 2  # times as many, at which curves are compared
ABOUT_M = 1.5  # metres by which a target that a way is led for is larger than it is
SMOOTHINGS = 6  # times that the places that draw a way are smoothed
ROUNDS = 4  # curves that are drawn, each from the one before
MOST_SHARE = 1 / 3  # of a target that may be hidden somewhere on a way that is not led
LESS_SHARE = 0.9  # of the time for which a plain curve's targets are hidden, with which a led one serves
LONGER_RATIO = 2.0  # times as long as the plain curve that the led one may take
NO_LENGTH = 1e-9


@dataclass(frozen=True, eq=False)
class FilmedCurve:
    """A curve through placed keyframes.

    at : path parameters of the keyframes, (K,), not decreasing
    watched : whom keyframes name, by name, each at one time
    limits : of the drone; pace : share of its speed that is flown
    """

    keyframes: tuple[PlacedKeyframe, ...]
    at: Array
    curve: Piecewise
    watched: Mapping[str, Watched]
    limits: Limits
    pace: float

    @cached_property
    def seconds(self) -> tuple[float, float]:
        """Return about how long the curve takes, and for how much of that its targets are hidden.

        Where one is hidden in part, its share counts. The speed is that which bends and the way from rest to
        rest allow; jerk is left out.
        """
        s = [self._samples(k, FINER) for k in range(len(self.at) - 1)]
        every = np.concatenate(s)
        shares = np.concatenate([self._hidden.get(k, np.zeros(len(part))) for k, part in enumerate(s)])
        steps = self._steps(every)
        return float(steps.sum()), float((0.5 * (shares[1:] + shares[:-1]) * steps).sum())

    def serves(self, plain: FilmedCurve) -> bool:
        """Tell whether targets are hidden notably less than from a plain curve, in not too long a time."""
        (takes, hidden), (least, most) = self.seconds, plain.seconds
        return hidden <= LESS_SHARE * most and takes <= LONGER_RATIO * least

    def beside(self, space: FreeSpace) -> tuple[Array, ...]:
        """Return places that draw each way to where its target is seen, (N, 3), in order; none if it is."""
        places = [np.zeros((0, 3))] * (len(self.at) - 1)
        for k, who in self._ways():
            if self._hidden[k].max() > MOST_SHARE:
                places[k] = self._led(space, k, who)
        return tuple(places)

    @cached_property
    def _hidden(self) -> dict[int, Array]:
        """The shares of its target that are hidden on each way that films one, at samples."""
        found = {}
        for k, who in self._ways():
            s = self._samples(k, FINER)
            found[k] = _repeated(who, len(s)).hidden(self.curve(s)[:, None])[:, 0]
        return found

    def _ways(self) -> Iterator[tuple[int, Watched]]:
        """Yield the ways from one keyframe to the next that film one target, and that target."""
        for k, (a, b) in enumerate(pairwise(self.keyframes)):
            moves = float(np.linalg.norm(np.subtract(a.at, b.at))) >= SAME_PLACE_M
            if moves and a.target is not None and a.target == b.target:
                yield k, self.watched[a.target]

    def _samples(self, k: int, finer: int) -> Array:
        long = float(self.at[k + 1] - self.at[k])
        return np.linspace(self.at[k], self.at[k + 1], finer * min(MOST, max(2, round(long / STEP_M))) + 1)

    def _steps(self, s: Array) -> Array:
        """Return about how many seconds pass from each of some path parameters (N,) to the next, (N - 1,)."""
        first, second = self.curve.derivative()(s), self.curve.derivative(2)(s)
        along = np.maximum(np.linalg.norm(first, axis=1), NO_LENGTH)
        bend = np.linalg.norm(np.cross(first, second), axis=1) / along**3
        most = self.limits.usable_acceleration
        square = np.minimum(most / np.maximum(bend, NO_LENGTH), self.limits.speed**2)
        long = np.linalg.norm(np.diff(self.curve(s), axis=0), axis=1)
        square[[0, -1]] = 0.0
        for i in range(1, len(s)):
            square[i] = min(square[i], square[i - 1] + 2.0 * most * long[i - 1])
        for i in range(len(s) - 2, -1, -1):
            square[i] = min(square[i], square[i + 1] + 2.0 * most * long[i])
        speed = self.pace * np.sqrt(square)
        return np.asarray(2.0 * long / np.maximum(speed[1:] + speed[:-1], NO_LENGTH))

    def _led(self, space: FreeSpace, k: int, who: Watched) -> Array:
        """Return places of the way after a keyframe, (N, 3), led to where its target is seen."""
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


def watched_at_keyframes(mission: MissionIR, placed: PlacedShot) -> Watched | None:
    """Return whom the keyframes of a shot are to see; None where nothing of triangles may hide it."""
    keyframes, names = placed.keyframes, [k.target for k in placed.keyframes]
    name = next((name for name in names if name is not None), None)
    if name is None or not is_led(mission, placed.shot):
        return None
    places = [k.at if k.target is None else mission.target(k.target).centre for k in keyframes]
    filmed = np.array([k.target is not None for k in keyframes])
    return replace(watched_at(mission, name, places), filmed=filmed)


def is_led(mission: MissionIR, shot: Shot) -> bool:
    """Tell whether a shot is led to where its targets are not hidden by anything of triangles."""
    return bool(mission.meshes or mission.terrain) and not hidden_on_purpose(shot)


def watched_at(mission: MissionIR, name: str, places: Sequence[Vec3]) -> Watched:
    """Return a target as it is watched at places, metres of W."""
    target, surfaces = mission.target(name), tuple(s for _, s in surfaces_before(mission, name))
    filmed = np.ones(len(places), dtype=bool)
    return Watched(np.array(places, dtype=np.float64), filmed, target.radius, target.height, surfaces)


@dataclass(frozen=True, slots=True)
class _Standing:
    """An obstacle as what a course keeps clear of, about the origin of W."""

    part: Solid
    clearance: float

    def at(self, times: Array) -> Array:
        """Return the origin at times (M,)."""
        return np.zeros((len(times), 3))


def _no_nearer(who: Watched, places: Array) -> _Standing:
    """Return a target as what is passed no nearer than places (N, 3) are: nearer by, it would be cropped."""
    x, y, z = who.places[0].tolist()
    body = Cylinder((x, y), who.radius, z - 0.5 * who.height, z + 0.5 * who.height)
    return _Standing(body, float(distances(body, places).min()) - MARGIN_M)


def _larger(who: Watched) -> Watched:
    """Return a target on the same ground that is larger: a curve is a little off the places that draw it."""
    higher = who.places + np.array([0.0, 0.0, 0.5 * ABOUT_M])
    return replace(who, places=higher, radius=who.radius + ABOUT_M, height=who.height + ABOUT_M)


def _smooth(off: Array) -> Array:
    """Return offsets (N, 3) with less of a change from one to the next; both ends stay."""
    off = off.copy()
    for _ in range(SMOOTHINGS):
        off[1:-1] = 0.25 * off[:-2] + 0.5 * off[1:-1] + 0.25 * off[2:]
    return off


def _repeated(who: Watched, times: int) -> Watched:
    return who.at(np.zeros(times, dtype=np.intp))
