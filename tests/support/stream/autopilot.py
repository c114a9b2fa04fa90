"""A simulated autopilot: pymavlink on a loopback port, the simulated vehicle behind it.

It follows the rules that matter for a sender. PX4 wants setpoints for a second before OFFBOARD, falls out of
it without them, and takes attitudes for its gimbal; ArduPilot takes setpoints only after its own take-off,
and gimbal angles without rates. `run` drives it, from any clock.
"""

from __future__ import annotations

import math
import socket
import struct
from dataclasses import dataclass, field

import numpy as np
from pymavlink.dialects.v20 import common as mavlink

from shotc.simulation.vehicle import STEP_S, Vehicle, VehicleSetpoint, VehicleState
from tests.support.plant_steps import moved

PX4, ARDUPILOT = 12, 3
OFFBOARD, PX4_HOLD, PX4_LAND = 6 << 16, 4 << 16 | 3 << 24, 4 << 16 | 6 << 24
GUIDED, BRAKE, LAND = 4, 17, 9
SET_MODE, ARM, TAKE_OFF, CLAIM = 176, 400, 22, 1001
VIDEO_START, VIDEO_STOP = 2500, 2501
CAMERA = 100
PX4_PARAMETERS = {"COM_OBL_RC_ACT": 5, "NAV_DLL_ACT": 2, "COM_OF_LOSS_T": 1.0}
ARDUPILOT_PARAMETERS = {
    "FS_GCS_ENABLE": 1.0,
    "FS_GCS_TIMEOUT": 5.0,
    "GUID_TIMEOUT": 3.0,
    "SYSID_MYGCS": 252.0,
}
DESCENT = 1.0
"""How fast it comes down in its landing mode, m/s."""


@dataclass
class Script:
    """What an autopilot is or does otherwise than it should.

    kind : of autopilot, None for the plan's; vehicle, status : of its heartbeat; armed : from the beginning
    shift : of its home from the pad, and stands : of the vehicle from its home, East, North, Up, metres
    tie : origin of its local frame, else its home; parameters : other values, None where it lacks one
    refuses : results of commands by number; answers_after : seconds before it answers commands
    vanishes : when it falls silent, takes_over : when its pilot changes the mode, on the clock of the test
    mute : messages that it never sends; stuck : it does not move; texts : what it says when asked to arm
    pitch : what its gimbal reaches, degrees; camera : it has a camera with a heartbeat of its own
    lands : whether it stops its motors on the ground
    """

    kind: int | None = None
    vehicle: int = 2
    status: int = 3
    armed: bool = False
    shift: tuple[float, float, float] = (0.0, 0.0, 0.0)
    stands: tuple[float, float, float] = (0.0, 0.0, 0.0)
    tie: tuple[float, float, float] | None = None
    parameters: dict[str, float | None] = field(default_factory=dict)
    refuses: dict[int, int] = field(default_factory=dict)
    answers_after: float = 0.0
    vanishes: float = math.inf
    takes_over: float = math.inf
    mute: frozenset[str] = frozenset()
    stuck: bool = False
    texts: tuple[str, ...] = ()
    pitch: tuple[float, float] = (-90.0, 30.0)
    camera: bool = False
    lands: bool = True


