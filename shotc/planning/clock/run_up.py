"""The run-up to a shot's motion and the run-out after it: straight, between rest and the speed at the film's
ends.

The place of rest is free, so that each takes the least time between rest and that speed. Where the time does
not allow this, a run-up begins where the drone is: at rest, or in the run-out of the film before it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import partial
from math import hypot, inf

import numpy as np

from shotc.geom.bernstein import Array, Piecewise, quintic_hermite
from shotc.geom.ease import minimum_jerk
from shotc.ir.drone import Drone
from shotc.ir.ideal import ideal_place
from shotc.ir.limits import Limits
from shotc.ir.mission import MissionIR, Shot
from shotc.ir.path import ClockLeg
from shotc.planning.timing.straight import LineLimits

STEP_S = 0.5  # seconds over which the speed at the ends of a shot is measured
SPLINE_RATIO = 1.05  # time of a spline over the least time, because its control points keep the limits
SETTLE_S = 0.4  # seconds beyond that, in which camera and position settle
SHORTEST_S = 2.0  # least seconds: a shorter one has too few pieces for a refiner

GOES_ON_SHARE, ACROSS_SHARE = 0.4, 0.7
"""Of a run-up that leads aside: the share flown at the film's speed, and the share in which the shift is
done.
"""

Places = Callable[[float], tuple[float, float, float]]
"""The reference position of a camera at a mission time, metres."""


@dataclass(frozen=True, slots=True, eq=False)
class Departure:
    """Where and when a run-up begins.

    time : mission time, seconds
    position : value, rate and acceleration in W, shape (3, 3), SI
    angles : the same of camera yaw, camera pitch and body yaw; None where they are free, at rest
    cut : the leg before it, which ends there without rest; None if the drone is at rest
    """

    time: float
    position: Array
    angles: Array | None = None
    cut: ClockLeg | None = None

    @classmethod
    def at_rest(cls, place: Array, time: float) -> Departure:
        """Return the departure from rest at a place, shape (3,), metres."""
        return cls(time, np.array([place, np.zeros(3), np.zeros(3)]))


@dataclass(frozen=True, slots=True, eq=False)
class Link:
    """A motion from the run-out of one film to the beginning of the next one, without a stop.

    curve : positions over time relative to the beginning of that film, seconds
    """

    curve: Piecewise

    @property
    def seconds(self) -> float:
        """Its duration."""
        return -float(self.curve.start)

    def at(self, seconds: Array) -> Array:
        """Return positions (M, 3) at times (M,) relative to the film's beginning, seconds."""
        return self.curve(np.clip(seconds, self.curve.start, self.curve.end))


