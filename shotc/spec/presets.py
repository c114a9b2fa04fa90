"""Drone presets, and the defaults of missions.

The figures are for planning: speeds are well below the published maxima, so that the autopilot has reserve
for corrections, and endurance includes a reserve. Rates and accelerations of gimbals, and jerks, are rarely
published; the values here are acceptable for smooth footage.
"""

from math import radians
from typing import Literal, NamedTuple

from shotc.ir.drone import Gimbal
from shotc.ir.limits import Limits
from shotc.ir.power import Power
from shotc.ir.smoothing import NORMAL_S
from shotc.ir.source import Autopilot

Body = Literal["forward", "follow-camera", "free"]

COMPOSITION = "thirds"
SEPARATION_M = 3.0
GROUND_CLEARANCE_M = 2.0
TARGET_CLEARANCE_M = 1.0
OBSTACLE_CLEARANCE_M = 2.0
TRANSIT_FILMED_M = 5.0
TRANSIT_OTHER_M = 3.0
TOP_SPEED_M_S = 70.0  # m/s, of targets; faster than helicopters, trains, and cars except racing cars
PACE_SHARE = 0.75
CIRCLE_SHARE = 0.03 / 36.0
"""Circle of confusion as a share of a sensor's width: the usual 0.03 mm of a full frame."""
WIDTH_PX = 3840  # width of a picture: UHD
ZOOM_RATE_RAD_S = radians(10.0)  # rad/s, of the field of view: a slow zoom of a film camera
SMOOTHING = NORMAL_S
RATE_HZ = 50.0
SHOW_RATE_HZ = 5.0
RUN_COUNT = 20  # of a rehearsal
RISE_M = 10.0  # metres over its pad to which a fleet's drone takes off vertically
EMIT = ("csv", "mavlink", "storyboard", "rerun")
SHOW_EMIT = ("csv", "skyc", "contact-sheet", "animatic", "rerun")
LARGE_OUTPUTS = ("csv", "rerun")
"""Outputs of a show whose size grows with drones and time: some hundred kilobytes a drone."""
MANY_DRONES = 2000
"""Number of drones above which tables and recordings of a show are made only on request."""
DEFAULT_MODEL = "x500"


class Preset(NamedTuple):
    """A drone model.

    summary : one line; source : of the figures
    hfov : rad; aspect : width / height; radius : of the sphere round the body and its propellers, m
    endurance : s, the time of hovering if its power is known
    power : battery and rotors, None if unknown
    fixed_lens : whether its camera is built in and has one field of view
    sensor : width of the exposed area, m, None if unknown
    """

    summary: str
    limits: Limits
    gimbal: Gimbal
    hfov: float
    aspect: float
    radius: float
    endurance: float
    autopilot: Autopilot
    body: Body
    source: str
    power: Power | None = None
    fixed_lens: bool = False
    sensor: float | None = None


class _Motion(NamedTuple):
    """Limits of the motion of a drone, SI."""

    speed: float
    climb: float
    descent: float
    acceleration: float
    jerk: float


def _limits(motion: _Motion, yaw: tuple[float, float]) -> Limits:
    """Return limits; yaw : (rate, acceleration) in degrees."""
    return Limits(*motion, radians(yaw[0]), radians(yaw[1]))


def _gimbal(pitch: tuple[float, float], yaw: tuple[float, float], rates: tuple[float, float]) -> Gimbal:
    """Return a gimbal from ranges and (rate, acceleration), all in degrees."""
    low, high = (radians(pitch[0]), radians(pitch[1])), (radians(yaw[0]), radians(yaw[1]))
    return Gimbal(low, high, radians(rates[0]), radians(rates[1]))


RESERVE_SHARE = 0.2  # share of a battery that is left at landing

_X500_POWER = Power(
    mass=2.0, battery=14.8 * 5.2 * 3600.0, rotors=4, radius=5 * 0.0254, efficiency=1.0, reserve=RESERVE_SHARE
).hovering_for(18 * 60.0)


_DJI = "; speeds at most three quarters of the maker's in mode N, endurance of what it hovers or flies"
_WIDE_FOV_RAD = radians(71.6)  # 24 mm equivalent, from the full width of a 4:3 sensor


def _dji(
    summary: str,
    motion: _Motion,
    pitch: tuple[float, float],
    minutes: float,
    source: str,
    *,
    light: bool = False,
) -> Preset:
    """Return a folding DJI drone: its gimbal does not pan, so the body turns with the camera.

    light : whether its mass is below 250 g
    """
    return Preset(
        summary=summary,
        limits=_limits(motion, (60.0, 90.0) if light else (70.0, 100.0)),
        gimbal=_gimbal(pitch, (-10.0, 10.0), (60.0, 120.0)),
        hfov=_WIDE_FOV_RAD,
        aspect=16 / 9,
        radius=0.3 if light else 0.4,
        endurance=minutes * 60.0,
        autopilot="dji-fly",
        body="follow-camera",
        source=source + _DJI,
        fixed_lens=True,
    )


