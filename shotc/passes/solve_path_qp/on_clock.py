"""The legs of a drone that films something on its own clock: each shot is planned for when it is flown.

A shot of a moving target has to know its first frame's time before it can be planned, so the legs before
it are timed here as the time pass will time them.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import partial
from itertools import pairwise

from shotc.geom.bernstein import Piecewise
from shotc.ir.keyframes import PlacedShot
from shotc.ir.mission import Drone, MissionIR
from shotc.ir.origin import KeyPath
from shotc.ir.path import BODY_YAW, CAM_YAW, Deviation, Leg, TimedLeg, TimedPath
from shotc.ir.trajectory import DroneTrajectory
from shotc.passes.parameterize_time.estimate import leg_time
from shotc.passes.solve_path_qp.departure import Then, Way, choose
from shotc.passes.solve_path_qp.legs import (
    Flight,
    Pose,
    end_of,
    shot_leg,
    take_off,
    turned,
    turns_to,
    way_home,
    way_to,
)
from shotc.passes.solve_path_qp.shots import Failure, ShotCurve
from shotc.passes.timed_route.aims import Looker
from shotc.passes.timed_route.clock import lead_in
from shotc.passes.timed_route.flights import flight
from shotc.passes.timed_route.shot import Around, NoMotion, TimedShot, timed_shot

TRIES = 6
SPARE = 0.2  # seconds by which a drone is early where the mission does not fix the start
LATER = (2.0, 5.0, 10.0)  # seconds that such a shot may begin later where something is met on the way to it


@dataclass(frozen=True, slots=True)
class OutsideTrack:
    """A shot that cannot be filmed while its target's track lasts: when it would begin, seconds."""

    target: str
    start: float


Trouble = Failure | NoMotion | OutsideTrack


@dataclass(frozen=True, slots=True, eq=False)
class _Reached:
    """A planned shot, the way to it, and by how many seconds the drone is late there."""

    shot: TimedShot
    way: Way
    late: float


