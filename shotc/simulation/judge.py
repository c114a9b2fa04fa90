"""Judges the runs of a plan: what cameras saw, the drones' clearances, and their strays."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from itertools import combinations
from math import inf
from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.framing import Cameras, frames
from shotc.geom.sight import off_axis, outside
from shotc.ir.bodies import shapes
from shotc.ir.coverage import coverage
from shotc.ir.hidden import HALF_SHARE
from shotc.ir.mission import MissionIR
from shotc.ir.path import HFOV
from shotc.ir.sampling import beside_cameras, clock, framed, references, subjects
from shotc.ir.trajectory import DroneTrajectory, TrajectoryIR
from shotc.simulation.clearance import ClosestApproach, between, nearest
from shotc.simulation.deviations import Lag, LargestDeviation, lags, misled, unplaced
from shotc.simulation.flight import DroneRuns
from shotc.simulation.replans import Replans
from shotc.simulation.shows import FleetCourse, FleetPair, FleetRun
from shotc.simulation.way_back import ReturnLack
from shotc.simulation.world import World, at_times

IN_AIR_M = 0.5
"""Height above its pad at the end of its plan, above which a drone has not landed, metres."""

SIGHT_S = 0.2
"""Seconds between the samples at which occlusion is judged."""


NO_FLEETS = FleetRun((), ())


@dataclass(frozen=True, slots=True)
class TargetFraming:
    """A target in the frames of a shot, in one run.

    in_frame : share of frames with the whole target, 0 to 1
    error, usual, worst : screen error in half frames: mean, 95 % quantile and maximum; None if the shot has
        no reference, infinite behind the camera
    time : of the largest error, or of the largest cropping, seconds
    in_sight : share of samples at which at most half of its outline is hidden
    """

    shot: str
    drone: str
    target: str
    in_frame: float
    error: float | None
    usual: float | None
    worst: float | None
    time: float
    in_sight: float


@dataclass(frozen=True, slots=True)
class TrackingError:
    """A drone's deviation from its plan in one run.

    stray, farthest : distance from the planned position at the same time, metres: root mean square and
        maximum
    time : of the maximum, seconds
    speed : largest speed over ground, m/s
    roll : largest roll of its picture, rad
    spoiled : share of filming samples with another drone in its picture, or in the cone of the rules; 0
        without other drones
    misled : the largest stray that is mainly its receiver's error
    unplaced : the largest error of its own position while it has none by satellites
    straight : what its straight ways back after outages lack; None without them
    landed : horizontal distance from its pad at the end, metres; None if it is in the air then
    """

    drone: str
    stray: float
    farthest: float
    time: float
    speed: float
    roll: float
    near: tuple[ClosestApproach, ...]
    replans: Replans | None = None
    spoiled: float = 0.0
    misled: LargestDeviation = field(default_factory=LargestDeviation)
    unplaced: LargestDeviation = field(default_factory=LargestDeviation)
    straight: ReturnLack | None = None
    landed: float | None = None

    @property
    def nearest(self) -> ClosestApproach | None:
        """The least distance of its body from anything."""
        return min(self.near, key=lambda each: each.distance, default=None)


@dataclass(frozen=True, slots=True)
class Run:
    """One run.

    number : its number, from 0; the same number gives the same run in any block
    lags : of replanned shots
    """

    number: int
    pictures: tuple[TargetFraming, ...]
    courses: tuple[TrackingError, ...]
    fleets: tuple[FleetCourse, ...] = ()
    fleet_pairs: tuple[FleetPair, ...] = ()
    lags: tuple[Lag, ...] = ()

    @property
    def in_frame(self) -> float:
        """Least share of frames with the whole target, over the shots; 1 without shots."""
        return min((p.in_frame for p in self.pictures), default=1.0)

    @property
    def in_sight(self) -> float:
        """Least share of samples at which at most half of a target is hidden, over the shots; 1 without
        targets.
        """
        return min((p.in_sight for p in self.pictures), default=1.0)

    @property
    def error(self) -> float:
        """Largest mean screen error over the shots; 0 without references."""
        return max((p.error for p in self.pictures if p.error is not None), default=0.0)

    @property
    def clearance(self) -> float:
        """Least distance of a drone's body from anything, metres; infinite without obstacles."""
        near = [c.nearest.distance for c in self.courses if c.nearest is not None]
        fleets = [fleet.clearance for fleet in self.fleets]
        return min([*near, *fleets, *(pair.clearance for pair in self.fleet_pairs)], default=inf)

    @property
    def stray(self) -> float:
        """Largest stray of a drone, metres."""
        return max(
            [*(c.farthest for c in self.courses), *(f.flown.farthest for f in self.fleets)], default=0.0
        )

    @property
    def merit(self) -> tuple[float, float, float, float]:
        """Sort key from the worst run to the best: collision depth, share in frame, screen error, stray."""
        return (min(self.clearance, 0.0), self.in_frame, -self.error, -self.stray)


