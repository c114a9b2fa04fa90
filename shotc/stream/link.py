"""The MAVLink connection to a vehicle: the only module that uses pymavlink.

It uses only the generated dialect of pymavlink, on sockets of its own. A link belongs to one vehicle: it
accepts datagrams from the first address that sends an autopilot's heartbeat, and sends to that address.
"""

from __future__ import annotations

import struct
from collections.abc import Callable, Iterator
from math import cos, nan, sin
from typing import Any

from pymavlink.dialects.v20 import common as mavlink

from shotc.stream.autopilots import Mode
from shotc.stream.endpoint import Endpoint, datagrams, opened
from shotc.stream.messages import (
    CommandResult,
    GimbalManager,
    GlobalPosition,
    GlobeFix,
    Heartbeat,
    Home,
    LocalPosition,
    Message,
    Origin,
    Parameter,
    StatusText,
)
from shotc.stream.setpoints import Aim, LocalSetpoint

STATION, OURSELVES = 255, mavlink.MAV_COMP_ID_MISSIONPLANNER
"""System and component id of ground stations."""
AUTOPILOT = mavlink.MAV_COMP_ID_AUTOPILOT1
USES_ALL = mavlink.POSITION_TARGET_TYPEMASK_YAW_RATE_IGNORE
ROLL_LOCK, PITCH_LOCK, YAW_LOCK = 4, 8, 16
INTEGERS = {1: "<B", 2: "<b", 3: "<H", 4: "<h", 5: "<I", 6: "<i"}
"""MAV_PARAM_TYPE of integers, and the ``struct`` format of their bytes in the float of PARAM_VALUE."""


