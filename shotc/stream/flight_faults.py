"""Diagnostics of a flight that does not go as planned."""

from __future__ import annotations

from shotc.diag.model import Diagnostic
from shotc.stream.vehicle import VehicleStatus

RESULTS = {
    1: "temporarily rejected",
    2: "denied",
    3: "unsupported",
    4: "failed",
    6: "cancelled",
}
"""MAV_RESULT of commands that are not accepted."""
TAKE_OVER = "take over with the remote control or a ground station"


def refused(vehicle: VehicleStatus, what: str, result: int) -> Diagnostic:
    """Return the error of a command that the vehicle refuses; what : completes "refuses ...", as
    in "to arm".
    """
    return Diagnostic(
        "A020",
        f"the vehicle of `{vehicle.drone}` refuses {what}",
        notes=(f"it answers: {RESULTS.get(result, f'MAV_RESULT {result}')}", *_status_texts(vehicle)),
        help="remove what keeps it from that: a ground station shows its checks before arming",
    )


def late(vehicle: VehicleStatus, what: str) -> Diagnostic:
    """Return the error of a vehicle that is not ready at its lift-off in the plan."""
    return Diagnostic(
        "A021",
        f"the vehicle of `{vehicle.drone}` is not ready when the plan has it lift off",
        notes=(f"it was asked {what} and has not done it", *_status_texts(vehicle)),
        help="check its radio link and its checks before arming, then run this again",
    )


def vanished(vehicle: VehicleStatus, silence: float) -> Diagnostic:
    """Return the error of a vehicle whose heartbeats have stopped."""
    return Diagnostic(
        "A022",
        f"the vehicle of `{vehicle.drone}` is heard no more",
        notes=(f"no heartbeat for {silence:.1f} s; without setpoints it does what was read of it before",),
        help=f"{TAKE_OVER}; check its radio link",
    )


def mode_left(vehicle: VehicleStatus) -> Diagnostic:
    """Return the error of a vehicle that no longer follows setpoints: its pilot or a failsafe has
    taken over.
    """
    mode = vehicle.autopilot.flown.name
    return Diagnostic(
        "A023",
        f"the vehicle of `{vehicle.drone}` has left the mode {mode}",
        notes=("its pilot or a failsafe took it over; it is sent nothing more", *_status_texts(vehicle)),
        help="land it, and run this again from the pads",
    )


def strayed(vehicle: VehicleStatus, distance: float, most: float) -> Diagnostic:
    """Return the error of a vehicle that is too far from its planned position."""
    return Diagnostic(
        "A024",
        f"the vehicle of `{vehicle.drone}` is {distance:.1f} m from where the plan has it",
        notes=(f"at most {most:g} m: farther away nothing that was proved holds",),
        help="put it back on its pad, or in the air look at its speed limits and at the wind",
    )


def stalled(seconds: float, most: float) -> Diagnostic:
    """Return the error of a sender that was stopped for so long that the next setpoint would be a jump."""
    return Diagnostic(
        "A025",
        f"nothing could be sent for {seconds:.2f} s",
        notes=(f"at most {most:g} s: the next setpoint would have been a jump",),
        help="leave the machine to this command, and keep it from going to sleep",
    )


def stale(target: str, silence: float) -> Diagnostic:
    """Return the warning that a live target is silent and the camera follows the plan."""
    return Diagnostic(
        "A026",
        f"nothing is heard of the live target `{target}`: the camera looks where the plan has it",
        notes=(f"its last position came {silence:.1f} s ago",),
        help="check what sends its position",
    )


def not_recorded(vehicle: VehicleStatus, shot: str, *, on: bool) -> Diagnostic:
    """Return the warning that the camera does not confirm that it started or stopped recording."""
    did = "begins" if on else "ends"
    return Diagnostic(
        "A027",
        f"the camera of `{vehicle.drone}` does not confirm that it {did} to record shot `{shot}`",
        notes=(f"component {vehicle.camera} was asked three times",),
        help="look at the camera: it may have to be started by hand",
    )


def not_landed(vehicle: VehicleStatus, seconds: float) -> Diagnostic:
    """Return the warning that a vehicle has not disarmed after its landing."""
    return Diagnostic(
        "A028",
        f"the vehicle of `{vehicle.drone}` has not disarmed {seconds:.0f} s after its landing began",
        help=f"{TAKE_OVER}",
    )


def not_holding(vehicle: VehicleStatus, seconds: float) -> Diagnostic:
    """Return the error of a vehicle that does not confirm that it holds."""
    mode = vehicle.autopilot.hold.name
    return Diagnostic(
        "A029",
        f"the vehicle of `{vehicle.drone}` does not confirm that it holds",
        notes=(f"{mode} was asked for over {seconds:.0f} s", *_status_texts(vehicle)),
        help=TAKE_OVER,
    )


def _status_texts(vehicle: VehicleStatus) -> tuple[str, ...]:
    return tuple(f"it says: {text}" for text in vehicle.texts)