class Autopilot:
    """One vehicle on a loopback port, which calls the port it is given."""

    def __init__(self, to, system, script, home, local):
        """Home : (lat, lon, alt); local : where it stands in its own frame, North, East, Down."""
        self.to, self.script, self.home = ("127.0.0.1", to), script, home
        self.origin, self.kind = script.tie or home, script.kind
        known = PX4_PARAMETERS if self.kind == PX4 else ARDUPILOT_PARAMETERS
        self.parameters = {n: v for n, v in (known | script.parameters).items() if v is not None}
        self.mode, self.armed = (PX4_HOLD if self.kind == PX4 else 0), script.armed
        self.pad = np.array([local])
        self.state = VehicleState.at_rest(self.pad.copy())
        self.asked = None
        self.rising = None
        self.setpoints, self.aims, self.commands, self.stations = [], [], [], set()
        self.taken_over_at = None
        self.recording = []
        self.time = None
        self._flowing = self._last = -math.inf
        self._beat = self._told = -math.inf
        self._later = []
        self._mav = mavlink.MAVLink(None, srcSystem=system, srcComponent=1)
        self._mav.robust_parsing = True
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.bind(("127.0.0.1", 0))
        self.socket.setblocking(False)

    def close(self):
        self.socket.close()

    @property
    def north_east_down(self):
        return tuple(self.state.position[0])

    def run(self, now):
        """Do what there is to do until a time: hear, fly, and tell."""
        if now >= self.script.vanishes:
            while self._receive() is not None:
                pass
            self.time = now
            return
        if self.time is None:
            self.time = now
        if now >= self.script.takes_over and self.mode in (OFFBOARD, GUIDED):
            self.mode = 3 << 16 if self.kind == PX4 else 5
        while (data := self._receive()) is not None:
            for raw in self._mav.parse_buffer(data) or []:
                self._hear(raw, now)
        while self.time + STEP_S <= now + 1e-9:
            self._fly()
        self._tell(now)

    def _receive(self):
        try:
            data, self.to = self.socket.recvfrom(65536)
            return data
        except OSError:
            return None

    def _send(self, message):
        if message.get_type() not in self.script.mute:
            self.socket.sendto(message.pack(self._mav), self.to)
            self._mav.seq = (self._mav.seq + 1) % 256

    def _hear(self, raw, now):
        kind = raw.get_type()
        if kind == "HEARTBEAT":
            self.stations.add(raw.get_srcSystem())
        elif kind == "PARAM_REQUEST_READ":
            self._tell_parameter(raw.param_id.rstrip("\x00"))
        elif kind == "COMMAND_LONG":
            self._obey(raw, now)
        elif kind == "SET_POSITION_TARGET_LOCAL_NED":
            self._follow(raw, now)
        elif kind == "GIMBAL_MANAGER_SET_ATTITUDE" and self.kind == PX4:
            w, x, y, z = raw.q
            yaw = math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))
            pitch = math.asin(max(-1.0, min(1.0, 2 * (w * y - z * x))))
            assert abs(math.atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y))) < 1e-6, "level"
            self.aims.append((now, pitch, yaw, raw.flags, raw.angular_velocity_y, raw.angular_velocity_z))
        elif kind == "GIMBAL_MANAGER_SET_PITCHYAW" and self.kind == ARDUPILOT and math.isnan(raw.pitch_rate):
            self.aims.append((now, raw.pitch, raw.yaw, raw.flags, raw.pitch_rate, raw.yaw_rate))

    def _tell_parameter(self, name):
        if name not in self.parameters:
            return
        value, kind = self.parameters[name], 9
        if self.kind == PX4 and isinstance(value, int):
            value, kind = struct.unpack("<f", struct.pack("<i", value))[0], 6
        self._send(self._mav.param_value_encode(name.encode(), value, kind, len(self.parameters), 0))

    def _follow(self, raw, now):
        assert raw.type_mask == 2048
        assert raw.coordinate_frame == 1
        place, rate, push = (raw.x, raw.y, raw.z), (raw.vx, raw.vy, raw.vz), (raw.afx, raw.afy, raw.afz)
        if not self.setpoints:
            self.taken_over_at = self._height()
        self.setpoints.append((now, *place, *rate, *push, raw.yaw))
        if now - self._last > 0.5:
            self._flowing = now
        self._last = now
        if self.kind == PX4 or self._height() > 0.5:
            self.asked = VehicleSetpoint(*(np.array([v]) for v in (place, rate, push)))
            self.rising = None

    def _obey(self, raw, now):
        params = [getattr(raw, f"param{i}") for i in range(1, 8)]
        if raw.command == mavlink.MAV_CMD_REQUEST_MESSAGE:
            self._tell_asked(int(params[0]))
            return
        self.commands.append((now, raw.command, *params))
        if raw.command == ARM:
            for text in self.script.texts:
                self._send(self._mav.statustext_encode(2, text.encode()))
        result = self.script.refuses.get(raw.command)
        if raw.command in (VIDEO_START, VIDEO_STOP) and self.script.camera and raw.target_component != CAMERA:
            result = mavlink.MAV_RESULT_UNSUPPORTED
        if result is None:
            result = self._does(raw.command, params, now)
        ack = self._mav.command_ack_encode(raw.command, result)
        self._later.append((now + self.script.answers_after, ack))

    def _does(self, command, params, now):
        if command == mavlink.MAV_CMD_DO_SET_MODE:
            return self._set_mode(params, now)
        if command == mavlink.MAV_CMD_COMPONENT_ARM_DISARM:
            return self._arm(params[0] == 1.0)
        if command == mavlink.MAV_CMD_NAV_TAKEOFF:
            if not (self.armed and self.mode == GUIDED):
                return mavlink.MAV_RESULT_FAILED
            self.rising = params[6]
        if command in (mavlink.MAV_CMD_VIDEO_START_CAPTURE, mavlink.MAV_CMD_VIDEO_STOP_CAPTURE):
            self.recording.append((now, command == mavlink.MAV_CMD_VIDEO_START_CAPTURE))
        return mavlink.MAV_RESULT_ACCEPTED

    def _set_mode(self, params, now):
        custom = int(params[1]) << 16 | int(params[2]) << 24 if self.kind == PX4 else int(params[1])
        if (
            custom == OFFBOARD
            and self.kind == PX4
            and not (now - self._last < 0.5 and now - self._flowing > 1.0)
        ):
            return mavlink.MAV_RESULT_DENIED
        self.mode = custom
        if custom in (PX4_HOLD, BRAKE):
            still = np.zeros((1, 3))
            self.asked = VehicleSetpoint(self.state.position.copy(), still, still)
        return mavlink.MAV_RESULT_ACCEPTED

    def _arm(self, armed):
        self.armed = armed
        return mavlink.MAV_RESULT_ACCEPTED

    def _height(self):
        return float(self.pad[0, 2] - self.state.position[0, 2])

    def _fly(self):
        self.time += STEP_S
        if not self.armed or self.script.stuck:
            return
        still, place = np.zeros((1, 3)), self.state.position
        wanted = self.asked
        if self.rising is not None:
            up = self.pad.copy()
            up[0, 2] -= self.rising
            wanted = VehicleSetpoint(up, still, still)
        elif self.mode in (PX4_LAND, LAND):
            down = place.copy()
            down[0, 2] = min(down[0, 2] + DESCENT, self.pad[0, 2] + 0.5)
            wanted = VehicleSetpoint(down, np.array([[0.0, 0.0, DESCENT]]), still)
        if wanted is None:
            return
        state = moved(Vehicle(), self.state, wanted, still)
        if state.position[0, 2] >= self.pad[0, 2]:  # the ground
            place = state.position.copy()
            place[0, 2] = self.pad[0, 2]
            state = VehicleState(place, still, still, still)
            if self.mode in (PX4_LAND, LAND) and self.script.lands:
                self.armed = False
        self.state = state

    def _tell(self, now):
        due = [ack for when, ack in self._later if when <= now]
        self._later = [(when, ack) for when, ack in self._later if when > now]
        for ack in due:
            self._send(ack)
        if self.kind == PX4 and self.mode == OFFBOARD and now - self._last > self.parameters["COM_OF_LOSS_T"]:
            self.mode = PX4_HOLD
        if now - self._beat >= 1.0:
            self._beat = now
            base = 1 | (128 if self.armed else 0)
            self._send(
                self._mav.heartbeat_encode(
                    self.script.vehicle,
                    self.kind,
                    base,
                    self.mode,
                    4 if self.armed else self.script.status,
                )
            )
            if self.script.camera:
                self._mav.srcComponent = CAMERA
                self._send(self._mav.heartbeat_encode(30, 8, 0, 0, 4))
                self._mav.srcComponent = 1
        if now - self._told >= 0.1:
            self._told = now
            place, rate = self.state.position[0], self.state.velocity[0]
            self._send(self._mav.local_position_ned_encode(int(now * 1000) % 2**32, *place, *rate))

    def _tell_asked(self, number):
        if number == mavlink.MAVLINK_MSG_ID_GPS_GLOBAL_ORIGIN and self.origin is not None:
            self._send(self._mav.gps_global_origin_encode(*_scaled(self.origin)))
        elif number == mavlink.MAVLINK_MSG_ID_HOME_POSITION and self.home is not None:
            rest = (0.0, 0.0, 0.0, [1.0, 0.0, 0.0, 0.0], 0.0, 0.0, 0.0)
            self._send(self._mav.home_position_encode(*_scaled(self.home), *rest))
        elif number == mavlink.MAVLINK_MSG_ID_GIMBAL_MANAGER_INFORMATION:
            low, high = map(math.radians, self.script.pitch)
            self._send(self._mav.gimbal_manager_information_encode(0, 0, 154, 0.0, 0.0, low, high, -3.0, 3.0))


def _scaled(place):
    lat, lon, alt = place
    return round(lat * 1e7), round(lon * 1e7), round(alt * 1e3)
