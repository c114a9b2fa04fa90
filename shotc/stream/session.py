"""Goes from a plan and the addresses of its vehicles to a flight: opens links, reads, checks, and flies."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from math import ceil, degrees, dist
from typing import TYPE_CHECKING

import numpy as np

from shotc.diag.model import Diagnostic
from shotc.diag.registry import has_errors
from shotc.ir.mission import GeoOrigin, MissionIR
from shotc.ir.path import HFOV
from shotc.ir.sampling import SAME_TIME_S
from shotc.ir.source import TAKES
from shotc.ir.trajectory import DroneTrajectory, VerifiedIR
from shotc.stream import checks
from shotc.stream.aim import LiveAim
from shotc.stream.autopilots import AUTOPILOTS, Autopilot
from shotc.stream.beginning import clock_time
from shotc.stream.checks import Ready
from shotc.stream.clock import RATE_HZ, FlightClock
from shotc.stream.endpoint import Endpoint
from shotc.stream.feed import Feed
from shotc.stream.flight import FlightResult, PilotedDrone, StreamedFlight
from shotc.stream.pilot import Pilot, RecordingTick, preparing_from
from shotc.stream.reading import read
from shotc.stream.setpoints import SetpointSeries, course_of
from shotc.stream.vehicle import VehicleStatus

if TYPE_CHECKING:  # the sockets are passed in, and MAVLink with them
    from shotc.stream.link import VehicleLink

CUT_TICKS = RATE_HZ // 10
"""Ticks between the end of one recording and the start of the next."""
SILENT_TARGET_S = 5.0
SAME_HFOV_RAD = 1e-4


@dataclass(frozen=True, slots=True)
class Doors:
    """The functions that open sockets.

    link : opens the link to a vehicle
    feed : opens the feed of a target
    Both raise OSError if that fails.
    """

    link: Callable[[Endpoint, Autopilot], VehicleLink]
    feed: Callable[[str, Endpoint, GeoOrigin], Feed]


@dataclass(frozen=True, slots=True)
class Aboard:
    """One drone that has passed its checks: what was read from it, and what is sent to it."""

    ready: Ready
    track: DroneTrajectory
    course: SetpointSeries


class Session:
    """One run, to be used in a ``with`` block, which closes its sockets."""

    def __init__(
        self, plan: VerifiedIR, doors: Doors, clock: FlightClock, note: Callable[[str], None]
    ) -> None:
        """Prepare a run; note : receives what happens, line by line."""
        self._plan = plan
        self._doors = doors
        self._clock = clock
        self._note = note
        self._stack = ExitStack()
        self._feeds: list[Feed] = []
        self.vehicles: list[VehicleStatus] = []

    def __enter__(self) -> Session:
        """Return itself."""
        return self

    def __exit__(self, *_: object) -> None:
        """Close all sockets."""
        self._stack.close()

    @property
    def mission(self) -> MissionIR:
        """The mission that is flown."""
        return self._plan.trajectory.keyframes.mission

    def open(self, addresses: Mapping[str, Endpoint], targets: Mapping[str, Endpoint]) -> list[Diagnostic]:
        """Open a link for every drone and a feed for every target; return the errors.

        addresses : by drone name
        targets : by target name
        """
        faults = [*unplaced(self.mission, self._plan), *unheard(self.mission, addresses)]
        if has_errors(faults):
            return faults
        for name, endpoint in addresses.items():
            autopilot = AUTOPILOTS[self.mission.drone(name).autopilot]
            try:
                link = self._doors.link(endpoint, autopilot)
            except OSError as error:
                faults.append(_closed(f"drone `{name}`", endpoint, error, "--to"))
                continue
            self._stack.callback(link.close)
            self.vehicles.append(VehicleStatus(name, autopilot, link))
        return [*faults, *self._open_feeds(targets)]

    def _open_feeds(self, targets: Mapping[str, Endpoint]) -> Iterator[Diagnostic]:
        assert self.mission.origin is not None
        for name, endpoint in targets.items():
            try:
                feed = self._doors.feed(name, endpoint, self.mission.origin)
            except OSError as error:
                yield _closed(f"target `{name}`", endpoint, error, "--target")
                continue
            self._stack.callback(feed.close)
            self._feeds.append(feed)

    def check(self) -> tuple[list[Aboard], list[Diagnostic]]:
        """Read and check every vehicle; return those that may fly, and all diagnostics."""
        read(self.vehicles, self._clock, self._note)
        aboard: list[Aboard] = []
        diagnostics: list[Diagnostic] = []
        for vehicle in self.vehicles:
            who, faults = self._judge(vehicle)
            diagnostics += faults
            aboard += [who] if who is not None else []
        return aboard, [*diagnostics, *self._mute_targets()]

    def _judge(self, vehicle: VehicleStatus) -> tuple[Aboard | None, list[Diagnostic]]:
        origin = self.mission.origin
        assert origin is not None
        ready = Ready(self.mission, self.mission.drone(vehicle.drone), vehicle)
        diagnostics = checks.answered(ready)
        frame = checks.frame_of(ready, origin)
        if diagnostics or frame is None:
            return None, diagnostics
        track = next(t for t in self._plan.trajectory.drones if t.drone == vehicle.drone)
        course = course_of(track, origin, frame, vehicle.autopilot.lift)
        diagnostics = [*checks.ready_to_fly(ready, origin, course), *zoomed(self.mission, track)]
        diagnostics += filmed_instead(self.mission, track)
        return (None if has_errors(diagnostics) else Aboard(ready, track, course)), diagnostics

    def _mute_targets(self) -> Iterator[Diagnostic]:
        """Wait for the first position of every target."""
        end = self._clock.now() + SILENT_TARGET_S
        while any(feed.seen is None for feed in self._feeds) and self._clock.now() < end:
            now = self._clock.now()
            for feed in self._feeds:
                feed.listen(now)
            self._clock.wait_until(now + 1 / RATE_HZ)
        for feed in self._feeds:
            if feed.seen is None:
                notes: tuple[str, ...] = (f"{SILENT_TARGET_S:.0f} s were waited at {feed.endpoint}",)
                if feed.unread:
                    notes += (f"{feed.unread} datagrams came that hold no position",)
                yield Diagnostic(
                    "A013",
                    f"no position of the target `{feed.target}` is heard",
                    (self.mission.origins.value(("targets", feed.target)),),
                    notes,
                    "let its position be sent there, or leave --target away",
                )

    def too_soon(self, aboard: Sequence[Aboard], at: float) -> Iterator[Diagnostic]:
        """Yield the error of a beginning before which drones cannot get ready; at : POSIX seconds."""
        lead = max(-preparing_from(who.ready.vehicle, who.course) for who in aboard) / RATE_HZ
        left = at - self._clock.utc()
        if left < lead:
            yield Diagnostic(
                "A035",
                f"mission time 0 cannot be at {clock_time(at)}: drones get ready for {lead:.1f} s before it",
                notes=(f"after the checks {max(left, 0.0):.1f} s are left",),
                help="give a later time with --at; the checks take up to 20 s",
            )

    def fly(self, aboard: Sequence[Aboard], at: float | None = None) -> tuple[FlightResult, list[Pilot]]:
        """Arm and fly all drones on one clock; at : the time of day of mission time 0, POSIX seconds."""
        crew = [
            PilotedDrone(
                Pilot(who.ready.vehicle, who.course, cuts_of(who.track)),
                LiveAim(self.mission, who.track, who.course, tuple(self._feeds)),
            )
            for who in aboard
        ]
        flown = StreamedFlight(crew, self._feeds, self._clock, self._note, at).fly()
        return flown, [member.pilot for member in crew]


def cuts_of(track: DroneTrajectory) -> tuple[RecordingTick, ...]:
    """Return when a drone's camera starts and stops recording, in order of time."""
    cuts: list[RecordingTick] = []
    for phase in track.phases:
        if phase.shot is not None:
            begin = ceil(phase.start * RATE_HZ - 1e-9)
            if cuts:
                begin = max(begin, cuts[-1].tick + CUT_TICKS)
            cuts += [
                RecordingTick(begin, phase.shot, True),
                RecordingTick(max(begin + 1, ceil(phase.end * RATE_HZ - 1e-9)), phase.shot, False),
            ]
    return tuple(cuts)