class VehicleLink:
    """One UDP socket to one vehicle."""

    def __init__(self, endpoint: Endpoint, *, bytewise: bool = False) -> None:
        """Open the socket.

        bytewise : whether integer parameters are sent as bytes
        Raises OSError if the socket cannot be opened.
        """
        self.endpoint = endpoint
        self.system = 0
        self.bytewise = bytewise
        self._peer: tuple[str, int] | None = (endpoint.host, endpoint.port) if endpoint.calls else None
        self._known = False
        self._mav = mavlink.MAVLink(None, srcSystem=STATION, srcComponent=OURSELVES)
        self._mav.robust_parsing = True
        self._socket = opened(endpoint)

    def close(self) -> None:
        """Close the socket."""
        self._socket.close()

    def speak_as(self, system: int) -> None:
        """Use the system id of the ground station whose silence the autopilot monitors."""
        self._mav.srcSystem = system

    def receive(self) -> Iterator[Message]:
        """Yield the messages that have arrived since the last call; skip other data and unused messages."""
        for data, peer in datagrams(self._socket):
            if self._known and peer != self._peer:
                continue
            yield from self._read(data, peer)

    def _read(self, data: bytes, peer: tuple[str, int]) -> Iterator[Message]:
        for raw in decoded(self._mav, data):
            message = understood(raw, bytewise=self.bytewise)
            if isinstance(message, Heartbeat) and not self._known and raw.get_srcComponent() == AUTOPILOT:
                self.system, self._peer, self._known = message.system, peer, True
            if message is not None and (not self.system or raw.get_srcSystem() == self.system):
                yield message

    def _send(self, message: Any) -> None:
        if self._peer is None:
            return
        try:
            self._socket.sendto(message.pack(self._mav), self._peer)
        except OSError:
            return  # a lost network shows as missing heartbeats
        self._mav.seq = (self._mav.seq + 1) % 256

    def heartbeat(self) -> None:
        """Send the heartbeat of a ground station."""
        self._send(
            self._mav.heartbeat_encode(
                mavlink.MAV_TYPE_GCS, mavlink.MAV_AUTOPILOT_INVALID, 0, 0, mavlink.MAV_STATE_ACTIVE
            )
        )

    def ask_parameter(self, name: str) -> None:
        """Request a parameter."""
        self._send(self._mav.param_request_read_encode(self.system, AUTOPILOT, name.encode(), -1))

    def ask(self, message: type[Message]) -> None:
        """Request one message of a type."""
        self.command(mavlink.MAV_CMD_REQUEST_MESSAGE, float(_NUMBERS[message]))

    def stream(self, message: type[Message], rate: float) -> None:
        """Request a type of message at a rate, Hz."""
        self.command(mavlink.MAV_CMD_SET_MESSAGE_INTERVAL, float(_NUMBERS[message]), 1e6 / rate)

    def command(self, command: int, *params: float, component: int = AUTOPILOT) -> None:
        """Send a command; missing parameters are zero."""
        seven = (*params, *(0.0,) * (7 - len(params)))
        self._send(self._mav.command_long_encode(self.system, component, command, 0, *seven))

    def set_mode(self, mode: Mode) -> None:
        """Request a flight mode."""
        custom = mavlink.MAV_MODE_FLAG_CUSTOM_MODE_ENABLED
        self.command(mavlink.MAV_CMD_DO_SET_MODE, float(custom), float(mode.main), float(mode.sub))

    def arm(self, *, armed: bool) -> None:
        """Request to arm or disarm, without forcing it."""
        self.command(mavlink.MAV_CMD_COMPONENT_ARM_DISARM, float(armed))

    def take_off(self, height: float) -> None:
        """Request a vertical take-off to a height above the vehicle's home, m."""
        self.command(mavlink.MAV_CMD_NAV_TAKEOFF, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, height)

    def record(self, *, on: bool, component: int) -> None:
        """Request the camera to start or stop recording."""
        video = mavlink.MAV_CMD_VIDEO_START_CAPTURE if on else mavlink.MAV_CMD_VIDEO_STOP_CAPTURE
        self.command(video, component=component)

    def claim(self, gimbal: GimbalManager) -> None:
        """Take control of a gimbal."""
        ours = (float(self._mav.srcSystem), float(self._mav.srcComponent))
        self.command(
            mavlink.MAV_CMD_DO_GIMBAL_MANAGER_CONFIGURE, *ours, -1.0, -1.0, 0.0, 0.0, float(gimbal.device),
            component=gimbal.component,
        )  # fmt: skip

    def setpoint(self, setpoint: LocalSetpoint, boot_ms: int) -> None:
        """Send position, velocity, acceleration and yaw."""
        self._send(
            self._mav.set_position_target_local_ned_encode(
                boot_ms, self.system, AUTOPILOT, mavlink.MAV_FRAME_LOCAL_NED, USES_ALL,
                *setpoint.position, *setpoint.velocity, *setpoint.acceleration, setpoint.yaw, 0.0,
            )
        )  # fmt: skip

    def aim(self, aim: Aim, gimbal: GimbalManager, *, pans: bool) -> None:
        """Send gimbal angles relative to the horizon; without pan, the camera keeps the body's yaw."""
        yaw = aim.yaw if pans else 0.0
        self._send(
            self._mav.gimbal_manager_set_pitchyaw_encode(
                self.system, gimbal.component, _flags(pans=pans), gimbal.device, aim.pitch, yaw, nan, nan
            )
        )

    def attitude(self, aim: Aim, gimbal: GimbalManager, *, pans: bool) -> None:
        """Send the angles of ``aim`` as a quaternion (w, x, y, z) without roll, with the angular rates."""
        yaw, yaw_rate = (aim.yaw, aim.yaw_rate) if pans else (0.0, 0.0)
        cp, sp, cy, sy = cos(aim.pitch / 2), sin(aim.pitch / 2), cos(yaw / 2), sin(yaw / 2)
        self._send(
            self._mav.gimbal_manager_set_attitude_encode(
                self.system, gimbal.component, _flags(pans=pans), gimbal.device,
                [cy * cp, -sy * sp, cy * sp, sy * cp], 0.0, aim.pitch_rate, yaw_rate,
            )
        )  # fmt: skip


def _flags(*, pans: bool) -> int:
    return ROLL_LOCK | PITCH_LOCK | (YAW_LOCK if pans else 0)