@dataclass(slots=True)
class Flown:
    """The legs of one drone while they grow, and the clock at their end.

    ends : of the shots of drones planned before, by id; this drone's are added
    """

    mission: MissionIR
    flight: Flight
    around: Around
    ends: dict[str, float]
    legs: list[Leg | TimedLeg] = field(default_factory=list)
    clock: float = 0.0
    deviations: list[Deviation] = field(default_factory=list)
    stats: list[tuple[str, float | str]] = field(default_factory=list)

    @property
    def drone(self) -> Drone:
        """Who flies."""
        return self.flight.drone

    def film(self, shot: ShotCurve | PlacedShot) -> Trouble | None:
        """Add a shot and the way to it."""
        return self._path(shot) if isinstance(shot, ShotCurve) else self._timed(shot)

    def home(self) -> Failure | None:
        """Add the way home."""
        pose = end_of(self.legs)
        span = (self.clock, None)
        way = choose(self.mission, self.drone, self.around, partial(self._back, pose), span)
        if way is None:
            back = way_home(self.flight, pose)
            assert not isinstance(back, list)
            return back
        self._take(way)
        return None

    def track(self) -> DroneTrajectory:
        """Return the drone's flight as far as it is planned, as the time pass will fly it."""
        return flight(self.mission, TimedPath(self.drone.name, tuple(self.legs)), dict(self.ends))

    def _back(self, pose: Pose, lift: float) -> list[Leg] | None:
        """Return the way home, first straight up by so many metres."""
        top = _at(pose, pose[2] + lift)
        up = self._through([pose, top], self.drone.path) if lift else []
        back = way_home(self.flight, top)
        return [*up, *back] if up is not None and isinstance(back, list) else None

    def _through(self, stops: list[Pose], path: KeyPath) -> list[Leg] | None:
        """Return the legs from each of some poses to the next."""
        legs: list[Leg] = []
        for a, b in pairwise(stops):
            way = way_to(self.flight, a, b, path)
            if not isinstance(way, list):
                return None
            legs += way
        return legs

    def _path(self, shot: ShotCurve) -> Trouble | None:
        timing = shot.shot.shot.timing
        ready = max(timing.start or 0.0, self.ends.get(timing.after or "", 0.0))
        way = self._way(shot.pose, shot, timing.start, ready)
        if not isinstance(way, Way):
            return way
        pose = end_of(way.legs) if way.legs else end_of(self.legs)
        placed = turned(self.drone, shot, pose)
        self._take(way)
        leg = shot_leg(placed)
        self.clock = max(self.clock, ready)
        self.legs.append(leg)
        self.clock += leg_time(self.mission, self.drone, leg)
        self.ends[shot.shot.shot.id] = self.clock
        return None

    def _way(
        self, goal: Pose, shot: ShotCurve | PlacedShot, due: float | None, ready: float = 0.0
    ) -> Way | Failure:
        """Return the unfilmed legs from here, or from the pad, to a shot's first pose.

        due : when the drone has to be there, if it has to; ready : when a shot on a path may begin
        """
        lift = [] if self.legs else [take_off(self.flight, goal)]
        pose = end_of(lift or self.legs)
        path = (shot.shot.shot if isinstance(shot, ShotCurve) else shot.shot).path
        near, then = _near(goal, pose), None
        if isinstance(shot, ShotCurve):
            placed = turned(self.drone, shot, pose)
            near, then = placed.pose, Then(shot_leg(placed), ready)
        direct = way_to(self.flight, pose, near, path)
        if not isinstance(direct, list):
            return direct

        def over(metres: float) -> list[Leg] | None:
            if not metres:
                return [*lift, *direct]
            high = max(pose[2], near[2]) + metres
            # Straight up from a pad there is the take-off already.
            stops = [pose, *([] if lift else [_at(pose, high)]), _at(near, high), near]
            found = self._through(stops, path)
            return None if found is None else [*lift, *found]

        found = choose(self.mission, self.drone, self.around, over, (self.clock, due), then)
        assert found is not None
        return found

    def _timed(self, placed: PlacedShot) -> Trouble | None:
        shot = placed.shot
        fixed = shot.timing.start
        start = fixed
        if start is None:
            ready = self.ends.get(shot.timing.after or "", 0.0)
            start = max(
                ready, self.clock + lead_in(self.mission, self.drone, shot, self.clock), self._since(placed)
            )
        reached = self._reached(placed, start)
        for _ in range(TRIES):
            if fixed is not None or not isinstance(reached, _Reached) or reached.late <= 0.0:
                break
            start += reached.late + SPARE
            reached = self._reached(placed, start)
        if not isinstance(reached, _Reached):
            return reached
        if fixed is None and not reached.way.clear:
            reached = self._later(placed, start) or reached
        self._take(reached.way)
        leg = _shifted(reached.shot.leg, turns_to(reached.shot.leg.pose, end_of(self.legs)))
        self.legs.append(leg)
        self.clock = float(leg.curve.end)
        self.ends[shot.id] = leg.end
        self.deviations += reached.shot.deviations
        self.stats += reached.shot.stats
        return None

    def _later(self, placed: PlacedShot, start: float) -> _Reached | None:
        """Return the first of some later starts to which there is a way on which nothing is met."""
        for more in LATER:
            reached = self._reached(placed, start + more)
            if isinstance(reached, _Reached) and reached.late <= 0.0 and reached.way.clear:
                return reached
        return None

    def _reached(self, placed: PlacedShot, start: float) -> _Reached | Trouble:
        """Plan a shot for a start, and the way to it."""
        outside = self._outside(placed, start)
        if outside is not None:
            return outside
        looker = Looker(self.mission, self.drone, placed.subjects)
        made = timed_shot(looker, self.flight.room, self.around, placed, start)
        if isinstance(made, NoMotion):
            return made
        begins = float(made.leg.curve.start)
        way = self._way(made.leg.pose, placed, begins)
        return _Reached(made, way, way.end - begins) if isinstance(way, Way) else way

    def _since(self, placed: PlacedShot) -> float:
        tracks = (self.mission.target(s.target).track for s in placed.subjects)
        return max((track.since for track in tracks if track is not None), default=0.0)

    def _outside(self, placed: PlacedShot, start: float) -> OutsideTrack | None:
        end = start + (placed.shot.timing.duration or 0.0)
        for subject in placed.subjects:
            track = self.mission.target(subject.target).track
            if track is not None and end > track.until + 1e-6:
                return OutsideTrack(subject.target, start)
        return None

    def _take(self, way: Way) -> None:
        self.legs += way.legs
        self.clock = way.end


def _at(pose: Pose, height: float) -> Pose:
    """Return a pose moved straight up or down to a height."""
    return (*pose[:2], height, *pose[3:])


def _near(goal: Pose, pose: Pose) -> Pose:
    shift, near = turns_to(goal, pose), list(goal)
    near[CAM_YAW] += shift
    near[BODY_YAW] += shift
    return tuple(near)


def _shifted(leg: TimedLeg, turns: float) -> TimedLeg:
    ctrl = leg.curve.ctrl.copy()
    ctrl[:, :, CAM_YAW] += turns
    ctrl[:, :, BODY_YAW] += turns
    return TimedLeg(leg.shot, Piecewise(leg.curve.breaks, ctrl), leg.start, leg.end, leg.framing, leg.path)
