"""Plans made by hand, for tests that need one without running the compiler."""

from __future__ import annotations

from functools import cache
from hashlib import sha256
from math import atan2, pi, radians

import numpy as np

from shotc.geom.bernstein import Piecewise, concatenate, quintic_hermite
from shotc.geom.shapes import CylinderShape
from shotc.geom.solids import Cylinder, Prism
from shotc.geom.vec import direction
from shotc.ir.drone import Drone, Gimbal
from shotc.ir.keyframes import KeyframeIR, PlacedKeyframe, PlacedShot
from shotc.ir.limits import Limits, Timing
from shotc.ir.mission import Composition, GeoOrigin, Keyframe, MissionIR, Shot, Zone
from shotc.ir.origin import OriginMap
from shotc.ir.phases import KeyframeTime, Phase, Reference
from shotc.ir.promise import Promise
from shotc.ir.rules import Rules, TransitClearance
from shotc.ir.source import MissionSource
from shotc.ir.target import Target
from shotc.ir.trajectory import Claim, DroneTrajectory, TrajectoryIR, VerifiedIR
from tests.support.records import replace

CENTER = Composition("center", points=((0.0, 0.0),))
HFOV = radians(70)
AZIMUTHS = np.linspace(-pi / 2, pi / 2, 5)
"""Where the keyframes of the half orbit stand, radians from East."""

TOWER = Target("tower", (0.0, 0.0, 12.0), CylinderShape(4.0, 24.0), ("targets", "tower"))
TREE = Zone("tree", "out", Cylinder((-20.0, 10.0), 3.0, 0.0, 12.0), ("world", "zones", "tree"))
FIELD = Zone(
    "field",
    "in",
    Prism(((-80.0, -80.0), (80.0, -80.0), (80.0, 80.0), (-80.0, 80.0)), 2.0, 60.0),
    ("world", "zones", "field"),
)
PHASES = (
    Phase("takeoff", None, 0.0, 8.0),
    Phase("transit", None, 8.0, 22.0),
    Phase("shot", "half", 22.0, 52.0),
    Phase("return", None, 52.0, 112.0),
    Phase("land", None, 112.0, 122.0),
)
SPEED = Claim(
    constraint="speed",
    subject="cam1",
    shot=None,
    limit=8.0,
    worst=7.9,
    unit="m/s",
    upper=True,
    time=37.0,
    position=(40.0, 0.0, 20.0),
    method="bounded",
    hard=True,
    holds=True,
    path=("drones", "cam1", "limits", "speed"),
)


def orbit_text(*, origin: bool = True) -> str:
    """The text of `orbit_mission`."""
    keyframes = "".join(
        f"      - {{at: [{float(40 * np.cos(a))!r}, {float(40 * np.sin(a))!r}, 20], look_at: tower}}\n"
        for a in AZIMUTHS
    )
    return f"""\
shotc: 1
mission: half-orbit
world:
{"  origin: {lat: 47.3769, lon: 8.5417, alt: 408}" if origin else ""}
  zones:
    tree: {{keep: out, cylinder: {{center: [-20, 10], radius: 3, height: [0, 12]}}}}
    field: {{keep: in, polygon: {{points: [[-80, -80], [80, -80], [80, 80], [-80, 80]], height: [2, 60]}}}}
targets:
  tower: {{at: [0, 0, 12], radius: 4, height: 24}}
drones:
  cam1:
    model: x500
    home: [0, -60, 0]
    limits: {{speed: 8, climb: 4, descent: 3, acceleration: 3, jerk: 8, yaw_rate: 60 deg/s,
             yaw_acceleration: 90 deg/s^2}}
    gimbal: {{pitch: [-90 deg, 30 deg], yaw: [-135 deg, 135 deg], rate: 45 deg/s, acceleration: 90 deg/s^2}}
    camera: {{hfov: 70 deg, aspect: "16:9"}}
    radius: 0.6
    endurance: 20 min
    body: follow-camera
rules: {{composition: center, separation: 3, ground_clearance: 2, target_clearance: 1}}
shots:
  - id: half
    kind: keyframes
    drone: cam1
    target: tower
    timing: {{duration: 30}}
    require: {{in_frame: 100 %, screen_error: 0.05}}
    keyframes:
{keyframes}output: {{emit: [csv, mavlink, rerun]}}
"""