def judged(
    world: World, ir: TrajectoryIR, flown: tuple[DroneRuns, ...], fleets: tuple[FleetRun, ...] = ()
) -> tuple[Run, ...]:
    """Return the judged runs of a plan.

    flown : flights in the order of ``ir.drones``
    fleets : results of fleets in every run; empty without fleets
    """
    mission = world.mission
    ticks = clock(mission.rate, float(world.times[-1]))
    near = [nearest(world, f, t, ticks[ticks <= t.curve.end]) for f, t in zip(flown, ir.drones, strict=True)]
    for (i, one), (_, other) in combinations(enumerate(flown), 2):
        for r, each in enumerate(between(mission, one, other, ticks)):
            near[i][r] = (*near[i][r], each)
    filmed = [tuple(_filmed(mission, track)) for track in ir.drones]
    astray = [_strays(f, t) for f, t in zip(flown, ir.drones, strict=True)]
    led = [misled(world, t, f, a) for f, t, a in zip(flown, ir.drones, astray, strict=True)]
    blind = [unplaced(world, t, f) for f, t in zip(flown, ir.drones, strict=True)]
    behind = [lags(world, t, f) for f, t in zip(flown, ir.drones, strict=True)]
    return tuple(
        Run(
            number,
            tuple(
                _picture(world, track, flown[d], r, each)
                for d, track in enumerate(ir.drones)
                for each in filmed[d]
            ),
            tuple(
                replace(
                    _course(f, r, astray[d][:, r], near[d][r], _spoiled(world, ir.drones, flown, (d, r))),
                    landed=_landed(f, ir.drones[d], r),
                    misled=led[d][r],
                    unplaced=blind[d][r],
                )
                for d, f in enumerate(flown)
            ),
            *(fleets[r] if fleets else NO_FLEETS),
            tuple(lag for each in behind for lag in each[r]),
        )
        for r, number in enumerate(world.runs)
    )


def cameras_of(
    mission: MissionIR, track: DroneTrajectory, flown: DroneRuns, run: int, times: Array
) -> Cameras:
    """Return the cameras of a run at times (M,): as flown, with the plan's lens.

    run : index of the run
    """
    return Cameras(
        at_times(flown.position[:, run], flown.times, times),
        at_times(np.unwrap(flown.yaw[:, run]), flown.times, times),
        at_times(flown.pitch[:, run], flown.times, times),
        track.curve(times)[:, HFOV],
        mission.drone(track.drone).aspect,
    )


class _Filmed(NamedTuple):
    """A target of a shot at the frames in which it is framed.

    times : (M,), seconds
    reference : reference on screen, (M, 2); NaN where there is none
    """

    shot: str
    target: str
    times: Array
    reference: Array


def _filmed(mission: MissionIR, track: DroneTrajectory) -> Iterator[_Filmed]:
    for phase in track.phases:
        if phase.shot is None:
            continue
        ticks = clock(mission.rate, phase.end)
        ticks = ticks[ticks >= phase.start]
        for name in subjects(mission, track, phase.shot):
            times = ticks[framed(track, phase.shot, name, ticks)]
            if len(times):
                yield _Filmed(phase.shot, name, times, references(track, phase.shot, name, times))


