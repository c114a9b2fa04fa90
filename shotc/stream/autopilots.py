"""What PX4 and ArduPilot want said differently, and what each does when its link is lost.

Numbers are those of MAVLink, of PX4's commander (``px4_custom_mode.h``, ``commander_params.c``) and of
ArduCopter (``mode.h``, ``Parameters.cpp``, ``events.cpp``). What gimbal managers take is in PX4's
``mavlink_receiver.cpp`` and ArduPilot's ``AP_Mount.cpp``.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal, NamedTuple

from shotc.stream.projection import Layout, azimuthal, equirectangular

Action = Literal["hold", "return", "land"]


class Mode(NamedTuple):
    """A flight mode: its name, the two numbers of MAV_CMD_DO_SET_MODE, and what heartbeats say in it."""

    name: str
    main: int
    sub: int
    custom: int


class LossRule(NamedTuple):
    """What a parameter says about a lost link.

    actions : the values that may be flown with, and what the autopilot does then
    harmless : values that leave the matter to the other parameters
    optional : whether versions without it are known
    safe : a value to set, and in words what for
    """

    parameter: str
    actions: Mapping[int, Action]
    harmless: frozenset[int]
    optional: bool
    safe: tuple[int, str]


class LossTime(NamedTuple):
    """A parameter that holds how long a link is silent before that, seconds."""

    parameter: str
    longest: float
    optional: bool = False


class SpeedLimit(NamedTuple):
    """A parameter above which the autopilot follows no setpoint, m/s; axis : of the speed that it bounds."""

    parameter: str
    axis: Literal["level", "up", "down"]


class Autopilot(NamedTuple):
    """An autopilot as a sender sees it.

    number : MAV_AUTOPILOT; layout : of its local frame
    flown, hold, land : the modes that follow setpoints, stop in the air, and come down where the vehicle is
    lead : seconds before its lift-off in the plan at which a drone begins to get ready
    lift : metres to which it takes off by itself before it takes setpoints; 0 where it takes them on its pad
    bytewise : whether the float of a parameter holds the bytes of an integer
    attitudes : whether its gimbal manager takes GIMBAL_MANAGER_SET_ATTITUDE, with rates beside the angles;
        else it takes GIMBAL_MANAGER_SET_PITCHYAW, and neither angles nor rates where both are given
    alone : the parameter that says what it does when the ground station falls silent, in any mode
    speeds : what bounds the speed of what follows setpoints; versions may lack them
    station : parameters, any one of which says whose heartbeats count as the link
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
        """Tell whether some versions do without a parameter."""
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
        # Before version 1.14 another parameter holds where no remote control is on.
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
            # 6 flies to where a stored mission lands, which no plan has proved.
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
"""By the name that missions give a drone's autopilot."""
NAMES = {pilot.number: pilot.name for pilot in AUTOPILOTS.values()}
MULTIROTORS = frozenset({2, 3, 4, 13, 14, 15, 29, 35})
"""MAV_TYPE of what hovers: 2 to 4 and more rotors, and helicopters."""