def unplaced(mission: MissionIR, plan: VerifiedIR) -> Iterator[Diagnostic]:
    """Yield what prevents a plan from being streamed at all."""
    names = ", ".join(f"`{fleet.fleet}`" for fleet in plan.trajectory.fleets)
    if names and plan.trajectory.drones:
        yield Diagnostic(
            "A034",
            f"the cameras alone are streamed: the plan has the fleet {names}, too",
            (mission.origins.key(("fleets",)),),
            ("cameras stay out of the airspace of the show whenever either begins",),
            "give the show and `--at` the same time of day; its .skyc file has the same clock",
        )
    elif names:
        yield Diagnostic(
            "A030",
            f"a show is not streamed: the plan has the fleet {names}",
            (mission.origins.key(("fleets",)),),
            help="drones of shows fly .skyc files by themselves: `shotc emit PLAN --emit skyc`",
        )
    if mission.origin is None:
        yield Diagnostic(
            "A001",
            "the plan has no place on the globe",
            (mission.origins.key(("world",)),),
            ("a vehicle's local frame is tied to the plan's by latitude and longitude",),
            "give the mission `world.origin: {lat: .., lon: .., alt: ..}` and plan again",
        )


def unheard(mission: MissionIR, names: Iterable[str]) -> Iterator[Diagnostic]:
    """Yield an error for every drone whose autopilot accepts no setpoints."""
    for drone in map(mission.drone, names):
        if drone.autopilot not in AUTOPILOTS:
            yield Diagnostic(
                "A032",
                f"drone `{drone.name}` is flown by {drone.autopilot}, which takes no setpoints",
                (mission.origins.key(drone.path),),
                (f"setpoints are for {' and '.join(AUTOPILOTS)}; its model is `{drone.model}`",),
                f"fly its file: `shotc emit PLAN --emit {TAKES[drone.autopilot][0]}`",
            )