_MINI_3 = _Motion(speed=7.5, climb=2.2, descent=2.2, acceleration=3.0, jerk=8.0)
_LIGHT = _Motion(speed=9.0, climb=3.5, descent=3.0, acceleration=3.0, jerk=8.0)
_AIR = _Motion(speed=11.0, climb=4.5, descent=4.5, acceleration=4.0, jerk=10.0)
_MAVIC = _Motion(speed=11.0, climb=4.5, descent=4.0, acceleration=4.0, jerk=10.0)

_PX4 = "speeds and accelerations below PX4's default MPC_* limits; "

_MODELS: dict[str, Preset] = {
    "x500": Preset(
        summary="500 mm PX4 development quadrotor with a three-axis gimbal",
        limits=_limits(_Motion(speed=8.0, climb=3.0, descent=1.5, acceleration=3.0, jerk=8.0), (60.0, 90.0)),
        gimbal=_gimbal((-90.0, 30.0), (-135.0, 135.0), (45.0, 90.0)),
        hfov=radians(70.0),
        aspect=16 / 9,
        radius=0.6,
        endurance=_X500_POWER.endurance,
        autopilot="px4",
        body="follow-camera",
        source=_PX4 + "500 mm wheelbase and 10 inch propellers of the Holybro X500 V2 give the radius; 2 kg, "
        "four cells of 5.2 Ah and about 18 min of hovering are the maker's",
        power=_X500_POWER,
    ),
    "mini": Preset(
        summary="folding camera drone under 250 g; its gimbal does not pan, the body turns",
        limits=_limits(_Motion(speed=8.0, climb=3.0, descent=3.0, acceleration=3.0, jerk=8.0), (60.0, 90.0)),
        gimbal=_gimbal((-90.0, 35.0), (-10.0, 10.0), (60.0, 120.0)),
        hfov=radians(72.0),
        aspect=16 / 9,
        radius=0.3,
        endurance=24 * 60.0,
        autopilot="dji-fly",
        body="follow-camera",
        source="class of the DJI Mini 4 Pro (24 mm equivalent lens), about half of its published maxima",
        fixed_lens=True,
    ),
    "pro": Preset(
        summary="folding camera drone of about 1 kg; its gimbal does not pan, the body turns",
        limits=_limits(
            _Motion(speed=12.0, climb=5.0, descent=4.0, acceleration=4.0, jerk=10.0), (70.0, 100.0)
        ),
        gimbal=_gimbal((-90.0, 30.0), (-10.0, 10.0), (60.0, 120.0)),
        hfov=radians(72.0),
        aspect=16 / 9,
        radius=0.4,
        endurance=30 * 60.0,
        autopilot="dji-fly",
        body="follow-camera",
        source="class of the DJI Mavic 3 (24 mm equivalent lens), about two thirds of its published maxima",
        fixed_lens=True,
    ),
    "mini-3": _dji(
        "DJI Mini 3, under 250 g, without waypoints of its own: flown by Litchi Pilot",
        _MINI_3,
        (-90.0, 60.0),
        22.0,
        "maker's data of the DJI Mini 3 (24 mm equivalent), speeds and endurance as of the Mini 3 Pro",
        light=True,
    )._replace(autopilot="litchi"),
    "mini-3-pro": _dji(
        "DJI Mini 3 Pro, under 250 g, without waypoints of its own: flown by Litchi Pilot",
        _MINI_3,
        (-90.0, 60.0),
        22.0,
        "maker's data of the DJI Mini 3 Pro (mode N 10 m/s, hovers 30 min, 24 mm equivalent)",
        light=True,
    )._replace(autopilot="litchi"),
    "mini-4-pro": _dji(
        "DJI Mini 4 Pro, under 250 g",
        _LIGHT,
        (-90.0, 60.0),
        22.0,
        "maker's data of the DJI Mini 4 Pro (N 12 m/s, up and down 5 m/s, hovers 30 min, 24 mm equivalent)",
        light=True,
    ),
    "mini-5-pro": _dji(
        "DJI Mini 5 Pro, under 250 g",
        _LIGHT,
        (-90.0, 55.0),
        23.0,
        "maker's data of the DJI Mini 5 Pro (tilt to 55 deg, 24 mm equivalent), mode N as of the Mini 4 Pro",
        light=True,
    ),
    "air-3": _dji(
        "DJI Air 3, 720 g, with its wide lens",
        _AIR,
        (-90.0, 60.0),
        31.0,
        "maker's data of the DJI Air 3 (mode N 15 m/s, hovers 42 min, 24 mm equivalent)",
    ),
    "air-3s": _dji(
        "DJI Air 3S, 724 g, with its wide lens",
        _AIR,
        (-90.0, 60.0),
        30.0,
        "maker's data of the DJI Air 3S (hovers 41 min, 24 mm equivalent), mode N as of the Air 3",
    ),
    "mavic-3-classic": _dji(
        "DJI Mavic 3 Classic, 895 g",
        _MAVIC,
        (-90.0, 35.0),
        30.0,
        "maker's data of the DJI Mavic 3 Classic (hovers 40 min, 24 mm equivalent), N as of the Mavic 3 Pro",
    ),
    "mavic-3-pro": _dji(
        "DJI Mavic 3 Pro, 958 g, with its wide lens",
        _MAVIC,
        (-90.0, 35.0),
        28.0,
        "maker's data of the DJI Mavic 3 Pro (N 15 m/s, up and down 6 m/s, hovers 37 min, 24 mm equivalent)",
    ),
    "mavic-4-pro": _dji(
        "DJI Mavic 4 Pro, 1063 g, with its wide lens",
        _MAVIC,
        (-90.0, 70.0),
        34.0,
        "maker's data of the DJI Mavic 4 Pro (flies 51 min, 28 mm equivalent), mode N taken as 15 m/s",
    )._replace(hfov=radians(63.4)),
    "mavic-3e": _dji(
        "DJI Mavic 3 Enterprise, 915 g, flown by DJI Pilot 2",
        _MAVIC,
        (-90.0, 35.0),
        28.0,
        "maker's data of the DJI Mavic 3 Enterprise (mode N 15 m/s, hovers 38 min, 24 mm equivalent)",
    )._replace(autopilot="pilot-2"),
    "solo": Preset(
        summary="ArduPilot quadrotor with an action camera on a gimbal without pan",
        limits=_limits(_Motion(speed=8.0, climb=3.0, descent=2.0, acceleration=2.5, jerk=5.0), (60.0, 90.0)),
        gimbal=_gimbal((-90.0, 30.0), (-20.0, 20.0), (45.0, 90.0)),
        hfov=radians(87.0),
        aspect=16 / 9,
        radius=0.5,
        endurance=14 * 60.0,
        autopilot="ardupilot",
        body="follow-camera",
        source="3DR Solo development guide (gimbal travel -130 to 45 deg pitch, 25 deg yaw), kept inside it; "
        "jerk as ArduPilot's default",
    ),
    "alta-x": Preset(
        summary="heavy lifter with a cinema camera on a gimbal that pans all round",
        limits=_limits(_Motion(speed=10.0, climb=3.0, descent=2.0, acceleration=2.0, jerk=4.0), (40.0, 50.0)),
        gimbal=_gimbal((-90.0, 25.0), (-170.0, 170.0), (40.0, 60.0)),
        hfov=radians(39.0),
        aspect=17 / 9,
        radius=1.3,
        endurance=15 * 60.0,
        autopilot="px4",
        body="forward",
        source="class of the Freefly Alta X with a MoVI gimbal; a 35 mm lens on a 24.9 mm wide sensor gives "
        "the field of view; dynamics are those of a heavy load",
    ),
    "crazyflie": Preset(
        summary="27 g indoor research quadrotor with a fixed forward camera",
        limits=_limits(_Motion(speed=1.0, climb=0.8, descent=0.5, acceleration=1.5, jerk=6.0), (90.0, 180.0)),
        gimbal=_gimbal((-10.0, 10.0), (-5.0, 5.0), (30.0, 60.0)),
        hfov=radians(65.0),
        aspect=1.0,
        radius=0.1,
        endurance=5 * 60.0,
        autopilot="px4",
        body="follow-camera",
        source="Bitcraze Crazyflie 2.1 with an AI deck (square sensor); the camera is fixed, so the pitch "
        "range is only what its picture tolerates",
        fixed_lens=True,
    ),
    "show-drone": Preset(
        summary="light-show quadrotor without a camera",
        limits=_limits(_Motion(speed=5.0, climb=2.5, descent=2.0, acceleration=2.5, jerk=8.0), (45.0, 90.0)),
        gimbal=_gimbal((-90.0, 30.0), (-180.0, 180.0), (45.0, 90.0)),
        hfov=radians(70.0),
        aspect=16 / 9,
        radius=0.25,
        endurance=12 * 60.0,
        autopilot="ardupilot",
        body="free",
        source="common light-show quadrotors of about 300 mm; camera figures are placeholders of the class",
    ),
}

_INCH_1_3_M, _INCH_M, _FOUR_THIRDS_M = 9.8e-3, 13.2e-3, 17.3e-3
"""Widths of sensors of the types 1/1.3 inch (4:3, 12.3 mm diagonal), 1 inch and 4/3 inch, m."""
_SENSORS = {
    **dict.fromkeys(("mini", "mini-3", "mini-3-pro", "mini-4-pro", "air-3"), _INCH_1_3_M),
    **dict.fromkeys(("mini-5-pro", "air-3s"), _INCH_M),
    **dict.fromkeys(("pro", "mavic-3-classic", "mavic-3-pro", "mavic-4-pro", "mavic-3e"), _FOUR_THIRDS_M),
    "alta-x": 24.9e-3,
}
PRESETS = {name: model._replace(sensor=_SENSORS.get(name)) for name, model in _MODELS.items()}
