"""Describes how PX4 and ArduPilot differ, and what each does when its link is lost.

Numbers are those of MAVLink, of PX4's commander (``px4_custom_mode.h``, ``commander_params.c``) and of
ArduCopter (``mode.h``, ``Parameters.cpp``, ``events.cpp``). The messages that gimbal managers accept are in
PX4's ``mavlink_receiver.cpp`` and ArduPilot's ``AP_Mount.cpp``.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal, NamedTuple

from shotc.stream.projection import Layout, azimuthal, equirectangular

Action = Literal["hold", "return", "land"]


class Mode(NamedTuple):
    """A flight mode: its name, the two numbers of MAV_CMD_DO_SET_MODE, and its custom_mode in heartbeats."""

    name: str
    main: int
    sub: int
    custom: int


class LossRule(NamedTuple):
    """The values of a parameter that controls what happens on a lost link.

    actions : the values allowed for a flight, each with the action of the autopilot
    harmless : further allowed values, which leave the action to the other parameters
    optional : whether some firmware versions lack the parameter
    safe : a value to recommend, and its action in words
    """

    parameter: str
    actions: Mapping[int, Action]
    harmless: frozenset[int]
    optional: bool
    safe: tuple[int, str]


class LossTime(NamedTuple):
    """A parameter that holds how long the link may be silent before the autopilot acts, s."""

    parameter: str
    longest: float
    optional: bool = False


class SpeedLimit(NamedTuple):
    """A parameter that limits the speed of setpoints, m/s; axis : the direction that it limits."""

    parameter: str
    axis: Literal["level", "up", "down"]


class Autopilot(NamedTuple):
    """An autopilot as a sender sees it.

    number : MAV_AUTOPILOT
    layout : the map projection of its local frame
    flown, hold, land : the modes that follow setpoints, stop in the air, and land at the current place
    lead : how long before lift-off in the plan a drone starts to prepare, s
    lift : height to which it takes off by itself before it accepts setpoints, m; 0 if it accepts them on its
        pad
    bytewise : whether the float of a PARAM_VALUE holds the bytes of an integer
    attitudes : whether its gimbal manager accepts GIMBAL_MANAGER_SET_ATTITUDE, with angles and rates; else it
        accepts GIMBAL_MANAGER_SET_PITCHYAW, which it ignores if both angles and rates are given
    alone : the parameter that sets what it does when the ground station is silent, in any mode
    speeds : parameters that limit the speed of setpoints; some versions lack them
    station : parameters that hold the system id of the ground station; any one of them is enough
    """

    name: str
    number: int
    layout: Layout
    flown: Mode
    hold: Mode
    land: Mode
    lead: float
    lift: float
    bytewise: bool
    attitudes: bool
    losses: tuple[LossRule, ...]
    times: tuple[LossTime, ...]
    alone: str
    speeds: tuple[SpeedLimit, ...] = ()
    station: tuple[str, ...] = ()

    @property
    def parameters(self) -> tuple[str, ...]:
        """The parameters that are read before a flight."""
        bounds = (row.parameter for row in self.speeds)
        times = (row.parameter for row in self.times)
        return (*(row.parameter for row in self.losses), *times, *bounds, *self.station)

    def can_lack(self, parameter: str) -> bool:
        """Tell whether some firmware versions lack a parameter."""
        optional = {row.parameter for row in self.losses if row.optional}
        optional |= {row.parameter for row in self.times if row.optional}
        return parameter in optional | {row.parameter for row in self.speeds} | set(self.station)


def _px4_mode(name: str, main: int, sub: int = 0) -> Mode:
    return Mode(name, main, sub, main << 16 | sub << 24)


def _ardupilot_mode(name: str, number: int) -> Mode:
    return Mode(name, number, 0, number)


PX4 = Autopilot(
    name="PX4",
    number=12,
    layout=azimuthal,
    flown=_px4_mode("OFFBOARD", 6),
    hold=_px4_mode("HOLD", 4, 3),
    land=_px4_mode("LAND", 4, 6),
    lead=8.0,
    lift=0.0,
    bytewise=True,
    attitudes=True,
    losses=(
        LossRule(
            "COM_OBL_RC_ACT",
            {3: "return", 4: "land", 5: "hold"},
            frozenset(),
            optional=False,
            safe=(5, "hold"),
        ),
        # Versions before 1.14 use another parameter when no remote control is on.
        LossRule("COM_OBL_ACT", {0: "land", 1: "hold", 2: "return"}, frozenset(), True, (1, "hold")),
        LossRule("NAV_DLL_ACT", {1: "hold", 2: "return", 3: "land"}, frozenset({0}), False, (2, "return")),
    ),
    times=(LossTime("COM_OF_LOSS_T", 5.0),),
    alone="NAV_DLL_ACT",
    speeds=(
        SpeedLimit("MPC_XY_VEL_MAX", "level"),
        SpeedLimit("MPC_Z_VEL_MAX_UP", "up"),
        SpeedLimit("MPC_Z_VEL_MAX_DN", "down"),
    ),
)
ARDUPILOT = Autopilot(
    name="ArduPilot",
    number=3,
    layout=equirectangular,
    flown=_ardupilot_mode("GUIDED", 4),
    hold=_ardupilot_mode("BRAKE", 17),
    land=_ardupilot_mode("LAND", 9),
    lead=15.0,
    lift=1.0,
    bytewise=False,
    attitudes=False,
    losses=(
        LossRule(
            "FS_GCS_ENABLE",
            # 6 flies to the landing point of a stored mission, which no plan has verified.
            {1: "return", 2: "return", 3: "return", 4: "return", 5: "land", 7: "land"},
            frozenset(),
            optional=False,
            safe=(1, "return"),
        ),
    ),
    times=(LossTime("FS_GCS_TIMEOUT", 10.0, optional=True), LossTime("GUID_TIMEOUT", 5.0, optional=True)),
    alone="FS_GCS_ENABLE",
    station=("MAV_GCS_SYSID", "SYSID_MYGCS"),
)
AUTOPILOTS = {"px4": PX4, "ardupilot": ARDUPILOT}
"""The autopilots by the name that missions use."""
NAMES = {pilot.number: pilot.name for pilot in AUTOPILOTS.values()}
MULTIROTORS = frozenset({2, 3, 4, 13, 14, 15, 29, 35})
"""MAV_TYPE of vehicles that can hover: rotorcraft with two to four or more rotors, and helicopters."""