def orbit_mission(*, origin: bool = True) -> MissionIR:
    """A half orbit round a tower, one tree and a field about it."""
    text = orbit_text(origin=origin).encode()
    return MissionIR(
        name="half-orbit",
        origin=GeoOrigin(47.3769, 8.5417, 408.0) if origin else None,
        wind=0.0,
        zones=(TREE, FIELD),
        targets=(TOWER,),
        drones=(_drone(),),
        rules=Rules(3.0, 2.0, 1.0, transits=TransitClearance(5.0, 3.0), obstacle_clearance=2.0),
        shots=(_shot(),),
        rate=50.0,
        emit=("csv", "mavlink", "rerun"),
        source_sha256=sha256(text).hexdigest(),
        deferred=(),
        origins=OriginMap("half-orbit.yaml", {}, {}),
        source=MissionSource(text),
    )


@cache
def orbit_plan(*, origin: bool = True) -> VerifiedIR:
    """Take-off, transit, a filmed half orbit, return and landing: C2, within every limit."""
    mission = orbit_mission(origin=origin)
    shot = mission.shots[0]
    zero = np.zeros((2, 2))
    reference = quintic_hermite(np.array([22.0, 52.0]), zero, zero, zero)
    flight = DroneTrajectory(
        "cam1",
        _flight_curve(),
        PHASES,
        _keyframe_times(),
        (Reference("half", "tower", 22.0, 52.0, reference),),
    )
    keyframes = KeyframeIR(mission, (PlacedShot(shot, _placed(shot)),))
    return VerifiedIR(TrajectoryIR(keyframes, (flight,), deviations=(), stats=()), (SPEED,))


def _drone() -> Drone:
    return Drone(
        name="cam1",
        model="x500",
        home=(0.0, -60.0, 0.0),
        limits=Limits(8.0, 4.0, 3.0, 3.0, 8.0, radians(60), radians(90)),
        gimbal=Gimbal((radians(-90), radians(30)), (radians(-135), radians(135)), radians(45), radians(90)),
        hfov=HFOV,
        aspect=16 / 9,
        radius=0.6,
        endurance=1200.0,
        priority=1,
        body="follow-camera",
        autopilot="px4",
        path=("drones", "cam1"),
    )


def _shot() -> Shot:
    return Shot(
        id="half",
        kind="keyframes",
        drone="cam1",
        subject="tower",
        keyframes=tuple(_keyframe(i, a) for i, a in enumerate(AZIMUTHS)),
        timing=Timing(duration=30.0),
        pace=0.75,
        promise=Promise(in_frame=1.0, screen_error=0.05),
        refine_optional=False,
        path=("shots", 0),
    )


def _keyframe(index: int, azimuth: float) -> Keyframe:
    return Keyframe(
        at=(40 * np.cos(azimuth), 40 * np.sin(azimuth), 20.0),
        aim=None,
        target="tower",
        composition=CENTER,
        hfov=HFOV,
        hold=0.0,
        time=None,
        placed=True,
        path=("shots", 0, "keyframes", index),
    )


def _placed(shot: Shot) -> tuple[PlacedKeyframe, ...]:
    poses = [_pose(a) for a in AZIMUTHS]
    return tuple(
        PlacedKeyframe(
            at=keyframe.at,
            yaw=direction(pose[3]),
            pitch=pose[4],
            hfov=keyframe.hfov,
            target="tower",
            reference=(0.0, 0.0),
            asked=(0.0, 0.0),
            hold=0.0,
            time=None,
            placed=True,
            path=keyframe.path,
        )
        for keyframe, pose in zip(shot.keyframes, poses, strict=True)
    )


