"""E: data that waypoint files cannot represent."""

from __future__ import annotations

from shotc.diag.code_info import CodeInfo
from shotc.diag.model import Severity

_MAVLINK = """\
shotc: 1
mission: over-the-house
world:
  origin: {lat: 47.3769, lon: 8.5417, alt: 408}
targets: {mast: {at: [0, 0, 6], radius: 1, height: 12}}
drones: {cam: {model: x500, home: [0, -40, 0]}}
shots:
  - id: look
    kind: keyframes
    drone: cam
    target: mast
    keyframes:
      - {at: [-20, -25, 16], look_at: mast}
      - {at: [20, -25, 16], look_at: mast}
output: {emit: [mavlink]}
"""

_MOVING = (
    _MAVLINK.replace("at: [0, 0, 6]", "track: {start: [0, 0, 6], velocity: [1, 0, 0]}")
    .replace(
        "    keyframes:\n      - {at: [-20, -25, 16], look_at: mast}\n      - {at: [20, -25, 16], look_at: mast}\n",
        "    side: right\n    distance: 25\n    altitude: 16\n    timing: {duration: 10}\n",
    )
    .replace("kind: keyframes", "kind: lateral")
)

_MAVLINK_CODES = (
    CodeInfo(
        "E101",
        "mission-file-needs-origin",
        Severity.WARNING,
        "mission files or KML tours are skipped, because the mission has no world.origin",
        "Autopilots and apps fly missions in latitude and longitude, and tours are filmed there. Without `world.origin` "
        "the plan has no place on the globe, so the files of `mavlink`, `dji`, `litchi` and `kml` are not written; all "
        "other outputs are. Give the origin of the mission's frame, or leave them out of `output.emit`.",
        _MAVLINK.replace("world:\n  origin: {lat: 47.3769, lon: 8.5417, alt: 408}\n", ""),
        _MAVLINK,
        "plan",
    ),
    CodeInfo(
        "E102",
        "zone-not-in-geofence",
        Severity.WARNING,
        "a zone is left out of the autopilot's geofence",
        "A MAVLink fence is an area on the map without height. A keep-out zone that the plan flies over or under, "
        "or a keep-in zone that the flight's ground track leaves, would make the autopilot stop a flight that is "
        "in order, so it is left out. PX4 asks for any one keep-in area where a mission means all of them; there "
        "only the smallest is written. The plan keeps every zone all the same.",
        _MAVLINK.replace(
            "  origin: {lat: 47.3769, lon: 8.5417, alt: 408}\n",
            "  origin: {lat: 47.3769, lon: 8.5417, alt: 408}\n"
            "  zones: {house: {keep: out, box: {center: [0, -25, 3], size: [8, 8, 6]}}}\n",
        ),
        _MAVLINK,
        "plan",
    ),
    CodeInfo(
        "E103",
        "mission-file-coarse",
        Severity.WARNING,
        "the mission file is coarser than intended, so that the autopilot can hold it",
        "A curve becomes straight legs, and an autopilot's memory ends: 500 items for PX4, 650 for ArduPilot. "
        "Where the usual tolerances need more, those of heading and picture grow first and that of position "
        "last, until the flight fits; the notes say what was reached. Fly the shots as separate missions, or "
        "fly the plan itself with `shotc stream`.",
        "",
        "",
        "other",
    ),
    CodeInfo(
        "E104",
        "takeoff-raised",
        Severity.WARNING,
        "a mission file takes off higher than the plan, because the autopilot refuses less",
        "Before a mission PX4 checks that the take-off ends at least a metre higher than its acceptance radius, "
        "which is 2 m for multirotors (NAV_ACC_RAD); ArduPilot climbs a metre at least. Where the plan turns off "
        "lower, the file climbs on to that height above the pad first, through air that was not verified.",
        "",
        "",
        "other",
    ),
    CodeInfo(
        "E105",
        "zoom-not-carried",
        Severity.WARNING,
        "a mission file does not carry the zoom of a shot",
        "MAVLink files and those of DJI Pilot 2 zoom a lens that `camera: {zoom: [24 mm, 70 mm]}` says is there; those of "
        "DJI Fly and Litchi cannot. Where nothing is known of the lens, or the format has no zoom, the camera's path and "
        "angles are right, and the field of view stays. Say what the camera carries, zoom by hand, or give the shot one `hfov`.",
        _MAVLINK.replace("[20, -25, 16], look_at: mast}", "[20, -25, 16], look_at: mast, hfov: 50 deg}"),
        _MAVLINK,
        "plan",
    ),
    CodeInfo(
        "E106",
        "legs-cut-clearance",
        Severity.WARNING,
        "the straight legs of a mission file come nearer to something than its clearance allows",
        "The plan keeps every clearance, but a mission file flies straight from waypoint to waypoint, and "
        "waypoints can only be so dense. The message says how much nearer the legs come, and to what. Leave more "
        "room there, or fly the plan itself with `shotc stream`.",
        "",
        "",
        "other",
    ),
    CodeInfo(
        "E107",
        "clock-not-carried",
        Severity.WARNING,
        "a mission file does not carry when a shot of a moving target is filmed",
        "An autopilot flies a mission file from waypoint to waypoint at mean speeds, from whenever it is started. A "
        "target that moves is then somewhere else, and several drones meet where the plan keeps them apart. Fly "
        "such a mission with `shotc stream`, all drones on one clock; the file is good for rehearsing one "
        "drone's way without the target.",
        _MOVING,
        _MAVLINK,
        "plan",
    ),
    CodeInfo(
        "E110",
        "fleet-without-missions",
        Severity.WARNING,
        "no mission files are written for a fleet",
        "The drones of a fleet keep their distance by being where they should be at every instant. A mission file "
        "is flown from waypoint to waypoint without a common clock, so a fleet that flies such files meets itself. "
        "`.skyc` is the format for shows: every drone's curve and lights over time, for Skybrush and the autopilots "
        "that follow it.",
        "",
        "",
        "other",
    ),
)

