"""Thinning: as few straight legs as keep position, heading and picture within tolerance.

The algorithm is greedy from the start of each stretch. It takes the longest leg whose flown pose, as the
autopilot would interpolate it, stays within tolerance of the plan at every sample.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import radians

import numpy as np
from numpy.typing import NDArray

from shotc.emit.mavlink.focus import Focus
from shotc.emit.mavlink.style import Style, command_of, facing, follow, region_of, turns_body
from shotc.emit.waypoints.clearance import Obstacle, shortfall
from shotc.emit.waypoints.lens import edge
from shotc.emit.waypoints.track import SAMPLE_STEP_S, Poses, SampledFlight, SampleRange, project, select
from shotc.geom.vec import wrapped
from shotc.ir.drone import Drone

Array = NDArray[np.float64]

SHORTEST_LEG_S = 0.5  # seconds; autopilots skip waypoints that follow each other faster
CLEARANCE_CUT_M = 0.02  # metres by which a straight leg may violate a clearance that the curve keeps
EVENING_HALVINGS = 5  # bisection steps of the tolerance scale for legs of even length
LARGEST_TURN_RAD = radians(170.0)  # rad of one leg, so that the shortest turn is the planned one
SHORTEST_CHORD_M = 1e-3  # metres; shorter chords have no direction


@dataclass(frozen=True, slots=True)
class Tolerance:
    """How far the flight plan may deviate: metres, rad, (u, v) units."""

    position: float = 0.25
    heading: float = radians(3.0)
    screen: float = 0.03

    def scaled(self, framing: float, position: float = 1.0) -> Tolerance:
        """Return the tolerance with heading and screen multiplied by ``framing``, and position by
        ``position``.
        """
        return Tolerance(self.position * position, self.heading * framing, self.screen * framing)


@dataclass(frozen=True, slots=True)
class StraightLeg:
    """One straight leg from sample ``first`` to sample ``last``; a stay if ``rest``."""

    first: int
    last: int
    shot: str | None
    rest: bool


@dataclass(frozen=True, slots=True, eq=False)
class Thinner:
    """Cuts one drone's track into legs.

    planned_shortfall : missing clearance of the plan at each sample, one array (n,) for each obstacle, metres
    focus : focus distances along the flight; None where the file does not set the focus
    """

    track: SampledFlight
    drone: Drone
    style: Style
    obstacles: tuple[Obstacle, ...]
    planned_shortfall: tuple[Array, ...]
    focus: Focus | None = None

    def legs(self, tolerance: Tolerance, *, even: bool = True) -> list[StraightLeg]:
        """Return the legs of the whole track; ``even`` takes more computation and gives no more legs."""
        cut = self._even if even else self._greedy
        return [leg for stretch in self.track.stretches for leg in cut(stretch, tolerance)]

    def _even(self, stretch: SampleRange, tolerance: Tolerance) -> list[StraightLeg]:
        # Greedy cutting leaves a short last leg; a tighter tolerance with the same number of legs evens them
        # out.
        best, low, high = self._greedy(stretch, tolerance), 0.0, 1.0
        for _ in range(EVENING_HALVINGS):
            share = (low + high) / 2
            trial = self._greedy(stretch, tolerance.scaled(share, share))
            if len(trial) <= len(best):
                best, high = trial, share
            else:
                low = share
        return best

    def _greedy(self, stretch: SampleRange, tolerance: Tolerance) -> list[StraightLeg]:
        out: list[StraightLeg] = []
        first = stretch.first
        while first < stretch.last:
            last = self._longest(stretch, first, tolerance)
            out.append(StraightLeg(first, last, stretch.shot, stretch.rest))
            first = last
        return out

    def _longest(self, stretch: SampleRange, first: int, tolerance: Tolerance) -> int:
        time = self.track.time
        least = int(np.searchsorted(time, time[first] + SHORTEST_LEG_S - SAMPLE_STEP_S / 2))
        good, step = min(max(least, first + 1), stretch.last), 4
        bad = stretch.last + 1
        while good < stretch.last:
            trial = min(good + step, stretch.last)
            if not self._fits(StraightLeg(first, trial, stretch.shot, stretch.rest), tolerance):
                bad = trial
                break
            good, step = trial, step * 2
        while bad - good > 1:
            trial = (good + bad) // 2
            if self._fits(StraightLeg(first, trial, stretch.shot, stretch.rest), tolerance):
                good = trial
            else:
                bad = trial
        return good

    def _fits(self, leg: StraightLeg, tolerance: Tolerance) -> bool:
        part = slice(leg.first, leg.last + 1)
        planned = select(self.track.poses, part)
        share = along(planned.position, self.track.time[part], rest=leg.rest)
        a, b = planned.position[0], planned.position[-1]
        flown = a + share[:, None] * (b - a)
        if np.linalg.norm(flown - planned.position, axis=1).max() > tolerance.position:
            return False
        if not self._clear(part, flown, tolerance.position):
            return False
        if leg.shot is None:
            return True
        if abs(planned.body_yaw[-1] - planned.body_yaw[0]) > LARGEST_TURN_RAD:
            return False
        poses = self._flown(leg, planned, flown, share)
        if np.abs(wrapped(poses.body_yaw - planned.body_yaw)).max() > tolerance.heading:
            return False
        if edge(planned.hfov, poses.hfov).max() > tolerance.screen or not self._sharp(part):
            return False
        subject = self.track.subject[part]
        shift = project(poses, subject, self.drone) - project(planned, subject, self.drone)
        return bool(np.nanmax(np.hypot(*shift.T), initial=0.0) <= tolerance.screen)

    def _sharp(self, part: slice) -> bool:
        """Return whether one focus distance is sharp enough for a leg."""
        middle = None if self.focus is None else self.focus.middle(part)
        return self.focus is None or middle is None or self.focus.serves(part, middle)

    def _clear(self, part: slice, flown: Array, reach: float) -> bool:
        for obstacle, planned in zip(self.obstacles, self.planned_shortfall, strict=True):
            worst = float(planned[part].max())
            if worst > -reach and shortfall(obstacle, flown).max() > max(worst, 0.0) + CLEARANCE_CUT_M:
                return False
        return True

    def _flown(self, leg: StraightLeg, planned: Poses, flown: Array, share: Array) -> Poses:
        command = command_of(self.track.poses, leg.first, leg.last, filmed=True)
        if self.style.autopilot == "px4":
            body = np.full(len(share), command.body_yaw)
            cam_yaw = np.full(len(share), command.cam_yaw)
        else:
            body = planned.body_yaw[0] + share * (planned.body_yaw[-1] - planned.body_yaw[0])
            cam_yaw = body + command.pan
        pitch = np.full(len(share), command.cam_pitch)
        region = region_of(self.style, self.track, slice(leg.first, leg.last + 1), leg.shot)
        if region is not None:
            if turns_body(self.drone):
                body = facing(flown, region)
            cam_yaw, pitch = follow(self.drone, flown, body, region)
        hfov = np.full(len(share), command.hfov) if self.style.zooms else planned.hfov
        return Poses(flown, body, cam_yaw, pitch, hfov)


def thinner_of(
    track: SampledFlight,
    drone: Drone,
    style: Style,
    obstacles: tuple[Obstacle, ...],
    focus: Focus | None = None,
) -> Thinner:
    """Return the thinner of one drone's track."""
    planned = tuple(shortfall(obstacle, track.poses.position) for obstacle in obstacles)
    return Thinner(track, drone, style, obstacles, planned, focus)


def along(points: Array, time: Array, *, rest: bool) -> Array:
    """Return the position along the straight leg of each planned point, from 0 to 1, shape (n,).

    points : (n, 3), metres
    time : (n,), seconds
    rest : whether the leg is a stay, whose position follows the time
    """
    chord = points[-1] - points[0]
    length2 = float(chord @ chord)
    if rest or length2 < SHORTEST_CHORD_M**2:
        return np.asarray((time - time[0]) / max(time[-1] - time[0], 1e-12))
    return np.asarray(np.clip((points - points[0]) @ chord / length2, 0.0, 1.0))
