"""Makes files from a verified plan for machines that fly curves through waypoints without a clock.

A format defines how points are written and read, how many a file holds, and which curves its machines may
fly. Points are chosen under all flight models at once. The written files are read back and flown under each
model.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import pairwise, product

import numpy as np
from numpy.typing import NDArray

from shotc.diag.model import Diagnostic
from shotc.emit.base import Artifact, Emission
from shotc.emit.waypoints import report
from shotc.emit.waypoints.choose import Chooser, chooser_of
from shotc.emit.waypoints.clearance import Obstacle, bounds, nearer_between, owner_of, shortfall
from shotc.emit.waypoints.compare import Error, ShotError, compare
from shotc.emit.waypoints.geo import Geo, GeoPosition, tie
from shotc.emit.waypoints.link import link_notes, return_height
from shotc.emit.waypoints.models import TURNINGS, CurveModel, fly, legs_of
from shotc.emit.waypoints.route import PointAction, Route, Waypoint, route_of
from shotc.emit.waypoints.stations import Station
from shotc.emit.waypoints.timing import evenly, kept_apart_by_time
from shotc.emit.waypoints.track import SampledFlight, track_of
from shotc.geom.camera import heading_of
from shotc.geom.vec import wrapped
from shotc.ir.drone import Drone, LensRange
from shotc.ir.mission import MissionIR
from shotc.ir.photos import Photos
from shotc.ir.source import Autopilot
from shotc.ir.trajectory import DroneTrajectory, VerifiedIR

Array = NDArray[np.float64]

LEAST_CUT_M = 0.05  # metres by which a re-flight may come nearer to an obstacle than the plan
STRAIGHT_RAD = np.radians(
    0.05
)  # rad off a target that a camera looks straight at; files have tenths of a degree
SAME_PLACE_M = 0.1  # metres between points, below which some machines refuse them as equal
ASIDE_M = 0.15  # metres by which such a point is moved
FINE_SAMPLES = 160  # intervals of a leg at which clearances are judged, before they are proved in between
HIGHEST_RATE_HZ = 10.0  # Hz of the judged frames; the picture changes slowly


@dataclass(frozen=True, slots=True)
class FileFormat:
    """A file format of waypoint missions.

    emitter : name of its emitter
    machines : autopilots that take it
    most : most points of a file
    ending : end of the file's name
    shapes : curves that its machines may fly
    halts : whether the machines stop at points with actions
    zooms : machines whose zoom it commands
    says_link_lost : whether it states what is done on link loss
    photos : machines that take photos on its command
    farthest : greatest length of a file's path, metres
    """

    emitter: str
    machines: tuple[Autopilot, ...]
    most: int
    ending: str
    shapes: tuple[CurveModel, ...]
    write: Callable[[list[Waypoint], Drone], bytes]
    read: Callable[[bytes], list[Waypoint]]
    halts: bool = False
    zooms: tuple[Autopilot, ...] = ()
    says_link_lost: bool = False
    photos: tuple[Autopilot, ...] = ()
    farthest: float = np.inf

    def lens(self, drone: Drone) -> LensRange | None:
        """Return the lens that its files zoom; None if they do not zoom."""
        return drone.lens if drone.zooms and drone.autopilot in self.zooms else None


def emit_files(plan: VerifiedIR, form: FileFormat) -> Emission:
    """Return the files of all drones that fly a format, with warnings and the error that it adds."""
    ir = plan.trajectory
    mission = ir.keyframes.mission
    diagnostics = list(report.fleets_left_out(mission, ir.fleets, form.emitter))
    flights, notes, others = report.flown_here(mission, ir.drones, form.emitter, form.machines)
    diagnostics += others
    if not flights:
        return Emission((), tuple(diagnostics))
    if mission.origin is None:
        return Emission((), (*diagnostics, report.no_origin(mission, form.emitter)))
    jobs = [_Job.of(mission, flight, form) for flight in flights]
    written = [job.written() for job in jobs]
    courses = {f.drone: w.ways for f, w in zip(flights, written, strict=True)}
    meeting = kept_apart_by_time(mission, courses, [f for f in ir.drones if f.drone not in courses])
    diagnostics += [report.apart_by_timing(mission, each, courses) for each in meeting]
    refused = {name for each in meeting for name in each.names}
    emissions = [job.emission(each) for job, each in zip(jobs, written, strict=True)]
    accepted = [e for f, e in zip(flights, emissions, strict=True) if f.drone not in refused]
    return Emission(
        tuple(a for e in accepted for a in e.artifacts),
        (*diagnostics, *(d for e in accepted for d in e.diagnostics)),
        (*notes, *(n for e in accepted for n in e.notes)),
    )


@dataclass(frozen=True, slots=True, eq=False)
class _WrittenFiles:
    """The files of a drone, the route read back from them, and samples of its legs for each curve model.

    photographed : shots of which the files take photos
    """

    artifacts: tuple[Artifact, ...]
    route: Route
    legs: tuple[Array, ...]
    photographed: frozenset[str]

    @property
    def ways(self) -> Array:
        """Positions along all paths that the drone may take, (n, 3), metres."""
        return np.concatenate([evenly(legs.reshape(-1, 3)) for legs in self.legs])


@dataclass(frozen=True, slots=True, eq=False)
class _Job:
    """The emission for one drone."""

    mission: MissionIR
    flight: DroneTrajectory
    drone: Drone
    form: FileFormat
    geo: Geo
    track: SampledFlight
    chooser: Chooser
    obstacles: tuple[Obstacle, ...]

    @staticmethod
    def of(mission: MissionIR, flight: DroneTrajectory, form: FileFormat) -> _Job:
        assert mission.origin is not None
        drone = mission.drone(flight.drone)
        track, obstacles = track_of(mission, flight), bounds(mission, drone)
        chooser = chooser_of(track, drone, obstacles, form.shapes, halts=form.halts, lens=form.lens(drone))
        if drone.autopilot in form.photos:
            chooser = replace(chooser, photos=_photos(mission, track))
        return _Job(mission, flight, drone, form, tie(mission.origin, drone.home), track, chooser, obstacles)

    def written(self) -> _WrittenFiles:
        """Return the files: points are chosen, written and read back."""
        stations = self.chooser.stations()
        points = waypoints_of(_parted(self.chooser.route(stations)), self.geo)
        watched = self._watched(stations)
        points = _two([replace(p, watched=at) for p, at in zip(points, watched, strict=True)])
        position = np.array([self.geo.point(p.place) for p in points])
        blocks = split(points, np.linalg.norm(np.diff(position, axis=0), axis=1), self.form)
        if len(blocks) > 1 and self.chooser.photos:
            # An action that begins in one file does not continue in the next.
            return replace(self, chooser=replace(self.chooser, photos={})).written()
        named = [f"-{i + 1}" for i in range(len(blocks))] if len(blocks) > 1 else [""]
        artifacts = tuple(
            Artifact(f"{self.drone.name}{number}{self.form.ending}", self.form.write(block, self.drone))
            for number, block in zip(named, blocks, strict=True)
        )
        route = route_of(joined([self.form.read(a.data) for a in artifacts]), self.geo)
        legs = tuple(s.samples(route, FINE_SAMPLES) for s in self.form.shapes)
        return _WrittenFiles(artifacts, route, legs, frozenset(self.chooser.photos))

    def _watched(self, stations: list[Station]) -> list[GeoPosition | None]:
        """Return for each station the standing target that the camera looks straight at during the whole
        shot, or None.
        """
        places: list[GeoPosition | None] = [None] * len(stations)
        for each in (s for s in self.track.stretches if s.shot is not None):
            inside = [i for i, s in enumerate(stations) if each.first <= s.first and s.last <= each.last]
            target, at = self.track.subject[each.first : each.last + 1], [stations[i].first for i in inside]
            east, north, _ = (target[0] - self.track.poses.position[at]).T
            off = wrapped(np.arctan2(north, east) - self.track.poses.cam_yaw[at])
            if np.ptp(target, axis=0).max() < SAME_PLACE_M and np.abs(off).max(initial=0.0) < STRAIGHT_RAD:
                place = self.geo.places(target[:1])[0]
                for i in inside:
                    places[i] = place
        return places

    def emission(self, written: _WrittenFiles) -> Emission:
        """Return the files with notes and warnings; no files if they come too near to an obstacle."""
        not_carried = report.zoom_not_carried(self.mission, self.flight) if self.chooser.lens is None else []
        faults = [*self._broken(written), *(d for d in not_carried if d.code == report.PROMISED)]
        if faults:
            return Emission((), tuple(faults))
        error = self._error(written.route)
        diagnostics = [
            *not_carried,
            *report.filmed_instead(self.mission, self.flight, self.form.emitter, written.photographed),
            *report.off_plan(self.mission, self.flight, self.track, error),
            *report.without_clock(self.mission, self.flight, self.track, error),
        ]
        files = [a.name for a in written.artifacts]
        notes = report.notes_on_files(self.drone, files, len(written.route.position), error, self._models)
        safety = self.drone.safety
        if safety is not None and safety.rally:
            diagnostics.append(report.no_rally(self.mission, self.drone, self.form.emitter))
        highest = float(written.route.position[:, 2].max()) - self.drone.home[2]
        link = link_notes(self.drone, return_height(highest, safety), written=self.form.says_link_lost)
        return Emission(
            written.artifacts, tuple(diagnostics), (*notes, *report.set_by_hand(self.drone), *link)
        )

    @property
    def _models(self) -> int:
        return len(self.form.shapes) * len(TURNINGS)

    def _error(self, route: Route) -> Error:
        """Return the largest error that a file adds under any flight model."""
        errors: list[Error] = []
        for shape, turning in product(self.form.shapes, TURNINGS):
            flown = fly(route, legs_of(route, shape), turning, self.chooser.lens)
            errors.append(compare(self.mission, self.flight, flown, HIGHEST_RATE_HZ))
        shots = tuple(_worst_shot([e.shots[i] for e in errors]) for i in range(len(errors[0].shots)))
        worst = max(errors, key=lambda e: e.screen)
        return replace(
            worst,
            position=max(e.position for e in errors),
            heading=max(e.heading for e in errors),
            filmed=max(e.filmed for e in errors),
            shots=shots,
        )

    def _broken(self, written: _WrittenFiles) -> list[Diagnostic]:
        """Return a fault for each obstacle that a re-flight comes nearer to than the plan, under the worst
        curve.
        """
        faults: list[Diagnostic] = []
        for obstacle, planned in zip(self.obstacles, self.chooser.planned, strict=True):
            held = max(float(planned.max()), 0.0)
            places = [legs.reshape(-1, 3) for legs in written.legs]
            depths = [shortfall(obstacle, each) - held for each in places]
            worst = max(range(len(depths)), key=lambda k: float(depths[k].max()))
            deepest = int(depths[worst].argmax())
            place, depth = places[worst][deepest], float(depths[worst][deepest])
            if depth <= LEAST_CUT_M:
                between = self._between(written.route, obstacle, held + LEAST_CUT_M)
                if between is None:
                    continue
                place, depth = between[0], between[1] - held
            distances = np.linalg.norm(self.track.poses.position - place, axis=1)
            time = float(self.track.time[int(distances.argmin())])
            owner = owner_of(obstacle, place)
            faults.append(report.near_obstacle(self.mission, self.drone, owner, depth, time))
        return faults

    def _between(self, route: Route, obstacle: Obstacle, allowed: float) -> tuple[Array, float] | None:
        """Return a violation between samples under any of the curves; None if it is proved that there is
        none.
        """
        nearer = (nearer_between(obstacle, shape.cubics(route), allowed) for shape in self.form.shapes)
        return next((each for each in nearer if each is not None), None)


def _photos(mission: MissionIR, track: SampledFlight) -> dict[str, Photos]:
    """Return the photo settings of shots during which the drone always moves and that no other shot adjoins.

    Formats state photo intervals for legs, so a drone that stands would take none.
    """
    by_station: dict[str, Photos] = {}
    for name in dict.fromkeys(s.shot for s in track.stretches if s.shot is not None):
        photos = mission.shot(name).photos
        numbers = [i for i, s in enumerate(track.stretches) if s.shot == name]
        around = [i for i in (numbers[0] - 1, numbers[-1] + 1) if 0 <= i < len(track.stretches)]
        beside = [track.stretches[i].shot for i in around]
        rests = any(track.stretches[i].rest for i in numbers)
        if photos is not None and not rests and not any(beside):
            by_station[name] = photos
    return by_station


def _worst_shot(errors: list[ShotError]) -> ShotError:
    worst = max(errors, key=lambda e: e.worst)
    return replace(
        worst,
        mean=max(e.mean for e in errors),
        lag=max(e.lag for e in errors),
        drift=max(e.drift for e in errors),
        edge=max(e.edge for e in errors),
    )


def _parted(route: Route) -> Route:
    """Move points that coincide with an earlier point towards their predecessor.

    An orbit that ends where it began has such points, and so has a flight that ends above its pad.
    """
    position = route.position.copy()
    for i in range(1, len(position)):
        step = position[i - 1] - position[i]
        if np.linalg.norm(position[:i] - position[i], axis=1).min() < SAME_PLACE_M:
            position[i] += ASIDE_M * step / max(float(np.linalg.norm(step)), ASIDE_M)
    return replace(route, position=position)


def _two(points: list[Waypoint]) -> list[Waypoint]:
    """Return at least two points, as every format demands; the added one is half-way down to the pad."""
    if len(points) > 1:
        return points
    place = replace(points[0].place, alt=points[0].place.alt / 2)
    return [points[0], replace(points[0], place=place, actions=())]


def waypoints_of(route: Route, geo: Geo) -> list[Waypoint]:
    """Return a route in the form of files."""
    return [
        Waypoint(
            place,
            float(np.degrees(wrapped(heading_of(float(route.yaw[i]))))),
            float(np.degrees(route.pitch[i])),
            float(route.speed[i]),
            bool(route.stops[i]),
            route.actions[i],
            float(route.curve[i]),
        )
        for i, place in enumerate(geo.places(route.position))
    ]


def split(points: list[Waypoint], legs: Array, form: FileFormat) -> list[list[Waypoint]]:
    """Return blocks that fit into files; each begins where the one before ends, preferably at a stop.

    legs : metres from each point to the next, (n - 1,)
    """
    blocks: list[list[Waypoint]] = []
    while (fit := _fitting(legs, form)) < len(points):
        stops = [i for i in range(fit // 2, fit) if points[i].stops]
        at = max(1, stops[-1] if stops else fit - 1)
        actions = points[at].actions
        first = next((k for k, a in enumerate(actions) if a.kind == "start"), len(actions))
        end = replace(points[at], stops=True, actions=actions[:first])
        blocks.append([*points[:at], end])
        points = [replace(points[at], stops=True, actions=actions[first:]), *points[at + 1 :]]
        legs = legs[at:]
    return [*blocks, points]


def _fitting(legs: Array, form: FileFormat) -> int:
    """Return how many of the points joined by legs (n - 1,), metres, fit into a file; at least two."""
    return max(2, min(form.most, 1 + int((np.cumsum(legs) <= form.farthest).sum())))


def joined(blocks: list[list[Waypoint]]) -> list[Waypoint]:
    """Return the points of all blocks, without the repeated ends."""
    points = list(blocks[0])
    for before, block in pairwise(blocks):
        actions: tuple[PointAction, ...] = (*before[-1].actions, *block[0].actions)
        points[-1] = replace(block[0], actions=actions)
        points += block[1:]
    return points
