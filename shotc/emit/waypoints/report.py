"""Notes and warnings of the waypoint emitters: what a format cannot carry, why no file is
written, its error.
"""

from __future__ import annotations

from collections.abc import Collection
from math import degrees
from typing import NamedTuple

import numpy as np

from shotc.diag.model import Diagnostic
from shotc.emit.base import without_origin
from shotc.emit.waypoints.choose import MEAN_HALF_FRAMES, WORST_HALF_FRAMES
from shotc.emit.waypoints.compare import Error, ShotError
from shotc.emit.waypoints.lens import edge
from shotc.emit.waypoints.stations import SHORTEST_LEG_M
from shotc.emit.waypoints.timing import WaysTooNear, too_near
from shotc.emit.waypoints.track import SampledFlight
from shotc.ir.drone import Drone
from shotc.ir.fleet import FleetTrajectory
from shotc.ir.mission import MissionIR, Shot
from shotc.ir.owners import Owner
from shotc.ir.path import HFOV
from shotc.ir.source import TAKES, ZOOM_COMMANDS, Autopilot
from shotc.ir.trajectory import DroneTrajectory
from shotc.rounding import at_least, exposure, nearer_than

LEAST_ZOOM_RAD = np.radians(0.1)
PROMISED = "E122"  # for a zoom that is not carried although the shot promises its framing
UNKNOWN_LENS = (
    "say what the camera carries, as `camera: {zoom: [24 mm, 70 mm]}`, or film the shot with the field of"
    " view of the drone"
)
OTHER_LENS = "film the shot with the field of view of the drone, or zoom by hand"
UNPROMISED = ", and remove its `require`: no file can promise a zoom by hand"
LEAST_TURN_RAD = np.radians(1.0)  # turn of the camera while the drone stands, above which it is mentioned
FILES = {"mavlink": "MAVLink", "dji": "DJI", "litchi": "Litchi"}
"""Names of the emitters' files."""


def no_origin(mission: MissionIR, emitter: str) -> Diagnostic:
    """Return the warning that the mission has no origin, so that there are no files."""
    what, why = f"the {FILES[emitter]} files are", "waypoints are latitudes and longitudes"
    return without_origin(mission, emitter, "E101", what, why)


def fleets_left_out(
    mission: MissionIR, fleets: tuple[FleetTrajectory, ...], emitter: str
) -> tuple[Diagnostic, ...]:
    """Return one warning that fleets get no mission files; none without fleets or if they get show files."""
    if not fleets or "skyc" in mission.emit:
        return ()
    names = ", ".join(f"`{track.fleet}` ({len(track.coef)} drones)" for track in fleets)
    return (
        Diagnostic(
            "E110",
            f"no {FILES[emitter]} mission is written for fleet {names}",
            tuple(mission.origins.key(mission.fleet(track.fleet).path) for track in fleets),
            ("a mission file has no common clock: drones that follow theirs would meet",),
            "ask for `skyc` in `output.emit`, the format of shows; `trajectory.csv` has every drone",
        ),
    )


class FlownHere(NamedTuple):
    """The flights of machines that take some files, and notes and diagnostics on the others."""

    flights: list[DroneTrajectory]
    notes: list[str]
    diagnostics: list[Diagnostic]


def flown_here(
    mission: MissionIR, flights: tuple[DroneTrajectory, ...], emitter: str, machines: tuple[Autopilot, ...]
) -> FlownHere:
    """Return the flights of machines that take these files, with notes and warnings on the others.

    There is a note if some of the mission's drones take them, and a warning for each drone if none does.
    """
    here = [f for f in flights if mission.drone(f.drone).autopilot in machines]
    others = [mission.drone(f.drone) for f in flights if mission.drone(f.drone).autopilot not in machines]
    if here:
        named = ", ".join(f"{drone.name} ({drone.autopilot})" for drone in others)
        return FlownHere(here, [f"{emitter}: no file for {named}, flown otherwise"] if others else [], [])
    return FlownHere([], [], [_not_flown(mission, drone, emitter, machines) for drone in others])


def _not_flown(mission: MissionIR, drone: Drone, emitter: str, machines: tuple[Autopilot, ...]) -> Diagnostic:
    fit = " or ".join(f"`{name}`" for name in TAKES[drone.autopilot])
    return Diagnostic(
        "E116",
        f"no {FILES[emitter]} file is written for {drone.name}, which is flown by {drone.autopilot}",
        (mission.origins.key(drone.path),),
        (f"{FILES[emitter]} files are flown by {' and '.join(machines)}; its model is `{drone.model}`",),
        f"ask for {fit} in `output.emit`, or plan with `--autopilot {machines[0]}`",
    )


