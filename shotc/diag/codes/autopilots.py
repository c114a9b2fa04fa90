"""A: autopilots, faults that prevent streaming a plan to them or that occur during the flight."""

from __future__ import annotations

from shotc.diag.code_info import CodeInfo
from shotc.diag.model import Severity


def _fault(number: int, slug: str, summary: str, explanation: str) -> CodeInfo:
    return CodeInfo(f"A{number:03}", slug, Severity.ERROR, summary, explanation, "", "", "other")


def _warning(number: int, slug: str, summary: str, explanation: str) -> CodeInfo:
    return _fault(number, slug, summary, explanation)._replace(severity=Severity.WARNING)


CODES: tuple[CodeInfo, ...] = (
    _fault(
        1,
        "stream-needs-origin",
        "a plan without world.origin cannot be streamed",
        "Setpoints are places in the autopilot's own local frame, whose origin is a latitude, a longitude and a "
        "height. A plan that has no place on the globe has none there. Give the mission `world.origin` and plan it "
        "again.",
    ),
    _fault(
        2,
        "address-not-opened",
        "the address of a vehicle or a target cannot be opened",
        "`udp:PORT` listens on this machine. The port may be in use by a ground station or by this command in "
        "another window, or the address may not be one of this machine's.",
    ),
    _fault(
        3,
        "no-heartbeat",
        "no autopilot is heard at an address",
        "An autopilot says once a second that it is there. For 10 s nothing came: it is off, its radio is, or its "
        "telemetry goes to another machine or port.",
    ),
    _fault(
        4,
        "other-vehicle",
        "a vehicle is not the one that the plan is made for",
        "PX4 and ArduPilot take setpoints differently, and a plan is made for vehicles that hover. The heartbeat says "
        "what the vehicle is; `drones.NAME.autopilot` says what the plan expects.",
    ),
    _fault(
        5,
        "vehicle-not-ready",
        "a vehicle is armed already, or not ready to be",
        "A plan begins on the pad with motors off. A vehicle that flies, starts up, calibrates or complains is left "
        "alone.",
    ),
    _fault(
        6,
        "vehicle-silent",
        "a vehicle does not send what has to be known before a flight",
        "Read before anything is armed are the origin of the local frame (GPS_GLOBAL_ORIGIN), the home "
        "(HOME_POSITION), the position (LOCAL_POSITION_NED), and the parameters that say what happens when the link "
        "is lost. A vehicle without a position by satellites has no origin and no home yet.",
    ),
    _fault(
        7,
        "link-loss-action",
        "an autopilot would not hold, return or land when its link is lost",
        "When setpoints end, PX4 does what COM_OBL_RC_ACT says (COM_OBL_ACT too, before version 1.14), and "
        "NAV_DLL_ACT when no ground station is heard; ArduPilot does what FS_GCS_ENABLE says. Only hold, return "
        "and land are flown with: position and altitude mode need somebody at the sticks, disabled and terminate "
        "need no comment. A value of FS_GCS_ENABLE that flies a stored mission is refused, too.",
    ),
    _fault(
        8,
        "link-loss-late",
        "an autopilot notices a lost link too late",
        "COM_OF_LOSS_T, GUID_TIMEOUT and FS_GCS_TIMEOUT say how long a link is silent before it counts as lost. "
        "Until then the last setpoint is followed, which moves.",
    ),
    _fault(
        9,
        "plan-elsewhere",
        "a plan is for another place than that of its vehicle",
        "The vehicle's home is more than 100 m from the pad that the plan begins on. Zones, terrain and "
        "buildings of the mission are not those round the vehicle.",
    ),
    _fault(
        10,
        "home-off",
        "a vehicle's home is more than 1 m from the plan's",
        "The plan takes off from its pad and lands there, and an autopilot that returns goes to its own home. Both "
        "have to be one place, to a metre, and the vehicle has to stand on it. Heights by satellites are often "
        "metres off: then `world.origin.alt` is what to change, for heights are flown above the pad.",
    ),
    _fault(
        11,
        "local-frame-far",
        "the local frame of an autopilot begins too far from the plan",
        "An autopilot sets the origin of its local frame where it first has a position. More than a kilometre away "
        "North and Down there are not those of the plan. It sets it anew when it is restarted.",
    ),
    _fault(
        12,
        "gimbal-not-able",
        "a vehicle has no gimbal that can do what the plan asks",
        "The camera is pointed through a MAVLink gimbal manager, which also says what its gimbal reaches.",
    ),
    _fault(
        13,
        "target-not-heard",
        "no position of a live target is heard",
        "With `--target` a camera follows where its target really is. Before take-off its position has to be heard "
        "once, as a JSON object or as another vehicle's GLOBAL_POSITION_INT, a datagram each.",
    ),
    _fault(
        14,
        "vehicle-slower",
        "an autopilot's own limits are slower than the plan",
        "PX4 follows no setpoint faster than MPC_XY_VEL_MAX, MPC_Z_VEL_MAX_UP and MPC_Z_VEL_MAX_DN, whatever the "
        "vehicle can do: it would fall behind the plan.",
    ),
    _fault(
        20,
        "vehicle-refuses",
        "a vehicle refuses a mode, its gimbal, to arm or to take off",
        "The autopilot has answered no. Its own checks are the reason mostly; what it said about them stands in the "
        "notes. All other drones hold, or disarm where they stand.",
    ),
    _fault(
        21,
        "vehicle-late",
        "a vehicle is not ready at its lift-off in the plan",
        "All drones fly on one clock, so none can wait for another. A drone begins to get ready 8 s (PX4) or 15 s "
        "(ArduPilot, which takes off to 1 m by itself) before its lift-off. All other drones hold, or disarm where "
        "they stand.",
    ),
    _fault(
        22,
        "vehicle-vanished",
        "a vehicle falls silent during the flight",
        "No heartbeat came for 2 s. Nobody knows whether setpoints still arrive; without them the autopilot does what "
        "was read of it before the flight. All other drones hold.",
    ),
    _fault(
        23,
        "mode-left",
        "a vehicle has left the mode in which it follows the plan",
        "Its pilot has taken it over, or a failsafe has. It is sent nothing more; all other drones hold.",
    ),
    _fault(
        24,
        "vehicle-strays",
        "a vehicle is far from its place in the plan",
        "What is proved of a plan holds along its path. More than 10 m from it a vehicle flies something else, in "
        "wind that is too strong for it or below limits of its own. A vehicle that waits for its lift-off is not "
        "armed more than 2 m from its pad. All drones in the air hold.",
    ),
    _fault(
        25,
        "sender-stalled",
        "setpoints could not be sent for too long",
        "The machine did something else for half a second or longer, or slept. The next setpoint would have been a "
        "jump. All drones hold.",
    ),
    _warning(
        26,
        "target-silent",
        "a live target falls silent during the flight",
        "The camera goes back to where the plan has it look, no faster than its gimbal turns, and follows again when "
        "positions come again.",
    ),
    _warning(
        27,
        "recording-not-confirmed",
        "a camera does not confirm that it records, or that it has ended",
        "MAV_CMD_VIDEO_START_CAPTURE and MAV_CMD_VIDEO_STOP_CAPTURE are sent at the begin and at the end of every "
        "shot, three times each at most. The flight goes on: it is what was proved.",
    ),
    _warning(
        28,
        "landing-not-confirmed",
        "a vehicle does not disarm after its landing",
        "At the end of the plan a drone stands on its pad, and is asked to land, which ends with motors off.",
    ),
    _fault(
        29,
        "hold-not-confirmed",
        "a vehicle does not confirm that it holds",
        "Hold (PX4: HOLD, ArduPilot: BRAKE) was asked for again and again for 5 s. Take the vehicle over.",
    ),
    _fault(
        30,
        "show-not-streamed",
        "fleets of shows are not streamed",
        "`shotc stream` films: it points cameras and looks after each vehicle. Drones of shows carry their part of a "
        "show themselves, as a .skyc file.",
    ),
    _warning(
        31,
        "zoom-not-sent",
        "the zoom of a shot is not sent",
        "What a zoom command means differs from camera to camera. The camera's path and angles are right, the field "
        "of view stays as it is. Zoom by hand, or give the shot one `hfov`.",
    ),
    _warning(
        33,
        "photos-not-sent",
        "a shot with photos is filmed instead",
        "`photos` of a shot are taken by MAVLink files. `shotc stream` tells cameras to begin and to end a recording, and "
        "nothing else.",
    ),
    _warning(
        34,
        "show-not-sent",
        "the cameras of a plan are streamed, but its show is not",
        "Drones of shows carry their part of a show themselves, as a .skyc file, whose clock is that of the plan. Cameras stay out of the "
        "airspace of the show from its take-off to its landing, so they are clear of it whenever either begins; what they film depends on both "
        "clocks beginning together.",
    ),
    _fault(
        35,
        "begins-too-soon",
        "mission time 0 is too soon for the drones to get ready",
        "`--at` says at which time of day mission time 0 is. A drone gets ready before its lift-off, 8 s (PX4) or 15 s "
        "(ArduPilot); where the plan lifts off at once, that is before mission time 0. Checks come first, which take up to 20 s.",
    ),
    _fault(
        32,
        "machine-takes-no-setpoints",
        "a drone of the plan is flown by an app, which takes no setpoints",
        "`shotc stream` speaks MAVLink with PX4 and ArduPilot. Machines of DJI fly a file that is copied onto their "
        "controller; `shotc emit` writes it.",
    ),
)