def decoded(mav: Any, data: bytes) -> list[Any]:
    """Return the MAVLink messages in a datagram; an empty list if it holds other data."""
    try:
        return mav.parse_buffer(data) or []
    except (mavlink.MAVError, struct.error, ValueError):
        return []


def decoder() -> Any:
    """Return a decoder for the datagrams of one sender."""
    mav = mavlink.MAVLink(None)
    mav.robust_parsing = True
    return mav


def understood(raw: Any, *, bytewise: bool = False) -> Message | None:
    """Return a message as plain values, None if its type is not used."""
    read = _READERS.get(raw.get_msgId())
    if read is None:
        return None
    try:
        return Parameter(_name(raw), _number(raw, bytewise=bytewise)) if read is _parameter else read(raw)
    except (OverflowError, ValueError, struct.error):
        return None


def _heartbeat(raw: Any) -> Message:
    return Heartbeat(
        raw.get_srcSystem(), raw.get_srcComponent(), raw.type, raw.autopilot,
        bool(raw.base_mode & mavlink.MAV_MODE_FLAG_SAFETY_ARMED), raw.custom_mode, raw.system_status,
    )  # fmt: skip


def _parameter(raw: Any) -> Message:
    return Parameter(_name(raw), float(raw.param_value))


def _name(raw: Any) -> str:
    text = raw.param_id
    return (text.decode("ascii", "replace") if isinstance(text, bytes) else str(text)).rstrip("\x00")


def _number(raw: Any, *, bytewise: bool) -> float:
    layout = INTEGERS.get(raw.param_type)
    if not bytewise or layout is None:
        return float(raw.param_value)
    return float(struct.unpack_from(layout, struct.pack("<f", raw.param_value))[0])


def _place(raw: Any) -> GlobeFix:
    return GlobeFix(raw.latitude / 1e7, raw.longitude / 1e7, raw.altitude / 1e3)


def _gimbal(raw: Any) -> Message:
    return GimbalManager(
        raw.get_srcComponent(),
        raw.gimbal_device_id,
        (raw.pitch_min, raw.pitch_max),
        (raw.yaw_min, raw.yaw_max),
    )


_READERS: dict[int, Callable[[Any], Message]] = {
    mavlink.MAVLINK_MSG_ID_HEARTBEAT: _heartbeat,
    mavlink.MAVLINK_MSG_ID_PARAM_VALUE: _parameter,
    mavlink.MAVLINK_MSG_ID_COMMAND_ACK: lambda raw: CommandResult(raw.command, raw.result),
    mavlink.MAVLINK_MSG_ID_GPS_GLOBAL_ORIGIN: lambda raw: Origin(_place(raw)),
    mavlink.MAVLINK_MSG_ID_HOME_POSITION: lambda raw: Home(_place(raw)),
    mavlink.MAVLINK_MSG_ID_LOCAL_POSITION_NED: lambda raw: LocalPosition((raw.x, raw.y, raw.z)),
    mavlink.MAVLINK_MSG_ID_GLOBAL_POSITION_INT: lambda raw: GlobalPosition(
        raw.get_srcSystem(), GlobeFix(raw.lat / 1e7, raw.lon / 1e7, raw.alt / 1e3)
    ),
    mavlink.MAVLINK_MSG_ID_GIMBAL_MANAGER_INFORMATION: _gimbal,
    mavlink.MAVLINK_MSG_ID_STATUSTEXT: lambda raw: StatusText(raw.severity, str(raw.text).rstrip("\x00")),
}
_NUMBERS: dict[type[Message], int] = {
    Origin: mavlink.MAVLINK_MSG_ID_GPS_GLOBAL_ORIGIN,
    Home: mavlink.MAVLINK_MSG_ID_HOME_POSITION,
    LocalPosition: mavlink.MAVLINK_MSG_ID_LOCAL_POSITION_NED,
    GimbalManager: mavlink.MAVLINK_MSG_ID_GIMBAL_MANAGER_INFORMATION,
}