_MACHINE_CODES = (
    CodeInfo(
        "E116",
        "other-machine",
        Severity.WARNING,
        "an output holds files for other machines than the drone's",
        "What flies a drone stands with its model: `shotc list drones`. PX4 and ArduPilot fly `mavlink`, DJI's apps `dji` "
        "or `litchi`. Where nothing is asked for, `plan` writes what the machines of the mission fly; `--autopilot` "
        "writes for another one.",
        _MAVLINK.replace("emit: [mavlink]", "emit: [dji]"),
        _MAVLINK,
        "plan",
    ),
    CodeInfo(
        "E117",
        "shot-shown-otherwise",
        Severity.WARNING,
        "a file of waypoints shows a shot otherwise than the plan",
        "Machines that fly curves through waypoints keep to themselves how they curve and turn, so points are chosen under "
        "all flight models at once: at most 0.05 half frames off at worst and 0.02 on average. Where that cannot be "
        "had, for a camera that turns while the drone stands, or so near that points would have to be closer than "
        "machines take them, the message says what was reached.",
        "",
        "",
        "other",
    ),
    CodeInfo(
        "E118",
        "target-drifts",
        Severity.WARNING,
        "a file without a clock films a target that moves",
        "Such a machine starts on command, and is sooner or later at each place than the plan, as it speeds up and "
        "brakes by rules of its own. The message says how far the target goes meanwhile. Start by eye and frame "
        "loosely, or fly the plan with `shotc stream` on a machine that takes it.",
        _MOVING.replace("x500", "mini").replace("[mavlink]", "[dji]"),
        _MAVLINK.replace("x500", "mini").replace("[mavlink]", "[dji]"),
        "plan",
    ),
    CodeInfo(
        "E119",
        "curve-breaks-clearance",
        Severity.ERROR,
        "a file of waypoints is not written, because its curve would come too near to something",
        "The curves of these machines leave the hull of their points, and nobody has published by how much. What is written "
        "is flown again under every flight model; a file that comes nearer to a zone, a target, the ground or the "
        "greatest height than the plan does, under any of them, is not written. Leave more room there, or let the way "
        "bend less.",
        "",
        "",
        "other",
    ),
    CodeInfo(
        "E120",
        "apart-by-timing",
        Severity.ERROR,
        "files of waypoints are not written, because timing alone keeps two drones apart",
        "Two drones may use the same air one after the other in a plan, for all fly by one clock. Files of waypoints "
        "have none: each is flown from whenever its pilot starts it. Where two ways come nearer to each other "
        "than the separation, neither file is written. Give each drone air of its own, by zones or heights.",
        "",
        "",
        "other",
    ),
)

_CROSSING = _MAVLINK.replace(
    "drones: {cam: {model: x500, home: [0, -40, 0]}}",
    "drones:\n  cam: {model: x500, home: [0, -40, 0]}\n  second: {model: x500, home: [10, -40, 0]}",
).replace(
    "output:",
    "  - id: across\n    kind: keyframes\n    drone: second\n    target: mast\n    timing: {after: look}\n"
    "    keyframes:\n      - {at: [0, -35, 16], look_at: mast}\n      - {at: [0, -15, 16], look_at: mast}\noutput:",
)