def zoomed(mission: MissionIR, track: DroneTrajectory) -> Iterator[Diagnostic]:
    """Yield a warning for every shot whose field of view changes."""
    for phase in track.phases:
        if phase.shot is not None:
            starts, ends = track.curve.breaks[:-1], track.curve.breaks[1:]
            inside = (starts < phase.end - SAME_TIME_S) & (ends > phase.start + SAME_TIME_S)
            hfov = track.curve.ctrl[inside][..., HFOV]
            if np.ptp(hfov) > SAME_HFOV_RAD:
                yield Diagnostic(
                    "A031",
                    f"the zoom of shot `{phase.shot}` is not sent",
                    (mission.origins.value(mission.shot(phase.shot).path),),
                    (f"its field of view is {degrees(hfov.min()):.0f} to {degrees(hfov.max()):.0f} degrees",),
                    "zoom by hand, or give the shot one `hfov`",
                )


def filmed_instead(mission: MissionIR, track: DroneTrajectory) -> Iterator[Diagnostic]:
    """Yield a warning for every shot that takes photos in the plan."""
    for phase in track.phases:
        if phase.shot is not None and mission.shot(phase.shot).photos is not None:
            shot = mission.shot(phase.shot)
            yield Diagnostic(
                "A033",
                f"shot `{shot.id}` is filmed, and takes no photos",
                (mission.origins.key((*shot.path, "photos")),),
                (f"asked are photos {shot.photos}",),
                "fly its mission file, or take the photos out of the film",
            )


def summary(who: Aboard) -> list[tuple[str, str]]:
    """Return what was read from a vehicle that may fly, as pairs of heading and text."""
    vehicle = who.ready.vehicle
    origin = who.ready.mission.origin
    assert origin is not None
    assert vehicle.heartbeat is not None
    distance = dist(checks.home_offset(who.ready, origin), (0.0, 0.0, 0.0))
    after = ", ".join(f"{name} {seconds:g} s" for name, seconds in checks.loss_times(vehicle).items())
    does = ", ".join(f"{action} ({name})" for name, action in checks.actions_of(vehicle).items())
    cuts = [cut for cut in cuts_of(who.track) if cut.on]
    return [
        ("vehicle", f"{vehicle.autopilot.name}, system {vehicle.heartbeat.system}"),
        ("home", f"{distance:.2f} m from its pad"),
        ("link lost", f"{does}; {after}"),
        (
            "setpoints",
            f"{who.course.last - who.course.first + 1} at {RATE_HZ} Hz, in {vehicle.autopilot.flown.name}",
        ),
        ("lifts off", f"{who.course.lifts / RATE_HZ:.1f} s"),
        ("records", ", ".join(f"{cut.shot} from {cut.tick / RATE_HZ:.1f} s" for cut in cuts) or "nothing"),
        ("back on its pad", f"{who.track.curve.end:.1f} s"),
    ]


def left_alone(vehicle: VehicleStatus) -> str:
    """Return what a vehicle in the air does after this program has ended, as the end of a sentence."""
    rule = vehicle.autopilot.alone
    action = checks.actions_of(vehicle).get(rule)
    return "" if action is None else f"; left alone it will {action} ({rule})"


def _closed(whose: str, endpoint: Endpoint, error: OSError, option: str) -> Diagnostic:
    reason = (error.strerror or str(error)).lower()
    return Diagnostic(
        "A002",
        f"the address {endpoint} of {whose} cannot be opened: {reason}",
        notes=("another program may listen there: a ground station, or this command in another window",),
        help=f"end it, or give another port with {option}",
    )
