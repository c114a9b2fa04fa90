"""An autopilot on MAVSDK: another implementation of MAVLink, with parameter and command services of its own.

What it reads and writes shares no line with pymavlink: messages go through libmav, as JSON. The vehicle is
where it was last asked to be.
"""

from __future__ import annotations

import json
import socket
from contextlib import suppress

from mavsdk.mavsdk import Configuration, Mavsdk
from mavsdk.plugins.mavlink_direct_server import MavlinkDirectServer, MavlinkMessage
from mavsdk.plugins.param_server import ParamServer

from tests.support.stream.autopilot import (
    ARM,
    CLAIM,
    OFFBOARD,
    PX4,
    PX4_HOLD,
    PX4_LAND,
    SET_MODE,
    VIDEO_START,
    VIDEO_STOP,
)

HEAD, HEARTBEAT = 10, bytes(3)
"""Bytes of a MAVLink 2 header, and the message number of a heartbeat in it."""
REQUEST, INTERVAL = 512, 511
INFORMATION = {49: "GPS_GLOBAL_ORIGIN", 242: "HOME_POSITION", 280: "GIMBAL_MANAGER_INFORMATION"}


class SdkAutopilot:
    """A PX4 at its home, which calls a port on this machine."""

    def __init__(self, port, place, parameters):
        """Place : (lat, lon, alt) of home and local frame; parameters : whole numbers and others by name."""
        self.place, self.mode, self.armed = place, PX4_HOLD, False
        self.position, self._beat = (0.0, 0.0, 0.0), 0.0
        self.setpoints, self.aims, self.commands = [], [], []
        self._sdk = Mavsdk(Configuration.create_manual(1, 1, False))
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._socket.setblocking(False)
        self._socket.connect(("127.0.0.1", port))
        self._sdk.add_any_connection("raw://")
        self._sdk.subscribe_raw_bytes_to_be_sent(self._out)
        component = self._sdk.server_component(0)
        self._parameters = ParamServer(component)
        for name, value in parameters.items():
            provide = (
                self._parameters.provide_param_int
                if isinstance(value, int)
                else self._parameters.provide_param_float
            )
            provide(name, value)
        self._direct = MavlinkDirectServer(component)
        self._direct.subscribe_message("SET_POSITION_TARGET_LOCAL_NED", self._follow)
        self._direct.subscribe_message("GIMBAL_MANAGER_SET_ATTITUDE", self._aim)
        for command in (SET_MODE, ARM, CLAIM, VIDEO_START, VIDEO_STOP, REQUEST, INTERVAL):
            self._direct.subscribe_command(command, self._obey)

    def close(self):
        self._sdk.destroy()
        self._socket.close()

    def run(self, now):
        """Take in what has come, and tell what is told all the time."""
        # What was sent before anybody listened comes back as refused.
        with suppress(BlockingIOError, ConnectionRefusedError):
            while True:
                self._sdk.pass_received_raw_bytes(self._socket.recv(65536))
        if now - self._beat >= 0.9:
            self._beat = now
            self._tell_heartbeat()
        self._tell_position()

    def _out(self, data):
        """Send what is to be sent, but for the heartbeats of a library, which is no autopilot."""
        if data[7:10] != HEARTBEAT or data[HEAD + 5] == PX4:
            with suppress(OSError):
                self._socket.send(data)

    def _tell_heartbeat(self):
        base = 1 | (128 if self.armed else 0)
        fields = {"type": 2, "autopilot": PX4, "base_mode": base, "custom_mode": self.mode}
        self._send("HEARTBEAT", fields | {"system_status": 4 if self.armed else 3, "mavlink_version": 3})

    def _tell_position(self):
        north, east, down = self.position
        fields = {"time_boot_ms": 0, "x": north, "y": east, "z": down, "vx": 0.0, "vy": 0.0, "vz": 0.0}
        self._send("LOCAL_POSITION_NED", fields)

    def _send(self, name, fields):
        self._direct.send_message(MavlinkMessage(name, 1, 1, 0, 0, json.dumps(fields)))

    def _follow(self, message, *_):
        told = json.loads(message.fields_json)
        self.setpoints.append(told)
        if self.mode == OFFBOARD and self.armed:
            self.position = (told["x"], told["y"], told["z"])

    def _aim(self, message, *_):
        self.aims.append(json.loads(message.fields_json))

    def _obey(self, message, *_):
        told = json.loads(message.fields_json)
        command = told["command"]
        self.commands.append(told)
        if command == SET_MODE:
            self.mode = int(told["param2"]) << 16 | int(told["param3"]) << 24
            self.armed = self.armed and self.mode != PX4_LAND
        elif command == ARM:
            self.armed = told["param1"] == 1.0
        ack = {"command": command, "result": 0, "progress": 255, "result_param2": 0}
        self._send("COMMAND_ACK", ack | {"target_system": 255, "target_component": 190})
        if command == REQUEST:
            self._inform(int(told["param1"]))

    def _inform(self, number):
        lat, lon, alt = self.place
        place = {"latitude": round(lat * 1e7), "longitude": round(lon * 1e7), "altitude": round(alt * 1e3)}
        name = INFORMATION.get(number)
        if name == "GPS_GLOBAL_ORIGIN":
            self._send(name, place | {"time_usec": 0})
        elif name == "HOME_POSITION":
            rest = dict.fromkeys(("x", "y", "z", "approach_x", "approach_y", "approach_z"), 0.0)
            self._send(name, place | rest | {"q": [1.0, 0.0, 0.0, 0.0], "time_usec": 0})
        elif name == "GIMBAL_MANAGER_INFORMATION":
            reach = {"pitch_min": -1.6, "pitch_max": 0.6, "yaw_min": -3.0, "yaw_max": 3.0}
            rest = {"roll_min": 0.0, "roll_max": 0.0, "time_boot_ms": 0, "cap_flags": 0}
            self._send(name, reach | rest | {"gimbal_device_id": 1})