_UNAIDED_CODES = (
    CodeInfo(
        "E145",
        "timing-not-carried",
        Severity.WARNING,
        "mission files of two drones do not carry the timing that keeps them apart",
        "Two drones may use the same air one after the other in a plan, for all fly by one clock. An autopilot starts its "
        "mission file when it is told to, and flies it at mean speeds, so that both may be at one place at once. `shotc stream` "
        "sends the plan itself to all of them by one clock; else fly one after the other has landed, or give each "
        "drone air of its own, by zones or heights.",
        _CROSSING,
        _MAVLINK,
        "plan",
    ),
    CodeInfo(
        "E122",
        "promised-zoom-not-carried",
        Severity.ERROR,
        "a mission file is not written, because it would not carry the zoom of a shot that promises its framing",
        "The picture of a shot with `require: {in_frame: ..., screen_error: ..., size: ...}` is proved with the field of view of "
        "the plan. A file that leaves the lens as it stands shows another one, so it is not written. Say what the camera carries "
        "with `camera: {zoom: ...}` where the machine takes zooms, film with one field of view, or promise nothing.",
        _MAVLINK.replace(
            "[20, -25, 16], look_at: mast}", "[20, -25, 16], look_at: mast, hfov: 60 deg}"
        ).replace("    target: mast\n", "    target: mast\n    require: {in_frame: 50 %}\n"),
        _MAVLINK.replace("[20, -25, 16], look_at: mast}", "[20, -25, 16], look_at: mast, hfov: 60 deg}")
        .replace("    target: mast\n", "    target: mast\n    require: {in_frame: 50 %}\n")
        .replace("home: [0, -40, 0]", "home: [0, -40, 0], camera: {zoom: [24 mm, 70 mm]}"),
        "plan",
    ),
    CodeInfo(
        "E121",
        "no-waypoints-of-its-own",
        Severity.WARNING,
        "a drone flies no waypoints by itself",
        "Mini 3 and Mini 3 Pro have no waypoints, in DJI Fly or in its programming interface. Litchi Pilot steers them over "
        "the controller from Litchi's table, which ends where the radio link does. That is a beta, for Android alone.",
        _MAVLINK.replace("x500", "mini-3-pro").replace("[mavlink]", "[litchi]"),
        _MAVLINK.replace("x500", "mini-4-pro").replace("[mavlink]", "[litchi]"),
        "plan",
    ),
)

_SAFETY_CODES = (
    CodeInfo(
        "E123",
        "rally-not-carried",
        Severity.WARNING,
        "a format has no rally points, and the mission asks for some",
        "`safety: {rally: [[x, y]]}` of a drone are places where it may land instead of at home. QGroundControl's plans hold them; "
        "files for DJI's apps and for Litchi, and the text form of waypoints, do not. Such a machine returns to where it took off.",
        _MAVLINK.replace(
            "x500, home: [0, -40, 0]", "mini, home: [0, -40, 0], safety: {rally: [[30, -40]]}"
        ).replace("[mavlink]", "[dji]"),
        _MAVLINK.replace("x500, home: [0, -40, 0]", "mini, home: [0, -40, 0]").replace("[mavlink]", "[dji]"),
        "plan",
    ),
)

_PHOTO_CODES = (
    CodeInfo(
        "E124",
        "photos-not-taken",
        Severity.WARNING,
        "a file films a shot instead of taking photos",
        "`photos: {every: 2 s}` of a shot takes photos in place of a film. MAVLink files do, and those for DJI Pilot 2 and Litchi where "
        "the drone moves all through the shot, no other shot begins where it ends, and the mission fits into one file: they tell "
        "intervals of legs. DJI Fly takes none. Else a film is recorded, from which pictures can be taken.",
        _MAVLINK.replace("    target: mast\n", "    target: mast\n    photos: {every: 2 s}\n")
        .replace("x500", "mini")
        .replace("[mavlink]", "[dji]"),
        _MAVLINK.replace("x500", "mini").replace("[mavlink]", "[dji]"),
        "plan",
    ),
)

WAYPOINTS: tuple[CodeInfo, ...] = (
    *_MAVLINK_CODES,
    *_MACHINE_CODES,
    *_UNAIDED_CODES,
    *_SAFETY_CODES,
    *_PHOTO_CODES,
)
