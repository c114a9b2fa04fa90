"""What a machine does when its link is lost: according to its file, or to its own settings."""

from __future__ import annotations

from shotc.ir.drone import Drone, LinkLost, Safety

NOTHING = Safety(None, None, ())
RETURN_OVER_M = 10.0  # metres from the highest point up to the return height; DJI Fly has its own setting
DJI_ACTIONS: dict[LinkLost, str] = {
    "return": "goBack",
    "hover": "hover",
    "land": "landing",
    "continue": "goBack",
}
"""Values of executeRCLostAction; if the mission continues, the value is not used."""

_DONE: dict[LinkLost, str] = {
    "return": "returns home",
    "hover": "hovers",
    "land": "lands where it is",
    "continue": "flies on",
}
_PX4: dict[LinkLost, str] = {
    "return": "NAV_DLL_ACT and NAV_RCL_ACT to 2 (return)",
    "hover": "NAV_DLL_ACT and NAV_RCL_ACT to 1 (hold)",
    "land": "NAV_DLL_ACT and NAV_RCL_ACT to 3 (land)",
    "continue": "NAV_DLL_ACT to 0 (disabled) and bit 0 of COM_RCL_EXCEPT (mission)",
}
_ARDUPILOT: dict[LinkLost, str] = {
    "return": "FS_GCS_ENABLE and FS_THR_ENABLE to 1 (RTL), and no bit 0 or 1 of FS_OPTIONS",
    "hover": "FS_GCS_ENABLE and FS_THR_ENABLE to 7 (brake), and no bit 0 or 1 of FS_OPTIONS",
    "land": "FS_GCS_ENABLE to 5 and FS_THR_ENABLE to 3 (land), and no bit 0 or 1 of FS_OPTIONS",
    "continue": "bits 0 and 1 of FS_OPTIONS (go on in Auto)",
}


def return_height(highest: float, safety: Safety | None) -> float:
    """Return the height above the pad of a file's return, metres.

    highest : height of its highest point above the pad, metres
    """
    written = None if safety is None else safety.return_height
    return highest + RETURN_OVER_M if written is None else written


def link_notes(drone: Drone, height: float, *, written: bool) -> list[str]:
    """Return the notes on a drone's link loss: what it does, and what has to be set by hand.

    height : return height in the file, above the pad, metres
    written : whether the file can state the behaviour
    """
    safety = drone.safety or NOTHING
    if drone.autopilot in ("px4", "ardupilot"):
        return [_vehicle(drone, safety)]
    if not written:
        return [_app(drone, safety)]
    action = safety.link_lost or "return"
    text = f"{drone.autopilot} {drone.name}: when the link is lost it {_DONE[action]}, as the file says"
    if action == "return" and drone.autopilot == "pilot-2":
        text += f", {height:.0f} m above its pad"
    if action == "return" and drone.autopilot == "dji-fly":
        text += f", at the height that is set in DJI Fly{_at_least(safety)}"
    if action == "continue" and drone.autopilot == "dji-fly":
        text += "; some machines do not, as the Mini 5 Pro in the EU"
    return [text]


def _at_least(safety: Safety) -> str:
    return "" if safety.return_height is None else f": set it to {safety.return_height:g} m"


def _vehicle(drone: Drone, safety: Safety) -> str:
    """Return the note on the vehicle's own settings, which MAVLink mission files do not contain."""
    px4 = drone.autopilot == "px4"
    name = f"{drone.autopilot} {drone.name}"
    text = f"{name}: the vehicle's own settings decide what happens when the link is lost, not the file"
    if safety.link_lost is None and safety.return_height is None:
        names = "NAV_DLL_ACT, NAV_RCL_ACT, RTL_RETURN_ALT" if px4 else "FS_GCS_ENABLE, FS_THR_ENABLE, RTL_ALT"
        return f"{text}: {names}"
    behaviour = [] if safety.link_lost is None else [(_PX4 if px4 else _ARDUPILOT)[safety.link_lost]]
    if safety.return_height is not None:
        height = safety.return_height
        behaviour.append(f"RTL_RETURN_ALT to {height:g} m" if px4 else f"RTL_ALT to {100 * height:.0f} cm")
    return f"{text}: set {', and '.join(behaviour)}"


def _app(drone: Drone, safety: Safety) -> str:
    name = f"{drone.autopilot} {drone.name}"
    text = f"{name}: the app's settings decide what happens when the link is lost, not the table"
    behaviour = [] if safety.link_lost is None else [f"`{safety.link_lost}`"]
    behaviour += [] if safety.return_height is None else [f"a return at {safety.return_height:g} m"]
    return f"{text}: set {' and '.join(behaviour)}" if behaviour else text