def _pose(azimuth: float) -> np.ndarray:
    """All seven channels of a camera on the orbit that has the tower in the middle of its frame."""
    p = np.array([40 * np.cos(azimuth), 40 * np.sin(azimuth), 20.0])
    d = np.array(TOWER.centre) - p
    # The camera goes once through yaw = pi; write it without a wrap.
    yaw = azimuth + pi
    return np.array([*p, yaw, atan2(d[2], np.hypot(d[0], d[1])), yaw, HFOV])


def _flight_curve() -> Piecewise:
    """The whole flight; the way back leads round the tower in two moves from rest to rest."""
    first, last = _pose(AZIMUTHS[0]), _pose(AZIMUTHS[-1])
    pad = np.array([0.0, -60.0, 0.0, pi / 2, 0.0, pi / 2, HFOV])
    above = pad + np.array([0, 0, 6.0, 0, 0, 0, 0])
    side = np.array([60.0, 0.0, 20.0, last[3], 0.0, last[3], HFOV])
    above_back, pad_back = above.copy(), pad.copy()
    above_back[[3, 5]] = pad_back[[3, 5]] = last[3]
    return concatenate(
        [
            _move(0.0, 8.0, pad, above),
            _move(8.0, 22.0, above, first),
            _orbit(),
            _move(52.0, 82.0, last, side),
            _move(82.0, 112.0, side, above_back),
            _move(112.0, 122.0, above_back, pad_back),
        ]
    )


def _move(t0: float, t1: float, a: np.ndarray, b: np.ndarray) -> Piecewise:
    zero = np.zeros((2, 7))
    return quintic_hermite(np.array([t0, t1]), np.stack([a, b]), zero, zero)


def _orbit() -> Piecewise:
    """Half a circle in 30 s, its azimuth eased by a quintic from rest to rest."""
    t = np.linspace(0.0, 1.0, 121)
    azimuth = -pi / 2 + pi * _ease(t)
    rate = pi * ((30 * t**2 - 60 * t**3 + 30 * t**4) / 30.0)
    accel = pi * ((60 * t - 180 * t**2 + 120 * t**3) / 900.0)
    h = 1e-4
    value = np.array([_pose(a) for a in azimuth])
    d1 = np.array([(_pose(a + h) - _pose(a - h)) / (2 * h) for a in azimuth])
    d2 = np.array([(_pose(a + h) - 2 * _pose(a) + _pose(a - h)) / h**2 for a in azimuth])
    return quintic_hermite(
        22.0 + 30 * t, value, d1 * rate[:, None], d2 * rate[:, None] ** 2 + d1 * accel[:, None]
    )


def _keyframe_times() -> tuple[KeyframeTime, ...]:
    """When the eased azimuth meets each keyframe's."""
    fine = np.linspace(0.0, 1.0, 200_001)
    times = 22 + 30 * np.interp(np.linspace(0.0, 1.0, len(AZIMUTHS)), _ease(fine), fine)
    return tuple(KeyframeTime("half", i, float(x)) for i, x in enumerate(times))


def _ease(t: np.ndarray) -> np.ndarray:
    return 10 * t**3 - 15 * t**4 + 6 * t**5


def dense_plan(*, placed: bool, count: int = 31) -> VerifiedIR:
    """The sample plan with many keyframes along its shot."""
    plan = orbit_plan()
    trajectory = plan.trajectory
    (shot,), (flight,) = trajectory.keyframes.shots, trajectory.drones
    keyframe = replace(shot.keyframes[0], placed=placed)
    written = replace(shot.shot, keyframes=shot.shot.keyframes[:1] * count)
    shots = (replace(shot, shot=written, keyframes=(keyframe,) * count),)
    times = tuple(KeyframeTime("half", i, float(t)) for i, t in enumerate(np.linspace(22, 52, count)))
    keyframes = replace(trajectory.keyframes, shots=shots)
    drones = (replace(flight, keyframes=times),)
    return VerifiedIR(replace(trajectory, keyframes=keyframes, drones=drones), plan.certificate)