def _picture(
    world: World, track: DroneTrajectory, flown: DroneRuns, run: int, filmed: _Filmed
) -> TargetFraming:
    shot, name, times, reference = filmed
    target = world.target(name, run, times)
    eyes = cameras_of(world.mission, track, flown, run, times)
    seen = frames(beside_cameras(eyes, target, times), target.centre, shapes(target, times))
    error = np.hypot(seen.u - reference[:, 0], seen.v - reference[:, 1])
    error = np.where(np.isnan(seen.u) & ~np.isnan(reference[:, 0]), np.inf, error)
    known = error[~np.isnan(error)]
    picture = TargetFraming(
        shot,
        track.drone,
        name,
        float(seen.in_frame.mean()),
        None,
        None,
        None,
        float(times[np.argmin(seen.margin)]),
        _in_sight(world, track, flown, (run, name), times),
    )
    if not len(known):
        return picture
    worst = int(np.nanargmax(error))
    return replace(
        picture,
        error=float(known.mean()),
        usual=float(np.quantile(known, 0.95, method="higher")),  # interpolation may give inf - inf
        worst=float(error[worst]),
        time=float(times[worst]),
    )


def _in_sight(
    world: World, track: DroneTrajectory, flown: DroneRuns, of: tuple[int, str], times: Array
) -> float:
    run, name = of
    at = np.arange(times[0], times[-1] + 1e-9, SIGHT_S)
    targets = tuple(world.target(target.name, run, at) for target in world.mission.targets)
    eyes = cameras_of(world.mission, track, flown, run, at).position
    share = coverage(world.mission._replace(targets=targets), (), name, eyes, at).share
    return float(np.mean(share <= HALF_SHARE))


def _strays(flown: DroneRuns, track: DroneTrajectory) -> Array:
    """Return the stray of a drone at its instants in each run, (F, R), metres."""
    plan = track.curve(flown.times)[:, None, :3]
    return np.asarray(np.linalg.norm(flown.position - plan, axis=2))


def _spoiled(
    world: World, tracks: tuple[DroneTrajectory, ...], flown: tuple[DroneRuns, ...], of: tuple[int, int]
) -> float:
    """Return the share of a drone's filming samples with another drone in the picture.

    of : index of the drone, and of the run
    """
    (d, run), mission = of, world.mission
    filmed = [np.arange(p.start, p.end, SIGHT_S) for p in tracks[d].phases if p.shot is not None]
    if len(flown) < 2 or not filmed:
        return 0.0
    times = np.concatenate(filmed)
    eyes = cameras_of(mission, tracks[d], flown[d], run, times)
    cone = mission.rules.half_angle
    seen = np.zeros(len(times), dtype=bool)
    for other in (each for i, each in enumerate(flown) if i != d):
        places = at_times(other.position[:, run], other.times, times)
        radius = mission.drone(other.drone).radius
        seen |= outside(eyes, places, radius) < 0.0 if cone is None else off_axis(eyes, places, radius) < cone
    return float(seen.mean())


def _landed(flown: DroneRuns, track: DroneTrajectory, run: int) -> float | None:
    """Return the horizontal distance from the end of the plan, metres; None above it."""
    off = flown.position[-1, run] - track.curve(track.curve.end)[:3]
    return None if off[2] > IN_AIR_M else float(np.linalg.norm(off[:2]))


def _course(
    flown: DroneRuns, run: int, off: Array, near: tuple[ClosestApproach, ...], spoiled: float
) -> TrackingError:
    """Return a drone's deviation from its plan.

    off : its stray at its instants, (F,), metres
    """
    k = int(np.argmax(off))
    speed = np.linalg.norm(flown.velocity[:, run], axis=1)
    return TrackingError(
        drone=flown.drone,
        stray=float(np.sqrt(np.mean(off**2))),
        farthest=float(off[k]),
        time=float(flown.times[k]),
        speed=float(speed.max()),
        roll=float(np.abs(flown.roll[:, run]).max()),
        near=near,
        replans=flown.replans[run] if flown.replans else None,
        spoiled=spoiled,
        straight=flown.straight[run] if flown.straight else None,
    )