def without_waypoints(mission: MissionIR, flights: tuple[DroneTrajectory, ...]) -> tuple[Diagnostic, ...]:
    """Return the warnings on drones that cannot fly waypoints by themselves, so that an app steers them."""
    drones = [mission.drone(f.drone) for f in flights]
    return tuple(
        Diagnostic(
            "E121",
            f"{drone.name} is a `{drone.model}`, which flies no waypoints by itself",
            (mission.origins.key(drone.path),),
            ("Litchi Pilot (a beta, for Android) steers it from this file, over its controller",),
            "try it in a wide place first, or film with a model that has waypoints, as `mini-4-pro`",
        )
        for drone in drones
        if drone.autopilot == "litchi"
    )


def zoom_not_carried(mission: MissionIR, flight: DroneTrajectory) -> list[Diagnostic]:
    """Return warnings on shots whose field of view a file without zoom does not carry.

    The warning becomes an error, and no file is written, if the shot promises its framing and the picture's
    edge shifts by more than files may add.
    """
    drone = mission.drone(flight.drone)
    out: list[Diagnostic] = []
    for phase in (p for p in flight.phases if p.shot is not None):
        hfov = flight.curve(np.linspace(phase.start, phase.end, 101))[:, HFOV]
        if np.abs(hfov - drone.hfov).max() < LEAST_ZOOM_RAD:
            continue
        shot = mission.shot(phase.shot or "")
        off = float(edge(hfov, drone.hfov).max())
        low, high = degrees(hfov.min()), degrees(hfov.max())
        angles = f"from {low:.1f} deg to {high:.1f} deg" if high - low > 0.1 else f"{high:.1f} deg"
        unknown = drone.lens is None and drone.autopilot in ZOOM_COMMANDS
        code, words = "E105", f"the mission file of {flight.drone} does not carry the zoom of shot {shot.id}"
        promised = off > WORST_HALF_FRAMES and _promises(shot)
        if promised:
            code = PROMISED
            words = f"no file is written for {flight.drone}: it would not carry the zoom of shot {shot.id}"
        out.append(
            Diagnostic(
                code,
                words,
                (mission.origins.key(shot.path),),
                (
                    f"the field of view is {angles}, the lens has {degrees(drone.hfov):.1f} deg: the edge of"
                    f" the picture is up to {at_least(off, 3)} half frames off",
                    *(["the shot promises its framing with `require`"] if promised else []),
                ),
                UNKNOWN_LENS if unknown else OTHER_LENS + (UNPROMISED if promised else ""),
            )
        )
    return out


def _promises(shot: Shot) -> bool:
    promise = shot.promise
    return any(each is not None for each in (promise.in_frame, promise.screen_error, promise.size))


def off_plan(
    mission: MissionIR, flight: DroneTrajectory, track: SampledFlight, error: Error
) -> list[Diagnostic]:
    """Return warnings on shots that a file shows differently from the plan, with the reason."""
    out: list[Diagnostic] = []
    for each in error.shots:
        if max(each.worst, each.edge) <= WORST_HALF_FRAMES and each.mean <= MEAN_HALF_FRAMES:
            continue
        shot = mission.shot(each.shot)
        reason, help_ = _reason(track, each)
        out.append(
            Diagnostic(
                "E117",
                f"the file of {flight.drone} shows shot {shot.id} up to"
                f" {at_least(max(each.worst, each.edge), 3)} half frames beside the plan",
                (mission.origins.key(shot.path),),
                (
                    f"worst at t = {each.time:.1f} s, {at_least(each.mean, 3)} on average; the aim is at most"
                    f" {WORST_HALF_FRAMES} and {MEAN_HALF_FRAMES} under every flight model",
                    reason,
                ),
                help_,
            )
        )
    return out


def _reason(track: SampledFlight, each: ShotError) -> tuple[str, str]:
    """Return the reason for a shot's difference from the plan, and a remedy."""
    for stretch in track.stretches:
        part = slice(stretch.first, stretch.last + 1)
        turn = max(np.ptp(track.poses.cam_yaw[part]), np.ptp(track.poses.cam_pitch[part]))
        if stretch.shot == each.shot and stretch.rest and turn > LEAST_TURN_RAD:
            return (
                f"its camera turns by {degrees(turn):.0f} deg while the drone stands, and such a file turns"
                " it on the way to the next point alone",
                "let the drone move while the camera turns, or turn it by hand",
            )
    return (
        f"its points are as near as {SHORTEST_LEG_M} m, nearer ones are refused",
        "film from farther away, or turn more slowly for the way that is flown",
    )


def without_clock(
    mission: MissionIR, flight: DroneTrajectory, track: SampledFlight, error: Error
) -> list[Diagnostic]:
    """Return warnings on the motion of moving targets during the lag of a file without clock."""
    out: list[Diagnostic] = []
    for each in error.shots:
        names = dict.fromkeys(r.target for r in flight.framing if r.shot == each.shot)
        moving = [name for name in names if mission.target(name).track is not None]
        if not moving:
            continue
        shot = mission.shot(each.shot)
        near = [name for name in moving if too_near(mission, flight, track.poses.position, name) > 0]
        crossed = [f"timing alone keeps the drone clear of `{name}`, whose way it crosses" for name in near]
        out.append(
            Diagnostic(
                "E118",
                f"the file of {flight.drone} has no clock, and the target of shot {shot.id} moves",
                (mission.origins.key(shot.path),),
                (
                    f"the machine is up to {at_least(each.lag, 1)} s off the plan's time within the shot;"
                    f" meanwhile `{moving[0]}` goes up to {at_least(each.drift, 1)} m",
                    "a late start adds the way that the target makes meanwhile",
                    *crossed,
                ),
                "start it by eye, frame more loosely, or fly the plan itself with `shotc stream` on a machine"
                " that takes it",
            )
        )
    return out