@dataclass(frozen=True, slots=True, eq=False)
class RunUp:
    """A motion between rest and an end of a film.

    seconds : its duration
    place, velocity : at its film end, shape (3,), metres and m/s
    shift : of the place of rest from the straight course, shape (3,), metres
    """

    seconds: float
    place: Array
    velocity: Array
    shift: Array = field(default_factory=partial(np.zeros, 3))

    @property
    def rest(self) -> Array:
        """The place of rest before the film, shape (3,), metres."""
        return np.asarray(self.at(np.array([-self.seconds]))[0])

    def lasting(self, times: float) -> RunUp:
        """Return the run-up with its duration multiplied by ``times``."""
        return replace(self, seconds=times * self.seconds)

    def begun(self, departure: Departure, film: float) -> RunUp | Link:
        """Return the run-up with a given beginning to a film whose first frame is at mission time ``film``.

        From rest it takes no less time than this one, which needs the least.
        """
        seconds, place = film - departure.time, departure.position[0]
        if departure.cut is not None:
            states = np.stack([departure.position, [self.place, self.velocity, np.zeros(3)]], axis=1)
            return Link(quintic_hermite(np.array([-seconds, 0.0]), *states))
        longer = replace(self, seconds=max(seconds, self.seconds), shift=np.ones(3))
        return replace(longer, shift=place - (longer.rest - longer.shift))

    def led(self, shift: Array, limits: Limits) -> RunUp:
        """Return the run-up that ends shifted by ``shift``, shape (3,), metres, with the duration that this
        needs.
        """
        level, rise = float(np.hypot(shift[0], shift[1])), abs(float(shift[2]))
        needed = max(
            _bounds(limits, _either_way(limits, shift)).rest_to_rest(level),
            _bounds(limits, min(limits.climb, limits.descent)).rest_to_rest(rise),
        )
        least = max(self.seconds, SPLINE_RATIO * needed / ACROSS_SHARE + SETTLE_S)
        return replace(
            self, seconds=least / (1.0 - GOES_ON_SHARE) if shift.any() else self.seconds, shift=shift
        )

    def at(self, seconds: Array) -> Array:
        """Return positions (M, 3) at times (M,) relative to the film's end, seconds; negative is before the
        film.

        The speed changes smoothly between zero and the film's speed; beyond the run-up the drone rests. A
        run-up with a shift keeps the film's speed for a part of its duration: a subject that follows the
        camera would run into a drone that slows down first.
        """
        x = np.clip(1.0 - np.abs(seconds) / self.seconds, 0.0, 1.0)
        goes_on = GOES_ON_SHARE if self.shift.any() else 0.0
        y = np.minimum(x / (1.0 - goes_on), 1.0)
        evenly = np.minimum(1.0 - x, goes_on)
        flown = self.seconds * (evenly + (1.0 - goes_on) * (0.5 - y**3 + 0.5 * y**4))
        beside = minimum_jerk(np.minimum((1.0 - x) / ACROSS_SHARE, 1.0))
        straight = self.place + (np.sign(seconds) * flown)[:, None] * self.velocity
        return np.asarray(straight + beside[:, None] * self.shift)


def lead_in(mission: MissionIR, drone: Drone, shot: Shot, start: float) -> RunUp:
    """Return the run-up to a shot whose first frame is at ``start``."""
    return _run_up(drone, partial(ideal_place, mission, shot, start), start, STEP_S)


def run_ups(mission: MissionIR, drone: Drone, shot: Shot, start: float) -> tuple[RunUp, RunUp]:
    """Return the run-up and the run-out of a shot whose first frame is at ``start``."""
    end = start + (shot.timing.duration or 0.0)
    after = _run_up(drone, partial(ideal_place, mission, shot, start), end, -STEP_S)
    return lead_in(mission, drone, shot, start), after


def _run_up(drone: Drone, place: Places, t: float, step: float) -> RunUp:
    here, velocity = np.array(place(t)), (np.array(place(t + step)) - np.array(place(t))) / step
    limits = drone.limits
    level, up = hypot(velocity[0], velocity[1]), velocity[2]
    fastest = limits.speed_along(float(velocity[0]), float(velocity[1]))
    share = max(level / fastest, up / limits.climb, -up / limits.descent, 1.0)
    velocity = velocity / share
    least = _bounds(limits).least_time(float(np.linalg.norm(velocity)))
    return RunUp(max(SHORTEST_S, SPLINE_RATIO * least + SETTLE_S), here, velocity)


def way_time(limits: Limits, displacement: Array) -> float:
    """Return the least time of a straight transfer from rest to rest, seconds.

    Horizontal and vertical motion are at the same time; the slower one decides.

    displacement : shape (3,), metres
    """
    fastest = limits.speed_along(float(displacement[0]), float(displacement[1]))
    level = _bounds(limits, fastest).rest_to_rest(float(np.linalg.norm(displacement[:2])))
    speed = limits.climb if displacement[2] > 0.0 else limits.descent
    return max(level, _bounds(limits, speed).rest_to_rest(abs(float(displacement[2]))))


def _bounds(limits: Limits, speed: float = inf) -> LineLimits:
    return LineLimits(speed, limits.usable_acceleration, limits.jerk)


def _either_way(limits: Limits, displacement: Array) -> float:
    """Return the ground speed that is feasible in both directions of a displacement, m/s."""
    east, north = float(displacement[0]), float(displacement[1])
    return min(limits.speed_along(east, north), limits.speed_along(-east, -north))