def near_obstacle(mission: MissionIR, drone: Drone, owner: Owner, depth: float, time: float) -> Diagnostic:
    """Return the error that a file comes too near to an obstacle, so that it is not written."""
    return Diagnostic(
        "E119",
        f"no file is written for {drone.name}: its curve comes {at_least(depth)} m too near to {owner.words}",
        (mission.origins.key(drone.path), mission.origins.key(owner.path)),
        (
            f"the plan keeps off it; the curve that is worst for it does not, at about t = {time:.1f} s",
            f"points cannot be nearer to each other than {SHORTEST_LEG_M} m",
        ),
        f"leave {at_least(depth, 1)} m more room there, or let the way bend less",
    )


def apart_by_timing(mission: MissionIR, meeting: WaysTooNear, flown: Collection[str]) -> Diagnostic:
    """Return the error that only timing keeps two drones apart, so that they get no files.

    flown : drones of these files, at least one of the two
    """
    refused = " and ".join(name for name in meeting.names if name in flown)
    return Diagnostic(
        "E120",
        f"no file is written for {refused}: timing alone keeps {' and '.join(meeting.names)} apart",
        tuple(mission.origins.key(mission.drone(name).path) for name in meeting.names),
        (
            f"their ways come within {nearer_than(meeting.distance, mission.rules.separation)} m of each"
            f" other, the separation is {mission.rules.separation:.2f} m",
            "such a file is flown from whenever its pilot starts it",
        ),
        "give each drone air of its own by zones or heights, or film with one drone",
    )


def notes_on_files(drone: Drone, files: list[str], count: int, error: Error, models: int) -> list[str]:
    """Return the notes on the error of a drone's files."""
    named = ", ".join(files)
    text = f"{drone.autopilot} {named}: {count} waypoints, position within {at_least(error.position)} m"
    if not error.shot:
        return [text]
    mean = max(each.mean for each in error.shots)
    return [
        f"{text}, adds at most {at_least(error.screen, 3)} of the screen (shot {error.shot}, t ="
        f" {error.time:.1f} s) and {at_least(mean, 3)} on average under all of {models} flight models; films"
        f" {at_least(error.filmed, 0)} s at most where the plan films {error.planned:.0f} s{zoomed_to(error)}"
    ]


def zoomed_to(error: Error) -> str:
    """Return the text on the error of zoom steps; "" without zoom."""
    return f"; the edge of the picture zooms to within {at_least(error.edge, 3)}" if error.edge > 0 else ""


def set_by_hand(drone: Drone, *, focuses: bool = False) -> list[str]:
    """Return the note on exposure settings for the pilot, because no mission file states them in a common
    way.

    focuses : whether the file commands the focus
    """
    if drone.optics is None:
        return []
    aperture, shutter = drone.optics.aperture, drone.optics.shutter
    parts = [] if aperture is None else [f"aperture f/{aperture:g}"]
    parts += [] if shutter is None else [f"shutter {exposure(shutter)}"]
    parts += [] if focuses or aperture is None else ["focus"]
    how = "set by hand on the camera, as no file holds it"
    return [f"{drone.autopilot} {drone.name}: {how}: {', '.join(parts)}"]


def filmed_instead(
    mission: MissionIR, flight: DroneTrajectory, emitter: str, taken: Collection[str]
) -> list[Diagnostic]:
    """Return warnings on shots that the files film although the mission asks for photos.

    taken : shots with photos
    """
    flown = [mission.shot(phase.shot) for phase in flight.phases if phase.shot is not None]
    return [
        Diagnostic(
            "E124",
            f"the {FILES[emitter]} file of {flight.drone} films shot {shot.id} instead of taking photos",
            (mission.origins.key((*shot.path, "photos")),),
            (f"asked are photos {shot.photos}",),
            "take the photos by hand or out of the film, or leave `photos` out",
        )
        for shot in dict.fromkeys(flown)
        if shot.photos is not None and shot.id not in taken
    ]


def no_rally(mission: MissionIR, drone: Drone, emitter: str) -> Diagnostic:
    """Return the warning that a format has no rally points."""
    assert drone.safety is not None
    count = len(drone.safety.rally)
    return Diagnostic(
        "E123",
        f"the {FILES[emitter]} file of {drone.name} does not carry its rally points",
        (mission.origins.key((*drone.path, "safety", "rally")),),
        (f"{count} place{'s are' if count > 1 else ' is'} left out: it returns to where it took off",),
        "keep them in mind, or take `rally` out",
    )
